// SPDX-License-Identifier: Apache-2.0
// Bases of functions on the sphere and on the hemisphere: real spherical harmonics Y and hemispherical harmonics H.
//
// An order n stands for the bands l = 0 .. n - 1: n * n functions. Function (l, m), |m| <= l, has number l (l + 1) + m.
// Both are products of a factor of the zenith angle and one of the azimuth,
//   Y_l^m = K_l^m P_l^|m|(cos theta) t_m(phi),    H_l^m = sqrt(2) K_l^m P_l^|m|(2 cos theta - 1) t_m(phi),
// with t_0 = 1, t_m = sqrt(2) cos(m phi) for m > 0 and sqrt(2) sin(|m| phi) for m < 0; the Legendre functions P carry
// the Condon-Shortley sign. Both are orthonormal, over the sphere and over the hemisphere z >= 0.
//
// Source: gautron2004-hsh; krivanek2005-radiance-caching sec. 4.1 and appendix.
#ifndef SHEEN_BASIS_BASIS_H
#define SHEEN_BASIS_BASIS_H

#include "math/vec.h"

#include <stddef.h>

/** Largest order, and numbers of functions and of zenith factors that it has. */
enum {
    SHEEN_ORDER_MAX = 32,
    SHEEN_BASIS_MAX = SHEEN_ORDER_MAX * SHEEN_ORDER_MAX,
    SHEEN_ZENITH_MAX = SHEEN_ORDER_MAX * (SHEEN_ORDER_MAX + 1) / 2,
    SHEEN_AZIMUTH_MAX = 2 * SHEEN_ORDER_MAX - 1
};

/** One of the two bases. */
typedef enum SheenBasis { SHEEN_BASIS_HSH, SHEEN_BASIS_SH } SheenBasis;
enum { SHEEN_BASIS_COUNT = 2 };

static inline size_t basis_size(unsigned n)
{
    return (size_t)n * n;
}
static inline size_t basis_index(unsigned l, int m)
{
    return (size_t)((int)(l * (l + 1)) + m);
}
/** Number of the zenith factor of (l, m), m >= 0, among the n (n + 1) / 2 of an order. */
static inline size_t basis_zenith_index(unsigned l, unsigned m)
{
    return (size_t)l * (l + 1) / 2 + m;
}

/**
 * The factors of the zenith angle, normalization included: [n (n + 1) / 2], number basis_zenith_index(l, m).
 * @param cos_theta  in [-1, 1]; below 0 the hemispherical ones are 0
 */
void sheen_basis_zenith(SheenBasis basis, unsigned n, float cos_theta, float out[]);

/** The factors of the azimuth t_m(phi), m = -(n - 1) .. n - 1: [2 n - 1], that of m at m + n - 1. */
void sheen_basis_azimuth(unsigned n, float phi, float out[]);

/** All functions at one direction. @param w  unit @param out  [n * n] */
void sheen_basis_eval(SheenBasis basis, unsigned n, Vec3 w, float out[]);

/**
 * Derivatives at one direction in forms that are finite everywhere.
 * @param by_theta  [n * n] out: cos(theta) d/dtheta
 * @param by_phi    [n * n] out: (1 / sin(theta)) d/dphi
 * Source: krivanek2005-radiance-caching appendix, which misses a factor m for m = l, and divides by zero at the pole;
 * here sqrt(1 - x^2) dP_l^m/dx = -(P_l^{m+1} - (l + m)(l - m + 1) P_l^{m-1}) / 2, and -P_l^1 for m = 0.
 */
void sheen_basis_derive(SheenBasis basis, unsigned n, Vec3 w, float by_theta[], float by_phi[]);

/**
 * Sums of values times functions over many directions, several directions at once.
 * @param w      [count] unit
 * @param value  [count]
 * @param out    [n * n]: sum_k value_k B_i(w_k)
 */
void sheen_basis_project(SheenBasis basis, unsigned n, size_t count, const Vec3 w[], const Rgb value[], Rgb out[]);

/** sum_i a_i b_i: the integral of the product of two functions, such as a lobe and radiance. @param a, b  [n * n] */
Rgb sheen_basis_dot(unsigned n, const float a[], const Rgb b[]);

#endif
