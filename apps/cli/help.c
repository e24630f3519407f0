// SPDX-License-Identifier: Apache-2.0
// Help and man pages, both written from the commands' tables.
#include "cli.h"

#include <string.h>

enum { PAGE_WIDTH = 80, OPTION_INDENT = 2, TEXT_INDENT = 8 };

static const char exit_codes[] = "0 done; 1 the input or the machine is at fault, one line on stderr says how; 2 the "
                                 "command line is at fault; 130 interrupted.";

// Of every command; the parser knows it by itself.
static const Option help_option = {
    .kind = OPTION_FLAG,
    .letter = 'h',
    .name = "help",
    .meaning = "Print this help.",
    .example = "--help",
};

/** Prints words in lines of PAGE_WIDTH; the line so far has `column` characters. Ends the line. */
static void print_wrapped(FILE *out, const char *text, int indent, int column)
{
    while (*text) {
        size_t length = strcspn(text, " \n");
        if (column > indent && column + 1 + (int)length > PAGE_WIDTH) {
            fputc('\n', out);
            column = 0;
        }
        if (column < indent)
            column += fprintf(out, "%*s", indent - column, "");
        else if (column > indent)
            column += fprintf(out, " ");
        column += fprintf(out, "%.*s", (int)length, text);
        text += length;
        if (*text == '\n') {
            fputs("\n\n", out);
            column = 0;
        }
        text += *text != '\0';
    }
    fputc('\n', out);
}

static void print_option(FILE *out, const Option *o)
{
    fprintf(out, "%*s", OPTION_INDENT, "");
    if (o->letter) fprintf(out, "-%c, ", o->letter);
    fprintf(out, "--%s%s%s\n", o->name, o->argument ? " " : "", o->argument ? o->argument : "");
    print_wrapped(out, o->meaning, TEXT_INDENT, 0);
    if (o->standard) print_wrapped(out, o->standard, TEXT_INDENT, fprintf(out, "%*sDefault:", TEXT_INDENT, ""));
    fprintf(out, "%*sExample: %s\n", TEXT_INDENT, "", o->example);
}

static void print_overview(FILE *out)
{
    fprintf(out, "Usage: sheen COMMAND ...\n\nSheen %s renders scenes with cached indirect light.\n\nCommands:\n",
            SHEEN_VERSION);
    for (const Command *const *c = cli_commands; *c; ++c) fprintf(out, "  %-10s %s\n", (*c)->name, (*c)->summary);
    fputs("\nOptions:\n  --help     this page\n  --version  name and version\n\n", out);
    fputs("'sheen COMMAND --help' and 'man sheen-COMMAND' tell the options of a command.\n\nExit codes:\n", out);
    print_wrapped(out, exit_codes, OPTION_INDENT, 0);
}

void cli_print_help(FILE *out, const Command *command)
{
    if (!command) {
        print_overview(out);
        return;
    }
    fprintf(out, "Usage: sheen %s %s [OPTION ...]\n\n", command->name, command->operands);
    print_wrapped(out, command->description, 0, 0);
    fputs("\nOptions:\n", out);
    const Option *o;
    size_t offset;
    for (size_t i = 0; (o = cli_option(command->options, i, &offset)); ++i)
        if (o->kind != OPTION_LATER) print_option(out, o);
    print_option(out, &help_option);
    fprintf(out, "\nExample:\n  %s\n\nExit codes:\n", command->example);
    print_wrapped(out, exit_codes, OPTION_INDENT, 0);
}

/** Prints text so that roff takes it as it is: minus signs, backslashes, and no request at the start of a line. */
static void man_words(FILE *out, const char *text)
{
    bool line_start = true;
    for (const char *c = text; *c; ++c) {
        if (line_start && (*c == '.' || *c == '\'')) fputs("\\&", out);
        line_start = *c == '\n';
        if (*c == '-')
            fputs("\\-", out);
        else if (*c == '\\')
            fputs("\\e", out);
        else if (*c == '\'')
            fputs("\\(aq", out);
        else if (*c == '\n')
            fputs("\n.PP\n", out);
        else
            fputc(*c, out);
    }
}

static void man_text(FILE *out, const char *text)
{
    man_words(out, text);
    fputc('\n', out);
}

static void man_option(FILE *out, const Option *o)
{
    fputs(".TP\n\\fB", out);
    if (o->letter) fprintf(out, "\\-%c\\fR, \\fB", o->letter);
    fputs("\\-\\-", out);
    man_words(out, o->name);
    fputs("\\fR", out);
    if (o->argument) {
        fputs(" \\fI", out);
        man_words(out, o->argument);
        fputs("\\fR", out);
    }
    fputc('\n', out);
    man_text(out, o->meaning);
    if (o->standard) {
        fputs("Default: ", out);
        man_text(out, o->standard);
    }
    fputs(".br\nExample: ", out);
    man_text(out, o->example);
}

static void man_program(FILE *out)
{
    fprintf(out, ".TH SHEEN 1 \"\" \"Sheen %s\" \"Sheen\"\n", SHEEN_VERSION);
    fputs(".SH NAME\nsheen \\- renderer with cached indirect light\n.SH SYNOPSIS\n.B sheen\n.I COMMAND\n\\&...\n", out);
    fputs(".SH DESCRIPTION\nSheen renders scenes with cached indirect light.\n.SH COMMANDS\n", out);
    for (const Command *const *c = cli_commands; *c; ++c) {
        fprintf(out, ".TP\n.B %s\n", (*c)->name);
        man_text(out, (*c)->summary);
    }
    fputs(".SH OPTIONS\n.TP\n.B \\-\\-help\nThis page in short.\n.TP\n.B \\-\\-version\nName and version.\n", out);
    fputs(".SH EXIT STATUS\n", out);
    man_text(out, exit_codes);
    fputs(".SH SEE ALSO\n", out);
    for (const Command *const *c = cli_commands; *c; ++c)
        fprintf(out, ".BR sheen\\-%s (1)%s\n", (*c)->name, c[1] ? "," : "");
}

void cli_print_man(FILE *out, const Command *command)
{
    if (!command) {
        man_program(out);
        return;
    }
    fputs(".TH SHEEN\\-", out);
    for (const char *c = command->name; *c; ++c) fputc(*c >= 'a' && *c <= 'z' ? *c - 'a' + 'A' : *c, out);
    fprintf(out, " 1 \"\" \"Sheen %s\" \"Sheen\"\n.SH NAME\nsheen\\-%s \\- ", SHEEN_VERSION, command->name);
    man_text(out, command->summary);
    fprintf(out, ".SH SYNOPSIS\n.B sheen %s\n.I ", command->name);
    man_text(out, command->operands);
    fputs("[\\fIOPTION\\fR ...]\n", out);
    fputs(".SH DESCRIPTION\n", out);
    man_text(out, command->description);
    fputs(".SH OPTIONS\n", out);
    const Option *o;
    size_t offset;
    for (size_t i = 0; (o = cli_option(command->options, i, &offset)); ++i)
        if (o->kind != OPTION_LATER) man_option(out, o);
    man_option(out, &help_option);
    fputs(".SH EXAMPLE\n.nf\n", out);
    man_text(out, command->example);
    fputs(".fi\n.SH EXIT STATUS\n", out);
    man_text(out, exit_codes);
    fputs(".SH SEE ALSO\n.BR sheen (1)\n", out);
}

// ---- sheen help ---------------------------------------------------------------------------------------------------

typedef struct HelpValues {
    bool man;
} HelpValues;

static const Option help_options[] = {
    {.kind = OPTION_FLAG,
     .name = "man",
     .meaning = "Print the man page, in the macros of man(7), instead of the help.",
     .example = "sheen help --man render | man -l -",
     .offset = offsetof(HelpValues, man)},
    {0},
};

static int run_help(int argc, char **argv)
{
    HelpValues values = {0};
    int code;
    if (!cli_parse(&command_help, &argc, argv, &values, &code)) return code;
    if (argc > 2) return cli_usage_error(&command_help, "'%s': one command at most", argv[2]);
    const Command *command = argc > 1 ? cli_find_command(argv[1]) : NULL;
    if (argc > 1 && !command) return cli_usage_error(&command_help, "'%s': there is no such command", argv[1]);
    (values.man ? cli_print_man : cli_print_help)(stdout, command);
    return cli_finish_stdout();
}

const Command command_help = {
    .name = "help",
    .operands = "[COMMAND]",
    .summary = "what the program and its commands do",
    .description = "Prints an overview, or the help of one command: the same as 'sheen COMMAND --help'.",
    .options = (const OptionTable[]){{help_options, 0}, {0}},
    .example = "sheen help render",
    .run = run_help,
};
