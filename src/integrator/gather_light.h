// SPDX-License-Identifier: Apache-2.0
// One gather: rays, light at what they hit, more rays where they are worth most. Every kind of record begins with it.
#ifndef SHEEN_INTEGRATOR_GATHER_LIGHT_H
#define SHEEN_INTEGRATOR_GATHER_LIGHT_H

#include "integrator/deep.h"
#include "integrator/hemisphere.h"

/** Relative standard error of the mean over a gather's strata that rays for irradiance aim at. */
#define SHEEN_GATHER_ERROR 0.03f

/** What all gathers of one kind share: where light beyond the first bounce comes from, and a buffer for each worker. */
typedef struct SheenGatherer {
    const SheenWork *work;
    const SheenDeep *deep; // NULL when that light is traced as paths, or when there is none
    float error;           // relative standard error of the mean over the strata that rays aim at
    unsigned workers;
    Hemisphere *scratch; // [workers], of the same strata
} SheenGatherer;

/**
 * @param strata  cosine-weighted or uniform
 * @param error   see SheenGatherer
 * @return false when out of memory; *out is to be freed all the same
 */
bool sheen_gatherer_init(const SheenWork *work, const SheenDeep *deep, SheenStrata strata, float error,
                         SheenGatherer *out);
void sheen_gatherer_free(SheenGatherer *gatherer);

/**
 * Gathers the light over a point, without what comes straight from lamps. Non-finite values are counted and taken for
 * black.
 * @param R_min  the least radius that the record will have, metres: where it is more than the harmonic mean distance
 * the record counts beside several others wherever it is read, and may be noisier than the aim
 * @param key    of all random numbers
 * @return the worker's buffer, until its next gather
 */
const Hemisphere *sheen_gather_light(const SheenGatherer *gatherer, const DiffusePoint *point, float R_min,
                                     uint32_t key, unsigned worker, SheenStats *stats);

#endif
