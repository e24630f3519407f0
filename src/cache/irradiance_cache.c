// SPDX-License-Identifier: Apache-2.0
#include "cache/irradiance_cache.h"

#include <stdlib.h>

SheenStatus sheen_irradiance_cache_create(float accuracy, bool neighbor_clamping, const Bounds *bounds,
                                          SheenIrradianceCache **out)
{
    *out = NULL;
    SheenIrradianceCache *c = calloc(1, sizeof *c);
    if (!c) return SHEEN_ERR_NOMEM;
    SheenStatus status = sheen_store_create(accuracy, neighbor_clamping, bounds, &c->store);
    if (status != SHEEN_OK) {
        free(c);
        return status;
    }
    *out = c;
    return SHEEN_OK;
}

void sheen_irradiance_cache_destroy(SheenIrradianceCache **cache)
{
    if (!cache || !*cache) return;
    sheen_store_destroy(&(*cache)->store);
    free((*cache)->light);
    free(*cache);
    *cache = NULL;
}

// Puts the light where the next record's will be.
static SheenStatus keep_light(SheenIrradianceCache *c, const IrradianceLight *light)
{
    uint32_t n = c->store->n;
    if (n == c->capacity) {
        uint32_t capacity = n ? 2 * n : 1024;
        if (capacity < n) return SHEEN_ERR_NOMEM;
        IrradianceLight *grown = realloc(c->light, (size_t)capacity * sizeof *grown);
        if (!grown) return SHEEN_ERR_NOMEM;
        c->light = grown;
        c->capacity = capacity;
    }
    c->light[n] = *light;
    return SHEEN_OK;
}

SheenStatus sheen_irradiance_cache_insert(SheenIrradianceCache *c, const Record *record, const IrradianceLight *light)
{
    SheenStatus status = keep_light(c, light);
    return status == SHEEN_OK ? sheen_store_insert(c->store, record) : status;
}

SheenStatus sheen_irradiance_cache_append(SheenIrradianceCache *c, const Record *record, const IrradianceLight *light)
{
    SheenStatus status = keep_light(c, light);
    return status == SHEEN_OK ? sheen_store_append(c->store, record) : status;
}

Rgb sheen_irradiance_interpolate(const SheenRecordStore *store, const IrradianceLight light[], const Contributors *c,
                                 Vec3 p, Vec3 n)
{
    Rgb sum = rgb_gray(0.0f);
    if (c->n == 0) return sum;
    for (unsigned i = 0; i < c->n; ++i) {
        uint32_t r = c->record[i];
        sum = rgb_mad(sum, c->weight[i], irradiance_predict(&store->records[r], &light[r], p, n));
    }
    return rgb_scale(sum, 1.0f / c->weight_sum);
}

// The smallest rotation that takes a to b, applied to v.
static Vec3 carry(Vec3 a, Vec3 b, Vec3 v)
{
    Vec3 axis = v3_cross(a, b);
    float c = v3_dot(a, b);
    return v3_add(v3_mad(v3_scale(v, c), v3_dot(axis, v) / (1.0f + c), axis), v3_cross(axis, v));
}

// What a record whose irradiance is E says for a normal bent from its own.
static Rgb predict_bent(const IrradianceLight *light, Rgb E, Vec3 n, Vec3 bent)
{
    float cos_theta = v3_dot(n, bent), k = 1.0f - cos_theta;
    Vec3 w = v3_cross(n, bent), along = v3_mad(bent, -cos_theta, n); // as long as sin(theta)
    float sine = v3_length(along), lean = sine > 0.0f ? maxf(0.0f, 1.0f + v3_dot(light->lean, along) / sine) : 1.0f;
    const Vec3 *r = light->rotation;
    Rgb above = rgb_add(rgb_scale(E, cos_theta), rgb(v3_dot(w, r[0]), v3_dot(w, r[1]), v3_dot(w, r[2])));
    Rgb all = rgb_mad(above, k * lean, light->behind);
    return rgb(maxf(0.0f, all.r), maxf(0.0f, all.g), maxf(0.0f, all.b));
}

Rgb sheen_irradiance_interpolate_bent(const SheenRecordStore *store, const IrradianceLight light[],
                                      const Contributors *c, Vec3 p, Vec3 n, Vec3 bent)
{
    if (n.x == bent.x && n.y == bent.y && n.z == bent.z) return sheen_irradiance_interpolate(store, light, c, p, n);
    Rgb sum = rgb_gray(0.0f);
    if (c->n == 0) return sum;
    for (unsigned i = 0; i < c->n; ++i) {
        const Record *r = &store->records[c->record[i]];
        const IrradianceLight *own = &light[c->record[i]];
        Rgb E = irradiance_predict(r, own, p, n);
        sum = rgb_mad(sum, c->weight[i], predict_bent(own, E, r->n, carry(n, r->n, bent)));
    }
    return rgb_scale(sum, 1.0f / c->weight_sum);
}

uint64_t sheen_irradiance_cache_bytes(const SheenIrradianceCache *c)
{
    return (uint64_t)c->store->n * sizeof *c->light + sheen_store_bytes(c->store);
}
