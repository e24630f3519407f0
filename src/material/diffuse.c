// SPDX-License-Identifier: Apache-2.0
// Lambert's surfaces: f = reflectance / pi on the side of wo, or transmittance / pi on the other.
#include "material/bsdf_ops.h"
#include "math/warp.h"

bool sheen_bsdf_sample_cosine(const BsdfLobe *b, Vec3 wo, float choice, Vec2 u, BsdfSample *out)
{
    (void)choice;
    if (!(wo.z > 0.0f)) return false;
    out->wi_l = warp_cosine_hemisphere(u);
    if (!(out->wi_l.z > 0.0f)) return false; // the rim of the disk, in rounding: density 0
    out->pdf = out->wi_l.z * SHEEN_INV_PI;
    out->weight = rgb_scale(b->ops->eval(b, wo, out->wi_l), 1.0f / out->pdf);
    return !rgb_is_black(out->weight);
}

float sheen_bsdf_pdf_cosine(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    (void)b;
    return bsdf_cosine_pdf(wo, wi);
}

// Gauss-Legendre's rule in the cosine, which Schlick's powers are polynomials of, and the midpoint rule in the azimuth:
// f is symmetric about the plane of wo.
Rgb sheen_bsdf_albedo_of_diffuse(const BsdfLobe *b, Vec3 wo)
{
    static const float x[] = {0.0337652429f, 0.169395307f, 0.380690407f, 0.619309593f, 0.830604693f, 0.966234757f};
    static const float w[] = {0.0856622462f, 0.180380787f, 0.233956967f, 0.233956967f, 0.180380787f, 0.0856622462f};
    static const Vec2 azimuths[] = {{0.923879533f, 0.382683432f},
                                    {0.382683432f, 0.923879533f},
                                    {-0.382683432f, 0.923879533f},
                                    {-0.923879533f, 0.382683432f}};
    Rgb sum = rgb_gray(0.0f);
    if (!(wo.z > 0.0f)) return sum;
    const Vec3 seen = v3(safe_sqrtf(1.0f - wo.z * wo.z), 0.0f, wo.z);
    for (int i = 0; i < 6; ++i) {
        float s = safe_sqrtf(1.0f - x[i] * x[i]);
        for (int k = 0; k < 4; ++k)
            sum = rgb_mad(sum, 0.5f * SHEEN_PI * w[i],
                          b->ops->eval(b, seen, v3(s * azimuths[k].x, s * azimuths[k].y, x[i])));
    }
    return rgb_unit(sum);
}

static Rgb lambert_eval(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    // f |cos| is the reflectance times the density of cosine-weighted directions.
    return rgb_scale(b->reflectance, bsdf_cosine_pdf(wo, wi));
}

static bool lambert_sample(const BsdfLobe *b, Vec3 wo, float choice, Vec2 u, BsdfSample *out)
{
    if (!sheen_bsdf_sample_cosine(b, wo, choice, u, out)) return false;
    out->weight = b->reflectance; // without rounding
    return true;
}

static Rgb lambert_albedo(const BsdfLobe *b, Vec3 wo)
{
    return wo.z > 0.0f ? b->reflectance : rgb_gray(0.0f);
}

static float lambert_importance(const BsdfLobe *b, Vec3 wo)
{
    return wo.z > 0.0f ? rgb_max(b->reflectance) : 0.0f;
}

const BsdfOps sheen_lobe_lambert = {.class = SHEEN_BSDF_DIFFUSE,
                                    .eval = lambert_eval,
                                    .pdf = sheen_bsdf_pdf_cosine,
                                    .sample = lambert_sample,
                                    .albedo = lambert_albedo,
                                    .importance = lambert_importance};

// ---- transmission -----------------------------------------------------------------------------------------------

static float transmit_pdf(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    (void)b;
    return wo.z * wi.z < 0.0f ? fabsf(wi.z) * SHEEN_INV_PI : 0.0f;
}

static Rgb transmit_eval(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    return rgb_scale(b->transmittance, transmit_pdf(b, wo, wi));
}

static bool transmit_sample(const BsdfLobe *b, Vec3 wo, float choice, Vec2 u, BsdfSample *out)
{
    (void)choice;
    Vec3 wi = warp_cosine_hemisphere(u);
    if (!(wi.z > 0.0f) || wo.z == 0.0f || rgb_is_black(b->transmittance)) return false;
    *out = (BsdfSample){.wi_l = v3(wi.x, wi.y, wo.z > 0.0f ? -wi.z : wi.z), .weight = b->transmittance};
    out->pdf = wi.z * SHEEN_INV_PI;
    return true;
}

static Rgb transmit_albedo(const BsdfLobe *b, Vec3 wo)
{
    (void)wo;
    return b->transmittance;
}

static float transmit_importance(const BsdfLobe *b, Vec3 wo)
{
    (void)wo;
    return rgb_max(b->transmittance);
}

// Not of the diffuse class: the irradiance that it scatters is that of the other side.
const BsdfOps sheen_lobe_diffuse_transmit = {.class = SHEEN_BSDF_GLOSSY,
                                             .transmits = true,
                                             .eval = transmit_eval,
                                             .pdf = transmit_pdf,
                                             .sample = transmit_sample,
                                             .albedo = transmit_albedo,
                                             .importance = transmit_importance};
