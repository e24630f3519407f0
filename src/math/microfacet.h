// SPDX-License-Identifier: Apache-2.0
// Surfaces of many small mirrors or panes: how their normals are distributed, and which of them are seen from where.
// Directions are local, z along the mean normal; normals of microfacets have z > 0.
#ifndef SHEEN_MATH_MICROFACET_H
#define SHEEN_MATH_MICROFACET_H

#include "math/vec.h"

typedef enum SheenDistribution {
    SHEEN_DISTRIBUTION_BECKMANN, // normally distributed slopes
    SHEEN_DISTRIBUTION_GGX,      // slopes with long tails
} SheenDistribution;

/** Roughness that every surface has at least, and at most. A smaller one is beyond the precision of directions. */
#define SHEEN_ALPHA_MIN 1e-4f
#define SHEEN_ALPHA_MAX 10.0f

/** alpha: along x and along y; for Beckmann's the root mean square of the slopes times sqrt(2). */
typedef struct Microfacet {
    SheenDistribution distribution;
    float alpha_u, alpha_v; // in [SHEEN_ALPHA_MIN, SHEEN_ALPHA_MAX]
} Microfacet;

/** @return the density of normals D(m), 1/sr over the mean surface: D cos integrates to 1. 0 for m.z <= 0. */
float sheen_microfacet_d(const Microfacet *s, Vec3 m);

/**
 * @return the share of the microfacets of normal m that is seen from v, |v.z| > 0, by Smith's model; 0 when v is behind
 *         them. Both sides of the surface behave alike. Source: walter2007
 */
float sheen_microfacet_g1(const Microfacet *s, Vec3 v, Vec3 m);

/** @return the density, 1/sr, with which sheen_microfacet_sample draws m: D G1 |v m| / |v.z|. */
float sheen_microfacet_pdf(const Microfacet *s, Vec3 v, Vec3 m);

/** A normal among those seen from v, v.z > 0. Source: heitz2014-visible; heitz2018-ggx; jakob2014-beckmann */
Vec3 sheen_microfacet_sample(const Microfacet *s, Vec3 v, Vec2 u);

#endif
