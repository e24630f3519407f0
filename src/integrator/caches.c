// SPDX-License-Identifier: Apache-2.0
#include "integrator/caches.h"

#include "cache/smooth.h"
#include "integrator/glossy_cache.h"

SheenStatus sheen_caches_create(const SheenWork *w, SheenCaches *out)
{
    *out = (SheenCaches){0};
    const SheenOptions *o = &w->options;
    const Bounds *bounds = &w->scene->bounds;
    SheenStatus status = sheen_irradiance_cache_create(o->accuracy, o->neighbor_clamping, bounds, &out->irradiance);
    bool tilted = o->basis == SHEEN_BASIS_ALL_HSH;
    for (int b = 0; b < SHEEN_BASIS_COUNT && status == SHEEN_OK && w->glossy; ++b)
        status = sheen_radiance_cache_create((SheenBasis)b, sheen_glossy_cache_order(w->glossy), tilted, o->accuracy,
                                             o->neighbor_clamping, bounds, &out->radiance[b]);
    return status;
}

void sheen_caches_free(SheenCaches *c)
{
    sheen_irradiance_cache_destroy(&c->irradiance);
    for (int b = 0; b < SHEEN_BASIS_COUNT; ++b) sheen_radiance_cache_destroy(&c->radiance[b]);
}

RecordCounts sheen_caches_counts(const SheenCaches *c)
{
    RecordCounts n = {.irradiance = c->irradiance ? c->irradiance->store->n : 0};
    for (int b = 0; b < SHEEN_BASIS_COUNT; ++b) n.radiance[b] = c->radiance[b] ? c->radiance[b]->store->n : 0;
    return n;
}

SheenStatus sheen_caches_smooth(const SheenWork *w, const RecordCounts *settled, const SheenCaches *c)
{
    const Bounds *bounds = &w->scene->bounds;
    SheenStatus status = c->irradiance
                             ? sheen_irradiance_cache_smooth(c->irradiance, settled->irradiance, bounds, w->pool, NULL)
                             : SHEEN_OK;
    for (int b = 0; b < SHEEN_BASIS_COUNT && status == SHEEN_OK; ++b)
        if (c->radiance[b])
            status = sheen_radiance_cache_smooth(c->radiance[b], settled->radiance[b], bounds, w->pool, NULL);
    return status;
}

void sheen_caches_count(const SheenCaches *c, SheenStats *stats)
{
    RecordCounts n = sheen_caches_counts(c);
    stats->records += n.irradiance;
    stats->radiance_records += record_counts_radiance(&n);
    if (c->irradiance) stats->cache_bytes += sheen_irradiance_cache_bytes(c->irradiance);
    for (int b = 0; b < SHEEN_BASIS_COUNT; ++b)
        if (c->radiance[b]) stats->cache_bytes += sheen_radiance_cache_bytes(c->radiance[b]);
}
