// SPDX-License-Identifier: Apache-2.0
// Translational gradients of the coefficients of radiance, three ways. For gather/radiance.c.
#ifndef SHEEN_GATHER_RADIANCE_GRADIENT_H
#define SHEEN_GATHER_RADIANCE_GRADIENT_H

#include "gather/radiance.h"

/**
 * Tables of the walls: a product of zenith factor and azimuth factor is all that the basis is, so that there are
 * M n^2 / 2 + N 2 n numbers instead of M N n^2.
 */
struct SheenRadianceTables {
    SheenStrata strata;
    SheenBasis basis;
    unsigned n;
    float *middle; // [N][2 n + 1] cos(m phi), m = 0 .. n, and sin(m phi), m = 1 .. n, at the middle of sector k
    float *edge;   // [N][2 n + 1] the same at the edge to sector k - 1
    float *wall;   // [M][n (n + 1) / 2] (2 pi / N) sin cos of theta_j- times the zenith factors at theta_j-
    float *ring;   // [M][n (n + 1) / 2] integrals of the zenith factors from theta_j- to theta_j+
};

/**
 * By the light that the walls of the cells uncover when the point moves, u_k along the middle of sector k and v_k-
 * across its edge:
 *   grad lambda = sum_k { u_k (2 pi / N) sum_{j>=1} cos(t_j-) sin(t_j-) I(r_jk, r_j-1,k) (L_jk - L_j-1,k) B(t_j-, p_k)
 *                       + v_k- sum_j I(r_jk, r_j,k-1) (L_jk - L_j,k-1) integral_{t_j-}^{t_j+} B(t, p_k-) dt }.
 * That is the gradient of light that is constant in each cell. The printed form takes the basis, and 1 / (M sin(theta))
 * for the length of a wall between sectors, at the jittered sample, which is biased at any number of rays. At the
 * middle of the wall both are right in the limit, but at order 10 and 1024 rays in a box off by 0.20 of the gradient;
 * the integral is by 0.08 and costs no more (bench/papers/radiance_gradients.c). I is one over the smaller distance, as
 * printed; two that are less than a factor of 1.5 apart belong to one surface, and the wall moves by the mean of both.
 * Source: krivanek2005-improved-radiance-gradients sec. 3.
 */
void sheen_radiance_gradient_stratified(const SheenRadianceTables *tables, const RadianceSamples *samples, Rgb dx[],
                                        Rgb dy[]);

/**
 * By the derivatives of direction and solid angle of what the rays hit, all of it staying in view. The change of solid
 * angle is divided by the cosine at the hit, here by no less than 0.05: without a bound the variance is infinite where
 * a curved thing has its silhouette.
 * Source: krivanek2005-radiance-caching sec. 4.3.2; (11) is (2 pi / N) (r n_x + 3 q_x cos(xi)) / (r^2 cos(xi)).
 */
void sheen_radiance_gradient_analytical(const SheenRadianceTables *tables, const RadianceSamples *samples, Rgb dx[],
                                        Rgb dy[]);

/**
 * The same by central differences. Each ray is shifted by a share of its own length, so that no scale is preferred.
 * Source: krivanek2005-radiance-caching sec. 4.3.1, there by one-sided differences.
 */
void sheen_radiance_gradient_numerical(const SheenRadianceTables *tables, const RadianceSamples *samples, Rgb dx[],
                                       Rgb dy[]);

/** One over a distance; 0 for an infinite one, and for what is no distance. */
static inline float inverse_distance(float distance)
{
    return distance > 1e-30f ? 1.0f / distance : 0.0f;
}

#endif
