// SPDX-License-Identifier: Apache-2.0
// What a surface does with light. Directions are local (z along the shading normal) and point away from the surface.
#ifndef SHEEN_MATERIAL_BSDF_H
#define SHEEN_MATERIAL_BSDF_H

#include "ray/surface.h"
#include "scene/scene.h"

/** A BSDF at a point: a material with its textures looked up. Small, passed by pointer, made in shading. */
typedef struct Bsdf {
    const SheenMaterial *material;
    Rgb reflectance;            // diffuse
    Rgb specular_reflectance;   // specular kinds
    Rgb specular_transmittance; // dielectrics
} Bsdf;

/** One sampled direction. */
typedef struct BsdfSample {
    Vec3 wi_l;     // unit
    Rgb weight;    // f cos(theta_i) / pdf; for a delta lobe the lobe's factor over the probability of choosing it
    float pdf;     // solid angle density, 1/sr; for a delta lobe the probability of choosing it
    bool delta;    // a mirror or refraction: eval and pdf do not see it
    bool transmit; // wi_l is on the other side than wo_l
} BsdfSample;

/** Looks the textures up at a surface point. */
Bsdf sheen_bsdf_at(const SheenScene *scene, const SurfacePoint *s);

/** @return true when the BSDF has only delta lobes: it is followed, not lit. */
bool sheen_bsdf_is_delta(const Bsdf *bsdf);

/** @return f(wo, wi) |cos(theta_i)|, 1/sr; zero for delta lobes. A one-sided diffuse surface is black from behind. */
Rgb sheen_bsdf_eval(const Bsdf *bsdf, Vec3 wo_l, Vec3 wi_l);

/** @return the density, 1/sr, with which sheen_bsdf_sample draws wi_l; zero for delta lobes. */
float sheen_bsdf_pdf(const Bsdf *bsdf, Vec3 wo_l, Vec3 wi_l);

/** @return false when the light is absorbed. `lobe` chooses among lobes, u places the direction; all in [0, 1). */
bool sheen_bsdf_sample(const Bsdf *bsdf, Vec3 wo_l, float lobe, Vec2 u, BsdfSample *out);

/**
 * The delta lobes, all of them, for a deterministic split: at most 2, each with pdf 1 and its factor as weight.
 * @return their number; 0 for a BSDF without delta lobes or when all is absorbed
 */
int sheen_bsdf_delta_lobes(const Bsdf *bsdf, Vec3 wo_l, BsdfSample out[2]);

/**
 * @return the share of the energy that wo's direction scatters into all others, transmission included, each channel in
 *         [0, 1]; without the factor 1/eta^2 that refraction puts on radiance
 */
Rgb sheen_bsdf_albedo(const Bsdf *bsdf, Vec3 wo_l);

/** Reflectance of a smooth dielectric. eta: interior over exterior; cos_i > 0 from outside, < 0 from inside.
 *  *cos_t: cosine of the refracted direction on the other side, sign opposite to cos_i; 0 at total reflection. */
float sheen_fresnel_dielectric(float cos_i, float eta, float *cos_t);

/** Reflectance of a smooth conductor of relative index eta + i k, for cos_i in [0, 1], one channel. */
float sheen_fresnel_conductor(float cos_i, float eta, float k);

#endif
