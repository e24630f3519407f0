// SPDX-License-Identifier: Apache-2.0
#include "integrator/fill.h"

#include "integrator/hemisphere.h"
#include "integrator/thin.h"

#include <stdlib.h>
#include <string.h>

// The reach a R of a record on a plane, in pixels. Below the least nothing is seen, above the most one record's noise
// would spread over a wide disc.
static const float reach_min_px = 4.0f, reach_max_px = 25.0f;
// A gather spends more rays until the standard error of its irradiance is expected to be so small.
static const float gather_error = 0.03f;
// A record that reaches no farther than the pixel's limit counts beside several others wherever it is read, so that it
// may have as many times that error as its reach is enlarged, up to so many.
static const float error_growth_max = 3.0f;
enum {
    LIGHT_SAMPLES = 1,  // at each hit of a gather: the best value per ray of 1, 2 and 4
    EXTENSIONS_MAX = 2, // vertices by which near hits are moved on
    COVER_BLOCK = 1024, // points an item of the coverage test
};

struct SheenFill {
    const SheenWork *work;
    const SheenDeep *deep;
    SheenIrradianceCache *cache;
    SheenStrata strata;
    unsigned workers;
    Hemisphere *scratch; // [workers]
    SheenStats *stats;   // [workers]
};

SheenStatus sheen_fill_create(const SheenWork *work, const SheenDeep *deep, SheenIrradianceCache *cache,
                              SheenFill **out)
{
    *out = NULL;
    SheenFill *f = calloc(1, sizeof *f);
    if (!f) return SHEEN_ERR_NOMEM;
    *f = (SheenFill){.work = work,
                     .deep = deep,
                     .cache = cache,
                     .strata = sheen_strata_cosine(work->options.gather_rays),
                     .workers = sheen_pool_size(work->pool)};
    f->scratch = calloc(f->workers, sizeof *f->scratch);
    f->stats = calloc(f->workers, sizeof *f->stats);
    bool ok = f->scratch && f->stats;
    for (unsigned i = 0; i < f->workers && ok; ++i) ok = sheen_hemisphere_reserve(&f->scratch[i], f->strata);
    if (!ok) {
        sheen_fill_destroy(&f);
        return SHEEN_ERR_NOMEM;
    }
    *out = f;
    return SHEEN_OK;
}

void sheen_fill_destroy(SheenFill **fill)
{
    SheenFill *f = fill ? *fill : NULL;
    if (!f) return;
    for (unsigned i = 0; i < f->workers && f->scratch; ++i) sheen_hemisphere_free(&f->scratch[i]);
    free(f->scratch);
    free(f->stats);
    free(f);
    *fill = NULL;
}

// ---- one record -------------------------------------------------------------------------------------------------

// Light at the vertices beyond their direct light, from the deep records.
static void add_deep_light(const SheenFill *f, Hemisphere *h)
{
    if (!f->deep) return;
    enum { BLOCK = 64 };
    DeepQuery queries[BLOCK];
    for (size_t first = 0; first < h->n_vertices; first += BLOCK) {
        const GatherVertex *v = h->vertices + first;
        size_t n = h->n_vertices - first < BLOCK ? h->n_vertices - first : BLOCK;
        for (size_t i = 0; i < n; ++i)
            queries[i] = sheen_deep_ask(f->deep, v[i].point.p, v[i].point.n, v[i].distance, (int)v[i].bounces - 1,
                                        hash_combine(h->key, v[i].ray));
        for (size_t i = 0; i < n; ++i) {
            Rgb E = sheen_deep_answer(f->deep, &queries[i]);
            h->L[v[i].cell] = rgb_add(h->L[v[i].cell], rgb_mul(v[i].weight, E));
        }
    }
}

// Light at the vertices of the rays traced last: direct, and from deeper bounces.
static void light_vertices(const SheenFill *f, Hemisphere *h, SheenStats *stats)
{
    sheen_hemisphere_direct(f->work, 0, LIGHT_SAMPLES, h, stats);
    bool paths = f->work->options.secondary == SHEEN_SECONDARY_PATH;
    float near = paths ? INFINITY : f->deep ? sheen_deep_near(f->deep) : 0.0f;
    unsigned extensions = paths ? f->work->options.bounces : EXTENSIONS_MAX;
    for (unsigned i = 0; i < extensions; ++i) {
        size_t before = h->n_vertices, moved = sheen_hemisphere_extend(f->work, near, h, stats);
        if (moved == 0) break;
        sheen_hemisphere_direct(f->work, before - moved, 1, h, stats);
    }
    add_deep_light(f, h);
}

// The hot spots that matter at a point, by the mean radiance about it as the deep records know it.
static void choose_guide(const SheenFill *f, const DiffusePoint *p, Hemisphere *h)
{
    DeepQuery query = sheen_deep_ask(f->deep, p->p, p->n, 0.0f, (int)f->work->options.bounces - 1, 0);
    float mean = SHEEN_INV_PI * rgb_luminance(sheen_deep_answer(f->deep, &query));
    sheen_guide_choose(sheen_deep_hot_spots(f->deep), p->p, &h->frame, h->strata, mean, gather_error, &h->guide);
}

// The least R of a record: its reach is then reach_min_px.
static float least_radius(const SheenOptions *o, float footprint)
{
    return reach_min_px * footprint / o->accuracy;
}

static void gather_light(const SheenFill *f, const DiffusePoint *p, float R_min, uint32_t key, Hemisphere *h,
                         SheenStats *stats)
{
    unsigned bounces = f->work->options.bounces;
    sheen_hemisphere_begin(p, key, h);
    if (f->deep) choose_guide(f, p, h);
    sheen_hemisphere_trace(f->work, p, bounces, h, stats);
    light_vertices(f, h, stats);
    float enlarged = R_min / sheen_harmonic_mean((unsigned)h->cells, h->distance);
    float noisier = clampf(enlarged, 1.0f, error_growth_max);
    if (sheen_hemisphere_refine(f->work, p, bounces, noisier * gather_error, h, stats)) light_vertices(f, h, stats);
    sheen_hemisphere_add_caustics(f->work, p, noisier, h, stats);
}

// Radius from the estimate: harmonic mean, bounded by the gradient, then by the pixel. Source:
// krivanek2006-making-caching-practical eq. (2), on luminance, for the second.
static void set_radius(const SheenOptions *o, const IrradianceEstimate *e, float footprint, Record *r,
                       IrradianceLight *light)
{
    float R_max = reach_max_px * footprint / o->accuracy;
    r->R_min = least_radius(o, footprint);
    float R = e->R;
    if (o->gradient_clamping) {
        float g = hypotf(rgb_luminance(e->translation[0]), rgb_luminance(e->translation[1]));
        if (g > 0.0f) R = minf(R, rgb_luminance(e->E) / g);
    }
    r->R = clampf(R, r->R_min, R_max);
    r->R_sure = maxf(R, SHEEN_SLIVER * r->R_min);
    // Where the pixel allows no smaller radius the gradient would overshoot: it is scaled down by as much.
    if (!(R < r->R_min)) return;
    float scale = maxf(R, 0.0f) / r->R_min;
    for (int i = 0; i < 3; ++i) light->translation[i] = v3_scale(light->translation[i], scale);
}

static void make_record(const SheenFill *f, const ShadingPoint *p, uint32_t key, Hemisphere *h, SheenStats *stats,
                        Record *r, IrradianceLight *light)
{
    gather_light(f, &p->point, least_radius(&f->work->options, p->footprint), key, h, stats);
    for (size_t i = 0; i < h->cells; ++i)
        if (!rgb_finite(h->L[i])) {
            h->L[i] = rgb_gray(0.0f);
            ++stats->nonfinite_samples;
        }
    IrradianceEstimate e;
    sheen_estimate_irradiance(h->strata, h->directions, h->L, h->distance, &e);
    *r = (Record){.p = p->point.p, .n = p->point.n, .error = h->error};
    *light = (IrradianceLight){.E = e.E};
    if (f->work->options.gradients == SHEEN_GRADIENTS_STRATIFIED) {
        estimate_world_gradient(&h->frame, e.translation, light->translation);
        estimate_world_gradient(&h->frame, e.rotation, light->rotation);
    }
    set_radius(&f->work->options, &e, p->footprint, r, light);
}

// ---- waves ------------------------------------------------------------------------------------------------------

/** State of the waves over one set of points. */
typedef struct Waves {
    SheenFill *fill;
    const ShadingPoint *points; // [n]
    size_t n;
    uint32_t *open; // points without a record, coarse to fine
    size_t n_open;
    unsigned char *covered; // [n_open]
    unsigned char *made_at; // [points] a record was made there: covered, whatever its numbers are
    float *spacing;         // [n_open] distance within which one record of the wave is enough
    uint32_t *accepted;     // the wave's new records
    size_t n_accepted;
    Record *records;        // [n_accepted]
    IrradianceLight *light; // [n_accepted]
    uint32_t made;          // records before the wave, for keys and progress
} Waves;

static void cover_task(void *user, size_t item, unsigned worker)
{
    (void)worker;
    Waves *w = user;
    float a = w->fill->work->options.accuracy;
    size_t end = (item + 1) * COVER_BLOCK < w->n_open ? (item + 1) * COVER_BLOCK : w->n_open;
    for (size_t i = item * COVER_BLOCK; i < end; ++i) {
        const ShadingPoint *p = &w->points[w->open[i]];
        Contributors c;
        sheen_store_find(w->fill->cache->store, p->point.p, p->point.n, 0.0f, &c);
        w->covered[i] = c.cover > 1 || w->made_at[w->open[i]];
        if (w->covered[i]) continue;
        float most = reach_max_px * p->footprint;
        float radius = sheen_store_expect_radius(w->fill->cache->store, p->point.p);
        w->spacing[i] = isinf(radius) ? 0.5f * most : clampf(a * radius, reach_min_px * p->footprint, most);
    }
}

static void gather_task(void *user, size_t item, unsigned worker)
{
    Waves *w = user;
    const SheenFill *f = w->fill;
    uint32_t key = hash_combine(f->work->options.seed ^ 0x9a7eu, w->made + (uint32_t)item);
    make_record(f, &w->points[w->accepted[item]], key, &f->scratch[worker], &f->stats[worker], &w->records[item],
                &w->light[item]);
    if (worker == 0) {
        // Most of the points that a wave finds open it covers.
        double before = 1.0 - (double)w->n_open / (double)w->n, wave = (double)item / (double)w->n_accepted;
        progress_report(f->work->progress, "fill", before + 0.7 * (1.0 - before) * wave, w->made + item);
    }
}

// Pixels whose coordinates are multiples of 64 come first, then of 32, and so on: each level doubles the density.
static unsigned level_of(uint32_t pixel, uint32_t width)
{
    uint32_t bits = (pixel % width) | (pixel / width) | 64u;
    unsigned level = 0;
    while (!(bits >> level & 1u)) ++level;
    return 6u - level;
}

static void order_points(Waves *w, size_t n, uint32_t width)
{
    size_t next[8] = {0}; // of each level, where its next point goes
    for (size_t i = 0; i < n; ++i) ++next[level_of(w->points[i].pixel, width) + 1];
    for (unsigned level = 0; level < 7; ++level) next[level + 1] += next[level];
    for (size_t i = 0; i < n; ++i) w->open[next[level_of(w->points[i].pixel, width)]++] = (uint32_t)i;
    w->n_open = n;
}

// Drops the covered points and chooses the wave's records among the rest.
static SheenStatus choose(Waves *w)
{
    size_t kept = 0;
    for (size_t i = 0; i < w->n_open; ++i) {
        if (w->covered[i]) continue;
        w->open[kept] = w->open[i];
        w->spacing[kept++] = w->spacing[i];
    }
    w->n_open = kept;
    return sheen_thin(w->fill->work->options.accuracy, reach_max_px, w->fill->work->width, w->points, w->n_open,
                      w->open, w->spacing, w->accepted, &w->n_accepted);
}

static SheenStatus insert_wave(Waves *w)
{
    for (size_t i = 0; i < w->n_accepted; ++i) {
        SheenStatus status = sheen_irradiance_cache_insert(w->fill->cache, &w->records[i], &w->light[i]);
        if (status != SHEEN_OK) return status;
        w->made_at[w->accepted[i]] = 1;
    }
    w->made += (uint32_t)w->n_accepted;
    return SHEEN_OK;
}

// @return SHEEN_OK with n_accepted = 0 when all points are covered.
static SheenStatus run_wave(Waves *w)
{
    const SheenWork *work = w->fill->work;
    size_t blocks = (w->n_open + COVER_BLOCK - 1) / COVER_BLOCK;
    if (!sheen_pool_run(work->pool, blocks, cover_task, w, work->cancel)) return SHEEN_ERR_CANCELLED;
    SheenStatus status = choose(w);
    if (status != SHEEN_OK || w->n_accepted == 0) return status;
    if (!sheen_pool_run(work->pool, w->n_accepted, gather_task, w, work->cancel)) return SHEEN_ERR_CANCELLED;
    return insert_wave(w);
}

SheenStatus sheen_fill_run(SheenFill *f, const ShadingPoint points[], size_t n, SheenStats *stats)
{
    if (n == 0) return SHEEN_OK;
    if (n > UINT32_MAX) return SHEEN_ERR_NOMEM;
    Waves w = {.fill = f, .points = points, .n = n, .made = f->cache->store->n};
    w.open = malloc(n * sizeof *w.open);
    w.covered = malloc(n);
    w.made_at = calloc(n, 1);
    w.spacing = malloc(n * sizeof *w.spacing);
    w.accepted = malloc(n * sizeof *w.accepted);
    w.records = malloc(n * sizeof *w.records);
    w.light = malloc(n * sizeof *w.light);
    SheenStatus status = w.open && w.covered && w.made_at && w.spacing && w.accepted && w.records && w.light
                             ? SHEEN_OK
                             : SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK) order_points(&w, n, f->work->width);
    do {
        if (status == SHEEN_OK) status = run_wave(&w);
        ++stats->passes;
    } while (status == SHEEN_OK && w.n_accepted > 0);
    for (unsigned i = 0; i < f->workers; ++i) {
        sheen_stats_add(stats, &f->stats[i]);
        f->stats[i] = (SheenStats){0};
    }
    free(w.open);
    free(w.covered);
    free(w.made_at);
    free(w.spacing);
    free(w.accepted);
    free(w.records);
    free(w.light);
    return status;
}
