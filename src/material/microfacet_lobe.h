// SPDX-License-Identifier: Apache-2.0
// What lobes of microfacets share. Included by src/material only.
#ifndef SHEEN_MATERIAL_MICROFACET_LOBE_H
#define SHEEN_MATERIAL_MICROFACET_LOBE_H

#include "material/bsdf_ops.h"

/**
 * Reflection by microfacets that are perfect mirrors, from the front only: f |cos(theta_i)|, 1/sr. Masking and
 * shadowing are taken for independent of each other, G = G1(wo) G1(wi). Source: walter2007
 * @param m  gets the microfacets' normal
 */
static inline float microfacet_reflection(const Microfacet *s, Vec3 wo, Vec3 wi, Vec3 *m)
{
    if (!(wo.z > 0.0f && wi.z > 0.0f)) return 0.0f;
    *m = bsdf_half(wo, wi);
    float d = sheen_microfacet_d(s, *m);
    return d > 0.0f ? d * sheen_microfacet_g1(s, wo, *m) * sheen_microfacet_g1(s, wi, *m) / (4.0f * wo.z) : 0.0f;
}

/** Its sampling by visible normals: the weight is the shadowing on the way out. */
static inline bool microfacet_reflection_sample(const Microfacet *s, Vec3 wo, Vec2 u, Vec3 *m, BsdfSample *out)
{
    if (!(wo.z > 0.0f)) return false;
    *m = sheen_microfacet_sample(s, wo, u);
    out->wi_l = v3_normalize(v3_reflect(wo, *m)); // the rounding of a very smooth surface's normals would add up
    if (!(out->wi_l.z > 0.0f)) return false;
    *m = bsdf_half(wo, out->wi_l);
    out->pdf = sheen_microfacet_d(s, *m) * sheen_microfacet_g1(s, wo, *m) / (4.0f * wo.z);
    out->weight = rgb_gray(sheen_microfacet_g1(s, out->wi_l, *m));
    return out->pdf > 0.0f;
}

static inline float microfacet_lobe_pdf(const BsdfLobe *b, Vec3 wo, Vec3 wi)
{
    if (!(wo.z > 0.0f && wi.z > 0.0f)) return 0.0f;
    Vec3 m = bsdf_half(wo, wi);
    return sheen_microfacet_d(&b->microfacet, m) * sheen_microfacet_g1(&b->microfacet, wo, m) / (4.0f * wo.z);
}

/** A pair of directions at a rough interface of two media, seen from the microfacet between them. */
typedef struct Facet {
    Vec3 m;                      // its normal, z > 0
    float o, i;                  // cosines of wo and wi to m, signs as of wo.z and wi.z
    float eta;                   // index on the side of wi over that of wo, for transmission
    float f;                     // Fresnel's reflectance
    float normals_per_direction; // solid angle of normals over that of wi
    bool reflect;
} Facet;

/** @param ior  interior over exterior, not 1. @return false when no microfacet takes wi to wo */
bool sheen_facet_pair(float ior, Vec3 wo, Vec3 wi, Facet *out);

/** A microfacet seen from wo, from either side: its normal on the side of wo, and Fresnel's reflectance there. */
Vec3 sheen_facet_seen(const Microfacet *s, float ior, Vec3 wo, Vec2 u, float *f);

/** Where it sends wo. @return false when that is through the mean surface the wrong way */
bool sheen_facet_send(float ior, Vec3 wo, Vec3 m, bool reflect, Vec3 *wi);

#endif
