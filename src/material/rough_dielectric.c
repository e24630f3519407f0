// SPDX-License-Identifier: Apache-2.0
// A rough interface of two transparent media: microfacets that reflect and refract, single scattering.
// Source: walter2007
#include "material/bsdf_ops.h"
#include "material/microfacet_lobe.h"

static float choose_reflection(const BsdfLobe *b, float f)
{
    float r = f * rgb_max(b->reflectance), t = (1.0f - f) * rgb_max(b->transmittance);
    return r + t > 0.0f ? r / (r + t) : 0.0f;
}

static Rgb rough_dielectric_eval(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    Facet t;
    if (!sheen_facet_pair(b->material->ior, wo, wi, &t)) return rgb_gray(0.0f);
    float x = sheen_microfacet_pdf(&b->microfacet, wo, t.m) * sheen_microfacet_g1(&b->microfacet, wi, t.m) *
              t.normals_per_direction;
    // As at the smooth interface, radiance from the denser side spreads: 1 / eta^2.
    return t.reflect ? rgb_scale(b->reflectance, t.f * x) : rgb_scale(b->transmittance, (1.0f - t.f) * x / sqrf(t.eta));
}

static float rough_dielectric_pdf(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    Facet t;
    if (!sheen_facet_pair(b->material->ior, wo, wi, &t)) return 0.0f;
    float p = choose_reflection(b, t.f);
    return sheen_microfacet_pdf(&b->microfacet, wo, t.m) * t.normals_per_direction * (t.reflect ? p : 1.0f - p);
}

static bool rough_dielectric_sample(const BsdfLobe *b, Vec3 wo, float choice, Vec2 u, BsdfSample *out)
{
    if (wo.z == 0.0f) return false;
    float ior = b->material->ior, f;
    Vec3 m = sheen_facet_seen(&b->microfacet, ior, wo, u, &f);
    if (!sheen_facet_send(ior, wo, m, choice < choose_reflection(b, f), &out->wi_l)) return false;
    out->pdf = rough_dielectric_pdf(b, wo, out->wi_l);
    if (!(out->pdf > 0.0f)) return false;
    out->weight = rgb_scale(rough_dielectric_eval(b, wo, out->wi_l), 1.0f / out->pdf);
    return true;
}

static Rgb rough_dielectric_albedo(const BsdfLobe *b, Vec3 wo)
{
    return sheen_bsdf_albedo_by_samples(b, wo, b->material->ior);
}

static float rough_dielectric_importance(const BsdfLobe *b, Vec3 wo)
{
    float cos_t, f = sheen_fresnel_dielectric(wo.z, b->material->ior, &cos_t);
    float x = rgb_max(rgb_mad(rgb_scale(b->reflectance, f), 1.0f - f, b->transmittance));
    return maxf(x, 0.01f * maxf(rgb_max(b->reflectance), rgb_max(b->transmittance)));
}

const BsdfOps sheen_lobe_rough_dielectric = {.class = SHEEN_BSDF_GLOSSY,
                                             .transmits = true,
                                             .eval = rough_dielectric_eval,
                                             .pdf = rough_dielectric_pdf,
                                             .sample = rough_dielectric_sample,
                                             .albedo = rough_dielectric_albedo,
                                             .importance = rough_dielectric_importance};
