// SPDX-License-Identifier: Apache-2.0
// Light straight from emitters at many points at once.
#ifndef SHEEN_INTEGRATOR_DIRECT_H
#define SHEEN_INTEGRATOR_DIRECT_H

#include "integrator/follow.h"

/** Which light a sample asks, and its random numbers. */
typedef struct LightNumbers {
    uint32_t light; // SHEEN_NONE: one is chosen
    float choice;   // for that
    Vec2 place;
} LightNumbers;

/** How the light samples of a shading point are shared out. */
typedef struct LightPlan {
    uint32_t each;    // lights that are asked one after another; 0: one is chosen for each sample
    uint32_t samples; // of each light, but 1 of those without size; or in all
} LightPlan;

/** So many lights are asked one after another. */
enum { SHEEN_FEW_LIGHTS = 4 };

LightPlan sheen_light_plan(const SheenWork *work);

/** Where the random numbers of a shading point's light samples are. */
typedef struct LightSequence {
    uint32_t key;
    uint32_t index; // of the first; they follow each other
} LightSequence;

/** @param branch, pixel, sample  of the way that sees the point */
LightSequence sheen_light_sequence(const SheenWork *work, LightPlan plan, uint32_t branch, uint32_t pixel,
                                   uint32_t sample);

/** The numbers of one light sample. @param light  that is asked; SHEEN_NONE: one is chosen */
static inline LightNumbers sheen_light_numbers(uint32_t key, uint32_t index, uint32_t light)
{
    SheenSampler sampler = sampler_make(key ^ (light == SHEEN_NONE ? 0 : hash_u32(light + 1)), index);
    float choice = hash_to_unit(key + index * 0x9e3779b9u); // steps of the golden ratio
    return (LightNumbers){light, choice, sampler_2d(&sampler)};
}

/** Buffers of one worker. */
typedef struct DirectScratch {
    Ray *rays;            // [capacity]
    Rgb *irradiance;      // [capacity]
    float *transmittance; // [capacity]
    size_t capacity;
} DirectScratch;

/** Makes room for n points; false when out of memory. */
bool sheen_direct_reserve(DirectScratch *scratch, size_t n);
void sheen_direct_free(DirectScratch *scratch);

/**
 * Adds scale times one sample of the direct irradiance at each point: the light that is named, or one chosen by
 * its unshadowed contribution there, is asked.
 * @param points   [n]; the sample is over the hemisphere about the shading normal, above the geometric surface
 * @param numbers  [n]
 * @param E        [n] W/m^2, added to
 * @return shadow rays traced
 */
uint64_t sheen_direct_add(const SheenWork *work, size_t n, const DiffusePoint points[], const LightNumbers numbers[],
                          float scale, DirectScratch *scratch, Rgb E[]);

#endif
