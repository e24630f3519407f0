// SPDX-License-Identifier: Apache-2.0
#include "light/light.h"

#include "light/choose.h"
#include "light/source.h"

#include <stdlib.h>

struct SheenLights {
    SheenArena *arena; // owns the arrays below
    uint32_t n;
    Source *sources; // [n], in the order of their kinds
    ChooseTable *choose;
    const SheenShape *shapes;
    uint32_t *of_light;                  // [scene->n_lights] index into sources, or SHEEN_NONE
    uint32_t environment;                // index into sources, or SHEEN_NONE
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

// Sources of one kind stand together, in the order of the scene: one pass for each kind.
static SheenStatus gather_sources(const SheenScene *scene, SheenEnvironmentSplit split, Source *all, SheenLights *l)
{
    for (uint32_t i = 0; i < scene->n_lights; ++i) {
        SheenStatus status = sheen_source_init(scene, &scene->lights[i], split, l->arena, &all[i]);
        if (status) return status;
        if (i == scene->environment) l->soft_limit = all[i].environment.threshold;
        l->of_light[i] = SHEEN_NONE;
    }
    for (int kind = 0; kind < SOURCE_KINDS; ++kind) {
        for (uint32_t i = 0; i < scene->n_lights; ++i) {
            if ((int)all[i].kind != kind || !can_contribute(&all[i])) continue;
            if (kind == SOURCE_ENVIRONMENT) l->environment = l->n;
            l->of_light[i] = l->n;
            l->sources[l->n++] = all[i];
        }
    }
    return SHEEN_OK;
}

static SheenStatus build(const SheenScene *scene, SheenEnvironmentSplit split, SheenLights *l)
{
    l->arena = sheen_arena_create();
    if (!l->arena) return SHEEN_ERR_NOMEM;
    l->shapes = scene->shapes;
    l->environment = SHEEN_NONE;
    if (scene->environment != SHEEN_NONE) l->environment_light = &scene->lights[scene->environment];
    l->sources = SHEEN_ARENA_NEW(l->arena, Source, scene->n_lights);
    l->of_light = SHEEN_ARENA_NEW(l->arena, uint32_t, scene->n_lights);
    Source *all = calloc(scene->n_lights ? scene->n_lights : 1, sizeof *all);
    SheenStatus status = SHEEN_ERR_NOMEM;
    if (l->sources && l->of_light && all) status = gather_sources(scene, split, all, l);
    free(all);
    return status ? status : sheen_choose_table_init(l->sources, l->n, l->arena, &l->choose);
}

SheenStatus sheen_lights_create(const SheenScene *scene, SheenEnvironmentSplit split, const SheenLog *log,
                                SheenLights **out)
{
    *out = NULL;
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

uint32_t sheen_lights_of_shape(const SheenLights *lights, uint32_t shape)
{
    uint32_t light = lights->shapes[shape].light;
    return light == SHEEN_NONE ? SHEEN_NONE : lights->of_light[light];
}

uint32_t sheen_lights_environment(const SheenLights *lights)
{
    return lights->environment;
}

float sheen_lights_choose(const SheenLights *lights, Vec3 p, Vec3 n, float *u, uint32_t *light)
{
    return sheen_choose_table_pick(lights->choose, p, n, u, light);
}

float sheen_lights_choose_probability(const SheenLights *lights, Vec3 p, Vec3 n, uint32_t light)
{
    return sheen_choose_table_probability(lights->choose, p, n, light);
}

// ---- samples ----------------------------------------------------------------------------------------------------

static bool sample_area(const Source *s, Vec3 p, Vec2 u, LightSample *out)
{
    SourcePoint point;
    if (!sheen_source_sample_area(s, p, u, &point) || !(point.pdf > 0.0f)) return false;
    Vec3 wi = v3_normalize(v3_sub(point.q, p));
    if (!(v3_dot(wi, point.n) < 0.0f)) return false;
    *out = (LightSample){.wi = wi,
                         .target = sheen_surface_offset(point.q, point.n),
                         .radiance = rgb_scale(s->light->radiance, 1.0f / point.pdf),
                         .pdf = point.pdf};
    return true;
}

// Point and spot: the inverse square of the distance is a part of what arrives, not of a density.
static bool sample_position(const SheenLight *l, Vec3 p, LightSample *out)
{
    Vec3 d = v3_sub(l->position, p);
    float d2 = v3_length2(d);
    if (!(d2 > 0.0f)) return false;
    Vec3 wi = v3_scale(d, 1.0f / sqrtf(d2));
    float falloff = l->kind == SHEEN_LIGHT_SPOT ? sheen_spot_falloff(l, -v3_dot(wi, l->direction)) : 1.0f;
    if (falloff == 0.0f) return false;
    *out = (LightSample){
        .wi = wi, .target = l->position, .delta = true, .radiance = rgb_scale(l->radiance, falloff / d2), .pdf = 1.0f};
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
    case SOURCE_ENVIRONMENT:
        return sample_environment(&s->environment, u, out);
    default:
        return sample_area(s, p, u, out);
    }
}

float sheen_light_pdf_hit(const SheenLights *lights, uint32_t light, Vec3 p, const SurfacePoint *hit)
{
    return sheen_source_pdf_area(&lights->sources[light], p, hit->p, hit->triangle);
}

float sheen_light_pdf_escape(const SheenLights *lights, uint32_t light, Vec3 wi)
{
    return sheen_environment_sampler_pdf(&lights->sources[light].environment, wi);
}

// ---- radiance ---------------------------------------------------------------------------------------------------

Rgb sheen_emitted(const SheenScene *scene, const SurfacePoint *s, Vec3 wo)
{
    uint32_t light = scene->shapes[s->shape].light;
    if (light == SHEEN_NONE || !(v3_dot(s->ng, wo) > 0.0f)) return rgb_gray(0.0f);
    return scene->lights[light].radiance;
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
