// SPDX-License-Identifier: Apache-2.0
// Polygons become triangles.
#ifndef SHEEN_IO_POLYGON_H
#define SHEEN_IO_POLYGON_H

#include "math/vec.h"

#include <stdbool.h>
#include <stdint.h>

/**
 * Cuts a polygon into n - 2 triangles that run round the same way. A convex polygon becomes a fan about its first
 * corner; one with corners that point inward is cut ear by ear in the plane of its mean normal. A polygon that crosses
 * itself, lies in no plane, or has more than 4,096 corners is cut into triangles all the same, which may overlap.
 * @param p          [n] corners, n >= 3; may hold anything, non-finite numbers too
 * @param triangles  [n - 2] indices into p
 * @return false when out of memory
 * Source: meisters1975-ears.
 */
bool sheen_polygon_cut(const Vec3 p[], uint32_t n, uint32_t (*triangles)[3]);

#endif
