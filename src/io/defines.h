// SPDX-License-Identifier: Apache-2.0
// Parameters of a scene that are given from outside.
#ifndef SHEEN_IO_DEFINES_H
#define SHEEN_IO_DEFINES_H

#include <stdbool.h>
#include <stddef.h>

/** Values of $parameters, each "NAME=VALUE"; they go before what <default> says. All zero: none. */
typedef struct SheenDefines {
    const char *const *items;
    size_t n;
} SheenDefines;

/** @return true when `text` is a name of letters, digits and '_', '=', and a value, which may be empty. */
bool sheen_define_is_valid(const char *text);

#endif
