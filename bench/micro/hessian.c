// SPDX-License-Identifier: Apache-2.0
// Microseconds that the Hessian of irradiance takes beside the irradiance and its gradients, on one thread.
//
//     bench_hessian
//
// Light and distances are random, a tenth is sky: no edge is left out because both sides are alike, as edges within
// the sky or between equal walls are. Each number is the median of 5 runs over 64 gathers, in CPU time of this process.
#include "gather/hessian.h"
#include "base/hash.h"
#include "gather/estimate.h"
#include "timing.h"

#include <stdio.h>
#include <stdlib.h>

enum { RAYS_MAX = 8192, N_GATHERS = 64, N_RUNS = 5 };

typedef struct Gather {
    Vec3 directions[RAYS_MAX];
    Rgb L[RAYS_MAX];
    float distance[RAYS_MAX];
} Gather;

static void make(SheenStrata s, uint32_t key, Gather *g)
{
    sheen_strata_directions(s, key, g->directions);
    for (uint32_t i = 0; i < strata_count(s); ++i) {
        uint32_t h = hash_combine(key, i);
        float u = hash_to_unit(h), v = hash_to_unit(hash_u32(h));
        g->L[i] = rgb(u, v, u * v);
        g->distance[i] = u < 0.1f ? INFINITY : 0.5f + v;
    }
}

// @return something of the result: what is read cannot be left out by the compiler.
static float estimate(SheenStrata s, bool hessian, const Gather *g)
{
    if (hessian) {
        IrradianceHessian h;
        sheen_estimate_hessian(s, g->directions, g->L, g->distance, &h, NULL);
        return h.xx + h.xy + h.yy;
    }
    IrradianceEstimate e;
    sheen_estimate_irradiance(s, g->L, g->distance, &e);
    return e.E.g + e.translation[0].g + e.rotation[1].g + e.R;
}

static double median(SheenStrata s, bool hessian, const Gather gathers[], float *sum)
{
    double times[N_RUNS];
    for (int r = -1; r < N_RUNS; ++r) { // the first warms up
        double start = processor_seconds();
        for (int i = 0; i < N_GATHERS; ++i) *sum += estimate(s, hessian, &gathers[i]);
        if (r >= 0) times[r] = processor_seconds() - start;
    }
    qsort(times, N_RUNS, sizeof *times, by_value);
    return 1e6 * times[N_RUNS / 2] / N_GATHERS;
}

int main(void)
{
    static Gather gathers[N_GATHERS];
    static const unsigned rays[] = {400, 1024, 6400};
    float sum = 0.0f;
    printf("microseconds a gather\n%6s %12s %12s %8s\n", "rays", "irradiance", "hessian", "ratio");
    for (size_t i = 0; i < sizeof rays / sizeof *rays; ++i) {
        SheenStrata s = sheen_strata_cosine(rays[i]);
        if (strata_count(s) > RAYS_MAX) return 1;
        for (uint32_t k = 0; k < N_GATHERS; ++k) make(s, k, &gathers[k]);
        double irradiance = median(s, false, gathers, &sum), hessian = median(s, true, gathers, &sum);
        printf("%6u %12.1f %12.1f %8.1f\n", strata_count(s), irradiance, hessian, hessian / irradiance);
    }
    printf("\n(%g)\n", (double)sum);
    return 0;
}
