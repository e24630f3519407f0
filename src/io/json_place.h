// SPDX-License-Identifier: Apache-2.0
// Where in a JSON text a value stands: the parser tells lines and columns of its own errors only.
#ifndef SHEEN_IO_JSON_PLACE_H
#define SHEEN_IO_JSON_PLACE_H

#include <stddef.h>

/** A step from a value into it: to a member of an object, or with NULL for a name to an item of an array. */
typedef struct JsonStep {
    const char *member;
    size_t item;
} JsonStep;

typedef struct JsonPlace {
    int line, column; // from 1; columns in bytes
} JsonPlace;

/**
 * @param text   [size] well-formed JSON
 * @param steps  [n] from the outermost value; member names without escapes
 * @return where the value begins; where a step finds nothing, where the value begins that lacks it
 */
JsonPlace sheen_json_place(const char *text, size_t size, const JsonStep steps[], size_t n);

#endif
