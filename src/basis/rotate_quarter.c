// SPDX-License-Identifier: Apache-2.0
// Any rotation of spherical harmonics by turns about z and quarter turns Q = Ry(90 degrees), whose matrices are
// constant:
//
//   Ry(beta) = Rx(-90) Rz(beta) Rx(90),    Rx(90) = Rz(-90) Q Rz(90),    Rx(-90) = Rz(-90) Rz(180) Q Rz(-180) Rz(90)
//
// give, of three turns about z and two constant matrices,
//
//   Rz(gamma) Ry(beta) Rz(alpha) = Rz(gamma + 90) Q Rz(beta + 180) Q Rz(alpha + 90).
//
// Three of four entries of Q are 0. It mixes no cosines with sines, and takes cosines of m to those of m' if l + m + m'
// is even, sines if it is odd. So a band is kept as four short vectors, of even m, of odd m, with cosines and with
// sines, padded to a width that the machine has vectors of, and Q is four small dense matrices.
//
// With the entries of the Wigner matrix d(90 degrees), which come in pairs d_{-m', m} = (-1)^{l + m} d_{m', m}, those
// of Q are 2 d_{m', m}, and sqrt(2) d_{m', m} where one of m, m' is 0, and d_{0, 0}.
#include "basis/rotation_tables.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Number k of a vector is m = 2 k, or 2 k + 1. There are no sines of m = 0: their entries stay 0.
enum { COS_EVEN, COS_ODD, SIN_EVEN, SIN_ODD, KINDS };

// Vectors of up to 16 and of up to 32 values of m.
enum { NARROW = 8, WIDE = 16 };

// Where Q takes each kind, for even and for odd l.
static const unsigned taken_to[2][KINDS] = {{COS_EVEN, COS_ODD, SIN_ODD, SIN_EVEN},
                                            {COS_ODD, COS_EVEN, SIN_EVEN, SIN_ODD}};

static unsigned width_of(unsigned n)
{
    return n > 2 * NARROW ? WIDE : NARROW;
}
// Columns of a kind's matrix, an even number: the last may be 0.
static unsigned columns_of(unsigned l)
{
    return l / 4 * 2 + 2;
}
static unsigned order_of(unsigned kind, unsigned k)
{
    return 2 * k + (kind == COS_ODD || kind == SIN_ODD);
}

// ---- the constant matrices --------------------------------------------------------------------------------------

// Column m >= 0 of d(90 degrees), rows m' = 0 .. l: the eigenvector of J_x = (J_+ + J_-) / 2 with eigenvalue m, from
// its first component, d_{l, m} = (-1)^{l - m} 2^-l sqrt((2 l)! / ((l + m)! (l - m)!)), down. It grows on the way, and
// errors with it.
static void wigner_column(unsigned l, unsigned m, double d[])
{
    double top = (l - m) % 2 ? -1.0 : 1.0;
    for (unsigned i = 1; i <= l; ++i) top *= 0.5;
    for (unsigned i = 1; i <= l - m; ++i) top *= sqrt((double)(l + m + i) / i);
    double above = 0.0;
    d[l] = top;
    for (unsigned row = l; row > 0; --row) {
        double up = sqrt((double)((l - row) * (l + row + 1))), down = sqrt((double)((l + row) * (l - row + 1)));
        d[row - 1] = (2.0 * m * d[row] - up * above) / down;
        above = d[row];
    }
}

static void fill_band(unsigned l, unsigned width, float *matrix)
{
    double d[SHEEN_ORDER_MAX];
    for (unsigned kind = 0; kind < KINDS; ++kind)
        for (unsigned column = 0; column < columns_of(l); ++column) {
            float *entries = matrix + (kind * columns_of(l) + column) * width;
            unsigned m = order_of(kind, column), to = taken_to[l % 2][kind];
            if (m > l) continue;
            wigner_column(l, m, d);
            for (unsigned k = 0; k < width && order_of(to, k) <= l; ++k) {
                unsigned row = order_of(to, k);
                bool no_sine = kind >= SIN_EVEN && (m == 0 || row == 0);
                double factor = no_sine ? 0.0 : m == 0 && row == 0 ? 1.0 : m == 0 || row == 0 ? M_SQRT2 : 2.0;
                entries[k] = (float)(factor * d[row]);
            }
        }
}

static size_t band_size(unsigned l, unsigned width)
{
    return (size_t)KINDS * columns_of(l) * width;
}

SheenStatus sheen_quarter_create(unsigned n, SheenQuarter *out)
{
    size_t size = 0;
    for (unsigned l = 0; l < n; ++l) size += band_size(l, width_of(n));
    float *band = out->matrix = calloc(size, sizeof *band);
    if (!band) return SHEEN_ERR_NOMEM;
    for (unsigned l = 0; l < n; ++l) {
        fill_band(l, width_of(n), band);
        band += band_size(l, width_of(n));
    }
    return SHEEN_OK;
}

// ---- rotation ---------------------------------------------------------------------------------------------------

// Cosine and sine of m times an angle: [even and odd m][k].
typedef struct Turn {
    float c[2][WIDE], s[2][WIDE];
} Turn;

static void make_turn(unsigned n, Vec2 angle, Turn *t)
{
    float c[SHEEN_ORDER_MAX], s[SHEEN_ORDER_MAX];
    rotation_powers(n, angle, c, s);
    memset(t, 0, sizeof *t);
    for (unsigned m = 0; m < n; ++m) {
        t->c[m % 2][m / 2] = c[m];
        t->s[m % 2][m / 2] = s[m];
    }
}

// Even or odd m.
static void turn_half(unsigned width, const float c[restrict], const float s[restrict], float cosine[restrict],
                      float sine[restrict])
{
    for (unsigned k = 0; k < width; ++k) {
        float turned = cosine[k] * c[k] - sine[k] * s[k];
        sine[k] = cosine[k] * s[k] + sine[k] * c[k];
        cosine[k] = turned;
    }
}

static void turn(unsigned width, const Turn *t, float v[])
{
    turn_half(width, t->c[0], t->s[0], v + COS_EVEN * width, v + SIN_EVEN * width);
    turn_half(width, t->c[1], t->s[1], v + COS_ODD * width, v + SIN_ODD * width);
}

// Two columns at once: their sums are in memory.
static void quarter(unsigned width, unsigned l, const float *restrict matrix, const float v[restrict],
                    float out[restrict])
{
    for (unsigned kind = 0; kind < KINDS; ++kind) {
        float *restrict sum = out + taken_to[l % 2][kind] * width;
        const float *restrict x = v + kind * width;
        for (unsigned k = 0; k < width; ++k) sum[k] = matrix[k] * x[0] + matrix[width + k] * x[1];
        matrix += 2 * width;
        for (unsigned column = 2; column < columns_of(l); column += 2, matrix += 2 * width)
            for (unsigned k = 0; k < width; ++k) sum[k] += matrix[k] * x[column] + matrix[width + k] * x[column + 1];
    }
}

// Loops over a constant width become a vector or two.
static void rotate_bands(unsigned width, unsigned n, const float *matrix, const Turn turns[3], float v[])
{
    float half[KINDS * WIDE];
    for (unsigned l = 0; l < n; ++l) {
        float *band = v + (size_t)l * KINDS * width;
        turn(width, &turns[0], band);
        quarter(width, l, matrix, band, half);
        turn(width, &turns[1], half);
        quarter(width, l, matrix, half, band);
        turn(width, &turns[2], band);
        matrix += band_size(l, width);
    }
}

// Between the order of basis_index and four vectors a band.
static void split(unsigned n, unsigned width, size_t stride, const float in[restrict], float v[restrict])
{
    for (unsigned l = 0; l < n; ++l, v += (size_t)KINDS * width) {
        const float *plus = in + basis_index(l, 0) * stride, *minus = plus;
        for (unsigned m = 0; m <= l; ++m, plus += stride, minus -= stride) {
            float *at = v + m % 2 * width + m / 2;
            at[0] = *plus;
            at[2 * width] = *minus;
        }
        v[SIN_EVEN * width] = 0.0f;
    }
}

static void join(unsigned n, unsigned width, size_t stride, const float v[restrict], float out[restrict])
{
    for (unsigned l = 0; l < n; ++l, v += (size_t)KINDS * width) {
        float *plus = out + basis_index(l, 0) * stride, *minus = plus;
        for (unsigned m = 0; m <= l; ++m, plus += stride, minus -= stride) {
            const float *at = v + m % 2 * width + m / 2;
            *minus = at[2 * width];
            *plus = at[0]; // last: for m = 0 it is the one
        }
    }
}

void sheen_quarter_rotate(const SheenQuarter *q, unsigned n, const SheenEuler *e, unsigned stride, const float in[],
                          float out[])
{
    unsigned width = width_of(n);
    Turn turns[3];
    make_turn(n, v2(-e->alpha.y, e->alpha.x), &turns[0]);
    make_turn(n, v2(-e->beta.x, -e->beta.y), &turns[1]);
    make_turn(n, v2(-e->gamma.y, e->gamma.x), &turns[2]);
    float v[SHEEN_ORDER_MAX * KINDS * WIDE];
    memset(v, 0, (size_t)n * KINDS * width * sizeof *v);
    split(n, width, stride, in, v);
    if (width == NARROW)
        rotate_bands(NARROW, n, q->matrix, turns, v);
    else
        rotate_bands(WIDE, n, q->matrix, turns, v);
    join(n, width, stride, v, out);
}
