// SPDX-License-Identifier: Apache-2.0
// Pass 3: emitted, direct and interpolated indirect light become pixels.
#ifndef SHEEN_INTEGRATOR_SHADE_H
#define SHEEN_INTEGRATOR_SHADE_H

#include "cache/irradiance_cache.h"
#include "integrator/visibility.h"

/** Points that no record covered when they were shaded, with their direct light already in the film. */
typedef struct Uncovered {
    ShadingPoint *points; // in the order of tiles
    size_t n, capacity;
} Uncovered;

void sheen_uncovered_free(Uncovered *u);

/**
 * Shades samples [first, ...) of every pixel up to as many as picture->samples has.
 * @param cache      NULL when there is no indirect light to read
 * @param uncovered  out: points whose indirect light is still missing
 * Errors: SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_shade(const SheenWork *work, const SheenIrradianceCache *cache, uint32_t first,
                                        Picture *picture, Uncovered *uncovered, SheenStats *stats);

/** Adds the indirect light of points that have records by now. */
void sheen_shade_uncovered(const SheenWork *work, const SheenIrradianceCache *cache, const Uncovered *uncovered,
                           Picture *picture, SheenStats *stats);

#endif
