// SPDX-License-Identifier: Apache-2.0
// One gather: rays, light at what they hit, more rays where they are worth most. Every kind of record begins with it.
#ifndef SHEEN_INTEGRATOR_GATHER_LIGHT_H
#define SHEEN_INTEGRATOR_GATHER_LIGHT_H

#include "integrator/deep.h"
#include "integrator/hemisphere.h"

/** Relative standard error of the mean over a gather's strata that its rays aim at. */
#define SHEEN_GATHER_ERROR 0.03f

/**
 * Gathers the light over a point into h->L, without what comes straight from lamps. Non-finite values are counted and
 * taken for black.
 * @param deep   light beyond the first bounce; NULL when it is traced as paths, or when there is none
 * @param R_min  the least radius that the record will have, metres: where it is more than the harmonic mean distance
 * the record counts beside several others wherever it is read, and may be noisier than the aim
 * @param key    of all random numbers
 * @param h      reserved for its strata, cosine-weighted or uniform
 */
void sheen_gather_light(const SheenWork *work, const SheenDeep *deep, const DiffusePoint *point, float R_min,
                        uint32_t key, Hemisphere *h, SheenStats *stats);

#endif
