// SPDX-License-Identifier: Apache-2.0
#include "cache/radiance_cache.h"

#include <stdlib.h>
#include <string.h>

// Sums are kept in so many lanes, a multiple of the three colours, and vectors are padded to a multiple of it.
enum { LANES = 12 };

SheenStatus sheen_radiance_cache_create(SheenBasis basis, unsigned order, bool tilted, float accuracy,
                                        bool neighbor_clamping, const Bounds *bounds, SheenRadianceCache **out)
{
    *out = NULL;
    SheenRadianceCache *c = calloc(1, sizeof *c);
    if (!c) return SHEEN_ERR_NOMEM;
    c->basis = basis;
    c->order = order;
    c->stride = (3 * basis_size(order) + LANES - 1) / LANES * LANES;
    // A record serves where 1 - n . n_i < a^2.
    float tilt_max = tilted ? acosf(clampf(1.0f - sqrf(accuracy), 0.0f, 1.0f)) : acosf(SHEEN_SAME_COS);
    SheenStatus status = sheen_store_create(accuracy, neighbor_clamping, bounds, &c->store);
    if (status == SHEEN_OK) status = sheen_rotation_create(basis, order, tilt_max, &c->rotation);
    if (status != SHEEN_OK) {
        sheen_radiance_cache_destroy(&c);
        return status;
    }
    if (basis == SHEEN_BASIS_HSH && !tilted) c->store->cos_min = SHEEN_SAME_COS;
    *out = c;
    return SHEEN_OK;
}

void sheen_radiance_cache_destroy(SheenRadianceCache **cache)
{
    if (!cache || !*cache) return;
    sheen_store_destroy(&(*cache)->store);
    sheen_rotation_destroy(&(*cache)->rotation);
    free((*cache)->light);
    free(*cache);
    *cache = NULL;
}

// Puts the light where the next record's will be.
static SheenStatus keep_light(SheenRadianceCache *c, const float light[])
{
    uint32_t n = c->store->n;
    size_t floats = radiance_light_floats(c);
    if (n == c->capacity) {
        uint32_t capacity = n ? 2 * n : 256;
        if (capacity < n || capacity > SIZE_MAX / (floats * sizeof *c->light)) return SHEEN_ERR_NOMEM;
        float *grown = realloc(c->light, capacity * floats * sizeof *grown);
        if (!grown) return SHEEN_ERR_NOMEM;
        c->light = grown;
        c->capacity = capacity;
    }
    memcpy(c->light + n * floats, light, floats * sizeof *light);
    return SHEEN_OK;
}

SheenStatus sheen_radiance_cache_insert(SheenRadianceCache *c, const Record *record, const float light[])
{
    SheenStatus status = keep_light(c, light);
    return status == SHEEN_OK ? sheen_store_insert(c->store, record) : status;
}

SheenStatus sheen_radiance_cache_append(SheenRadianceCache *c, const Record *record, const float light[])
{
    SheenStatus status = keep_light(c, light);
    return status == SHEEN_OK ? sheen_store_append(c->store, record) : status;
}

/** A lobe's coefficients with room for the padding. */
typedef struct LobeVector {
    size_t used; // floats, a multiple of LANES
    float c[3 * SHEEN_BASIS_MAX + LANES];
} LobeVector;

// The dot product of a lobe with a record's light moved by (x, y), a colour each. All vectors are padded with zeros.
static Rgb dot_moved(size_t stride, const LobeVector *lobe, const float light[], float x, float y)
{
    const float *dx = light + stride, *dy = light + 2 * stride;
    float sum[LANES] = {0};
    for (size_t i = 0; i < lobe->used; i += LANES)
        for (size_t k = 0; k < LANES; ++k) sum[k] += lobe->c[i + k] * (light[i + k] + x * dx[i + k] + y * dy[i + k]);
    Rgb out = rgb_gray(0.0f);
    for (size_t k = 0; k < LANES; k += 3) out = rgb_add(out, rgb(sum[k], sum[k + 1], sum[k + 2]));
    return out;
}

// The lobe in a record's frame. Equal normals have equal frames, but for those on two sides of where the choice of the
// frame jumps.
static const LobeVector *in_frame(const SheenRadianceCache *cache, const Frame *here, const Frame *there,
                                  const LobeVector *lobe, LobeVector *turned)
{
    if (cache->basis == SHEEN_BASIS_SH) return lobe;
    if (v3_dot(here->t, there->t) > SHEEN_SAME_COS && v3_dot(here->n, there->n) > SHEEN_SAME_COS) return lobe;
    turned->used = cache->stride;
    memcpy(turned->c, lobe->c, lobe->used * sizeof *lobe->c);
    memset(turned->c + lobe->used, 0, (turned->used - lobe->used) * sizeof *lobe->c);
    sheen_rotation_apply(cache->rotation, sheen_euler_between(here, there), 3, turned->c, turned->c);
    return turned;
}

Rgb sheen_radiance_reflect(const SheenRadianceCache *cache, const Contributors *c, Vec3 p, Vec3 n,
                           const RadianceLobe *lobe)
{
    Rgb sum = rgb_gray(0.0f);
    if (c->n == 0) return sum;
    LobeVector own, turned;
    size_t floats = 3 * basis_size(lobe->order);
    own.used = (floats + LANES - 1) / LANES * LANES;
    memcpy(own.c, lobe->coefficients, floats * sizeof *own.c);
    memset(own.c + floats, 0, (own.used - floats) * sizeof *own.c);
    Frame here = frame_from_normal(n);
    for (unsigned i = 0; i < c->n; ++i) {
        const Record *r = &cache->store->records[c->record[i]];
        Frame there = frame_from_normal(r->n);
        Vec3 d = v3_sub(p, r->p);
        const LobeVector *v = in_frame(cache, &here, &there, &own, &turned);
        const float *light = cache->light + c->record[i] * radiance_light_floats(cache);
        sum = rgb_mad(sum, c->weight[i], dot_moved(cache->stride, v, light, v3_dot(d, there.t), v3_dot(d, there.b)));
    }
    sum = rgb_scale(sum, 1.0f / c->weight_sum);
    return rgb(maxf(sum.r, 0.0f), maxf(sum.g, 0.0f), maxf(sum.b, 0.0f));
}

uint64_t sheen_radiance_cache_bytes(const SheenRadianceCache *c)
{
    return (uint64_t)c->store->n * radiance_light_floats(c) * sizeof *c->light + sheen_store_bytes(c->store);
}
