// SPDX-License-Identifier: Apache-2.0
// What the program writes as JSON in more than one place.
#ifndef SHEEN_CLI_JSON_TEXT_H
#define SHEEN_CLI_JSON_TEXT_H

#include "math/bounds.h"

#include <jansson.h>
#include <stdint.h>

/** @return the text as a JSON string, with '?' for bytes above 127 when it is not UTF-8; NULL when out of memory. */
json_t *json_text(const char *text);

/** @return a hash as a JSON string of 16 hexadecimal digits; NULL when out of memory. */
json_t *json_hash(uint64_t hash);

/** @return the two corners as JSON arrays, or null where there are none. */
json_t *json_bounds(const Bounds *bounds);

/** @return any JSON value as text in one line, from malloc; NULL when out of memory. */
char *json_value_text(const json_t *value);

#endif
