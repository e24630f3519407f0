// SPDX-License-Identifier: Apache-2.0
// Sampling flat shapes uniformly over the solid angle that they fill. In double: solid angles are differences of large
// angles, and light sources are small.
#ifndef SHEEN_LIGHT_SPHERICAL_H
#define SHEEN_LIGHT_SPHERICAL_H

#include "math/vec.h"

/** A vector in double, for this folder's geometry. */
typedef struct D3 {
    double x, y, z;
} D3;

static inline D3 d3(double x, double y, double z)
{
    return (D3){x, y, z};
}
static inline D3 d3_sub(Vec3 a, Vec3 b)
{
    return d3((double)a.x - (double)b.x, (double)a.y - (double)b.y, (double)a.z - (double)b.z);
}
static inline D3 d3_scale(D3 a, double s)
{
    return d3(a.x * s, a.y * s, a.z * s);
}
/** a + s b */
static inline D3 d3_mad(D3 a, double s, D3 b)
{
    return d3(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}
static inline double d3_dot(D3 a, D3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline D3 d3_cross(D3 a, D3 b)
{
    return d3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline double d3_length(D3 a)
{
    return sqrt(d3_dot(a, a));
}

/** Points corner + s ex + t ey, s and t in [0, 1], seen from the side of n. */
typedef struct SheenRectangle {
    Vec3 corner, ex, ey;
    Vec3 n;        // unit, ex x ey normalized
    D3 x, y, z;    // unit axes: ex, ey, n
    double lx, ly; // lengths of the edges
    Vec3 center;
    float area, diagonal2; // m^2, squared length of the diagonal
} SheenRectangle;

/** ex and ey are perpendicular and not zero. */
SheenRectangle sheen_rectangle_make(Vec3 corner, Vec3 ex, Vec3 ey);

// From so many diagonals away, squared, the area serves as well as the solid angle, whose arc tangent, sine and cosine
// cost as much as tracing the shadow ray.
#define RECTANGLE_FAR2 2.0f

/** @return true where the rectangle is so far from p that its points are drawn uniformly over the area. */
static inline bool sheen_rectangle_is_far(const SheenRectangle *r, Vec3 p)
{
    return v3_length2(v3_sub(r->center, p)) > RECTANGLE_FAR2 * r->diagonal2;
}

/**
 * A point of the rectangle, uniform over the solid angle seen from p; over the area where that is too small to tell.
 * For points that are not far, but it would be right for those, too.
 * @param st           coordinates of the point on the rectangle, [0, 1]^2
 * @param solid_angle  one over the density, sr
 * @return false when p is not in front of the rectangle
 * Source: urena2013-spherical-rectangle.
 */
bool sheen_rectangle_sample(const SheenRectangle *r, Vec3 p, Vec2 u, Vec2 *st, float *solid_angle);

/** @return the density, 1/sr, with which a rectangle's directions are drawn from p, far or near, for the one to q. */
float sheen_rectangle_pdf(const SheenRectangle *r, Vec3 p, Vec3 q);

/**
 * A point of a triangle, seen from its front, where the vertices run counter-clockwise; uniform over its solid angle,
 * or over its area where it looks small from p.
 * @param b  barycentric coordinates of vertices 1 and 2
 * Source: arvo1995-spherical-triangle.
 */
bool sheen_triangle_sample(const Vec3 v[3], Vec3 p, Vec2 u, Vec2 *b, float *pdf);

/** @return the density, 1/sr, with which sheen_triangle_sample draws the direction from p to q on the triangle. */
float sheen_triangle_pdf(const Vec3 v[3], Vec3 p, Vec3 q);

#endif
