// SPDX-License-Identifier: Apache-2.0
#include "integrator/shade.h"

#include "base/clock.h"
#include "integrator/direct.h"
#include "integrator/record_radius.h"

#include <stdlib.h>

/** Buffers of one worker. */
typedef struct Shader {
    Visibility visibility;
    DirectScratch direct;
    DiffusePoint *points; // [capacity]
    uint32_t *at;         // which of the shading points they are
    LightSequence *from;  // of the points' random numbers
    LightNumbers *numbers;
    Rgb *irradiance;
    size_t capacity;
    SheenStats stats;
    double visibility_seconds, direct_seconds, interpolate_seconds;
    bool failed; // out of memory
} Shader;

typedef struct ShadeTask {
    const SheenWork *work;
    const PictureCaches *caches;
    uint32_t first;
    Picture *picture;
    Shader *shaders;       // [workers]
    SeenPoints *uncovered; // [tiles]
} ShadeTask;

static void free_points(Shader *s)
{
    free(s->points);
    free(s->at);
    free(s->from);
    free(s->numbers);
    free(s->irradiance);
}

static bool reserve(Shader *s, size_t n)
{
    if (n <= s->capacity) return true;
    free_points(s);
    s->points = malloc(n * sizeof *s->points);
    s->at = malloc(n * sizeof *s->at);
    s->from = malloc(n * sizeof *s->from);
    s->numbers = malloc(n * sizeof *s->numbers);
    s->irradiance = malloc(n * sizeof *s->irradiance);
    s->capacity = s->points && s->at && s->from && s->numbers && s->irradiance ? n : 0;
    return s->capacity > 0 && sheen_direct_reserve(&s->direct, n);
}

static void shader_free(Shader *s)
{
    sheen_visibility_free(&s->visibility);
    sheen_direct_free(&s->direct);
    free_points(s);
}

// Adds the light that a point reflects for irradiance E, and counts it as `aov`.
static void add_reflected(const ShadingPoint *p, Rgb E, SheenAov aov, Picture *picture, SheenStats *stats)
{
    Rgb value = rgb_scale(rgb_mul(rgb_mul(p->throughput, p->point.reflectance), E), SHEEN_INV_PI);
    sheen_picture_add(picture, p->pixel, p->sample, value, aov, stats);
}

// Without branches or calls: the compiler makes vector instructions of it.
static void light_numbers(size_t n, const LightSequence from[], uint32_t j, uint32_t light, LightNumbers out[])
{
    for (size_t i = 0; i < n; ++i) out[i] = sheen_light_numbers(from[i].key, from[i].index + j, light);
}

static void ask(const SheenWork *work, size_t n, uint32_t light, uint32_t samples, Shader *s)
{
    for (uint32_t j = 0; j < samples; ++j) {
        light_numbers(n, s->from, j, light, s->numbers);
        s->stats.rays_shadow +=
            sheen_direct_add(work, n, s->points, s->numbers, 1.0f / (float)samples, &s->direct, s->irradiance);
    }
}

static bool direct_light(const SheenWork *work, Shader *s, Picture *picture)
{
    size_t n = s->visibility.seen.n_points, m = 0;
    const ShadingPoint *points = s->visibility.seen.points;
    if (n == 0 || sheen_lights_count(work->lights) == 0) return true;
    if (!reserve(s, n)) return false;
    LightPlan plan = sheen_light_plan(work);
    for (size_t i = 0; i < n; ++i) {
        if (points[i].lit) continue;
        s->points[m] = points[i].point;
        s->irradiance[m] = rgb_gray(0.0f);
        s->at[m] = (uint32_t)i;
        s->from[m++] = sheen_light_sequence(work, plan, points[i].branch, points[i].pixel, points[i].sample);
    }
    if (plan.each == 0) ask(work, m, SHEEN_NONE, plan.samples, s);
    for (uint32_t light = 0; light < plan.each; ++light)
        ask(work, m, light, sheen_light_is_delta(work->lights, light) ? 1 : plan.samples, s);
    for (size_t i = 0; i < m; ++i) {
        const ShadingPoint *p = &points[s->at[i]];
        add_reflected(p, s->irradiance[i], p->gathered ? SHEEN_AOV_INDIRECT : SHEEN_AOV_DIRECT, picture, &s->stats);
    }
    return true;
}

/** Records of one kind, as the layers of the cache tell them apart. */
typedef struct RecordLook {
    Rgb dot, transport;
} RecordLook;
static const RecordLook irradiance_look = {{1.0f, 1.0f, 1.0f}, {0.0f, 1.0f, 0.0f}};
static const RecordLook radiance_look = {{1.0f, 0.5f, 0.0f}, {1.0f, 0.0f, 0.0f}};

// Draws the dots of records, round as they are seen: not those along glossy reflections, which would be blurred, nor
// the faint ones in the reflections of glass.
static void draw_dots(const SheenRecordStore *store, const ShadingPoint *p, const Contributors *c, Rgb color,
                      SheenFilm *film)
{
    const float radius = 1.25f;    // pixels
    const float brightest = 0.25f; // the least part of the light that a way carries
    if (p->gathered || !(rgb_max(p->throughput) > brightest)) return;
    bool dot = false;
    for (unsigned i = 0; i < c->n && !dot; ++i) {
        Vec3 d = v3_sub(p->point.p, store->records[c->record[i]].p);
        dot = v3_length2(d) - sqrf(v3_dot(d, p->toward)) < sqrf(radius * p->footprint);
    }
    if (dot) film_add(film, SHEEN_AOV_RECORDS, p->pixel % film->width, p->pixel / film->width, color);
}

// The relative error to be expected of what records say of a point: their noise, and what interpolation adds. That is a
// part of the split-sphere bound 1/w, which is for the worst of scenes; of the radius that a record has by itself, not
// of that which it was enlarged to. Root mean square, each record weighed as in the interpolation.
static float expected_error(const SheenRecordStore *store, const ShadingPoint *p, const Contributors *c)
{
    const float share = 0.15f; // of the bound: what was measured in the Cornell box and in scenes/glossy-box.xml
    float sum = 0.0f;
    for (unsigned i = 0; i < c->n; ++i) {
        const Record *r = &store->records[c->record[i]];
        float w = record_weight(r->R_sure, record_distance2(r, p->point.p), v3_dot(p->point.n, r->n));
        sum += c->weight[i] * (sqrf(share * minf(1.0f / w, 1.0f)) + sqrf(r->error));
    }
    return sqrtf(sum / c->weight_sum);
}

static float mean_accuracy(const SheenRecordStore *store, const Contributors *c)
{
    float sum = 0.0f;
    for (unsigned i = 0; i < c->n; ++i) sum += c->weight[i] * store->records[c->record[i]].a;
    return sum / c->weight_sum;
}

// The layers that show the cache at work.
static void add_cache_layers(const SheenRecordStore *store, const ShadingPoint *p, const Contributors *c,
                             const RecordLook *look, Picture *picture)
{
    SheenFilm *film = picture->film;
    uint32_t x = p->pixel % film->width, y = p->pixel / film->width;
    film_add(film, SHEEN_AOV_TRANSPORT, x, y, look->transport);
    if (!picture->served) return;
    film_add(film, SHEEN_AOV_COVERAGE, x, y, rgb_gray((float)c->n));
    film_add(film, SHEEN_AOV_ACCURACY, x, y, rgb_gray(mean_accuracy(store, c)));
    film_add(film, SHEEN_AOV_ERROR, x, y, rgb_gray(expected_error(store, p, c)));
    ++picture->served[p->pixel];
    draw_dots(store, p, c, look->dot, film);
}

// @param cache  may be NULL @return false where its records say nothing
static bool indirect_diffuse(const SheenOptions *o, const SheenIrradianceCache *cache, const ShadingPoint *p,
                             Picture *picture, SheenStats *stats)
{
    Contributors c;
    if (!cache) return false;
    sheen_store_find_near(cache->store, p->point.p, p->point.n, record_most_enlarged(o, p->footprint), &c);
    if (c.n == 0) return false;
    Rgb E = sheen_irradiance_interpolate_bent(cache->store, cache->light, &c, p->point.p, p->point.n, p->point.bent);
    add_reflected(p, E, SHEEN_AOV_INDIRECT, picture, stats);
    add_cache_layers(cache->store, p, &c, &irradiance_look, picture);
    return true;
}

// @param cache  may be NULL @return false where its records say nothing
static bool indirect_glossy(const SheenOptions *o, const SheenRadianceCache *cache, const GlossyPoint *g,
                            const Rgb lobes[], Picture *picture, SheenStats *stats)
{
    const ShadingPoint *p = &g->at;
    Contributors c;
    if (!cache) return false;
    sheen_store_find_near(cache->store, p->point.p, p->point.n, record_most_enlarged(o, p->footprint), &c);
    if (c.n == 0) return false;
    RadianceLobe lobe = {g->order, lobes + g->lobe};
    Rgb L = sheen_radiance_reflect(cache, &c, p->point.p, p->point.n, &lobe);
    sheen_picture_add(picture, p->pixel, p->sample, rgb_mul(p->throughput, L), SHEEN_AOV_INDIRECT, stats);
    add_cache_layers(cache->store, p, &c, &radiance_look, picture);
    return true;
}

// Adds the indirect light of points. @param uncovered  gets those without a record; NULL: they are left out
// @return false when out of memory
static bool indirect_light(const SheenOptions *o, const PictureCaches *caches, const SeenPoints *seen, Picture *picture,
                           SeenPoints *uncovered, SheenStats *stats)
{
    const SheenCaches *kept = caches->kept, *own = caches->own;
    for (size_t i = 0; i < seen->n_points; ++i) {
        const ShadingPoint *p = &seen->points[i];
        bool covered = indirect_diffuse(o, kept->irradiance, p, picture, stats) ||
                       indirect_diffuse(o, own->irradiance, p, picture, stats);
        if (!covered && uncovered && !sheen_seen_add(p, 1, uncovered)) return false;
    }
    for (size_t i = 0; i < seen->n_glossy; ++i) {
        const GlossyPoint *g = &seen->glossy[i];
        bool covered = indirect_glossy(o, kept->radiance[g->basis], g, seen->lobes, picture, stats) ||
                       indirect_glossy(o, own->radiance[g->basis], g, seen->lobes, picture, stats);
        if (covered || !uncovered) continue;
        if (!sheen_seen_add_glossy(&g->at, g->basis, g->order, seen->lobes + g->lobe, uncovered)) return false;
    }
    return true;
}

// Shades some samples of a tile. @return false when out of memory
static bool shade_range(const ShadeTask *t, const Tile *tile, SampleRange range, SeenPoints *uncovered, Shader *s)
{
    double t0 = sheen_clock_seconds();
    if (!sheen_visibility_trace(t->work, tile, range, t->picture, &s->visibility, &s->stats)) return false;
    double t1 = sheen_clock_seconds();
    if (!direct_light(t->work, s, t->picture)) return false;
    double t2 = sheen_clock_seconds();
    const SheenOptions *o = &t->work->options;
    if (t->caches && !indirect_light(o, t->caches, &s->visibility.seen, t->picture, uncovered, &s->stats)) return false;
    double t3 = sheen_clock_seconds();
    s->visibility_seconds += t1 - t0;
    s->direct_seconds += t2 - t1;
    s->interpolate_seconds += t3 - t2;
    return true;
}

static uint32_t most_samples(const Picture *picture, const Tile *tile)
{
    uint32_t most = 0;
    for (uint32_t y = tile->y; y < tile->y + tile->height; ++y)
        for (uint32_t x = tile->x; x < tile->x + tile->width; ++x) {
            uint32_t n = picture->samples[(size_t)y * picture->film->width + x];
            most = n > most ? n : most;
        }
    return most;
}

static void shade_task(void *user, size_t item, unsigned worker)
{
    ShadeTask *t = user;
    Shader *s = &t->shaders[worker];
    Tile tile = sheen_tile(t->work, (uint32_t)item);
    uint32_t end = most_samples(t->picture, &tile), spp = t->work->options.spp; // so many at once fit the buffers
    for (uint32_t first = t->first; first < end && !s->failed; first += spp)
        if (!shade_range(t, &tile, (SampleRange){first, spp, t->picture->samples}, &t->uncovered[item], s))
            s->failed = true;
    if (worker == 0) progress_report(t->work->progress, "shade", (double)item / sheen_tile_count(t->work), 0);
}

SheenStatus sheen_shade(const SheenWork *work, const PictureCaches *caches, uint32_t first, Picture *picture,
                        SeenPoints *uncovered, SheenStats *stats)
{
    unsigned workers = sheen_pool_size(work->pool);
    uint32_t tiles = sheen_tile_count(work);
    ShadeTask task = {work, caches, first, picture, calloc(workers, sizeof(Shader)), calloc(tiles, sizeof(SeenPoints))};
    SheenStatus status = task.shaders && task.uncovered ? SHEEN_OK : SHEEN_ERR_NOMEM;
    double start = sheen_clock_seconds();
    if (status == SHEEN_OK && !sheen_pool_run(work->pool, tiles, shade_task, &task, work->cancel))
        status = SHEEN_ERR_CANCELLED;
    double elapsed = sheen_clock_seconds() - start, busy = 0.0, part[3] = {0, 0, 0};
    for (unsigned i = 0; i < workers && task.shaders; ++i) {
        Shader *s = &task.shaders[i];
        if (s->failed) status = SHEEN_ERR_NOMEM;
        sheen_stats_add(stats, &s->stats);
        part[0] += s->visibility_seconds, part[1] += s->direct_seconds, part[2] += s->interpolate_seconds;
        shader_free(s);
    }
    // The workers' seconds as shares of the wall clock.
    busy = part[0] + part[1] + part[2];
    double share = busy > 0.0 ? elapsed / busy : 0.0;
    stats->time_visibility += part[0] * share;
    stats->time_direct += part[1] * share;
    stats->time_interpolate += part[2] * share;
    for (uint32_t i = 0; i < tiles && task.uncovered; ++i) {
        if (status == SHEEN_OK && !sheen_seen_append(&task.uncovered[i], uncovered)) status = SHEEN_ERR_NOMEM;
        sheen_seen_free(&task.uncovered[i]);
    }
    free(task.shaders);
    free(task.uncovered);
    return status;
}

void sheen_shade_uncovered(const SheenOptions *o, const PictureCaches *caches, const SeenPoints *uncovered,
                           Picture *picture, SheenStats *stats)
{
    indirect_light(o, caches, uncovered, picture, NULL, stats);
}

void sheen_shade_sampled(const ShadingPoint points[], size_t n, const Rgb E[], Picture *picture, SheenStats *stats)
{
    SheenFilm *film = picture->film;
    for (size_t i = 0; i < n; ++i) {
        const ShadingPoint *p = &points[i];
        add_reflected(p, E[i], SHEEN_AOV_INDIRECT, picture, stats);
        film_add(film, SHEEN_AOV_TRANSPORT, p->pixel % film->width, p->pixel / film->width, rgb(0.0f, 0.0f, 1.0f));
    }
}
