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

/** The least R of a record. @param footprint  side of a pixel there, metres */
static inline float record_least_radius(const SheenOptions *o, float footprint)
{
    return SHEEN_REACH_MIN_PX * footprint / o->accuracy;
}

/** The largest radius that a record may have been enlarged to, to serve a point: twice what its own picture would
 * enlarge it to. Records made from afar give way to finer ones when the camera comes near. */
static inline float record_most_enlarged(const SheenOptions *o, float footprint)
{
    return 2.0f * record_least_radius(o, footprint);
}

/** Sets the radii of a record whose own is R. */
static inline void record_set_radius(const SheenOptions *o, float footprint, float R, Record *r)
{
    r->R_min = record_least_radius(o, footprint);
    r->R = clampf(R, r->R_min, SHEEN_REACH_MAX_PX * footprint / o->accuracy);
    r->R_sure = maxf(R, SHEEN_SLIVER * r->R_min);
}

#endif
