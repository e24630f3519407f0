// SPDX-License-Identifier: Apache-2.0
// The modified Phong lobe: a power of the cosine to the mirror direction. Source: lafortune1994-phong
#include "material/bsdf_ops.h"
#include "math/frame.h"

// cos^n about the mirror direction, times (n + 1) / (2 pi): a density over the sphere.
static float phong_pdf(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    float n = b->material->exponent, c = v3_dot(bsdf_mirror(wo), wi);
    if (!(wo.z > 0.0f && wi.z > 0.0f && c > 0.0f)) return 0.0f;
    return powf(minf(c, 1.0f), n) * (n + 1.0f) * (0.5f * SHEEN_INV_PI);
}

// (n + 2) / (2 pi) cos^n: light that falls in perpendicularly is all reflected.
static Rgb phong_eval(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    float n = b->material->exponent;
    return rgb_scale(b->reflectance, phong_pdf(b, wo, wi) * (n + 2.0f) / (n + 1.0f) * maxf(wi.z, 0.0f));
}

static bool phong_sample(const BsdfLobe *b, Vec3 wo, float choice, Vec2 u, BsdfSample *out)
{
    (void)choice;
    if (!(wo.z > 0.0f)) return false;
    float n = b->material->exponent, c = powf(u.x, 1.0f / (n + 1.0f)), s = safe_sqrtf(1.0f - c * c);
    float phi = 2.0f * SHEEN_PI * u.y;
    Frame f = frame_from_normal(bsdf_mirror(wo));
    out->wi_l = v3_normalize(frame_to_world(&f, v3(s * cosf(phi), s * sinf(phi), c)));
    out->pdf = phong_pdf(b, wo, out->wi_l);
    if (!(out->pdf > 0.0f)) return false;
    out->weight = rgb_scale(b->reflectance, (n + 2.0f) / (n + 1.0f) * out->wi_l.z);
    return true;
}

static Rgb phong_albedo(const BsdfLobe *b, Vec3 wo)
{
    return sheen_bsdf_albedo_by_samples(b, wo, 1.0f);
}

static float phong_importance(const BsdfLobe *b, Vec3 wo)
{
    return wo.z > 0.0f ? rgb_max(b->reflectance) : 0.0f;
}

const BsdfOps sheen_lobe_phong = {.class = SHEEN_BSDF_GLOSSY,
                                  .layer = true,
                                  .eval = phong_eval,
                                  .pdf = phong_pdf,
                                  .sample = phong_sample,
                                  .albedo = phong_albedo,
                                  .importance = phong_importance};
