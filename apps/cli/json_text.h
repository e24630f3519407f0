// SPDX-License-Identifier: Apache-2.0
// Names of files and cameras as JSON strings.
#ifndef SHEEN_CLI_JSON_TEXT_H
#define SHEEN_CLI_JSON_TEXT_H

#include <jansson.h>

/** @return the text as a JSON string, with '?' for bytes above 127 when it is not UTF-8; NULL when out of memory. */
json_t *json_text(const char *text);

#endif
