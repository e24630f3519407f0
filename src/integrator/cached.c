// SPDX-License-Identifier: Apache-2.0
#include "integrator/cached.h"

#include "base/clock.h"
#include "integrator/converge.h"
#include "integrator/deep.h"
#include "integrator/first_points.h"
#include "integrator/gather_light.h"
#include "integrator/give_way.h"
#include "integrator/glossy_cache.h"
#include "integrator/irradiance_record.h"
#include "integrator/radiance_record.h"
#include "integrator/shade.h"

#include <stdlib.h>

struct SheenCached {
    SheenWork work; // without a view
    bool found;     // gathers find light that light samples leave out
    bool indirect;  // there is light to keep
    SheenGlossyCache *glossy;
    SheenCaches caches;
    RecordCounts settled; // records that have learnt from their neighbors
    // Where deep light is explored from, and what makes records: made when the first record is.
    DiffusePoint *seeds;
    size_t n_seeds;
    bool ready;
    SheenDeep *deep;
    SheenIrradianceMaker *irradiance, *sampled;
    SheenRadianceMaker *radiance[SHEEN_BASIS_COUNT];
};

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

SheenStatus sheen_cached_create(const SheenWork *work, bool gloss, SheenStats *stats, SheenCached **out)
{
    *out = NULL;
    double start = sheen_clock_seconds();
    SheenCached *c = calloc(1, sizeof *c);
    if (!c) return SHEEN_ERR_NOMEM;
    c->work = *work;
    c->found = gathers_see_light(work->scene);
    c->indirect = c->found || work->options.bounces > 0;
    SheenStatus status = c->indirect && gloss ? sheen_glossy_cache_create(work, &c->glossy) : SHEEN_OK;
    c->work.glossy = c->glossy;
    if (status == SHEEN_OK && c->indirect) status = sheen_caches_create(&c->work, &c->caches);
    stats->time_fill += sheen_clock_seconds() - start;
    if (status != SHEEN_OK) sheen_cached_destroy(&c);
    *out = c;
    return status;
}

void sheen_cached_destroy(SheenCached **cached)
{
    SheenCached *c = cached ? *cached : NULL;
    if (!c) return;
    sheen_irradiance_maker_destroy(&c->irradiance);
    sheen_irradiance_maker_destroy(&c->sampled);
    for (int b = 0; b < SHEEN_BASIS_COUNT; ++b) sheen_radiance_maker_destroy(&c->radiance[b]);
    sheen_deep_destroy(&c->deep);
    sheen_caches_free(&c->caches);
    sheen_glossy_cache_destroy(&c->glossy);
    free(c->seeds);
    free(c);
    *cached = NULL;
}

SheenCaches *sheen_cached_caches(SheenCached *cached)
{
    return &cached->caches;
}

void sheen_cached_adopt(SheenCached *c)
{
    c->settled = sheen_caches_counts(&c->caches);
}

static SheenStatus add_seeds(SheenCached *c, const SeenPoints *seen)
{
    size_t n = c->n_seeds + seen->n_points + seen->n_glossy;
    if (n == c->n_seeds) return SHEEN_OK;
    DiffusePoint *grown = realloc(c->seeds, n * sizeof *grown);
    if (!grown) return SHEEN_ERR_NOMEM;
    c->seeds = grown;
    for (size_t i = 0; i < seen->n_points; ++i) grown[c->n_seeds++] = seen->points[i].point;
    for (size_t i = 0; i < seen->n_glossy; ++i) grown[c->n_seeds++] = seen->glossy[i].at.point;
    return SHEEN_OK;
}

SheenStatus sheen_cached_look(SheenCached *c, const SheenView *view, SheenStats *stats)
{
    enum { STRIDE = 8 }; // every eighth pixel both ways
    if (!c->indirect || c->ready) return SHEEN_OK;
    double start = sheen_clock_seconds();
    SheenWork work = sheen_work_for(&c->work, view);
    SeenPoints seen = {0};
    uint32_t *ends = malloc((size_t)view->width * view->height * sizeof *ends);
    if (ends) sheen_every_pixel(STRIDE, view->width, view->height, ends);
    SheenStatus status = ends ? sheen_first_points(&work, ends, stats, &seen) : SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK) status = add_seeds(c, &seen);
    sheen_seen_free(&seen);
    free(ends);
    stats->time_visibility += sheen_clock_seconds() - start;
    return status;
}

// Makes what makes records. @param at  a point to explore from where no view was looked at
static SheenStatus make_ready(SheenCached *c, const ShadingPoint *at, SheenStats *stats)
{
    if (c->ready) return SHEEN_OK;
    const SheenWork *w = &c->work;
    const DiffusePoint *seeds = c->n_seeds ? c->seeds : &at->point;
    SheenStatus status = SHEEN_OK;
    // Where light samples find all direct light, one bounce needs no deep records.
    bool deeper = w->options.bounces > 1 || (w->options.bounces == 1 && c->found);
    if (deeper && w->options.secondary == SHEEN_SECONDARY_CACHE)
        status = sheen_deep_create(w, seeds, c->n_seeds ? c->n_seeds : 1, w->options.bounces - 1, stats, &c->deep);
    if (status == SHEEN_OK)
        status = sheen_irradiance_maker_create(w, c->deep, w->options.gather_rays, SHEEN_GATHER_ERROR, &c->irradiance);
    const float any_error = 1e6f; // no further rays
    if (status == SHEEN_OK)
        status = sheen_irradiance_maker_create(w, c->deep, SHEEN_SAMPLED_RAYS, any_error, &c->sampled);
    for (int b = 0; b < SHEEN_BASIS_COUNT && status == SHEEN_OK && w->glossy; ++b)
        status = sheen_radiance_maker_create(w, c->deep, c->caches.radiance[b], &c->radiance[b]);
    c->ready = status == SHEEN_OK;
    return status;
}

/** Where new records go. */
typedef struct Target {
    const SheenCaches *caches;
    const SheenCaches *around; // whose records bound the new ones'; NULL for none
    unsigned rounds;           // fills at most: later records' clamping and refinement uncover some points again
    bool adaptive;             // whether records are refined
} Target;

// The kinds of records: irradiance, then radiance in each basis.
enum { KIND_IRRADIANCE, KIND_RADIANCE, KINDS = KIND_RADIANCE + SHEEN_BASIS_COUNT };

static SheenRecordStore *store_of(const SheenCaches *caches, int kind)
{
    return kind == KIND_IRRADIANCE ? caches->irradiance->store : caches->radiance[kind - KIND_RADIANCE]->store;
}

static RecordKind record_kind(const SheenCached *c, const Target *to, int kind)
{
    int basis = kind - KIND_RADIANCE;
    RecordKind k = kind == KIND_IRRADIANCE ? sheen_irradiance_kind(c->irradiance, to->caches->irradiance)
                                           : sheen_radiance_kind(c->radiance[basis], to->caches->radiance[basis]);
    if (to->around) k.around = store_of(to->around, kind);
    return k;
}

// Makes records of one kind until its points are covered. Where they are at first, nothing is done.
static SheenStatus cover(SheenCached *c, const SheenWork *work, const Target *to, int kind, const ShadingPoint points[],
                         size_t n, SheenAdaptView *view, SheenStats *stats)
{
    bool open = false;
    SheenStatus status = sheen_fill_is_open(work, store_of(to->caches, kind), points, n, &open);
    if (status != SHEEN_OK || !open) return status;
    status = make_ready(c, &points[0], stats);
    if (status != SHEEN_OK) return status;
    RecordKind k = record_kind(c, to, kind);
    AdaptCache cache = {.irradiance = kind == KIND_IRRADIANCE ? to->caches->irradiance : NULL,
                        .radiance = kind == KIND_IRRADIANCE ? NULL : to->caches->radiance[kind - KIND_RADIANCE]};
    const Convergence convergence = {work, &k, cache, to->rounds, to->adaptive ? view : NULL};
    return sheen_converge(&convergence, points, n, stats);
}

static SheenStatus cover_glossy(SheenCached *c, const SheenWork *work, const Target *to, SheenBasis basis,
                                const SeenPoints *seen, SheenAdaptView *view, SheenStats *stats)
{
    ShadingPoint *points = malloc((seen->n_glossy + 1) * sizeof *points);
    if (!points) return SHEEN_ERR_NOMEM;
    size_t n = 0;
    for (size_t i = 0; i < seen->n_glossy; ++i)
        if (seen->glossy[i].basis == basis) points[n++] = seen->glossy[i].at;
    SheenStatus status = cover(c, work, to, KIND_RADIANCE + (int)basis, points, n, view, stats);
    free(points);
    return status;
}

// Makes records until all that is seen is covered.
static SheenStatus fill(SheenCached *c, const SheenWork *work, const Target *to, const SeenPoints *seen,
                        SheenStats *stats)
{
    double start = sheen_clock_seconds();
    SheenAdaptView view = {0};
    SheenStatus status = cover(c, work, to, KIND_IRRADIANCE, seen->points, seen->n_points, &view, stats);
    for (int b = 0; b < SHEEN_BASIS_COUNT && status == SHEEN_OK && seen->n_glossy > 0; ++b)
        status = cover_glossy(c, work, to, (SheenBasis)b, seen, &view, stats);
    sheen_adapt_free(&view);
    stats->time_fill += sheen_clock_seconds() - start;
    return status;
}

SheenStatus sheen_cached_fill(SheenCached *c, const SheenView *view, SheenStats *stats)
{
    enum { ROUNDS_MAX = 32 };
    if (!c->indirect) return SHEEN_OK;
    SheenWork work = sheen_work_for(&c->work, view);
    SeenPoints seen = {0};
    double start = sheen_clock_seconds();
    progress_report(work.progress, "visibility", 0.0, 0);
    SheenStatus status = sheen_first_points(&work, NULL, stats, &seen);
    stats->time_visibility += sheen_clock_seconds() - start;
    const Target kept = {&c->caches, NULL, ROUNDS_MAX, work.options.adaptive};
    if (status == SHEEN_OK) status = fill(c, &work, &kept, &seen, stats);
    sheen_seen_free(&seen);
    return status;
}

SheenStatus sheen_cached_settle(SheenCached *c, SheenStats *stats)
{
    double start = sheen_clock_seconds();
    SheenStatus status = sheen_caches_smooth(&c->work, &c->settled, &c->caches);
    if (status == SHEEN_OK) sheen_cached_adopt(c);
    stats->time_fill += sheen_clock_seconds() - start;
    return status;
}

// Shows points that are to be sampled, and leaves the others in the list.
static SheenStatus sample(SheenCached *c, const SheenWork *work, const PictureCaches *caches, SeenPoints *uncovered,
                          Picture *picture, SheenStats *stats)
{
    size_t n = uncovered->n_points, n_sampled = 0, n_left = 0;
    if (n == 0) return SHEEN_OK;
    double start = sheen_clock_seconds();
    bool *sampled = malloc(n * sizeof *sampled);
    ShadingPoint *points = malloc(n * sizeof *points);
    Rgb *E = malloc(n * sizeof *E);
    SheenStatus status = sampled && points && E ? SHEEN_OK : SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK) status = make_ready(c, &uncovered->points[0], stats);
    if (status == SHEEN_OK)
        status = sheen_give_way_choose(work, caches->kept->irradiance->store, uncovered->points, n, sampled);
    for (size_t i = 0; i < n && status == SHEEN_OK; ++i) {
        const ShadingPoint p = uncovered->points[i];
        if (sampled[i])
            points[n_sampled++] = p;
        else
            uncovered->points[n_left++] = p;
    }
    if (status == SHEEN_OK) status = sheen_give_way_gather(work, c->sampled, points, n_sampled, E, stats);
    if (status == SHEEN_OK) {
        uncovered->n_points = n_left;
        sheen_shade_sampled(points, n_sampled, E, picture, stats);
    }
    free(sampled);
    free(points);
    free(E);
    stats->time_interpolate += sheen_clock_seconds() - start;
    return status;
}

// Shades samples of each pixel from `first` on, and fills the picture's own caches where it sees what no record covers.
static SheenStatus shade(SheenCached *c, const SheenWork *work, SheenCaches *own, uint32_t first, Picture *picture,
                         SheenStats *stats)
{
    SeenPoints uncovered = {0};
    const PictureCaches caches = {&c->caches, own};
    SheenStatus status = sheen_shade(work, c->indirect ? &caches : NULL, first, picture, &uncovered, stats);
    // Records for the first samples serve the further ones too; those that these still need serve no others.
    if (status == SHEEN_OK && first > 0) status = sample(c, work, &caches, &uncovered, picture, stats);
    if (status == SHEEN_OK && uncovered.n_points + uncovered.n_glossy > 0) {
        if (!own->irradiance) status = sheen_caches_create(work, own);
        const Target to = {own, &c->caches, 1, false};
        if (status == SHEEN_OK) status = fill(c, work, &to, &uncovered, stats);
        if (status == SHEEN_OK) sheen_shade_uncovered(&work->options, &caches, &uncovered, picture, stats);
    }
    sheen_seen_free(&uncovered);
    return status;
}

SheenStatus sheen_cached_shade(SheenCached *c, const SheenView *view, SheenFilm *film, SheenStats *stats)
{
    const SheenOptions *o = &c->work.options;
    SheenWork work = sheen_work_for(&c->work, view);
    SheenCaches own = {0};
    Picture picture;
    uint64_t more = 0;
    if (!sheen_picture_create(&work, film, &picture)) return SHEEN_ERR_NOMEM;
    SheenStatus status = shade(c, &work, &own, 0, &picture, stats);
    if (status == SHEEN_OK && !sheen_picture_plan(o->noise, &picture, &more)) status = SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK && more > 0) status = shade(c, &work, &own, o->spp, &picture, stats);
    sheen_picture_average(&picture);
    stats->spp_done = o->spp;
    stats->spp_mean = (double)o->spp + (double)more / ((double)film->width * film->height);
    sheen_caches_count(&c->caches, stats);
    sheen_caches_count(&own, stats);
    if (c->deep) stats->deep_records = sheen_deep_records(c->deep);
    sheen_caches_free(&own);
    sheen_picture_free(&picture);
    return status;
}
