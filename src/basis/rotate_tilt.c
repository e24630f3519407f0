// SPDX-License-Identifier: Apache-2.0
// The tilt of hemispherical harmonics by matrices for each degree,
//
//   M_ij = integral of H_i(w) H_j(Ry(beta)^-1 w) over the w for which both w and Ry(beta)^-1 w are above the horizon.
//
// A function that is even in y stays so: M is a block of the cosines and one of the sines, and its integral is twice
// that over y > 0. There w = (sin t cos p, cos t, sin t sin p), 0 < t < pi / 2 and 0 < p < pi - beta. H behaves like
// a root of the height above the horizon, for odd m; with t = u^2 pi / 2 and p = (pi - beta)(3 v^2 - 2 v^3) the
// integrand is smooth in u and v, and a Gauss-Legendre rule gets it to the last bits of floats.
#include "basis/rotation_tables.h"

#include "math/quadrature.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    LANES = 8,
    BLOCK_MAX = SHEEN_TILT_ORDER_MAX * (SHEEN_TILT_ORDER_MAX + 1) / 2 + LANES, // rows, with padding
    POINTS_MAX = 4 * SHEEN_TILT_ORDER_MAX
};
#define DEGREE ((float)(M_PI / 180))

// Number of cosines, m = 0 .. l, and of sines, m = 1 .. l; number zenith_index(l, m) and zenith_index(l - 1, m - 1).
static unsigned cosines(unsigned n)
{
    return n * (n + 1) / 2;
}
static unsigned sines(unsigned n)
{
    return n * (n - 1) / 2;
}
// A block is stored column by column, padded to whole vectors, and to a multiple of four columns, by zeros.
static size_t padded_rows(unsigned rows)
{
    return (rows + LANES - 1) / LANES * LANES;
}
static size_t block_size(unsigned rows)
{
    return padded_rows(rows) * ((rows + 3) / 4 * 4);
}
static size_t matrix_size(unsigned n)
{
    return block_size(cosines(n)) + block_size(sines(n));
}

static void split(unsigned n, unsigned stride, const float in[], float cosine[], float sine[])
{
    for (unsigned l = 0; l < n; ++l)
        for (unsigned m = 0; m <= l; ++m) {
            cosine[basis_zenith_index(l, m)] = in[basis_index(l, (int)m) * stride];
            if (m > 0) sine[basis_zenith_index(l - 1, m - 1)] = in[basis_index(l, -(int)m) * stride];
        }
}

static void join(unsigned n, unsigned stride, const float cosine[], const float sine[], float out[])
{
    for (unsigned l = 0; l < n; ++l)
        for (unsigned m = 0; m <= l; ++m) {
            out[basis_index(l, (int)m) * stride] = cosine[basis_zenith_index(l, m)];
            if (m > 0) out[basis_index(l, -(int)m) * stride] = sine[basis_zenith_index(l - 1, m - 1)];
        }
}

// ---- the matrices -----------------------------------------------------------------------------------------------

// A rule for [0, 1].
typedef struct Rule {
    unsigned n;
    double node[POINTS_MAX], weight[POINTS_MAX];
} Rule;

static void make_rule(unsigned n, Rule *r)
{
    r->n = n;
    sheen_quadrature_gauss(n, r->node, r->weight);
}

// Adds weight a b^T to a block. @param a, b  followed by zeros
static void add_product(unsigned rows, float weight, const float a[restrict], const float b[restrict],
                        float *restrict matrix)
{
    size_t padded = padded_rows(rows);
    for (unsigned column = 0; column < rows; ++column, matrix += padded) {
        float factor = weight * b[column];
        for (size_t k = 0; k < padded; ++k) matrix[k] += a[k] * factor;
    }
}

static void fill_matrix(unsigned n, double beta, const Rule *across, const Rule *along, float matrix[])
{
    float h[SHEEN_TILT_ORDER_MAX * SHEEN_TILT_ORDER_MAX];
    float cosine[2][BLOCK_MAX] = {{0}}, sine[2][BLOCK_MAX] = {{0}};
    float *sine_block = matrix + block_size(cosines(n));
    for (unsigned i = 0; i < across->n; ++i)
        for (unsigned k = 0; k < along->n; ++k) {
            double u = across->node[i], v = along->node[k], t = 0.5 * M_PI * u * u;
            double p = (M_PI - beta) * v * v * (3 - 2 * v), r = sin(t);
            double weight = 2 * r * across->weight[i] * M_PI * u * along->weight[k] * (M_PI - beta) * 6 * v * (1 - v);
            sheen_basis_eval(SHEEN_BASIS_HSH, n, v3((float)(r * cos(p)), (float)cos(t), (float)(r * sin(p))), h);
            split(n, 1, h, cosine[0], sine[0]);
            p += beta; // Ry(beta) takes z to x: before, this direction was higher
            sheen_basis_eval(SHEEN_BASIS_HSH, n, v3((float)(r * cos(p)), (float)cos(t), (float)(r * sin(p))), h);
            split(n, 1, h, cosine[1], sine[1]);
            add_product(cosines(n), (float)weight, cosine[0], cosine[1], matrix);
            add_product(sines(n), (float)weight, sine[0], sine[1], sine_block);
        }
}

static void fill_identity(unsigned rows, float *matrix)
{
    for (unsigned i = 0; i < rows; ++i) matrix[i * padded_rows(rows) + i] = 1.0f;
}

SheenStatus sheen_tilt_create(unsigned n, float tilt_max, SheenTilt *out)
{
    float degrees = tilt_max / DEGREE;
    out->degrees = degrees > 1.0f ? (unsigned)ceilf(minf(degrees, 90.0f) - 1e-3f) : 1; // 25.000001 is 25
    out->matrix = calloc((size_t)(out->degrees + 1) * matrix_size(n), sizeof *out->matrix);
    if (!out->matrix) return SHEEN_ERR_NOMEM;
    fill_identity(cosines(n), out->matrix);
    fill_identity(sines(n), out->matrix + block_size(cosines(n)));
    Rule across, along; // measured: fewer points leave more than floats do, 5e-6
    make_rule(2 * n + 4, &across);
    make_rule(7 * n / 2 + 8, &along);
    for (unsigned d = 1; d <= out->degrees; ++d)
        fill_matrix(n, d * M_PI / 180, &across, &along, out->matrix + d * matrix_size(n));
    return SHEEN_OK;
}

// ---- rotation ---------------------------------------------------------------------------------------------------

// Adds a block times factor x. Four columns at once: their sums are in memory.
static void multiply(unsigned rows, const float *restrict matrix, float factor, const float x[restrict],
                     float sum[restrict])
{
    size_t padded = padded_rows(rows);
    for (unsigned column = 0; column < rows; column += 4, matrix += 4 * padded) {
        const float *a = matrix, *b = a + padded, *c = b + padded, *d = c + padded;
        float xa = factor * x[column], xb = factor * x[column + 1];
        float xc = factor * x[column + 2], xd = factor * x[column + 3];
        for (size_t k = 0; k < padded; ++k) sum[k] += (a[k] * xa + b[k] * xb) + (c[k] * xc + d[k] * xd);
    }
}

// A tilt the other way is the same between two half turns about z.
static void half_turn(unsigned n, float cosine[], float sine[])
{
    for (unsigned l = 1; l < n; ++l)
        for (unsigned m = 1; m <= l; m += 2) {
            cosine[basis_zenith_index(l, m)] *= -1.0f;
            sine[basis_zenith_index(l - 1, m - 1)] *= -1.0f;
        }
}

void sheen_tilt_rotate(const SheenTilt *tilt, unsigned n, Vec2 beta, unsigned stride, float x[])
{
    float angle = atan2f(fabsf(beta.y), beta.x) / DEGREE;
    if (!(angle > 1e-3f)) return; // a tilt by rounding errors, such as those of two normals of one plane
    angle = minf(angle, (float)tilt->degrees);
    unsigned entry = (unsigned)angle < tilt->degrees ? (unsigned)angle : tilt->degrees - 1;
    const float *a = tilt->matrix + entry * matrix_size(n), *b = a + matrix_size(n);
    size_t skip = block_size(cosines(n));
    float cosine[2][BLOCK_MAX] = {{0}}, sine[2][BLOCK_MAX] = {{0}};
    split(n, stride, x, cosine[0], sine[0]);
    if (beta.y < 0.0f) half_turn(n, cosine[0], sine[0]);
    float t = angle - (float)entry;
    multiply(cosines(n), a, 1.0f - t, cosine[0], cosine[1]);
    multiply(cosines(n), b, t, cosine[0], cosine[1]);
    multiply(sines(n), a + skip, 1.0f - t, sine[0], sine[1]);
    multiply(sines(n), b + skip, t, sine[0], sine[1]);
    if (beta.y < 0.0f) half_turn(n, cosine[1], sine[1]);
    join(n, stride, cosine[1], sine[1], x);
}
