// SPDX-License-Identifier: Apache-2.0
// What `sheen info` tells of a cache file.
#ifndef SHEEN_CLI_CACHE_INFO_H
#define SHEEN_CLI_CACHE_INFO_H

#include "cache/cache_file.h"

#include <jansson.h>

/** @return a new reference, or NULL when out of memory. */
json_t *cache_info_json(const char *path, const SheenCacheFile *file);

#endif
