// SPDX-License-Identifier: Apache-2.0
#include "integrator/visibility.h"

#include "scene/passage.h"

#include <stdlib.h>

enum { SPLIT_DEPTH = 3 };
static const float throughput_min = 1e-4f; // ways that carry less cannot be seen and are dropped

uint32_t sheen_tile_count(const SheenWork *work)
{
    uint32_t nx = (work->width + SHEEN_TILE_SIDE - 1) / SHEEN_TILE_SIDE;
    uint32_t ny = (work->height + SHEEN_TILE_SIDE - 1) / SHEEN_TILE_SIDE;
    return nx * ny;
}

Tile sheen_tile(const SheenWork *work, uint32_t index)
{
    uint32_t nx = (work->width + SHEEN_TILE_SIDE - 1) / SHEEN_TILE_SIDE;
    Tile t = {index % nx * SHEEN_TILE_SIDE, index / nx * SHEEN_TILE_SIDE, SHEEN_TILE_SIDE, SHEEN_TILE_SIDE};
    if (t.width > work->width - t.x) t.width = work->width - t.x;
    if (t.height > work->height - t.y) t.height = work->height - t.y;
    return t;
}

void sheen_every_pixel(uint32_t stride, uint32_t width, uint32_t height, uint32_t ends[])
{
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) ends[(size_t)y * width + x] = x % stride == 0 && y % stride == 0;
}

void sheen_visibility_free(Visibility *v)
{
    sheen_seen_free(&v->seen);
    free(v->rays[0]);
    free(v->rays[1]);
    free(v->batch);
    free(v->hits);
    *v = (Visibility){0};
}

static bool push_ray(Visibility *v, int list, const EyeRay *r)
{
    if (v->n_rays[list] == v->rays_capacity[list]) {
        size_t capacity = v->rays_capacity[list] ? 2 * v->rays_capacity[list] : 4096;
        EyeRay *grown = realloc(v->rays[list], capacity * sizeof *grown);
        if (!grown) return false;
        v->rays[list] = grown;
        v->rays_capacity[list] = capacity;
    }
    v->rays[list][v->n_rays[list]++] = *r;
    return true;
}

static bool reserve_batch(Visibility *v, size_t n)
{
    if (n <= v->batch_capacity) return true;
    free(v->batch);
    free(v->hits);
    v->batch = malloc(n * sizeof *v->batch);
    v->hits = malloc(n * sizeof *v->hits);
    v->batch_capacity = v->batch && v->hits ? n : 0;
    return v->batch_capacity > 0;
}

// The first samples of all pixels share one sequence, further ones have one for each pixel.
static SheenSampler camera_sampler(const SheenWork *work, uint32_t x, uint32_t y, uint32_t s)
{
    uint32_t key = hash_u32(work->options.seed), spp = work->options.spp;
    if (s < spp) return sampler_make(key, sheen_sample_index(x, y, spp, s));
    return sampler_make(hash_combine(key, y * work->width + x + 1), s - spp);
}

// What samples [first, end) of a pixel count for in their mean, the negative ones in weight[1].
static void pixel_weights(const SheenWork *work, uint32_t x, uint32_t y, uint32_t first, uint32_t end, float weight[2])
{
    uint32_t n_negative = 0;
    for (uint32_t s = first; work->filter && work->filter->has_signs && s < end; ++s) {
        SheenSampler sampler = camera_sampler(work, x, y, s);
        bool negative;
        sheen_pixel_filter_sample(work->filter, sampler_2d(&sampler), &negative);
        n_negative += negative;
    }
    double exact[2];
    sheen_pixel_filter_weights(work->filter, end - first, n_negative, exact);
    weight[0] = (float)exact[0], weight[1] = (float)exact[1];
}

static bool push_pixel(const SheenWork *work, const SheenEye *eye, uint32_t x, uint32_t y, SampleRange range,
                       Visibility *v)
{
    uint32_t pixel = y * work->width + x, spp = work->options.spp;
    // The first samples and the further ones have mean weight 1 each.
    uint32_t all = range.ends ? range.ends[pixel] : spp,
             last = range.first + range.n < all ? range.first + range.n : all;
    if (range.first >= last) return true;
    float weight[2];
    pixel_weights(work, x, y, range.first < spp ? 0 : spp, range.first < spp ? spp : all, weight);
    for (uint32_t s = range.first; s < last; ++s) {
        EyeRay r = {.throughput = rgb_gray(1.0f), .pixel = pixel, .sample = s, .branch = 1};
        SheenSampler sampler = camera_sampler(work, x, y, s);
        bool negative;
        r.ray = sheen_camera_ray(work, eye, x, y, &sampler, &negative);
        r.weight = weight[negative];
        if (!push_ray(v, 0, &r)) return false;
    }
    return true;
}

static bool push_camera_rays(const SheenWork *work, const SheenEye *eye, const Tile *tile, SampleRange range,
                             Visibility *v)
{
    v->n_rays[0] = 0;
    for (uint32_t y = tile->y; y < tile->y + tile->height; ++y)
        for (uint32_t x = tile->x; x < tile->x + tile->width; ++x)
            if (!push_pixel(work, eye, x, y, range, v)) return false;
    return true;
}

static SheenSampler sampler_of(const SheenWork *work, const EyeRay *r)
{
    uint32_t key = hash_combine(hash_combine(work->options.seed, r->pixel), r->branch + 7919u * r->depth);
    return sampler_make(key, r->sample);
}

// Sends a ray on with the i-th way of its branching, and counts that. @return false when out of memory
static bool send(const EyeRay *r, const Ray *ray, Rgb weight, uint32_t i, EyeRay *next, int list, Visibility *v)
{
    next->throughput = rgb_mul(r->throughput, weight);
    if (!(rgb_max(next->throughput) > throughput_min)) return true;
    next->ray = *ray;
    next->branch = 2 * r->branch + i;
    next->depth = r->depth + 1;
    SheenFilm *film = v->film;
    if (film)
        film_add(film, SHEEN_AOV_TRANSPORT, r->pixel % film->width, r->pixel / film->width, rgb(0.0f, 0.0f, 1.0f));
    return push_ray(v, list, next);
}

// Sends a ray straight on through a hole. Nothing has happened to it, and light that it finds weighs as before.
static bool pass(const EyeRay *r, const SurfacePoint *s, Rgb weight, int list, Visibility *v)
{
    EyeRay next = *r;
    next.throughput = rgb_mul(r->throughput, weight);
    if (r->passages == SHEEN_PASSAGES_MAX || !(rgb_max(next.throughput) > throughput_min)) return true;
    next.ray = sheen_surface_ray(s, r->ray.d);
    next.branch ^= hash_u32(++next.passages);
    return push_ray(v, list, &next);
}

// Sends a ray on along its delta lobes.
static bool split(const EyeRay *r, const SeenSurface *s, int list, Visibility *v)
{
    BsdfSample lobes[SHEEN_BSDF_MAX_DELTA];
    int n = sheen_bsdf_delta_lobes(&s->bsdf, s->wo_l, lobes);
    for (int i = 0; i < n; ++i) {
        if (lobes[i].passage) {
            if (!pass(r, &s->s, lobes[i].weight, list, v)) return false;
            continue;
        }
        EyeRay next = *r;
        next.competes = false;
        Ray ray = sheen_surface_ray(&s->s, frame_to_world(&s->frame, lobes[i].wi_l));
        if (!send(r, &ray, lobes[i].weight, (uint32_t)i, &next, list, v)) return false;
    }
    return true;
}

static void add_first_hit(const SheenWork *work, const EyeRay *r, const Hit *hit, const SurfacePoint *s,
                          SheenFilm *film)
{
    uint32_t x = r->pixel % work->width, y = r->pixel / work->width;
    float weight = r->weight;
    Vec3 n = v3_dot(s->ns, r->ray.d) <= 0.0f ? s->ns : v3_neg(s->ns);
    film_add(film, SHEEN_AOV_DEPTH, x, y, rgb_gray(weight * hit->t));
    film_add(film, SHEEN_AOV_POSITION, x, y, rgb_scale(rgb(s->p.x, s->p.y, s->p.z), weight));
    film_add(film, SHEEN_AOV_NORMAL, x, y, rgb_scale(rgb(n.x, n.y, n.z), weight));
    if (film->aov[SHEEN_AOV_ALBEDO]) {
        Frame frame = frame_from_normal(n);
        Bsdf bsdf;
        sheen_bsdf_look_up(work->scene, s, &bsdf);
        Rgb albedo = sheen_bsdf_albedo(&bsdf, frame_to_local(&frame, v3_neg(r->ray.d)));
        film_add(film, SHEEN_AOV_ALBEDO, x, y, rgb_scale(albedo, weight));
    }
    film_add(film, SHEEN_AOV_UV, x, y, rgb_scale(rgb(s->uv.x, s->uv.y, 0.0f), weight));
    if (r->sample == 0)
        film_add(film, SHEEN_AOV_PRIMITIVE, x, y,
                 rgb((float)s->shape, (float)s->triangle, s->instance == SHEEN_NONE ? -1.0f : (float)s->instance));
}

static void add_light(const EyeRay *r, Rgb radiance, Picture *picture, SheenStats *stats)
{
    sheen_picture_add(picture, r->pixel, r->sample, rgb_scale(rgb_mul(r->throughput, radiance), r->weight),
                      SHEEN_AOV_DIRECT, stats);
}

// Sends a ray on along the glossy part. What it sees is blurred: the pixel widens.
static bool send_glossy(const SheenWork *work, const EyeRay *r, const SeenSurface *s, int list, Visibility *v)
{
    const float blur = 1.0f / 32.0f; // of the lobe's width that may be told apart in what it shows
    EyeRay next = *r;
    Ray ray;
    Rgb weight;
    float roughness;
    SheenSampler sampler = sampler_of(work, r);
    if (!sheen_glossy_ray(s, &sampler, &ray, &weight, &roughness, &next.origin)) return true;
    next.gathered = next.competes = true;
    next.blur += blur * roughness;
    return send(r, &ray, weight, SHEEN_BSDF_MAX_DELTA, &next, list, v);
}

static ShadingPoint shading_point(const EyeRay *r, const DiffusePoint *point, bool lit)
{
    return (ShadingPoint){.point = *point,
                          .throughput = rgb_scale(r->throughput, r->weight),
                          .toward = r->ray.d,
                          .footprint = r->footprint,
                          .pixel = r->pixel,
                          .sample = r->sample,
                          .branch = r->branch,
                          .lit = lit,
                          .gathered = r->gathered};
}

static bool add_point(const EyeRay *r, const DiffusePoint *point, bool lit, Visibility *v)
{
    ShadingPoint p = shading_point(r, point, lit);
    return sheen_seen_add(&p, 1, &v->seen);
}

// A point for what a cache holds of the glossy part; the rest stays in s->rest.
static bool add_glossy_point(const SheenWork *work, const EyeRay *r, SeenSurface *s, bool lobes, Visibility *v)
{
    sheen_glossy_cache_read(work->glossy, s, &v->lobe);
    DiffusePoint point;
    if (v->lobe.order == 0 || !sheen_set_point(&s->s, s->wo_l.z > 0.0f, rgb_gray(1.0f), &point)) return true;
    if (lobes) sheen_glossy_cache_orient(work->glossy, s, &v->lobe);
    ShadingPoint p = shading_point(r, &point, true);
    return sheen_seen_add_glossy(&p, v->lobe.basis, v->lobe.order, lobes ? v->lobe.coefficients : NULL, &v->seen);
}

// A surface in full: all its delta lobes, a ray along the glossy part, light samples, and a point for the diffuse part.
static bool see(const SheenWork *work, const EyeRay *r, SeenSurface *s, int list, Picture *picture, Visibility *v,
                SheenStats *stats)
{
    unsigned classes = sheen_bsdf_classes(&s->bsdf);
    if ((classes & SHEEN_BSDF_DELTA) && !split(r, s, list, v)) return false;
    if ((classes & SHEEN_BSDF_GLOSSY) && work->glossy && !add_glossy_point(work, r, s, picture != NULL, v))
        return false;
    if ((classes & SHEEN_BSDF_GLOSSY) && !send_glossy(work, r, s, list, v)) return false;
    if ((classes & SHEEN_BSDF_SMOOTH) && picture) {
        Rgb L = sheen_glossy_lit(work, s, r->branch, r->pixel, r->sample, stats);
        add_light(r, L, picture, stats);
    }
    DiffusePoint point;
    if (!(classes & SHEEN_BSDF_DIFFUSE)) return true;
    Rgb diffuse = sheen_bsdf_diffuse(&s->bsdf, s->wo_l, NULL);
    if (!sheen_set_point(&s->s, s->wo_l.z > 0.0f, diffuse, &point)) return true;
    sheen_bend_point(&s->bsdf, &s->frame, s->wo_l, &point);
    return add_point(r, &point, true, v);
}

// What the light that a ray found is worth: on surfaces that emit and beyond all.
static Rgb found(const SheenWork *work, const EyeRay *r, const SurfacePoint *s)
{
    Vec3 wo = v3_neg(r->ray.d);
    if (r->competes)
        return s ? sheen_glossy_found(work, &r->origin, s, wo) : sheen_glossy_found_sky(work, &r->origin, r->ray.d);
    if (s) return sheen_emitted(work->scene, s, wo);
    return rgb_add(sheen_environment(work->scene, r->ray.d), sheen_suns(work->lights, r->ray.d));
}

static bool arrive(const SheenWork *work, const SheenEye *eye, EyeRay *r, const Hit *hit, int list, Picture *picture,
                   Visibility *v, SheenStats *stats)
{
    if (hit->shape == SHEEN_NONE) {
        if (picture) add_light(r, found(work, r, NULL), picture, stats);
        return true;
    }
    SeenSurface seen;
    SurfacePoint *s = &seen.s;
    sheen_surface_from_hit(work->scene, &r->ray, hit, s);
    Vec3 wo = v3_neg(r->ray.d);
    r->length += hit->t;
    r->blurred += r->blur * hit->t;
    r->footprint = sheen_eye_footprint(eye, r->length) + r->blurred;
    if (picture) {
        Rgb emitted = found(work, r, s);
        if (!rgb_is_black(emitted)) add_light(r, emitted, picture, stats);
        if (r->depth == 0 && r->passages == 0) add_first_hit(work, r, hit, s, picture->film);
    }
    bool last = r->gathered && work->options.bounces == 0; // no light comes from another scattering
    DiffusePoint point;
    const SheenMaterial *lambertian = sheen_lambertian(work->scene, s);
    if (lambertian)
        return last || !sheen_lambertian_point(work->scene, lambertian, s, wo, &point) ||
               add_point(r, &point, false, v);
    sheen_seen_surface(work, wo, &seen);
    if (!r->gathered && r->depth < SPLIT_DEPTH) return see(work, r, &seen, list, picture, v, stats);
    SheenSampler sampler = sampler_of(work, r);
    Ray ray;
    EyeRay next = *r;
    Rgb through = rgb_gray(1.0f);
    SheenStep step = sheen_step(s, &seen.bsdf, wo, &sampler, &through, &ray, &point);
    if (step == SHEEN_STEP_SCATTERS || step == SHEEN_STEP_TURNS) return last || add_point(r, &point, false, v);
    if (step == SHEEN_STEP_PASSES) return pass(r, s, through, list, v);
    next.competes = false;
    if (step == SHEEN_STEP_ENDS || r->depth >= SHEEN_SPECULAR_MAX) return true;
    return send(r, &ray, through, 0, &next, list, v);
}

bool sheen_visibility_trace(const SheenWork *work, const Tile *tile, SampleRange range, Picture *picture, Visibility *v,
                            SheenStats *stats)
{
    seen_clear(&v->seen);
    v->film = picture ? picture->film : NULL;
    SheenEye eye = sheen_eye(work->camera, work->width, work->height);
    if (!push_camera_rays(work, &eye, tile, range, v)) return false;
    stats->rays_camera += v->n_rays[0];
    for (int list = 0, depth = 0; v->n_rays[list] > 0; list ^= 1, ++depth) {
        size_t n_rays = v->n_rays[list];
        if (!reserve_batch(v, n_rays)) return false;
        for (size_t i = 0; i < n_rays; ++i) v->batch[i] = v->rays[list][i].ray;
        sheen_accel_intersect_many(work->accel, depth ? SHEEN_INCOHERENT : SHEEN_COHERENT, n_rays, v->batch, v->hits);
        if (depth) stats->rays_specular += n_rays;
        v->n_rays[list ^ 1] = 0;
        for (size_t i = 0; i < n_rays; ++i)
            if (!arrive(work, &eye, &v->rays[list][i], &v->hits[i], list ^ 1, picture, v, stats)) return false;
    }
    return true;
}
