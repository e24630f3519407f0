// SPDX-License-Identifier: Apache-2.0
// What the principled BSDFs share. Included by src/material only.
#ifndef SHEEN_MATERIAL_PRINCIPLED_LOBE_H
#define SHEEN_MATERIAL_PRINCIPLED_LOBE_H

#include "material/bsdf_ops.h"

/**
 * Reflectance of a microfacet seen from the front, metal, tint and all.
 * @param F       Fresnel's for the dielectric
 * @param cosine  of the viewer's direction to its normal
 */
Rgb sheen_principled_fresnel(const BsdfLobe *b, float F, float cosine);

/** Terms whose sum, each with its factor, is sheen_principled_fresnel: the exact one of a dielectric, and Schlick's. */
enum { SHEEN_FRESNEL_EXACT, SHEEN_FRESNEL_ONE, SHEEN_FRESNEL_SCHLICK, SHEEN_FRESNEL_TERMS };

/** The terms: they depend on the direction alone. @param cosine  of the viewer's direction to the microfacet's normal
 */
void sheen_principled_fresnel_terms(float ior, float cosine, float terms[SHEEN_FRESNEL_TERMS]);

/** Their factors: they depend on the lobe's textures alone. */
void sheen_principled_fresnel_factors(const BsdfLobe *b, Rgb factors[SHEEN_FRESNEL_TERMS]);

#endif
