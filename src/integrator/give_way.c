// SPDX-License-Identifier: Apache-2.0
#include "integrator/give_way.h"

#include "integrator/record_radius.h"
#include "integrator/thin.h"

#include <stdlib.h>

enum {
    SIDE = 16,       // pixels of a square
    RECORD_RAYS = 3, // that a record takes at least, in units of its first ones
    BLOCK = 64       // points an item
};

// ---- which points ---------------------------------------------------------------------------------------------------

static size_t square_of(uint32_t pixel, uint32_t width)
{
    size_t across = (width + SIDE - 1) / SIDE;
    return pixel / width / SIDE * across + pixel % width / SIDE;
}

// The points that would get a record: as far apart as the records around let expect.
static SheenStatus would_be_made(const SheenWork *work, const SheenRecordStore *store, const ShadingPoint points[],
                                 size_t n, uint32_t made[], size_t *n_made)
{
    const SheenOptions *o = &work->options;
    uint32_t *candidates = malloc(n * sizeof *candidates);
    float *spacing = malloc(n * sizeof *spacing), *a = malloc(n * sizeof *a);
    SheenStatus status = candidates && spacing && a ? SHEEN_OK : SHEEN_ERR_NOMEM;
    for (size_t i = 0; i < n && status == SHEEN_OK; ++i) {
        float least = o->reach_min * points[i].footprint, most = o->reach_max * points[i].footprint;
        RecordExpected e = sheen_store_expect(store, points[i].point.p);
        candidates[i] = (uint32_t)i;
        spacing[i] = clampf(e.reach, least, most);
        a[i] = record_first_accuracy(o, e.a);
    }
    if (status == SHEEN_OK)
        status = sheen_thin(o->reach_max, work->width, points, n, candidates, spacing, a, made, n_made);
    free(candidates);
    free(spacing);
    free(a);
    return status;
}

SheenStatus sheen_give_way_choose(const SheenWork *work, const SheenRecordStore *store, const ShadingPoint points[],
                                  size_t n, bool sampled[])
{
    if (n == 0) return SHEEN_OK;
    if (n > UINT32_MAX) return SHEEN_ERR_NOMEM;
    size_t squares = square_of(work->width * work->height - 1, work->width) + 1, n_made = 0;
    uint32_t *made = malloc(n * sizeof *made);
    uint32_t *records = calloc(squares, sizeof *records), *served = calloc(squares, sizeof *served);
    SheenStatus status = made && records && served ? SHEEN_OK : SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK) status = would_be_made(work, store, points, n, made, &n_made);
    if (status == SHEEN_OK) {
        for (size_t i = 0; i < n_made; ++i) ++records[square_of(points[made[i]].pixel, work->width)];
        for (size_t i = 0; i < n; ++i) ++served[square_of(points[i].pixel, work->width)];
        uint64_t a_record = (uint64_t)RECORD_RAYS * work->options.gather_rays;
        for (size_t i = 0; i < n; ++i) {
            size_t s = square_of(points[i].pixel, work->width);
            uint64_t least = records[s] > 0 ? records[s] : 1; // records of other squares may reach into this one
            sampled[i] = (uint64_t)SHEEN_SAMPLED_RAYS * served[s] < a_record * least;
        }
    }
    free(made);
    free(records);
    free(served);
    return status;
}

// ---- their light ----------------------------------------------------------------------------------------------------

typedef struct Gathers {
    const SheenWork *work;
    const SheenIrradianceMaker *maker;
    const ShadingPoint *points; // [n]
    size_t n;
    Rgb *E;            // [n]
    SheenStats *stats; // [workers]
} Gathers;

static void gather_task(void *user, size_t item, unsigned worker)
{
    Gathers *g = user;
    for (size_t i = item * BLOCK; i < g->n && i < (item + 1) * BLOCK; ++i) {
        const ShadingPoint *p = &g->points[i];
        uint32_t key = hash_combine(g->work->options.seed ^ 0x51a3u, p->pixel);
        key = hash_combine(hash_combine(key, p->sample), p->branch);
        g->E[i] = sheen_irradiance_sample(g->maker, p, key, worker, &g->stats[worker]);
    }
}

SheenStatus sheen_give_way_gather(const SheenWork *work, const SheenIrradianceMaker *maker, const ShadingPoint points[],
                                  size_t n, Rgb E[], SheenStats *stats)
{
    unsigned workers = sheen_pool_size(work->pool);
    Gathers g = {work, maker, points, n, E, calloc(workers, sizeof *g.stats)};
    if (!g.stats) return SHEEN_ERR_NOMEM;
    bool done = sheen_pool_run(work->pool, (n + BLOCK - 1) / BLOCK, gather_task, &g, work->cancel);
    for (unsigned i = 0; i < workers; ++i) sheen_stats_add(stats, &g.stats[i]);
    free(g.stats);
    return done ? SHEEN_OK : SHEEN_ERR_CANCELLED;
}
