// SPDX-License-Identifier: Apache-2.0
// Light on surfaces that the camera sees and that are not Lambert's alone: light samples see the whole BSDF, and rays
// along its glossy part find what they find; both weigh each other.
#ifndef SHEEN_INTEGRATOR_GLOSSY_H
#define SHEEN_INTEGRATOR_GLOSSY_H

#include "integrator/direct.h"

/** A surface as the camera sees it. */
typedef struct SeenSurface {
    SurfacePoint s;
    Bsdf bsdf;
    bool cached; // part of the glossy light is read from a cache: light samples stand for all that lamps send to it,
    Bsdf rest;   // and rays go along the rest alone; set only then
    Frame frame; // about the shading normal
    Vec3 wo_l;
    Vec3 side;       // geometric normal on the side of the viewer
    bool both_sides; // light from the other side is scattered too
} SeenSurface;

/** Completes one whose `s` is set. @param wo  unit, toward the viewer */
void sheen_seen_surface(const SheenWork *work, Vec3 wo, SeenSurface *out);

/** Where a ray along a glossy reflection comes from. */
typedef struct GlossyOrigin {
    Vec3 p, side;
    float pdf; // density of its direction, 1/sr
    bool both_sides;
} GlossyOrigin;

/**
 * Radiance toward the viewer that light samples find: of the diffuse part all, of the glossy part the share that rays
 * along it do not find better.
 * @param branch, pixel, sample  of the way that sees it: they key the random numbers, as those of a ShadingPoint do
 */
Rgb sheen_glossy_lit(const SheenWork *work, const SeenSurface *v, uint32_t branch, uint32_t pixel, uint32_t sample,
                     SheenStats *stats);

/** Radiance that a surface sends along wo as one light sample finds it, where no ray along its glossy part is drawn. */
Rgb sheen_glossy_lit_once(const SheenWork *work, const SurfacePoint *s, Vec3 wo, LightNumbers numbers,
                          SheenStats *stats);

/**
 * Draws the ray along the glossy part. @param roughness  gets that of the lobe drawn
 * @return false when all is absorbed
 */
bool sheen_glossy_ray(const SeenSurface *v, SheenSampler *sampler, Ray *ray, Rgb *weight, float *roughness,
                      GlossyOrigin *origin);

/** The share of light that such a ray found on a surface, sheen_emitted, or beyond all, sheen_environment and
 * sheen_suns. */
Rgb sheen_glossy_found(const SheenWork *work, const GlossyOrigin *origin, const SurfacePoint *s, Vec3 wo);
Rgb sheen_glossy_found_sky(const SheenWork *work, const GlossyOrigin *origin, Vec3 wi);

#endif
