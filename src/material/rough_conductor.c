// SPDX-License-Identifier: Apache-2.0
// Metal of microfacets that are mirrors, single scattering.
#include "material/bsdf_ops.h"
#include "material/microfacet_lobe.h"

static Rgb fresnel_of(const BsdfLobe *b, float cosine)
{
    return rgb_mul(fresnel_conductor_rgb(clampf(cosine, 0.0f, 1.0f), b->material->eta, b->material->k), b->reflectance);
}

static Rgb rough_conductor_eval(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    Vec3 m;
    float d = microfacet_reflection(&b->microfacet, wo, wi, &m);
    return d > 0.0f ? rgb_scale(fresnel_of(b, v3_dot(wo, m)), d) : rgb_gray(0.0f);
}

static bool rough_conductor_sample(const BsdfLobe *b, Vec3 wo, float choice, Vec2 u, BsdfSample *out)
{
    (void)choice;
    Vec3 m;
    if (!microfacet_reflection_sample(&b->microfacet, wo, u, &m, out)) return false;
    out->weight = rgb_mul(out->weight, fresnel_of(b, v3_dot(wo, m)));
    return true;
}

static Rgb rough_conductor_albedo(const BsdfLobe *b, Vec3 wo)
{
    return sheen_bsdf_albedo_by_samples(b, wo, 1.0f);
}

static float rough_conductor_importance(const BsdfLobe *b, Vec3 wo)
{
    return wo.z > 0.0f ? maxf(rgb_max(fresnel_of(b, wo.z)), 0.01f * rgb_max(b->reflectance)) : 0.0f;
}

const BsdfOps sheen_lobe_rough_conductor = {.class = SHEEN_BSDF_GLOSSY,
                                            .eval = rough_conductor_eval,
                                            .pdf = microfacet_lobe_pdf,
                                            .sample = rough_conductor_sample,
                                            .albedo = rough_conductor_albedo,
                                            .importance = rough_conductor_importance};
