// SPDX-License-Identifier: Apache-2.0
// A hit becomes a point on a surface; rays leave it without hitting it again.
#ifndef SHEEN_RAY_SURFACE_H
#define SHEEN_RAY_SURFACE_H

#include "ray/accel.h"

/** A point on a surface, world space. */
typedef struct SurfacePoint {
    Vec3 p;         // on the surface to within rounding (from barycentric coordinates, not from the ray)
    Vec3 ng;        // unit geometric normal of the front side
    Vec3 ns;        // unit shading normal, in the hemisphere of ng
    Vec2 uv;        // texture coordinates; barycentric (u, v) when a mesh has none
    uint32_t shape; // index into scene->shapes
    uint32_t triangle;
    uint32_t instance;
} SurfacePoint;

/** Completes a hit. `hit->shape` must not be SHEEN_NONE. Pure, thread-safe. */
void sheen_surface_from_hit(const SheenScene *scene, const Ray *ray, const Hit *hit, SurfacePoint *out);

/**
 * Moves p off its surface, along `n`, by a few units in the last place of its coordinates: far enough that a ray from
 * there does not hit the surface it left, near enough that nothing fits between at any scale.
 * @param n  geometric normal, on the side to which the ray goes
 * Source: waechter2019-offset, ch. 6.
 */
Vec3 sheen_surface_offset(Vec3 p, Vec3 n);

/** A ray from `s` in direction d (unit), offset to the side of ng to which d points. */
static inline Ray sheen_surface_ray(const SurfacePoint *s, Vec3 d)
{
    Vec3 n = v3_dot(d, s->ng) >= 0.0f ? s->ng : v3_neg(s->ng);
    return (Ray){sheen_surface_offset(s->p, n), INFINITY, d};
}

#endif
