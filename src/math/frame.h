// SPDX-License-Identifier: Apache-2.0
// An orthonormal frame about a normal: t x b = n. Local vectors (suffix _l) have z along n.
#ifndef SHEEN_MATH_FRAME_H
#define SHEEN_MATH_FRAME_H

#include "math/vec.h"

typedef struct Frame {
    Vec3 t, b, n;
} Frame;

/** Cosine from which on two normals count as the same: half a degree. */
#define SHEEN_SAME_COS 0.99996f

/** The world's own axes. */
static inline Frame frame_world(void)
{
    return (Frame){v3(1.0f, 0.0f, 0.0f), v3(0.0f, 1.0f, 0.0f), v3(0.0f, 0.0f, 1.0f)};
}

/** A frame about the unit vector n, the same for the same n. Source: duff2017-onb, listing 3. */
static inline Frame frame_from_normal(Vec3 n)
{
    float s = copysignf(1.0f, n.z);
    float a = -1.0f / (s + n.z);
    float c = n.x * n.y * a;
    return (Frame){v3(1.0f + s * n.x * n.x * a, s * c, -s * n.x), v3(c, s + n.y * n.y * a, -n.y), n};
}
static inline Vec3 frame_to_world(const Frame *f, Vec3 v_l)
{
    return v3_mad(v3_mad(v3_scale(f->n, v_l.z), v_l.y, f->b), v_l.x, f->t);
}
static inline Vec3 frame_to_local(const Frame *f, Vec3 v)
{
    return v3(v3_dot(v, f->t), v3_dot(v, f->b), v3_dot(v, f->n));
}

#endif
