// SPDX-License-Identifier: Apache-2.0
// The stratified gradient. The sum over all sectors of light times harmonics is, for each ring, one short Fourier
// series; the sum over the rings then takes each of its terms with the zenith factors.
#include "gather/radiance_gradient.h"

#include <string.h>

// Rings are worked on in blocks, whose Fourier sums fit into the first level of the processor's cache.
enum { BLOCK = 16, BLOCK_FLOATS = 3 * BLOCK, TURNS_MAX = 2 * SHEEN_ORDER_MAX + 1 };

/** Rings first .. first + count - 1. */
typedef struct Rings {
    unsigned first, count;
} Rings;

/** One over the distances in one sector, from the ring before the block on. */
typedef struct Inverses {
    float of[BLOCK + 1];
} Inverses;

/** Fourier sums over the sectors of what walls uncover: [cos(m phi), sin(m phi)][ring][channel]. */
typedef struct Sums {
    double of[TURNS_MAX][BLOCK_FLOATS];
} Sums;

// How far a wall moves for a shift of the point, per metre: I of the formula, from one over each distance.
static inline float approach(float a, float b)
{
    float nearer = maxf(a, b);
    return nearer < 1.5f * minf(a, b) ? 0.5f * (a + b) : nearer;
}

// The ring before the first is the first: nothing passes the pole, and the difference there is 0.
static inline unsigned ring_before(unsigned j)
{
    return j ? j - 1 : 0;
}

static void invert(Rings rings, const float distance[], Inverses *out)
{
    out->of[0] = inverse_distance(distance[ring_before(rings.first)]);
    for (unsigned i = 0; i < rings.count; ++i) out->of[i + 1] = inverse_distance(distance[rings.first + i]);
}

// Light uncovered by the walls to the ring before.
static void uncover_rings(Rings rings, const Rgb L[], const Inverses *inverse, float out[])
{
    for (unsigned i = 0; i < rings.count; ++i) {
        unsigned j = rings.first + i;
        Rgb d = rgb_scale(rgb_sub(L[j], L[ring_before(j)]), approach(inverse->of[i + 1], inverse->of[i]));
        memcpy(out + (size_t)3 * i, &d, sizeof d);
    }
}

// Light uncovered by the walls to the sector before.
static void uncover_sectors(Rings rings, const Rgb L[], const Rgb before[], const Inverses *inverse,
                            const Inverses *inverse_before, float out[])
{
    for (unsigned i = 0; i < rings.count; ++i) {
        unsigned j = rings.first + i;
        Rgb d = rgb_scale(rgb_sub(L[j], before[j]), approach(inverse->of[i + 1], inverse_before->of[i + 1]));
        memcpy(out + (size_t)3 * i, &d, sizeof d);
    }
}

static void add_turns(unsigned turns, const float turn[], const float light[BLOCK_FLOATS], Sums *sums)
{
    for (unsigned m = 0; m < turns; ++m) {
        double factor = (double)turn[m], *restrict sum = sums->of[m];
        for (unsigned i = 0; i < BLOCK_FLOATS; ++i) sum[i] += factor * (double)light[i];
    }
}

// Fourier sums of the walls between rings, at the middles of the sectors, and between sectors, at their edges.
static void sum_sectors(const SheenRadianceTables *t, const RadianceSamples *s, Rings rings, Sums *by_ring,
                        Sums *by_sector)
{
    unsigned M = t->strata.rings, N = t->strata.sectors, turns = 2 * t->n + 1;
    memset(by_ring->of, 0, turns * sizeof by_ring->of[0]);
    memset(by_sector->of, 0, turns * sizeof by_sector->of[0]);
    Inverses inverses[2];
    const Rgb *before = s->L + (size_t)(N - 1) * M;
    invert(rings, s->distance + (size_t)(N - 1) * M, &inverses[1]);
    for (unsigned k = 0; k < N; ++k) {
        const Rgb *L = s->L + (size_t)k * M;
        Inverses *inverse = &inverses[k & 1];
        float light[BLOCK_FLOATS] = {0};
        invert(rings, s->distance + (size_t)k * M, inverse);
        uncover_rings(rings, L, inverse, light);
        add_turns(turns, t->middle + (size_t)k * turns, light, by_ring);
        uncover_sectors(rings, L, before, inverse, &inverses[~k & 1], light);
        add_turns(turns, t->edge + (size_t)k * turns, light, by_sector);
        before = L;
    }
}

/** The four products of cos(m phi), sin(m phi) with cos(phi), sin(phi), summed with what walls uncover; per channel. */
typedef struct Products {
    double cc[3], cs[3], sc[3], ss[3];
} Products;

static Products products(const Sums *sums, unsigned n, unsigned m, unsigned ring)
{
    Products p;
    unsigned first = 3 * ring;
    for (unsigned i = 0; i < 3; ++i) {
        double c_up = sums->of[m + 1][first + i], c_down = sums->of[m ? m - 1 : 1][first + i];
        double s_up = sums->of[n + m + 1][first + i], s_down = 0.0;
        if (m == 0) s_down = -s_up;
        if (m > 1) s_down = sums->of[n + m - 1][first + i];
        p.cc[i] = 0.5 * (c_up + c_down);
        p.cs[i] = 0.5 * (s_up - s_down);
        p.sc[i] = 0.5 * (s_up + s_down);
        p.ss[i] = 0.5 * (c_down - c_up);
    }
    return p;
}

/** Gradients of (l, m) and (l, -m): d/dx and d/dy of the one, then of the other; per channel. */
typedef struct Pair {
    double of[12];
} Pair;

// u_k is (cos(phi), sin(phi)), v_k is (-sin(phi), cos(phi)).
static void by_frame(const Products *ring, const Products *sector, Pair *u, Pair *v)
{
    for (unsigned i = 0; i < 3; ++i) {
        u->of[i] = ring->cc[i];
        u->of[3 + i] = ring->cs[i];
        u->of[6 + i] = ring->sc[i];
        u->of[9 + i] = ring->ss[i];
        v->of[i] = -sector->cs[i];
        v->of[3 + i] = sector->cc[i];
        v->of[6 + i] = -sector->ss[i];
        v->of[9 + i] = sector->sc[i];
    }
}

static void add_rings(const SheenRadianceTables *t, Rings rings, const Sums *by_ring, const Sums *by_sector,
                      Pair gradient[])
{
    size_t zeniths = (size_t)t->n * (t->n + 1) / 2;
    for (unsigned i = 0; i < rings.count; ++i) {
        const float *wall = t->wall + (rings.first + i) * zeniths, *ring = t->ring + (rings.first + i) * zeniths;
        for (unsigned m = 0; m < t->n; ++m) {
            Products p = products(by_ring, t->n, m, i), q = products(by_sector, t->n, m, i);
            Pair u, v;
            by_frame(&p, &q, &u, &v);
            for (unsigned l = m; l < t->n; ++l) {
                size_t z = basis_zenith_index(l, m);
                double a = (double)wall[z], b = (double)ring[z];
                for (unsigned c = 0; c < 12; ++c) gradient[z].of[c] += a * u.of[c] + b * v.of[c];
            }
        }
    }
}

static Rgb rgb_of(const double of[3], double scale)
{
    return rgb((float)(scale * of[0]), (float)(scale * of[1]), (float)(scale * of[2]));
}

void sheen_radiance_gradient_stratified(const SheenRadianceTables *t, const RadianceSamples *samples, Rgb dx[],
                                        Rgb dy[])
{
    Pair gradient[SHEEN_ZENITH_MAX];
    Sums by_ring, by_sector;
    memset(gradient, 0, (size_t)t->n * (t->n + 1) / 2 * sizeof *gradient);
    for (unsigned first = 0; first < t->strata.rings; first += BLOCK) {
        unsigned left = t->strata.rings - first;
        Rings rings = {first, left < BLOCK ? left : BLOCK};
        sum_sectors(t, samples, rings, &by_ring, &by_sector);
        add_rings(t, rings, &by_ring, &by_sector, gradient);
    }
    for (unsigned l = 0; l < t->n; ++l)
        for (unsigned m = 0; m <= l; ++m) {
            const double *g = gradient[basis_zenith_index(l, m)].of, scale = m ? sqrt(2.0) : 1.0;
            size_t minus = basis_index(l, -(int)m), plus = basis_index(l, (int)m);
            dx[minus] = rgb_of(g + 6, scale);
            dy[minus] = rgb_of(g + 9, scale);
            dx[plus] = rgb_of(g, scale);
            dy[plus] = rgb_of(g + 3, scale);
        }
}
