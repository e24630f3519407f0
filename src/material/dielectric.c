// SPDX-License-Identifier: Apache-2.0
// A smooth interface of two transparent media: a mirror lobe and a refracted one.
#include "material/bsdf_ops.h"

static int dielectric_lobes(const BsdfLobe *b, Vec3 wo, BsdfSample out[2])
{
    float ior = b->material->ior, cos_t, f = sheen_fresnel_dielectric(wo.z, ior, &cos_t);
    // Index on the side of wo over that beyond: tangents shrink by it, and radiance, which is bundled into less solid
    // angle by the denser medium, scales with its square on the way from wi to wo. Source: veach1997, sec. 5.2.
    float ratio = wo.z > 0.0f ? 1.0f / ior : ior;
    Vec3 wt = v3(-ratio * wo.x, -ratio * wo.y, cos_t);
    return bsdf_interface_lobes(wo, wt, rgb_scale(b->reflectance, f), rgb_scale(b->transmittance, 1.0f - f),
                                ratio * ratio, out);
}

// The share of the energy: without the factor on radiance, which leaves it at most 1.
static Rgb dielectric_albedo(const BsdfLobe *b, Vec3 wo)
{
    float cos_t, f = sheen_fresnel_dielectric(wo.z, b->material->ior, &cos_t);
    return rgb_mad(rgb_scale(b->reflectance, f), 1.0f - f, b->transmittance);
}

const BsdfOps sheen_lobe_dielectric = {.class = SHEEN_BSDF_DELTA,
                                       .lobes = dielectric_lobes,
                                       .albedo = dielectric_albedo,
                                       .importance = bsdf_albedo_importance};
