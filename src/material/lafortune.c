// SPDX-License-Identifier: Apache-2.0
// One generalized cosine lobe of Lafortune's: a power of a dot product whose axes are scaled and turned round at will.
// A material has any number of them, so that off-specular peaks, retro-reflection and measured surfaces can be fitted.
// With c = (-1, -1, 1) it is Phong's lobe. Source: lafortune1997
#include "material/bsdf_ops.h"
#include "math/frame.h"

/** The lobe's axis for wo, not normalized: its dot product with wi is the base of the power. */
static Vec3 axis_of(const SheenLafortune *l, Vec3 wo)
{
    return v3(l->c.x * wo.x, l->c.y * wo.y, l->c.z * wo.z);
}

// cos^n about the axis, times (n + 1) / (2 pi): a density over the sphere. @param length  gets the axis'
static float lobe_pdf(const SheenLafortune *l, Vec3 wo, Vec3 wi, float *length)
{
    Vec3 axis = axis_of(l, wo);
    *length = v3_length(axis);
    float c = v3_dot(axis, wi) / *length; // NaN without an axis
    if (!(wo.z > 0.0f && wi.z > 0.0f && c > 0.0f)) return 0.0f;
    return powf(minf(c, 1.0f), l->exponent) * (l->exponent + 1.0f) * (0.5f * SHEEN_INV_PI);
}

// Reciprocal by its form: c_x wo_x wi_x + c_y wo_y wi_y + c_z wo_z wi_z.
static Rgb weight_of(const BsdfLobe *b, float length, float cos_i)
{
    const SheenLafortune *l = b->lafortune;
    float scale = powf(length, l->exponent) * (l->exponent + 2.0f) / (l->exponent + 1.0f) * cos_i;
    return isfinite(scale) ? rgb_scale(rgb_mul(b->reflectance, l->weight), scale) : rgb_gray(0.0f);
}

static float lafortune_pdf(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    float length;
    return lobe_pdf(b->lafortune, wo, wi, &length);
}

static Rgb lafortune_eval(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    float length, pdf = lobe_pdf(b->lafortune, wo, wi, &length);
    return pdf > 0.0f ? rgb_scale(weight_of(b, length, wi.z), pdf) : rgb_gray(0.0f);
}

static bool lafortune_sample(const BsdfLobe *b, Vec3 wo, float choice, Vec2 u, BsdfSample *out)
{
    (void)choice;
    Vec3 axis = axis_of(b->lafortune, wo);
    float length = v3_length(axis);
    if (!(wo.z > 0.0f && length > 0.0f)) return false;
    float c = powf(u.x, 1.0f / (b->lafortune->exponent + 1.0f)), s = safe_sqrtf(1.0f - c * c);
    float phi = 2.0f * SHEEN_PI * u.y;
    Frame f = frame_from_normal(v3_scale(axis, 1.0f / length));
    out->wi_l = v3_normalize(frame_to_world(&f, v3(s * cosf(phi), s * sinf(phi), c)));
    out->pdf = lobe_pdf(b->lafortune, wo, out->wi_l, &length);
    if (!(out->pdf > 0.0f)) return false;
    out->weight = weight_of(b, length, out->wi_l.z);
    return true;
}

static Rgb lafortune_albedo(const BsdfLobe *b, Vec3 wo)
{
    return sheen_bsdf_albedo_by_samples(b, wo, 1.0f);
}

static float lafortune_importance(const BsdfLobe *b, Vec3 wo)
{
    if (!(wo.z > 0.0f)) return 0.0f;
    return minf(rgb_max(weight_of(b, v3_length(axis_of(b->lafortune, wo)), 1.0f)), 1.0f);
}

const BsdfOps sheen_lobe_lafortune = {.class = SHEEN_BSDF_GLOSSY,
                                      .layer = true,
                                      .eval = lafortune_eval,
                                      .pdf = lafortune_pdf,
                                      .sample = lafortune_sample,
                                      .albedo = lafortune_albedo,
                                      .importance = lafortune_importance};
