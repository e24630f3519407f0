// SPDX-License-Identifier: Apache-2.0
#include "integrator/glossy.h"

#include "integrator/mis.h"

void sheen_seen_surface(const SheenWork *work, Vec3 wo, SeenSurface *out)
{
    out->frame = frame_from_normal(out->s.ns);
    out->wo_l = sheen_seen_from(&out->s, &out->frame, wo);
    out->side = v3_dot(wo, out->s.ng) >= 0.0f ? out->s.ng : v3_neg(out->s.ng);
    sheen_bsdf_look_up(work->scene, &out->s, &out->bsdf);
    out->both_sides = sheen_bsdf_transmits(&out->bsdf);
    out->cached = false;
}

// What rays along the glossy part find.
static const Bsdf *sampled(const SeenSurface *v)
{
    return v->cached ? &v->rest : &v->bsdf;
}

// f |cos| of the glossy part, the share that rays along it find better taken off.
// @param expected  density of the light samples
static Rgb glossy_share(const SeenSurface *v, Vec3 wi_l, bool delta, float expected)
{
    Rgb all = sheen_bsdf_eval_of(&v->bsdf, SHEEN_BSDF_GLOSSY, v->wo_l, wi_l);
    if (delta || rgb_is_black(all)) return all;
    float found = sheen_bsdf_pdf_of(sampled(v), SHEEN_BSDF_GLOSSY, v->wo_l, wi_l);
    float share = power_heuristic(expected, found);
    if (!v->cached) return rgb_scale(all, share);
    Rgb rest = sheen_bsdf_eval_of(&v->rest, SHEEN_BSDF_GLOSSY, v->wo_l, wi_l);
    return rgb_mad(rgb_sub(all, rest), share, rest);
}

// Light samples that go to `light` from a point, in the mean.
static float samples_expected(const SheenLights *lights, LightPlan plan, const GlossyOrigin *o, uint32_t light)
{
    if (plan.each > 0) return (float)plan.samples;
    return (float)plan.samples * choose_light_probability(lights, o->p, o->side, o->both_sides, light);
}

// One of `samples` light samples.
static Rgb light_sample(const SheenWork *work, const SeenSurface *v, LightNumbers numbers, uint32_t samples,
                        SheenStats *stats)
{
    uint32_t light = numbers.light;
    float choice = 1.0f;
    LightSample ls;
    if (light == SHEEN_NONE)
        choice = choose_light(work->lights, v->s.p, v->side, v->both_sides, numbers.choice, &light);
    if (!(choice > 0.0f) || !sheen_light_sample(work->lights, light, v->s.p, numbers.place, &ls)) return rgb_gray(0.0f);
    Vec3 wi_l = frame_to_local(&v->frame, ls.wi);
    if (!(wi_l.z * v3_dot(ls.wi, v->s.ng) > 0.0f)) return rgb_gray(0.0f);
    Rgb f = glossy_share(v, wi_l, ls.delta, (float)samples * choice * ls.pdf);
    f = rgb_add(f, sheen_bsdf_eval_of(&v->bsdf, SHEEN_BSDF_DIFFUSE, v->wo_l, wi_l));
    if (rgb_is_black(f)) return f;
    Ray shadow = sheen_shadow_ray(&v->s, &ls);
    ++stats->rays_shadow;
    float through = sheen_accel_transmittance(work->accel, &shadow);
    if (through == 0.0f) return rgb_gray(0.0f);
    return rgb_scale(rgb_mul(f, ls.radiance), through / (choice * (float)samples));
}

Rgb sheen_glossy_lit(const SheenWork *work, const SeenSurface *v, uint32_t branch, uint32_t pixel, uint32_t sample,
                     SheenStats *stats)
{
    Rgb L = rgb_gray(0.0f);
    if (sheen_lights_count(work->lights) == 0) return L;
    LightPlan plan = sheen_light_plan(work);
    LightSequence from = sheen_light_sequence(work, plan, branch, pixel, sample);
    uint32_t turns = plan.each ? plan.each : 1;
    for (uint32_t turn = 0; turn < turns; ++turn) {
        uint32_t light = plan.each ? turn : SHEEN_NONE;
        uint32_t n = plan.each && sheen_light_is_delta(work->lights, light) ? 1 : plan.samples;
        for (uint32_t j = 0; j < n; ++j)
            L = rgb_add(L, light_sample(work, v, sheen_light_numbers(from.key, from.index + j, light), n, stats));
    }
    return L;
}

Rgb sheen_glossy_lit_once(const SheenWork *work, const SurfacePoint *s, Vec3 wo, LightNumbers numbers,
                          SheenStats *stats)
{
    SeenSurface v;
    v.s = *s;
    sheen_seen_surface(work, wo, &v);
    v.cached = true; // nothing is left to rays
    v.rest.n_lobes = 0;
    return light_sample(work, &v, numbers, 1, stats);
}

bool sheen_glossy_ray(const SeenSurface *v, SheenSampler *sampler, Ray *ray, Rgb *weight, float *roughness,
                      GlossyOrigin *origin)
{
    BsdfSample sample;
    float lobe = sampler_1d(sampler);
    if (!sheen_bsdf_sample_of(sampled(v), SHEEN_BSDF_GLOSSY, v->wo_l, lobe, sampler_2d(sampler), &sample)) return false;
    Vec3 wi = frame_to_world(&v->frame, sample.wi_l);
    if (!(sample.wi_l.z * v3_dot(wi, v->s.ng) > 0.0f) || !rgb_finite(sample.weight)) return false;
    *ray = sheen_surface_ray(&v->s, wi);
    *weight = sample.weight;
    *roughness = sample.roughness;
    *origin = (GlossyOrigin){v->s.p, v->side, sample.pdf, v->both_sides};
    return true;
}

static float share_found(const SheenWork *work, const GlossyOrigin *o, uint32_t light, float pdf_light)
{
    return power_heuristic(o->pdf, samples_expected(work->lights, sheen_light_plan(work), o, light) * pdf_light);
}

Rgb sheen_glossy_found(const SheenWork *work, const GlossyOrigin *origin, const SurfacePoint *s, Vec3 wo)
{
    Rgb L = sheen_emitted(work->scene, s, wo);
    uint32_t light = sheen_lights_of_shape(work->lights, s->shape);
    if (rgb_is_black(L) || light == SHEEN_NONE) return L;
    return rgb_scale(L, share_found(work, origin, light, sheen_light_pdf_hit(work->lights, light, origin->p, s)));
}

Rgb sheen_glossy_found_sky(const SheenWork *work, const GlossyOrigin *origin, Vec3 wi)
{
    Rgb all = sheen_environment(work->scene, wi), soft = sheen_environment_soft(work->lights, wi);
    uint32_t light = sheen_lights_environment(work->lights), first, n = sheen_lights_suns(work->lights, &first);
    if (!rgb_is_black(all) && light != SHEEN_NONE) {
        float share = share_found(work, origin, light, sheen_light_pdf_escape(work->lights, light, wi));
        all = rgb_mad(soft, share, rgb_sub(all, soft)); // the soft part is left to rays
    }
    for (uint32_t sun = first; sun < first + n; ++sun) {
        Rgb L = sheen_sun(work->lights, sun, wi);
        if (rgb_is_black(L)) continue;
        all = rgb_mad(all, share_found(work, origin, sun, sheen_light_pdf_escape(work->lights, sun, wi)), L);
    }
    return all;
}
