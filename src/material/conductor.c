// SPDX-License-Identifier: Apache-2.0
// A smooth metal: one mirror lobe, coloured by the Fresnel reflectance of a complex index.
#include "material/bsdf_ops.h"

static Rgb conductor_albedo(const BsdfLobe *b, Vec3 wo)
{
    if (!(wo.z > 0.0f)) return rgb_gray(0.0f);
    return rgb_mul(fresnel_conductor_rgb(wo.z, b->material->eta, b->material->k), b->reflectance);
}

const BsdfOps sheen_lobe_conductor = {.class = SHEEN_BSDF_DELTA,
                                      .lobes = bsdf_mirror_lobe,
                                      .albedo = conductor_albedo,
                                      .importance = bsdf_albedo_importance};
