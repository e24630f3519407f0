// SPDX-License-Identifier: Apache-2.0
// Affine transforms, in double so that long chains in scene files stay exact enough.
#ifndef SHEEN_MATH_TRANSFORM_H
#define SHEEN_MATH_TRANSFORM_H

#include "math/vec.h"

/** Row-major 4 x 4 matrix acting on column vectors; rows 0..2 hold the affine part. */
typedef struct Transform {
    double m[4][4];
} Transform;

Transform transform_identity(void);
Transform transform_translate(double x, double y, double z);
Transform transform_scale(double x, double y, double z);
/** Right-handed rotation by `angle` radians about `axis` (any length but zero; zero gives the identity). */
Transform transform_rotate(Vec3 axis, double angle);
/** Camera-to-world: z from origin to target, y as near `up` as possible, x = up x z (to the left in the picture). */
Transform transform_look_at(Vec3 origin, Vec3 target, Vec3 up);
/** a b: b is applied first. */
Transform transform_mul(Transform a, Transform b);
/** @return false, and *out the identity, when the matrix is singular or not finite. */
bool transform_invert(const Transform *t, Transform *out);
/** Determinant of the linear part; negative when the transform mirrors. */
double transform_determinant(const Transform *t);

Vec3 transform_point(const Transform *t, Vec3 p);
Vec3 transform_vector(const Transform *t, Vec3 v);
/** Normals go with the inverse transpose: pass the inverse of the transform. The result is normalized. */
Vec3 transform_normal(const Transform *inverse, Vec3 n);

#endif
