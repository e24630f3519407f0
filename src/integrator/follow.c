// SPDX-License-Identifier: Apache-2.0
#include "integrator/follow.h"

#include "scene/passage.h"

bool sheen_set_point(const SurfacePoint *s, bool front, Rgb reflectance, DiffusePoint *out)
{
    Vec3 ng = front ? s->ng : v3_neg(s->ng), n = front ? s->ns : v3_neg(s->ns);
    *out = (DiffusePoint){s->p, sheen_surface_leave(s, ng), ng, n, n, reflectance};
    return !rgb_is_black(reflectance);
}

void sheen_bend_point(const Bsdf *bsdf, const Frame *frame, Vec3 wo_l, DiffusePoint *point)
{
    Vec3 n_l;
    if (!sheen_bsdf_is_mapped(bsdf)) return;
    sheen_bsdf_diffuse(bsdf, wo_l, &n_l);
    point->bent = frame_to_world(frame, n_l);
}

bool sheen_lambertian_point(const SheenScene *scene, const SheenMaterial *material, const SurfacePoint *s, Vec3 wo,
                            DiffusePoint *out)
{
    bool front = v3_dot(wo, s->ng) >= 0.0f;
    if (!front && !material->two_sided) return false;
    const SheenTexture *t = &material->reflectance;
    Rgb c = t->kind == SHEEN_TEXTURE_CONSTANT ? t->value : sheen_surface_texture(scene, t, s);
    return sheen_set_point(s, front, rgb_unit(c), out);
}

// A rough reflection at least so wide is nearly the same from everywhere, next to all else that a gather blurs.
static const float wide_roughness = 0.2f;
// Of a highlight narrower than this a light sample seldom finds what it sends.
static const float lit_roughness = 0.1f;

static bool goes_on(const BsdfSample *s)
{
    if (s->layer) return false;
    return s->delta || s->roughness < wide_roughness;
}

Vec3 sheen_seen_from(const SurfacePoint *s, const Frame *frame, Vec3 wo)
{
    const float grazing = 1e-3f;
    Vec3 wo_l = frame_to_local(frame, wo);
    bool front = v3_dot(wo, s->ng) >= 0.0f;
    if (front == (wo_l.z > 0.0f) && wo_l.z != 0.0f) return wo_l;
    return v3_normalize(v3(wo_l.x, wo_l.y, front ? grazing : -grazing));
}

SheenStep sheen_step(const SurfacePoint *s, const Bsdf *bsdf, Vec3 wo, SheenSampler *sampler, Rgb *throughput,
                     Ray *next, DiffusePoint *point)
{
    Frame frame = frame_from_normal(s->ns);
    BsdfSample sample;
    float lobe = sampler_1d(sampler);
    Vec2 u = sheen_bsdf_is_delta(bsdf) ? v2(0.5f, 0.5f) : sampler_2d(sampler);
    Vec3 wo_l = sheen_seen_from(s, &frame, wo);
    if (!sheen_bsdf_sample(bsdf, wo_l, lobe, u, &sample)) return SHEEN_STEP_ENDS;
    if (!rgb_finite(sample.weight) || rgb_is_black(sample.weight)) return SHEEN_STEP_ENDS;
    if (sample.passage) {
        *throughput = rgb_mul(*throughput, sample.weight);
        *next = sheen_surface_ray(s, v3_neg(wo));
        return SHEEN_STEP_PASSES;
    }
    Vec3 wi = frame_to_world(&frame, sample.wi_l);
    bool through = sample.wi_l.z * v3_dot(wi, s->ng) <= 0.0f; // the side that the shading normal alone denies
    if (!goes_on(&sample)) {
        bool front = (v3_dot(wo, s->ng) >= 0.0f) != sample.transmit;
        bool turns = sample.roughness < 1.0f;
        if ((turns && through) || !sheen_set_point(s, front, sample.weight, point)) return SHEEN_STEP_ENDS;
        *next = sheen_surface_ray(s, wi);
        if (turns) return SHEEN_STEP_TURNS;
        if (!sample.transmit) sheen_bend_point(bsdf, &frame, wo_l, point);
        // Of a mapped surface some directions were absorbed above, those below its plane. What asks for its light
        // knows.
        point->reflectance = rgb_scale(point->reflectance, 1.0f / diffuse_point_open(point));
        return SHEEN_STEP_SCATTERS;
    }
    if (through) return SHEEN_STEP_ENDS;
    *throughput = rgb_mul(*throughput, sample.weight);
    *next = sheen_surface_ray(s, wi);
    return SHEEN_STEP_GOES_ON;
}

void sheen_follow(const SheenWork *work, const Ray *ray, const Hit *hit, SheenSampler *sampler, uint64_t *specular_rays,
                  Followed *out)
{
    Ray next;
    Hit next_hit;
    *out = (Followed){.throughput = rgb_gray(1.0f)};
    for (;;) {
        out->direction = ray->d;
        if (hit->shape == SHEEN_NONE) {
            out->escaped = true;
            out->distance = INFINITY;
            return;
        }
        SurfacePoint s;
        sheen_surface_from_hit(work->scene, ray, hit, &s);
        Vec3 wo = v3_neg(ray->d);
        out->distance += hit->t;
        out->emitted = sheen_emitted(work->scene, &s, wo);
        const SheenMaterial *lambertian = sheen_lambertian(work->scene, &s);
        if (lambertian) {
            out->scatters = sheen_lambertian_point(work->scene, lambertian, &s, wo, &out->point);
            return;
        }
        Bsdf bsdf;
        sheen_bsdf_look_up(work->scene, &s, &bsdf);
        out->glossy = sheen_bsdf_is_rough(&bsdf, wide_roughness, lit_roughness);
        if (out->glossy) out->surface = s;
        Rgb found = out->specular > 0 ? rgb_mul(out->throughput, out->emitted) : rgb_gray(0.0f);
        SheenStep step = sheen_step(&s, &bsdf, wo, sampler, &out->throughput, &next, &out->point);
        out->turns = step == SHEEN_STEP_TURNS;
        if (out->turns) out->onward = next.d;
        out->scatters = step == SHEEN_STEP_SCATTERS || out->turns;
        if (out->scatters || step == SHEEN_STEP_ENDS) return;
        out->passed = rgb_add(out->passed, found);
        out->emitted = rgb_gray(0.0f);
        if (step == SHEEN_STEP_PASSES ? out->passages++ == SHEEN_PASSAGES_MAX : out->specular++ == SHEEN_SPECULAR_MAX)
            return;
        sheen_accel_intersect(work->accel, &next, &next_hit);
        ray = &next;
        hit = &next_hit;
        ++*specular_rays;
    }
}
