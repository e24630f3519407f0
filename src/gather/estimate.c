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

float sheen_harmonic_mean(unsigned n, const float distance[])
{
    double sum = 0.0;
    for (unsigned i = 0; i < n; ++i) sum += 1.0 / (double)distance[i];
    return sum > 0.0 ? (float)((double)n / sum) : INFINITY;
}

static double inverse_of_nearer(float a, float b)
{
    return 1.0 / (double)minf(a, b); // 0 for two infinite distances
}

// Radiance exchanged across the walls between the rings of one sector.
static RgbSum ring_walls(SheenStrata s, const Rgb L[], const float distance[])
{
    RgbSum sum = {0, 0, 0};
    for (unsigned j = 1; j < s.rings; ++j) {
        double sin2 = (double)j / s.rings;
        double w = sqrt(sin2) * (1.0 - sin2) * inverse_of_nearer(distance[j], distance[j - 1]);
        sum_add(&sum, w, rgb_sub(L[j], L[j - 1]));
    }
    return sum;
}

// The same across the wall between a sector and the one before it.
static RgbSum sector_walls(SheenStrata s, const Rgb L[], const float distance[], const Rgb L_before[],
                           const float distance_before[])
{
    RgbSum sum = {0, 0, 0};
    for (unsigned j = 0; j < s.rings; ++j) {
        double width = sqrt((double)(j + 1) / s.rings) - sqrt((double)j / s.rings);
        sum_add(&sum, width * inverse_of_nearer(distance[j], distance_before[j]), rgb_sub(L[j], L_before[j]));
    }
    return sum;
}

static void translation_gradient(SheenStrata s, const Rgb L[], const float distance[], Rgb out[2])
{
    RgbSum x = {0, 0, 0}, y = {0, 0, 0};
    const double two_pi = 6.283185307179586;
    for (unsigned k = 0; k < s.sectors; ++k) {
        size_t here = (size_t)k * s.rings, before = (size_t)(k ? k - 1 : s.sectors - 1) * s.rings;
        Rgb u = sum_rgb(ring_walls(s, L + here, distance + here));
        Rgb v = sum_rgb(sector_walls(s, L + here, distance + here, L + before, distance + before));
        double middle = two_pi * (k + 0.5) / s.sectors, edge = two_pi * k / s.sectors, width = two_pi / s.sectors;
        sum_add(&x, width * cos(middle), u);
        sum_add(&y, width * sin(middle), u);
        sum_add(&x, -sin(edge), v);
        sum_add(&y, cos(edge), v);
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
        double scale = per_cell / fmax((double)directions[i].z, 0.01);
        sum_add(&rx, -(double)directions[i].y * scale, L[i]);
        sum_add(&ry, (double)directions[i].x * scale, L[i]);
    }
    out->E = sum_rgb(E);
    out->rotation[0] = sum_rgb(rx);
    out->rotation[1] = sum_rgb(ry);
    translation_gradient(s, L, distance, out->translation);
    out->R = sheen_harmonic_mean(n, distance);
}
