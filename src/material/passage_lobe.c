// SPDX-License-Identifier: Apache-2.0
// The holes of a mask: light goes straight on.
#include "material/bsdf_ops.h"

static int passage_lobes(const BsdfLobe *b, Vec3 wo, BsdfSample out[2])
{
    (void)b;
    out[0] = bsdf_delta(v3_neg(wo), rgb_gray(1.0f), 1.0f, true);
    return 1;
}

static Rgb passage_albedo(const BsdfLobe *b, Vec3 wo)
{
    (void)b, (void)wo;
    return rgb_gray(1.0f);
}

const BsdfOps sheen_lobe_passage = {
    .class = SHEEN_BSDF_DELTA, .lobes = passage_lobes, .albedo = passage_albedo, .importance = bsdf_albedo_importance};
