// SPDX-License-Identifier: Apache-2.0
// One direction at a time. The powers of sin(theta) in the zenith factors go to the azimuth: there they turn cos(m phi)
// and sin(m phi) into real and imaginary part of a power of x + i y, and what is left of the zenith factors is a
// polynomial in cos(theta). Neither needs the angles, and both are as exact at the pole as anywhere.
#include "basis/basis.h"

#include "basis/legendre.h"

// sqrt(2) first ratio^(m - 1), complex, at m = 1 .. n - 1; 1 at 0.
static void powers(unsigned n, Vec2 first, Vec2 ratio, float real[], float imaginary[])
{
    real[0] = 1.0f;
    imaginary[0] = 0.0f;
    float c = SHEEN_SQRT2 * first.x, s = SHEEN_SQRT2 * first.y;
    for (unsigned m = 1; m < n; ++m) {
        real[m] = c;
        imaginary[m] = s;
        float turned = c * ratio.x - s * ratio.y;
        s = c * ratio.y + s * ratio.x;
        c = turned;
    }
}

// The functions of one band, or what stands for them: factors of the zenith times those of the azimuth, m >= 0.
static void band(unsigned l, const float zenith[restrict], const float real[restrict], const float imaginary[restrict],
                 float out[restrict])
{
    float *middle = out + basis_index(l, 0);
    for (unsigned m = 1; m <= l; ++m) middle[-(int)m] = zenith[m] * imaginary[m];
    for (unsigned m = 0; m <= l; ++m) middle[m] = zenith[m] * real[m];
}

static void clear(size_t size, float out[])
{
    for (size_t i = 0; i < size; ++i) out[i] = 0.0f;
}

void sheen_basis_zenith(SheenBasis basis, unsigned n, float cos_theta, float out[])
{
    if (!zenith_inside(basis, cos_theta)) {
        clear(basis_zenith_index(n, 0), out);
        return;
    }
    // Not 1 - x^2, which is all rounding where x is near 1.
    float sin_theta = safe_sqrtf((1.0f - cos_theta) * (1.0f + cos_theta));
    sheen_legendre(n, zenith_argument(basis, cos_theta), zenith_scale(basis, cos_theta) * sin_theta,
                   zenith_first(basis), out);
}

void sheen_basis_azimuth(unsigned n, float phi, float out[])
{
    float real[SHEEN_ORDER_MAX], imaginary[SHEEN_ORDER_MAX];
    Vec2 z = v2(cosf(phi), sinf(phi));
    powers(n, z, z, real, imaginary);
    for (unsigned m = 0; m < n; ++m) {
        out[n - 1 - m] = imaginary[m];
        out[n - 1 + m] = real[m];
    }
    out[n - 1] = 1.0f;
}

void sheen_basis_eval(SheenBasis basis, unsigned n, Vec3 w, float out[])
{
    if (!zenith_inside(basis, w.z)) {
        clear(basis_size(n), out);
        return;
    }
    float zenith[SHEEN_ZENITH_MAX], real[SHEEN_ORDER_MAX], imaginary[SHEEN_ORDER_MAX];
    float scale = zenith_scale(basis, w.z);
    Vec2 z = v2(scale * w.x, scale * w.y);
    sheen_legendre(n, zenith_argument(basis, w.z), 1.0f, zenith_first(basis), zenith);
    powers(n, z, z, real, imaginary);
    for (unsigned l = 0; l < n; ++l) band(l, zenith + basis_zenith_index(l, 0), real, imaginary, out);
}

// -2 sqrt(1 - x^2)^(2 - m) dN_l^m/dx for m > 0, from Q_l^m = N_l^m / sqrt(1 - x^2)^m and s2 = 1 - x^2.
static void slopes(unsigned l, float s2, const float q[restrict], float out[restrict])
{
    // Going from m - 1 to m, N gains 1 / sqrt((l + m)(l - m + 1)) in normalisation.
    for (unsigned m = 1; m < l; ++m)
        out[m] =
            sqrtf((float)((l + m + 1) * (l - m))) * s2 * q[m + 1] - sqrtf((float)((l + m) * (l - m + 1))) * q[m - 1];
    out[l] = -sqrtf((float)(2 * l)) * q[l - 1];
}

void sheen_basis_derive(SheenBasis basis, unsigned n, Vec3 w, float by_theta[], float by_phi[])
{
    if (!zenith_inside(basis, w.z)) {
        clear(basis_size(n), by_theta);
        clear(basis_size(n), by_phi);
        return;
    }
    float zenith[SHEEN_ZENITH_MAX], real[SHEEN_ORDER_MAX], imaginary[SHEEN_ORDER_MAX], row[SHEEN_ORDER_MAX];
    float sin_theta = sqrtf(w.x * w.x + w.y * w.y), scale = zenith_scale(basis, w.z), s = scale * sin_theta;
    Vec2 unit = sin_theta > 0.0f ? v2(w.x / sin_theta, w.y / sin_theta) : v2(1.0f, 0.0f);
    sheen_legendre(n, zenith_argument(basis, w.z), 1.0f, zenith_first(basis), zenith);
    // One power of s less than in the functions: it is the division by sin(theta), and by s in dx.
    powers(n, unit, v2(scale * w.x, scale * w.y), real, imaginary);

    // -cos(theta) dx/dtheta / s: cos(theta) for x = cos(theta), and sqrt(cos(theta) (1 + cos(theta))) for twice that
    // minus 1, finite at the horizon where dx/dtheta / s is not.
    float chain = basis == SHEEN_BASIS_SH ? w.z : sqrtf(w.z * (1.0f + w.z));
    by_theta[0] = by_phi[0] = 0.0f;
    for (unsigned l = 1; l < n; ++l) {
        const float *q = zenith + basis_zenith_index(l, 0);
        slopes(l, s * s, q, row);
        for (unsigned m = 1; m <= l; ++m) row[m] *= 0.5f * chain;
        row[0] = chain * sqrtf((float)(l * (l + 1))) * s * q[1];
        band(l, row, real, imaginary, by_theta);
        // d/dphi turns the function of m into -m times that of -m.
        row[0] = 0.0f;
        for (unsigned m = 1; m <= l; ++m) row[m] = (float)m * scale * q[m];
        float *middle = by_phi + basis_index(l, 0);
        for (unsigned m = 0; m <= l; ++m) middle[-(int)m] = row[m] * real[m];
        for (unsigned m = 0; m <= l; ++m) middle[m] = -row[m] * imaginary[m];
    }
}

// Partial sums, so that an addition need not wait for the one before.
Rgb sheen_basis_dot(unsigned n, const float a[], const Rgb b[])
{
    enum { PARTS = 4 };
    Rgb sum[PARTS] = {{0}};
    size_t size = basis_size(n), i = 0;
    for (; i + PARTS <= size; i += PARTS)
        for (size_t k = 0; k < PARTS; ++k) sum[k] = rgb_mad(sum[k], a[i + k], b[i + k]);
    for (; i < size; ++i) sum[0] = rgb_mad(sum[0], a[i], b[i]);
    return rgb_add(rgb_add(sum[0], sum[1]), rgb_add(sum[2], sum[3]));
}
