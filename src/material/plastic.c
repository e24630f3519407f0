// SPDX-License-Identifier: Apache-2.0
// A dielectric interface on a diffuse base: the reflection of the interface, smooth or rough, and the base below it,
// with all the light that goes to and fro between both. Coatings have the same interface.
// Source: jakob2010-mitsuba, plugins plastic and roughplastic
#include "material/bsdf_ops.h"
#include "material/microfacet_lobe.h"
#include "scene/coat.h"

static float interface_reflectance(const BsdfLobe *b, float cosine)
{
    float cos_t;
    return sheen_fresnel_dielectric(fabsf(cosine), b->material->ior, &cos_t);
}

// ---- the smooth interface ---------------------------------------------------------------------------------------

static Rgb coat_albedo(const BsdfLobe *b, Vec3 wo)
{
    return wo.z > 0.0f ? rgb_scale(b->reflectance, interface_reflectance(b, wo.z)) : rgb_gray(0.0f);
}

const BsdfOps sheen_lobe_coat = {.class = SHEEN_BSDF_DELTA,
                                 .layer = true,
                                 .lobes = bsdf_mirror_lobe,
                                 .albedo = coat_albedo,
                                 .importance = bsdf_albedo_importance};

// ---- the rough interface ----------------------------------------------------------------------------------------

static Rgb rough_coat_eval(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    Vec3 m;
    float d = microfacet_reflection(&b->microfacet, wo, wi, &m);
    return d > 0.0f ? rgb_scale(b->reflectance, d * interface_reflectance(b, v3_dot(wo, m))) : rgb_gray(0.0f);
}

static bool rough_coat_sample(const BsdfLobe *b, Vec3 wo, float choice, Vec2 u, BsdfSample *out)
{
    (void)choice;
    Vec3 m;
    if (!microfacet_reflection_sample(&b->microfacet, wo, u, &m, out)) return false;
    out->weight = rgb_scale(rgb_mul(out->weight, b->reflectance), interface_reflectance(b, v3_dot(wo, m)));
    return true;
}

static Rgb rough_coat_albedo(const BsdfLobe *b, Vec3 wo)
{
    return sheen_bsdf_albedo_by_samples(b, wo, 1.0f);
}

static float rough_coat_importance(const BsdfLobe *b, Vec3 wo)
{
    return wo.z > 0.0f ? rgb_max(b->reflectance) * maxf(interface_reflectance(b, wo.z), 0.01f) : 0.0f;
}

const BsdfOps sheen_lobe_rough_coat = {.class = SHEEN_BSDF_GLOSSY,
                                       .layer = true,
                                       .eval = rough_coat_eval,
                                       .pdf = microfacet_lobe_pdf,
                                       .sample = rough_coat_sample,
                                       .albedo = rough_coat_albedo,
                                       .importance = rough_coat_importance};

// ---- the base ---------------------------------------------------------------------------------------------------
// `transmittance` is what the base gains by the light that the interface sends back to it, over the index squared.

static float through(const BsdfLobe *b, float cosine)
{
    const SheenCoat *coat = b->material->coat;
    return coat ? sheen_coat_transmittance(coat, b->microfacet.alpha_u, cosine)
                : 1.0f - interface_reflectance(b, cosine);
}

static Rgb base_eval(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    float cosine = bsdf_cosine_pdf(wo, wi);
    if (!(cosine > 0.0f)) return rgb_gray(0.0f);
    return rgb_scale(rgb_mul(b->reflectance, b->transmittance), cosine * through(b, wo.z) * through(b, wi.z));
}

// The mean of the factor of wi over all directions: for the smooth interface by the symmetry of transmission,
// 1 - mean from outside = ior^2 (1 - mean from inside).
static Rgb base_albedo(const BsdfLobe *b, Vec3 wo)
{
    if (!(wo.z > 0.0f)) return rgb_gray(0.0f);
    const SheenMaterial *m = b->material;
    float mean = m->coat ? sheen_coat_mean(m->coat, b->microfacet.alpha_u) : sqrf(m->ior) * (1.0f - m->inside);
    return rgb_scale(rgb_mul(b->reflectance, b->transmittance), through(b, wo.z) * mean);
}

const BsdfOps sheen_lobe_coated_lambert = {.class = SHEEN_BSDF_DIFFUSE,
                                           .eval = base_eval,
                                           .pdf = sheen_bsdf_pdf_cosine,
                                           .sample = sheen_bsdf_sample_cosine,
                                           .albedo = base_albedo,
                                           .importance = bsdf_albedo_importance};
