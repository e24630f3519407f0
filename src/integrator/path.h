// SPDX-License-Identifier: Apache-2.0
// One path: an unbiased estimate of the light that arrives along a ray.
#ifndef SHEEN_INTEGRATOR_PATH_H
#define SHEEN_INTEGRATOR_PATH_H

#include "integrator/work.h"
#include "math/sampler.h"

/** Scatterings at delta lobes (mirrors, glass) that one path follows at most; they do not count as bounces. Passage
 *  through holes is none of them, see SHEEN_PASSAGES_MAX. */
enum { SHEEN_PATH_MAX_DELTA = 64 };

/** Dimensions of a sample that are left to the caller, for the place in the pixel: sheen_path_trace starts after them.
 */
enum { SHEEN_PATH_FIRST_DIM = 2 };

/** Radiance along a ray, split by the number of scatterings that are not at delta lobes. W m^-2 sr^-1. */
typedef struct PathRadiance {
    Rgb direct;   // at most one: emitters, seen straight or through delta lobes, and direct light
    Rgb indirect; // two or more
} PathRadiance;

/**
 * Follows one path and sums the light that it finds: at each vertex by light samples and by the ray that goes on,
 * weighted by the power heuristic. See sheen_path_render for what counts as a bounce and which light is left out.
 *
 * @param ray      of unit direction
 * @param hit      what the ray hits, possibly nothing
 * @param sampler  the sample; its `dim` is ignored, see SHEEN_PATH_FIRST_DIM
 * @param stats    rays are counted here; not shared between threads
 * @return an estimate whose mean is the radiance; may be non-finite where the scene's numbers overflow
 * Source: veach1997 ch. 9 (power heuristic); arvo1990 (Russian roulette). Pure but for *stats, thread-safe.
 */
PathRadiance sheen_path_trace(const SheenWork *work, const Ray *ray, const Hit *hit, SheenSampler sampler,
                              SheenStats *stats);

#endif
