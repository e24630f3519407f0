// SPDX-License-Identifier: Apache-2.0
// What each kind of BSDF implements; bsdf.c chooses by the material's kind. Included by src/material only.
#ifndef SHEEN_MATERIAL_BSDF_OPS_H
#define SHEEN_MATERIAL_BSDF_OPS_H

#include "material/bsdf.h"

/**
 * One kind of BSDF: the functions of bsdf.h. A smooth kind has eval, pdf and sample and no lobes; a kind of delta lobes
 * only has lobes and none of the three. All have an albedo.
 */
typedef struct BsdfOps {
    Rgb (*eval)(const Bsdf *bsdf, Vec3 wo_l, Vec3 wi_l);
    float (*pdf)(const Bsdf *bsdf, Vec3 wo_l, Vec3 wi_l);
    bool (*sample)(const Bsdf *bsdf, Vec3 wo_l, float lobe, Vec2 u, BsdfSample *out);
    /** As sheen_bsdf_delta_lobes, but each pdf is the probability with which sampling chooses the lobe; their sum is 1.
     */
    int (*lobes)(const Bsdf *bsdf, Vec3 wo_l, BsdfSample out[2]);
    Rgb (*albedo)(const Bsdf *bsdf, Vec3 wo_l);
} BsdfOps;

extern const BsdfOps sheen_bsdf_diffuse, sheen_bsdf_conductor, sheen_bsdf_dielectric, sheen_bsdf_thin_dielectric;

/** A delta lobe with its factor; pdf is set by the kind. */
static inline BsdfSample bsdf_delta(Vec3 wi_l, Rgb weight, float pdf, bool transmit)
{
    return (BsdfSample){.wi_l = wi_l, .weight = weight, .pdf = pdf, .delta = true, .transmit = transmit};
}

/** The mirror direction in the local frame. */
static inline Vec3 bsdf_mirror(Vec3 wo_l)
{
    return v3(-wo_l.x, -wo_l.y, wo_l.z);
}

/**
 * The two lobes of an interface without its own absorption, those that are black left out.
 * @param reflected, transmitted  share of the energy, tints included
 * @param scale                   factor on the transmitted radiance beside its energy
 * @return their number
 */
static inline int bsdf_interface_lobes(Vec3 wo_l, Vec3 wt_l, Rgb reflected, Rgb transmitted, float scale,
                                       BsdfSample out[2])
{
    float r = rgb_max(reflected), t = rgb_max(transmitted), sum = r + t;
    int n = 0;
    if (r > 0.0f) out[n++] = bsdf_delta(bsdf_mirror(wo_l), reflected, r / sum, false);
    if (t > 0.0f) out[n++] = bsdf_delta(wt_l, rgb_scale(transmitted, scale), t / sum, true);
    return n;
}

#endif
