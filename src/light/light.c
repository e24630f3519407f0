// SPDX-License-Identifier: Apache-2.0
#include "light/light.h"

#include "light/choose.h"
#include "light/emission.h"
#include "light/source.h"

#include <stdlib.h>

struct SheenLights {
    SheenArena *arena; // owns the arrays below
    uint32_t n;
    Source *sources; // [n], in the order of their kinds
    Chooser chooser;
    const SheenScene *scene;
    uint32_t *of_light;                  // [scene->n_lights] index into sources, or SHEEN_NONE
    uint32_t environment;                // index into sources, or SHEEN_NONE
    uint32_t first_sun, n_suns;          // indices into sources
    const SheenLight *environment_light; // NULL for none
    float soft_limit;                    // luminance up to which samples leave the environment out
};

// ---- creation ---------------------------------------------------------------------------------------------------

static bool can_contribute(const Source *s)
{
    const SheenLight *l = s->light;
    if (!rgb_finite(l->radiance) || !(rgb_max(l->radiance) > 0.0f)) return false;
    if (s->kind == SOURCE_ENVIRONMENT) return s->environment.flux > 0.0f;
    if (l->kind == SHEEN_LIGHT_AREA) return s->area > 0.0 && isfinite(s->area);
    return true;
}

// Where a source stands: by kind, then along a curve that keeps neighbours together, then as in the scene.
typedef struct Order {
    uint32_t kind, code, index;
} Order;

static int compare_orders(const void *a, const void *b)
{
    const Order *x = a, *y = b;
    if (x->kind != y->kind) return x->kind < y->kind ? -1 : 1;
    if (x->code != y->code) return x->code < y->code ? -1 : 1;
    return x->index < y->index ? -1 : 1;
}

static uint32_t spread_bits(float x) // 10 bits of [0, 1], two zeros after each
{
    uint32_t b = (uint32_t)(clampf(x, 0.0f, 1.0f) * 1023.0f);
    b = (b | b << 16) & 0x030000ffu;
    b = (b | b << 8) & 0x0300f00fu;
    b = (b | b << 4) & 0x030c30c3u;
    return (b | b << 2) & 0x09249249u;
}

// Place along the Morton curve within the box of all lights.
static uint32_t morton_code(const Bounds *box, Vec3 p)
{
    Vec3 size = v3_max(v3_sub(box->hi, box->lo), v3(1e-20f, 1e-20f, 1e-20f)), d = v3_sub(p, box->lo);
    return spread_bits(d.x / size.x) << 2 | spread_bits(d.y / size.y) << 1 | spread_bits(d.z / size.z);
}

static SheenStatus gather_sources(const SheenScene *scene, SheenEnvironmentSplit split, Source *all, Order *order,
                                  SheenLights *l)
{
    Bounds box = bounds_empty();
    for (uint32_t i = 0; i < scene->n_lights; ++i) {
        l->of_light[i] = SHEEN_NONE;
        SheenStatus status = sheen_source_init(scene, &scene->lights[i], split, l->arena, &all[i]);
        if (status) return status;
        if (i == scene->environment) l->soft_limit = all[i].environment.threshold;
        if (!can_contribute(&all[i])) continue;
        if (!isinf(all[i].radius)) box = bounds_add(box, all[i].center);
        order[l->n++].index = i;
    }
    for (uint32_t k = 0; k < l->n; ++k) {
        const Source *s = &all[order[k].index];
        order[k].kind = (uint32_t)s->kind;
        order[k].code = isinf(s->radius) ? 0 : morton_code(&box, s->center);
    }
    qsort(order, l->n, sizeof *order, compare_orders);
    for (uint32_t k = 0; k < l->n; ++k) {
        l->sources[k] = all[order[k].index];
        l->of_light[order[k].index] = k;
        if (l->sources[k].kind == SOURCE_ENVIRONMENT) l->environment = k;
        if (l->sources[k].kind == SOURCE_SUN && l->n_suns++ == 0) l->first_sun = k;
    }
    return SHEEN_OK;
}

static SheenStatus build(const SheenScene *scene, SheenEnvironmentSplit split, SheenLights *l)
{
    l->arena = sheen_arena_create();
    if (!l->arena) return SHEEN_ERR_NOMEM;
    l->scene = scene;
    l->environment = SHEEN_NONE;
    if (scene->environment != SHEEN_NONE) l->environment_light = &scene->lights[scene->environment];
    l->sources = SHEEN_ARENA_NEW(l->arena, Source, scene->n_lights);
    l->of_light = SHEEN_ARENA_NEW(l->arena, uint32_t, scene->n_lights);
    Source *all = calloc((size_t)scene->n_lights + 1, sizeof *all);
    Order *order = calloc((size_t)scene->n_lights + 1, sizeof *order);
    SheenStatus status = SHEEN_ERR_NOMEM;
    if (l->sources && l->of_light && all && order) status = gather_sources(scene, split, all, order, l);
    free(order);
    free(all);
    if (status) return status;
    return sheen_chooser_init(l->sources, l->n, l->arena, &l->chooser) ? SHEEN_OK : SHEEN_ERR_NOMEM;
}

SheenStatus sheen_lights_create(const SheenScene *scene, SheenEnvironmentSplit split, const SheenLog *log,
                                SheenLights **out)
{
    *out = NULL;
    uint32_t n_infinite = 0;
    for (uint32_t i = 0; i < scene->n_lights; ++i)
        n_infinite +=
            scene->lights[i].kind == SHEEN_LIGHT_DIRECTIONAL || scene->lights[i].kind == SHEEN_LIGHT_ENVIRONMENT;
    if (scene->n_lights > CHOOSE_MAX || n_infinite > CHOOSE_INFINITE_MAX)
        return sheen_fail(log, SHEEN_ERR_UNSUPPORTED,
                          "%s: %u lights, %u of them directional, are more than the %u and %u that can be rendered",
                          scene->name, scene->n_lights, n_infinite, CHOOSE_MAX, CHOOSE_INFINITE_MAX);
    SheenLights *l = calloc(1, sizeof *l);
    SheenStatus status = l ? build(scene, split, l) : SHEEN_ERR_NOMEM;
    if (status) {
        sheen_lights_destroy(&l);
        return sheen_fail(log, status, "%s: the tables of the lights do not fit into memory", scene->name);
    }
    *out = l;
    return SHEEN_OK;
}

void sheen_lights_destroy(SheenLights **lights)
{
    if (!*lights) return;
    sheen_arena_destroy(&(*lights)->arena);
    free(*lights);
    *lights = NULL;
}

// ---- which ------------------------------------------------------------------------------------------------------

uint32_t sheen_lights_count(const SheenLights *lights)
{
    return lights->n;
}

bool sheen_light_is_delta(const SheenLights *lights, uint32_t light)
{
    SourceKind kind = lights->sources[light].kind;
    return kind == SOURCE_POINT || kind == SOURCE_SPOT || kind == SOURCE_DIRECTIONAL;
}

uint32_t sheen_lights_of_shape(const SheenLights *lights, uint32_t shape)
{
    uint32_t light = lights->scene->shapes[shape].light;
    return light == SHEEN_NONE ? SHEEN_NONE : lights->of_light[light];
}

uint32_t sheen_lights_environment(const SheenLights *lights)
{
    return lights->environment;
}

uint32_t sheen_lights_suns(const SheenLights *lights, uint32_t *first)
{
    *first = lights->first_sun;
    return lights->n_suns;
}

float sheen_lights_choose(const SheenLights *lights, Vec3 p, Vec3 n, float *u, uint32_t *light)
{
    return sheen_chooser_pick(&lights->chooser, p, n, u, light);
}

float sheen_lights_choose_probability(const SheenLights *lights, Vec3 p, Vec3 n, uint32_t light)
{
    return sheen_chooser_probability(&lights->chooser, p, n, light);
}

// ---- samples ----------------------------------------------------------------------------------------------------

static bool sample_area(const SheenScene *scene, const Source *s, Vec3 p, Vec2 u, LightSample *out)
{
    SourcePoint point;
    if (!sheen_source_sample_area(s, p, u, &point)) return false;
    Rgb radiance = s->light->radiance;
    if (s->light->texture) {
        radiance = sheen_emission_at(scene, s->light, point.triangle, point.q);
        if (rgb_is_black(radiance)) return false;
    }
    float clearance = sheen_surface_clearance(point.q, point.n, s->radius + point.distance);
    *out = (LightSample){.wi = point.wi,
                         .target = v3_mad(point.q, clearance, point.n),
                         .radiance = rgb_scale(radiance, point.solid_angle),
                         .pdf = 1.0f / point.solid_angle};
    return out->pdf > 0.0f && isfinite(out->pdf);
}

// Point, spot, projector: the inverse square of the distance is a part of what arrives, not of a density.
static bool sample_position(const SheenLight *l, Vec3 p, LightSample *out)
{
    Vec3 d = v3_sub(l->position, p);
    float d2 = v3_length2(d);
    if (!(d2 > 0.0f)) return false;
    Vec3 wi = v3_scale(d, 1.0f / sqrtf(d2));
    Rgb intensity = sheen_spot_intensity(l, v3_neg(wi));
    if (rgb_is_black(intensity)) return false;
    *out = (LightSample){
        .wi = wi, .target = l->position, .delta = true, .radiance = rgb_scale(intensity, 1.0f / d2), .pdf = 1.0f};
    return true;
}

static bool sample_environment(const EnvironmentSampler *e, Vec2 u, LightSample *out)
{
    Vec3 wi;
    Rgb radiance;
    float pdf;
    if (!sheen_environment_sampler_sample(e, u, &wi, &radiance, &pdf)) return false;
    *out = (LightSample){.wi = wi, .infinite = true, .radiance = rgb_scale(radiance, 1.0f / pdf), .pdf = pdf};
    return true;
}

static bool sample_sun(const SunDisk *sun, Vec2 u, LightSample *out)
{
    Vec3 wi = sheen_sun_disk_sample(sun, u);
    *out = (LightSample){
        .wi = wi, .infinite = true, .radiance = rgb_scale(sun->radiance, 1.0f / sun->pdf), .pdf = sun->pdf};
    return true;
}

bool sheen_light_sample(const SheenLights *lights, uint32_t light, Vec3 p, Vec2 u, LightSample *out)
{
    const Source *s = &lights->sources[light];
    switch (s->kind) {
    case SOURCE_POINT:
    case SOURCE_SPOT:
        return sample_position(s->light, p, out);
    case SOURCE_DIRECTIONAL:
        *out = (LightSample){.wi = v3_neg(s->light->direction),
                             .infinite = true,
                             .delta = true,
                             .radiance = s->light->radiance,
                             .pdf = 1.0f};
        return true;
    case SOURCE_SUN:
        return sample_sun(&s->sun, u, out);
    case SOURCE_ENVIRONMENT:
        return sample_environment(&s->environment, u, out);
    default:
        return sample_area(lights->scene, s, p, u, out);
    }
}

float sheen_light_pdf_hit(const SheenLights *lights, uint32_t light, Vec3 p, const SurfacePoint *hit)
{
    return sheen_source_pdf_area(&lights->sources[light], p, hit->p, hit->triangle);
}

float sheen_light_pdf_escape(const SheenLights *lights, uint32_t light, Vec3 wi)
{
    const Source *s = &lights->sources[light];
    if (s->kind == SOURCE_SUN) return sun_disk_covers(&s->sun, wi) ? s->sun.pdf : 0.0f;
    return sheen_environment_sampler_pdf(&s->environment, wi);
}

// ---- radiance ---------------------------------------------------------------------------------------------------

Rgb sheen_emitted(const SheenScene *scene, const SurfacePoint *s, Vec3 wo)
{
    uint32_t light = scene->shapes[s->shape].light;
    if (light == SHEEN_NONE || !(v3_dot(s->ng, wo) > 0.0f)) return rgb_gray(0.0f);
    return sheen_emission(scene, &scene->lights[light], s);
}

Rgb sheen_sun(const SheenLights *lights, uint32_t sun, Vec3 wi)
{
    const SunDisk *disk = &lights->sources[sun].sun;
    return sun_disk_covers(disk, wi) ? disk->radiance : rgb_gray(0.0f);
}

Rgb sheen_suns(const SheenLights *lights, Vec3 wi)
{
    Rgb sum = rgb_gray(0.0f);
    for (uint32_t i = 0; i < lights->n_suns; ++i) sum = rgb_add(sum, sheen_sun(lights, lights->first_sun + i, wi));
    return sum;
}

Rgb sheen_environment_soft(const SheenLights *lights, Vec3 wi)
{
    if (!(lights->soft_limit > 0.0f)) return rgb_gray(0.0f);
    Rgb radiance = sheen_environment_radiance(lights->environment_light, wi);
    float l = rgb_luminance(radiance);
    return l > lights->soft_limit ? rgb_scale(radiance, lights->soft_limit / l) : radiance;
}

Ray sheen_shadow_ray(const SurfacePoint *s, const LightSample *sample)
{
    Ray ray = sheen_surface_ray(s, sample->wi);
    if (sample->infinite) return ray;
    ray.d = v3_sub(sample->target, ray.o);
    ray.t_max = 1.0f;
    return ray;
}
