// SPDX-License-Identifier: Apache-2.0
#include "integrator/shade.h"

#include "base/clock.h"
#include "integrator/direct.h"

#include <stdlib.h>
#include <string.h>

enum { KEY_LIGHT = 0x11c7 };

void sheen_uncovered_free(Uncovered *u)
{
    free(u->points);
    *u = (Uncovered){0};
}

static bool uncovered_push(Uncovered *u, const ShadingPoint *p, size_t n)
{
    if (u->n + n > u->capacity) {
        size_t capacity = 2 * (u->n + n) + 64;
        ShadingPoint *grown = realloc(u->points, capacity * sizeof *grown);
        if (!grown) return false;
        u->points = grown;
        u->capacity = capacity;
    }
    if (n) memcpy(u->points + u->n, p, n * sizeof *p);
    u->n += n;
    return true;
}

/** Buffers of one worker. */
typedef struct Shader {
    Visibility visibility;
    DirectScratch direct;
    DiffusePoint *points; // [capacity]
    uint32_t *keys;       // of the points' random numbers
    uint32_t *indices;    // of the points' first light samples
    LightNumbers *numbers;
    Rgb *irradiance;
    size_t capacity;
    SheenStats stats;
    double visibility_seconds, direct_seconds, interpolate_seconds;
    bool failed; // out of memory
} Shader;

typedef struct ShadeTask {
    const SheenWork *work;
    const SheenIrradianceCache *cache;
    SheenFilm *film;
    Shader *shaders;      // [workers]
    Uncovered *uncovered; // [tiles]
} ShadeTask;

static void free_points(Shader *s)
{
    free(s->points);
    free(s->keys);
    free(s->indices);
    free(s->numbers);
    free(s->irradiance);
}

static bool reserve(Shader *s, size_t n)
{
    if (n <= s->capacity) return true;
    free_points(s);
    s->points = malloc(n * sizeof *s->points);
    s->keys = malloc(n * sizeof *s->keys);
    s->indices = malloc(n * sizeof *s->indices);
    s->numbers = malloc(n * sizeof *s->numbers);
    s->irradiance = malloc(n * sizeof *s->irradiance);
    s->capacity = s->points && s->keys && s->indices && s->numbers && s->irradiance ? n : 0;
    return s->capacity > 0 && sheen_direct_reserve(&s->direct, n);
}

static void shader_free(Shader *s)
{
    sheen_visibility_free(&s->visibility);
    sheen_direct_free(&s->direct);
    free_points(s);
}

// Adds the light that a point reflects for irradiance E, and counts it as `aov`.
static void add_reflected(const SheenWork *work, const ShadingPoint *p, Rgb E, SheenAov aov, SheenFilm *film,
                          SheenStats *stats)
{
    float weight = SHEEN_INV_PI / (float)work->options.spp;
    Rgb value = rgb_scale(rgb_mul(rgb_mul(p->throughput, p->point.reflectance), E), weight);
    if (!rgb_finite(value)) {
        ++stats->nonfinite_samples;
        return;
    }
    film->color[p->pixel] = rgb_add(film->color[p->pixel], value);
    film_add(film, aov, p->pixel % work->width, p->pixel / work->width, value);
}

// Numbers of sample j of each point, asked of `light`, or of one that is chosen. Without branches or calls: the
// compiler makes vector instructions of it.
static void light_numbers(size_t n, const uint32_t keys[], const uint32_t indices[], uint32_t j, uint32_t light,
                          LightNumbers out[])
{
    uint32_t salt = light == SHEEN_NONE ? 0 : hash_u32(light + 1);
    for (size_t i = 0; i < n; ++i) {
        SheenSampler sampler = sampler_make(keys[i] ^ salt, indices[i] + j);
        out[i].light = light;
        out[i].choice = hash_to_unit(keys[i] + sampler.index * 0x9e3779b9u); // steps of the golden ratio
        out[i].place = sampler_2d(&sampler);
    }
}

/** How the light samples of a shading point are shared out. */
typedef struct LightPlan {
    uint32_t each;    // lights that are asked one after another; 0: one is chosen for each sample
    uint32_t samples; // of each light, but 1 of those without size; or in all
} LightPlan;

// Few lights are all asked: a choice goes by what they would send if nothing was in the way, and is noise wherever the
// strongest is hidden. Two samples each cost less than the choice did and leave half its error.
static LightPlan plan_lights(const SheenWork *work)
{
    enum { FEW = 4 };
    uint32_t n = sheen_lights_count(work->lights), wanted = work->options.light_samples, deltas = 0;
    if (n > FEW || (wanted > 0 && wanted < n)) return (LightPlan){0, wanted ? wanted : FEW};
    if (wanted == 0) return (LightPlan){n, n > 1 ? 2 : 1};
    for (uint32_t i = 0; i < n; ++i) deltas += sheen_light_is_delta(work->lights, i);
    return (LightPlan){n, deltas < n ? (wanted - deltas) / (n - deltas) : 1};
}

static void ask(const SheenWork *work, size_t n, uint32_t light, uint32_t samples, Shader *s)
{
    for (uint32_t j = 0; j < samples; ++j) {
        light_numbers(n, s->keys, s->indices, j, light, s->numbers);
        s->stats.rays_shadow +=
            sheen_direct_add(work, n, s->points, s->numbers, 1.0f / (float)samples, &s->direct, s->irradiance);
    }
}

static bool direct_light(const SheenWork *work, Shader *s, SheenFilm *film)
{
    size_t n = s->visibility.n_points;
    const ShadingPoint *points = s->visibility.points;
    if (n == 0 || sheen_lights_count(work->lights) == 0) return true;
    if (!reserve(s, n)) return false;
    LightPlan plan = plan_lights(work);
    for (size_t i = 0; i < n; ++i) {
        uint32_t x = points[i].pixel % work->width, y = points[i].pixel / work->width;
        s->points[i] = points[i].point;
        s->irradiance[i] = rgb_gray(0.0f);
        s->keys[i] = hash_combine(work->options.seed ^ KEY_LIGHT, points[i].branch);
        s->indices[i] = sheen_sample_index(x, y, work->options.spp * plan.samples, points[i].sample * plan.samples);
    }
    if (plan.each == 0) ask(work, n, SHEEN_NONE, plan.samples, s);
    for (uint32_t light = 0; light < plan.each; ++light)
        ask(work, n, light, sheen_light_is_delta(work->lights, light) ? 1 : plan.samples, s);
    for (size_t i = 0; i < n; ++i) add_reflected(work, &points[i], s->irradiance[i], SHEEN_AOV_DIRECT, film, &s->stats);
    return true;
}

// The layers that show the cache at work. The estimate of the relative error is the contributors' 1/w, the split-sphere
// bound, in the mean of the interpolation.
static void add_cache_layers(const SheenWork *work, const SheenIrradianceCache *cache, const ShadingPoint *p,
                             const Contributors *c, SheenFilm *film)
{
    uint32_t x = p->pixel % work->width, y = p->pixel / work->width;
    float weight = 1.0f / (float)work->options.spp, error = 0.0f;
    bool dot = false;
    for (unsigned i = 0; i < c->n; ++i) {
        error += c->weight[i] / (c->weight[i] + 1.0f / cache->accuracy);
        Vec3 d = v3_sub(p->point.p, cache->records[c->record[i]].p);
        dot = dot || v3_length2(d) < sqrf(1.5f * p->footprint);
    }
    film_add(film, SHEEN_AOV_COVERAGE, x, y, rgb_gray(weight * (float)c->n));
    film_add(film, SHEEN_AOV_ACCURACY, x, y, rgb_gray(weight * cache->accuracy));
    film_add(film, SHEEN_AOV_ERROR, x, y, rgb_gray(weight * error / c->weight_sum));
    if (dot) film_add(film, SHEEN_AOV_RECORDS, x, y, rgb_gray(weight));
}

static bool indirect_light(const SheenWork *work, const SheenIrradianceCache *cache, const ShadingPoint *p,
                           SheenFilm *film, SheenStats *stats)
{
    Contributors c;
    sheen_irradiance_cache_find(cache, p->point.p, p->point.n, 0.0f, &c);
    if (c.n == 0) return false;
    Rgb E = sheen_irradiance_cache_interpolate(cache, &c, p->point.p, p->point.n);
    add_reflected(work, p, E, SHEEN_AOV_INDIRECT, film, stats);
    add_cache_layers(work, cache, p, &c, film);
    return true;
}

static void shade_task(void *user, size_t item, unsigned worker)
{
    ShadeTask *t = user;
    const SheenWork *work = t->work;
    Shader *s = &t->shaders[worker];
    Tile tile = sheen_tile(work, (uint32_t)item);
    double t0 = sheen_clock_seconds();
    if (!sheen_visibility_trace(work, &tile, 0, work->options.spp, t->film, &s->visibility, &s->stats))
        s->failed = true;
    double t1 = sheen_clock_seconds();
    if (!s->failed && !direct_light(work, s, t->film)) s->failed = true;
    double t2 = sheen_clock_seconds();
    for (size_t i = 0; t->cache && i < s->visibility.n_points && !s->failed; ++i) {
        const ShadingPoint *p = &s->visibility.points[i];
        if (!indirect_light(work, t->cache, p, t->film, &s->stats) && !uncovered_push(&t->uncovered[item], p, 1))
            s->failed = true;
    }
    double t3 = sheen_clock_seconds();
    s->visibility_seconds += t1 - t0;
    s->direct_seconds += t2 - t1;
    s->interpolate_seconds += t3 - t2;
    if (worker == 0) progress_report(work->progress, "shade", (double)item / sheen_tile_count(work), 0);
}

SheenStatus sheen_shade(const SheenWork *work, const SheenIrradianceCache *cache, SheenFilm *film, Uncovered *uncovered,
                        SheenStats *stats)
{
    unsigned workers = sheen_pool_size(work->pool);
    uint32_t tiles = sheen_tile_count(work);
    ShadeTask task = {work, cache, film, calloc(workers, sizeof(Shader)), calloc(tiles, sizeof(Uncovered))};
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
        if (status == SHEEN_OK && !uncovered_push(uncovered, task.uncovered[i].points, task.uncovered[i].n))
            status = SHEEN_ERR_NOMEM;
        sheen_uncovered_free(&task.uncovered[i]);
    }
    free(task.shaders);
    free(task.uncovered);
    return status;
}

void sheen_shade_uncovered(const SheenWork *work, const SheenIrradianceCache *cache, const Uncovered *uncovered,
                           SheenFilm *film, SheenStats *stats)
{
    for (size_t i = 0; i < uncovered->n; ++i) indirect_light(work, cache, &uncovered->points[i], film, stats);
}
