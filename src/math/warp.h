// SPDX-License-Identifier: Apache-2.0
// Maps from the unit square to directions and shapes. u in [0, 1)^2; densities with respect to solid angle or area.
#ifndef SHEEN_MATH_WARP_H
#define SHEEN_MATH_WARP_H

#include "math/vec.h"

/** Concentric map to the unit disk, uniform: density 1/pi. Source: shirley1997-concentric. */
static inline Vec2 warp_disk(Vec2 u)
{
    float x = 2.0f * u.x - 1.0f, y = 2.0f * u.y - 1.0f;
    if (x == 0.0f && y == 0.0f) return v2(0.0f, 0.0f);
    bool wide = fabsf(x) > fabsf(y);
    float r = wide ? x : y;
    float phi = wide ? 0.25f * SHEEN_PI * (y / x) : 0.5f * SHEEN_PI - 0.25f * SHEEN_PI * (x / y);
    return v2(r * cosf(phi), r * sinf(phi));
}

/** Cosine-weighted direction about +z: density cos(theta)/pi. */
static inline Vec3 warp_cosine_hemisphere(Vec2 u)
{
    Vec2 d = warp_disk(u);
    return v3(d.x, d.y, safe_sqrtf(1.0f - d.x * d.x - d.y * d.y));
}

/** Uniform direction: density 1/(4 pi). */
static inline Vec3 warp_sphere(Vec2 u)
{
    float z = 1.0f - 2.0f * u.x, r = safe_sqrtf(1.0f - z * z), phi = 2.0f * SHEEN_PI * u.y;
    return v3(r * cosf(phi), r * sinf(phi), z);
}

/** Uniform direction in the cone of directions with cosine to +z above cos_max: density 1/(2 pi (1 - cos_max)). */
static inline Vec3 warp_cone(Vec2 u, float cos_max)
{
    float z = 1.0f - u.x * (1.0f - cos_max), r = safe_sqrtf(1.0f - z * z), phi = 2.0f * SHEEN_PI * u.y;
    return v3(r * cosf(phi), r * sinf(phi), z);
}

/** Uniform barycentric coordinates (b1, b2) of a triangle: density 1/area. Source: heitz2019-triangle. */
static inline Vec2 warp_triangle(Vec2 u)
{
    if (u.y > u.x) return v2(0.5f * u.x, u.y - 0.5f * u.x);
    return v2(u.x - 0.5f * u.y, 0.5f * u.y);
}

#endif
