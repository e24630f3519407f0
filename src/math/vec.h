// SPDX-License-Identifier: Apache-2.0
// Vectors and colours. Light and geometry are different types, so that adding a radiance to a position does not
// compile.
#ifndef SHEEN_MATH_VEC_H
#define SHEEN_MATH_VEC_H

#include <math.h>
#include <stdbool.h>

#define SHEEN_PI 3.14159265358979323846f
#define SHEEN_INV_PI 0.31830988618379067154f

typedef struct Vec2 {
    float x, y;
} Vec2;

typedef struct Vec3 {
    float x, y, z;
} Vec3;

/** A radiometric or reflectance value in linear sRGB primaries; the unit stands where it is used. */
typedef struct Rgb {
    float r, g, b;
} Rgb;

_Static_assert(sizeof(Vec3) == 12, "shared with Embree as RTC_FORMAT_FLOAT3");
_Static_assert(sizeof(Rgb) == 12, "pixel arrays are [height][width][3] floats");

static inline float minf(float a, float b)
{
    return a < b ? a : b;
}
static inline float maxf(float a, float b)
{
    return a > b ? a : b;
}
static inline float clampf(float x, float lo, float hi)
{
    return x < lo ? lo : x > hi ? hi : x;
}
/** x in [0, 1]; a NaN becomes 0. */
static inline float unit_or_zero(float x)
{
    return x > 0.0f ? minf(x, 1.0f) : 0.0f;
}
/** Rises from 0 at 0 to 1 at 1, level at both ends, and stays there. */
static inline float smoothstep(float x)
{
    x = unit_or_zero(x);
    return x * x * (3.0f - 2.0f * x);
}
static inline float sqrf(float x)
{
    return x * x;
}
/** sqrt that takes a slightly negative argument, a rounding error, for zero. */
static inline float safe_sqrtf(float x)
{
    return sqrtf(maxf(x, 0.0f));
}
static inline float lerpf(float a, float b, float t)
{
    return a + (b - a) * t;
}

static inline Vec2 v2(float x, float y)
{
    return (Vec2){x, y};
}

static inline Vec3 v3(float x, float y, float z)
{
    return (Vec3){x, y, z};
}
static inline Vec3 v3_add(Vec3 a, Vec3 b)
{
    return v3(a.x + b.x, a.y + b.y, a.z + b.z);
}
static inline Vec3 v3_sub(Vec3 a, Vec3 b)
{
    return v3(a.x - b.x, a.y - b.y, a.z - b.z);
}
static inline Vec3 v3_scale(Vec3 a, float s)
{
    return v3(a.x * s, a.y * s, a.z * s);
}
/** a + s b */
static inline Vec3 v3_mad(Vec3 a, float s, Vec3 b)
{
    return v3(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}
static inline Vec3 v3_neg(Vec3 a)
{
    return v3(-a.x, -a.y, -a.z);
}
static inline float v3_dot(Vec3 a, Vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline Vec3 v3_cross(Vec3 a, Vec3 b)
{
    return v3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline float v3_length2(Vec3 a)
{
    return v3_dot(a, a);
}
static inline float v3_length(Vec3 a)
{
    return sqrtf(v3_length2(a));
}
/** @return a / |a|; the zero vector stays zero. */
/**
 * @return whether d points into the cone about `axis`, both unit; by the sine of the half angle, which is below 90
 * degrees, since the cosine of a narrow cone is not exact.
 */
static inline bool v3_in_cone(Vec3 d, Vec3 axis, float sin2)
{
    return v3_dot(d, axis) > 0.0f && v3_length2(v3_cross(d, axis)) <= sin2;
}
static inline Vec3 v3_normalize(Vec3 a)
{
    float l = v3_length(a);
    return l > 0.0f ? v3_scale(a, 1.0f / l) : a;
}
static inline Vec3 v3_min(Vec3 a, Vec3 b)
{
    return v3(minf(a.x, b.x), minf(a.y, b.y), minf(a.z, b.z));
}
static inline Vec3 v3_max(Vec3 a, Vec3 b)
{
    return v3(maxf(a.x, b.x), maxf(a.y, b.y), maxf(a.z, b.z));
}
static inline bool v3_finite(Vec3 a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}
/** Mirror direction of w, unit and pointing away from the surface, about the unit normal n. */
static inline Vec3 v3_reflect(Vec3 w, Vec3 n)
{
    return v3_mad(v3_neg(w), 2.0f * v3_dot(w, n), n);
}

static inline Rgb rgb(float r, float g, float b)
{
    return (Rgb){r, g, b};
}
static inline Rgb rgb_gray(float v)
{
    return (Rgb){v, v, v};
}
static inline Rgb rgb_add(Rgb a, Rgb b)
{
    return rgb(a.r + b.r, a.g + b.g, a.b + b.b);
}
static inline Rgb rgb_sub(Rgb a, Rgb b)
{
    return rgb(a.r - b.r, a.g - b.g, a.b - b.b);
}
static inline Rgb rgb_mul(Rgb a, Rgb b)
{
    return rgb(a.r * b.r, a.g * b.g, a.b * b.b);
}
static inline Rgb rgb_scale(Rgb a, float s)
{
    return rgb(a.r * s, a.g * s, a.b * s);
}
/** a + s b */
static inline Rgb rgb_mad(Rgb a, float s, Rgb b)
{
    return rgb(a.r + s * b.r, a.g + s * b.g, a.b + s * b.b);
}
static inline float rgb_max(Rgb a)
{
    return maxf(a.r, maxf(a.g, a.b));
}
/** Each channel in [0, 1]; a NaN becomes 0. Reflectances beyond would make energy out of nothing. */
static inline Rgb rgb_unit(Rgb a)
{
    return rgb(unit_or_zero(a.r), unit_or_zero(a.g), unit_or_zero(a.b));
}
static inline bool rgb_is_black(Rgb a)
{
    return a.r == 0.0f && a.g == 0.0f && a.b == 0.0f;
}
static inline bool rgb_finite(Rgb a)
{
    return isfinite(a.r) && isfinite(a.g) && isfinite(a.b);
}
/** Luminance of linear sRGB primaries, Rec. 709 weights. */
static inline float rgb_luminance(Rgb a)
{
    return 0.2126f * a.r + 0.7152f * a.g + 0.0722f * a.b;
}

#endif
