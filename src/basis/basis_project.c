// SPDX-License-Identifier: Apache-2.0
// Sums over many directions, the work of a record besides its rays.
//
// A loop over LANES independent directions is what compilers make vector instructions of without a permission to
// reorder sums: each lane has sums of its own until the end. For the functions of one |m|,
//
//   sum_k value_k N_l^m(k) t_{+-m}(k) = sum_k N_l^m(k) W_m(k),    W_m = value t_{+-m}, for three colours,
//
// so that a function costs a multiplication and an addition a colour, and the recurrence for N runs once a pair +-m.
#include "basis/basis.h"

#include "basis/legendre.h"

#include <string.h>

enum {
    LANES = 8,
    BLOCK = 4 * LANES, // directions that share a pass over the sums
    WEIGHTS = 6        // real and imaginary part, times red, green and blue
};

// A block of directions. Powers of sqrt(1 - x^2) stand with the azimuth, as in sheen_basis_eval.
typedef struct Block {
    float x[BLOCK];             // argument of N
    float re[BLOCK], im[BLOCK]; // sqrt(1 - x^2) e^{i phi}
    float power_re[BLOCK], power_im[BLOCK];
    float value[3][BLOCK];
    float weight[WEIGHTS][BLOCK];         // W_m
    float column[SHEEN_ORDER_MAX][BLOCK]; // N_l^m / sqrt(1 - x^2)^m at l - m
} Block;

// Sums of a pair of functions.
typedef struct Sums {
    float of[WEIGHTS][LANES];
} Sums;

// Fills up with values of 0.
static void load(SheenBasis basis, size_t count, const Vec3 w[], const Rgb value[], Block *b)
{
    for (size_t k = 0; k < BLOCK; ++k) {
        bool inside = k < count && zenith_inside(basis, w[k].z);
        Vec3 d = inside ? w[k] : v3(0.0f, 0.0f, 1.0f);
        Rgb v = inside ? value[k] : rgb_gray(0.0f);
        float scale = zenith_scale(basis, d.z);
        b->x[k] = zenith_argument(basis, d.z);
        b->re[k] = scale * d.x;
        b->im[k] = scale * d.y;
        b->power_re[k] = SHEEN_SQRT2;
        b->power_im[k] = 0.0f;
        b->value[0][k] = v.r;
        b->value[1][k] = v.g;
        b->value[2][k] = v.b;
    }
}

// W_0.
static void weigh_first(Block *b)
{
    memcpy(b->weight, b->value, sizeof b->value);
    memset(b->weight[3], 0, sizeof b->value);
}

// W_m after W_{m-1}.
static void weigh_next(Block *b)
{
    for (unsigned k = 0; k < BLOCK; ++k) {
        float re = b->power_re[k], im = b->power_im[k];
        b->power_re[k] = re * b->re[k] - im * b->im[k];
        b->power_im[k] = re * b->im[k] + im * b->re[k];
    }
    for (unsigned c = 0; c < 3; ++c)
        for (unsigned k = 0; k < BLOCK; ++k) {
            b->weight[c][k] = b->value[c][k] * b->power_re[k];
            b->weight[3 + c][k] = b->value[c][k] * b->power_im[k];
        }
}

// The zenith factors of one m, and all l.
static void fill_column(unsigned n, unsigned m, float first, Block *b)
{
    for (unsigned k = 0; k < BLOCK; ++k) b->column[0][k] = first;
    for (unsigned l = m + 1; l < n; ++l) {
        float a = sheen_legendre_a[basis_zenith_index(l, m)], c = sheen_legendre_b[basis_zenith_index(l, m)];
        const float *last = b->column[l - m - 1], *before = l > m + 1 ? b->column[l - m - 2] : last; // c is 0 then
        for (unsigned k = 0; k < BLOCK; ++k) b->column[l - m][k] = a * b->x[k] * last[k] - c * before[k];
    }
}

// Adds the block's share of one pair of functions. Sums stay in memory, so that compilers need not find registers for
// them, and the loop over lanes is the outer one: the inner one is unrolled, and what is left becomes vectors.
static void add(const float f[restrict], float weight[restrict][BLOCK], Sums *restrict sums)
{
    for (unsigned i = 0; i < LANES; ++i)
        for (unsigned j = 0; j < WEIGHTS; ++j)
            sums->of[j][i] +=
                (f[i] * weight[j][i] + f[LANES + i] * weight[j][LANES + i]) +
                (f[2 * LANES + i] * weight[j][2 * LANES + i] + f[3 * LANES + i] * weight[j][3 * LANES + i]);
}

static void add_block(SheenBasis basis, unsigned n, Block *b, Sums sums[])
{
    // N_m^m / sqrt(1 - x^2)^m, a constant.
    float first = zenith_first(basis);
    weigh_first(b);
    for (unsigned m = 0; m < n; ++m) {
        if (m > 0) {
            first *= sheen_legendre_a[basis_zenith_index(m, m)];
            weigh_next(b);
        }
        fill_column(n, m, first, b);
        for (unsigned l = m; l < n; ++l) add(b->column[l - m], b->weight, &sums[basis_zenith_index(l, m)]);
    }
}

static Rgb total(float of[3][LANES])
{
    Rgb all = rgb_gray(0.0f);
    for (unsigned i = 0; i < LANES; ++i) all = rgb_add(all, rgb(of[0][i], of[1][i], of[2][i]));
    return all;
}

void sheen_basis_project(SheenBasis basis, unsigned n, size_t count, const Vec3 w[], const Rgb value[], Rgb out[])
{
    Block b;
    Sums sums[SHEEN_ZENITH_MAX];
    memset(sums, 0, basis_zenith_index(n, 0) * sizeof *sums);
    for (size_t k = 0; k < count; k += BLOCK) {
        load(basis, count - k < BLOCK ? count - k : BLOCK, w + k, value + k, &b);
        add_block(basis, n, &b, sums);
    }
    for (unsigned l = 0; l < n; ++l)
        for (unsigned m = 0; m <= l; ++m) {
            Sums *s = &sums[basis_zenith_index(l, m)];
            out[basis_index(l, -(int)m)] = total(s->of + 3);
            out[basis_index(l, (int)m)] = total(s->of); // last: for m = 0 it is the one
        }
}
