// SPDX-License-Identifier: Apache-2.0
// The harmonics in double precision, straight from their definition, and quadratures: what the tests compare with.
#ifndef SHEEN_TESTS_BASIS_KIT_H
#define SHEEN_TESTS_BASIS_KIT_H

#include "base/hash.h"
#include "basis/basis.h"

#include <math.h>

typedef struct Direction {
    double x, y, z;
} Direction;

static inline Direction direction(double theta, double phi)
{
    return (Direction){sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
}
static inline Vec3 to_vec3(Direction d)
{
    return v3((float)d.x, (float)d.y, (float)d.z);
}
/** Of the very floats, made unit. */
static inline Direction from_vec3(Vec3 w)
{
    double x = (double)w.x, y = (double)w.y, z = (double)w.z, length = sqrt(x * x + y * y + z * z);
    return (Direction){x / length, y / length, z / length};
}

/** P_l^m(x), m >= 0, with the Condon-Shortley sign; s = sqrt(1 - x^2). */
static inline double kit_legendre(int l, int m, double x, double s)
{
    double before = 0.0, p = 1.0;
    for (int k = 1; k <= m; ++k) p *= -(2 * k - 1) * s;
    for (int k = m + 1; k <= l; ++k) {
        double next = ((2 * k - 1) * x * p - (k + m - 1) * before) / (k - m);
        before = p;
        p = next;
    }
    return p;
}

/** K_l^m P_l^m at the argument of the basis, l = m .. n - 1, with the hemispherical ones' sqrt(2). @param out  at l */
static inline void kit_zenith(SheenBasis basis, int n, int m, double cos_theta, double sin_theta, double out[])
{
    bool hemisphere = basis == SHEEN_BASIS_HSH;
    double x = hemisphere ? 2 * cos_theta - 1 : cos_theta, before = 0.0;
    double s = hemisphere && sin_theta > 0 ? 2 * sin_theta * sqrt(cos_theta / (1 + cos_theta)) : sin_theta;
    double p = kit_legendre(m, m, x, s);
    for (int l = m; l < n; ++l) {
        double k2 = (hemisphere ? 2 : 1) * (2 * l + 1) / (4 * M_PI);
        for (int i = 1; i <= 2 * m; ++i) k2 /= l - m + i;
        out[l] = sqrt(k2) * p;
        double next = ((2 * l + 1) * x * p - (l + m) * before) / (l + 1 - m);
        before = p;
        p = next;
    }
}

/** All functions; 0 below the horizon for the hemispherical ones. */
static inline void kit_eval(SheenBasis basis, unsigned n, Direction w, double out[])
{
    double sin_theta = sqrt(w.x * w.x + w.y * w.y), phi = atan2(w.y, w.x), zenith[SHEEN_ORDER_MAX];
    for (int m = 0; m < (int)n; ++m) {
        double c = m ? M_SQRT2 * cos(m * phi) : 1.0, s = M_SQRT2 * sin(m * phi);
        if (basis == SHEEN_BASIS_HSH && w.z < 0) c = s = 0.0;
        kit_zenith(basis, (int)n, m, fmax(w.z, basis == SHEEN_BASIS_HSH ? 0.0 : -1.0), sin_theta, zenith);
        for (int l = m; l < (int)n; ++l) {
            if (m) out[basis_index((unsigned)l, -m)] = s * zenith[l];
            out[basis_index((unsigned)l, m)] = c * zenith[l];
        }
    }
}

/** Nodes in (-1, 1) and weights of the Gauss-Legendre rule of n points, exact for polynomials up to 2 n - 1. */
static inline void kit_gauss(int n, double node[], double weight[])
{
    for (int i = 0; i < n; ++i) {
        double x = cos(M_PI * (i + 0.75) / (n + 0.5)), slope = 1.0;
        for (int step = 0; step < 20; ++step) {
            double p = kit_legendre(n, 0, x, 0.0);
            slope = n * (x * p - kit_legendre(n - 1, 0, x, 0.0)) / (x * x - 1);
            x -= p / slope;
        }
        node[i] = x;
        weight[i] = 2 / ((1 - x * x) * slope * slope);
    }
}

/** Uniform on the sphere, or on the upper hemisphere; number i of a fixed sequence. */
static inline Vec3 kit_direction(SheenBasis basis, uint32_t i)
{
    double u = (double)hash_to_unit(hash_u32(2 * i + 1)), v = (double)hash_to_unit(hash_u32(2 * i + 2));
    return to_vec3(direction(acos(basis == SHEEN_BASIS_SH ? 2 * u - 1 : u), 2 * M_PI * v));
}

#endif
