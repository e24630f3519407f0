// SPDX-License-Identifier: Apache-2.0
// The principled BSDF: a diffuse lobe with retro-reflection, sheen and a flattened variant, a microfacet lobe that is
// metal, dielectric or glass, and a clear coat. Sources: burley2012; burley2015; in the form of jakob2022-mitsuba3,
// plugin principled: its clear coat has no 1 / (4 cos cos), and its sheen is not divided by pi.
#include "material/bsdf_ops.h"
#include "material/microfacet_lobe.h"
#include "material/principled_lobe.h"

// Shares of the light that is not reflected like a metal's.
static float opaque_share(const BsdfLobe *b)
{
    return (1.0f - b->principled.metallic) * (1.0f - b->principled.spec_trans);
}
static float glass_share(const BsdfLobe *b)
{
    return (1.0f - b->principled.metallic) * b->principled.spec_trans;
}

static float schlick_weight(float cosine)
{
    float m = clampf(1.0f - cosine, 0.0f, 1.0f);
    return sqrf(sqrf(m)) * m;
}

// Schlick's reflectance from r0, for either side of an interface: from the denser one by the refracted cosine.
static float schlick_share(float cosine, float eta)
{
    float relative = cosine >= 0.0f ? eta : 1.0f / eta;
    float c_t = safe_sqrtf(1.0f - (1.0f - cosine * cosine) / sqrf(relative));
    return schlick_weight(relative > 1.0f ? fabsf(cosine) : c_t);
}

static Rgb schlick(Rgb r0, float cosine, float eta)
{
    return rgb_mad(r0, schlick_share(cosine, eta), rgb_sub(rgb_gray(1.0f), r0));
}

static Rgb mix(Rgb a, Rgb b, float t)
{
    return rgb_mad(rgb_scale(a, 1.0f - t), t, b);
}

// The base colour at luminance 1.
static Rgb tint_of(Rgb base)
{
    float l = rgb_luminance(base);
    return l > 0.0f ? rgb_scale(base, 1.0f / l) : rgb_gray(1.0f);
}

// ---- diffuse ----------------------------------------------------------------------------------------------------

static Rgb diffuse_eval(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    if (!(wo.z > 0.0f && wi.z > 0.0f)) return rgb_gray(0.0f);
    float Fo = schlick_weight(wo.z), Fi = schlick_weight(wi.z), cos_d = v3_dot(bsdf_half(wo, wi), wi);
    float retro_scale = 2.0f * b->principled.roughness * cos_d * cos_d;
    float smooth = (1.0f - 0.5f * Fi) * (1.0f - 0.5f * Fo);
    float retro = retro_scale * (Fo + Fi + Fo * Fi * (retro_scale - 1.0f));
    float f = smooth + retro;
    if (b->principled.flatness > 0.0f) { // of a medium below, after Hanrahan and Krueger
        float ss90 = 0.5f * retro_scale, ss = lerpf(1.0f, ss90, Fo) * lerpf(1.0f, ss90, Fi);
        f = lerpf(f, 1.25f * (ss * (1.0f / (wo.z + wi.z) - 0.5f) + 0.5f), b->principled.flatness);
    }
    Rgb value = rgb_scale(b->reflectance, opaque_share(b) * f * SHEEN_INV_PI);
    // Where all is glass, the sheen is left out with the rest of this lobe.
    if (b->principled.sheen > 0.0f && opaque_share(b) > 0.0f) {
        Rgb tint = mix(rgb_gray(1.0f), tint_of(b->reflectance), b->principled.sheen_tint);
        value =
            rgb_mad(value, b->principled.sheen * (1.0f - b->principled.metallic) * schlick_weight(fabsf(cos_d)), tint);
    }
    return rgb_scale(value, wi.z);
}

static float diffuse_importance(const BsdfLobe *b, Vec3 wo)
{
    if (!(wo.z > 0.0f)) return 0.0f;
    return opaque_share(b) * (rgb_max(b->reflectance) + 0.3f * b->principled.sheen);
}

const BsdfOps sheen_lobe_principled_diffuse = {.class = SHEEN_BSDF_DIFFUSE,
                                               .eval = diffuse_eval,
                                               .pdf = sheen_bsdf_pdf_cosine,
                                               .sample = sheen_bsdf_sample_cosine,
                                               .albedo = sheen_bsdf_albedo_of_diffuse,
                                               .importance = diffuse_importance};

// ---- specular ---------------------------------------------------------------------------------------------------

Rgb sheen_principled_fresnel(const BsdfLobe *b, float F, float cosine)
{
    float eta = b->material->ior, metallic = b->principled.metallic, tint = b->principled.spec_tint;
    Rgb sum = rgb_gray((1.0f - metallic) * (1.0f - tint) * F);
    if (metallic > 0.0f) sum = rgb_mad(sum, metallic, schlick(b->reflectance, cosine, eta));
    if (tint > 0.0f) {
        Rgb r0 = rgb_scale(tint_of(b->reflectance), sqrf((eta - 1.0f) / (eta + 1.0f)));
        sum = rgb_mad(sum, (1.0f - metallic) * tint, schlick(r0, cosine, eta));
    }
    return sum;
}

void sheen_principled_fresnel_terms(float ior, float cosine, float terms[SHEEN_FRESNEL_TERMS])
{
    float cos_t;
    terms[SHEEN_FRESNEL_EXACT] = sheen_fresnel_dielectric(cosine, ior, &cos_t);
    terms[SHEEN_FRESNEL_ONE] = 1.0f;
    terms[SHEEN_FRESNEL_SCHLICK] = schlick_share(cosine, ior);
}

void sheen_principled_fresnel_factors(const BsdfLobe *b, Rgb factors[SHEEN_FRESNEL_TERMS])
{
    float eta = b->material->ior, metallic = b->principled.metallic, tint = b->principled.spec_tint;
    Rgb one = rgb_gray(1.0f), r0 = rgb_scale(tint_of(b->reflectance), sqrf((eta - 1.0f) / (eta + 1.0f)));
    factors[SHEEN_FRESNEL_EXACT] = rgb_gray((1.0f - metallic) * (1.0f - tint));
    factors[SHEEN_FRESNEL_ONE] = mix(rgb_scale(r0, tint), b->reflectance, metallic);
    factors[SHEEN_FRESNEL_SCHLICK] = mix(rgb_scale(rgb_sub(one, r0), tint), rgb_sub(one, b->reflectance), metallic);
}

// From behind there is only glass, without tint or metal.
static Rgb fresnel_of(const BsdfLobe *b, float F, float cosine, bool front)
{
    return front ? sheen_principled_fresnel(b, F, cosine) : rgb_gray(glass_share(b) * F);
}

static Rgb refracted_color(const BsdfLobe *b)
{
    Rgb c = b->reflectance;
    return rgb_scale(rgb(sqrtf(c.r), sqrtf(c.g), sqrtf(c.b)), glass_share(b));
}

// Probability of reflection at a microfacet of reflectance F.
static float choose_reflection(const BsdfLobe *b, float F, bool front)
{
    float glass = glass_share(b);
    if (!(glass > 0.0f)) return 1.0f;
    return front ? 1.0f - glass * (1.0f - F) : F;
}

// Metal and tinted dielectric are opaque: without glass there is reflection from the front only.
static bool facet_of(const BsdfLobe *b, Vec3 wo, Vec3 wi, Facet *t)
{
    if (!(glass_share(b) > 0.0f) && !(wo.z > 0.0f && wi.z > 0.0f)) return false;
    return sheen_facet_pair(b->material->ior, wo, wi, t);
}

static Rgb specular_eval(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    Facet t;
    if (!facet_of(b, wo, wi, &t)) return rgb_gray(0.0f);
    float x = sheen_microfacet_pdf(&b->microfacet, wo, t.m) * sheen_microfacet_g1(&b->microfacet, wi, t.m) *
              t.normals_per_direction;
    if (t.reflect) return rgb_scale(fresnel_of(b, t.f, t.o, wo.z > 0.0f), x);
    return rgb_scale(refracted_color(b), (1.0f - t.f) * x / sqrf(t.eta));
}

static float specular_pdf(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    Facet t;
    if (!facet_of(b, wo, wi, &t)) return 0.0f;
    float p = choose_reflection(b, t.f, wo.z > 0.0f);
    return sheen_microfacet_pdf(&b->microfacet, wo, t.m) * t.normals_per_direction * (t.reflect ? p : 1.0f - p);
}

static bool specular_sample(const BsdfLobe *b, Vec3 wo, float choice, Vec2 u, BsdfSample *out)
{
    if (wo.z == 0.0f || (wo.z < 0.0f && !(glass_share(b) > 0.0f))) return false;
    float ior = b->material->ior, F;
    Vec3 m = sheen_facet_seen(&b->microfacet, ior, wo, u, &F);
    bool reflect = choice < choose_reflection(b, F, wo.z > 0.0f);
    if (!sheen_facet_send(ior, wo, m, reflect, &out->wi_l)) return false;
    out->pdf = specular_pdf(b, wo, out->wi_l);
    if (!(out->pdf > 0.0f)) return false;
    out->weight = rgb_scale(specular_eval(b, wo, out->wi_l), 1.0f / out->pdf);
    return true;
}

static Rgb any_albedo(const BsdfLobe *b, Vec3 wo)
{
    return sheen_bsdf_albedo_by_samples(b, wo, b->material->ior);
}

static float specular_importance(const BsdfLobe *b, Vec3 wo)
{
    float cos_t, F = sheen_fresnel_dielectric(wo.z, b->material->ior, &cos_t);
    if (wo.z < 0.0f) return glass_share(b);
    return maxf(rgb_max(fresnel_of(b, F, wo.z, true)) + (1.0f - F) * rgb_max(refracted_color(b)), 0.02f);
}

const BsdfOps sheen_lobe_principled_specular = {.class = SHEEN_BSDF_GLOSSY,
                                                .transmits = true,
                                                .eval = specular_eval,
                                                .pdf = specular_pdf,
                                                .sample = specular_sample,
                                                .albedo = any_albedo,
                                                .importance = specular_importance};

// ---- clear coat -------------------------------------------------------------------------------------------------
// Distribution GTR1 of roughness alpha = microfacet.alpha_u < 1; masking as of GGX with alpha 0.25.

static const Microfacet coat_masking = {SHEEN_DISTRIBUTION_GGX, 0.25f, 0.25f};

static float gtr1(float alpha, Vec3 m)
{
    float a2 = alpha * alpha;
    return (a2 - 1.0f) / (SHEEN_PI * logf(a2) * (1.0f + (a2 - 1.0f) * m.z * m.z));
}

static Rgb clearcoat_eval(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    if (!(wo.z > 0.0f && wi.z > 0.0f)) return rgb_gray(0.0f);
    Vec3 m = bsdf_half(wo, wi);
    float g = sheen_microfacet_g1(&coat_masking, wo, m) * sheen_microfacet_g1(&coat_masking, wi, m);
    float F = schlick(rgb_gray(0.04f), v3_dot(wo, m), b->material->ior).r;
    return rgb_gray(0.25f * b->principled.clearcoat * F * gtr1(b->microfacet.alpha_u, m) * g * wi.z);
}

static float clearcoat_pdf(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    if (!(wo.z > 0.0f && wi.z > 0.0f)) return 0.0f;
    Vec3 m = bsdf_half(wo, wi);
    return gtr1(b->microfacet.alpha_u, m) * m.z / (4.0f * fabsf(v3_dot(wo, m)));
}

static bool clearcoat_sample(const BsdfLobe *b, Vec3 wo, float choice, Vec2 u, BsdfSample *out)
{
    (void)choice;
    if (!(wo.z > 0.0f)) return false;
    float a2 = sqrf(b->microfacet.alpha_u), c2 = (1.0f - powf(a2, 1.0f - u.x)) / (1.0f - a2);
    float c = safe_sqrtf(c2), s = safe_sqrtf(1.0f - c2), phi = 2.0f * SHEEN_PI * u.y;
    Vec3 m = v3(s * cosf(phi), s * sinf(phi), c);
    out->wi_l = v3_normalize(v3_reflect(wo, m));
    out->pdf = v3_dot(wo, m) > 0.0f ? clearcoat_pdf(b, wo, out->wi_l) : 0.0f;
    if (!(out->pdf > 0.0f) || !isfinite(out->pdf)) return false;
    out->weight = rgb_scale(clearcoat_eval(b, wo, out->wi_l), 1.0f / out->pdf);
    return true;
}

static float clearcoat_importance(const BsdfLobe *b, Vec3 wo)
{
    return wo.z > 0.0f ? b->principled.clearcoat * (0.04f + 0.25f * schlick_weight(wo.z)) : 0.0f;
}

const BsdfOps sheen_lobe_principled_clearcoat = {.class = SHEEN_BSDF_GLOSSY,
                                                 .layer = true,
                                                 .eval = clearcoat_eval,
                                                 .pdf = clearcoat_pdf,
                                                 .sample = clearcoat_sample,
                                                 .albedo = any_albedo,
                                                 .importance = clearcoat_importance};
