// SPDX-License-Identifier: Apache-2.0
// Lambert's surface: f = reflectance / pi on the side of wo.
#include "material/bsdf_ops.h"
#include "math/warp.h"

static bool is_lit(const Bsdf *bsdf, float cos_o)
{
    return cos_o > 0.0f || (bsdf->material->two_sided && cos_o < 0.0f);
}

static float diffuse_pdf(const Bsdf *bsdf, Vec3 wo_l, Vec3 wi_l)
{
    return is_lit(bsdf, wo_l.z) && wo_l.z * wi_l.z > 0.0f ? fabsf(wi_l.z) * SHEEN_INV_PI : 0.0f;
}

static Rgb diffuse_eval(const Bsdf *bsdf, Vec3 wo_l, Vec3 wi_l)
{
    // f |cos| is the reflectance times the density of cosine-weighted directions.
    return rgb_scale(bsdf->reflectance, diffuse_pdf(bsdf, wo_l, wi_l));
}

static bool diffuse_sample(const Bsdf *bsdf, Vec3 wo_l, float lobe, Vec2 u, BsdfSample *out)
{
    (void)lobe;
    if (!is_lit(bsdf, wo_l.z) || rgb_is_black(bsdf->reflectance)) return false;
    Vec3 wi = warp_cosine_hemisphere(u);
    if (!(wi.z > 0.0f)) return false; // the rim of the disk, in rounding: density 0
    float pdf = wi.z * SHEEN_INV_PI;
    if (wo_l.z < 0.0f) wi.z = -wi.z;
    *out = (BsdfSample){.wi_l = wi, .weight = bsdf->reflectance, .pdf = pdf};
    return true;
}

static Rgb diffuse_albedo(const Bsdf *bsdf, Vec3 wo_l)
{
    return is_lit(bsdf, wo_l.z) ? bsdf->reflectance : rgb_gray(0.0f);
}

const BsdfOps sheen_bsdf_diffuse = {
    .eval = diffuse_eval, .pdf = diffuse_pdf, .sample = diffuse_sample, .albedo = diffuse_albedo};
