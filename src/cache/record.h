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
    float R;      // clamped harmonic mean distance, metres: the record reaches a R on a plane
    float a;      // its accuracy: the record is used where w > 1/a
    float R_min;  // the least R that later clamping may set
    float R_sure; // its own radius. Below R_min, R is R_min: farther out it speaks where no other record does
    float error;  // relative standard error of its light
} Record;

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
 * @param d2 squared distance to the shading point; @param cos_n  cosine between the normals
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
 * @param slack  metres, added to the tolerance
 * Source: ward1988, test on d_i(P), there without tolerance.
 */
static inline bool record_in_front(const Record *r, Vec3 p, Vec3 n, float slack)
{
    float d = v3_dot(v3_sub(p, r->p), v3_add(n, r->n)) * 0.5f;
    return d < -0.02f * r->a * r->R - slack;
}

#endif
