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
// Columns of a kind's matrix.
static unsigned columns_of(unsigned l)
{
    return l / 2 + 1;
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
    float c = 1.0f, s = 0.0f;
    memset(t, 0, sizeof *t);
    for (unsigned m = 0; m < n; ++m) {
        t->c[m % 2][m / 2] = c;
        t->s[m % 2][m / 2] = s;
        float turned = c * angle.x - s * angle.y;
        s = c * angle.y + s * angle.x;
        c = turned;
    }
}

static inline void turn(unsigned width, const Turn *t, float v[restrict])
{
    float *even = v + COS_EVEN * width, *odd = v + COS_ODD * width;
    for (unsigned k = 0; k < width; ++k) {
        float c = even[k], s = even[2 * width + k];
        even[k] = c * t->c[0][k] - s * t->s[0][k];
        even[2 * width + k] = c * t->s[0][k] + s * t->c[0][k];
    }
    for (unsigned k = 0; k < width; ++k) {
        float c = odd[k], s = odd[2 * width + k];
        odd[k] = c * t->c[1][k] - s * t->s[1][k];
        odd[2 * width + k] = c * t->s[1][k] + s * t->c[1][k];
    }
}

static inline void quarter(unsigned width, unsigned l, const float *restrict matrix, const float v[restrict],
                           float out[restrict])
{
    for (unsigned kind = 0; kind < KINDS; ++kind) {
        float sum[WIDE] = {0};
        for (unsigned column = 0; column < columns_of(l); ++column, matrix += width)
            for (unsigned k = 0; k < width; ++k) sum[k] += matrix[k] * v[kind * width + column];
        for (unsigned k = 0; k < width; ++k) out[taken_to[l % 2][kind] * width + k] = sum[k];
    }
}

// Loops over a constant width become a vector or two.
static inline void rotate_bands(unsigned width, unsigned n, const float *matrix, const Turn turns[3], float v[])
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
    for (unsigned l = 0; l < n; ++l)
        for (unsigned m = 0; m <= l; ++m) {
            float *band = v + ((size_t)l * KINDS + m % 2) * width + m / 2;
            band[0] = in[basis_index(l, (int)m) * stride];
            if (m > 0) band[2 * width] = in[basis_index(l, -(int)m) * stride];
        }
    if (width == NARROW)
        rotate_bands(NARROW, n, q->matrix, turns, v);
    else
        rotate_bands(WIDE, n, q->matrix, turns, v);
    for (unsigned l = 0; l < n; ++l)
        for (unsigned m = 0; m <= l; ++m) {
            const float *band = v + ((size_t)l * KINDS + m % 2) * width + m / 2;
            out[basis_index(l, (int)m) * stride] = band[0];
            if (m > 0) out[basis_index(l, -(int)m) * stride] = band[2 * width];
        }
}
