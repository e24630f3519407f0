// SPDX-License-Identifier: Apache-2.0
// Statistics of a run as one JSON object.
#ifndef SHEEN_CLI_STATS_H
#define SHEEN_CLI_STATS_H

#include "render_options.h"

/** What a run of `sheen render` measured beside the library's own counters. Times in seconds. */
typedef struct RunStats {
    const char *scene;
    unsigned threads;
    double load, write, total;
    SheenStats render;
    SheenRenderTimes times;
} RunStats;

/** @return the object as text from malloc, or NULL when out of memory. Keys never change their meaning. */
char *stats_to_json(const RenderValues *values, const RunStats *run);

#endif
