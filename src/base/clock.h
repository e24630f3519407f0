// SPDX-License-Identifier: Apache-2.0
// Wall-clock time for statistics and progress; never part of a picture.
#ifndef SHEEN_BASE_CLOCK_H
#define SHEEN_BASE_CLOCK_H

#include <time.h>

/** @return seconds of a clock that only goes forward. */
static inline double sheen_clock_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
