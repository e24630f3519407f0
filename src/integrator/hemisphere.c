// SPDX-License-Identifier: Apache-2.0
#include "integrator/hemisphere.h"

#include "gather/allocate.h"
#include "integrator/glossy.h"
#include "math/warp.h"

#include <stdlib.h>
#include <string.h>

// Keys of the random numbers of a gather, so that no two uses share one.
enum { KEY_STRATA = 1, KEY_LIGHT = 2, KEY_EXTEND = 3, KEY_FURTHER = 4, KEY_OWN = 5, KEY_CAUSTIC = 6, KEY_SPECULAR = 7 };

// Rays of a stratum that find lamps through mirrors and glass; at most as many in all as there are strata.
enum { CAUSTIC_RAYS = 8 };

void sheen_hemisphere_free(Hemisphere *h)
{
    free(h->directions);
    free(h->L);
    free(h->caustic);
    free(h->specular);
    free(h->mirrored);
    free(h->apart);
    free(h->through);
    free(h->sorted);
    free(h->extra);
    free(h->further);
    free(h->value);
    free(h->deviation);
    free(h->distance);
    free(h->normals);
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
    size_t n = strata_count(strata), rays = SHEEN_FURTHER_MAX * n;
    if (n > h->capacity) {
        sheen_hemisphere_free(h);
        h->directions = malloc(n * sizeof *h->directions);
        h->L = malloc(n * sizeof *h->L);
        h->caustic = malloc(n * sizeof *h->caustic);
        h->specular = malloc(n);
        h->mirrored = malloc(n * sizeof *h->mirrored);
        h->apart = malloc(n * sizeof *h->apart);
        h->through = malloc(n * sizeof *h->through);
        h->sorted = malloc(n * sizeof *h->sorted);
        h->extra = malloc(n * sizeof *h->extra);
        h->further = malloc(rays * sizeof *h->further);
        h->value = malloc(n * sizeof *h->value);
        h->deviation = malloc(n * sizeof *h->deviation);
        h->distance = malloc(n * sizeof *h->distance);
        h->normals = malloc(n * sizeof *h->normals);
        h->vertices = malloc(rays * sizeof *h->vertices);
        h->moved = malloc(rays * sizeof *h->moved);
        h->rays = malloc(rays * sizeof *h->rays);
        h->hits = malloc(rays * sizeof *h->hits);
        h->points = malloc(rays * sizeof *h->points);
        h->numbers = malloc(rays * sizeof *h->numbers);
        h->irradiance = malloc(rays * sizeof *h->irradiance);
        if (!h->directions || !h->L || !h->caustic || !h->specular || !h->mirrored || !h->apart || !h->through ||
            !h->sorted || !h->extra || !h->further || !h->value || !h->deviation || !h->distance || !h->normals ||
            !h->vertices || !h->moved || !h->rays || !h->hits || !h->points || !h->numbers || !h->irradiance ||
            !sheen_direct_reserve(&h->direct, rays)) {
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

// The part of the light at the end of a way through mirrors or glass that no light sample and no soft sky stands for.
static Rgb caustic_of(const SheenWork *work, const Followed *f)
{
    if (f->specular == 0) return rgb_gray(0.0f);
    if (!f->escaped) return rgb_add(rgb_mul(f->throughput, f->emitted), f->passed);
    Rgb all = sheen_environment(work->scene, f->direction), soft = sheen_environment_soft(work->lights, f->direction);
    Rgb hard = rgb_add(rgb_sub(all, soft), sheen_suns(work->lights, f->direction));
    return rgb_add(rgb_mul(f->throughput, hard), f->passed);
}

// A Kronecker sequence over the gather's light samples, in fixed point: neighboring strata ask distant parts of the
// lights. The steps are the powers of 1 / 1.2207..., the root of x^4 = x + 1. Source: roberts2018-quasirandom.
// @param light  that is asked; SHEEN_NONE: one is chosen
static LightNumbers light_numbers(uint32_t key, uint32_t use, uint32_t index, uint32_t light)
{
    uint32_t shift = hash_combine(key, KEY_LIGHT + (use << 8)) ^ (light == SHEEN_NONE ? 0 : hash_u32(light + 1));
    uint32_t x = shift, y = hash_u32(shift), z = hash_u32(y);
    return (LightNumbers){light,
                          hash_to_unit(x + index * 0xd1b54a33u),
                          {hash_to_unit(y + index * 0xabc98388u), hash_to_unit(z + index * 0x8cb92ba7u)}};
}

// The lights that each hit asks one after another; 0: one is chosen. A choice goes by what lights would send if nothing
// was in the way: a strong one in the next room would be asked in place of the weak one in this.
static uint32_t lights_each(const SheenWork *work)
{
    uint32_t n = sheen_lights_count(work->lights);
    return n <= SHEEN_FEW_LIGHTS ? n : 0;
}

// What one ray of the gather, or of an extension of one of its vertices, ended on.
// @param weight  radiance in the cell per radiance along the ray
static void receive(const SheenWork *work, const Followed *f, Rgb weight, uint32_t cell, uint32_t ray, unsigned bounces,
                    Hemisphere *h, SheenStats *stats)
{
    Rgb through = rgb_mul(weight, f->throughput);
    if (f->escaped)
        h->L[cell] = rgb_add(h->L[cell], rgb_mul(through, sheen_environment_soft(work->lights, f->direction)));
    if (f->specular > 0 && f->scatters) h->specular[cell] = 1; // the soft sky behind a pane is as good as without it
    h->caustic[cell] = rgb_add(h->caustic[cell], rgb_mul(weight, caustic_of(work, f)));
    if (bounces == 0) return;
    bool lit = h->glossy && f->glossy && sheen_lights_count(work->lights) > 0;
    if (lit) {
        uint32_t each = lights_each(work);
        for (uint32_t turn = 0; turn < (each ? each : 1); ++turn) {
            LightNumbers numbers = light_numbers(h->key, bounces, ray, each ? turn : SHEEN_NONE);
            Rgb L = sheen_glossy_lit_once(work, &f->surface, v3_neg(f->direction), numbers, stats);
            if (rgb_finite(L)) h->glossy[cell] = rgb_add(h->glossy[cell], rgb_mul(through, L));
        }
    }
    if (!f->scatters) return;
    Rgb reflected = rgb_scale(rgb_mul(through, f->point.reflectance), SHEEN_INV_PI);
    // Behind a mirror or a pane one direction of a lobe would be noise that sheen_hemisphere_add_caustics cuts.
    bool turns = h->glossy && f->turns && f->specular == 0;
    h->vertices[h->n_vertices++] =
        (GatherVertex){f->point, reflected, cell, ray, f->distance, bounces, lit, turns, f->onward};
}

// Point e of a Kronecker sequence of its own for each key. Source: roberts2018-quasirandom.
static Vec2 kronecker(uint32_t key, uint32_t e)
{
    return v2(hash_to_unit(key + e * 0xc13fa9a9u), hash_to_unit(hash_u32(key) + e * 0x91e10da6u));
}

// Direction e of a cell beside its first.
static Vec3 further_direction(const Hemisphere *h, uint32_t use, uint32_t cell, uint32_t e)
{
    Vec2 u = kronecker(hash_combine(hash_combine(h->key, use), cell), e);
    return sheen_strata_direction(h->strata, cell % h->strata.rings, cell / h->strata.rings, u);
}

// Asks the strata whose ray came to a mirror or a pane for lamps again, several times: a lamp seen there is small and
// bright, and one ray in a stratum finds it seldom. A stratum's caustic becomes the mean over those of its rays that
// came to one. Given that the first did, this has the expectation of the first alone, whatever share of the stratum the
// mirror fills.
static void resample_caustics(const SheenWork *work, const DiffusePoint *point, const uint32_t cells[], size_t n,
                              Hemisphere *h, SheenStats *stats)
{
    h->caustic_rays = n == 0 ? 1 : (uint32_t)(h->cells / n < CAUSTIC_RAYS ? h->cells / n : CAUSTIC_RAYS);
    uint32_t more = h->caustic_rays - 1, key = hash_combine(h->key, KEY_CAUSTIC);
    for (size_t i = 0; i < n * more; ++i) {
        Vec3 d = further_direction(h, KEY_CAUSTIC, cells[i / more], (uint32_t)(i % more));
        h->rays[i] = leave(point, frame_to_world(&h->frame, d));
    }
    sheen_accel_intersect_many(work->accel, SHEEN_COHERENT, n * more, h->rays, h->hits);
    stats->rays_gather += n * more;
    for (size_t c = 0; c < n && more; ++c) {
        Rgb sum = h->caustic[cells[c]];
        float found = 1.0f;
        for (size_t i = c * more; i < (c + 1) * more; ++i) {
            SheenSampler sampler = sampler_make(key, (uint32_t)i);
            Followed f;
            sheen_follow(work, &h->rays[i], &h->hits[i], &sampler, &stats->rays_specular, &f);
            sum = rgb_add(sum, caustic_of(work, &f));
            found += f.specular > 0 ? 1.0f : 0.0f;
        }
        h->caustic[cells[c]] = rgb_scale(sum, 1.0f / found);
    }
}

void sheen_hemisphere_begin(const DiffusePoint *point, uint32_t key, Hemisphere *h)
{
    h->key = key;
    h->frame = frame_from_normal(point->n);
    h->error = 0.0f;
    h->guide.n = 0;
    h->glossy = NULL;
}

void sheen_hemisphere_trace(const SheenWork *work, const DiffusePoint *point, unsigned bounces, Hemisphere *h,
                            SheenStats *stats)
{
    h->n_vertices = 0;
    sheen_strata_directions(h->strata, hash_combine(h->key, KEY_STRATA), h->directions);
    uint32_t specular_key = hash_combine(h->key, KEY_SPECULAR);
    for (uint32_t i = 0; i < h->cells; ++i) h->rays[i] = leave(point, frame_to_world(&h->frame, h->directions[i]));
    sheen_accel_intersect_many(work->accel, SHEEN_COHERENT, h->cells, h->rays, h->hits);
    stats->rays_gather += h->cells;
    size_t n_through = 0;
    for (uint32_t i = 0; i < h->cells; ++i) {
        h->L[i] = h->caustic[i] = rgb_gray(0.0f);
        h->specular[i] = 0;
        SheenSampler sampler = sampler_make(specular_key, i);
        Followed f;
        sheen_follow(work, &h->rays[i], &h->hits[i], &sampler, &stats->rays_specular, &f);
        h->distance[i] = maxf(f.distance, 1e-20f);
        h->normals[i] = f.scatters ? frame_to_local(&h->frame, f.point.ng) : v3_neg(h->directions[i]);
        receive(work, &f, rgb_gray(1.0f), i, i, bounces, h, stats);
        if (f.specular > 0) h->through[n_through++] = i;
    }
    // Without a light to ask there is no lamp and no hard part of the sky.
    if (sheen_lights_count(work->lights) == 0) n_through = 0;
    resample_caustics(work, point, h->through, n_through, h, stats);
}

// ---- refinement -------------------------------------------------------------------------------------------------

// The share of one ray along d, in a cell with `rays` of its own, where the cones send more.
static float ray_weight(const Hemisphere *h, Vec3 d, uint32_t rays)
{
    float density = (float)h->cells * strata_pdf(h->strata, d.z); // of one ray in each cell, per steradian
    return density / ((float)rays * density + guide_density(&h->guide, d));
}

static size_t add_cones(Hemisphere *h)
{
    size_t n = 0;
    uint32_t key = hash_combine(h->key, KEY_FURTHER);
    for (uint32_t c = 0; c < h->guide.n; ++c)
        for (uint32_t e = 0; e < h->guide.cones[c].rays && n < SHEEN_FURTHER_MAX * h->cells; ++e) {
            Vec3 d = sheen_cone_direction(&h->guide.cones[c], kronecker(hash_combine(key, (uint32_t)h->cells + c), e));
            if (d.z > 1e-4f) h->further[n++] = (GatherRay){.d = d, .cell = sheen_strata_cell(h->strata, d)};
        }
    return n;
}

// Lists the further rays and gives all their weights; the first rays' light takes its own.
static size_t plan(float error, Hemisphere *h)
{
    for (size_t i = 0; i < h->cells; ++i)
        h->value[i] = ray_weight(h, h->directions[i], 1) * rgb_luminance(rgb_add(h->L[i], h->caustic[i]));
    size_t n = add_cones(h);
    size_t most = SHEEN_FURTHER_MAX * h->cells;
    size_t more =
        sheen_strata_allocate(h->strata, h->value, error, (uint32_t)(most - n), h->deviation, h->extra, &h->error);
    if (n + more == 0) return 0;
    for (uint32_t i = 0; i < h->cells; ++i) {
        float weight = ray_weight(h, h->directions[i], 1 + h->extra[i]);
        h->L[i] = rgb_scale(h->L[i], weight);
        h->caustic[i] = rgb_scale(h->caustic[i], weight);
        for (uint32_t e = 0; e < h->extra[i]; ++e)
            h->further[n++] = (GatherRay){.d = further_direction(h, KEY_FURTHER, i, e), .cell = i};
    }
    for (size_t i = 0; i < n; ++i)
        h->further[i].weight = ray_weight(h, h->further[i].d, 1 + h->extra[h->further[i].cell]);
    return n;
}

size_t sheen_hemisphere_refine(const SheenWork *work, const DiffusePoint *point, unsigned bounces, float error,
                               Hemisphere *h, SheenStats *stats)
{
    size_t n = plan(error, h);
    h->n_vertices = 0;
    for (size_t i = 0; i < n; ++i) h->rays[i] = leave(point, frame_to_world(&h->frame, h->further[i].d));
    sheen_accel_intersect_many(work->accel, SHEEN_COHERENT, n, h->rays, h->hits);
    stats->rays_gather += n;
    uint32_t specular_key = hash_combine(h->key, KEY_SPECULAR);
    for (uint32_t i = 0; i < n; ++i) {
        uint32_t ray = (uint32_t)h->cells + i;
        SheenSampler sampler = sampler_make(specular_key, ray);
        Followed f;
        sheen_follow(work, &h->rays[i], &h->hits[i], &sampler, &stats->rays_specular, &f);
        receive(work, &f, rgb_gray(h->further[i].weight), h->further[i].cell, ray, bounces, h, stats);
    }
    return n;
}

// ---- light at the vertices --------------------------------------------------------------------------------------

// Draws a direction from a Lambertian vertex. @return its weight
static float onward(const Hemisphere *h, const GatherVertex *v, uint32_t key, Vec3 *d)
{
    SheenSampler sampler = sampler_make(key, v->ray);
    Frame frame = frame_from_normal(v->point.bent);
    float choice = sampler_1d(&sampler);
    float weight = sheen_guide_direction(&h->guide, v->point.p, &frame, choice, sampler_2d(&sampler), d);
    *d = frame_to_world(&frame, *d);
    return v3_dot(*d, v->point.n) > 0.0f ? weight : 0.0f;
}

size_t sheen_hemisphere_extend(const SheenWork *work, float near, Hemisphere *h, SheenStats *stats)
{
    // Near vertices are taken out into rays; the rest closes up.
    size_t n_rays = 0, kept = 0;
    uint32_t key = hash_combine(h->key, KEY_EXTEND);
    GatherVertex *moved = h->moved;
    for (size_t i = 0; i < h->n_vertices; ++i) {
        GatherVertex v = h->vertices[i];
        if (!v.turns && !(v.distance < near)) {
            if (kept++ < i) h->vertices[kept - 1] = v;
            continue;
        }
        Vec3 d = v.onward;
        float weight = v.turns ? 1.0f : onward(h, &v, hash_combine(key, v.bounces), &d);
        if (!(weight > 0.0f)) continue;
        // One ray estimates the irradiance at the vertex by pi L, times its weight.
        v.weight = rgb_scale(v.weight, SHEEN_PI * weight);
        h->rays[n_rays] = leave(&v.point, d);
        moved[n_rays++] = v;
    }
    size_t taken = h->n_vertices - kept;
    h->n_vertices = kept;
    sheen_accel_intersect_many(work->accel, SHEEN_INCOHERENT, n_rays, h->rays, h->hits);
    stats->rays_gather += n_rays;
    for (size_t i = 0; i < n_rays; ++i) {
        const GatherVertex *v = &moved[i];
        SheenSampler sampler = sampler_make(hash_combine(h->key, KEY_SPECULAR + v->bounces), v->ray);
        Followed f;
        sheen_follow(work, &h->rays[i], &h->hits[i], &sampler, &stats->rays_specular, &f);
        receive(work, &f, v->weight, v->cell, v->ray, v->bounces - 1, h, stats);
    }
    return taken;
}

void sheen_hemisphere_direct(const SheenWork *work, size_t first, uint32_t samples, Hemisphere *h, SheenStats *stats)
{
    const GatherVertex *v = h->vertices + first, *end = h->vertices + h->n_vertices;
    size_t n = 0; // vertices without direct light so far
    for (; v < end; ++v) {
        if (v->lit) continue;
        h->points[n] = v->point;
        h->irradiance[n++] = rgb_gray(0.0f);
    }
    uint32_t each = lights_each(work), turns = each ? each : samples;
    for (uint32_t turn = 0; turn < turns; ++turn) {
        size_t i = 0;
        for (v = h->vertices + first; v < end; ++v)
            if (!v->lit)
                h->numbers[i++] = each ? light_numbers(h->key, v->bounces, v->ray, turn)
                                       : light_numbers(h->key, v->bounces, v->ray * samples + turn, SHEEN_NONE);
        float share = each ? 1.0f : 1.0f / (float)samples;
        stats->rays_shadow += sheen_direct_add(work, n, h->points, h->numbers, share, &h->direct, h->irradiance);
    }
    size_t i = 0;
    for (v = h->vertices + first; v < end; ++v)
        if (!v->lit) h->L[v->cell] = rgb_add(h->L[v->cell], rgb_mul(v->weight, h->irradiance[i++]));
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

// Irradiance at the gather's own point straight from lamps: noise is seen beside it too.
static Rgb own_direct(const SheenWork *work, const DiffusePoint *point, Hemisphere *h, SheenStats *stats)
{
    const size_t most = 16, n = h->cells < most ? h->cells : most;
    for (size_t i = 0; i < n; ++i) {
        h->points[i] = *point;
        h->irradiance[i] = rgb_gray(0.0f);
        h->numbers[i] = light_numbers(h->key, KEY_OWN, (uint32_t)i, SHEEN_NONE);
    }
    stats->rays_shadow += sheen_direct_add(work, n, h->points, h->numbers, 1.0f / (float)n, &h->direct, h->irradiance);
    Rgb E = rgb_gray(0.0f);
    for (size_t i = 0; i < n; ++i) E = rgb_add(E, h->irradiance[i]);
    return E;
}

// Adds values to L, each cut to at most `share` of the whole, `beside` included; but never below what one cell in 64
// sees, which is light and not noise: a room may have no other.
static void add_cut(Hemisphere *h, const Rgb values[], double share, double beside)
{
    double rest = beside, cut = 0.0;
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

void sheen_hemisphere_add_caustics(const SheenWork *work, const DiffusePoint *point, float noisier, Hemisphere *h,
                                   SheenStats *stats)
{
    double mirrored_most = 8.0 * (double)noisier, caustic_most = 2.0 * (double)noisier; // times the mean, a ray
    bool caustic = false, mirrored = false;
    for (size_t i = 0; i < h->cells; ++i) {
        h->mirrored[i] = h->specular[i] ? h->L[i] : rgb_gray(0.0f);
        if (h->specular[i]) h->L[i] = rgb_gray(0.0f);
        mirrored = mirrored || h->specular[i];
        caustic = caustic || !rgb_is_black(h->caustic[i]);
    }
    if (!mirrored && !caustic) return;
    double cells = (double)h->cells;
    double beside = (double)(rgb_max(own_direct(work, point, h, stats)) * SHEEN_INV_PI) * cells;
    add_cut(h, h->mirrored, mirrored_most / cells, beside);
    add_cut(h, h->caustic, caustic_most * (double)h->caustic_rays / cells, beside);
}
