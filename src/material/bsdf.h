// SPDX-License-Identifier: Apache-2.0
// What a surface does with light. Directions are local, in frame_from_normal(s->ns) of the surface point (z along the
// shading normal), and point away from the surface.
//
// A material becomes a list of lobes: elementary BSDFs, each with a share of the whole, each of one class. Wrappers
// stand between the surface and a lobe: another frame (bump and normal maps, anisotropy), the mirrored back side, a
// coating. See docs/materials.md.
#ifndef SHEEN_MATERIAL_BSDF_H
#define SHEEN_MATERIAL_BSDF_H

#include "math/fresnel.h"
#include "ray/surface.h"
#include "scene/scene.h"

enum { SHEEN_BSDF_MAX_LOBES = SHEEN_MATERIAL_MAX_LOBES, SHEEN_BSDF_MAX_WRAPS = SHEEN_MATERIAL_MAX_WRAPS };
/** A lobe is two delta lobes at most: a mirror and a refraction. */
enum { SHEEN_BSDF_MAX_DELTA = 2 * SHEEN_BSDF_MAX_LOBES };

/** Classes of lobes; may be combined. */
typedef enum BsdfClass {
    SHEEN_BSDF_DIFFUSE = 1, // nearly Lambertian reflection: what an irradiance is enough for
    SHEEN_BSDF_GLOSSY = 2,  // every other smooth lobe, transmission included
    SHEEN_BSDF_DELTA = 4,   // mirrors, refraction, straight passage
    SHEEN_BSDF_SMOOTH = SHEEN_BSDF_DIFFUSE | SHEEN_BSDF_GLOSSY,
    SHEEN_BSDF_ALL = SHEEN_BSDF_SMOOTH | SHEEN_BSDF_DELTA,
} BsdfClass;

/** An elementary BSDF with its textures looked up. Its fields are for src/material. */
typedef struct BsdfLobe {
    const struct BsdfOps *ops;
    const SheenMaterial *material;   // what it is a part of, for constants
    float weight;                    // share of the whole, [0, 1]
    uint32_t wrap;                   // the innermost wrapper around it, counted from 1; 0 for none
    const SheenLafortune *lafortune; // of a lobe of Lafortune's
    Rgb reflectance, transmittance;
    Microfacet microfacet;
    struct {
        float roughness, metallic, spec_trans, spec_tint, sheen, sheen_tint, flatness, clearcoat, clearcoat_gloss;
    } principled;
} BsdfLobe;

typedef enum BsdfWrapKind {
    SHEEN_WRAP_TWO_SIDED, // seen from behind, the normal is turned round
    SHEEN_WRAP_FRONT,     // black from behind
    SHEEN_WRAP_BACK,      // black from the front, and turned round
    SHEEN_WRAP_FRAME,     // another frame
    SHEEN_WRAP_COAT,      // a refracting layer
} BsdfWrapKind;

/** What stands between the surface and lobes. Its fields are for src/material. */
typedef struct BsdfWrap {
    BsdfWrapKind kind;
    uint32_t outer;                // the wrapper around this one, counted from 1; 0 for none
    Frame frame;                   // in the frame outside
    const SheenMaterial *material; // the coating, or the map
    float alpha;                   // of the coating
} BsdfWrap;

/** A BSDF at a point, made in shading, passed by pointer. What is beyond the counts is not initialized. */
typedef struct Bsdf {
    uint32_t n_lobes, n_wraps;
    BsdfLobe lobes[SHEEN_BSDF_MAX_LOBES];
    BsdfWrap wraps[SHEEN_BSDF_MAX_WRAPS];
} Bsdf;

/** One sampled direction. */
typedef struct BsdfSample {
    Vec3 wi_l;     // unit
    Rgb weight;    // f |cos(theta_i)| / pdf; for a delta lobe the lobe's factor over the probability of choosing it
    float pdf;     // solid angle density, 1/sr; for a delta lobe the probability of choosing it
    bool delta;    // a mirror or refraction: eval and pdf do not see it
    bool transmit; // wi_l is on the other side than wo_l
    bool passage;  // a delta lobe that goes straight on as if there was no surface: shadow rays do as well, so that it
                   // is no scattering; its factor is sheen_material_passage
    // Of the lobe that was drawn, by sheen_bsdf_sample_of alone:
    float roughness; // alpha, of two axes the mean; 0 for a delta lobe, 1 for a diffuse one
    bool layer;      // it only ever lies upon something else: a coat, a highlight
} BsdfSample;

/** Looks the textures up at a surface point. */
void sheen_bsdf_look_up(const SheenScene *scene, const SurfacePoint *s, Bsdf *out);
/** The same where the copy of more than a kilobyte does not count. */
Bsdf sheen_bsdf_at(const SheenScene *scene, const SurfacePoint *s);

// ---- the whole --------------------------------------------------------------------------------------------------

/** @return the classes of its lobes. */
unsigned sheen_bsdf_classes(const Bsdf *bsdf);

/** @return true when the BSDF has only delta lobes: it is followed, not lit. */
bool sheen_bsdf_is_delta(const Bsdf *bsdf);

/** @return true when it is glossy and all its lobes reflect and are at least so rough (alpha), those that only ever lie
 *  upon something else `least_layer`. */
bool sheen_bsdf_is_rough(const Bsdf *bsdf, float least, float least_layer);

/** @return true when a smooth lobe sends light to the other side: then lights on both sides matter. */
bool sheen_bsdf_transmits(const Bsdf *bsdf);

/**
 * @param classes  which lobes count; SHEEN_BSDF_ALL for the whole
 * @return f(wo, wi) |cos(theta_i)|, 1/sr; zero for delta lobes. A one-sided surface is black from behind.
 */
Rgb sheen_bsdf_eval_of(const Bsdf *bsdf, unsigned classes, Vec3 wo_l, Vec3 wi_l);
static inline Rgb sheen_bsdf_eval(const Bsdf *bsdf, Vec3 wo_l, Vec3 wi_l)
{
    return sheen_bsdf_eval_of(bsdf, SHEEN_BSDF_ALL, wo_l, wi_l);
}

/** @return the density, 1/sr, with which sheen_bsdf_sample_of draws wi_l; zero for delta lobes. */
float sheen_bsdf_pdf_of(const Bsdf *bsdf, unsigned classes, Vec3 wo_l, Vec3 wi_l);
static inline float sheen_bsdf_pdf(const Bsdf *bsdf, Vec3 wo_l, Vec3 wi_l)
{
    return sheen_bsdf_pdf_of(bsdf, SHEEN_BSDF_ALL, wo_l, wi_l);
}

/** @return false when the light is absorbed. `lobe` chooses among lobes, u places the direction; all in [0, 1). */
bool sheen_bsdf_sample_of(const Bsdf *bsdf, unsigned classes, Vec3 wo_l, float lobe, Vec2 u, BsdfSample *out);
static inline bool sheen_bsdf_sample(const Bsdf *bsdf, Vec3 wo_l, float lobe, Vec2 u, BsdfSample *out)
{
    return sheen_bsdf_sample_of(bsdf, SHEEN_BSDF_ALL, wo_l, lobe, u, out);
}

/**
 * The delta lobes, all of them, for a deterministic split, each with pdf 1 and its factor as weight. Those in the same
 * direction are one, but passage stands alone.
 * @return their number; 0 for a BSDF without delta lobes or when all is absorbed
 */
int sheen_bsdf_delta_lobes(const Bsdf *bsdf, Vec3 wo_l, BsdfSample out[SHEEN_BSDF_MAX_DELTA]);

/**
 * @return the share of the energy that wo's direction scatters into all others, transmission included, each channel in
 *         [0, 1]; without the factor 1/eta^2 that refraction puts on radiance. Closed forms where there are, else a
 *         fixed quadrature, good to about 2 %: for layers and choices, not for light.
 */
Rgb sheen_bsdf_albedo(const Bsdf *bsdf, Vec3 wo_l);

// ---- for caches -------------------------------------------------------------------------------------------------

/**
 * The diffuse lobes as one Lambertian surface: their radiance toward wo is the result times irradiance / pi. Exact for
 * Lambert's lobe. The base of a plastic and the diffuse lobe of `principled` depend on wi as well: the result is their
 * directional albedo for wo, exact under light that is alike from everywhere; so is the fading of light along a map.
 * @param n_l  gets the unit normal about which the irradiance is meant, on the side of wo: z or -z unless a map
 * perturbs it (that of the heaviest diffuse lobe); NULL when not wanted
 * @return zero where there is no diffuse lobe, or wo is behind it
 */
Rgb sheen_bsdf_diffuse(const Bsdf *bsdf, Vec3 wo_l, Vec3 *n_l);

/** @return true when a bump or normal map stands between the surface and a lobe. */
bool sheen_bsdf_is_mapped(const Bsdf *bsdf);

/**
 * @return false when nothing of a material, anywhere, is a mirror, glass, or metal, rough or not: what shows lamps that
 *         light samples do not find. Passage does not: they do.
 */
bool sheen_material_may_be_delta(const SheenScene *scene, uint32_t material);

#endif
