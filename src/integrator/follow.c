// SPDX-License-Identifier: Apache-2.0
#include "integrator/follow.h"

// A point on the side of a surface that wo is on. @return false when it is black
static inline bool set_point(const SurfacePoint *s, bool front, Rgb reflectance, DiffusePoint *out)
{
    Vec3 ng = front ? s->ng : v3_neg(s->ng), n = front ? s->ns : v3_neg(s->ns);
    *out = (DiffusePoint){s->p, sheen_surface_leave(s, ng), ng, n, reflectance};
    return !rgb_is_black(reflectance);
}

bool sheen_diffuse_point(const SurfacePoint *s, const Bsdf *bsdf, Vec3 wo, DiffusePoint *out)
{
    bool front = v3_dot(wo, s->ng) >= 0.0f;
    return set_point(s, front, sheen_bsdf_diffuse(bsdf, v3(0.0f, 0.0f, front ? 1.0f : -1.0f), NULL), out);
}

static float unit_or_zero(float x) // a NaN becomes 0
{
    return x > 0.0f ? minf(x, 1.0f) : 0.0f;
}

bool sheen_lambertian_point(const SheenMaterial *material, const SurfacePoint *s, Vec3 wo, DiffusePoint *out)
{
    bool front = v3_dot(wo, s->ng) >= 0.0f;
    if (!front && !material->two_sided) return false;
    const SheenTexture *t = &material->reflectance;
    Rgb c = t->kind == SHEEN_TEXTURE_CONSTANT ? t->value : sheen_texture_eval(t, s->uv);
    return set_point(s, front, rgb(unit_or_zero(c.r), unit_or_zero(c.g), unit_or_zero(c.b)), out);
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
            out->scatters = sheen_lambertian_point(lambertian, &s, wo, &out->point);
            return;
        }
        Bsdf bsdf;
        sheen_bsdf_look_up(work->scene, &s, &bsdf);
        sheen_bsdf_simplify(&bsdf);
        if (!sheen_bsdf_is_delta(&bsdf)) {
            out->scatters = sheen_diffuse_point(&s, &bsdf, wo, &out->point);
            return;
        }
        if (out->specular++ == SHEEN_SPECULAR_MAX) return;
        Frame frame = frame_from_normal(s.ns);
        BsdfSample sample;
        float lobe = sampler_1d(sampler);
        if (!sheen_bsdf_sample(&bsdf, frame_to_local(&frame, wo), lobe, v2(0.5f, 0.5f), &sample)) return;
        out->throughput = rgb_mul(out->throughput, sample.weight);
        if (rgb_is_black(out->throughput)) return;
        next = sheen_surface_ray(&s, frame_to_world(&frame, sample.wi_l));
        sheen_accel_intersect(work->accel, &next, &next_hit);
        ray = &next;
        hit = &next_hit;
        ++*specular_rays;
    }
}
