// SPDX-License-Identifier: Apache-2.0
// What the first pass leaves: the points whose indirect light caches hold.
#ifndef SHEEN_INTEGRATOR_SEEN_POINTS_H
#define SHEEN_INTEGRATOR_SEEN_POINTS_H

#include "basis/basis.h"
#include "integrator/follow.h"

/** A point that a pixel sees. */
typedef struct ShadingPoint {
    DiffusePoint point;
    Rgb throughput;  // of the mirrors and panes on the way, over the chance of the way; times what the sample counts
                     // for under the pixel's filter, which may be negative
    Vec3 toward;     // unit, along which it was seen
    float footprint; // side of a pixel's square at this distance, metres
    uint32_t pixel;  // y * width + x
    uint32_t sample; // sample of the pixel
    uint32_t branch; // which of the sample's ways through mirrors and glass
    bool lit;        // its direct light is in the film
    bool gathered;   // seen along a glossy reflection: all its light is indirect
} ShadingPoint;

/** A point on a glossy surface, and what harmonics hold of its lobes: f(wo, .) cos(theta_i). */
typedef struct GlossyPoint {
    ShadingPoint at; // lit; its reflectance says nothing
    SheenBasis basis;
    unsigned order; // n; 0 without a lobe
    size_t lobe;    // the first of its n * n coefficients in the list's `lobes`
} GlossyPoint;

typedef struct SeenPoints {
    ShadingPoint *points; // diffuse ones
    size_t n_points, points_capacity;
    GlossyPoint *glossy;
    size_t n_glossy, glossy_capacity;
    Rgb *lobes;
    size_t n_lobes, lobes_capacity;
} SeenPoints;

void sheen_seen_free(SeenPoints *seen);
static inline void seen_clear(SeenPoints *seen)
{
    seen->n_points = seen->n_glossy = seen->n_lobes = 0;
}

/** Adds n points. @return false when out of memory */
bool sheen_seen_add(const ShadingPoint points[], size_t n, SeenPoints *seen);

/**
 * Adds a glossy point with a copy of its lobe.
 * @param lobe  [order * order]; NULL where only the place matters
 * @return false when out of memory
 */
bool sheen_seen_add_glossy(const ShadingPoint *at, SheenBasis basis, unsigned order, const Rgb lobe[],
                           SeenPoints *seen);

/** Adds all of another list. @return false when out of memory */
bool sheen_seen_append(const SeenPoints *more, SeenPoints *seen);

#endif
