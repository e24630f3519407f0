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

uint64_t sheen_irradiance_cache_bytes(const SheenIrradianceCache *c)
{
    return (uint64_t)c->store->n * sizeof *c->light + sheen_store_bytes(c->store);
}
