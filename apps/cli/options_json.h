// SPDX-License-Identifier: Apache-2.0
// The values of options as JSON: for statistics, EXR files and whoever must know how a picture was made.
#ifndef SHEEN_CLI_OPTIONS_JSON_H
#define SHEEN_CLI_OPTIONS_JSON_H

#include "cli.h"

#include <jansson.h>

/** @return the recorded options and their values as one object, a new reference; NULL when out of memory. */
json_t *options_json(const OptionTable *tables, const void *values);

/** The same of those that the records of the cache depend on. */
json_t *options_json_of_records(const OptionTable *tables, const void *values);

/** @return the value of the option of that name, which must be there, recorded or not; a new reference or NULL. */
json_t *options_json_value(const OptionTable *tables, const void *values, const char *name);

/** @return the name of a value in a list of choices, "" for one that has none. */
const char *choice_name(const Choice *choices, int value);

#endif
