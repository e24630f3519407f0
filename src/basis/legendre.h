// SPDX-License-Identifier: Apache-2.0
// Normalised associated Legendre functions, the zenith factors of both bases.
//
//   N_l^m(x) = K_l^m P_l^m(x), 0 <= m <= l, with K_l^m = sqrt((2 l + 1) / (4 pi) (l - m)! / (l + m)!)
//
// and the Condon-Shortley sign in P. Normalisation is part of the recurrence, so that neither factorials nor powers
// leave the range of floats:
//
//   N_m^m = a_m^m sqrt(1 - x^2) N_{m-1}^{m-1},    N_l^m = a_l^m x N_{l-1}^m - b_l^m N_{l-2}^m    (b_{m+1}^m = 0).
//
// The test checks the coefficients against their formulas.
#ifndef SHEEN_BASIS_LEGENDRE_H
#define SHEEN_BASIS_LEGENDRE_H

#include "basis/basis.h"

/** K_0^0 = 1 / sqrt(4 pi): N_0^0. */
#define SHEEN_LEGENDRE_FIRST 0.282094791773878143f

#define SHEEN_SQRT2 1.41421356237309505f

/** sqrt((4 l^2 - 1) / (l^2 - m^2)), and -sqrt((2 m + 1) / (2 m)) for l = m > 0; number basis_zenith_index(l, m). */
extern const float sheen_legendre_a[SHEEN_ZENITH_MAX];
/** a_l^m / a_{l-1}^m, and 0 for m >= l - 1. */
extern const float sheen_legendre_b[SHEEN_ZENITH_MAX];

/**
 * first / N_0^0 times N_l^m, for s = sqrt(1 - x^2); the same divided by sqrt(1 - x^2)^m, a polynomial, for s = 1.
 * @param out  [n (n + 1) / 2], number basis_zenith_index(l, m)
 */
void sheen_legendre(unsigned n, float x, float s, float first, float out[]);

/** The zenith factor of (l, m) is zenith_first / N_0^0 times N_l^m at zenith_argument. */
static inline float zenith_first(SheenBasis basis)
{
    return basis == SHEEN_BASIS_HSH ? SHEEN_SQRT2 * SHEEN_LEGENDRE_FIRST : SHEEN_LEGENDRE_FIRST;
}
static inline float zenith_argument(SheenBasis basis, float cos_theta)
{
    return basis == SHEEN_BASIS_HSH ? 2.0f * cos_theta - 1.0f : cos_theta;
}
/** sqrt(1 - x^2) / sin(theta) for that argument x; cos_theta >= 0 for hemispherical ones. */
static inline float zenith_scale(SheenBasis basis, float cos_theta)
{
    return basis == SHEEN_BASIS_HSH ? 2.0f * sqrtf(cos_theta / (1.0f + cos_theta)) : 1.0f;
}
/** Whether the functions are not all 0. */
static inline bool zenith_inside(SheenBasis basis, float cos_theta)
{
    return basis == SHEEN_BASIS_SH || cos_theta >= 0.0f;
}

#endif
