// SPDX-License-Identifier: Apache-2.0
// Where in the hemisphere more rays are worth most. Knows no rays: it maps arrays.
#ifndef SHEEN_GATHER_ALLOCATE_H
#define SHEEN_GATHER_ALLOCATE_H

#include "gather/strata.h"

#include <stdint.h>

/** Most rays that a cell can be given beside its first. */
enum { SHEEN_EXTRA_MAX = 64 };

/**
 * Gives cells more rays until the standard error of the mean is expected to be `error` times the mean, in proportion to
 * the standard deviation expected in each (Neyman's allocation). What a cell may hold is told by its neighbors alone,
 * never by its own first sample: a mean over first and further samples is then free of bias, where cells that are
 * chosen because they were bright would come out too dark.
 * @param value      [cells] the first samples: luminance, or another non-negative measure
 * @param error      relative standard error to reach
 * @param most       the largest sum of all extra rays; the error then stays larger
 * @param deviation  [cells] scratch; out: the standard deviation that was expected in each cell
 * @param extra      [cells] out: further rays for each cell
 * @param expected   out: the relative standard error that is expected then
 * @return their sum
 * Source: neyman1934-allocation, for the shares; ward1988 supersamples by the contrast of neighbors.
 */
uint32_t sheen_strata_allocate(SheenStrata s, const float value[], float error, uint32_t most, float deviation[],
                               uint32_t extra[], float *expected);

#endif
