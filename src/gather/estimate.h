// SPDX-License-Identifier: Apache-2.0
// One gather becomes irradiance, its gradients and the distance to what is around. Knows no rays: it maps arrays.
#ifndef SHEEN_GATHER_ESTIMATE_H
#define SHEEN_GATHER_ESTIMATE_H

#include "gather/strata.h"
#include "math/frame.h"

/** What one gather says about its point, in the local frame (x, y in the surface, z along the normal). */
typedef struct IrradianceEstimate {
    Rgb E;              // irradiance, W/m^2
    Rgb translation[2]; // dE/dx, dE/dy, W/m^3
    Rgb rotation[2];    // dE per radian of rotation of the normal about x, about y
    float R;            // harmonic mean distance of the rays, metres; INFINITY when nothing is near
} IrradianceEstimate;

/**
 * @param s         the strata, cosine-weighted
 * @param L         [cells] radiance from there, W m^-2 sr^-1
 * @param distance  [cells] distance of what sends it, metres; INFINITY for the sky
 * Rays are cosine-weighted, so R is the harmonic mean under that density (it weighs what is overhead more than a
 * mean over solid angle would). Pure, thread-safe, no allocation.
 *
 * Source: ward1992-gradients. Translation in the form that agrees with dense quadrature: every wall between rings,
 * and sin(theta) at the edges of a cell across the wall between sectors,
 *   grad E = sum_k { u_k (2 pi / N) sum_{j>=1} sin(t_j-) cos^2(t_j-) (L_jk - L_j-1,k) / min(r_jk, r_j-1,k)
 *                  + v_k- sum_j (sin(t_j+) - sin(t_j-)) (L_jk - L_j,k-1) / min(r_jk, r_j,k-1) }.
 * krivanek2005-improved-radiance-gradients prints cos(theta) of the jittered sample instead, which is biased.
 * Rotation: E(n') = E + (n x n') . grad_r E with grad_r E = integral of L (n x d) over solid angle. Radiance counts as
 * even in a stratum: the tangent of the sample's zenith angle that is printed makes grazing samples count without
 * bound.
 */
void sheen_estimate_irradiance(SheenStrata s, const Rgb L[], const float distance[], IrradianceEstimate *out);

/** The angle by which bump and normal maps are taken to bend normals where it shows: what is said of bent normals is
 *  best there. Of 0.3, 0.5 and 0.8 it is the best on walls whose steepest places are bent by 0.3 to 0.7. */
#define SHEEN_BEND 0.5f

/** What comes from between the planes of a normal n and of one bent away from it. */
typedef struct BehindEstimate {
    Rgb mean;      // over the azimuths in which it is bent, W/m^2; over 1 - cos(theta)
    float lean[2]; // relative change with the azimuth
} BehindEstimate;

/**
 * With m bent from n by theta toward the azimuth phi, the integral of L max(0, m . d) above n is E cos(theta) +
 * (n x m) . grad_r E, plus the integral of L max(0, -m . d), light that the former counts negatively: for light that is
 * alike from everywhere (1 - cos(theta)) E / 2. This is that integral at theta = SHEEN_BEND, over 1 - cos(theta); of
 * its Fourier series in phi the mean and, relative to it and by the luminance, the first harmonic.
 * @param s, L  as for sheen_estimate_irradiance
 */
void sheen_estimate_behind(SheenStrata s, const Rgb L[], BehindEstimate *out);

/** A gradient (d/dx, d/dy in the local frame) as one world-space vector for each colour channel. */
static inline void estimate_world_gradient(const Frame *f, const Rgb local[2], Vec3 out[3])
{
    out[0] = v3_mad(v3_scale(f->t, local[0].r), local[1].r, f->b);
    out[1] = v3_mad(v3_scale(f->t, local[0].g), local[1].g, f->b);
    out[2] = v3_mad(v3_scale(f->t, local[0].b), local[1].b, f->b);
}

/**
 * The radius that the estimate allows: the harmonic mean, bounded by E / |grad E| of the luminance.
 * Source: krivanek2006-making-caching-practical eq. (2).
 */
static inline float estimate_gradient_radius(const IrradianceEstimate *e)
{
    float g = hypotf(rgb_luminance(e->translation[0]), rgb_luminance(e->translation[1]));
    return g > 0.0f ? minf(e->R, maxf(rgb_luminance(e->E), 0.0f) / g) : e->R;
}

/** What a gradient that holds within a radius is scaled by where it is used farther away: it would overshoot. */
static inline float estimate_gradient_share(float radius, float used)
{
    return radius < used ? maxf(radius, 0.0f) / used : 1.0f;
}

/** Scales the translation gradient down for a record that is used farther than its radius. */
static inline void estimate_enlarge(float radius, float used, IrradianceEstimate *e)
{
    float scale = estimate_gradient_share(radius, used);
    for (int i = 0; i < 2; ++i) e->translation[i] = rgb_scale(e->translation[i], scale);
}

/** Harmonic mean n / sum(1 / d); distances of INFINITY are zero terms. INFINITY when all are. */
float sheen_harmonic_mean(unsigned n, const float distance[]);

#endif
