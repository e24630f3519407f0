// SPDX-License-Identifier: Apache-2.0
#include "integrator/fill.h"

#include "integrator/record_radius.h"
#include "integrator/thin.h"

#include <stdlib.h>

enum { COVER_BLOCK = 1024 }; // points an item of the coverage test

/** State of the waves over one set of points. */
typedef struct Waves {
    const SheenWork *work;
    const RecordKind *kind;
    SheenStats *stats;          // [workers]
    const ShadingPoint *points; // [n]
    size_t n;
    uint32_t *open; // points without a record, coarse to fine
    size_t n_open;
    unsigned char *covered; // [n_open]
    unsigned char *made_at; // [points] a record was made there: covered, whatever its numbers are
    float *spacing;         // [n_open] distance within which one record of the wave is enough
    float *a;               // [points] accuracy that a record there begins with
    uint32_t *accepted;     // the wave's new records
    size_t n_accepted;
    Record *records;      // [n_accepted]
    unsigned char *light; // [n_accepted][kind->light_size]
    uint32_t made;        // records before the wave, those around included: for keys and progress
} Waves;

/** Asks whether all points are covered. */
typedef struct Question {
    const SheenOptions *options;
    const SheenRecordStore *store;
    const ShadingPoint *points; // [n]
    size_t n;
    atomic_bool open;
} Question;

static bool is_covered(const SheenOptions *o, const SheenRecordStore *store, const ShadingPoint *p)
{
    Contributors c;
    sheen_store_find_near(store, p->point.p, p->point.n, record_most_enlarged(o, p->footprint), &c);
    return c.cover > 1;
}

static void question_task(void *user, size_t item, unsigned worker)
{
    (void)worker;
    Question *q = user;
    size_t end = (item + 1) * COVER_BLOCK < q->n ? (item + 1) * COVER_BLOCK : q->n;
    for (size_t i = item * COVER_BLOCK; i < end && !atomic_load_explicit(&q->open, memory_order_relaxed); ++i)
        if (!is_covered(q->options, q->store, &q->points[i])) atomic_store(&q->open, true);
}

SheenStatus sheen_fill_is_open(const SheenWork *work, const SheenRecordStore *store, const ShadingPoint points[],
                               size_t n, bool *open)
{
    Question q = {&work->options, store, points, n, false};
    *open = false;
    if (!sheen_pool_run(work->pool, (n + COVER_BLOCK - 1) / COVER_BLOCK, question_task, &q, work->cancel))
        return SHEEN_ERR_CANCELLED;
    *open = atomic_load(&q.open);
    return SHEEN_OK;
}

static void cover_task(void *user, size_t item, unsigned worker)
{
    (void)worker;
    Waves *w = user;
    const SheenOptions *o = &w->work->options;
    size_t end = (item + 1) * COVER_BLOCK < w->n_open ? (item + 1) * COVER_BLOCK : w->n_open;
    for (size_t i = item * COVER_BLOCK; i < end; ++i) {
        const ShadingPoint *p = &w->points[w->open[i]];
        w->covered[i] = w->made_at[w->open[i]] || is_covered(o, w->kind->store, p);
        if (w->covered[i]) continue;
        float most = o->reach_max * p->footprint;
        RecordExpected e = sheen_store_expect(w->kind->store, p->point.p);
        w->spacing[i] = isinf(e.reach) ? 0.5f * most : clampf(e.reach, o->reach_min * p->footprint, most);
        w->a[w->open[i]] = record_first_accuracy(o, e.a);
    }
}

static void gather_task(void *user, size_t item, unsigned worker)
{
    Waves *w = user;
    uint32_t key = hash_combine(w->work->options.seed ^ 0x9a7eu, w->made + (uint32_t)item);
    uint32_t point = w->accepted[item];
    w->kind->make(w->kind->maker, &w->points[point], w->a[point], key, worker, &w->stats[worker], &w->records[item],
                  w->light + item * w->kind->light_size);
    if (worker == 0) {
        // Most of the points that a wave finds open it covers.
        double before = 1.0 - (double)w->n_open / (double)w->n, wave = (double)item / (double)w->n_accepted;
        progress_report(w->work->progress, "fill", before + 0.7 * (1.0 - before) * wave, w->made + item);
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
    return sheen_thin(w->work->options.reach_max, w->work->width, w->points, w->n_open, w->open, w->spacing, w->a,
                      w->accepted, &w->n_accepted);
}

static SheenStatus insert_wave(Waves *w)
{
    for (size_t i = 0; i < w->n_accepted; ++i) {
        if (w->kind->around) sheen_store_bound(w->kind->around, &w->records[i]);
        SheenStatus status = w->kind->insert(w->kind->cache, &w->records[i], w->light + i * w->kind->light_size);
        if (status != SHEEN_OK) return status;
        w->made_at[w->accepted[i]] = 1;
    }
    w->made += (uint32_t)w->n_accepted;
    return SHEEN_OK;
}

// @return SHEEN_OK with n_accepted = 0 when all points are covered.
static SheenStatus run_wave(Waves *w)
{
    const SheenWork *work = w->work;
    size_t blocks = (w->n_open + COVER_BLOCK - 1) / COVER_BLOCK;
    if (!sheen_pool_run(work->pool, blocks, cover_task, w, work->cancel)) return SHEEN_ERR_CANCELLED;
    SheenStatus status = choose(w);
    if (status != SHEEN_OK || w->n_accepted == 0) return status;
    unsigned char *grown = realloc(w->light, w->n_accepted * w->kind->light_size);
    if (!grown) return SHEEN_ERR_NOMEM;
    w->light = grown;
    if (!sheen_pool_run(work->pool, w->n_accepted, gather_task, w, work->cancel)) return SHEEN_ERR_CANCELLED;
    return insert_wave(w);
}

SheenStatus sheen_fill_run(const SheenWork *work, const RecordKind *kind, const ShadingPoint points[], size_t n,
                           SheenStats *stats)
{
    if (n == 0) return SHEEN_OK;
    if (n > UINT32_MAX) return SHEEN_ERR_NOMEM;
    unsigned workers = sheen_pool_size(work->pool);
    Waves w = {.work = work, .kind = kind, .points = points, .n = n, .made = kind->store->n};
    if (kind->around) w.made += kind->around->n;
    w.stats = calloc(workers, sizeof *w.stats);
    w.open = malloc(n * sizeof *w.open);
    w.covered = malloc(n);
    w.made_at = calloc(n, 1);
    w.spacing = malloc(n * sizeof *w.spacing);
    w.a = malloc(n * sizeof *w.a);
    w.accepted = malloc(n * sizeof *w.accepted);
    w.records = malloc(n * sizeof *w.records);
    bool ok = w.stats && w.open && w.covered && w.made_at && w.spacing && w.a && w.accepted && w.records;
    SheenStatus status = ok ? SHEEN_OK : SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK) order_points(&w, n, work->width);
    do {
        if (status == SHEEN_OK) status = run_wave(&w);
        ++stats->passes;
    } while (status == SHEEN_OK && w.n_accepted > 0);
    for (unsigned i = 0; i < workers && w.stats; ++i) sheen_stats_add(stats, &w.stats[i]);
    free(w.stats);
    free(w.open);
    free(w.covered);
    free(w.made_at);
    free(w.spacing);
    free(w.a);
    free(w.accepted);
    free(w.records);
    free(w.light);
    return status;
}
