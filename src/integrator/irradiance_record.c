// SPDX-License-Identifier: Apache-2.0
#include "integrator/irradiance_record.h"

#include "integrator/gather_light.h"
#include "integrator/record_radius.h"

#include <stdlib.h>

struct SheenIrradianceMaker {
    const SheenWork *work;
    const SheenDeep *deep;
    SheenIrradianceCache *cache;
    unsigned workers;
    Hemisphere *scratch; // [workers]
};

SheenStatus sheen_irradiance_maker_create(const SheenWork *work, const SheenDeep *deep, SheenIrradianceCache *cache,
                                          SheenIrradianceMaker **out)
{
    *out = NULL;
    SheenIrradianceMaker *m = calloc(1, sizeof *m);
    if (!m) return SHEEN_ERR_NOMEM;
    *m = (SheenIrradianceMaker){.work = work, .deep = deep, .cache = cache, .workers = sheen_pool_size(work->pool)};
    m->scratch = calloc(m->workers, sizeof *m->scratch);
    SheenStrata strata = sheen_strata_cosine(work->options.gather_rays);
    bool ok = m->scratch != NULL;
    for (unsigned i = 0; i < m->workers && ok; ++i) ok = sheen_hemisphere_reserve(&m->scratch[i], strata);
    if (!ok) {
        sheen_irradiance_maker_destroy(&m);
        return SHEEN_ERR_NOMEM;
    }
    *out = m;
    return SHEEN_OK;
}

void sheen_irradiance_maker_destroy(SheenIrradianceMaker **maker)
{
    SheenIrradianceMaker *m = maker ? *maker : NULL;
    if (!m) return;
    for (unsigned i = 0; i < m->workers && m->scratch; ++i) sheen_hemisphere_free(&m->scratch[i]);
    free(m->scratch);
    free(m);
    *maker = NULL;
}

static void make(void *user, const ShadingPoint *p, uint32_t key, unsigned worker, SheenStats *stats, Record *record,
                 void *out)
{
    const SheenIrradianceMaker *m = user;
    const SheenOptions *o = &m->work->options;
    Hemisphere *h = &m->scratch[worker];
    IrradianceLight *light = out;
    sheen_gather_light(m->work, m->deep, &p->point, record_least_radius(o, p->footprint), key, h, stats);
    IrradianceEstimate e;
    sheen_estimate_irradiance(h->strata, h->directions, h->L, h->distance, &e);
    *record = (Record){.p = p->point.p, .n = p->point.n, .error = h->error};
    float R = o->gradient_clamping ? estimate_gradient_radius(&e) : e.R;
    record_set_radius(o, p->footprint, R, record);
    estimate_enlarge(R, record->R_min, &e);
    *light = (IrradianceLight){.E = e.E};
    if (o->gradients == SHEEN_GRADIENT_NONE) return;
    estimate_world_gradient(&h->frame, e.translation, light->translation);
    estimate_world_gradient(&h->frame, e.rotation, light->rotation);
}

static SheenStatus insert(void *user, const Record *record, const void *light)
{
    const SheenIrradianceMaker *m = user;
    return sheen_irradiance_cache_insert(m->cache, record, light);
}

RecordKind sheen_irradiance_kind(SheenIrradianceMaker *maker)
{
    return (RecordKind){maker->cache->store, sizeof(IrradianceLight), maker, make, insert};
}
