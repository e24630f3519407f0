// SPDX-License-Identifier: Apache-2.0
// The program: finds the command and runs it.
#include "cli.h"

#include <errno.h>
#include <signal.h>
#include <stdarg.h>
#include <string.h>

const Command *const cli_commands[] = {&command_render, &command_animate, &command_compare,
                                       &command_info,   &command_help,    NULL};

// Commands that are known but not in this version.
static const char *const later_commands[] = {"view", NULL};

const Command *cli_find_command(const char *name)
{
    for (const Command *const *c = cli_commands; *c; ++c)
        if (strcmp((*c)->name, name) == 0) return *c;
    return NULL;
}

// Names and texts come from files: whatever is in them, a message is one line, and a terminal takes no command from it.
static void print_line(const char *start, const char *format, va_list args, const char *end)
{
    char text[2048];
    vsnprintf(text, sizeof text, format, args);
    for (char *c = text; *c; ++c)
        if ((unsigned char)*c < ' ' || *c == 127) *c = '?';
    fprintf(stderr, "%s%s%s\n", start, text, end);
}

int cli_usage_error(const Command *command, const char *format, ...)
{
    char end[64];
    snprintf(end, sizeof end, "; try 'sheen %s%s--help'", command ? command->name : "", command ? " " : "");
    va_list args;
    va_start(args, format);
    print_line("sheen: ", format, args, end);
    va_end(args);
    return CLI_USAGE;
}

int cli_check_operand(const Command *command, int argc, char **argv, const char *operand, const char *what)
{
    if (argc < 2) return cli_usage_error(command, "%s: the %s is missing", operand, what);
    if (argc > 2) return cli_usage_error(command, "%s: '%s' is one %s too many", operand, argv[2], what);
    return CLI_DONE;
}

int cli_error(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    print_line("sheen: ", format, args, "");
    va_end(args);
    return CLI_WORLD;
}

void cli_note(const char *start, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    print_line(start, format, args, "");
    va_end(args);
}

int cli_finish_stdout(void)
{
    if (fflush(stdout) == 0 && !ferror(stdout)) return CLI_DONE;
    return cli_error("standard output: %s", strerror(errno));
}

int main(int argc, char **argv)
{
    // A reader that went away or a limit on file sizes makes a write fail, which is reported, instead of ending us.
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    if (argc < 2) return cli_usage_error(NULL, "a command is missing");
    const char *word = argv[1];
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
        cli_print_help(stdout, NULL);
        return cli_finish_stdout();
    }
    if (strcmp(word, "--version") == 0) {
        printf("sheen %s\n", SHEEN_VERSION);
        return cli_finish_stdout();
    }
    const Command *command = cli_find_command(word);
    if (command) return command->run(argc - 1, argv + 1);
    for (const char *const *later = later_commands; *later; ++later)
        if (strcmp(*later, word) == 0) return cli_usage_error(NULL, "'%s' is not in this version", word);
    return cli_usage_error(NULL, "there is no %s '%s'", word[0] == '-' ? "option" : "command", word);
}
