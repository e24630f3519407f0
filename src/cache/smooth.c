// SPDX-License-Identifier: Apache-2.0
#include "cache/smooth.h"

#include <stdlib.h>
#include <string.h>

// The expected interpolation error as a share of the split-sphere bound 1/w, which is for the worst of scenes.
// Measured: smaller shares blur the Cornell box, larger ones leave noise.
static const float share_of_bound = 0.5f;

typedef struct Smoothing {
    const SheenRecordStore *wide; // the records, with twice the reach
    const IrradianceLight *light; // [records]
    IrradianceLight *smoothed;    // [records]
} Smoothing;

// What a neighbor says at a record, added with a weight.
static void add(const Smoothing *s, uint32_t from, float weight, const Record *at, IrradianceLight *sum)
{
    const IrradianceLight *light = &s->light[from];
    sum->E = rgb_mad(sum->E, weight, irradiance_predict(&s->wide->records[from], light, at->p, at->n));
    for (int i = 0; i < 3; ++i) {
        sum->translation[i] = v3_mad(sum->translation[i], weight, light->translation[i]);
        sum->rotation[i] = v3_mad(sum->rotation[i], weight, light->rotation[i]);
    }
}

// A gradient lies in the plane of the record, also when the neighbors lie in others.
static Vec3 in_plane(Vec3 g, Vec3 n)
{
    return v3_mad(g, -v3_dot(g, n), n);
}

// By how much two records differ more than noise explains; 1 when it does. On two sides of a wall they do.
static float contrast(const Smoothing *s, uint32_t own, uint32_t other)
{
    const float sigmas = 4.0f;
    float a = rgb_luminance(s->light[own].E), b = rgb_luminance(s->light[other].E);
    float noise = maxf(s->wide->records[own].error, s->wide->records[other].error);
    return maxf(1.0f, maxf(a, b) / (maxf(minf(a, b), 1e-20f) * (1.0f + sigmas * noise)));
}

static void smooth_task(void *user, size_t item, unsigned worker)
{
    (void)worker;
    Smoothing *s = user;
    uint32_t own = (uint32_t)item;
    const Record *at = &s->wide->records[own];
    Contributors near;
    sheen_store_find(s->wide, at->p, at->n, 0.0f, &near);
    IrradianceLight sum = {.E = rgb_gray(0.0f)};
    float weights = 0.0f;
    for (unsigned i = 0; i < near.n; ++i) {
        uint32_t other = near.record[i];
        const Record *r = &s->wide->records[other];
        Vec3 d = v3_sub(at->p, r->p);
        float w =
            other == own ? INFINITY : record_weight(minf(r->R_sure, at->R_sure), v3_length2(d), v3_dot(at->n, r->n));
        float variance = (sqrf(r->error) + sqrf(share_of_bound / w)) * sqrf(contrast(s, own, other));
        if (!(variance > 0.0f)) continue;
        add(s, other, 1.0f / variance, at, &sum);
        weights += 1.0f / variance;
    }
    if (!(at->error > 0.0f) || !(weights > 0.0f) || !isfinite(weights)) return;
    IrradianceLight *out = &s->smoothed[own];
    out->E = rgb_scale(sum.E, 1.0f / weights);
    for (int i = 0; i < 3; ++i) {
        out->translation[i] = v3_scale(in_plane(sum.translation[i], at->n), 1.0f / weights);
        out->rotation[i] = v3_scale(in_plane(sum.rotation[i], at->n), 1.0f / weights);
    }
}

static SheenStatus widen(const SheenRecordStore *store, const Bounds *bounds, SheenRecordStore **wide)
{
    SheenStatus status = sheen_store_create(2.0f * store->accuracy, false, bounds, wide);
    for (uint32_t i = 0; i < store->n && status == SHEEN_OK; ++i)
        status = sheen_store_insert(*wide, &store->records[i]);
    return status;
}

SheenStatus sheen_irradiance_cache_smooth(SheenIrradianceCache *cache, const Bounds *bounds, SheenPool *pool,
                                          const atomic_bool *cancel)
{
    uint32_t n = cache->store->n;
    if (n == 0) return SHEEN_OK;
    size_t bytes = n * sizeof *cache->light;
    SheenRecordStore *wide = NULL;
    Smoothing s = {.light = cache->light, .smoothed = malloc(bytes)};
    SheenStatus status = s.smoothed ? widen(cache->store, bounds, &wide) : SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK) {
        memcpy(s.smoothed, cache->light, bytes);
        s.wide = wide;
        if (!sheen_pool_run(pool, n, smooth_task, &s, cancel)) status = SHEEN_ERR_CANCELLED;
    }
    if (status == SHEEN_OK) memcpy(cache->light, s.smoothed, bytes);
    free(s.smoothed);
    sheen_store_destroy(&wide);
    return status;
}
