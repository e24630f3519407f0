// SPDX-License-Identifier: Apache-2.0
// The cached integrators: visibility, fill, shade. `irradiance` samples what is glossy, `radiance` caches what of it
// harmonics can hold.
#include "base/clock.h"
#include "cache/smooth.h"
#include "integrator/deep.h"
#include "integrator/glossy_cache.h"
#include "integrator/irradiance_record.h"
#include "integrator/radiance_record.h"
#include "integrator/shade.h"
#include "integrator/work.h"

#include <stdlib.h>

/** The shading points of the first sample of each pixel: where the fill looks for gaps. */
typedef struct FirstPoints {
    const SheenWork *work;
    Visibility *workers; // [workers] buffers
    SheenStats *stats;   // [workers]
    SeenPoints *tiles;   // [tiles]
    atomic_bool failed;
} FirstPoints;

static void first_points_task(void *user, size_t item, unsigned worker)
{
    FirstPoints *f = user;
    Visibility *v = &f->workers[worker];
    Tile tile = sheen_tile(f->work, (uint32_t)item);
    bool ok = sheen_visibility_trace(f->work, &tile, (SampleRange){0, 1, NULL}, NULL, v, &f->stats[worker]) &&
              sheen_seen_append(&v->seen, &f->tiles[item]);
    if (!ok) atomic_store(&f->failed, true);
}

static SheenStatus collect_first_points(const SheenWork *work, SheenStats *stats, SeenPoints *points)
{
    unsigned workers = sheen_pool_size(work->pool);
    uint32_t tiles = sheen_tile_count(work);
    FirstPoints f = {.work = work,
                     .workers = calloc(workers, sizeof(Visibility)),
                     .stats = calloc(workers, sizeof(SheenStats)),
                     .tiles = calloc(tiles, sizeof(SeenPoints))};
    SheenStatus status = f.workers && f.stats && f.tiles ? SHEEN_OK : SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK && !sheen_pool_run(work->pool, tiles, first_points_task, &f, work->cancel))
        status = SHEEN_ERR_CANCELLED;
    if (status == SHEEN_OK && atomic_load(&f.failed)) status = SHEEN_ERR_NOMEM;
    for (uint32_t i = 0; i < tiles && f.tiles; ++i) {
        if (status == SHEEN_OK && !sheen_seen_append(&f.tiles[i], points)) status = SHEEN_ERR_NOMEM;
        sheen_seen_free(&f.tiles[i]);
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

/** The caches, and what fills them. */
typedef struct Cached {
    const SheenWork *work;
    bool found; // gathers find light that light samples leave out
    SheenCaches caches;
    SheenDeep *deep;
    SheenIrradianceMaker *irradiance;
    SheenRadianceMaker *radiance[SHEEN_BASIS_COUNT];
} Cached;

static void cached_free(Cached *c)
{
    sheen_irradiance_maker_destroy(&c->irradiance);
    sheen_irradiance_cache_destroy(&c->caches.irradiance);
    for (int b = 0; b < SHEEN_BASIS_COUNT; ++b) {
        sheen_radiance_maker_destroy(&c->radiance[b]);
        sheen_radiance_cache_destroy(&c->caches.radiance[b]);
    }
    sheen_deep_destroy(&c->deep);
}

static SheenStatus create_radiance(Cached *c, SheenBasis basis)
{
    const SheenWork *w = c->work;
    bool tilted = w->options.basis == SHEEN_BASIS_ALL_HSH;
    SheenStatus status =
        sheen_radiance_cache_create(basis, sheen_glossy_cache_order(w->glossy), tilted, w->options.accuracy,
                                    w->options.neighbor_clamping, &w->scene->bounds, &c->caches.radiance[basis]);
    if (status != SHEEN_OK) return status;
    return sheen_radiance_maker_create(w, c->deep, c->caches.radiance[basis], &c->radiance[basis]);
}

static SheenStatus create_caches(Cached *c)
{
    const SheenWork *w = c->work;
    SheenStatus status = sheen_irradiance_cache_create(w->options.accuracy, w->options.neighbor_clamping,
                                                       &w->scene->bounds, &c->caches.irradiance);
    if (status == SHEEN_OK) status = sheen_irradiance_maker_create(w, c->deep, c->caches.irradiance, &c->irradiance);
    for (int b = 0; b < SHEEN_BASIS_COUNT && status == SHEEN_OK && w->glossy; ++b)
        status = create_radiance(c, (SheenBasis)b);
    return status;
}

// The seeds are every eighth pixel both ways.
static bool is_seed(const SheenWork *work, const ShadingPoint *p)
{
    enum { STRIDE = 8 };
    return p->pixel % work->width % STRIDE == 0 && p->pixel / work->width % STRIDE == 0;
}

static SheenStatus create_deep(Cached *c, const SeenPoints *points, SheenStats *stats)
{
    size_t n = 0;
    DiffusePoint *seeds = malloc((points->n_points + points->n_glossy + 1) * sizeof *seeds);
    if (!seeds) return SHEEN_ERR_NOMEM;
    for (size_t i = 0; i < points->n_points; ++i)
        if (is_seed(c->work, &points->points[i])) seeds[n++] = points->points[i].point;
    for (size_t i = 0; i < points->n_glossy; ++i)
        if (is_seed(c->work, &points->glossy[i].at)) seeds[n++] = points->glossy[i].at.point;
    if (n == 0 && points->n_points > 0) seeds[n++] = points->points[0].point;
    if (n == 0 && points->n_glossy > 0) seeds[n++] = points->glossy[0].at.point;
    SheenStatus status = sheen_deep_create(c->work, seeds, n, c->work->options.bounces - 1, stats, &c->deep);
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

static bool has_indirect(const SheenWork *work, bool found)
{
    return work->options.bounces > 0 || found;
}

// The glossy points of one basis.
static SheenStatus fill_radiance(Cached *c, SheenBasis basis, const SeenPoints *seen, SheenStats *stats)
{
    ShadingPoint *points = malloc((seen->n_glossy + 1) * sizeof *points);
    if (!points) return SHEEN_ERR_NOMEM;
    size_t n = 0;
    for (size_t i = 0; i < seen->n_glossy; ++i)
        if (seen->glossy[i].basis == basis) points[n++] = seen->glossy[i].at;
    RecordKind kind = sheen_radiance_kind(c->radiance[basis]);
    SheenStatus status = sheen_fill_run(c->work, &kind, points, n, stats);
    free(points);
    return status;
}

// Makes records until all points have some.
static SheenStatus fill(Cached *c, const SeenPoints *seen, SheenStats *stats)
{
    double start = sheen_clock_seconds();
    RecordKind kind = sheen_irradiance_kind(c->irradiance);
    SheenStatus status = sheen_fill_run(c->work, &kind, seen->points, seen->n_points, stats);
    for (int b = 0; b < SHEEN_BASIS_COUNT && status == SHEEN_OK && seen->n_glossy > 0; ++b)
        status = fill_radiance(c, (SheenBasis)b, seen, stats);
    stats->time_fill += sheen_clock_seconds() - start;
    return status;
}

static SheenStatus smooth(Cached *c, SheenStats *stats)
{
    const SheenWork *w = c->work;
    double start = sheen_clock_seconds();
    SheenStatus status = sheen_irradiance_cache_smooth(c->caches.irradiance, &w->scene->bounds, w->pool, w->cancel);
    for (int b = 0; b < SHEEN_BASIS_COUNT && status == SHEEN_OK; ++b)
        if (c->caches.radiance[b])
            status = sheen_radiance_cache_smooth(c->caches.radiance[b], &w->scene->bounds, w->pool, w->cancel);
    stats->time_fill += sheen_clock_seconds() - start;
    return status;
}

static SheenStatus fill_first(Cached *c, SheenStats *stats)
{
    const SheenWork *work = c->work;
    SeenPoints points = {0};
    double t0 = sheen_clock_seconds();
    progress_report(work->progress, "visibility", 0.0, 0);
    SheenStatus status = collect_first_points(work, stats, &points);
    double t1 = sheen_clock_seconds();
    stats->time_visibility += t1 - t0;
    // Where light samples find all direct light, one bounce needs no deep records.
    unsigned bounces = work->options.bounces;
    bool deeper = bounces > 1 || (bounces == 1 && c->found);
    if (status == SHEEN_OK && deeper && work->options.secondary == SHEEN_SECONDARY_CACHE)
        status = create_deep(c, &points, stats);
    if (status == SHEEN_OK) status = create_caches(c);
    stats->time_fill += sheen_clock_seconds() - t1;
    if (status == SHEEN_OK) status = fill(c, &points, stats);
    if (status == SHEEN_OK) status = smooth(c, stats);
    sheen_seen_free(&points);
    return status;
}

// Shades samples of each pixel from `first` on, and fills the caches where they see what no record covers.
static SheenStatus shade(Cached *c, bool indirect, uint32_t first, Picture *picture, SheenStats *stats)
{
    SeenPoints uncovered = {0};
    const SheenCaches *caches = indirect ? &c->caches : NULL;
    SheenStatus status = sheen_shade(c->work, caches, first, picture, &uncovered, stats);
    if (status == SHEEN_OK && uncovered.n_points + uncovered.n_glossy > 0) {
        status = fill(c, &uncovered, stats);
        if (status == SHEEN_OK) sheen_shade_uncovered(c->work, caches, &uncovered, picture, stats);
    }
    sheen_seen_free(&uncovered);
    return status;
}

static SheenStatus shade_picture(Cached *c, bool indirect, SheenFilm *film, SheenStats *stats)
{
    const SheenOptions *o = &c->work->options;
    Picture picture;
    uint64_t more = 0;
    if (!sheen_picture_create(c->work, film, &picture)) return SHEEN_ERR_NOMEM;
    SheenStatus status = shade(c, indirect, 0, &picture, stats);
    if (status == SHEEN_OK && !sheen_picture_plan(o->noise, &picture, &more)) status = SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK && more > 0) status = shade(c, indirect, o->spp, &picture, stats);
    sheen_picture_average(&picture);
    stats->spp_done = o->spp;
    stats->spp_mean = (double)o->spp + (double)more / ((double)film->width * film->height);
    sheen_picture_free(&picture);
    return status;
}

static void count_records(const Cached *c, SheenStats *stats)
{
    if (c->deep) stats->deep_records = sheen_deep_records(c->deep);
    if (c->caches.irradiance) {
        stats->records = c->caches.irradiance->store->n;
        stats->cache_bytes = sheen_irradiance_cache_bytes(c->caches.irradiance);
    }
    for (int b = 0; b < SHEEN_BASIS_COUNT; ++b) {
        const SheenRadianceCache *cache = c->caches.radiance[b];
        if (!cache) continue;
        stats->radiance_records += cache->store->n;
        stats->cache_bytes += sheen_radiance_cache_bytes(cache);
    }
}

// @param found  gathers find light that light samples leave out
static SheenStatus render(const SheenWork *work, bool found, SheenFilm *film, SheenStats *stats)
{
    Cached c = {.work = work, .found = found};
    bool indirect = has_indirect(work, found);
    SheenStatus status = indirect ? fill_first(&c, stats) : SHEEN_OK;
    if (status == SHEEN_OK) status = shade_picture(&c, indirect, film, stats);
    count_records(&c, stats);
    cached_free(&c);
    return status;
}

SheenStatus sheen_irradiance_render(const SheenWork *work, SheenFilm *film, SheenStats *stats)
{
    return render(work, gathers_see_light(work->scene), film, stats);
}

SheenStatus sheen_radiance_render(const SheenWork *work, SheenFilm *film, SheenStats *stats)
{
    SheenWork with = *work;
    SheenGlossyCache *glossy = NULL;
    bool found = gathers_see_light(work->scene);
    double start = sheen_clock_seconds();
    SheenStatus status = has_indirect(work, found) ? sheen_glossy_cache_create(work, &glossy) : SHEEN_OK;
    stats->time_fill += sheen_clock_seconds() - start;
    with.glossy = glossy;
    if (status == SHEEN_OK) status = render(&with, found, film, stats);
    sheen_glossy_cache_destroy(&glossy);
    return status;
}
