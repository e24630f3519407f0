// SPDX-License-Identifier: Apache-2.0
// A pane of glass without thickness: light goes straight through, or back, after any number of reflections inside.
#include "material/bsdf_ops.h"

// The series R + T R T + T R^3 T + ... of a pane that absorbs nothing, T = 1 - R, sums to 2 R / (1 + R).
static float pane_reflectance(const BsdfLobe *b, Vec3 wo)
{
    float cos_t, r = sheen_fresnel_dielectric(fabsf(wo.z), b->material->ior, &cos_t);
    return 2.0f * r / (1.0f + r);
}

static int thin_lobes(const BsdfLobe *b, Vec3 wo, BsdfSample out[2])
{
    float r = pane_reflectance(b, wo);
    return bsdf_interface_lobes(wo, v3_neg(wo), rgb_scale(b->reflectance, r), rgb_scale(b->transmittance, 1.0f - r),
                                1.0f, out);
}

static Rgb thin_albedo(const BsdfLobe *b, Vec3 wo)
{
    float r = pane_reflectance(b, wo);
    return rgb_mad(rgb_scale(b->reflectance, r), 1.0f - r, b->transmittance);
}

const BsdfOps sheen_lobe_thin_dielectric = {
    .class = SHEEN_BSDF_DELTA, .lobes = thin_lobes, .albedo = thin_albedo, .importance = bsdf_albedo_importance};
