// SPDX-License-Identifier: Apache-2.0
// What each kind of lobe implements; bsdf.c adds them up. Included by src/material only.
#ifndef SHEEN_MATERIAL_BSDF_OPS_H
#define SHEEN_MATERIAL_BSDF_OPS_H

#include "material/bsdf.h"

/**
 * One kind of lobe. Directions are in the lobe's frame, inside all wrappers, and the lobe's weight is not in it.
 * A smooth kind has eval, pdf and sample; a delta kind has lobes. All have an albedo and an importance.
 */
typedef struct BsdfOps {
    BsdfClass class;
    bool transmits; // a smooth kind that reaches the other side
    bool layer;     // see BsdfSample
    Rgb (*eval)(const BsdfLobe *b, Vec3 wo, Vec3 wi);
    float (*pdf)(const BsdfLobe *b, Vec3 wo, Vec3 wi);
    /** wi_l, weight and pdf of *out are set; the rest is zero before. @return false when nothing is scattered */
    bool (*sample)(const BsdfLobe *b, Vec3 wo, float choice, Vec2 u, BsdfSample *out);
    /** As sheen_bsdf_delta_lobes, but each pdf is the probability with which sampling chooses the lobe; their sum is 1.
     */
    int (*lobes)(const BsdfLobe *b, Vec3 wo, BsdfSample out[2]);
    Rgb (*albedo)(const BsdfLobe *b, Vec3 wo);
    /** A cheap guess of the albedo's largest channel, by which sampling chooses lobes; positive where the albedo is. */
    float (*importance)(const BsdfLobe *b, Vec3 wo);
} BsdfOps;

extern const BsdfOps sheen_lobe_lambert, sheen_lobe_coated_lambert, sheen_lobe_rough_diffuse,
    sheen_lobe_diffuse_transmit; // diffuse surfaces
extern const BsdfOps sheen_lobe_conductor, sheen_lobe_dielectric, sheen_lobe_thin_dielectric, sheen_lobe_coat,
    sheen_lobe_passage;                                                                              // delta lobes
extern const BsdfOps sheen_lobe_rough_conductor, sheen_lobe_rough_dielectric, sheen_lobe_rough_coat; // microfacets
extern const BsdfOps sheen_lobe_phong, sheen_lobe_ward, sheen_lobe_lafortune;                        // empirical
extern const BsdfOps sheen_lobe_principled_diffuse, sheen_lobe_principled_specular, sheen_lobe_principled_clearcoat;
extern const BsdfOps sheen_lobe_thin_reflection, sheen_lobe_thin_transmission; // of a principled sheet

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

/** The lobe of a mirror that reflects the lobe's albedo. @return their number, 0 when it is black */
static inline int bsdf_mirror_lobe(const BsdfLobe *b, Vec3 wo, BsdfSample out[2])
{
    Rgb factor = b->ops->albedo(b, wo);
    if (rgb_is_black(factor)) return 0;
    out[0] = bsdf_delta(bsdf_mirror(wo), factor, 1.0f, false);
    return 1;
}

/** The importance of lobes whose albedo is quickly told. */
static inline float bsdf_albedo_importance(const BsdfLobe *b, Vec3 wo)
{
    return rgb_max(b->ops->albedo(b, wo));
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

/** Cosine-weighted sampling on the side of +z, as operations of lobes with an eval; weight from eval. */
bool sheen_bsdf_sample_cosine(const BsdfLobe *b, Vec3 wo, float choice, Vec2 u, BsdfSample *out);
float sheen_bsdf_pdf_cosine(const BsdfLobe *b, Vec3 wo, Vec3 wi);
static inline float bsdf_cosine_pdf(Vec3 wo, Vec3 wi)
{
    return wo.z > 0.0f && wi.z > 0.0f ? wi.z * SHEEN_INV_PI : 0.0f;
}

/** The albedo of a lobe by a fixed set of its own samples. @param ior  of light that goes through, else 1 */
Rgb sheen_bsdf_albedo_by_samples(const BsdfLobe *b, Vec3 wo, float ior);

/** The albedo of a lobe that reflects nearly as Lambert's, alike about the normal, by a quadrature of 24 directions. */
Rgb sheen_bsdf_albedo_of_diffuse(const BsdfLobe *b, Vec3 wo);

/** The microfacet normal halfway between two directions on the same side, z > 0. */
static inline Vec3 bsdf_half(Vec3 wo, Vec3 wi)
{
    Vec3 m = v3_normalize(v3_add(wo, wi));
    return m.z < 0.0f ? v3_neg(m) : m;
}

// ---- wrappers (wrap.c) ------------------------------------------------------------------------------------------

/** The way of wo from the surface through all wrappers to a lobe. */
typedef struct BsdfWay {
    const BsdfWrap *wraps[SHEEN_BSDF_MAX_WRAPS]; // from the outermost
    Vec3 wo[SHEEN_BSDF_MAX_WRAPS + 1];           // outside wraps[i]; the last is inside all
    Rgb factor;                                  // what the coatings leave of the light toward wo
    int n;
} BsdfWay;

/** @return false when nothing of the lobe is seen from wo. */
bool sheen_bsdf_way(const Bsdf *bsdf, const BsdfLobe *lobe, Vec3 wo, BsdfWay *way);
static inline Vec3 bsdf_way_wo(const BsdfWay *way)
{
    return way->wo[way->n];
}

/**
 * Takes wi from the surface to the lobe.
 * @param factor   what the coatings leave of the light on both ways, beside `density`
 * @param density  solid angle inside over that outside: densities and f |cos| are multiplied by it
 * @return false when no light goes that way
 */
bool sheen_bsdf_way_in(const BsdfWay *way, Vec3 *wi, Rgb *factor, float *density);

/** Takes a sample of the lobe to the surface: direction, weight and density. @return false when it does not get out */
bool sheen_bsdf_way_out(const BsdfWay *way, BsdfSample *sample);

/** @return what the fading of light along mapped surfaces leaves of light that is alike from everywhere. */
float sheen_bsdf_way_terminator(const BsdfWay *way);

/** @return the lobe's z axis as it is at the surface. */
Vec3 sheen_bsdf_way_normal(const BsdfWay *way);

#endif
