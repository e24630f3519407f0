// SPDX-License-Identifier: Apache-2.0
// A pane of glass without thickness: light goes straight through, or back, after any number of reflections inside.
#include "material/bsdf_ops.h"

// The series R + T R T + T R^3 T + ... of a pane that absorbs nothing, T = 1 - R, sums to 2 R / (1 + R).
static float pane_reflectance(const Bsdf *bsdf, Vec3 wo_l)
{
    float cos_t, r = sheen_fresnel_dielectric(fabsf(wo_l.z), bsdf->material->ior, &cos_t);
    return 2.0f * r / (1.0f + r);
}

static int thin_lobes(const Bsdf *bsdf, Vec3 wo_l, BsdfSample out[2])
{
    float r = pane_reflectance(bsdf, wo_l);
    return bsdf_interface_lobes(wo_l, v3_neg(wo_l), rgb_scale(bsdf->specular_reflectance, r),
                                rgb_scale(bsdf->specular_transmittance, 1.0f - r), 1.0f, out);
}

static Rgb thin_albedo(const Bsdf *bsdf, Vec3 wo_l)
{
    float r = pane_reflectance(bsdf, wo_l);
    return rgb_mad(rgb_scale(bsdf->specular_reflectance, r), 1.0f - r, bsdf->specular_transmittance);
}

const BsdfOps sheen_bsdf_thin_dielectric = {.lobes = thin_lobes, .albedo = thin_albedo};
