// SPDX-License-Identifier: Apache-2.0
// The options about cache files.
#ifndef SHEEN_CLI_CACHE_OPTIONS_H
#define SHEEN_CLI_CACHE_OPTIONS_H

#include "cli.h"

typedef struct CacheValues {
    TextList in;       // files to read records from
    const char *out;   // file to write them to; NULL for none
    bool records_only; // of `sheen render` alone
} CacheValues;

/** Of a CacheValues, without records_only. */
extern const Option cache_options[];

/** Checks them against each other. @param has_cache  whether the integrator has records
 *  @return true, or false after a message about the command line */
bool cache_values_check(const Command *command, const CacheValues *values, bool has_cache);

#endif
