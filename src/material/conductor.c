// SPDX-License-Identifier: Apache-2.0
// A smooth metal: one mirror lobe, coloured by the Fresnel reflectance of a complex index.
#include "material/bsdf_ops.h"

static Rgb conductor_albedo(const BsdfLobe *b, Vec3 wo)
{
    if (!(wo.z > 0.0f)) return rgb_gray(0.0f);
    return rgb_mul(fresnel_conductor_rgb(wo.z, b->material->eta, b->material->k), b->reflectance);
}

static int conductor_lobes(const BsdfLobe *b, Vec3 wo, BsdfSample out[2])
{
    Rgb factor = conductor_albedo(b, wo);
    if (rgb_is_black(factor)) return 0;
    out[0] = bsdf_delta(bsdf_mirror(wo), factor, 1.0f, false);
    return 1;
}

static float conductor_importance(const BsdfLobe *b, Vec3 wo)
{
    return rgb_max(conductor_albedo(b, wo));
}

static void conductor_roughen(BsdfLobe *b, float least_alpha)
{
    b->ops = &sheen_lobe_rough_conductor;
    b->microfacet = (Microfacet){SHEEN_DISTRIBUTION_GGX, least_alpha, least_alpha};
}

const BsdfOps sheen_lobe_conductor = {.class = SHEEN_BSDF_DELTA,
                                      .lobes = conductor_lobes,
                                      .albedo = conductor_albedo,
                                      .importance = conductor_importance,
                                      .roughen = conductor_roughen};
