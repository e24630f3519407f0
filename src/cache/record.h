// SPDX-License-Identifier: Apache-2.0
// A record of whatever light: where it was made and where it may be used.
#ifndef SHEEN_CACHE_RECORD_H
#define SHEEN_CACHE_RECORD_H

#include "math/vec.h"

#include <stdbool.h>

/** The least R_sure that a record is given, in units of R_min. */
#define SHEEN_SLIVER 0.1f

typedef struct Record {
    Vec3 p;       // position, world space, metres
    Vec3 n;       // unit normal of the side that is lit
    float R;      // clamped radius, metres: the record reaches a R on a plane
    float a;      // its accuracy: the record is used where w > 1/a
    float R_min;  // the least R that later clamping may set
    float R_sure; // its own radius. Below R_min, R is R_min: farther out it speaks where no other record does
    float error;  // relative standard error of its light
    Vec3 stretch; // in the plane of n: the way in which it reaches farther, see record_elongation; zero: a disc
} Record;

/** The most that an ellipse may be longer than wide. */
#define SHEEN_ASPECT_MAX 2.0f

/** The stretch of an ellipse whose longer radius is `aspect` >= 1 times the shorter. @param axis  unit, along it */
static inline Vec3 record_stretch(Vec3 axis, float aspect)
{
    return v3_scale(axis, safe_sqrtf(1.0f - 1.0f / sqrf(aspect)));
}

/** How many times as far as across a record reaches along its stretch. */
static inline float record_elongation(const Record *r)
{
    return 1.0f / sqrtf(1.0f - v3_length2(r->stretch));
}

/** How far a record reaches on a plane at most, metres. */
static inline float record_reach(const Record *r)
{
    return r->a * r->R * record_elongation(r);
}

/** Squared distance of a point as a record measures it: along its stretch less than it is. */
static inline float record_distance2(const Record *r, Vec3 p)
{
    Vec3 d = v3_sub(p, r->p);
    return v3_length2(d) - sqrf(v3_dot(d, r->stretch));
}

/** Whether the record's own radius is below what the picture resolves. */
static inline bool record_is_enlarged(const Record *r)
{
    return r->R_sure < r->R_min;
}

/** Whether it sees the world through a gap far narrower than a pixel: it knows nothing of what is around. */
static inline bool record_is_sliver(const Record *r)
{
    return r->R_sure <= SHEEN_SLIVER * r->R_min;
}

/**
 * Weight of a record: the inverse of the split-sphere estimate of the interpolation error, without the accuracy a.
 * @param R  the record's radius, metres
 * @param d2 squared distance to the shading point, record_distance2; @param cos_n  cosine between the normals
 * @return   w in (0, inf]; the record may be used while w > 1/a
 * Source: ward1988 eq. (4); krivanek2005-radiance-caching sec. 4.4.
 */
static inline float record_weight(float R, float d2, float cos_n)
{
    return 1.0f / (sqrtf(d2) / R + safe_sqrtf(1.0f - cos_n));
}

/**
 * Whether a point lies so far in front of (or behind) a record's surface that it sees other things than the record.
 * The tolerance of 2 % of the reach a R lets coplanar points pass whatever rounding did to them: an exact test rejects
 * half of them and doubles the number of records.
 * Source: ward1988, test on d_i(P), there without tolerance.
 */
static inline bool record_in_front(const Record *r, Vec3 p, Vec3 n)
{
    float d = v3_dot(v3_sub(p, r->p), v3_add(n, r->n)) * 0.5f;
    return d < -0.02f * r->a * r->R;
}

#endif
