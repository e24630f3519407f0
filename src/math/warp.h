// SPDX-License-Identifier: Apache-2.0
// Maps from the unit square to directions and shapes. u in [0, 1)^2; densities with respect to solid angle or area.
#ifndef SHEEN_MATH_WARP_H
#define SHEEN_MATH_WARP_H

#include "math/vec.h"

#include <stdint.h>

/** Point i of n, a power of 2, that fill the unit square evenly, each alone in its column and row: for quadratures. */
static inline Vec2 warp_hammersley(uint32_t i, uint32_t n)
{
    uint32_t bits = i; // turned round: the radical inverse in base 2
    bits = (bits & 0x55555555u) << 1 | (bits >> 1 & 0x55555555u);
    bits = (bits & 0x33333333u) << 2 | (bits >> 2 & 0x33333333u);
    bits = (bits & 0x0f0f0f0fu) << 4 | (bits >> 4 & 0x0f0f0f0fu);
    bits = (bits & 0x00ff00ffu) << 8 | (bits >> 8 & 0x00ff00ffu);
    bits = bits << 16 | bits >> 16;
    return v2(((float)i + 0.5f) / (float)n, (float)(bits >> 8) * 0x1p-24f + 0.5f / (float)n);
}

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

/**
 * Uniform direction in a cone about +z: density 1/(2 pi height).
 * @param height  1 - cos of the half angle, which keeps narrow cones exact
 */
static inline Vec3 warp_cone(Vec2 u, float height)
{
    float h = u.x * height, r = safe_sqrtf(h * (2.0f - h)), phi = 2.0f * SHEEN_PI * u.y;
    return v3(r * cosf(phi), r * sinf(phi), 1.0f - h);
}

/** Uniform barycentric coordinates (b1, b2) of a triangle: density 1/area. Source: heitz2019-triangle. */
static inline Vec2 warp_triangle(Vec2 u)
{
    if (u.y > u.x) return v2(0.5f * u.x, u.y - 0.5f * u.x);
    return v2(u.x - 0.5f * u.y, 0.5f * u.y);
}

#endif
