// SPDX-License-Identifier: Apache-2.0
// Time of the micro benchmarks.
#ifndef SHEEN_BENCH_TIMING_H
#define SHEEN_BENCH_TIMING_H

#include <time.h>

/** Seconds of processor time of the program: others do not count. */
static inline double processor_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/** For qsort over doubles, the smallest first. */
static inline int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

#endif
