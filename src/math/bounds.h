// SPDX-License-Identifier: Apache-2.0
// Axis-aligned boxes.
#ifndef SHEEN_MATH_BOUNDS_H
#define SHEEN_MATH_BOUNDS_H

#include "math/vec.h"

typedef struct Bounds {
    Vec3 lo, hi; // empty when lo > hi on any axis
} Bounds;

static inline Bounds bounds_empty(void)
{
    return (Bounds){v3(INFINITY, INFINITY, INFINITY), v3(-INFINITY, -INFINITY, -INFINITY)};
}
static inline bool bounds_is_empty(const Bounds *b)
{
    return b->lo.x > b->hi.x || b->lo.y > b->hi.y || b->lo.z > b->hi.z;
}
static inline Bounds bounds_add(Bounds b, Vec3 p)
{
    return (Bounds){v3_min(b.lo, p), v3_max(b.hi, p)};
}
static inline Bounds bounds_union(Bounds a, Bounds b)
{
    return (Bounds){v3_min(a.lo, b.lo), v3_max(a.hi, b.hi)};
}
static inline Vec3 bounds_center(const Bounds *b)
{
    return v3_scale(v3_add(b->lo, b->hi), 0.5f);
}
/** Radius of the sphere about the centre that holds the box; 0 when empty. */
static inline float bounds_radius(const Bounds *b)
{
    return bounds_is_empty(b) ? 0.0f : 0.5f * v3_length(v3_sub(b->hi, b->lo));
}

/** @return distance in units of d at which a ray from p along d leaves the box for good; 0 when it misses it. */
static inline float bounds_exit(const Bounds *b, Vec3 p, Vec3 d)
{
    Vec3 far = v3(d.x > 0.0f ? b->hi.x : b->lo.x, d.y > 0.0f ? b->hi.y : b->lo.y, d.z > 0.0f ? b->hi.z : b->lo.z);
    float t = INFINITY;
    if (d.x != 0.0f) t = minf(t, (far.x - p.x) / d.x);
    if (d.y != 0.0f) t = minf(t, (far.y - p.y) / d.y);
    if (d.z != 0.0f) t = minf(t, (far.z - p.z) / d.z);
    return t > 0.0f && isfinite(t) ? t : 0.0f;
}

#endif
