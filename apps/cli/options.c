// SPDX-License-Identifier: Apache-2.0
// From the words of a command line to a structure of values, strictly: a number is read whole and in its range, a name
// is one that exists, or one line says what is wrong with which option.
#include "cli.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/** An option with what was given to it. */
typedef struct Given {
    const Command *command;
    const Option *option;
    char shown[64];   // as the user wrote it: "--spp" or "-o"
    const char *text; // its argument
    void *field;
} Given;

// Digits only: strtoul would take "-1", " 1" and "+1".
static bool read_count(const char *text, double min, double max, uint32_t *out)
{
    if (!*text || strspn(text, "0123456789") != strlen(text)) return false;
    errno = 0;
    unsigned long long value = strtoull(text, NULL, 10);
    if (errno || (double)value < min || (double)value > max) return false;
    *out = (uint32_t)value;
    return true;
}

// Decimal numbers only: strtod would take "nan", "inf", "0x1p3" and leading spaces.
static bool read_number(const char *text, double min, double max, double *out)
{
    if (!*text || strspn(text, "0123456789.+-eE") != strlen(text)) return false;
    char *end;
    double value = strtod(text, &end);
    if (*end || end == text || !isfinite(value) || value < min || value > max) return false;
    *out = value;
    return true;
}

static bool read_size(const char *text, double min, double max, PictureSize *out)
{
    char width[16];
    size_t n = strcspn(text, "xX");
    if (!text[n] || n >= sizeof width) return false;
    memcpy(width, text, n);
    width[n] = '\0';
    return read_count(width, min, max, &out->width) && read_count(text + n + 1, min, max, &out->height);
}

const Choice cli_on_off[] = {{"on", SWITCH_ON}, {"off", SWITCH_OFF}, {0}};

static const Choice *find_choice(const Choice *choices, const char *text, size_t length)
{
    for (const Choice *c = choices; c->name; ++c)
        if (strlen(c->name) == length && memcmp(c->name, text, length) == 0) return c;
    return NULL;
}

static void list_choices(const Choice *choices, char *out, size_t size)
{
    size_t used = 0;
    out[0] = '\0';
    for (const Choice *c = choices; c->name; ++c) {
        if (c->value == CHOICE_LATER) continue;
        int n = snprintf(out + used, size - used, "%s%s", used ? ", " : "", c->name);
        if (n < 0 || (size_t)n >= size - used) return;
        used += (size_t)n;
    }
}

/** @return the choice's value, or CHOICE_LATER after a message. */
static int read_choice(const Given *g, const char *text, size_t length)
{
    const Choice *choice = find_choice(g->option->choices, text, length);
    if (choice && choice->value != CHOICE_LATER) return choice->value;
    if (choice) {
        cli_usage_error(g->command, "%s: '%s' is not in this version", g->shown, choice->name);
    } else {
        char names[512];
        list_choices(g->option->choices, names, sizeof names);
        cli_usage_error(g->command, "%s: '%.*s' is none of %s", g->shown, (int)length, text, names);
    }
    return CHOICE_LATER;
}

static bool store_set(const Given *g)
{
    unsigned set = 0;
    for (const char *word = g->text;; ++word) {
        size_t length = strcspn(word, ",");
        int value = read_choice(g, word, length);
        if (value == CHOICE_LATER) return false;
        set |= 1u << value;
        word += length;
        if (!*word) break;
    }
    *(unsigned *)g->field |= set;
    return true;
}

static bool store_texts(const Given *g)
{
    TextList *list = g->field;
    if (list->n == TEXT_LIST_MAX) {
        cli_usage_error(g->command, "%s: given more than %d times", g->shown, TEXT_LIST_MAX);
        return false;
    }
    list->items[list->n++] = g->text;
    return true;
}

static bool refuse_number(const Given *g, const char *what)
{
    const Option *o = g->option;
    cli_usage_error(g->command, "%s: '%s' is not %s from %.10g to %.10g", g->shown, g->text, what, o->min, o->max);
    return false;
}

/** Reads the argument into the option's field. @return false after a message. */
static bool store(const Given *g)
{
    const Option *o = g->option;
    switch (o->kind) {
    case OPTION_FLAG:
        *(bool *)g->field = true;
        return true;
    case OPTION_COUNT:
        return read_count(g->text, o->min, o->max, g->field) || refuse_number(g, "a whole number");
    case OPTION_NUMBER:
        return read_number(g->text, o->min, o->max, g->field) || refuse_number(g, "a number");
    case OPTION_SIZE:
        return read_size(g->text, o->min, o->max, g->field) || refuse_number(g, "a size WxH with sides");
    case OPTION_CHOICE: {
        int value = read_choice(g, g->text, strlen(g->text));
        if (value != CHOICE_LATER) *(int *)g->field = value;
        return value != CHOICE_LATER;
    }
    case OPTION_SWITCH: {
        int value = g->text ? read_choice(g, g->text, strlen(g->text)) : SWITCH_ON;
        if (value != CHOICE_LATER) *(int *)g->field = value;
        return value != CHOICE_LATER;
    }
    case OPTION_SET:
        return store_set(g);
    case OPTION_TEXT:
        *(const char **)g->field = g->text;
        return true;
    case OPTION_TEXTS:
        return store_texts(g);
    case OPTION_LATER:
        break;
    }
    return false;
}

const Option *cli_option(const OptionTable *tables, size_t i, size_t *offset)
{
    for (const OptionTable *t = tables; t->options; ++t)
        for (const Option *o = t->options; o->name; ++o) {
            if (i-- > 0) continue;
            *offset = t->base + o->offset;
            return o;
        }
    return NULL;
}

/** Finds the option of a word that begins with a dash; *inline_text is what follows `=` or the letter, or NULL. */
static const Option *find_option(const Command *command, const char *word, Given *g, const char **inline_text,
                                 size_t *offset)
{
    const Option *o;
    *inline_text = NULL;
    if (word[1] != '-') {
        snprintf(g->shown, sizeof g->shown, "-%c", word[1]);
        if (word[2]) *inline_text = word + 2;
        for (size_t i = 0; (o = cli_option(command->options, i, offset)); ++i)
            if (o->letter == word[1]) return o;
        return NULL;
    }
    size_t length = strcspn(word, "=");
    if (word[length]) *inline_text = word + length + 1;
    snprintf(g->shown, sizeof g->shown, "%.*s", (int)length, word);
    for (size_t i = 0; (o = cli_option(command->options, i, offset)); ++i)
        if (strlen(o->name) == length - 2 && memcmp(o->name, word + 2, length - 2) == 0) return o;
    return NULL;
}

/** Takes argv[*i], an option, and its argument. @return false after a message. */
static bool parse_option(const Command *command, int argc, char **argv, int *i, void *values)
{
    Given g = {.command = command};
    const char *inline_text;
    size_t offset = 0;
    g.option = find_option(command, argv[*i], &g, &inline_text, &offset);
    if (!g.option) {
        cli_usage_error(command, "%s: there is no such option", g.shown);
        return false;
    }
    if (g.option->kind == OPTION_LATER) {
        cli_usage_error(command, "%s: this option is not in this version", g.shown);
        return false;
    }
    if (g.option->kind == OPTION_FLAG && inline_text) {
        cli_usage_error(command, "%s: takes no argument, not '%s'", g.shown, inline_text);
        return false;
    }
    g.field = (char *)values + offset;
    g.text = inline_text;
    if (g.option->kind == OPTION_SWITCH) {
        // A word that follows is an operand unless it can only be the switch's.
        const char *next = !g.text && *i + 1 < argc ? argv[*i + 1] : NULL;
        if (next && find_choice(cli_on_off, next, strlen(next))) g.text = argv[++*i];
    } else if (g.option->kind != OPTION_FLAG) {
        if (!g.text && *i + 1 < argc) g.text = argv[++*i];
        if (!g.text || !*g.text) {
            cli_usage_error(command, "%s: its argument %s is missing", g.shown, g.option->argument);
            return false;
        }
    }
    return store(&g);
}

double cli_decimal(float value)
{
    return nearbyint((double)value * 1e4) / 1e4;
}

bool cli_parse(const Command *command, int *argc, char **argv, void *values, int *exit_code)
{
    int n_operands = 0;
    bool options_end = false;
    for (int i = 1; i < *argc; ++i) {
        const char *word = argv[i];
        if (options_end || word[0] != '-' || !word[1]) {
            argv[1 + n_operands++] = argv[i];
        } else if (strcmp(word, "--") == 0) {
            options_end = true;
        } else if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
            cli_print_help(stdout, command);
            *exit_code = cli_finish_stdout();
            return false;
        } else if (!parse_option(command, *argc, argv, &i, values)) {
            *exit_code = CLI_USAGE;
            return false;
        }
    }
    *argc = 1 + n_operands;
    return true;
}
