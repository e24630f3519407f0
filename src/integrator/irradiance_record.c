// SPDX-License-Identifier: Apache-2.0
#include "integrator/irradiance_record.h"

#include "gather/hessian.h"
#include "integrator/gather_light.h"
#include "integrator/record_radius.h"

#include <stdlib.h>

struct SheenIrradianceMaker {
    SheenGatherer gatherer;
};

SheenStatus sheen_irradiance_maker_create(const SheenWork *work, const SheenDeep *deep, uint32_t rays, float error,
                                          SheenIrradianceMaker **out)
{
    *out = NULL;
    SheenIrradianceMaker *m = calloc(1, sizeof *m);
    if (!m) return SHEEN_ERR_NOMEM;
    SheenStrata strata = sheen_strata_cosine(rays);
    if (!sheen_gatherer_init(work, deep, strata, error, &m->gatherer)) {
        sheen_irradiance_maker_destroy(&m);
        return SHEEN_ERR_NOMEM;
    }
    *out = m;
    return SHEEN_OK;
}

void sheen_irradiance_maker_destroy(SheenIrradianceMaker **maker)
{
    if (!maker || !*maker) return;
    sheen_gatherer_free(&(*maker)->gatherer);
    free(*maker);
    *maker = NULL;
}

// @return the record's own radius, across
static float set_radius(const SheenOptions *o, float footprint, const Hemisphere *h, const IrradianceEstimate *e,
                        Record *r)
{
    if (o->error_metric == SHEEN_ERROR_SPLIT_SPHERE) {
        float R = o->gradient_clamping ? estimate_gradient_radius(e) : e->R;
        record_set_radius(o, footprint, R, r);
        return R;
    }
    IrradianceHessian bends;
    sheen_estimate_hessian(h->strata, h->directions, h->L, h->distance, &bends, NULL);
    HessianEllipse ellipse = sheen_hessian_ellipse(&bends, rgb_luminance(e->E), SHEEN_HESSIAN_ERROR);
    record_set_ellipse(o, footprint, &h->frame, &ellipse, r);
    return ellipse.radius[0];
}

// Gathers at a point for a record of accuracy a.
static const Hemisphere *gather(const SheenIrradianceMaker *m, const ShadingPoint *p, float a, uint32_t key,
                                unsigned worker, SheenStats *stats, IrradianceEstimate *e)
{
    float R_min = record_least_radius(&m->gatherer.work->options, a, p->footprint);
    DiffusePoint at = p->point;
    at.bent = at.n; // whatever a map makes of the surface there
    const Hemisphere *h = sheen_gather_light(&m->gatherer, &at, R_min, key, worker, stats);
    sheen_estimate_irradiance(h->strata, h->L, h->distance, e);
    return h;
}

static void set_light(const SheenOptions *o, const Hemisphere *h, const IrradianceEstimate *e, IrradianceLight *light)
{
    BehindEstimate behind;
    sheen_estimate_behind(h->strata, h->L, &behind);
    *light = (IrradianceLight){.E = e->E, .behind = behind.mean};
    light->lean = frame_to_world(&h->frame, v3(behind.lean[0], behind.lean[1], 0.0f));
    if (o->gradients == SHEEN_GRADIENT_NONE) return;
    estimate_world_gradient(&h->frame, e->translation, light->translation);
    estimate_world_gradient(&h->frame, e->rotation, light->rotation);
}

static void make(const void *maker, const ShadingPoint *p, float a, uint32_t key, unsigned worker, SheenStats *stats,
                 Record *record, void *light)
{
    const SheenIrradianceMaker *m = maker;
    const SheenOptions *o = &m->gatherer.work->options;
    IrradianceEstimate e;
    const Hemisphere *h = gather(m, p, a, key, worker, stats, &e);
    *record = (Record){.p = p->point.p, .n = p->point.n, .a = a, .error = h->error};
    float R = set_radius(o, p->footprint, h, &e, record);
    estimate_enlarge(R, record->R_min, &e);
    set_light(o, h, &e, light);
}

Rgb sheen_irradiance_sample(const SheenIrradianceMaker *m, const ShadingPoint *p, uint32_t key, unsigned worker,
                            SheenStats *stats)
{
    const SheenOptions *o = &m->gatherer.work->options;
    IrradianceEstimate e;
    IrradianceLight light;
    const Hemisphere *h = gather(m, p, o->accuracy, key, worker, stats, &e);
    set_light(o, h, &e, &light);
    Record here = {.p = p->point.p, .n = p->point.n};
    const SheenRecordStore alone = {.records = &here, .n = 1};
    const Contributors one = {.n = 1, .record = {0}, .weight = {1.0f}, .weight_sum = 1.0f};
    return sheen_irradiance_interpolate_bent(&alone, &light, &one, p->point.p, p->point.n, p->point.bent);
}

static SheenStatus insert(void *cache, const Record *record, const void *light)
{
    return sheen_irradiance_cache_insert(cache, record, light);
}

RecordKind sheen_irradiance_kind(const SheenIrradianceMaker *maker, SheenIrradianceCache *cache)
{
    return (RecordKind){sizeof(IrradianceLight), maker, make, cache->store, NULL, cache, insert};
}
