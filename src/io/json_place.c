// SPDX-License-Identifier: Apache-2.0
#include "io/json_place.h"

#include <stdbool.h>
#include <string.h>

typedef struct Cursor {
    const char *at, *end;
} Cursor;

static void skip_space(Cursor *c)
{
    while (c->at < c->end && strchr(" \t\r\n", *c->at) && *c->at) ++c->at;
}

/** Goes behind a string that begins here. */
static void skip_string(Cursor *c)
{
    for (++c->at; c->at < c->end && *c->at != '"'; ++c->at)
        if (*c->at == '\\') ++c->at;
    if (c->at < c->end)
        ++c->at;
    else
        c->at = c->end;
}

/** Goes behind the value that begins here: to a comma or a closing bracket of what holds it. */
static void skip_value(Cursor *c)
{
    size_t depth = 0;
    while (c->at < c->end) {
        char letter = *c->at;
        if (letter == '"') {
            skip_string(c);
            continue;
        }
        if (depth == 0 && (letter == ',' || letter == ']' || letter == '}')) return;
        if (letter == '[' || letter == '{') ++depth;
        if (letter == ']' || letter == '}') --depth;
        ++c->at;
    }
}

/** Enters the container that begins here and goes to the value that the step names. @return false: not there */
static bool enter(Cursor *c, const JsonStep *step)
{
    if (c->at == c->end || *c->at != (step->member ? '{' : '[')) return false;
    size_t length = step->member ? strlen(step->member) : 0;
    ++c->at;
    for (size_t i = 0;; ++i) {
        skip_space(c);
        if (c->at == c->end || *c->at == '}' || *c->at == ']') return false;
        bool found = i == step->item;
        if (step->member) {
            const char *name = c->at + 1;
            skip_string(c);
            found = (size_t)(c->at - name) == length + 1 && memcmp(name, step->member, length) == 0;
            skip_space(c);
            if (c->at < c->end) ++c->at; // the colon
            skip_space(c);
        }
        if (found) return c->at < c->end;
        skip_value(c);
        if (c->at < c->end && *c->at == ',') ++c->at;
    }
}

JsonPlace sheen_json_place(const char *text, size_t size, const JsonStep steps[], size_t n)
{
    Cursor c = {text, text + size};
    skip_space(&c);
    const char *found = c.at;
    for (size_t i = 0; i < n && enter(&c, &steps[i]); ++i) found = c.at;
    JsonPlace place = {1, 1};
    for (const char *p = text; p < found; ++p) {
        bool new_line = *p == '\n';
        place.column = new_line ? 1 : place.column + 1;
        place.line += new_line;
    }
    return place;
}
