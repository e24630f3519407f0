// SPDX-License-Identifier: Apache-2.0
// A smooth metal: one mirror lobe, coloured by the Fresnel reflectance of a complex index.
#include "material/bsdf_ops.h"

static Rgb conductor_albedo(const Bsdf *bsdf, Vec3 wo_l)
{
    const SheenMaterial *m = bsdf->material;
    if (!(wo_l.z > 0.0f) && !m->two_sided) return rgb_gray(0.0f);
    float c = fabsf(wo_l.z);
    Rgb f = rgb(sheen_fresnel_conductor(c, m->eta.r, m->k.r), sheen_fresnel_conductor(c, m->eta.g, m->k.g),
                sheen_fresnel_conductor(c, m->eta.b, m->k.b));
    return rgb_mul(f, bsdf->specular_reflectance);
}

static int conductor_lobes(const Bsdf *bsdf, Vec3 wo_l, BsdfSample out[2])
{
    Rgb factor = conductor_albedo(bsdf, wo_l);
    if (rgb_is_black(factor)) return 0;
    out[0] = bsdf_delta(bsdf_mirror(wo_l), factor, 1.0f, false);
    return 1;
}

const BsdfOps sheen_bsdf_conductor = {.lobes = conductor_lobes, .albedo = conductor_albedo};
