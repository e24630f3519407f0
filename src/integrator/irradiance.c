// SPDX-License-Identifier: Apache-2.0
// The `irradiance` integrator: visibility, fill, shade.
#include "base/clock.h"
#include "cache/smooth.h"
#include "integrator/deep.h"
#include "integrator/irradiance_record.h"
#include "integrator/shade.h"
#include "integrator/work.h"

#include <stdlib.h>

/** The shading points of the first sample of each pixel: where the fill looks for gaps. */
typedef struct FirstPoints {
    const SheenWork *work;
    Visibility *workers; // [workers] buffers
    SheenStats *stats;   // [workers]
    Visibility *tiles;   // [tiles] points only
    bool failed;
} FirstPoints;

static void first_points_task(void *user, size_t item, unsigned worker)
{
    FirstPoints *f = user;
    Visibility *v = &f->workers[worker], *out = &f->tiles[item];
    Tile tile = sheen_tile(f->work, (uint32_t)item);
    if (!sheen_visibility_trace(f->work, &tile, (SampleRange){0, 1, NULL}, NULL, v, &f->stats[worker])) return;
    out->points = malloc((v->n_points + 1) * sizeof *out->points);
    if (!out->points) return;
    out->n_points = v->n_points;
    for (size_t i = 0; i < v->n_points; ++i) out->points[i] = v->points[i];
}

static SheenStatus collect_first_points(const SheenWork *work, SheenStats *stats, ShadingPoint **points, size_t *n)
{
    unsigned workers = sheen_pool_size(work->pool);
    uint32_t tiles = sheen_tile_count(work);
    FirstPoints f = {.work = work,
                     .workers = calloc(workers, sizeof(Visibility)),
                     .stats = calloc(workers, sizeof(SheenStats)),
                     .tiles = calloc(tiles, sizeof(Visibility))};
    SheenStatus status = f.workers && f.stats && f.tiles ? SHEEN_OK : SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK && !sheen_pool_run(work->pool, tiles, first_points_task, &f, work->cancel))
        status = SHEEN_ERR_CANCELLED;
    *n = 0;
    for (uint32_t i = 0; i < tiles && status == SHEEN_OK; ++i) {
        if (!f.tiles[i].points) status = SHEEN_ERR_NOMEM;
        *n += f.tiles[i].n_points;
    }
    *points = status == SHEEN_OK ? malloc((*n + 1) * sizeof **points) : NULL;
    if (status == SHEEN_OK && !*points) status = SHEEN_ERR_NOMEM;
    size_t at = 0;
    for (uint32_t i = 0; i < tiles && f.tiles; ++i) {
        for (size_t j = 0; j < f.tiles[i].n_points && status == SHEEN_OK; ++j) (*points)[at++] = f.tiles[i].points[j];
        sheen_visibility_free(&f.tiles[i]);
    }
    for (unsigned i = 0; i < workers; ++i) {
        if (f.stats) sheen_stats_add(stats, &f.stats[i]);
        if (f.workers) sheen_visibility_free(&f.workers[i]);
    }
    free(f.workers);
    free(f.stats);
    free(f.tiles);
    return status;
}

// The seeds are every eighth pixel both ways.
static SheenStatus create_deep(const SheenWork *work, const ShadingPoint points[], size_t n, SheenStats *stats,
                               SheenDeep **deep)
{
    enum { STRIDE = 8 };
    DiffusePoint *seeds = malloc((n + 1) * sizeof *seeds);
    if (!seeds) return SHEEN_ERR_NOMEM;
    size_t n_seeds = 0;
    for (size_t i = 0; i < n; ++i) {
        uint32_t x = points[i].pixel % work->width, y = points[i].pixel / work->width;
        if (x % STRIDE == 0 && y % STRIDE == 0) seeds[n_seeds++] = points[i].point;
    }
    if (n_seeds == 0 && n > 0) seeds[n_seeds++] = points[0].point;
    SheenStatus status = sheen_deep_create(work, seeds, n_seeds, work->options.bounces - 1, stats, deep);
    free(seeds);
    return status;
}

// Whether gathers see light that light samples leave out, so that there are records even without a bounce: the soft
// sky, and lamps in mirrors and behind glass.
static bool gathers_see_light(const SheenScene *scene)
{
    if (scene->environment != SHEEN_NONE) return true;
    bool lamps = false, delta = false;
    for (uint32_t i = 0; i < scene->n_lights; ++i) lamps = lamps || scene->lights[i].disk > 0.0f;
    for (uint32_t i = 0; i < scene->n_shapes; ++i) {
        lamps = lamps || scene->shapes[i].light != SHEEN_NONE;
        delta = delta || sheen_material_may_be_delta(scene, scene->shapes[i].material);
    }
    return lamps && delta;
}

static SheenStatus run_fill(const SheenWork *work, SheenIrradianceMaker *maker, const ShadingPoint points[], size_t n,
                            SheenStats *stats)
{
    RecordKind kind = sheen_irradiance_kind(maker);
    return sheen_fill_run(work, &kind, points, n, stats);
}

static SheenStatus fill_cache(const SheenWork *work, SheenIrradianceCache *cache, SheenDeep **deep,
                              SheenIrradianceMaker **maker, SheenStats *stats)
{
    ShadingPoint *points = NULL;
    size_t n = 0;
    double t0 = sheen_clock_seconds();
    progress_report(work->progress, "visibility", 0.0, 0);
    SheenStatus status = collect_first_points(work, stats, &points, &n);
    double t1 = sheen_clock_seconds();
    stats->time_visibility += t1 - t0;
    // Where light samples find all direct light, one bounce needs no deep records.
    unsigned bounces = work->options.bounces;
    bool deeper = bounces > 1 || (bounces == 1 && gathers_see_light(work->scene));
    if (status == SHEEN_OK && deeper && work->options.secondary == SHEEN_SECONDARY_CACHE)
        status = create_deep(work, points, n, stats, deep);
    if (status == SHEEN_OK) status = sheen_irradiance_maker_create(work, *deep, cache, maker);
    if (status == SHEEN_OK) status = run_fill(work, *maker, points, n, stats);
    if (status == SHEEN_OK)
        status = sheen_irradiance_cache_smooth(cache, &work->scene->bounds, work->pool, work->cancel);
    stats->time_fill += sheen_clock_seconds() - t1;
    free(points);
    return status;
}

// Shades samples of each pixel from `first` on, and fills the cache where they see what no record covers.
static SheenStatus shade(const SheenWork *work, SheenIrradianceCache *cache, SheenIrradianceMaker *maker,
                         uint32_t first, Picture *picture, SheenStats *stats)
{
    Uncovered uncovered = {0};
    SheenStatus status = sheen_shade(work, cache, first, picture, &uncovered, stats);
    if (status == SHEEN_OK && uncovered.n > 0) {
        double start = sheen_clock_seconds();
        status = run_fill(work, maker, uncovered.points, uncovered.n, stats);
        stats->time_fill += sheen_clock_seconds() - start;
        if (status == SHEEN_OK) sheen_shade_uncovered(work, cache, &uncovered, picture, stats);
    }
    sheen_uncovered_free(&uncovered);
    return status;
}

static SheenStatus shade_picture(const SheenWork *work, SheenIrradianceCache *cache, SheenIrradianceMaker *maker,
                                 SheenFilm *film, SheenStats *stats)
{
    Picture picture;
    uint64_t more = 0;
    if (!sheen_picture_create(work, film, &picture)) return SHEEN_ERR_NOMEM;
    SheenStatus status = shade(work, cache, maker, 0, &picture, stats);
    if (status == SHEEN_OK && !sheen_picture_plan(work->options.noise, &picture, &more)) status = SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK && more > 0) status = shade(work, cache, maker, work->options.spp, &picture, stats);
    sheen_picture_average(&picture);
    stats->spp_done = work->options.spp;
    stats->spp_mean = (double)work->options.spp + (double)more / ((double)film->width * film->height);
    sheen_picture_free(&picture);
    return status;
}

SheenStatus sheen_irradiance_render(const SheenWork *work, SheenFilm *film, SheenStats *stats)
{
    SheenIrradianceCache *cache = NULL;
    SheenDeep *deep = NULL;
    SheenIrradianceMaker *maker = NULL;
    bool indirect = work->options.bounces > 0 || gathers_see_light(work->scene);
    SheenStatus status = SHEEN_OK;
    if (indirect) {
        status = sheen_irradiance_cache_create(work->options.accuracy, work->options.neighbor_clamping,
                                               &work->scene->bounds, &cache);
        if (status == SHEEN_OK) status = fill_cache(work, cache, &deep, &maker, stats);
    }
    if (status == SHEEN_OK) status = shade_picture(work, cache, maker, film, stats);
    if (cache) {
        stats->records = cache->store->n;
        stats->cache_bytes = sheen_irradiance_cache_bytes(cache);
    }
    if (deep) stats->deep_records = sheen_deep_records(deep);
    sheen_irradiance_maker_destroy(&maker);
    sheen_deep_destroy(&deep);
    sheen_irradiance_cache_destroy(&cache);
    return status;
}
