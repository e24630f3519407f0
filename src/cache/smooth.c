// SPDX-License-Identifier: Apache-2.0
#include "cache/smooth.h"

#include <stdlib.h>
#include <string.h>

// The expected interpolation error as a share of the split-sphere bound 1/w, which is for the worst of scenes.
// Measured: smaller shares blur the Cornell box, larger ones leave noise.
static const float share_of_bound = 0.5f;

typedef struct Smoothing {
    const SheenIrradianceCache *wide; // the records, with twice the reach
    IrradianceRecord *smoothed;       // [records]
} Smoothing;

// What a neighbor says at a record, added with a weight.
static void add(const IrradianceRecord *from, float weight, const IrradianceRecord *at, IrradianceRecord *sum)
{
    sum->E = rgb_mad(sum->E, weight, record_extrapolate(from, at->p, at->n));
    for (int i = 0; i < 3; ++i) {
        sum->translation[i] = v3_mad(sum->translation[i], weight, from->translation[i]);
        sum->rotation[i] = v3_mad(sum->rotation[i], weight, from->rotation[i]);
    }
}

// A gradient lies in the plane of the record, also when the neighbors lie in others.
static Vec3 in_plane(Vec3 g, Vec3 n)
{
    return v3_mad(g, -v3_dot(g, n), n);
}

// By how much two records differ more than noise explains; 1 when it does. On two sides of a wall they do.
static float contrast(const IrradianceRecord *own, const IrradianceRecord *other)
{
    const float sigmas = 4.0f;
    float a = rgb_luminance(own->E), b = rgb_luminance(other->E), noise = maxf(own->error, other->error);
    return maxf(1.0f, maxf(a, b) / (maxf(minf(a, b), 1e-20f) * (1.0f + sigmas * noise)));
}

static void smooth_task(void *user, size_t item, unsigned worker)
{
    (void)worker;
    Smoothing *s = user;
    const IrradianceRecord *own = &s->wide->records[item];
    Contributors near;
    sheen_irradiance_cache_find(s->wide, own->p, own->n, 0.0f, &near);
    IrradianceRecord sum = {.E = rgb_gray(0.0f)};
    float weights = 0.0f;
    for (unsigned i = 0; i < near.n; ++i) {
        const IrradianceRecord *r = &s->wide->records[near.record[i]];
        Vec3 d = v3_sub(own->p, r->p);
        float w =
            r == own ? INFINITY : record_weight(minf(r->R_sure, own->R_sure), v3_length2(d), v3_dot(own->n, r->n));
        float variance = (sqrf(r->error) + sqrf(share_of_bound / w)) * sqrf(contrast(own, r));
        if (!(variance > 0.0f)) continue;
        add(r, 1.0f / variance, own, &sum);
        weights += 1.0f / variance;
    }
    if (!(own->error > 0.0f) || !(weights > 0.0f) || !isfinite(weights)) return;
    IrradianceRecord *out = &s->smoothed[item];
    out->E = rgb_scale(sum.E, 1.0f / weights);
    for (int i = 0; i < 3; ++i) {
        out->translation[i] = v3_scale(in_plane(sum.translation[i], own->n), 1.0f / weights);
        out->rotation[i] = v3_scale(in_plane(sum.rotation[i], own->n), 1.0f / weights);
    }
}

static SheenStatus widen(const SheenIrradianceCache *cache, const Bounds *bounds, SheenIrradianceCache **wide)
{
    SheenStatus status = sheen_irradiance_cache_create(2.0f * cache->accuracy, false, bounds, wide);
    for (uint32_t i = 0; i < cache->n_records && status == SHEEN_OK; ++i)
        status = sheen_irradiance_cache_insert(*wide, &cache->records[i]);
    return status;
}

SheenStatus sheen_irradiance_cache_smooth(SheenIrradianceCache *cache, const Bounds *bounds, SheenPool *pool,
                                          const atomic_bool *cancel)
{
    if (cache->n_records == 0) return SHEEN_OK;
    size_t bytes = cache->n_records * sizeof *cache->records;
    Smoothing s = {.smoothed = malloc(bytes)};
    SheenIrradianceCache *wide = NULL;
    SheenStatus status = s.smoothed ? widen(cache, bounds, &wide) : SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK) {
        memcpy(s.smoothed, cache->records, bytes);
        s.wide = wide;
        if (!sheen_pool_run(pool, cache->n_records, smooth_task, &s, cancel)) status = SHEEN_ERR_CANCELLED;
    }
    if (status == SHEEN_OK) memcpy(cache->records, s.smoothed, bytes);
    free(s.smoothed);
    sheen_irradiance_cache_destroy(&wide);
    return status;
}
