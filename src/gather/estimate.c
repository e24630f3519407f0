// SPDX-License-Identifier: Apache-2.0
#include "gather/estimate.h"

#include <stddef.h>

static const double pi = 3.141592653589793;

// Sums are kept in double: a gradient is a difference of many terms of both signs.
typedef struct RgbSum {
    double r, g, b;
} RgbSum;

static void sum_add(RgbSum *s, double w, Rgb v)
{
    s->r += w * (double)v.r;
    s->g += w * (double)v.g;
    s->b += w * (double)v.b;
}

static Rgb sum_rgb(RgbSum s)
{
    return rgb((float)s.r, (float)s.g, (float)s.b);
}

// One over each distance, 0 for an infinite one. The nearer of two has the larger.
static void invert(unsigned n, const float distance[], float *restrict inverse)
{
    for (unsigned i = 0; i < n; ++i) inverse[i] = 1.0f / distance[i];
}

float sheen_harmonic_mean(unsigned n, const float distance[])
{
    enum { BLOCK = 64 };
    float inverse[BLOCK];
    double sum = 0.0;
    for (unsigned first = 0; first < n; first += BLOCK) {
        unsigned count = n - first < BLOCK ? n - first : BLOCK;
        invert(count, distance + first, inverse);
        for (unsigned i = 0; i < count; ++i) sum += (double)inverse[i];
    }
    return sum > 0.0 ? (float)((double)n / sum) : INFINITY;
}

// Weights of the walls, the same in every sector.
typedef struct WallTable {
    double ring[SHEEN_RINGS_MAX];   // sin cos^2 at the lower edge of ring j; 0 for ring 0, which has none
    double sector[SHEEN_RINGS_MAX]; // sin at the upper edge less sin at the lower edge
} WallTable;

static void fill_table(unsigned rings, WallTable *t)
{
    double lower = 0.0;
    for (unsigned j = 0; j < rings; ++j) {
        double sin2 = (double)j / rings, upper = sqrt((double)(j + 1) / rings);
        t->ring[j] = lower * (1.0 - sin2);
        t->sector[j] = upper - lower;
        lower = upper;
    }
}

/** One sector: [rings] radiance, and one over the distance. */
typedef struct Sector {
    const Rgb *L;
    float inverse[SHEEN_RINGS_MAX];
} Sector;

static void read_sector(SheenStrata s, unsigned k, const Rgb L[], const float distance[], Sector *out)
{
    out->L = L + (size_t)k * s.rings;
    invert(s.rings, distance + (size_t)k * s.rings, out->inverse);
}

// Radiance exchanged across the walls of one sector: between its rings (u), and to the sector before it (v).
static void add_walls(SheenStrata s, const WallTable *t, const Sector *here, const Sector *before, RgbSum *u, RgbSum *v)
{
    const float *r = here->inverse;
    for (unsigned j = 0; j < s.rings; ++j) {
        if (j) sum_add(u, t->ring[j] * (double)maxf(r[j], r[j - 1]), rgb_sub(here->L[j], here->L[j - 1]));
        sum_add(v, t->sector[j] * (double)maxf(r[j], before->inverse[j]), rgb_sub(here->L[j], before->L[j]));
    }
}

static void translation_gradient(SheenStrata s, const Rgb L[], const float distance[], Rgb out[2])
{
    WallTable table;
    fill_table(s.rings, &table);
    RgbSum x = {0, 0, 0}, y = {0, 0, 0};
    Sector sectors[2];
    read_sector(s, s.sectors - 1, L, distance, &sectors[1]);
    for (unsigned k = 0; k < s.sectors; ++k) {
        Sector *here = &sectors[k & 1], *before = &sectors[~k & 1];
        read_sector(s, k, L, distance, here);
        RgbSum u = {0, 0, 0}, v = {0, 0, 0};
        add_walls(s, &table, here, before, &u, &v);
        double middle = 2.0 * pi * (k + 0.5) / s.sectors, edge = 2.0 * pi * k / s.sectors, width = 2.0 * pi / s.sectors;
        sum_add(&x, width * cos(middle), sum_rgb(u));
        sum_add(&y, width * sin(middle), sum_rgb(u));
        sum_add(&x, -sin(edge), sum_rgb(v));
        sum_add(&y, cos(edge), sum_rgb(v));
    }
    out[0] = sum_rgb(x);
    out[1] = sum_rgb(y);
}

/** What a sum over the strata takes of the directions in it: integrals over a ring, and over a sector. Radiance counts
 *  as even in a stratum, so that grazing rays, of much weight and little chance, bring no noise of their own. */
typedef struct RingIntegrals {
    double of[SHEEN_RINGS_MAX];
} RingIntegrals;

static Vec2 sector_integrals(SheenStrata s, unsigned k) // of cos(phi) and sin(phi)
{
    double step = 2.0 * pi / s.sectors, lower = step * k, upper = step * (k + 1);
    return v2((float)(sin(upper) - sin(lower)), (float)(cos(lower) - cos(upper)));
}

// Sums of L times a ring's integral and a sector's.
static void sum_vector(SheenStrata s, const RingIntegrals *rings, const Rgb L[], RgbSum *x, RgbSum *y)
{
    for (unsigned k = 0; k < s.sectors; ++k) {
        RgbSum sector = {0, 0, 0};
        for (unsigned j = 0; j < s.rings; ++j) sum_add(&sector, rings->of[j], L[k * s.rings + j]);
        Vec2 w = sector_integrals(s, k);
        sum_add(x, (double)w.x, sum_rgb(sector));
        sum_add(y, (double)w.y, sum_rgb(sector));
    }
}

// Of what a plane bent by SHEEN_BEND leaves behind, for light from a zenith angle: its Fourier series in the azimuth.
static void behind_at(double cos_theta, double *mean, double *first)
{
    double a = sin((double)SHEEN_BEND) * sqrt(1.0 - cos_theta * cos_theta), b = cos((double)SHEEN_BEND) * cos_theta;
    *mean = *first = 0.0;
    if (!(a > b)) return;
    double psi = acos(b / a), reach = sin(psi); // max(0, a cos(psi) - b) is not zero from -psi to psi
    *mean = (a * reach - b * psi) / pi;
    *first = (a * (psi + reach * cos(psi)) - 2.0 * b * reach) / pi;
}

void sheen_estimate_behind(SheenStrata s, const Rgb L[], BehindEstimate *out)
{
    enum { STEPS = 8 };
    RingIntegrals means = {{0}}, firsts = {{0}};
    for (unsigned j = 0; j < s.rings; ++j) {
        double upper = sqrt(1.0 - (double)j / s.rings), lower = sqrt(1.0 - (double)(j + 1) / s.rings);
        double width = (upper - lower) / STEPS;
        for (unsigned i = 0; i < STEPS; ++i) {
            double mean, first;
            behind_at(lower + (i + 0.5) * width, &mean, &first);
            means.of[j] += width * mean;
            firsts.of[j] += width * first;
        }
    }
    RgbSum mean = {0, 0, 0}, x = {0, 0, 0}, y = {0, 0, 0};
    double scale = 1.0 / (1.0 - cos((double)SHEEN_BEND));
    for (unsigned i = 0; i < strata_count(s); ++i)
        sum_add(&mean, scale * 2.0 * pi / s.sectors * means.of[i % s.rings], L[i]);
    sum_vector(s, &firsts, L, &x, &y);
    out->mean = sum_rgb(mean);
    double luminance = (double)rgb_luminance(out->mean);
    scale = luminance > 0.0 ? -scale / luminance : 0.0; // what is bent away from light has it behind
    out->lean[0] = (float)(scale * (double)rgb_luminance(sum_rgb(x)));
    out->lean[1] = (float)(scale * (double)rgb_luminance(sum_rgb(y)));
}

// grad_r E = integral of L (n x d) with n x d = (-d.y, d.x, 0) in the local frame.
static void rotation_gradient(SheenStrata s, const Rgb L[], Rgb out[2])
{
    RingIntegrals rings; // of sin(theta) over the zenith's share of the solid angle, sin(theta) d theta
    double before = 0.0;
    for (unsigned j = 0; j < s.rings; ++j) {
        double sin2 = (double)(j + 1) / s.rings, sine = sqrt(sin2);
        double up_to = 0.5 * (asin(fmin(sine, 1.0)) - sine * sqrt(fmax(0.0, 1.0 - sin2)));
        rings.of[j] = up_to - before;
        before = up_to;
    }
    RgbSum x = {0, 0, 0}, y = {0, 0, 0};
    sum_vector(s, &rings, L, &x, &y);
    out[0] = rgb_scale(sum_rgb(y), -1.0f);
    out[1] = sum_rgb(x);
}

void sheen_estimate_irradiance(SheenStrata s, const Rgb L[], const float distance[], IrradianceEstimate *out)
{
    unsigned n = strata_count(s);
    RgbSum E = {0, 0, 0};
    for (unsigned i = 0; i < n; ++i) sum_add(&E, pi / n, L[i]);
    out->E = sum_rgb(E);
    rotation_gradient(s, L, out->rotation);
    translation_gradient(s, L, distance, out->translation);
    out->R = sheen_harmonic_mean(n, distance);
}
