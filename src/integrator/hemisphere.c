// SPDX-License-Identifier: Apache-2.0
#include "integrator/hemisphere.h"

#include "math/warp.h"

#include <stdlib.h>
#include <string.h>

// Keys of the random numbers of a gather, so that no two uses share one.
enum { KEY_STRATA = 1, KEY_LIGHT = 2, KEY_EXTEND = 3, KEY_SPECULAR = 4 };

void sheen_hemisphere_free(Hemisphere *h)
{
    free(h->directions);
    free(h->L);
    free(h->caustic);
    free(h->specular);
    free(h->mirrored);
    free(h->sorted);
    free(h->distance);
    free(h->vertices);
    free(h->moved);
    free(h->rays);
    free(h->hits);
    free(h->points);
    free(h->numbers);
    free(h->irradiance);
    sheen_direct_free(&h->direct);
    *h = (Hemisphere){0};
}

bool sheen_hemisphere_reserve(Hemisphere *h, SheenStrata strata)
{
    size_t n = strata_count(strata);
    if (n > h->capacity) {
        sheen_hemisphere_free(h);
        h->directions = malloc(n * sizeof *h->directions);
        h->L = malloc(n * sizeof *h->L);
        h->caustic = malloc(n * sizeof *h->caustic);
        h->specular = malloc(n);
        h->mirrored = malloc(n * sizeof *h->mirrored);
        h->sorted = malloc(n * sizeof *h->sorted);
        h->distance = malloc(n * sizeof *h->distance);
        h->vertices = malloc(n * sizeof *h->vertices);
        h->moved = malloc(n * sizeof *h->moved);
        h->rays = malloc(n * sizeof *h->rays);
        h->hits = malloc(n * sizeof *h->hits);
        h->points = malloc(n * sizeof *h->points);
        h->numbers = malloc(n * sizeof *h->numbers);
        h->irradiance = malloc(n * sizeof *h->irradiance);
        if (!h->directions || !h->L || !h->caustic || !h->specular || !h->mirrored || !h->sorted || !h->distance ||
            !h->vertices || !h->moved || !h->rays || !h->hits || !h->points || !h->numbers || !h->irradiance ||
            !sheen_direct_reserve(&h->direct, n)) {
            sheen_hemisphere_free(h);
            return false;
        }
        h->capacity = n;
    }
    h->strata = strata;
    h->cells = n;
    return true;
}

static Ray leave(const DiffusePoint *p, Vec3 d)
{
    float below = v3_dot(d, p->ng);
    if (below < 0.0f) d = v3_mad(d, -2.0f * below, p->ng);
    return (Ray){p->origin, INFINITY, d};
}

// What one ray of the gather, or of an extension of one of its vertices, ended on.
// @param weight  radiance in the cell per radiance along the ray
static void receive(const SheenWork *work, const Followed *f, Rgb weight, uint32_t cell, unsigned bounces,
                    Hemisphere *h)
{
    Rgb through = rgb_mul(weight, f->throughput);
    if (f->escaped)
        h->L[cell] = rgb_add(h->L[cell], rgb_mul(through, sheen_environment_soft(work->lights, f->direction)));
    if (f->specular > 0) {
        if (f->scatters) h->specular[cell] = 1; // the soft sky behind a pane is as good as without it
        Rgb hard = f->emitted;
        if (f->escaped)
            hard = rgb_sub(sheen_environment(work->scene, f->direction),
                           sheen_environment_soft(work->lights, f->direction));
        h->caustic[cell] = rgb_add(h->caustic[cell], rgb_mul(through, hard));
    }
    if (!f->scatters || bounces == 0) return;
    h->vertices[h->n_vertices++] = (GatherVertex){
        f->point, rgb_scale(rgb_mul(through, f->point.reflectance), SHEEN_INV_PI), cell, f->distance, bounces};
}

void sheen_hemisphere_directions(uint32_t key, Hemisphere *h)
{
    uint32_t strata_key = hash_combine(key, KEY_STRATA);
    for (unsigned k = 0, i = 0; k < h->strata.sectors; ++k)
        for (unsigned j = 0; j < h->strata.rings; ++j, ++i) {
            uint32_t r = hash_combine(strata_key, i);
            Vec2 u = v2(hash_to_unit(r), hash_to_unit(hash_u32(r ^ 0x5bd1e995u)));
            h->directions[i] = sheen_strata_direction(h->strata, j, k, u);
        }
}

void sheen_hemisphere_trace(const SheenWork *work, const DiffusePoint *point, uint32_t key, unsigned bounces,
                            Hemisphere *h, SheenStats *stats)
{
    h->key = key;
    h->frame = frame_from_normal(point->n);
    h->n_vertices = 0;
    sheen_hemisphere_directions(key, h);
    uint32_t specular_key = hash_combine(key, KEY_SPECULAR);
    for (uint32_t i = 0; i < h->cells; ++i) h->rays[i] = leave(point, frame_to_world(&h->frame, h->directions[i]));
    sheen_accel_intersect_many(work->accel, SHEEN_COHERENT, h->cells, h->rays, h->hits);
    stats->rays_gather += h->cells;
    for (uint32_t i = 0; i < h->cells; ++i) {
        h->L[i] = h->caustic[i] = rgb_gray(0.0f);
        h->specular[i] = 0;
        SheenSampler sampler = sampler_make(specular_key, i);
        Followed f;
        sheen_follow(work, &h->rays[i], &h->hits[i], &sampler, &stats->rays_specular, &f);
        h->distance[i] = maxf(f.distance, 1e-20f);
        receive(work, &f, rgb_gray(1.0f), i, bounces, h);
    }
}

size_t sheen_hemisphere_extend(const SheenWork *work, float near, Hemisphere *h, SheenStats *stats)
{
    // Near vertices are taken out into rays; the rest closes up.
    size_t n_rays = 0, kept = 0;
    uint32_t key = hash_combine(h->key, KEY_EXTEND);
    GatherVertex *moved = h->moved;
    for (size_t i = 0; i < h->n_vertices; ++i) {
        GatherVertex v = h->vertices[i];
        if (!(v.distance < near)) {
            h->vertices[kept++] = v;
            continue;
        }
        SheenSampler sampler = sampler_make(hash_combine(key, v.bounces), v.cell);
        Frame frame = frame_from_normal(v.point.n);
        Vec3 d = frame_to_world(&frame, warp_cosine_hemisphere(sampler_2d(&sampler)));
        h->rays[n_rays] = leave(&v.point, d);
        moved[n_rays++] = v;
    }
    h->n_vertices = kept;
    sheen_accel_intersect_many(work->accel, SHEEN_INCOHERENT, n_rays, h->rays, h->hits);
    stats->rays_gather += n_rays;
    for (size_t i = 0; i < n_rays; ++i) {
        const GatherVertex *v = &moved[i];
        SheenSampler sampler = sampler_make(hash_combine(h->key, KEY_SPECULAR + v->bounces), v->cell);
        Followed f;
        sheen_follow(work, &h->rays[i], &h->hits[i], &sampler, &stats->rays_specular, &f);
        // One cosine-weighted ray estimates the irradiance at the vertex by pi L.
        receive(work, &f, rgb_scale(v->weight, SHEEN_PI), v->cell, v->bounces - 1, h);
    }
    return n_rays;
}

// A Kronecker sequence over the gather's light samples, in fixed point: neighboring strata ask distant parts of the
// lights. The steps are the powers of 1 / 1.2207..., the root of x^4 = x + 1. Source: roberts2018-quasirandom.
static LightNumbers light_numbers(uint32_t key, uint32_t use, uint32_t index)
{
    uint32_t shift = hash_combine(key, KEY_LIGHT + (use << 8)), x = shift, y = hash_u32(shift), z = hash_u32(y);
    return (LightNumbers){hash_to_unit(x + index * 0xd1b54a33u),
                          {hash_to_unit(y + index * 0xabc98388u), hash_to_unit(z + index * 0x8cb92ba7u)}};
}

void sheen_hemisphere_direct(const SheenWork *work, size_t first, uint32_t samples, Hemisphere *h, SheenStats *stats)
{
    size_t n = h->n_vertices - first;
    const GatherVertex *v = h->vertices + first;
    for (size_t i = 0; i < n; ++i) {
        h->points[i] = v[i].point;
        h->irradiance[i] = rgb_gray(0.0f);
    }
    for (uint32_t s = 0; s < samples; ++s) {
        for (size_t i = 0; i < n; ++i) h->numbers[i] = light_numbers(h->key, v[i].bounces, v[i].cell * samples + s);
        stats->rays_shadow +=
            sheen_direct_add(work, n, h->points, h->numbers, 1.0f / (float)samples, &h->direct, h->irradiance);
    }
    for (size_t i = 0; i < n; ++i) h->L[v[i].cell] = rgb_add(h->L[v[i].cell], rgb_mul(v[i].weight, h->irradiance[i]));
}

static int compare_descending(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x < y) - (x > y);
}

// The value of rank `rank` from the largest, rank 0.
static float ranked(Hemisphere *h, const Rgb values[], size_t rank)
{
    for (size_t i = 0; i < h->cells; ++i) h->sorted[i] = rgb_max(values[i]);
    qsort(h->sorted, h->cells, sizeof *h->sorted, compare_descending);
    return h->sorted[rank];
}

// Adds values to L, each cut to at most `share` of the whole; but never below what one cell in 64 sees, which is light
// and not noise: a room may have no other.
static void add_cut(Hemisphere *h, const Rgb values[], double share)
{
    double rest = 0.0, cut = 0.0;
    for (size_t i = 0; i < h->cells; ++i) {
        rest += (double)rgb_max(h->L[i]);
        cut = fmax(cut, (double)rgb_max(values[i]));
    }
    if (!(cut > 0.0)) return;
    // The cut c solves c = share (rest + sum min(value, c)); the iteration falls toward it from above.
    for (int step = 0; step < 16; ++step) {
        double sum = rest;
        for (size_t i = 0; i < h->cells; ++i) sum += fmin((double)rgb_max(values[i]), cut);
        cut = fmin(cut, share * sum);
    }
    float most = maxf((float)cut, ranked(h, values, h->cells / 64));
    for (size_t i = 0; i < h->cells; ++i) {
        float m = rgb_max(values[i]);
        if (m > 0.0f) h->L[i] = rgb_mad(h->L[i], m > most ? most / m : 1.0f, values[i]);
    }
}

void sheen_hemisphere_add_caustics(Hemisphere *h)
{
    const double mirrored_most = 8.0, caustic_most = 2.0; // times the mean
    for (size_t i = 0; i < h->cells; ++i) {
        h->mirrored[i] = h->specular[i] ? h->L[i] : rgb_gray(0.0f);
        if (h->specular[i]) h->L[i] = rgb_gray(0.0f);
    }
    add_cut(h, h->mirrored, mirrored_most / (double)h->cells);
    add_cut(h, h->caustic, caustic_most / (double)h->cells);
}
