// SPDX-License-Identifier: Apache-2.0
#include "gather/estimate.h"

#include <stddef.h>

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
    const double two_pi = 6.283185307179586;
    Sector sectors[2];
    read_sector(s, s.sectors - 1, L, distance, &sectors[1]);
    for (unsigned k = 0; k < s.sectors; ++k) {
        Sector *here = &sectors[k & 1], *before = &sectors[~k & 1];
        read_sector(s, k, L, distance, here);
        RgbSum u = {0, 0, 0}, v = {0, 0, 0};
        add_walls(s, &table, here, before, &u, &v);
        double middle = two_pi * (k + 0.5) / s.sectors, edge = two_pi * k / s.sectors, width = two_pi / s.sectors;
        sum_add(&x, width * cos(middle), sum_rgb(u));
        sum_add(&y, width * sin(middle), sum_rgb(u));
        sum_add(&x, -sin(edge), sum_rgb(v));
        sum_add(&y, cos(edge), sum_rgb(v));
    }
    out[0] = sum_rgb(x);
    out[1] = sum_rgb(y);
}

void sheen_estimate_irradiance(SheenStrata s, const Vec3 directions[], const Rgb L[], const float distance[],
                               IrradianceEstimate *out)
{
    unsigned n = strata_count(s);
    double per_cell = 3.141592653589793 / n;
    RgbSum E = {0, 0, 0}, rx = {0, 0, 0}, ry = {0, 0, 0};
    for (unsigned i = 0; i < n; ++i) {
        sum_add(&E, per_cell, L[i]);
        // n x d = (-d.y, d.x, 0) in the local frame, over the density cos(theta) / pi of the samples. A grazing sample
        // is cut at 0.6 degrees, where one ray would outweigh all others.
        float inverse = 1.0f / maxf(directions[i].z, 0.01f);
        sum_add(&rx, -per_cell * (double)(directions[i].y * inverse), L[i]);
        sum_add(&ry, per_cell * (double)(directions[i].x * inverse), L[i]);
    }
    out->E = sum_rgb(E);
    out->rotation[0] = sum_rgb(rx);
    out->rotation[1] = sum_rgb(ry);
    translation_gradient(s, L, distance, out->translation);
    out->R = sheen_harmonic_mean(n, distance);
}
