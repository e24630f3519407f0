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
    float clearance; // metres off the surface, along ng, where rays leave
} SurfacePoint;

/** Completes a hit. `hit->shape` must not be SHEEN_NONE. Pure, thread-safe. */
void sheen_surface_from_hit(const SheenScene *scene, const Ray *ray, const Hit *hit, SurfacePoint *out);

/**
 * The texture coordinates of a hit, as in SurfacePoint, and the front's normal, not unit, in the shape's own space.
 * @param triangle, u, v  as in Hit; meshes alone ask for them
 * @param p               the point, spheres and disks alone ask for it
 */
Vec2 sheen_surface_uv(const SheenShape *shape, uint32_t triangle, float u, float v, Vec3 p);
Vec3 sheen_surface_front(const SheenShape *shape, uint32_t triangle, Vec3 p);

/**
 * How the surface moves with its texture coordinates: dp/du and dp/dv, world space, metres; v as in `s->uv`. Where a
 * mesh has no texture coordinates, or degenerate ones, any two directions orthogonal to ng and each other, of length 1.
 * For the few materials that need it; pure, thread-safe.
 */
void sheen_surface_tangents(const SheenScene *scene, const SurfacePoint *s, Vec3 *dpdu, Vec3 *dpdv);

/** @return barycentric coordinates of vertices 1 and 2 of a point's foot on a triangle's plane, mesh's own space. */
Vec2 sheen_surface_barycentric(const SheenMesh *mesh, uint32_t triangle, Vec3 p);

/** @return the linear value of a texture at a point: by its uv, or of its mesh's own colours. Pure, thread-safe. */
Rgb sheen_surface_texture(const SheenScene *scene, const SheenTexture *t, const SurfacePoint *s);

/**
 * @param n  geometric normal, on the side to which rays go
 * @return a point off the surface from which a ray on that side does not hit it again. The distance follows the
 * rounding of the coordinates and the size of the primitive, a few millionths of it, whatever the scale of the scene.
 */
static inline Vec3 sheen_surface_leave(const SurfacePoint *s, Vec3 n)
{
    return v3_mad(s->p, s->clearance, n);
}

/**
 * The distance off a surface for a point p on it that no ray has hit.
 * @param n       unit normal
 * @param extent  size of the primitive, or the length of a ray that shall end there when that is more, metres
 */
float sheen_surface_clearance(Vec3 p, Vec3 n, float extent);

/** A ray from `s` in direction d (unit), offset to the side of ng to which d points. */
static inline Ray sheen_surface_ray(const SurfacePoint *s, Vec3 d)
{
    Vec3 n = v3_dot(d, s->ng) >= 0.0f ? s->ng : v3_neg(s->ng);
    return (Ray){sheen_surface_leave(s, n), INFINITY, d};
}

#endif
