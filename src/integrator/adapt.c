// SPDX-License-Identifier: Apache-2.0
#include "integrator/adapt.h"

#include "integrator/record_radius.h"
#include "integrator/shade.h"

#include <stdlib.h>
#include <string.h>

enum {
    STRIDE = 2, // below reaches of 4 pixels, the least by default: every second pixel misses no overlap that matters
    BLOCK = 256 // points an item
};

// ---- what is looked at --------------------------------------------------------------------------------------------

SheenStatus sheen_adapt_look(const SheenWork *work, SheenStats *stats, SheenAdaptView *out)
{
    *out = (SheenAdaptView){0};
    size_t n = (size_t)work->width * work->height;
    SheenFilm *film = NULL;
    Picture picture = {0};
    out->direct = calloc(n, sizeof *out->direct);
    SheenStatus status = out->direct ? sheen_film_create(work->width, work->height, 0, &film) : SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK && !sheen_picture_create(work, film, &picture)) status = SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK) {
        // Part of the fill: its progress is not that of a picture, nor are its seconds.
        SheenWork quiet = *work;
        quiet.progress = NULL;
        SheenStats counted = {0};
        const SheenCaches none = {0};
        const PictureCaches caches = {&none, &none};
        sheen_every_pixel(STRIDE, work->width, work->height, picture.samples);
        status = sheen_shade(&quiet, &caches, 0, &picture, &out->seen, &counted);
        sheen_stats_add(stats, &counted);
    }
    for (size_t i = 0; i < n && status == SHEEN_OK; ++i) out->direct[i] = fabsf(rgb_luminance(film->color[i]));
    sheen_picture_free(&picture);
    sheen_film_destroy(&film);
    return status;
}

void sheen_adapt_free(SheenAdaptView *view)
{
    sheen_seen_free(&view->seen);
    free(view->direct);
    *view = (SheenAdaptView){0};
}

// ---- the metric ---------------------------------------------------------------------------------------------------

// The interpolated value of records, and its standard error.
typedef struct Mean {
    float Y, sigma;
} Mean;

static Mean mean_without(unsigned n, const AdaptShare share[], unsigned left_out)
{
    float weights = 0.0f, sum = 0.0f, square = 0.0f;
    for (unsigned i = 0; i < n; ++i) {
        if (i == left_out) continue;
        weights += share[i].weight;
        sum += share[i].weight * share[i].Y;
        square += sqrf(share[i].weight * share[i].sigma);
    }
    return (Mean){sum / weights, sqrtf(square) / weights};
}

unsigned sheen_adapt_tell(float discernible, float direct, unsigned n, AdaptShare share[])
{
    while (n > 1) {
        Mean all = mean_without(n, share, n);
        unsigned out = n;
        for (unsigned i = 0; i < n; ++i) {
            if (share[i].fixed || (out < n && share[i].weight >= share[out].weight)) continue;
            Mean others = mean_without(n, share, i);
            float least = discernible * (all.Y + direct) + maxf(all.sigma, others.sigma);
            if (fabsf(all.Y - others.Y) > least) out = i;
        }
        if (out == n) break;
        AdaptShare told = share[out];
        share[out] = share[--n];
        share[n] = told;
    }
    return n;
}

// ---- a pass ---------------------------------------------------------------------------------------------------------

typedef struct Pass {
    const SheenWork *work;
    const SheenAdaptView *view;
    const AdaptCache *cache;
    SheenRecordStore *store;
    SheenOctree *const *touched; // [2] or NULL
    _Atomic uint32_t *least; // [records] bits of the least accuracy that was asked for; positive floats sort like them
} Pass;

static void ask_for(_Atomic uint32_t *least, float a)
{
    uint32_t bits, known = atomic_load_explicit(least, memory_order_relaxed);
    memcpy(&bits, &a, sizeof bits);
    while (bits < known && !atomic_compare_exchange_weak(least, &known, bits)) continue;
}

static bool is_touched(SheenOctree *const touched[2], Vec3 p)
{
    return !touched || sheen_octree_holds(touched[0], p) || sheen_octree_holds(touched[1], p);
}

// Luminance that a point shows by one record alone. @param g  the same point, where it is glossy
static float shown(const Pass *s, const ShadingPoint *p, const GlossyPoint *g, uint32_t record)
{
    const Contributors one = {.n = 1, .record = {record}, .weight = {1.0f}, .weight_sum = 1.0f};
    const DiffusePoint *at = &p->point;
    Rgb L;
    if (g) {
        RadianceLobe lobe = {g->order, s->view->seen.lobes + g->lobe};
        L = sheen_radiance_reflect(s->cache->radiance, &one, at->p, at->n, &lobe);
    } else {
        Rgb E = sheen_irradiance_interpolate_bent(s->store, s->cache->irradiance->light, &one, at->p, at->n, at->bent);
        L = rgb_scale(rgb_mul(at->reflectance, E), SHEEN_INV_PI);
    }
    return fabsf(rgb_luminance(rgb_mul(p->throughput, L)));
}

// @param g  the same point, where it is glossy
static void pass_point(const Pass *s, const ShadingPoint *p, const GlossyPoint *g)
{
    const SheenOptions *o = &s->work->options;
    Contributors c;
    AdaptShare share[SHEEN_CONTRIBUTORS_MAX];
    if (!is_touched(s->touched, p->point.p)) return;
    sheen_store_find_near(s->store, p->point.p, p->point.n, record_most_enlarged(o, p->footprint), &c);
    if (c.n < 2) return;
    for (unsigned i = 0; i < c.n; ++i) {
        const Record *r = &s->store->records[c.record[i]];
        bool enlarged = record_is_enlarged(r);
        float w = enlarged ? c.weight[i] : c.weight[i] + 1.0f / r->a, Y = shown(s, p, g, c.record[i]);
        share[i] = (AdaptShare){c.record[i], w, Y, r->error * Y, enlarged || r->a <= record_least_accuracy(o, r)};
    }
    unsigned stay = sheen_adapt_tell(o->discernible, s->view->direct[p->pixel], c.n, share);
    for (unsigned i = stay; i < c.n; ++i) {
        const Record *r = &s->store->records[share[i].record];
        // The printed |p - p_i| / R_i forgets the normals.
        ask_for(&s->least[share[i].record], maxf((1.0f - 1e-4f) / share[i].weight, record_least_accuracy(o, r)));
    }
}

static void pass_diffuse(void *user, size_t item, unsigned worker)
{
    (void)worker;
    const Pass *s = user;
    const SeenPoints *seen = &s->view->seen;
    for (size_t i = item * BLOCK; i < seen->n_points && i < (item + 1) * BLOCK; ++i)
        pass_point(s, &seen->points[i], NULL);
}

static void pass_glossy(void *user, size_t item, unsigned worker)
{
    (void)worker;
    const Pass *s = user;
    const SeenPoints *seen = &s->view->seen;
    for (size_t i = item * BLOCK; i < seen->n_glossy && i < (item + 1) * BLOCK; ++i)
        if (seen->glossy[i].basis == s->cache->radiance->basis) pass_point(s, &seen->glossy[i].at, &seen->glossy[i]);
}

// The least accuracy that was asked for, of each record.
static void read_least(const Pass *s, float a[])
{
    for (uint32_t i = 0; i < s->store->n; ++i) {
        uint32_t bits = atomic_load_explicit(&s->least[i], memory_order_relaxed);
        a[i] = INFINITY;
        if (bits != UINT32_MAX) memcpy(&a[i], &bits, sizeof bits);
    }
}

SheenStatus sheen_adapt_pass(const SheenWork *work, const SheenAdaptView *view, SheenOctree *const touched[2],
                             const AdaptCache *cache)
{
    Pass s = {.work = work, .view = view, .cache = cache, .store = adapt_store(cache), .touched = touched};
    size_t n = cache->radiance ? view->seen.n_glossy : view->seen.n_points;
    if (s.store->n == 0) return SHEEN_OK;
    s.least = malloc(s.store->n * sizeof *s.least);
    float *a = malloc(s.store->n * sizeof *a);
    SheenStatus status = s.least && a ? SHEEN_OK : SHEEN_ERR_NOMEM;
    for (uint32_t i = 0; i < s.store->n && status == SHEEN_OK; ++i) atomic_init(&s.least[i], UINT32_MAX);
    if (status == SHEEN_OK && !sheen_pool_run(work->pool, (n + BLOCK - 1) / BLOCK,
                                              cache->radiance ? pass_glossy : pass_diffuse, &s, work->cancel))
        status = SHEEN_ERR_CANCELLED;
    if (status == SHEEN_OK) {
        read_least(&s, a);
        sheen_store_refine(s.store, a);
    }
    free((void *)s.least);
    free(a);
    return status;
}
