// SPDX-License-Identifier: Apache-2.0
#include "gather/radiance.h"

#include "gather/estimate.h"
#include "gather/radiance_gradient.h"

#include <stdlib.h>

static const double pi = 3.141592653589793;

// ---- tables -----------------------------------------------------------------------------------------------------

// cos(m phi), m = 0 .. n, and sin(m phi), m = 1 .. n.
static void fill_turns(unsigned n, double phi, float out[])
{
    for (unsigned m = 0; m <= n; ++m) {
        if (m) out[n + m] = (float)sin(m * phi);
        out[m] = (float)cos(m * phi);
    }
}

static void fill_zenith(const SheenRadianceTables *t, double cos_theta, double weight, float out[])
{
    sheen_basis_zenith(t->basis, t->n, (float)cos_theta, out);
    for (unsigned i = 0; i < t->n * (t->n + 1) / 2; ++i) out[i] = (float)(weight * (double)out[i]);
}

static void fill_tables(const SheenRadianceTables *t)
{
    unsigned M = t->strata.rings, N = t->strata.sectors;
    size_t turns = 2 * t->n + 1, zeniths = t->n * (t->n + 1) / 2;
    for (unsigned k = 0; k < N; ++k) {
        fill_turns(t->n, 2.0 * pi * (k + 0.5) / N, t->middle + k * turns);
        fill_turns(t->n, 2.0 * pi * k / N, t->edge + k * turns);
    }
    for (unsigned j = 0; j < M; ++j) {
        double upper = 1.0 - (double)j / M, lower = 1.0 - (double)(j + 1) / M, middle = 1.0 - (j + 0.5) / M;
        fill_zenith(t, upper, 2.0 * pi / N * upper * sqrt(1.0 - upper * upper), t->wall + j * zeniths);
        fill_zenith(t, middle, acos(lower) - acos(upper), t->ring + j * zeniths);
    }
}

SheenStatus sheen_radiance_tables_create(SheenStrata strata, SheenBasis basis, unsigned n, SheenRadianceTables **out)
{
    enum { SECTORS_MAX = 1 << 24 };
    *out = NULL;
    if (strata.density != SHEEN_DENSITY_UNIFORM || strata.rings < 1 || strata.rings > SHEEN_RINGS_MAX ||
        strata.sectors < 1 || strata.sectors > SECTORS_MAX || n < 1 || n > SHEEN_ORDER_MAX)
        return SHEEN_ERR_INVALID;
    size_t turns = (size_t)strata.sectors * (2 * n + 1), zeniths = (size_t)strata.rings * n * (n + 1) / 2;
    SheenRadianceTables *t = malloc(sizeof *t + 2 * (turns + zeniths) * sizeof(float));
    if (!t) return SHEEN_ERR_NOMEM;
    float *numbers = (float *)(t + 1); // behind the struct, which is aligned for pointers
    *t = (SheenRadianceTables){.strata = strata,
                               .basis = basis,
                               .n = n,
                               .middle = numbers,
                               .edge = numbers + turns,
                               .wall = numbers + 2 * turns,
                               .ring = numbers + 2 * turns + zeniths};
    fill_tables(t);
    *out = t;
    return SHEEN_OK;
}

void sheen_radiance_tables_destroy(SheenRadianceTables **tables)
{
    free(*tables);
    *tables = NULL;
}

// ---- estimate ---------------------------------------------------------------------------------------------------

static void project(const SheenRadianceTables *t, const RadianceSamples *samples, Rgb lambda[])
{
    unsigned cells = strata_count(t->strata);
    float per_cell = (float)(2.0 * pi / cells);
    sheen_basis_project(t->basis, t->n, cells, samples->directions, samples->L, lambda);
    for (size_t i = 0; i < basis_size(t->n); ++i) lambda[i] = rgb_scale(lambda[i], per_cell);
}

// Half the smaller squared difference: an edge of the light between two cells is in one of them at most.
static double light_variance(float here, float ring, float sector)
{
    double along = (double)here - (double)ring, across = (double)here - (double)sector;
    return 0.5 * fmin(along * along, across * across);
}

/*
 * White noise of variance V in each cell, 2 pi / cells wide, gives a sum f = sum_i c_i B_i over the hemisphere the
 * variance (2 pi / cells)^2 V sum_k f(w_k)^2 = (2 pi / cells) V |c|^2. A part of V is the basis, which the light
 * scales: on the sphere the functions of an order have a mean squared slope of (n^2 - 1) / 2 times their mean square,
 * and over a square of area A a slope s, of any direction, makes a variance of s^2 A / 12. HSH are SH on a hemisphere
 * that is stretched to twice its area.
 */
static float standard_error(const SheenRadianceTables *t, const Rgb L[])
{
    unsigned M = t->strata.rings, N = t->strata.sectors;
    double cells = (double)M * N, per_cell = 2.0 * pi / cells, light = 0.0, squares = 0.0;
    for (unsigned k = 0; k < N; ++k) {
        const Rgb *here = L + (size_t)k * M, *before = L + (size_t)(k ? k - 1 : N - 1) * M;
        for (unsigned j = 0; j < M; ++j) {
            float value = rgb_luminance(here[j]);
            squares += (double)value * (double)value;
            if (M > 1) light += light_variance(value, rgb_luminance(here[j ? j - 1 : 1]), rgb_luminance(before[j]));
        }
    }
    double area = t->basis == SHEEN_BASIS_HSH ? 2.0 * per_cell : per_cell;
    double slope2 = 0.5 * ((double)t->n * t->n - 1.0);
    return (float)sqrt(per_cell * (light + slope2 * area / 12.0 * squares) / cells);
}

void sheen_estimate_radiance(const SheenRadianceTables *tables, const RadianceSamples *samples, SheenGradient gradient,
                             RadianceEstimate *out)
{
    project(tables, samples, out->lambda);
    if (gradient == SHEEN_GRADIENT_STRATIFIED)
        sheen_radiance_gradient_stratified(tables, samples, out->dx, out->dy);
    else if (gradient == SHEEN_GRADIENT_ANALYTICAL)
        sheen_radiance_gradient_analytical(tables, samples, out->dx, out->dy);
    else if (gradient == SHEEN_GRADIENT_NUMERICAL)
        sheen_radiance_gradient_numerical(tables, samples, out->dx, out->dy);
    out->R = sheen_harmonic_mean(strata_count(tables->strata), samples->distance);
    out->error = standard_error(tables, samples->L);
}
