// SPDX-License-Identifier: Apache-2.0
// One gather becomes the coefficients of the light that comes in, their gradients, and the distance to what is around.
// Knows no rays: it maps arrays.
#ifndef SHEEN_GATHER_RADIANCE_H
#define SHEEN_GATHER_RADIANCE_H

#include "base/status.h"
#include "basis/basis.h"
#include "gather/strata.h"

/** How the coefficients change with a shift of the point. */
typedef enum SheenGradient {
    SHEEN_GRADIENT_STRATIFIED, // what the walls between cells uncover: the only one that sees occlusion change
    SHEEN_GRADIENT_ANALYTICAL, // by derivatives: all that the rays hit stays in view
    SHEEN_GRADIENT_NUMERICAL,  // the same by finite differences
    SHEEN_GRADIENT_NONE
} SheenGradient;

/** What is the same for all gathers of one kind: strata, basis, order, and the basis at the walls. Immutable. */
typedef struct SheenRadianceTables SheenRadianceTables;

/**
 * @param strata  of equal solid angle
 * @param n       order, 1 .. SHEEN_ORDER_MAX
 * @param out     owned by the caller
 * @return SHEEN_ERR_INVALID for other strata or orders, SHEEN_ERR_NOMEM
 */
SHEEN_NODISCARD SheenStatus sheen_radiance_tables_create(SheenStrata strata, SheenBasis basis, unsigned n,
                                                         SheenRadianceTables **out);

/** Frees the tables and sets *tables to NULL. NULL-safe. */
void sheen_radiance_tables_destroy(SheenRadianceTables **tables);

/** The samples of one gather, in the local frame (x, y in the surface, z along the normal); borrowed. */
typedef struct RadianceSamples {
    const Vec3 *directions; // [cells] unit, z >= 0, each in its cell
    const Rgb *L;           // [cells] radiance from there, finite, W m^-2 sr^-1
    const float *distance;  // [cells] of what sends it, metres; INFINITY for the sky
    const Vec3 *normals;    // [cells] unit, of what sends it; for the analytical and numerical gradients only
} RadianceSamples;

/** What one gather says about its point, in the local frame. The arrays are the caller's, [n * n] each. */
typedef struct RadianceEstimate {
    Rgb *lambda;  // coefficients of the radiance that comes in: sum_i lambda_i B_i(w), 0 below the horizon
    Rgb *dx, *dy; // their derivatives for a shift along x, along y, per metre; left alone without gradients
    float R;      // harmonic mean distance over solid angle, metres; INFINITY when nothing is near
    float error;  // standard error, luminance, of sum_i c_i lambda_i for |c| = 1, on average over such sums
} RadianceEstimate;

/**
 * Coefficients lambda_i = (2 pi / cells) sum_k L_k B_i(w_k), and the rest. Both bases stand for the radiance of the
 * upper hemisphere; SH take that below for 0. Pure, thread-safe, no allocation.
 *
 * Stratified gradients: see gather/radiance_gradient.h, as the others. The standard error adds two variances within a
 * cell: that of the light, half the smaller of the squared differences to the neighbors in ring and sector, and that of
 * the basis, by its mean squared slope.
 *
 * Source: krivanek2005-radiance-caching eq. (4); krivanek2006-making-caching-practical sec. 4.2, for a standard error
 * from the samples themselves (there by leaving out half of them, which strata make noisy).
 */
void sheen_estimate_radiance(const SheenRadianceTables *tables, const RadianceSamples *samples, SheenGradient gradient,
                             RadianceEstimate *out);

#endif
