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
    GROUPS = 8, // of lanes that share a pass over the sums
    BLOCK = LANES * GROUPS,
    WEIGHTS = 6 // real and imaginary part, times red, green and blue
};

typedef struct Lanes {
    float at[LANES];
} Lanes;

typedef struct Weights {
    Lanes of[WEIGHTS];
} Weights;

// A block of directions. Powers of sqrt(1 - x^2) stand with the azimuth, as in sheen_basis_eval.
typedef struct Block {
    unsigned groups;              // in use; the last is filled up with values of 0
    Lanes x[GROUPS];              // argument of N
    Lanes re[GROUPS], im[GROUPS]; // sqrt(1 - x^2) e^{i phi}
    Lanes power_re[GROUPS], power_im[GROUPS];
    Lanes value[3][GROUPS];
    Weights weight[GROUPS];                // W_m
    Lanes column[SHEEN_ORDER_MAX][GROUPS]; // N_l^m / sqrt(1 - x^2)^m at l - m
} Block;

static void load(SheenBasis basis, size_t count, const Vec3 w[], const Rgb value[], Block *b)
{
    b->groups = (unsigned)((count + LANES - 1) / LANES);
    for (size_t k = 0; k < (size_t)b->groups * LANES; ++k) {
        size_t g = k / LANES, i = k % LANES;
        bool inside = k < count && zenith_inside(basis, w[k].z);
        Vec3 d = inside ? w[k] : v3(0.0f, 0.0f, 1.0f);
        Rgb v = inside ? value[k] : rgb_gray(0.0f);
        float scale = zenith_scale(basis, d.z);
        b->x[g].at[i] = zenith_argument(basis, d.z);
        b->re[g].at[i] = scale * d.x;
        b->im[g].at[i] = scale * d.y;
        b->power_re[g].at[i] = SHEEN_SQRT2;
        b->power_im[g].at[i] = 0.0f;
        b->value[0][g].at[i] = v.r;
        b->value[1][g].at[i] = v.g;
        b->value[2][g].at[i] = v.b;
    }
}

// W_0.
static void weigh_first(Block *b)
{
    for (unsigned g = 0; g < b->groups; ++g)
        for (unsigned c = 0; c < 3; ++c)
            for (unsigned i = 0; i < LANES; ++i) {
                b->weight[g].of[c].at[i] = b->value[c][g].at[i];
                b->weight[g].of[3 + c].at[i] = 0.0f;
            }
}

// W_m after W_{m-1}.
static void weigh_next(Block *restrict b)
{
    for (unsigned g = 0; g < b->groups; ++g) {
        Lanes re, im;
        for (unsigned i = 0; i < LANES; ++i) {
            re.at[i] = b->power_re[g].at[i] * b->re[g].at[i] - b->power_im[g].at[i] * b->im[g].at[i];
            im.at[i] = b->power_re[g].at[i] * b->im[g].at[i] + b->power_im[g].at[i] * b->re[g].at[i];
        }
        b->power_re[g] = re;
        b->power_im[g] = im;
        for (unsigned c = 0; c < 3; ++c)
            for (unsigned i = 0; i < LANES; ++i) {
                b->weight[g].of[c].at[i] = b->value[c][g].at[i] * re.at[i];
                b->weight[g].of[3 + c].at[i] = b->value[c][g].at[i] * im.at[i];
            }
    }
}

// The zenith factors of one m, and all l.
static void fill_column(unsigned n, unsigned m, float first, Block *restrict b)
{
    for (unsigned g = 0; g < b->groups; ++g) {
        Lanes before = {{0}}, last;
        for (unsigned i = 0; i < LANES; ++i) last.at[i] = b->column[0][g].at[i] = first;
        for (unsigned l = m + 1; l < n; ++l) {
            float a = sheen_legendre_a[basis_zenith_index(l, m)], c = sheen_legendre_b[basis_zenith_index(l, m)];
            for (unsigned i = 0; i < LANES; ++i) {
                float next = a * b->x[g].at[i] * last.at[i] - c * before.at[i];
                before.at[i] = last.at[i];
                last.at[i] = b->column[l - m][g].at[i] = next;
            }
        }
    }
}

// Adds the block's share of one pair of functions.
static void add(unsigned groups, const Lanes column[restrict], const Weights weight[restrict], Weights *restrict sum)
{
    Weights s = *sum;
    for (unsigned g = 0; g < groups; ++g)
        for (unsigned j = 0; j < WEIGHTS; ++j)
            for (unsigned i = 0; i < LANES; ++i) s.of[j].at[i] += column[g].at[i] * weight[g].of[j].at[i];
    *sum = s;
}

static void add_block(SheenBasis basis, unsigned n, Block *b, Weights sums[])
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
        for (unsigned l = m; l < n; ++l) add(b->groups, b->column[l - m], b->weight, &sums[basis_zenith_index(l, m)]);
    }
}

static Rgb total(const Lanes sum[3])
{
    Rgb all = rgb_gray(0.0f);
    for (unsigned i = 0; i < LANES; ++i) all = rgb_add(all, rgb(sum[0].at[i], sum[1].at[i], sum[2].at[i]));
    return all;
}

void sheen_basis_project(SheenBasis basis, unsigned n, size_t count, const Vec3 w[], const Rgb value[], Rgb out[])
{
    Block b;
    Weights sums[SHEEN_ZENITH_MAX];
    memset(sums, 0, basis_zenith_index(n, 0) * sizeof *sums);
    for (size_t k = 0; k < count; k += BLOCK) {
        load(basis, count - k < BLOCK ? count - k : BLOCK, w + k, value + k, &b);
        add_block(basis, n, &b, sums);
    }
    for (unsigned l = 0; l < n; ++l)
        for (unsigned m = 0; m <= l; ++m) {
            const Weights *sum = &sums[basis_zenith_index(l, m)];
            out[basis_index(l, -(int)m)] = total(sum->of + 3);
            out[basis_index(l, (int)m)] = total(sum->of); // last: for m = 0 it is the one
        }
}
