// SPDX-License-Identifier: Apache-2.0
// What a rough interface lets through, tabulated: microfacets have no closed form for it.
#ifndef SHEEN_SCENE_COAT_H
#define SHEEN_SCENE_COAT_H

#include "base/arena.h"
#include "math/microfacet.h"

#include <stdint.h>

enum { SHEEN_COAT_COSINES = 64, SHEEN_COAT_ALPHAS = 8 };

typedef struct SheenCoat {
    float ior;
    SheenDistribution distribution;
    float alpha_min, alpha_max; // of the rows
    uint32_t n_alphas;          // 1 where the roughness is constant, else SHEEN_COAT_ALPHAS
    float transmittance[SHEEN_COAT_ALPHAS][SHEEN_COAT_COSINES]; // of light from outside, at cosine i / 63
    // For light that comes alike from everywhere: transmittance from outside, reflectance of the inner side.
    float mean[SHEEN_COAT_ALPHAS], inside[SHEEN_COAT_ALPHAS];
} SheenCoat;

/**
 * Tabulates what microfacets let through and reflect by single scattering: about 10 ms a roughness.
 * @param alpha_min, alpha_max  range of the roughness; one row when they are equal
 * @return NULL when out of memory
 */
const SheenCoat *sheen_coat_create(SheenArena *arena, float ior, SheenDistribution distribution, float alpha_min,
                                   float alpha_max);

/** @return the transmittance from outside, in [0, 1], for |cosine| of the direction to the normal. */
float sheen_coat_transmittance(const SheenCoat *coat, float alpha, float cosine);

/** @return the mean transmittance from outside, and the diffuse reflectance of the inner side. */
float sheen_coat_mean(const SheenCoat *coat, float alpha);
float sheen_coat_inside(const SheenCoat *coat, float alpha);

#endif
