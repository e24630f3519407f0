// SPDX-License-Identifier: Apache-2.0
// Rays per second of a gather, on one thread, beside the bare ray queries of the very same rays.
//
//     bench_gather [SCENE]        (scenes/cornell-box.xml of the working directory when none is given)
//
// Camera rays of the scene's first camera find 500 points, spread over the picture. A gather of 1,024 rays at each of
// them is timed as the fill of the cache makes it, in three steps: sheen_hemisphere_trace, sheen_hemisphere_direct
// with one light sample a vertex, sheen_estimate_irradiance. (Deep records and extensions are left out: they belong to
// the whole fill.) The first table has the rays per second up to the end of each step:
//
//     gather rays   sheen_accel_intersect_many on the recorded rays of the gathers, nothing else
//     shadow rays   sheen_accel_transmittance_many on their recorded shadow rays, nothing else
//     trace         + directions, surfaces, BSDFs
//     + direct      + choice of lights, light samples, shadow rays
//     + estimate    + irradiance and gradients
//
// "of bare" is the time of the bare queries over the time of the step: on the gather rays alone for `trace`, on gather
// and shadow rays for the others. 1 would be a renderer that does nothing but trace rays. The bare queries contain the
// packing of rays into Embree's packets and of hits out of them. Rays through mirrors and glass are not counted as
// rays; their time is part of the surfaces.
//
// The second table says where the time of the whole gather goes. Its parts are the calls that a gather makes, timed on
// their own with the gather's own inputs; "other" is what they leave of a step: making rays, emission, weights, copies.
//
// Each number is the median of 5 runs, in CPU time of this process, so that other programs count only by the caches and
// the clock frequency that they take away. An interval of the clock that holds nothing is taken off each interval.
#include "integrator/hemisphere.h"
#include "integrator/visibility.h"
#include "io/load.h"
#include "timing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { N_POINTS = 500, GATHER_RAYS = 1024, N_RUNS = 5, PICTURE_WIDTH = 256 };

// ---- time -------------------------------------------------------------------------------------------------------

// What is timed: the bare queries, the steps of a gather, the parts of its steps.
typedef enum Section {
    BARE_GATHER,
    BARE_SHADOW,
    TRACE,
    DIRECT,
    ESTIMATE,
    DIRECTIONS,
    SURFACES,
    CHOOSE,
    SAMPLE,
    N_SECTIONS
} Section;

// A system call, about a microsecond: some per cent of the shortest section.
static double empty_interval(void)
{
    enum { N = 20000 };
    double sum = 0.0;
    for (int i = 0; i < N; ++i) {
        double start = processor_seconds();
        sum += processor_seconds() - start;
    }
    return sum / N;
}

// A result that is read cannot be left out by the compiler.
static void keep(double *sum, double result)
{
    if (isfinite(result)) *sum += result;
}

// ---- scene and points -------------------------------------------------------------------------------------------

/** A gather's rays, recorded. */
typedef struct Recorded {
    Ray *rays;   // [cells]
    Ray *shadow; // [n_vertices], some skipped
    size_t n_vertices;
} Recorded;

typedef struct Bench {
    SheenPool *pool;
    SheenScene *scene;
    SheenLights *lights;
    SheenAccel *accel;
    SheenWork work;
    ShadingPoint points[N_POINTS];
    Recorded recorded[N_POINTS];
    size_t n_points;
    Hemisphere h;
    uint32_t light[GATHER_RAYS * 2]; // chosen at each vertex; strata round the number of rays up or down
    float probability[GATHER_RAYS * 2];
    SheenStats stats; // of one run over all points
    double empty;
    double time[N_SECTIONS][N_RUNS];
    double sum; // of results
} Bench;

static void fail(const char *what)
{
    fprintf(stderr, "bench_gather: %s\n", what);
    exit(1);
}

static void print_line(void *user, SheenLogLevel level, const char *text)
{
    (void)user;
    if (level != SHEEN_LOG_INFO) fprintf(stderr, "%s\n", text);
}

// One sample a pixel of a small picture; every so manieth point is kept.
static void find_points(Bench *b)
{
    Visibility v = {0};
    ShadingPoint *all = NULL;
    size_t n = 0;
    SheenStats stats = {0};
    for (uint32_t i = 0; i < sheen_tile_count(&b->work); ++i) {
        Tile tile = sheen_tile(&b->work, i);
        if (!sheen_visibility_trace(&b->work, &tile, (SampleRange){0, 1, NULL}, NULL, &v, &stats))
            fail("out of memory");
        if (v.seen.n_points == 0) continue;
        ShadingPoint *more = realloc(all, (n + v.seen.n_points) * sizeof *all);
        if (!more) fail("out of memory");
        all = more;
        memcpy(all + n, v.seen.points, v.seen.n_points * sizeof *all);
        n += v.seen.n_points;
    }
    b->n_points = n < N_POINTS ? n : N_POINTS;
    for (size_t i = 0; i < b->n_points; ++i) b->points[i] = all[i * n / b->n_points];
    free(all);
    sheen_visibility_free(&v);
    if (n == 0) fail("the camera sees no surface that scatters");
}

static void set_up(Bench *b, const char *path)
{
    static const SheenLog log = {print_line, NULL};
    if (sheen_pool_create(1, &b->pool) != SHEEN_OK) fail("no thread");
    if (sheen_scene_load(path, &log, &b->scene) != SHEEN_OK) exit(1);
    if (b->scene->n_cameras == 0) fail("the scene has no camera");
    if (sheen_lights_create(b->scene, SHEEN_ENVIRONMENT_HARD, &log, &b->lights) != SHEEN_OK) exit(1);
    if (sheen_accel_create(b->scene, b->pool, &log, &b->accel) != SHEEN_OK) exit(1);
    const SheenCamera *camera = &b->scene->cameras[0];
    uint64_t height = camera->width > 0 ? (uint64_t)PICTURE_WIDTH * camera->height / camera->width : PICTURE_WIDTH;
    b->work = (SheenWork){.scene = b->scene,
                          .accel = b->accel,
                          .lights = b->lights,
                          .camera = camera,
                          .width = PICTURE_WIDTH,
                          .height = height < 1                   ? 1
                                    : height > 4 * PICTURE_WIDTH ? 4 * PICTURE_WIDTH
                                                                 : (uint32_t)height,
                          .options = sheen_options_default(),
                          .pool = b->pool,
                          .log = &log};
    if (!sheen_hemisphere_reserve(&b->h, sheen_strata_cosine(GATHER_RAYS))) fail("out of memory");
    if (b->h.cells > sizeof b->light / sizeof *b->light) fail("too many strata");
    find_points(b);
    b->empty = empty_interval();
}

static void tear_down(Bench *b)
{
    for (size_t i = 0; i < b->n_points; ++i) {
        free(b->recorded[i].rays);
        free(b->recorded[i].shadow);
    }
    sheen_hemisphere_free(&b->h);
    sheen_accel_destroy(&b->accel);
    sheen_lights_destroy(&b->lights);
    sheen_scene_destroy(&b->scene);
    sheen_pool_destroy(&b->pool);
}

// ---- one gather -------------------------------------------------------------------------------------------------

static uint32_t key_of(size_t point)
{
    return hash_combine(1, (uint32_t)point);
}

static void trace(Bench *b, size_t i)
{
    sheen_hemisphere_begin(&b->points[i].point, key_of(i), &b->h);
    sheen_hemisphere_trace(&b->work, &b->points[i].point, b->work.options.bounces, &b->h, &b->stats);
}

static void direct(Bench *b)
{
    sheen_hemisphere_direct(&b->work, 0, 1, &b->h, &b->stats);
}

static void record(Bench *b, size_t i)
{
    trace(b, i);
    Recorded *r = &b->recorded[i];
    r->n_vertices = b->h.n_vertices;
    r->rays = malloc(b->h.cells * sizeof *r->rays);
    r->shadow = malloc((r->n_vertices + 1) * sizeof *r->shadow);
    if (!r->rays || !r->shadow) fail("out of memory");
    memcpy(r->rays, b->h.rays, b->h.cells * sizeof *r->rays);
    direct(b);
    memcpy(r->shadow, b->h.direct.rays, r->n_vertices * sizeof *r->shadow);
}

// The recorded rays are copied to where a gather has them, so that a section does not begin by waiting for memory.
static double bare_gather(Bench *b, size_t i)
{
    memcpy(b->h.rays, b->recorded[i].rays, b->h.cells * sizeof *b->h.rays);
    double start = processor_seconds();
    sheen_accel_intersect_many(b->accel, SHEEN_COHERENT, b->h.cells, b->h.rays, b->h.hits);
    double end = processor_seconds();
    keep(&b->sum, (double)b->h.hits[0].t);
    return end - start;
}

static double bare_shadow(Bench *b, size_t i)
{
    size_t n = b->recorded[i].n_vertices;
    DirectScratch *d = &b->h.direct;
    memcpy(d->rays, b->recorded[i].shadow, n * sizeof *d->rays);
    double start = processor_seconds();
    sheen_accel_transmittance_many(b->accel, n, d->rays, d->transmittance);
    double end = processor_seconds();
    if (n > 0) keep(&b->sum, (double)d->transmittance[0]);
    return end - start;
}

static void whole_gather(Bench *b, size_t i, double t[N_SECTIONS])
{
    const Hemisphere *h = &b->h;
    IrradianceEstimate e;
    double t0 = processor_seconds();
    trace(b, i);
    double t1 = processor_seconds();
    direct(b);
    double t2 = processor_seconds();
    sheen_estimate_irradiance(h->strata, h->L, h->distance, &e);
    double t3 = processor_seconds();
    t[TRACE] += t1 - t0;
    t[DIRECT] += t2 - t1;
    t[ESTIMATE] += t3 - t2;
    keep(&b->sum, (double)(e.E.g + e.translation[0].g + e.translation[1].g + e.rotation[0].g + e.rotation[1].g));
    keep(&b->sum, (double)e.R);
}

static void trace_parts(Bench *b, size_t i, double t[N_SECTIONS])
{
    Hemisphere *h = &b->h;
    double t0 = processor_seconds();
    sheen_strata_directions(h->strata, key_of(i), h->directions);
    double t1 = processor_seconds();
    t[DIRECTIONS] += t1 - t0;
    bare_gather(b, i); // the hits
    uint64_t specular = 0;
    float sum = 0.0f;
    double t2 = processor_seconds();
    for (uint32_t k = 0; k < h->cells; ++k) {
        SheenSampler sampler = sampler_make(key_of(i), k);
        Followed f;
        sheen_follow(&b->work, &h->rays[k], &h->hits[k], &sampler, &specular, &f);
        sum += f.emitted.g + f.throughput.g + f.direction.x + f.point.n.x + f.point.origin.x + f.point.reflectance.g;
    }
    double t3 = processor_seconds();
    t[SURFACES] += t3 - t2;
    keep(&b->sum, (double)(h->directions[0].x + sum));
}

// Points and numbers are those that the direct light of the gather left behind.
static void direct_parts(Bench *b, size_t i, double t[N_SECTIONS])
{
    Hemisphere *h = &b->h;
    trace(b, i);
    direct(b);
    float sum = 0.0f;
    double t0 = processor_seconds();
    for (size_t k = 0; k < h->n_vertices; ++k) {
        float u = h->numbers[k].choice;
        b->probability[k] = sheen_lights_choose(b->lights, h->points[k].p, h->points[k].n, &u, &b->light[k]);
    }
    double t1 = processor_seconds();
    for (size_t k = 0; k < h->n_vertices; ++k) {
        LightSample s;
        if (b->probability[k] > 0.0f &&
            sheen_light_sample(b->lights, b->light[k], h->points[k].p, h->numbers[k].place, &s))
            sum += s.pdf + s.radiance.g + s.wi.x + s.target.x;
    }
    double t2 = processor_seconds();
    keep(&b->sum, (double)sum);
    t[CHOOSE] += t1 - t0;
    t[SAMPLE] += t2 - t1;
}

// ---- runs and tables --------------------------------------------------------------------------------------------

// Each section has a round over all points of its own: none finds the scene in the cache because the same rays have
// just been there.
static void run(Bench *b, int index)
{
    double t[N_SECTIONS] = {0};
    for (size_t i = 0; i < b->n_points; ++i) t[BARE_GATHER] += bare_gather(b, i);
    for (size_t i = 0; i < b->n_points; ++i) t[BARE_SHADOW] += bare_shadow(b, i);
    b->stats = (SheenStats){0};
    for (size_t i = 0; i < b->n_points; ++i) whole_gather(b, i, t);
    SheenStats counted = b->stats;
    for (size_t i = 0; i < b->n_points; ++i) trace_parts(b, i, t);
    for (size_t i = 0; i < b->n_points; ++i) direct_parts(b, i, t);
    b->stats = counted;
    for (int s = 0; s < N_SECTIONS; ++s) b->time[s][index] = t[s] - b->empty * (double)b->n_points;
}

static double median(Bench *b, Section s)
{
    qsort(b->time[s], N_RUNS, sizeof b->time[s][0], by_value);
    return b->time[s][N_RUNS / 2];
}

static void rate_line(const char *name, uint64_t rays, double time, double bare)
{
    printf("%-12s %10.3f %10.1f %9.2f %8.2f\n", name, 1e-6 * (double)rays, 1e3 * time, 1e-6 * (double)rays / time,
           bare / time);
}

static void part_line(const char *name, double time, double whole, uint64_t rays)
{
    printf("%-36s %10.1f %7.1f %%\n", name, 1e9 * time / (double)rays, 100.0 * time / whole);
}

static void print_tables(Bench *b, const char *path)
{
    double t[N_SECTIONS];
    for (int s = 0; s < N_SECTIONS; ++s) t[s] = median(b, (Section)s);
    uint64_t rays = b->stats.rays_gather, shadow = b->stats.rays_shadow;
    double bare = t[BARE_GATHER], both = bare + t[BARE_SHADOW], traced = t[TRACE], lit = traced + t[DIRECT];
    double whole = lit + t[ESTIMATE];
    printf("%s: %zu gathers of %zu rays, lights: %u, %.3f rays through mirrors and glass per gather ray\n\n", path,
           b->n_points, b->h.cells, sheen_lights_count(b->lights), (double)b->stats.rays_specular / (double)rays);
    printf("%-12s %10s %10s %9s %8s\n", "", "rays, M", "ms", "Mray/s", "of bare");
    rate_line("gather rays", rays, bare, bare);
    rate_line("shadow rays", shadow, t[BARE_SHADOW], t[BARE_SHADOW]);
    rate_line("both", rays + shadow, both, both);
    rate_line("trace", rays, traced, bare);
    rate_line("+ direct", rays + shadow, lit, both);
    rate_line("+ estimate", rays + shadow, whole, both);
    printf("\n%-36s %10s %9s\n", "part", "ns/ray", "share");
    part_line("trace: directions and jitter", t[DIRECTIONS], whole, rays);
    part_line("trace: bare rays", bare, whole, rays);
    part_line("trace: surfaces, BSDFs, mirrors", t[SURFACES], whole, rays);
    part_line("trace: other", traced - t[DIRECTIONS] - bare - t[SURFACES], whole, rays);
    part_line("direct: choice of a light", t[CHOOSE], whole, rays);
    part_line("direct: sample of the light", t[SAMPLE], whole, rays);
    part_line("direct: bare shadow rays", t[BARE_SHADOW], whole, rays);
    part_line("direct: other", t[DIRECT] - t[CHOOSE] - t[SAMPLE] - t[BARE_SHADOW], whole, rays);
    part_line("estimate", t[ESTIMATE], whole, rays);
    part_line("whole gather, per gather ray", whole, whole, rays);
    printf("\n(%g)\n", b->sum);
}

int main(int argc, char **argv)
{
    if (argc > 2) {
        fprintf(stderr, "usage: bench_gather [SCENE]\n");
        return 1;
    }
    const char *path = argc > 1 ? argv[1] : "scenes/cornell-box.xml";
    static Bench b; // too large for the stack of some systems
    set_up(&b, path);
    for (size_t i = 0; i < b.n_points; ++i) record(&b, i); // warms up, too
    for (int i = 0; i < N_RUNS; ++i) run(&b, i);
    print_tables(&b, path);
    tear_down(&b);
    return 0;
}
