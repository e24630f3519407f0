// SPDX-License-Identifier: Apache-2.0
#include "integrator/gather_light.h"

#include <stdlib.h>

// A record may have as many times the error that is aimed at as its reach is enlarged, up to so many.
static const float error_growth_max = 3.0f;
enum {
    LIGHT_SAMPLES = 1,  // at each hit of a gather: the best value per ray of 1, 2 and 4
    EXTENSIONS_MAX = 2, // vertices by which near hits are moved on
};

// Light at the vertices beyond their direct light, from the deep records.
static void add_deep_light(const SheenDeep *deep, Hemisphere *h)
{
    if (!deep) return;
    for (size_t i = 0; i < h->n_vertices; ++i) {
        const GatherVertex *v = &h->vertices[i];
        Rgb E = sheen_deep_irradiance(deep, v->point.p, v->point.n, (int)v->bounces - 1);
        h->L[v->cell] = rgb_mad(h->L[v->cell], diffuse_point_open(&v->point), rgb_mul(v->weight, E));
    }
}

// Light at the vertices of the rays traced last: direct, and from deeper bounces.
static void light_vertices(const SheenWork *work, const SheenDeep *deep, Hemisphere *h, SheenStats *stats)
{
    sheen_hemisphere_direct(work, 0, LIGHT_SAMPLES, h, stats);
    bool paths = work->options.secondary == SHEEN_SECONDARY_PATH;
    float near = paths ? INFINITY : deep ? sheen_deep_near(deep) : 0.0f;
    unsigned extensions = paths ? work->options.bounces : deep ? EXTENSIONS_MAX : 0;
    for (unsigned i = 0; i < extensions; ++i) {
        size_t before = h->n_vertices, moved = sheen_hemisphere_extend(work, near, h, stats);
        if (moved == 0) break;
        sheen_hemisphere_direct(work, before - moved, 1, h, stats);
    }
    add_deep_light(deep, h);
}

// The hot spots that matter at a point, by the mean radiance about it as the deep records know it.
static void choose_guide(const SheenWork *work, const SheenDeep *deep, const DiffusePoint *p, Hemisphere *h)
{
    Rgb E = sheen_deep_irradiance(deep, p->p, p->n, (int)work->options.bounces - 1);
    float mean = SHEEN_INV_PI * rgb_luminance(E);
    sheen_guide_choose(sheen_deep_hot_spots(deep), p->p, &h->frame, h->strata, mean, SHEEN_GATHER_ERROR, &h->guide);
}

bool sheen_gatherer_init(const SheenWork *work, const SheenDeep *deep, SheenStrata strata, float error,
                         SheenGatherer *out)
{
    *out = (SheenGatherer){work, deep, error, sheen_pool_size(work->pool), NULL};
    out->scratch = calloc(out->workers, sizeof *out->scratch);
    for (unsigned i = 0; i < out->workers; ++i)
        if (!out->scratch || !sheen_hemisphere_reserve(&out->scratch[i], strata)) return false;
    return true;
}

void sheen_gatherer_free(SheenGatherer *g)
{
    for (unsigned i = 0; i < g->workers && g->scratch; ++i) sheen_hemisphere_free(&g->scratch[i]);
    free(g->scratch);
    *g = (SheenGatherer){0};
}

const Hemisphere *sheen_gather_light(const SheenGatherer *gatherer, const DiffusePoint *point, float R_min,
                                     uint32_t key, unsigned worker, SheenStats *stats)
{
    const SheenWork *work = gatherer->work;
    const SheenDeep *deep = gatherer->deep;
    Hemisphere *h = &gatherer->scratch[worker];
    unsigned bounces = work->options.bounces;
    sheen_hemisphere_begin(point, key, h);
    h->glossy = h->L;
    if (deep) choose_guide(work, deep, point, h);
    sheen_hemisphere_trace(work, point, bounces, h, stats);
    light_vertices(work, deep, h, stats);
    float enlarged = R_min / sheen_harmonic_mean((unsigned)h->cells, h->distance);
    float noisier = clampf(enlarged, 1.0f, error_growth_max);
    if (sheen_hemisphere_refine(work, point, bounces, noisier * gatherer->error, h, stats))
        light_vertices(work, deep, h, stats);
    sheen_hemisphere_add_caustics(work, point, noisier, h, stats);
    for (size_t i = 0; i < h->cells; ++i)
        if (!rgb_finite(h->L[i])) {
            h->L[i] = rgb_gray(0.0f);
            ++stats->nonfinite_samples;
        }
    return h;
}
