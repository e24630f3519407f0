// SPDX-License-Identifier: Apache-2.0
// The radius of a record, bounded by what the picture resolves.
#ifndef SHEEN_INTEGRATOR_RECORD_RADIUS_H
#define SHEEN_INTEGRATOR_RECORD_RADIUS_H

#include "cache/record.h"
#include "gather/hessian.h"
#include "integrator/work.h"
#include "math/frame.h"

/** The least R of a record of accuracy a. @param footprint  side of a pixel there, metres */
static inline float record_least_radius(const SheenOptions *o, float a, float footprint)
{
    return o->reach_min * footprint / a;
}

/** How far a record that was enlarged may reach to serve a point, metres: twice as far as the point's own picture would
 * have enlarged it. Records made from afar give way to finer ones when the camera comes near. */
static inline float record_most_enlarged(const SheenOptions *o, float footprint)
{
    return 2.0f * o->reach_min * footprint;
}

/** Sets the radii of a record of its accuracy whose own is R. */
static inline void record_set_radius(const SheenOptions *o, float footprint, float R, Record *r)
{
    r->R_min = record_least_radius(o, r->a, footprint);
    r->R = clampf(R, r->R_min, o->reach_max * footprint / r->a);
    r->R_sure = maxf(R, SHEEN_SLIVER * r->R_min);
}

// Light that is extrapolated by its value and gradient over an ellipse at the accuracy a is off in the mean by this
// times a^2 of itself.
#define SHEEN_HESSIAN_ERROR 0.2f

/**
 * The same of an ellipse. Neither radius is more than the picture has use for; and the longer, which noise reaches
 * more, not more than twice the shorter.
 * @param frame  the record's, in which `e` is
 */
static inline void record_set_ellipse(const SheenOptions *o, float footprint, const Frame *frame,
                                      const HessianEllipse *e, Record *r)
{
    record_set_radius(o, footprint, e->radius[0], r);
    float longer = clampf(e->radius[1], r->R, o->reach_max * footprint / r->a);
    Vec3 axis = frame_to_world(frame, v3(-e->sin_axis, e->cos_axis, 0.0f));
    r->stretch = record_stretch(axis, minf(longer / r->R, SHEEN_ASPECT_MAX));
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
