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

#endif
