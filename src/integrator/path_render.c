// SPDX-License-Identifier: Apache-2.0
// The reference picture: passes of samples over tiles, until there are enough or the time is up.
#include "base/clock.h"
#include "integrator/path.h"
#include "material/bsdf.h"

#include <stdlib.h>

enum { TILE = 16, MAX_PASS = 16 };

// Progress is reported at most this often, seconds.
static const double REPORT_INTERVAL = 0.02;

// Sums of all samples, in double, so that neither the number of samples nor how they are cut into passes shows. Those
// that count negatively are kept apart: what they weigh is known when all are counted.
typedef struct Sums {
    double *data; // [height][width][stride]: colour, then each layer wanted; the same of negative samples
                  // and their number where the filter has any
    int offset[SHEEN_AOV_COUNT]; // first channel of a layer, 0 when nobody asked for it
    size_t part, stride;         // channels of colour and layers, and of a pixel
    bool has_signs;              // some samples count negatively
    bool first_hit;              // some layer shows the first hit
} Sums;

// What one thread needs: counters, and one sample of each pixel of a tile.
typedef struct Worker {
    SheenStats stats;
    SheenSampler samplers[TILE * TILE];
    Ray rays[TILE * TILE];
    Hit hits[TILE * TILE];
    bool negative[TILE * TILE]; // samples that count negatively
} Worker;

typedef struct Passes {
    const SheenWork *work;
    SheenEye eye;
    SheenFilm *film;
    Sums sums;
    Worker *workers; // [pool size]
    size_t tiles_x, tiles_y;
    uint32_t spp;         // to be done, when the time is not limited
    uint32_t first, size; // samples done before this pass, and in it
    atomic_size_t tiles_done;
    double start, last_report; // the latter is used by the calling thread alone
} Passes;

static SheenStatus sums_create(const SheenFilm *film, const SheenPixelFilter *filter, Sums *sums)
{
    static const SheenAov of_first_hit[] = {SHEEN_AOV_DEPTH, SHEEN_AOV_POSITION, SHEEN_AOV_NORMAL,  SHEEN_AOV_ALBEDO,
                                            SHEEN_AOV_UV,    SHEEN_AOV_DIRECT,   SHEEN_AOV_INDIRECT};
    *sums = (Sums){.part = 3, .has_signs = filter && filter->has_signs};
    for (size_t i = 0; i < sizeof of_first_hit / sizeof of_first_hit[0]; ++i) {
        SheenAov aov = of_first_hit[i];
        if (!film->aov[aov]) continue;
        sums->offset[aov] = (int)sums->part;
        sums->part += sheen_aov_info[aov].n_channels;
        sums->first_hit = sums->first_hit || (aov != SHEEN_AOV_DIRECT && aov != SHEEN_AOV_INDIRECT);
    }
    sums->stride = sums->has_signs ? 2 * sums->part + 1 : sums->part;
    sums->data = calloc((size_t)film->width * film->height, sums->stride * sizeof *sums->data);
    return sums->data ? SHEEN_OK : SHEEN_ERR_NOMEM;
}

static void add_rgb(double *sum, Rgb value)
{
    sum[0] += (double)value.r;
    sum[1] += (double)value.g;
    sum[2] += (double)value.b;
}

static void add_vec3(double *sum, Vec3 value)
{
    add_rgb(sum, rgb(value.x, value.y, value.z));
}

// Adds what the camera ray sees first to the layers that show it.
static void add_first_hit(const Passes *p, double *px, const Ray *ray, const Hit *hit)
{
    const Sums *sums = &p->sums;
    if (hit->shape == SHEEN_NONE) return;
    SurfacePoint s;
    sheen_surface_from_hit(p->work->scene, ray, hit, &s);
    if (sums->offset[SHEEN_AOV_DEPTH]) px[sums->offset[SHEEN_AOV_DEPTH]] += (double)hit->t;
    if (sums->offset[SHEEN_AOV_POSITION]) add_vec3(px + sums->offset[SHEEN_AOV_POSITION], s.p);
    if (sums->offset[SHEEN_AOV_NORMAL]) add_vec3(px + sums->offset[SHEEN_AOV_NORMAL], s.ns);
    if (sums->offset[SHEEN_AOV_UV]) add_vec3(px + sums->offset[SHEEN_AOV_UV], v3(s.uv.x, s.uv.y, 0.0f));
    if (sums->offset[SHEEN_AOV_ALBEDO]) {
        Bsdf bsdf;
        sheen_bsdf_look_up(p->work->scene, &s, &bsdf);
        Frame frame = frame_from_normal(s.ns);
        add_rgb(px + sums->offset[SHEEN_AOV_ALBEDO], sheen_bsdf_albedo(&bsdf, frame_to_local(&frame, v3_neg(ray->d))));
    }
}

static float index_or_minus_one(uint32_t index)
{
    return index == SHEEN_NONE ? -1.0f : (float)index;
}

static void set_primitive(SheenFilm *film, size_t pixel, const Hit *hit)
{
    float *px = film->aov[SHEEN_AOV_PRIMITIVE];
    if (!px) return;
    bool miss = hit->shape == SHEEN_NONE;
    px[3 * pixel] = index_or_minus_one(hit->shape);
    px[3 * pixel + 1] = miss ? -1.0f : (float)hit->triangle;
    px[3 * pixel + 2] = miss ? -1.0f : index_or_minus_one(hit->instance);
}

static void add_sample(Passes *p, size_t pixel, uint32_t i, Worker *w)
{
    const Sums *sums = &p->sums;
    SheenSampler sampler = w->samplers[i];
    const Ray *ray = &w->rays[i];
    const Hit *hit = &w->hits[i];
    double *px = sums->data + pixel * sums->stride;
    if (w->negative[i]) {
        px[sums->stride - 1] += 1.0;
        px += sums->part;
    }
    if (sampler.index == 0) set_primitive(p->film, pixel, hit);
    if (sums->first_hit) add_first_hit(p, px, ray, hit);
    PathRadiance L = sheen_path_trace(p->work, ray, hit, sampler, &w->stats);
    Rgb color = rgb_add(L.direct, L.indirect);
    if (!rgb_finite(color)) {
        ++w->stats.nonfinite_samples;
        return;
    }
    add_rgb(px, color);
    if (sums->offset[SHEEN_AOV_DIRECT]) add_rgb(px + sums->offset[SHEEN_AOV_DIRECT], L.direct);
    if (sums->offset[SHEEN_AOV_INDIRECT]) add_rgb(px + sums->offset[SHEEN_AOV_INDIRECT], L.indirect);
}

static bool cancelled(const SheenWork *work)
{
    return work->cancel && atomic_load_explicit(work->cancel, memory_order_relaxed);
}

// Traces one sample of each pixel of a tile: the camera rays as one coherent batch, then path by path.
static void render_tile_sample(Passes *p, uint32_t x0, uint32_t y0, uint32_t index, Worker *w)
{
    const SheenWork *work = p->work;
    uint32_t x1 = x0 + TILE < work->width ? x0 + TILE : work->width;
    uint32_t y1 = y0 + TILE < work->height ? y0 + TILE : work->height;
    uint32_t width = x1 - x0, n = width * (y1 - y0);
    for (uint32_t i = 0; i < n; ++i) {
        uint32_t x = x0 + i % width, y = y0 + i / width;
        w->samplers[i] = sampler_make(hash_combine(hash_combine(hash_u32(work->options.seed), x), y), index);
        w->rays[i] = sheen_camera_ray(work, &p->eye, x, y, &w->samplers[i], &w->negative[i]);
    }
    sheen_accel_intersect_many(work->accel, SHEEN_COHERENT, n, w->rays, w->hits);
    w->stats.rays_camera += n;
    for (uint32_t i = 0; i < n && !cancelled(work); ++i) {
        size_t pixel = (size_t)(y0 + i / width) * work->width + x0 + i % width;
        add_sample(p, pixel, i, w);
    }
}

// Only the calling thread, worker 0, reports.
static void report(Passes *p)
{
    double now = sheen_clock_seconds(), limit = p->work->options.time_limit;
    if (now - p->last_report < REPORT_INTERVAL) return;
    p->last_report = now;
    double tiles = (double)p->tiles_x * (double)p->tiles_y;
    double samples = p->first + p->size * (double)atomic_load_explicit(&p->tiles_done, memory_order_relaxed) / tiles;
    double done = limit > 0.0 ? (now - p->start) / limit : samples / p->spp;
    progress_report(p->work->progress, "path", done < 1.0 ? done : 1.0, 0);
}

static void render_tile(void *user, size_t item, unsigned worker)
{
    Passes *p = user;
    uint32_t x0 = (uint32_t)(item % p->tiles_x) * TILE, y0 = (uint32_t)(item / p->tiles_x) * TILE;
    for (uint32_t i = 0; i < p->size && !cancelled(p->work); ++i)
        render_tile_sample(p, x0, y0, p->first + i, &p->workers[worker]);
    atomic_fetch_add_explicit(&p->tiles_done, 1, memory_order_relaxed);
    if (worker == 0) report(p);
}

// Samples of the next pass: 1, 1, 2, 4, 8, 16, 16, ..., and no more than are asked for or are likely to end in time.
static uint32_t next_pass(const Passes *p)
{
    uint32_t done = p->first, size = done == 0 ? 1 : done < MAX_PASS ? done : MAX_PASS;
    double limit = p->work->options.time_limit;
    if (!(limit > 0.0)) return size < p->spp - done ? size : p->spp - done;
    if (done == 0) return 1;
    double elapsed = sheen_clock_seconds() - p->start, fit = (limit - elapsed) / (elapsed / done);
    if (!(fit >= 1.0) || done > UINT32_MAX - MAX_PASS) return 0;
    return size < fit ? size : (uint32_t)fit;
}

// Means of a pixel's sums: `out` may be the sums themselves.
static void pixel_means(const Passes *p, const double *px, double *out)
{
    const Sums *sums = &p->sums;
    double weight[2];
    uint32_t n_negative = sums->has_signs ? (uint32_t)px[sums->stride - 1] : 0;
    sheen_pixel_filter_weights(p->work->filter, p->first, n_negative, weight);
    for (size_t c = 0; c < sums->part; ++c) {
        double sum = weight[0] * px[c];
        if (sums->has_signs) sum += weight[1] * px[sums->part + c];
        out[c] = sum / p->first;
    }
}

static void write_film(const Passes *p)
{
    const Sums *sums = &p->sums;
    SheenFilm *film = p->film;
    size_t n = (size_t)film->width * film->height;
    for (size_t i = 0; i < n; ++i) {
        double *px = sums->data + i * sums->stride;
        pixel_means(p, px, px);
        film->color[i] = rgb((float)px[0], (float)px[1], (float)px[2]);
    }
    for (int a = 0; a < SHEEN_AOV_COUNT; ++a) {
        if (!sums->offset[a]) continue;
        unsigned n_channels = sheen_aov_info[a].n_channels;
        for (size_t i = 0; i < n; ++i) {
            const double *px = sums->data + i * sums->stride + sums->offset[a];
            for (unsigned c = 0; c < n_channels; ++c) film->aov[a][i * n_channels + c] = (float)px[c];
        }
    }
}

static SheenStatus run_passes(Passes *p, SheenStats *stats)
{
    const SheenWork *work = p->work;
    while ((p->size = next_pass(p)) > 0) {
        atomic_store(&p->tiles_done, 0);
        if (!sheen_pool_run(work->pool, p->tiles_x * p->tiles_y, render_tile, p, work->cancel) || cancelled(work))
            return SHEEN_ERR_CANCELLED;
        p->first += p->size;
        ++stats->passes;
        stats->spp_done = p->first;
        stats->spp_mean = p->first;
    }
    return SHEEN_OK;
}

SheenStatus sheen_path_render(const SheenWork *work, SheenFilm *film, SheenStats *stats)
{
    Passes p = {.work = work,
                .eye = sheen_eye(work->camera, work->width, work->height),
                .film = film,
                .tiles_x = (work->width + (size_t)TILE - 1) / TILE,
                .tiles_y = (work->height + (size_t)TILE - 1) / TILE,
                .spp = work->options.spp ? work->options.spp : 1,
                .start = sheen_clock_seconds()};
    unsigned n_workers = sheen_pool_size(work->pool);
    p.workers = calloc(n_workers, sizeof *p.workers);
    SheenStatus status = sums_create(film, work->filter, &p.sums);
    if (!p.workers) status = SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK) {
        progress_report(work->progress, "path", 0.0, 0);
        status = run_passes(&p, stats);
        for (unsigned i = 0; i < n_workers; ++i) sheen_stats_add(stats, &p.workers[i].stats);
    }
    if (status == SHEEN_OK) {
        write_film(&p);
        progress_report(work->progress, "path", 1.0, 0);
    }
    free(p.sums.data);
    free(p.workers);
    return status;
}
