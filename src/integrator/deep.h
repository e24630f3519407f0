// SPDX-License-Identifier: Apache-2.0
// Light beyond the first bounce: a sparse set of records that gather once, keep their hits, and are swept once a
// bounce.
#ifndef SHEEN_INTEGRATOR_DEEP_H
#define SHEEN_INTEGRATOR_DEEP_H

#include "integrator/follow.h"
#include "integrator/hot_spot.h"
#include "integrator/work.h"

typedef struct SheenDeep SheenDeep;

/**
 * Places records over what the seeds' surroundings see, from their own hits outward until no new ground appears,
 * gathers at each, and solves E_k = G(sky + direct + albedo E_k-1) for k = 0 .. bounces by sweeps over the stored hits.
 * @param seeds    [n] points that the picture's gathers start from, in a fixed order
 * @param bounces  the largest k that will be read
 * @param out      owned by the caller; borrows `work`
 */
SHEEN_NODISCARD SheenStatus sheen_deep_create(const SheenWork *work, const DiffusePoint seeds[], size_t n,
                                              unsigned bounces, SheenStats *stats, SheenDeep **out);
void sheen_deep_destroy(SheenDeep **deep);

/** Sky and k bounces: how many of the highest k can be read: k, k - 1 and k - 2 for near hits that go on. */
enum { SHEEN_DEEP_LEVELS = 3 };

/**
 * The irradiance of the sky and of up to k bounces at a point, without direct light, from the records around it that no
 * wall hides; where there is none, the mean over all.
 * @param k  in (bounces - SHEEN_DEEP_LEVELS, bounces]; below 0 it is black
 * Thread-safe; a pure function of its arguments.
 */
Rgb sheen_deep_irradiance(const SheenDeep *deep, Vec3 p, Vec3 n, int k);

/** Distance below which a gather's hit is too near for deep records: one more real vertex is worth its ray. Metres. */
float sheen_deep_near(const SheenDeep *deep);

/** The small bright places that the records' gathers found. */
const HotSpots *sheen_deep_hot_spots(const SheenDeep *deep);

uint32_t sheen_deep_records(const SheenDeep *deep);

#endif
