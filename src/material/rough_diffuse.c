// SPDX-License-Identifier: Apache-2.0
// Rough plaster and clay: V-shaped grooves of Lambertian facets that mask, shadow and light each other.
// Sources: orennayar1994, the fits with (full) and without (fast) light between facets; jakob2010-mitsuba, plugin
// roughdiffuse: the standard deviation of the slope's angle is the roughness alpha over the square root of 2.
#include "material/bsdf_ops.h"

/** What both fits are made of. */
typedef struct Pair {
    float sigma2;                     // variance of the facets' angle
    float cos_phi;                    // of the angle between both directions about the normal
    float alpha, beta;                // the larger and the smaller angle from the normal
    float sin_alpha, tan_beta, tan_2; // tan_2 of half their sum
} Pair;

static Pair pair_of(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    Pair p = {.sigma2 = 0.5f * sqrf(b->microfacet.alpha_u)};
    float cos_alpha = maxf(minf(wo.z, wi.z), 1e-6f), cos_beta = clampf(maxf(wo.z, wi.z), 1e-6f, 1.0f);
    float sin_beta = safe_sqrtf(1.0f - cos_beta * cos_beta);
    p.sin_alpha = safe_sqrtf(1.0f - cos_alpha * cos_alpha);
    p.alpha = acosf(cos_alpha), p.beta = acosf(cos_beta);
    p.tan_beta = sin_beta / cos_beta;
    p.tan_2 = (p.sin_alpha + sin_beta) / (cos_alpha + cos_beta);
    float both = p.sin_alpha * sin_beta;
    p.cos_phi = both > 1e-8f ? clampf((wo.x * wi.x + wo.y * wi.y) / both, -1.0f, 1.0f) : 0.0f;
    return p;
}

/** @return pi f of a white surface, by the fit without light between facets */
static float fast_fit(const Pair *p)
{
    float a = 1.0f - 0.5f * p->sigma2 / (p->sigma2 + 0.33f), b = 0.45f * p->sigma2 / (p->sigma2 + 0.09f);
    return a + b * maxf(p->cos_phi, 0.0f) * p->sin_alpha * p->tan_beta;
}

/** pi f = reflectance * *once + reflectance^2 * the result: light that met one facet, and two. */
static float full_fit(const Pair *p, float *once)
{
    float s = p->sigma2 / (p->sigma2 + 0.09f), b = 2.0f * SHEEN_INV_PI * p->beta;
    float ab = 4.0f * SHEEN_INV_PI * SHEEN_INV_PI * p->alpha * p->beta;
    float c1 = 1.0f - 0.5f * p->sigma2 / (p->sigma2 + 0.33f);
    float c2 = 0.45f * s * (p->cos_phi >= 0.0f ? p->sin_alpha : p->sin_alpha - b * b * b);
    float c3 = 0.125f * s * ab * ab;
    *once = c1 + c2 * p->cos_phi * p->tan_beta + c3 * (1.0f - fabsf(p->cos_phi)) * p->tan_2;
    return 0.17f * p->sigma2 / (p->sigma2 + 0.13f) * (1.0f - p->cos_phi * b * b);
}

static Rgb rough_diffuse_eval(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    if (!(wo.z > 0.0f && wi.z > 0.0f)) return rgb_gray(0.0f);
    Pair p = pair_of(b, wo, wi);
    float once, twice = 0.0f;
    if (b->material->fast)
        once = fast_fit(&p);
    else
        twice = full_fit(&p, &once);
    once = maxf(once, 0.0f); // far beyond the roughness that the fit was made for
    Rgb c = b->reflectance;
    return rgb_scale(rgb_mad(rgb_scale(c, once), twice, rgb_mul(c, c)), wi.z * SHEEN_INV_PI);
}

static float rough_diffuse_importance(const BsdfLobe *b, Vec3 wo)
{
    return wo.z > 0.0f ? rgb_max(b->reflectance) : 0.0f;
}

const BsdfOps sheen_lobe_rough_diffuse = {.class = SHEEN_BSDF_DIFFUSE,
                                          .eval = rough_diffuse_eval,
                                          .pdf = sheen_bsdf_pdf_cosine,
                                          .sample = sheen_bsdf_sample_cosine,
                                          .albedo = sheen_bsdf_albedo_of_diffuse,
                                          .importance = rough_diffuse_importance};
