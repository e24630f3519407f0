// SPDX-License-Identifier: Apache-2.0
#include "gather/radiance.h"

#include "gather/estimate.h"
#include "gather/radiance_gradient.h"
#include "math/quadrature.h"

#include <stdlib.h>

static const double pi = 3.141592653589793;

// ---- tables -----------------------------------------------------------------------------------------------------

enum { NODES_MAX = 2 * SHEEN_ORDER_MAX + 8 };

/** A rule for integrals over [0, 1]. */
typedef struct Rule {
    unsigned n;
    double node[NODES_MAX], weight[NODES_MAX];
} Rule;

// cos(m phi), m = 0 .. n, and sin(m phi), m = 1 .. n.
static void fill_turns(unsigned n, double phi, float out[])
{
    for (unsigned m = 0; m <= n; ++m) {
        if (m) out[n + m] = (float)sin(m * phi);
        out[m] = (float)cos(m * phi);
    }
}

// Adds the zenith factors at one angle.
static void add_zenith(const SheenRadianceTables *t, double theta, double weight, double sum[SHEEN_ZENITH_MAX])
{
    float factor[SHEEN_ZENITH_MAX];
    sheen_basis_zenith(t->basis, t->n, (float)cos(theta), factor);
    for (unsigned i = 0; i < t->n * (t->n + 1) / 2; ++i) sum[i] += weight * (double)factor[i];
}

static void put_zenith(const SheenRadianceTables *t, const double sum[], float out[])
{
    for (unsigned i = 0; i < t->n * (t->n + 1) / 2; ++i) out[i] = (float)sum[i];
}

// A wall to the ring before, at one angle.
static void fill_wall(const SheenRadianceTables *t, double theta, float out[])
{
    double sum[SHEEN_ZENITH_MAX] = {0};
    add_zenith(t, theta, 2.0 * pi / t->strata.sectors * cos(theta) * sin(theta), sum);
    put_zenith(t, sum, out);
}

// A wall to the sector before, from one angle to the other. Hemispherical factors of m = 1 have a root of cos(theta):
// angles that are squares from the lower end take it away.
static void fill_ring(const SheenRadianceTables *t, const Rule *rule, double upper, double lower, float out[])
{
    double sum[SHEEN_ZENITH_MAX] = {0}, width = lower - upper;
    for (unsigned i = 0; i < rule->n; ++i) {
        double u = rule->node[i];
        add_zenith(t, lower - width * u * u, width * 2.0 * u * rule->weight[i], sum);
    }
    put_zenith(t, sum, out);
}

static void fill_tables(const SheenRadianceTables *t)
{
    unsigned M = t->strata.rings, N = t->strata.sectors;
    size_t turns = 2 * t->n + 1, zeniths = t->n * (t->n + 1) / 2;
    for (unsigned k = 0; k < N; ++k) {
        fill_turns(t->n, 2.0 * pi * (k + 0.5) / N, t->middle + k * turns);
        fill_turns(t->n, 2.0 * pi * k / N, t->edge + k * turns);
    }
    Rule rule = {.n = 2 * t->n + 8}; // more than the turns of the factors ask for, even of one ring
    sheen_quadrature_gauss(rule.n, rule.node, rule.weight);
    for (unsigned j = 0; j < M; ++j) {
        double upper = acos(1.0 - (double)j / M), lower = acos(1.0 - (double)(j + 1) / M);
        fill_wall(t, upper, t->wall + j * zeniths);
        fill_ring(t, &rule, upper, lower, t->ring + j * zeniths);
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
