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

/** Buffers of one worker. */
typedef struct DirectScratch {
    Ray *rays;               // [capacity]
    Rgb *irradiance;         // [capacity]
    unsigned char *occluded; // [capacity]
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
