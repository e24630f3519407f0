// SPDX-License-Identifier: Apache-2.0
// Microseconds that a gather's estimate of radiance takes beside its rays, on one thread, for 1024 of them.
//
//     bench_radiance_gather
//
//     projection    sheen_basis_project alone, on the gather's directions and light
//     none          the whole estimate without gradients: + harmonic mean distance, standard error
//     stratified .. with the gradient of that name
//
// Light and distances are random, a tenth is sky: nothing depends on their values. Each number is the median of 5 runs
// over 64 gathers, in CPU time of this process.
#include "base/hash.h"
#include "gather/radiance.h"
#include "timing.h"

#include <stdio.h>
#include <stdlib.h>

enum { RAYS = 1024, N_GATHERS = 64, N_RUNS = 5, N_METHODS = 5 };
enum { PROJECTION = SHEEN_GRADIENT_NONE + 1 };

static const struct {
    const char *name;
    int gradient; // a SheenGradient, or PROJECTION
} methods[N_METHODS] = {{"projection", PROJECTION},
                        {"none", SHEEN_GRADIENT_NONE},
                        {"stratified", SHEEN_GRADIENT_STRATIFIED},
                        {"analytical", SHEEN_GRADIENT_ANALYTICAL},
                        {"numerical", SHEEN_GRADIENT_NUMERICAL}};

typedef struct Gather {
    Vec3 directions[RAYS], normals[RAYS];
    Rgb L[RAYS];
    float distance[RAYS];
} Gather;

static void make(SheenStrata s, uint32_t key, Gather *g)
{
    sheen_strata_directions(s, key, g->directions);
    for (uint32_t i = 0; i < RAYS; ++i) {
        uint32_t h = hash_combine(key, i);
        float u = hash_to_unit(h), v = hash_to_unit(hash_u32(h));
        g->L[i] = rgb(u, v, u * v);
        g->distance[i] = u < 0.1f ? INFINITY : 0.5f + v;
        g->normals[i] = v3_normalize(v3(u - 0.5f, v - 0.5f, -0.5f));
    }
}

// @return something of the result: what is read cannot be left out by the compiler.
static float estimate(const SheenRadianceTables *tables, SheenBasis basis, unsigned n, int gradient, const Gather *g)
{
    static Rgb lambda[SHEEN_BASIS_MAX], dx[SHEEN_BASIS_MAX], dy[SHEEN_BASIS_MAX];
    if (gradient == PROJECTION) {
        sheen_basis_project(basis, n, RAYS, g->directions, g->L, lambda);
        return lambda[n].r;
    }
    RadianceSamples samples = {g->directions, g->L, g->distance, g->normals};
    RadianceEstimate e = {.lambda = lambda, .dx = dx, .dy = dy};
    sheen_estimate_radiance(tables, &samples, (SheenGradient)gradient, &e);
    return lambda[n].r + dx[n].g + dy[n].b + e.error;
}

static double median(const SheenRadianceTables *tables, SheenBasis basis, unsigned n, int gradient,
                     const Gather gathers[], float *sum)
{
    double times[N_RUNS];
    for (int r = -1; r < N_RUNS; ++r) { // the first warms up
        double start = processor_seconds();
        for (int i = 0; i < N_GATHERS; ++i) *sum += estimate(tables, basis, n, gradient, &gathers[i]);
        if (r >= 0) times[r] = processor_seconds() - start;
    }
    qsort(times, N_RUNS, sizeof *times, by_value);
    return times[N_RUNS / 2] / N_GATHERS;
}

int main(void)
{
    static Gather gathers[N_GATHERS];
    static const unsigned orders[] = {4, 6, 10};
    SheenStrata strata = sheen_strata_uniform(RAYS);
    if (strata_count(strata) != RAYS) return 1;
    for (uint32_t i = 0; i < N_GATHERS; ++i) make(strata, i, &gathers[i]);
    float sum = 0.0f;
    printf("microseconds a gather of %d rays\n%-16s", RAYS, "");
    for (int m = 0; m < N_METHODS; ++m) printf("%12s", methods[m].name);
    for (int b = 0; b < 2; ++b)
        for (size_t o = 0; o < sizeof orders / sizeof *orders; ++o) {
            SheenBasis basis = b ? SHEEN_BASIS_SH : SHEEN_BASIS_HSH;
            SheenRadianceTables *tables;
            if (sheen_radiance_tables_create(strata, basis, orders[o], &tables) != SHEEN_OK) return 1;
            printf("\n%-4s order %-6u", b ? "SH" : "HSH", orders[o]);
            for (int m = 0; m < N_METHODS; ++m)
                printf("%12.1f", 1e6 * median(tables, basis, orders[o], methods[m].gradient, gathers, &sum));
            sheen_radiance_tables_destroy(&tables);
        }
    printf("\n\n(%g)\n", (double)sum);
    return 0;
}
