// SPDX-License-Identifier: Apache-2.0
// Small places so bright that a gather must not leave to chance whether it finds them: the inside of a lamp's housing,
// a patch of sun behind a door. What is known of them comes from other gathers, so that it may steer one without bias.
#ifndef SHEEN_INTEGRATOR_HOT_SPOT_H
#define SHEEN_INTEGRATOR_HOT_SPOT_H

#include "base/status.h"
#include "gather/strata.h"
#include "math/frame.h"

#include <stdint.h>

/** A sphere about hits that were far brighter than what else was seen. */
typedef struct HotSpot {
    Vec3 center;
    float radius;   // metres
    float radiance; // luminance, the largest seen
    uint32_t hits;
} HotSpot;

enum { SHEEN_HOT_SPOTS_MAX = 256, SHEEN_CONES_MAX = 48 };

typedef struct HotSpots {
    uint32_t n;
    HotSpot spots[SHEEN_HOT_SPOTS_MAX];
} HotSpots;

/**
 * Adds a hit to the spot that it is near to, or makes a new one; once there are SHEEN_HOT_SPOTS_MAX, others are left
 * out. The result depends on the order of the calls.
 * @param distance  from which it was seen, metres: nearness is an angle
 * @param radiance  luminance
 */
void sheen_hot_spots_add(HotSpots *spots, Vec3 p, float distance, float radiance);

/** The rays that a gather sends into the cone about a hot spot, uniform in it. */
typedef struct Cone {
    Vec3 axis;      // unit, local frame of the gather
    float sin2_max; // of the half angle
    float density;  // rays per steradian
    uint32_t rays;
    uint32_t spot; // which
} Cone;

/** The hot spots that matter at one gather. */
typedef struct Guide {
    const HotSpots *spots;
    float mean; // luminance of the radiance to be expected on average
    uint32_t n;
    Cone cones[SHEEN_CONES_MAX];
} Guide;

/**
 * Chooses the spots that would make a gather noisy: seen under less than some strata, but bright enough there to
 * matter. All of them together get at most one ray a stratum.
 * @param mean    luminance of the mean radiance that the gather is expected to find; not learnt from its own rays
 * @param error   relative standard error that is sought
 */
void sheen_guide_choose(const HotSpots *spots, Vec3 p, const Frame *frame, SheenStrata strata, float mean, float error,
                        Guide *out);

/** Rays per steradian that all cones together send along d. */
static inline float guide_density(const Guide *g, Vec3 d)
{
    float sum = 0.0f;
    for (uint32_t i = 0; i < g->n; ++i)
        if (v3_in_cone(d, g->cones[i].axis, g->cones[i].sin2_max)) sum += g->cones[i].density;
    return sum;
}

/** A direction uniform in a cone, in the frame of its axis; may lie below the horizon. */
Vec3 sheen_cone_direction(const Cone *cone, Vec2 u);

/**
 * One direction from a point near the gather's: toward a hot spot or cosine-weighted, as chance will have it.
 * @param frame   about the normal of the point
 * @param choice  in [0, 1); @param u in [0, 1)^2
 * @param d       out: unit, local; may lie below the horizon, with weight 0 then
 * @return cos(theta) / pi over the density with which d is drawn
 */
float sheen_guide_direction(const Guide *guide, Vec3 p, const Frame *frame, float choice, Vec2 u, Vec3 *d);

#endif
