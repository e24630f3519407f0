// SPDX-License-Identifier: Apache-2.0
// The principled BSDF of a sheet without thickness: its rough reflection, and its rough transmission, which is that
// reflection, tinted, seen through the sheet. Both have the surface's front where the viewer is. The diffuse parts are
// those of the principled BSDF and of Lambert. Sources: burley2015; jakob2022-mitsuba3, plugin principledthin.
#include "material/microfacet_lobe.h"
#include "material/principled_lobe.h"

static Vec3 through(Vec3 w)
{
    return v3(w.x, w.y, -w.z);
}

static float fresnel_at(const BsdfLobe *b, float cosine)
{
    float cos_t;
    return sheen_fresnel_dielectric(cosine, b->material->ior, &cos_t);
}

// ---- reflection -------------------------------------------------------------------------------------------------

static Rgb reflect_eval(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    Vec3 m;
    float x = microfacet_reflection(&b->microfacet, wo, wi, &m);
    if (!(x > 0.0f)) return rgb_gray(0.0f);
    float cosine = v3_dot(wo, m);
    return rgb_scale(sheen_principled_fresnel(b, fresnel_at(b, cosine), cosine), x);
}

static bool reflect_sample(const BsdfLobe *b, Vec3 wo, float choice, Vec2 u, BsdfSample *out)
{
    (void)choice;
    Vec3 m;
    if (!microfacet_reflection_sample(&b->microfacet, wo, u, &m, out)) return false;
    float cosine = v3_dot(wo, m);
    out->weight = rgb_mul(out->weight, sheen_principled_fresnel(b, fresnel_at(b, cosine), cosine));
    return true;
}

static Rgb any_albedo(const BsdfLobe *b, Vec3 wo)
{
    return sheen_bsdf_albedo_by_samples(b, wo, 1.0f);
}

static float reflect_importance(const BsdfLobe *b, Vec3 wo)
{
    return wo.z > 0.0f ? maxf(rgb_max(sheen_principled_fresnel(b, fresnel_at(b, wo.z), wo.z)), 0.02f) : 0.0f;
}

const BsdfOps sheen_lobe_thin_reflection = {.class = SHEEN_BSDF_GLOSSY,
                                            .eval = reflect_eval,
                                            .pdf = microfacet_lobe_pdf,
                                            .sample = reflect_sample,
                                            .albedo = any_albedo,
                                            .importance = reflect_importance};

// ---- transmission -----------------------------------------------------------------------------------------------

// As in Mitsuba, light that its microfacet would see on its own side is left out. It is not reciprocal by that.
static bool goes_through(Vec3 wi, Vec3 m)
{
    return v3_dot(wi, m) < 0.0f;
}

static Rgb transmit_eval(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    Vec3 m;
    float x = microfacet_reflection(&b->microfacet, wo, through(wi), &m);
    if (!(x > 0.0f) || !goes_through(wi, m)) return rgb_gray(0.0f);
    return rgb_scale(b->reflectance, (1.0f - fresnel_at(b, v3_dot(wo, m))) * x);
}

static float transmit_pdf(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    Vec3 other = through(wi);
    return wo.z > 0.0f && goes_through(wi, bsdf_half(wo, other)) ? microfacet_lobe_pdf(b, wo, other) : 0.0f;
}

static bool transmit_sample(const BsdfLobe *b, Vec3 wo, float choice, Vec2 u, BsdfSample *out)
{
    (void)choice;
    Vec3 m;
    if (!microfacet_reflection_sample(&b->microfacet, wo, u, &m, out)) return false;
    out->wi_l = through(out->wi_l);
    if (!goes_through(out->wi_l, m)) return false;
    out->weight = rgb_mul(out->weight, rgb_scale(b->reflectance, 1.0f - fresnel_at(b, v3_dot(wo, m))));
    return true;
}

static float transmit_importance(const BsdfLobe *b, Vec3 wo)
{
    return wo.z > 0.0f ? maxf((1.0f - fresnel_at(b, wo.z)) * rgb_max(b->reflectance), 0.02f) : 0.0f;
}

const BsdfOps sheen_lobe_thin_transmission = {.class = SHEEN_BSDF_GLOSSY,
                                              .transmits = true,
                                              .eval = transmit_eval,
                                              .pdf = transmit_pdf,
                                              .sample = transmit_sample,
                                              .albedo = any_albedo,
                                              .importance = transmit_importance};
