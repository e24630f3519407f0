// SPDX-License-Identifier: Apache-2.0
// What the commands of the program share: each is one file that defines one Command. The tables of its options are the
// only place that knows them: parser, --help and man page are all made from them.
#ifndef SHEEN_CLI_CLI_H
#define SHEEN_CLI_CLI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/** Exit codes of the program. */
enum { CLI_DONE = 0, CLI_WORLD = 1, CLI_USAGE = 2, CLI_INTERRUPTED = 130 };

/** How an option's argument is read, and the type of the field that it fills. */
typedef enum OptionKind {
    OPTION_FLAG,   // no argument; bool becomes true
    OPTION_COUNT,  // whole number in [min, max]; uint32_t
    OPTION_NUMBER, // decimal number in [min, max]; double
    OPTION_CHOICE, // one of `choices`; int becomes its value
    OPTION_SWITCH, // "on", "off", or nothing for "on"; int becomes a Switch
    OPTION_SET,    // names of `choices` with commas between; unsigned gains the bits 1 << value
    OPTION_SIZE,   // WxH, each side in [min, max]; PictureSize
    OPTION_TEXT,   // any words but none; const char *
    OPTION_TEXTS,  // the same, may be given several times; TextList
    OPTION_LATER,  // known, but not in this version: refused, and not in the help
} OptionKind;

/** A named value. A choice that this version does not have is refused, and not in the help. */
typedef struct Choice {
    const char *name; // NULL ends a list
    int value;
} Choice;
enum { CHOICE_LATER = -1 };

/** Values of an OPTION_SWITCH; unset is what a command puts there for a default that depends. */
typedef enum Switch { SWITCH_OFF, SWITCH_ON, SWITCH_UNSET } Switch;
extern const Choice cli_on_off[];

typedef struct PictureSize {
    uint32_t width, height;
} PictureSize;

enum { TEXT_LIST_MAX = 32 };
typedef struct TextList {
    const char *items[TEXT_LIST_MAX];
    size_t n;
} TextList;

/** One option of a command. */
typedef struct Option {
    OptionKind kind;
    char letter;          // of the short form, 0 for none
    const char *name;     // of the long form without the dashes; NULL ends a table
    const char *argument; // how help names the argument; NULL for flags
    const char *meaning;  // sentences
    const char *standard; // what holds without the option; NULL for flags
    const char *example;  // as a user would type it
    size_t offset;        // of the field in the table's structure of values
    double min, max;
    const Choice *choices;
    bool recorded;   // the picture depends on it: it goes into statistics and EXR files
    bool of_records; // the records of the cache depend on it: it goes into cache files
} Option;

/** Options that several commands may share, and where the structure that they fill stands in the command's values. */
typedef struct OptionTable {
    const Option *options; // NULL ends a list of tables
    size_t base;
} OptionTable;

/** A command: `sheen NAME`. */
typedef struct Command {
    const char *name;
    const char *operands;    // how help names them: "SCENE"
    const char *summary;     // one line, lower case, no stop
    const char *description; // paragraphs for help and man page, "\n" between them
    const OptionTable *options;
    const char *example; // a whole command line
    /** @param argv  argv[0] is the command's name; argv[argc] is NULL. @return the exit code */
    int (*run)(int argc, char **argv);
} Command;

extern const Command command_render, command_animate, command_compare, command_info, command_help;

/** All commands in the order of the help; NULL ends the list. */
extern const Command *const cli_commands[];

/** @return the command of that name or NULL. */
const Command *cli_find_command(const char *name);

/**
 * @param offset  gets the place of the option's field in the command's structure of values
 * @return option i of all tables in their order, or NULL behind the last
 */
const Option *cli_option(const OptionTable *tables, size_t i, size_t *offset);

/**
 * Reads the words of a command line into a structure of values that holds the defaults. Options and operands may stand
 * in any order; `--name=value`, `-xvalue` and `--` work; of an option given twice the last counts.
 * @param argc, argv  as a command gets them; on return argv[1..*argc - 1] are the operands
 * @return true to go on; false when *exit_code says how to end: help was asked for and printed, or one line on stderr
 *         names the option that is wrong
 */
bool cli_parse(const Command *command, int *argc, char **argv, void *values, int *exit_code);

/** @return the nearest number of four decimals, so that a value of the library is told as 0.15 and not as its float. */
double cli_decimal(float value);

// Messages: one line each on stderr, with '?' for control characters.

/** Prints `sheen: MESSAGE; try 'sheen COMMAND --help'` on stderr. @param command  may be NULL. @return CLI_USAGE */
int cli_usage_error(const Command *command, const char *format, ...) __attribute__((format(printf, 2, 3)));

/**
 * Checks that a command was left one operand. @param operand  its name in the help @param what  in words
 * @return CLI_DONE, or CLI_USAGE after a message
 */
int cli_check_operand(const Command *command, int argc, char **argv, const char *operand, const char *what);

/** Prints `sheen: MESSAGE` on stderr. @return CLI_WORLD */
int cli_error(const char *format, ...) __attribute__((format(printf, 1, 2)));

/** Prints a line that begins with `start` on stderr. */
void cli_note(const char *start, const char *format, ...) __attribute__((format(printf, 2, 3)));

/** Flushes stdout. @return CLI_DONE, or CLI_WORLD and a message when what was printed did not arrive. */
int cli_finish_stdout(void);

/** Prints what `sheen COMMAND --help` says, or the overview for NULL. */
void cli_print_help(FILE *out, const Command *command);

/** Prints the man page, in the macros of man(7), of a command, or of the program for NULL. */
void cli_print_man(FILE *out, const Command *command);

#endif
