// SPDX-License-Identifier: Apache-2.0
#include "integrator/deep.h"

#include "cache/irradiance_cache.h"
#include "integrator/hemisphere.h"
#include "math/warp.h"

#include <stdlib.h>
#include <string.h>

// Measured on the Cornell box and a staircase: finer gathers or records gain nothing, coarser ones bias
// (docs/irradiance-caching.md).
static const float deep_accuracy = 0.5f;
enum { DEEP_RINGS = 12, DEEP_SECTORS = 36, DEEP_CELLS = DEEP_RINGS * DEEP_SECTORS };
static const SheenStrata deep_strata = {.rings = DEEP_RINGS, .sectors = DEEP_SECTORS};
enum {
    PROBES = 24,    // rays that estimate the radius of a record before it is placed
    FOLLOWED = 12,  // hits of those that are looked at next
    GRAZING = 2,    // rings of the grazing rays that find what stands beside a record: up to 24 degrees
    KEPT = 4,       // deep records that a stored hit reads
    ROUNDS_MAX = 3, // of placing records at hits that no record covers
    BUDGET = 2500,  // records of the first round; where it does not suffice all sizes grow
};
static const float growth = 1.5f;
// Sizes in units of the scale: the median distance that light goes between surfaces.
static const float reach_min = 0.03f, reach_max = 0.25f, near = 0.105f;

/** What a stratum of a deep gather saw. */
typedef struct DeepCell {
    Vec3 p, n, ng;  // the hit's vertex; p is off the surface, where rays leave; of the sky, where it shines in
    Rgb weight;     // radiance per irradiance there; black without vertex
    bool turned;    // the vertex lies beyond a glossy surface, one scattering more away
    Rgb sky;        // radiance of the sky and of caustics
    Rgb direct;     // after one scattering: weight times direct irradiance, and what lamps send to glossy surfaces
    Rgb beyond;     // after two: the same of a vertex that is turned to
    float distance; // INFINITY for the sky
    uint32_t record[KEPT];
    float share[KEPT]; // of the records' irradiance; sum 1, or all 0 where no record covers the hit: it then takes the
                       // gather's own point for a guess
} DeepCell;

/** What stands up beside a record in the way of a sector's grazing ray, in the record's local frame. */
typedef struct Horizon {
    float distance, height; // metres along the surface and above it; INFINITY for the sky
} Horizon;

struct SheenDeep {
    const SheenWork *work;
    unsigned bounces;
    float scale;     // metres
    float reach_min; // metres
    SheenRecordStore *store;
    DiffusePoint *points;                      // [records]
    DeepCell *cells;                           // [records][strata], freed after the solution
    Horizon *horizon;                          // [gathered records][DEEP_SECTORS]
    float *nearest;                            // [gathered records] least distance of its horizon
    IrradianceLight *light[SHEEN_DEEP_LEVELS]; // light[i][record] holds k = bounces - i
    Rgb mean[SHEEN_DEEP_LEVELS];               // over all records: a guess where there is none
    HotSpots hot;
    uint32_t point_capacity, gathered;
};

// ---- placement --------------------------------------------------------------------------------------------------

/** Points to look at, first in first out. */
typedef struct Queue {
    DiffusePoint *items;
    size_t head, tail, capacity;
} Queue;

static bool queue_push(Queue *q, const DiffusePoint *p)
{
    if (q->tail == q->capacity) {
        size_t capacity = q->capacity ? 2 * q->capacity : 1024;
        DiffusePoint *grown = realloc(q->items, capacity * sizeof *grown);
        if (!grown) return false;
        q->items = grown;
        q->capacity = capacity;
    }
    q->items[q->tail++] = *p;
    return true;
}

static uint32_t point_key(const SheenDeep *d, uint32_t index, uint32_t use)
{
    return hash_combine(hash_combine(d->work->options.seed ^ 0xdee9u, index), use);
}

static float reach_of(const SheenDeep *d, float R)
{
    return clampf(deep_accuracy * R, d->reach_min, maxf(reach_max * d->scale, d->reach_min));
}

static bool store_point(SheenDeep *d, const DiffusePoint *p, float R)
{
    uint32_t i = d->store->n;
    if (i == d->point_capacity) {
        uint32_t capacity = i ? 2 * i : 1024;
        DiffusePoint *grown = realloc(d->points, capacity * sizeof *grown);
        if (!grown) return false;
        d->points = grown;
        d->point_capacity = capacity;
    }
    d->points[i] = *p;
    float clamped = reach_of(d, R) / deep_accuracy;
    Record record = {.p = p->p, .n = p->n, .R = clamped, .a = deep_accuracy, .R_min = clamped, .R_sure = clamped};
    return sheen_store_insert(d->store, &record) == SHEEN_OK;
}

static SheenStatus create_store(SheenDeep *d)
{
    return sheen_store_create(deep_accuracy, false, &d->work->scene->bounds, &d->store);
}

// Whether something stands between a record and a point of its surface, as the record's grazing rays saw it. A surface
// that bends up to the point is not in the way.
static bool is_behind(const SheenDeep *d, uint32_t record, Vec3 p)
{
    const float before = 0.95f;              // of the distance: a wall that the point lies on is not in its way
    if (record >= d->gathered) return false; // nothing is known yet
    const Record *r = &d->store->records[record];
    Vec3 v = v3_sub(p, r->p);
    if (!(v3_length2(v) > sqrf(d->nearest[record]))) return false;
    Frame f = frame_from_normal(r->n);
    Vec3 l = frame_to_local(&f, v);
    float turn = atan2f(l.y, l.x) * (0.5f * SHEEN_INV_PI);
    unsigned sector = (unsigned)(DEEP_SECTORS * (turn < 0.0f ? turn + 1.0f : turn)) % DEEP_SECTORS;
    const Horizon *h = &d->horizon[(size_t)record * DEEP_SECTORS + sector];
    return h->distance < before * hypotf(l.x, l.y) && h->height > l.z;
}

// The records that serve a point and are not behind a wall. Their reach is wide: without the test light would leak
// along the floor, under thin walls.
static void find(const SheenDeep *d, Vec3 p, Vec3 n, Contributors *out)
{
    Contributors all;
    sheen_store_find(d->store, p, n, &all);
    out->n = out->cover = 0;
    out->weight_sum = 0.0f;
    for (unsigned i = 0; i < all.n; ++i) {
        if (is_behind(d, all.record[i], p)) continue;
        out->record[out->n] = all.record[i];
        out->weight[out->n++] = all.weight[i];
        out->weight_sum += all.weight[i];
    }
    out->cover = out->n;
}

static bool covered(const SheenDeep *d, Vec3 p, Vec3 n)
{
    Contributors c;
    find(d, p, n, &c);
    return c.n > 0;
}

// Places records, up to `most` in all, for the queued points that are not covered; some hits of each are queued in
// turn.
static SheenStatus place(SheenDeep *d, Queue *q, uint32_t most, Hemisphere *probe, SheenStats *stats)
{
    while (q->head < q->tail && d->store->n < most) {
        DiffusePoint p = q->items[q->head++];
        if (covered(d, p.p, p.n)) continue;
        sheen_hemisphere_begin(&p, point_key(d, d->store->n, 0), probe);
        sheen_hemisphere_trace(d->work, &p, 1, probe, stats);
        if (!store_point(d, &p, sheen_harmonic_mean((unsigned)probe->cells, probe->distance))) return SHEEN_ERR_NOMEM;
        size_t step = probe->n_vertices / FOLLOWED + 1;
        for (size_t i = 0; i < probe->n_vertices; i += step)
            if (!queue_push(q, &probe->vertices[i].point)) return SHEEN_ERR_NOMEM;
    }
    q->head = q->tail = 0;
    return SHEEN_OK;
}

// ---- gathering --------------------------------------------------------------------------------------------------

typedef struct DeepTask {
    SheenDeep *deep;
    Hemisphere *scratch;  // [workers]
    SheenStats *stats;    // [workers]
    uint32_t first;       // record of item 0
    unsigned k;           // bounce of the sweep
    const Rgb *before[2]; // [records] E_k-1, E_k-2
    Rgb *now;             // [records] E_k
} DeepTask;

static DeepCell *cells_of(const SheenDeep *d, uint32_t record)
{
    return d->cells + (size_t)record * strata_count(deep_strata);
}

// Where the sky that a stratum saw shines into the scene's box: near the window, where there is one.
static Vec3 shines_in(const SheenDeep *d, uint32_t record, const Hemisphere *h, size_t cell)
{
    Vec3 from = d->points[record].p, along = frame_to_world(&h->frame, h->directions[cell]);
    return v3_mad(from, bounds_exit(&d->work->scene->bounds, from, along), along);
}

// Takes the light that a stratum has by now out of the gather.
static Rgb take_light(Hemisphere *h, size_t cell)
{
    Rgb L = rgb_add(h->L[cell], h->apart[cell]);
    h->L[cell] = h->apart[cell] = rgb_gray(0.0f);
    return L;
}

// Takes down what the grazing rays of a gather came to.
static void set_horizon(SheenDeep *d, uint32_t record, const Hemisphere *h)
{
    d->nearest[record] = INFINITY;
    for (unsigned k = 0; k < DEEP_SECTORS; ++k) {
        Horizon *out = &d->horizon[(size_t)record * DEEP_SECTORS + k];
        *out = (Horizon){INFINITY, INFINITY};
        for (unsigned ring = DEEP_RINGS - GRAZING; ring < DEEP_RINGS; ++ring) {
            size_t cell = k * DEEP_RINGS + ring;
            Vec3 l = h->directions[cell];
            float along = h->distance[cell] * hypotf(l.x, l.y);
            if (along < out->distance) *out = (Horizon){along, h->distance[cell] * l.z};
        }
        d->nearest[record] = minf(d->nearest[record], out->distance);
    }
}

static void set_vertex(const GatherVertex *v, bool turned, DeepCell *c)
{
    c->p = v->point.origin;
    c->n = v->point.n;
    c->ng = v->point.ng;
    c->weight = rgb_scale(v->weight, diffuse_point_open(&v->point));
    c->turned = turned;
}

static void gather_task(void *user, size_t item, unsigned worker)
{
    DeepTask *t = user;
    SheenDeep *d = t->deep;
    const SheenWork *work = d->work;
    uint32_t record = t->first + (uint32_t)item;
    Hemisphere *h = &t->scratch[worker];
    SheenStats *stats = &t->stats[worker];
    sheen_hemisphere_begin(&d->points[record], point_key(d, record, 1), h);
    memset(h->apart, 0, h->cells * sizeof *h->apart);
    h->glossy = h->apart;
    sheen_hemisphere_trace(work, &d->points[record], 2, h, stats); // what turns goes on once
    set_horizon(d, record, h);
    sheen_hemisphere_add_caustics(work, &d->points[record], 1.0f, h, stats);
    DeepCell *cells = cells_of(d, record);
    for (size_t i = 0; i < h->cells; ++i) {
        bool sky = isinf(h->distance[i]) && !h->specular[i];
        cells[i] = (DeepCell){
            .p = sky ? shines_in(d, record, h, i) : d->points[record].p, .sky = h->L[i], .distance = h->distance[i]};
        h->L[i] = rgb_gray(0.0f);
    }
    sheen_hemisphere_direct(work, 0, 1, h, stats);
    for (size_t i = 0; i < h->cells; ++i) cells[i].direct = take_light(h, i);
    size_t before = h->n_vertices, kept = before - sheen_hemisphere_extend(work, 0.0f, h, stats);
    for (size_t i = 0; i < h->cells; ++i) cells[i].direct = rgb_add(cells[i].direct, h->L[i]); // the sky beyond
    memset(h->L, 0, h->cells * sizeof *h->L);
    sheen_hemisphere_direct(work, kept, 1, h, stats);
    for (size_t i = 0; i < h->cells; ++i) cells[i].beyond = take_light(h, i);
    for (size_t i = 0; i < h->n_vertices; ++i) set_vertex(&h->vertices[i], i >= kept, &cells[h->vertices[i].cell]);
}

static void link_task(void *user, size_t item, unsigned worker)
{
    (void)worker;
    DeepTask *t = user;
    SheenDeep *d = t->deep;
    DeepCell *cells = cells_of(d, (uint32_t)item);
    for (size_t i = 0; i < strata_count(deep_strata); ++i) {
        DeepCell *c = &cells[i];
        if (rgb_is_black(c->weight) || c->share[0] > 0.0f) continue;
        Contributors found;
        find(d, c->p, c->n, &found);
        float sum = 0.0f;
        for (int slot = 0; slot < KEPT; ++slot) {
            unsigned best = found.n;
            for (unsigned j = 0; j < found.n; ++j)
                if (found.weight[j] > 0.0f && (best == found.n || found.weight[j] > found.weight[best])) best = j;
            if (best == found.n) break;
            c->record[slot] = found.record[best];
            c->share[slot] = found.weight[best];
            sum += found.weight[best];
            found.weight[best] = 0.0f;
        }
        for (int slot = 0; slot < KEPT && sum > 0.0f; ++slot) c->share[slot] /= sum;
    }
}

// Queues the hits that no record covers.
static SheenStatus queue_uncovered(const SheenDeep *d, uint32_t first, Queue *q)
{
    for (uint32_t r = first; r < d->gathered; ++r) {
        const DeepCell *cells = cells_of(d, r);
        for (size_t i = 0; i < strata_count(deep_strata); ++i) {
            const DeepCell *c = &cells[i];
            if (rgb_is_black(c->weight) || c->share[0] > 0.0f) continue;
            DiffusePoint p = {c->p, c->p, c->ng, c->n, c->n, rgb_scale(c->weight, SHEEN_PI)};
            if (!queue_push(q, &p)) return SHEEN_ERR_NOMEM;
        }
    }
    return SHEEN_OK;
}

static SheenStatus gather_new(SheenDeep *d, DeepTask *task)
{
    uint32_t n = d->store->n;
    DeepCell *grown = realloc(d->cells, (size_t)n * strata_count(deep_strata) * sizeof *grown);
    if (grown) d->cells = grown;
    Horizon *horizon = realloc(d->horizon, (size_t)n * DEEP_SECTORS * sizeof *horizon);
    if (horizon) d->horizon = horizon;
    float *nearest = realloc(d->nearest, (size_t)n * sizeof *nearest);
    if (nearest) d->nearest = nearest;
    if (!grown || !horizon || !nearest) return SHEEN_ERR_NOMEM;
    task->first = d->gathered;
    d->gathered = n;
    SheenPool *pool = d->work->pool;
    const atomic_bool *cancel = d->work->cancel;
    bool done = sheen_pool_run(pool, n - task->first, gather_task, task, cancel) &&
                sheen_pool_run(pool, n, link_task, task, cancel);
    return done ? SHEEN_OK : SHEEN_ERR_CANCELLED;
}

// Places the first records, from the seeds outward. A scene with more small things than the budget allows is covered
// with larger records: deep light is read through the hundreds of rays of a gather, which need no detail.
static SheenStatus place_first(SheenDeep *d, const Queue *seeds, Queue *q, Hemisphere *probe, SheenStats *stats)
{
    for (;;) {
        q->head = q->tail = 0;
        for (size_t i = 0; i < seeds->tail; ++i)
            if (!queue_push(q, &seeds->items[i])) return SHEEN_ERR_NOMEM;
        SheenStatus status = place(d, q, BUDGET, probe, stats);
        if (status != SHEEN_OK || d->store->n < BUDGET) return status;
        sheen_store_destroy(&d->store);
        status = create_store(d);
        if (status != SHEEN_OK) return status;
        d->reach_min *= growth;
    }
}

static SheenStatus place_and_gather(SheenDeep *d, const Queue *seeds, DeepTask *task, SheenStats *stats)
{
    Hemisphere probe = {0};
    Queue queue = {0};
    if (!sheen_hemisphere_reserve(&probe, sheen_strata_cosine(PROBES))) return SHEEN_ERR_NOMEM;
    SheenStatus status = place_first(d, seeds, &queue, &probe, stats);
    for (int round = 0; round < ROUNDS_MAX && status == SHEEN_OK && d->store->n > d->gathered; ++round) {
        uint32_t first = d->gathered;
        progress_report(d->work->progress, "deep light", (double)round / ROUNDS_MAX, d->store->n);
        status = gather_new(d, task);
        if (status != SHEEN_OK || round + 1 == ROUNDS_MAX) break;
        status = queue_uncovered(d, first, &queue);
        if (status == SHEEN_OK) status = place(d, &queue, BUDGET + BUDGET / 2, &probe, stats);
    }
    free(queue.items);
    sheen_hemisphere_free(&probe);
    return status;
}

// ---- solution ---------------------------------------------------------------------------------------------------

// Irradiance at a stratum's vertex. @param E  [records]
static Rgb irradiance_of(const DeepCell *c, const Rgb E[], size_t own)
{
    Rgb sum = c->share[0] > 0.0f ? rgb_gray(0.0f) : E[own];
    for (int i = 0; i < KEPT && c->share[i] > 0.0f; ++i) sum = rgb_mad(sum, c->share[i], E[c->record[i]]);
    return sum;
}

// Radiance that a stratum sends after k bounces. @param before  E_k-1 and E_k-2
static Rgb cell_radiance(const DeepCell *c, unsigned k, const Rgb *const before[2], size_t own)
{
    if (k == 0) return c->sky;
    Rgb L = rgb_add(c->sky, c->direct);
    if (c->turned && k == 1) return L;
    Rgb E = irradiance_of(c, before[c->turned ? 1 : 0], own);
    return rgb_add(L, rgb_add(c->beyond, rgb_mul(c->weight, E)));
}

static void sweep_task(void *user, size_t item, unsigned worker)
{
    DeepTask *t = user;
    SheenDeep *d = t->deep;
    const DeepCell *cells = cells_of(d, (uint32_t)item);
    Hemisphere *h = &t->scratch[worker];
    for (size_t i = 0; i < h->cells; ++i) {
        h->L[i] = cell_radiance(&cells[i], t->k, t->before, item);
        h->distance[i] = cells[i].distance;
    }
    IrradianceEstimate e;
    sheen_estimate_irradiance(h->strata, h->L, h->distance, &e);
    t->now[item] = e.E;
    unsigned level = d->bounces - t->k;
    if (level >= SHEEN_DEEP_LEVELS) return;
    IrradianceLight *light = &d->light[level][item];
    Frame frame = frame_from_normal(d->points[item].n);
    light->E = e.E;
    estimate_enlarge(estimate_gradient_radius(&e), d->store->records[item].R, &e);
    estimate_world_gradient(&frame, e.translation, light->translation);
    estimate_world_gradient(&frame, e.rotation, light->rotation);
}

static float neighbors_mean(const float L[], unsigned cell)
{
    uint32_t beside[8];
    unsigned n = strata_neighbors(deep_strata, cell % DEEP_RINGS, cell / DEEP_RINGS, beside);
    float sum = 0.0f;
    for (unsigned i = 0; i < n; ++i) sum += L[beside[i]];
    return sum / (float)n;
}

// Remembers the small bright places that the gathers found: a stratum that sends many times the mean, and more than
// its neighbors. What came by a mirror is left out: it does not lie where it is seen.
static void find_hot_spots(SheenDeep *d, const Rgb E[])
{
    const Rgb *const before[2] = {E, E};
    const float times_mean = 10.0f, times_neighbors = 3.0f;
    float L[DEEP_CELLS];
    for (uint32_t r = 0; r < d->gathered; ++r) {
        const DeepCell *cells = cells_of(d, r);
        float sum = 0.0f;
        for (unsigned i = 0; i < DEEP_CELLS; ++i) sum += L[i] = rgb_luminance(cell_radiance(&cells[i], 1, before, r));
        for (unsigned i = 0; i < DEEP_CELLS; ++i) {
            const DeepCell *c = &cells[i];
            if (!(DEEP_CELLS * L[i] > times_mean * sum)) continue;
            if (L[i] < times_neighbors * neighbors_mean(L, i)) continue;
            float distance = v3_length(v3_sub(c->p, d->points[r].p));
            bool straight = isinf(c->distance) || fabsf(distance - c->distance) < 0.01f * distance;
            if (straight && distance > 0.0f) sheen_hot_spots_add(&d->hot, c->p, distance, L[i]);
        }
    }
}

static SheenStatus solve(SheenDeep *d, DeepTask *task)
{
    size_t n = d->gathered;
    Rgb *E[3];
    for (int i = 0; i < 3; ++i) E[i] = calloc(n + 1, sizeof(Rgb));
    SheenStatus status = E[0] && E[1] && E[2] ? SHEEN_OK : SHEEN_ERR_NOMEM;
    for (int i = 0; i < SHEEN_DEEP_LEVELS; ++i) {
        d->light[i] = calloc(n + 1, sizeof(IrradianceLight));
        if (!d->light[i]) status = SHEEN_ERR_NOMEM;
    }
    for (unsigned k = 0; k <= d->bounces && status == SHEEN_OK; ++k) {
        task->k = k;
        task->before[0] = E[(k + 2) % 3];
        task->before[1] = E[(k + 1) % 3];
        task->now = E[k % 3];
        if (!sheen_pool_run(d->work->pool, n, sweep_task, task, d->work->cancel)) status = SHEEN_ERR_CANCELLED;
    }
    for (int i = 0; i < SHEEN_DEEP_LEVELS && status == SHEEN_OK; ++i)
        for (size_t j = 0; j < n; ++j) d->mean[i] = rgb_mad(d->mean[i], 1.0f / (float)n, d->light[i][j].E);
    if (status == SHEEN_OK) find_hot_spots(d, E[d->bounces % 3]);
    for (int i = 0; i < 3; ++i) free(E[i]);
    return status;
}

// ---- creation ---------------------------------------------------------------------------------------------------

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// From each seed some rays start, as those of the picture's gathers will; what they hit is looked at first, and the
// median of their lengths is the scale.
static SheenStatus queue_seeds(SheenDeep *d, const DiffusePoint seeds[], size_t n, Queue *q, SheenStats *stats)
{
    enum { RAYS = 4 };
    float *lengths = malloc((n * RAYS + 1) * sizeof *lengths);
    size_t n_lengths = 0;
    if (!lengths) return SHEEN_ERR_NOMEM;
    for (uint32_t i = 0; i < n * RAYS; ++i) {
        const DiffusePoint *s = &seeds[i / RAYS];
        SheenSampler sampler = sampler_make(hash_u32(d->work->options.seed ^ 0x5eedu), i);
        Frame frame = frame_from_normal(s->n);
        Vec3 dir = frame_to_world(&frame, warp_cosine_hemisphere(sampler_2d(&sampler)));
        if (v3_dot(dir, s->ng) <= 0.0f) continue;
        Ray ray = {s->origin, INFINITY, dir};
        Hit hit;
        sheen_accel_intersect(d->work->accel, &ray, &hit);
        ++stats->rays_gather;
        Followed f;
        sheen_follow(d->work, &ray, &hit, &sampler, &stats->rays_specular, &f);
        if (!f.scatters) continue;
        lengths[n_lengths++] = f.distance;
        if (!queue_push(q, &f.point)) {
            free(lengths);
            return SHEEN_ERR_NOMEM;
        }
    }
    qsort(lengths, n_lengths, sizeof *lengths, compare_floats);
    d->scale = n_lengths ? lengths[n_lengths / 2] : 1.0f;
    d->reach_min = reach_min * d->scale;
    free(lengths);
    return SHEEN_OK;
}

SheenStatus sheen_deep_create(const SheenWork *work, const DiffusePoint seeds[], size_t n, unsigned bounces,
                              SheenStats *stats, SheenDeep **out)
{
    *out = NULL;
    SheenDeep *d = calloc(1, sizeof *d);
    if (!d) return SHEEN_ERR_NOMEM;
    d->work = work;
    d->bounces = bounces;
    unsigned workers = sheen_pool_size(work->pool);
    DeepTask task = {
        .deep = d, .scratch = calloc(workers, sizeof(Hemisphere)), .stats = calloc(workers, sizeof(SheenStats))};
    Queue seed_hits = {0};
    SheenStatus status = create_store(d);
    if (!task.scratch || !task.stats) status = SHEEN_ERR_NOMEM;
    for (unsigned i = 0; i < workers && status == SHEEN_OK; ++i)
        if (!sheen_hemisphere_reserve(&task.scratch[i], deep_strata)) status = SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK) status = queue_seeds(d, seeds, n, &seed_hits, stats);
    if (status == SHEEN_OK) status = place_and_gather(d, &seed_hits, &task, stats);
    if (status == SHEEN_OK) status = solve(d, &task);
    for (unsigned i = 0; i < workers; ++i) {
        if (task.stats) sheen_stats_add(stats, &task.stats[i]);
        if (task.scratch) sheen_hemisphere_free(&task.scratch[i]);
    }
    free(task.scratch);
    free(task.stats);
    free(seed_hits.items);
    free(d->cells);
    d->cells = NULL;
    if (status != SHEEN_OK) sheen_deep_destroy(&d);
    *out = d;
    return status;
}

void sheen_deep_destroy(SheenDeep **deep)
{
    SheenDeep *d = deep ? *deep : NULL;
    if (!d) return;
    sheen_store_destroy(&d->store);
    for (int i = 0; i < SHEEN_DEEP_LEVELS; ++i) free(d->light[i]);
    free(d->points);
    free(d->cells);
    free(d->horizon);
    free(d->nearest);
    free(d);
    *deep = NULL;
}

// ---- reading ----------------------------------------------------------------------------------------------------

Rgb sheen_deep_irradiance(const SheenDeep *d, Vec3 p, Vec3 n, int k)
{
    Contributors c;
    if (k < 0) return rgb_gray(0.0f);
    int level = (int)d->bounces - k;
    find(d, p, n, &c);
    return c.n > 0 ? sheen_irradiance_interpolate(d->store, d->light[level], &c, p, n) : d->mean[level];
}

float sheen_deep_near(const SheenDeep *d)
{
    return near * d->scale;
}

const HotSpots *sheen_deep_hot_spots(const SheenDeep *d)
{
    return &d->hot;
}

uint32_t sheen_deep_records(const SheenDeep *d)
{
    return d->store->n;
}
