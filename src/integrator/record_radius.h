// SPDX-License-Identifier: Apache-2.0
// The radius of a record, bounded by what the picture resolves.
#ifndef SHEEN_INTEGRATOR_RECORD_RADIUS_H
#define SHEEN_INTEGRATOR_RECORD_RADIUS_H

#include "cache/record.h"
#include "integrator/work.h"

// The reach a R of a record on a plane, in pixels. Below the least nothing is seen, above the most one record's noise
// would spread over a wide disc.
#define SHEEN_REACH_MIN_PX 4.0f
#define SHEEN_REACH_MAX_PX 25.0f

/** The least R of a record of accuracy a. @param footprint  side of a pixel there, metres */
static inline float record_least_radius(float a, float footprint)
{
    return SHEEN_REACH_MIN_PX * footprint / a;
}

/** How far a record that was enlarged may reach to serve a point, metres: twice as far as the point's own picture would
 * have enlarged it. Records made from afar give way to finer ones when the camera comes near. */
static inline float record_most_enlarged(float footprint)
{
    return 2.0f * SHEEN_REACH_MIN_PX * footprint;
}

/** Sets the radii of a record of its accuracy whose own is R. */
static inline void record_set_radius(float footprint, float R, Record *r)
{
    r->R_min = record_least_radius(r->a, footprint);
    r->R = clampf(R, r->R_min, SHEEN_REACH_MAX_PX * footprint / r->a);
    r->R_sure = maxf(R, SHEEN_SLIVER * r->R_min);
}

// Adaptive caching: records begin with --accuracy, or with what their neighbors came to, and become more accurate where
// they disagree with others. To begin with more, as the paper does, was worse: coarse records that differ from fine
// ones by less than noise explains leave borders between the two.
#define SHEEN_ACCURACY_LEAST 0.25f // times --accuracy
#define SHEEN_ACCURACY_GROWS 1.4f  // times that of the nearest record; krivanek2006-making-caching-practical sec. 4.2

/** The accuracy that a record begins with. @param nearest  that of the nearest record, 0 where there is none */
static inline float record_first_accuracy(const SheenOptions *o, float nearest)
{
    return o->adaptive && nearest > 0.0f ? minf(SHEEN_ACCURACY_GROWS * nearest, o->accuracy) : o->accuracy;
}

/** The least a that refinement may set. */
static inline float record_least_accuracy(const SheenOptions *o, const Record *r)
{
    return maxf(SHEEN_ACCURACY_LEAST * o->accuracy, r->a * r->R_min / r->R);
}

#endif
