// SPDX-License-Identifier: Apache-2.0
// The second derivatives of irradiance over the surface, occlusion included, from one gather. Knows no rays: it maps
// arrays.
#ifndef SHEEN_GATHER_HESSIAN_H
#define SHEEN_GATHER_HESSIAN_H

#include "gather/strata.h"

/** Second derivatives of the luminance of irradiance along x and y of the local frame, W/m^4. */
typedef struct IrradianceHessian {
    float xx, xy, yy;
} IrradianceHessian;

/**
 * The Hessian of the irradiance of a virtual mesh: the points where the rays end are joined to triangles as the strata
 * lie, each triangle sends a constant radiance, and the irradiance of that has exact derivatives.
 *
 * @param s            the strata, of either density
 * @param directions   [cells] local sample directions, unit, z > 0
 * @param L            [cells] radiance from there, W m^-2 sr^-1; what is not finite counts as black
 * @param distance     [cells] distance of what sends it, metres; INFINITY for the sky, and for what is not positive
 * @param gradient     d/dx and d/dy of the luminance of that mesh's irradiance, W/m^3; may be NULL
 * Always finite. Light that is alike from everywhere, and the sky, give exactly 0. Pure, thread-safe, no allocation.
 *
 * Source: schwarzhaupt2012-hessian, but for
 * - a triangle's radiance, which is the mean of those vertices that are farther than 2/3 of the farthest. The farthest
 *   one alone, as published, is right at the edge of an occluder, but of first order in the cell where radiance is
 *   smooth: the error of the Hessian in a plain box is 26 % at 400 rays with it, and 5 % with the mean.
 * - the gap down to the horizon, which is closed by each sector's last sample let fall onto the plane. Left open, the
 *   box is wrong by twice its Hessian.
 *
 * Relative error of the Hessian (Frobenius norm), root mean square over jitter, from radiance without noise:
 *
 *                                        400 rays   1,024   6,400
 *     box without occlusion                  0.06    0.01    0.003
 *     flat bright screen on black            0.22    0.16    0.08
 *     dark ball before a ceiling             0.20    0.09    0.15
 *     bright ball on black                   0.31    0.39    0.47
 *
 * The silhouette of a ball moves over it as the point moves, that of the mesh does not: an error that stays, and makes
 * radii too small by up to a seventh.
 */
void sheen_estimate_hessian(SheenStrata s, const Vec3 directions[], const Rgb L[], const float distance[],
                            IrradianceHessian *out, float gradient[2]);

/**
 * The same of the integral of L f over solid angle, for another weight f than the cosine: that of a lobe, say, for the
 * radiance that it sends on.
 * @param weight  [cells] g(d), the gradient of |v| f(v / |v|) at the sample's direction: f is g . d, and its slope is
 *                the part of g across d. f is 0 at the horizon. For the cosine g is (0, 0, 1), which NULL stands for.
 *                What is not finite counts as 0.
 * Along an edge f is interpolated between its ends: relative error of the Hessian of a Phong lobe of exponent 7 tilted
 * by 45 degrees, as above:
 *
 *     box without occlusion                  0.02    0.006   0.001
 *     flat bright screen on black            0.13    0.06    0.02
 *     dark ball before a ceiling             0.14    0.10    0.16
 *     bright ball on black                   0.12    0.19    0.23
 */
void sheen_estimate_lobe_hessian(SheenStrata s, const Vec3 directions[], const Vec3 weight[], const Rgb L[],
                                 const float distance[], IrradianceHessian *out, float gradient[2]);

/** An ellipse about a point of a surface, in the local frame: axes (c, s) and (-s, c), the shorter radius first. */
typedef struct HessianEllipse {
    float cos_axis, sin_axis;
    float radius[2]; // metres; INFINITY where nothing bends
} HessianEllipse;

/**
 * The largest ellipse in which extrapolation by value and gradient errs by a share of the irradiance, in the mean.
 * @param E      luminance of the irradiance, W/m^2
 * @param error  mean relative error, > 0
 *
 * With l_i the eigenvalues, the error at (u, v) along their axes is at most (|l_1| u^2 + |l_2| v^2) / 2, and its mean
 * over an ellipse (|l_1| R_1^2 + |l_2| R_2^2) / 8. Of all ellipses of mean e E the one with R_i = sqrt(4 e E / |l_i|)
 * has the largest area. (The published radii bound the error's integral instead, by the fourth root of 4 eps / pi
 * |l_i|: an absolute quantity, which means another quality for each size of the scene.)
 */
HessianEllipse sheen_hessian_ellipse(const IrradianceHessian *h, float E, float error);

#endif
