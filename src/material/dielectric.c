// SPDX-License-Identifier: Apache-2.0
// A smooth interface of two transparent media: a mirror lobe and a refracted one.
#include "material/bsdf_ops.h"

static int dielectric_lobes(const Bsdf *bsdf, Vec3 wo_l, BsdfSample out[2])
{
    float cos_t, f = sheen_fresnel_dielectric(wo_l.z, bsdf->material->ior, &cos_t);
    // Index on the side of wo over that beyond: tangents shrink by it, and radiance, which is bundled into less solid
    // angle by the denser medium, scales with its square on the way from wi to wo. Source: veach1997, sec. 5.2.
    float ratio = wo_l.z > 0.0f ? 1.0f / bsdf->material->ior : bsdf->material->ior;
    Vec3 wt = v3(-ratio * wo_l.x, -ratio * wo_l.y, cos_t);
    return bsdf_interface_lobes(wo_l, wt, rgb_scale(bsdf->specular_reflectance, f),
                                rgb_scale(bsdf->specular_transmittance, 1.0f - f), ratio * ratio, out);
}

// The share of the energy: without the factor on radiance, which leaves it at most 1.
static Rgb dielectric_albedo(const Bsdf *bsdf, Vec3 wo_l)
{
    float cos_t, f = sheen_fresnel_dielectric(wo_l.z, bsdf->material->ior, &cos_t);
    return rgb_mad(rgb_scale(bsdf->specular_reflectance, f), 1.0f - f, bsdf->specular_transmittance);
}

const BsdfOps sheen_bsdf_dielectric = {.lobes = dielectric_lobes, .albedo = dielectric_albedo};
