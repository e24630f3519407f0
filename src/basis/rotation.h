// SPDX-License-Identifier: Apache-2.0
// Rotation of functions that are given by coefficients, from one frame to another.
//
// A rotation is R = Rz(gamma) Ry(beta) Rz(alpha); a function f becomes (R f)(w) = f(R^-1 w). About z it is exact in
// both bases. The tilt beta is exact in spherical harmonics; in hemispherical ones what it pushes below the horizon is
// lost, what comes up from there is 0, and the edge between is seen through an order n only: of the squares of random
// coefficients of order 10, 92, 79 and 66 per cent are left after 5, 15 and 30 degrees; of the irradiance of an even
// sky, (1 + cos(beta)) / 2, as it must be. A tilt there and back is therefore not the identity, and an inverse is the
// transpose in both bases: (A x) . y = x . (A^T y). Of a record and a lobe, rotate the lobe: one vector instead of
// three colours and their gradients.
//
// Vectors are [n * n][channels]: floats for 1 channel, Rgb for 3.
#ifndef SHEEN_BASIS_ROTATION_H
#define SHEEN_BASIS_ROTATION_H

#include "base/status.h"
#include "basis/basis.h"
#include "math/frame.h"

/** Cosines and sines of the angles of a rotation. */
typedef struct SheenEuler {
    Vec2 alpha, beta, gamma;
} SheenEuler;

/** The rotation that takes a function's coefficients in the one frame to those in the other. */
SheenEuler sheen_euler_between(const Frame *from, const Frame *to);

/** The inverse, which is the transpose of what a rotation does to coefficients. */
static inline SheenEuler euler_inverse(SheenEuler e)
{
    return (SheenEuler){v2(e.gamma.x, -e.gamma.y), v2(e.beta.x, -e.beta.y), v2(e.alpha.x, -e.alpha.y)};
}

/** Rotates about z, in either basis. @param angle  its cosine and sine @param out  may be `in` */
void sheen_rotate_z(unsigned n, Vec2 angle, unsigned channels, const float in[], float out[]);

/** Tables for the rotations of one basis and order. Threads may share them. */
typedef struct SheenRotation SheenRotation;

/** Largest order of hemispherical functions that can be tilted, whose tables grow with its fourth power. */
enum { SHEEN_TILT_ORDER_MAX = 16 };

/**
 * @param n         1 .. SHEEN_ORDER_MAX, or SHEEN_TILT_ORDER_MAX for hemispherical functions
 * @param tilt_max  largest tilt of hemispherical functions, radians, up to pi / 2; there is a matrix for each degree,
 *                  20 kB of order 10
 * @return SHEEN_ERR_INVALID for an order that is out of range, SHEEN_ERR_NOMEM
 */
SHEEN_NODISCARD SheenStatus sheen_rotation_create(SheenBasis basis, unsigned n, float tilt_max, SheenRotation **out);
void sheen_rotation_destroy(SheenRotation **rotation);

/**
 * Rotates coefficients. A hemispherical tilt is interpolated between degrees, which is good to 1 per cent at order 10
 * and to 3 at order 16 (below 1 degree; to a third of that above); one beyond the largest is taken for the largest.
 * @param in, out  [n * n][channels]; may be the same
 */
void sheen_rotation_apply(const SheenRotation *rotation, SheenEuler e, unsigned channels, const float in[],
                          float out[]);

/** The same from a frame to the world's axes. */
static inline void sheen_rotation_to_world(const SheenRotation *rotation, const Frame *from, unsigned channels,
                                           const float in[], float out[])
{
    Frame world = frame_world();
    sheen_rotation_apply(rotation, sheen_euler_between(from, &world), channels, in, out);
}

#endif
