// SPDX-License-Identifier: Apache-2.0
#include "integrator/path.h"

#include "integrator/mis.h"
#include "material/bsdf.h"
#include "scene/passage.h"

// After so many scatterings, not at delta lobes, a path of small throughput is ended by chance. Earlier ends would cost
// more noise than time; chains of delta lobes are short, and without roulette exact.
enum { ROULETTE_FIRST_SCATTERING = 4 };

// Bounds the length of a path where nothing absorbs and the bounces are not bounded.
static const float ROULETTE_MAX_SURVIVAL = 0.99f;

// Each vertex has its own dimensions, drawn or not, so that the samples of a pixel are stratified against each other at
// each vertex, whatever happened at the ones before.
enum { DIM_LIGHT = 0, DIM_LIGHT_UV = 1, DIM_LOBE = 3, DIM_BSDF_UV = 4, DIM_ROULETTE = 6, DIMS_PER_VERTEX = 7 };

// The path so far, up to the ray that is to find the next vertex. A passage through a hole is no scattering: the ray
// goes on with all that is known of how it was drawn, since the light samples of the vertex that it left pass the hole
// too.
typedef struct Path {
    const SheenWork *work;
    SheenStats *stats;
    SheenSampler sampler;
    Ray ray;
    Rgb throughput;
    uint32_t vertices;    // scatterings of all kinds, and passages
    uint32_t scatterings; // those that are not at delta lobes
    uint32_t passages;
    // How the ray was drawn, for weighing the light that it finds against light samples of the same vertex.
    bool competes;          // false for camera rays and after delta lobes: no light sample could have found it
    float pdf;              // 1/sr
    Vec3 p, n;              // the vertex it left, and the normal there on its side
    bool both_sides;        // lights on the other side were asked as well
    uint32_t light_samples; // that were taken there
    PathRadiance sum;
} Path;

// A vertex: surface, what it does with light, and where the path came from.
typedef struct Vertex {
    SurfacePoint s;
    Bsdf bsdf;
    Frame frame; // about the shading normal
    Vec3 wo, wo_l;
    Vec3 side;       // geometric normal on the side of wo
    bool both_sides; // light from the other side is scattered too
    uint32_t light_samples;
} Vertex;

static void draw_from(Path *path, uint32_t dim)
{
    path->sampler.dim = SHEEN_PATH_FIRST_DIM + path->vertices * DIMS_PER_VERTEX + dim;
}

// Books light that took `scatterings` scatterings to arrive.
static void add_light(Path *path, uint32_t scatterings, Rgb radiance)
{
    Rgb *sum = scatterings <= 1 ? &path->sum.direct : &path->sum.indirect;
    *sum = rgb_add(*sum, rgb_mul(path->throughput, radiance));
}

// Weight of light that the path's ray found: `light` its index, pdf_light the density of light samples there.
static float weight_of_found(const Path *path, uint32_t light, float pdf_light)
{
    float choice = choose_light_probability(path->work->lights, path->p, path->n, path->both_sides, light);
    return power_heuristic(path->pdf, (float)path->light_samples * choice * pdf_light);
}

// @param light  of which L is; may be SHEEN_NONE
static void add_escaped(Path *path, Rgb L, uint32_t light)
{
    if (rgb_is_black(L)) return;
    if (path->competes && light != SHEEN_NONE) {
        float pdf_light = sheen_light_pdf_escape(path->work->lights, light, path->ray.d);
        L = rgb_scale(L, weight_of_found(path, light, pdf_light));
    }
    add_light(path, path->scatterings, L);
}

static void add_sky(Path *path)
{
    const SheenLights *lights = path->work->lights;
    uint32_t first, n = sheen_lights_suns(lights, &first);
    add_escaped(path, sheen_environment(path->work->scene, path->ray.d), sheen_lights_environment(lights));
    for (uint32_t sun = first; sun < first + n; ++sun) add_escaped(path, sheen_sun(lights, sun, path->ray.d), sun);
}

static void add_emitted(Path *path, const SurfacePoint *s, Vec3 wo)
{
    const SheenLights *lights = path->work->lights;
    Rgb L = sheen_emitted(path->work->scene, s, wo);
    if (rgb_is_black(L)) return;
    uint32_t light = sheen_lights_of_shape(lights, s->shape);
    if (path->competes && light != SHEEN_NONE)
        L = rgb_scale(L, weight_of_found(path, light, sheen_light_pdf_hit(lights, light, path->p, s)));
    add_light(path, path->scatterings, L);
}

// Makes the vertex at a hit. @return false when the surface is seen from a side that its shading normal denies.
static bool make_vertex(const Path *path, const SurfacePoint *s, Vertex *v)
{
    v->s = *s;
    v->wo = v3_neg(path->ray.d);
    v->frame = frame_from_normal(s->ns);
    v->wo_l = frame_to_local(&v->frame, v->wo);
    float cos_g = v3_dot(v->wo, s->ng);
    if (!(cos_g * v->wo_l.z > 0.0f)) return false;
    v->side = cos_g > 0.0f ? s->ng : v3_neg(s->ng);
    sheen_bsdf_look_up(path->work->scene, s, &v->bsdf);
    v->both_sides = sheen_bsdf_transmits(&v->bsdf);
    return true;
}

// The light from one light sample, scattered toward wo and weighed against the BSDF's own sampling.
static Rgb light_sample(const Path *path, const Vertex *v, uint32_t n_samples, float u_choice, Vec2 u)
{
    const SheenWork *work = path->work;
    uint32_t light;
    float choice = choose_light(work->lights, v->s.p, v->side, v->both_sides, u_choice, &light);
    LightSample ls;
    if (!(choice > 0.0f) || !sheen_light_sample(work->lights, light, v->s.p, u, &ls)) return rgb_gray(0.0f);
    Vec3 wi_l = frame_to_local(&v->frame, ls.wi);
    if (!(wi_l.z * v3_dot(ls.wi, v->s.ng) > 0.0f)) return rgb_gray(0.0f);
    Rgb f_cos = sheen_bsdf_eval(&v->bsdf, v->wo_l, wi_l);
    if (rgb_is_black(f_cos)) return f_cos;
    Ray shadow = sheen_shadow_ray(&v->s, &ls);
    ++path->stats->rays_shadow;
    float through = sheen_accel_transmittance(work->accel, &shadow);
    if (through == 0.0f) return rgb_gray(0.0f);
    float weight = through / (choice * (float)n_samples);
    if (!ls.delta)
        weight *= power_heuristic((float)n_samples * choice * ls.pdf, sheen_bsdf_pdf(&v->bsdf, v->wo_l, wi_l));
    return rgb_scale(rgb_mul(f_cos, ls.radiance), weight);
}

// All light samples of a vertex. Several samples are consecutive ones of the same sequence, which stays stratified.
static void add_light_samples(Path *path, const Vertex *v)
{
    if (sheen_lights_count(path->work->lights) == 0) return;
    uint32_t n = v->light_samples;
    Rgb L = rgb_gray(0.0f);
    for (uint32_t i = 0; i < n; ++i) {
        SheenSampler sampler = path->sampler;
        sampler.index = sampler.index * n + i;
        sampler.dim = SHEEN_PATH_FIRST_DIM + path->vertices * DIMS_PER_VERTEX + DIM_LIGHT;
        float u_choice = sampler_1d(&sampler);
        L = rgb_add(L, light_sample(path, v, n, u_choice, sampler_2d(&sampler)));
    }
    add_light(path, path->scatterings + 1, L);
}

// Ends paths that carry little. @return false when this one ends.
static bool survive_roulette(Path *path)
{
    if (path->scatterings < ROULETTE_FIRST_SCATTERING || !path->competes) return true;
    draw_from(path, DIM_ROULETTE);
    float q = minf(rgb_max(path->throughput), ROULETTE_MAX_SURVIVAL);
    if (!(sampler_1d(&path->sampler) < q)) return false;
    path->throughput = rgb_scale(path->throughput, 1.0f / q);
    return true;
}

// Sends the ray straight on. @return false when the path ends here.
static bool pass(Path *path, const SurfacePoint *s, Rgb weight)
{
    if (path->passages == SHEEN_PASSAGES_MAX) return false;
    path->throughput = rgb_mul(path->throughput, weight);
    path->ray = sheen_surface_ray(s, path->ray.d);
    ++path->passages;
    ++path->vertices;
    ++path->stats->rays_specular;
    return true;
}

// What a surface lets pass that scatters nothing, since its shading normal denies the side from which it is seen.
static bool pass_unseen(Path *path, const SurfacePoint *s)
{
    const SheenScene *scene = path->work->scene;
    bool front = v3_dot(path->ray.d, s->ng) <= 0.0f;
    float passage = sheen_material_passage(scene->materials, scene->shapes[s->shape].material, s->uv, front);
    return passage > 0.0f && pass(path, s, rgb_gray(passage));
}

// Draws the ray that leaves the vertex. @return false when the path ends here.
static bool scatter(Path *path, const Vertex *v)
{
    draw_from(path, DIM_LOBE);
    float u_lobe = sampler_1d(&path->sampler);
    BsdfSample bs;
    if (!sheen_bsdf_sample(&v->bsdf, v->wo_l, u_lobe, sampler_2d(&path->sampler), &bs)) return false;
    if (bs.passage) return pass(path, &v->s, bs.weight);
    Vec3 wi = frame_to_world(&v->frame, bs.wi_l);
    if (!(bs.wi_l.z * v3_dot(wi, v->s.ng) > 0.0f)) return false;
    if (bs.delta) {
        if (path->vertices - path->scatterings - path->passages >= SHEEN_PATH_MAX_DELTA) return false;
        ++path->stats->rays_specular;
    } else {
        if (path->scatterings > path->work->options.bounces) return false;
        ++path->scatterings;
        ++path->stats->rays_path;
    }
    path->throughput = rgb_mul(path->throughput, bs.weight);
    path->ray = sheen_surface_ray(&v->s, wi);
    path->competes = !bs.delta;
    path->pdf = bs.pdf;
    path->p = v->s.p;
    path->n = v->side;
    path->both_sides = v->both_sides;
    path->light_samples = v->light_samples;
    ++path->vertices;
    return survive_roulette(path);
}

PathRadiance sheen_path_trace(const SheenWork *work, const Ray *ray, const Hit *hit, SheenSampler sampler,
                              SheenStats *stats)
{
    Path path = {.work = work, .stats = stats, .sampler = sampler, .ray = *ray, .throughput = rgb_gray(1.0f)};
    uint32_t first_light_samples = work->options.light_samples ? work->options.light_samples : 1;
    Hit next = *hit;
    for (;;) {
        if (next.shape == SHEEN_NONE) {
            add_sky(&path);
            break;
        }
        SurfacePoint s;
        Vertex v;
        sheen_surface_from_hit(work->scene, &path.ray, &next, &s);
        add_emitted(&path, &s, v3_neg(path.ray.d));
        if (make_vertex(&path, &s, &v)) {
            v.light_samples = path.scatterings == 0 ? first_light_samples : 1;
            // After the last scattering only delta lobes are followed, to the emitter that may be behind them.
            bool lit = path.scatterings <= work->options.bounces && !sheen_bsdf_is_delta(&v.bsdf);
            if (lit) add_light_samples(&path, &v);
            if (!scatter(&path, &v)) break;
        } else if (!pass_unseen(&path, &s)) {
            break;
        }
        sheen_accel_intersect(work->accel, &path.ray, &next);
    }
    return path.sum;
}
