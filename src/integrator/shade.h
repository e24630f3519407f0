// SPDX-License-Identifier: Apache-2.0
// Pass 3: emitted, direct and interpolated indirect light become pixels.
#ifndef SHEEN_INTEGRATOR_SHADE_H
#define SHEEN_INTEGRATOR_SHADE_H

#include "cache/irradiance_cache.h"
#include "cache/radiance_cache.h"
#include "integrator/visibility.h"

/** The caches that a picture reads; any may be NULL. */
typedef struct SheenCaches {
    SheenIrradianceCache *irradiance;
    SheenRadianceCache *radiance[SHEEN_BASIS_COUNT];
} SheenCaches;

/**
 * Shades samples [first, ...) of every pixel up to as many as picture->samples has.
 * @param caches     NULL when there is no indirect light to read
 * @param uncovered  out: points whose indirect light is still missing, with their direct light already in the film, in
 *                   the order of tiles
 * Errors: SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_shade(const SheenWork *work, const SheenCaches *caches, uint32_t first,
                                        Picture *picture, SeenPoints *uncovered, SheenStats *stats);

/** Adds the indirect light of points that have records by now. */
void sheen_shade_uncovered(const SheenWork *work, const SheenCaches *caches, const SeenPoints *uncovered,
                           Picture *picture, SheenStats *stats);

#endif
