// SPDX-License-Identifier: Apache-2.0
#include "cache/smooth.h"

#include <stdlib.h>
#include <string.h>

// The expected interpolation error as a share of the split-sphere bound 1/w, which is for the worst of scenes.
// Measured: smaller shares blur the Cornell box, larger ones leave noise.
static const float share_of_bound = 0.5f;

typedef struct Smoothing {
    const SheenRecordStore *wide; // the records, with twice the reach
    uint32_t first;               // of the records that learn
    // One of the two caches, and what becomes of its light.
    const SheenIrradianceCache *irradiance;
    const SheenRadianceCache *radiance;
    IrradianceLight *irradiance_out; // [records]
    float *radiance_out;             // [records][radiance_light_floats]
} Smoothing;

/** What a record learns from: records, itself among them, and weights of sum 1. */
typedef struct Teachers {
    unsigned n;
    uint32_t record[SHEEN_CONTRIBUTORS_MAX];
    float weight[SHEEN_CONTRIBUTORS_MAX];
} Teachers;

static const float *radiance_of(const SheenRadianceCache *c, uint32_t record)
{
    return c->light + record * radiance_light_floats(c);
}

// The light that comes in, by which records are compared: of radiance its mean, the first coefficient.
static float brightness(const Smoothing *s, uint32_t record)
{
    if (s->irradiance) return rgb_luminance(s->irradiance->light[record].E);
    const float *c = radiance_of(s->radiance, record);
    return rgb_luminance(rgb(c[0], c[1], c[2]));
}

// By how much two records differ more than noise explains; 1 when it does. On two sides of a wall they do.
static float contrast(const Smoothing *s, uint32_t own, uint32_t other)
{
    const float sigmas = 4.0f;
    float a = brightness(s, own), b = brightness(s, other);
    float noise = maxf(s->wide->records[own].error, s->wide->records[other].error);
    return maxf(1.0f, maxf(a, b) / (maxf(minf(a, b), 1e-20f) * (1.0f + sigmas * noise)));
}

// By how much less far than their radii say the light of two radiance records is alike: refinement told some apart, for
// it knows lobes and radii do not. The root of what it came to, for some of that was noise. Measured: without this
// refined floors were no better than before, by the whole of it a rougher picture's noise grows by 3 %.
static float told_apart(const SheenRecordStore *store, uint32_t own, uint32_t other)
{
    return sqrtf(minf(store->records[own].a, store->records[other].a) / store->accuracy);
}

// @return false where the record stays as it is
static bool find_teachers(const Smoothing *s, uint32_t own, Teachers *out)
{
    const Record *at = &s->wide->records[own];
    bool alike = s->radiance && s->radiance->basis == SHEEN_BASIS_HSH;
    Contributors near;
    sheen_store_find(s->wide, at->p, at->n, &near);
    float weights = 0.0f;
    out->n = 0;
    for (unsigned i = 0; i < near.n; ++i) {
        uint32_t other = near.record[i];
        const Record *r = &s->wide->records[other];
        float d2 = record_distance2(r, at->p), cos_n = v3_dot(at->n, r->n);
        if (alike && !(cos_n > SHEEN_SAME_COS)) continue;
        // The reach of irradiance tells how far the light is alike; that of radiance is cut by gradients whose noise is
        // that of all coefficients.
        float R =
            s->radiance ? minf(r->R, at->R) * told_apart(s->radiance->store, own, other) : minf(r->R_sure, at->R_sure);
        float w = other == own ? INFINITY : record_weight(R, d2, cos_n);
        float variance = (sqrf(r->error) + sqrf(share_of_bound / w)) * sqrf(contrast(s, own, other));
        if (!(variance > 0.0f)) continue;
        out->record[out->n] = other;
        out->weight[out->n++] = 1.0f / variance;
        weights += 1.0f / variance;
    }
    if (!(at->error > 0.0f) || !(weights > 0.0f) || !isfinite(weights)) return false;
    for (unsigned i = 0; i < out->n; ++i) out->weight[i] /= weights;
    return true;
}

// A gradient lies in the plane of the record, also when the neighbors lie in others.
static Vec3 in_plane(Vec3 g, Vec3 n)
{
    return v3_mad(g, -v3_dot(g, n), n);
}

static void smooth_irradiance(void *user, size_t item, unsigned worker)
{
    (void)worker;
    Smoothing *s = user;
    Teachers from;
    uint32_t own = s->first + (uint32_t)item;
    if (!find_teachers(s, own, &from)) return;
    const Record *at = &s->wide->records[own];
    IrradianceLight sum = {.E = rgb_gray(0.0f)};
    for (unsigned k = 0; k < from.n; ++k) {
        uint32_t other = from.record[k];
        const IrradianceLight *light = &s->irradiance->light[other];
        sum.E = rgb_mad(sum.E, from.weight[k], irradiance_predict(&s->wide->records[other], light, at->p, at->n));
        for (int i = 0; i < 3; ++i) {
            sum.translation[i] = v3_mad(sum.translation[i], from.weight[k], light->translation[i]);
            sum.rotation[i] = v3_mad(sum.rotation[i], from.weight[k], light->rotation[i]);
        }
        sum.behind = rgb_mad(sum.behind, from.weight[k], light->behind);
        sum.lean = v3_mad(sum.lean, from.weight[k], light->lean);
    }
    for (int i = 0; i < 3; ++i) {
        sum.translation[i] = in_plane(sum.translation[i], at->n);
        sum.rotation[i] = in_plane(sum.rotation[i], at->n);
    }
    sum.lean = in_plane(sum.lean, at->n);
    s->irradiance_out[own] = sum;
}

// Adds what a record says at another, its derivatives turned to the other's axes.
static void add_radiance(const SheenRadianceCache *c, uint32_t from, float weight, const Record *at, float sum[])
{
    const float *value = radiance_of(c, from), *dx = value + c->stride, *dy = dx + c->stride;
    Frame here = frame_from_normal(at->n), there = frame_from_normal(c->store->records[from].n);
    Vec3 d = v3_sub(at->p, c->store->records[from].p);
    float x = weight * v3_dot(d, there.t), y = weight * v3_dot(d, there.b);
    float tt = weight * v3_dot(here.t, there.t), tb = weight * v3_dot(here.t, there.b);
    float bt = weight * v3_dot(here.b, there.t), bb = weight * v3_dot(here.b, there.b);
    for (size_t i = 0; i < c->stride; ++i) {
        sum[i] += weight * value[i] + x * dx[i] + y * dy[i];
        sum[c->stride + i] += tt * dx[i] + tb * dy[i];
        sum[2 * c->stride + i] += bt * dx[i] + bb * dy[i];
    }
}

static void smooth_radiance(void *user, size_t item, unsigned worker)
{
    (void)worker;
    Smoothing *s = user;
    const SheenRadianceCache *c = s->radiance;
    Teachers from;
    uint32_t own = s->first + (uint32_t)item;
    if (!find_teachers(s, own, &from)) return;
    float *out = s->radiance_out + own * radiance_light_floats(c);
    memset(out, 0, radiance_light_floats(c) * sizeof *out);
    for (unsigned k = 0; k < from.n; ++k) add_radiance(c, from.record[k], from.weight[k], &s->wide->records[own], out);
}

static SheenStatus widen(const SheenRecordStore *store, const Bounds *bounds, SheenRecordStore **wide)
{
    SheenStatus status = sheen_store_create(2.0f * store->accuracy, false, bounds, wide);
    for (uint32_t i = 0; i < store->n && status == SHEEN_OK; ++i) {
        Record r = store->records[i];
        r.a = 2.0f * store->accuracy;
        status = sheen_store_append(*wide, &r);
    }
    return status;
}

// Runs over all records of a store. @param light  [bytes], replaced when all is done @param out  a copy of it
static SheenStatus run(const SheenRecordStore *store, const Bounds *bounds, SheenPool *pool, const atomic_bool *cancel,
                       void (*task)(void *, size_t, unsigned), Smoothing *s, void *light, void *out, size_t bytes)
{
    SheenRecordStore *wide = NULL;
    SheenStatus status = out ? widen(store, bounds, &wide) : SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK) {
        memcpy(out, light, bytes);
        s->wide = wide;
        if (!sheen_pool_run(pool, store->n - s->first, task, s, cancel)) status = SHEEN_ERR_CANCELLED;
    }
    if (status == SHEEN_OK) memcpy(light, out, bytes);
    sheen_store_destroy(&wide);
    free(out);
    return status;
}

SheenStatus sheen_irradiance_cache_smooth(SheenIrradianceCache *cache, uint32_t first, const Bounds *bounds,
                                          SheenPool *pool, const atomic_bool *cancel)
{
    size_t bytes = cache->store->n * sizeof *cache->light;
    if (first >= cache->store->n) return SHEEN_OK;
    Smoothing s = {.first = first, .irradiance = cache, .irradiance_out = malloc(bytes)};
    return run(cache->store, bounds, pool, cancel, smooth_irradiance, &s, cache->light, s.irradiance_out, bytes);
}

SheenStatus sheen_radiance_cache_smooth(SheenRadianceCache *cache, uint32_t first, const Bounds *bounds,
                                        SheenPool *pool, const atomic_bool *cancel)
{
    size_t bytes = cache->store->n * radiance_light_floats(cache) * sizeof *cache->light;
    if (first >= cache->store->n) return SHEEN_OK;
    Smoothing s = {.first = first, .radiance = cache, .radiance_out = malloc(bytes)};
    return run(cache->store, bounds, pool, cancel, smooth_radiance, &s, cache->light, s.radiance_out, bytes);
}
