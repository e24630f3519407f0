// SPDX-License-Identifier: Apache-2.0
// Light that arrives straight from emitters: which one to ask, where on it, how much comes from there.
#ifndef SHEEN_LIGHT_LIGHT_H
#define SHEEN_LIGHT_LIGHT_H

#include "base/log.h"
#include "ray/surface.h"
#include "scene/scene.h"

/** What sampling needs of the scene's lights: bounds, area and image distributions. Immutable, thread-safe. */
typedef struct SheenLights SheenLights;

/** Which part of an environment the light sampling answers for. */
typedef enum SheenEnvironmentSplit {
    SHEEN_ENVIRONMENT_WHOLE, // all of it
    SHEEN_ENVIRONMENT_HARD,  // only what is brighter than sheen_environment_soft: sun and lamps. The caller gathers the
                             // soft rest with rays of its own
} SheenEnvironmentSplit;

/**
 * @param scene  borrowed; must outlive the result
 * @param out    owned by the caller; NULL on failure
 * Errors: SHEEN_ERR_NOMEM; SHEEN_ERR_UNSUPPORTED for more than 2^20 lights, or 256 directional ones.
 */
SHEEN_NODISCARD SheenStatus sheen_lights_create(const SheenScene *scene, SheenEnvironmentSplit split,
                                                const SheenLog *log, SheenLights **out);

/** Frees the lights and sets *lights to NULL. NULL-safe. */
void sheen_lights_destroy(SheenLights **lights);

/** One sample of the light that arrives at a point from one light. */
typedef struct LightSample {
    Vec3 wi;       // unit, toward the light
    Vec3 target;   // end of the shadow ray, off the light's surface toward the point; finite lights only
    bool infinite; // environment and directional: the shadow ray has no end
    bool delta;    // point, spot, directional without a disk: no other technique can find it; pdf is 1
    Rgb radiance;  // arriving radiance over pdf: L / pdf for the others; E over a facing surface for delta lights
    float pdf;     // solid angle density, 1/sr
} LightSample;

/** @return the number of lights that can be asked (area lights without area and black lights are left out). */
uint32_t sheen_lights_count(const SheenLights *lights);

/**
 * Chooses one light for a point in proportion to an estimate of its unshadowed contribution there, never zero for a
 * light that can contribute.
 * @param p, n       the point and its unit normal on the side that is lit
 * @param u          in [0, 1); on return rescaled to be uniform again
 * @param light      index for the functions below
 * @return the probability of the choice; 0 when none is chosen, since none that came into question can reach the
 *         point. A single light is always chosen
 */
float sheen_lights_choose(const SheenLights *lights, Vec3 p, Vec3 n, float *u, uint32_t *light);

/** @return the probability with which sheen_lights_choose picks `light` at (p, n). */
float sheen_lights_choose_probability(const SheenLights *lights, Vec3 p, Vec3 n, uint32_t light);

/** @return whether all samples of a light at one point are alike: point, spot, directional without a disk. */
bool sheen_light_is_delta(const SheenLights *lights, uint32_t light);

/** Samples a light as seen from p, by solid angle where a closed form exists. @return false when nothing arrives. */
bool sheen_light_sample(const SheenLights *lights, uint32_t light, Vec3 p, Vec2 u, LightSample *out);

/**
 * @return the density, 1/sr, with which sheen_light_sample from p draws the direction toward a hit on an emitting
 *         surface (`light` from sheen_lights_of_shape). `hit` is the point on the light.
 */
float sheen_light_pdf_hit(const SheenLights *lights, uint32_t light, Vec3 p, const SurfacePoint *hit);

/** The same for a direction that leaves the scene, of the environment or a sun. */
float sheen_light_pdf_escape(const SheenLights *lights, uint32_t light, Vec3 wi);

/** @return the index for the functions above of the light on a shape, or SHEEN_NONE. */
uint32_t sheen_lights_of_shape(const SheenLights *lights, uint32_t shape);
/** @return the index for the functions above of the environment, or SHEEN_NONE. */
uint32_t sheen_lights_environment(const SheenLights *lights);

/**
 * Suns: directional lights with a disk.
 * @param first  gets the index for the functions above of the first; the others follow
 * @return their number
 */
uint32_t sheen_lights_suns(const SheenLights *lights, uint32_t *first);

/** @return radiance that arrives along wi (unit, pointing out of the scene) from one sun's disk. W m^-2 sr^-1. */
Rgb sheen_sun(const SheenLights *lights, uint32_t sun, Vec3 wi);
/** The same from all of them, which sheen_environment does not know. */
Rgb sheen_suns(const SheenLights *lights, Vec3 wi);

/** @return radiance that a surface point emits toward wo (unit): zero for no light or from behind. W m^-2 sr^-1. */
Rgb sheen_emitted(const SheenScene *scene, const SurfacePoint *s, Vec3 wo);

/** @return radiance that arrives along wi (unit, pointing out of the scene) from the environment. W m^-2 sr^-1. */
Rgb sheen_environment(const SheenScene *scene, Vec3 wi);

/**
 * @return the part of sheen_environment(scene, wi) that the samples of the environment light leave out: the radiance
 *         scaled so that its luminance is at most a small multiple of the environment's mean with
 *         SHEEN_ENVIRONMENT_HARD (all of it when nothing is brighter); zero with SHEEN_ENVIRONMENT_WHOLE
 */
Rgb sheen_environment_soft(const SheenLights *lights, Vec3 wi);

/** A shadow ray from `s` to a light sample, starting and ending off the surfaces. */
Ray sheen_shadow_ray(const SurfacePoint *s, const LightSample *sample);

#endif
