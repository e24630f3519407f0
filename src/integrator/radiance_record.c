// SPDX-License-Identifier: Apache-2.0
#include "integrator/radiance_record.h"

#include "gather/radiance.h"
#include "integrator/gather_light.h"
#include "integrator/record_radius.h"

#include <stdlib.h>
#include <string.h>

struct SheenRadianceMaker {
    const SheenRadianceCache *like;
    SheenGatherer gatherer;
    SheenRadianceTables *tables;
};

// What a lobe sees is a part of the strata: their mean must be better than for irradiance. Smaller errors gain nothing:
// the rays are as many as there may be.
static const float radiance_error = 0.01f;

// A gather needs several rays for each coefficient.
static SheenStrata strata_for(const SheenOptions *o, unsigned order)
{
    uint32_t least = 16 * (uint32_t)basis_size(order);
    return sheen_strata_uniform(o->gather_rays > least ? o->gather_rays : least);
}

SheenStatus sheen_radiance_maker_create(const SheenWork *work, const SheenDeep *deep, const SheenRadianceCache *like,
                                        SheenRadianceMaker **out)
{
    *out = NULL;
    SheenRadianceMaker *m = calloc(1, sizeof *m);
    if (!m) return SHEEN_ERR_NOMEM;
    m->like = like;
    SheenStrata strata = strata_for(&work->options, like->order);
    SheenStatus status = sheen_radiance_tables_create(strata, like->basis, like->order, &m->tables);
    if (status == SHEEN_OK && !sheen_gatherer_init(work, deep, strata, radiance_error, &m->gatherer))
        status = SHEEN_ERR_NOMEM;
    if (status != SHEEN_OK) sheen_radiance_maker_destroy(&m);
    *out = m;
    return status;
}

void sheen_radiance_maker_destroy(SheenRadianceMaker **maker)
{
    if (!maker || !*maker) return;
    sheen_gatherer_free(&(*maker)->gatherer);
    sheen_radiance_tables_destroy(&(*maker)->tables);
    free(*maker);
    *maker = NULL;
}

static double square_sum(size_t n, const Rgb v[])
{
    double sum = 0.0;
    for (size_t i = 0; i < n; ++i) {
        double y = (double)rgb_luminance(v[i]); // whose square is beyond floats in the faintest and brightest scenes
        sum += y * y;
    }
    return sum;
}

// The harmonic mean distance, bounded by the light over its gradient, both as vectors. Source:
// krivanek2006-making-caching-practical sec. 5.1.
static float gradient_radius(size_t n, const RadianceEstimate *e)
{
    double slope = sqrt(square_sum(n, e->dx) + square_sum(n, e->dy));
    return slope > 0.0 ? minf(e->R, (float)(sqrt(square_sum(n, e->lambda)) / slope)) : e->R;
}

// Standard error relative to what a lobe as narrow as the order resolves sees of even light of the same energy: such a
// lobe of norm 1 takes one part in n of |lambda|.
static float relative_error(unsigned order, const RadianceEstimate *e)
{
    float norm = (float)sqrt(square_sum(basis_size(order), e->lambda));
    return norm > 0.0f ? e->error * (float)order / norm : 0.0f;
}

// On a curved surface a record serves points whose horizon lies lower than its own on one side. There it takes what it
// mirrors of the light above for what it did not see; black would be the worst of guesses, and an edge of the light
// that an order resolves badly. Of a function and its mirror image those harmonics are left that are even in z, twice.
static void mirror_below(unsigned order, Rgb c[])
{
    for (unsigned l = 0; l < order; ++l)
        for (int m = -(int)l; m <= (int)l; ++m)
            c[basis_index(l, m)] = rgb_scale(c[basis_index(l, m)], ((int)l + m) % 2 == 0 ? 2.0f : 0.0f);
}

static void make(const void *maker, const ShadingPoint *p, float a, uint32_t key, unsigned worker, SheenStats *stats,
                 Record *record, void *out)
{
    const SheenRadianceMaker *m = maker;
    const SheenOptions *o = &m->gatherer.work->options;
    const SheenRadianceCache *cache = m->like;
    float R_min = record_least_radius(o, a, p->footprint);
    const Hemisphere *h = sheen_gather_light(&m->gatherer, &p->point, R_min, key, worker, stats);
    float *light = out;
    memset(light, 0, radiance_light_floats(cache) * sizeof *light);
    Rgb *parts[3];
    for (size_t i = 0; i < 3; ++i) parts[i] = (Rgb *)(void *)(light + i * cache->stride);
    RadianceEstimate e = {.lambda = parts[0], .dx = parts[1], .dy = parts[2]};
    RadianceSamples samples = {h->directions, h->L, h->distance, h->normals};
    sheen_estimate_radiance(m->tables, &samples, o->gradients, &e);
    size_t n = basis_size(cache->order);
    *record = (Record){.p = p->point.p, .n = p->point.n, .a = a, .error = relative_error(cache->order, &e)};
    float R = o->gradient_clamping ? gradient_radius(n, &e) : e.R;
    record_set_radius(o, p->footprint, R, record);
    float scale = estimate_gradient_share(R, record->R_min);
    for (size_t i = 0; i < 2 * cache->stride; ++i) light[cache->stride + i] *= scale;
    if (cache->basis == SHEEN_BASIS_HSH) return;
    for (size_t i = 0; i < 3; ++i) {
        float *part = light + i * cache->stride;
        mirror_below(cache->order, parts[i]);
        sheen_rotation_to_world(cache->rotation, &h->frame, 3, part, part);
    }
}

static SheenStatus insert(void *cache, const Record *record, const void *light)
{
    return sheen_radiance_cache_insert(cache, record, light);
}

RecordKind sheen_radiance_kind(const SheenRadianceMaker *maker, SheenRadianceCache *cache)
{
    return (RecordKind){radiance_light_floats(cache) * sizeof(float), maker, make, cache->store, NULL, cache, insert};
}
