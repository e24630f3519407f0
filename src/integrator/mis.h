// SPDX-License-Identifier: Apache-2.0
// Light samples against BSDF samples: what multiple importance sampling asks of the choice of a light.
#ifndef SHEEN_INTEGRATOR_MIS_H
#define SHEEN_INTEGRATOR_MIS_H

#include "light/light.h"

/**
 * Weight of a sample of density a where another technique would have drawn it with density b: a^2 / (a^2 + b^2), in a
 * form that does not overflow. Source: veach1997 ch. 9.
 */
static inline float power_heuristic(float a, float b)
{
    float ratio = b / a;
    return 1.0f / (1.0f + ratio * ratio);
}

/**
 * Chooses a light for a surface. Where it scatters light from both sides, a coin decides on the side first.
 * @param side  unit geometric normal on the side of the viewer
 * @param u     in [0, 1)
 * @return the probability, of the light by either way; 0 when none is chosen
 */
static inline float choose_light(const SheenLights *lights, Vec3 p, Vec3 side, bool both_sides, float u,
                                 uint32_t *light)
{
    if (!both_sides) return sheen_lights_choose(lights, p, side, &u, light);
    bool other = u >= 0.5f;
    u = other ? 2.0f * u - 1.0f : 2.0f * u;
    Vec3 back = v3_neg(side);
    float chosen = sheen_lights_choose(lights, p, other ? back : side, &u, light);
    if (!(chosen > 0.0f)) return 0.0f;
    return 0.5f * (chosen + sheen_lights_choose_probability(lights, p, other ? side : back, *light));
}

/** @return the probability with which choose_light picks `light`. */
static inline float choose_light_probability(const SheenLights *lights, Vec3 p, Vec3 side, bool both_sides,
                                             uint32_t light)
{
    float chosen = sheen_lights_choose_probability(lights, p, side, light);
    if (!both_sides) return chosen;
    return 0.5f * (chosen + sheen_lights_choose_probability(lights, p, v3_neg(side), light));
}

#endif
