// SPDX-License-Identifier: Apache-2.0
// Pass 3: emitted, direct and interpolated indirect light become pixels.
#ifndef SHEEN_INTEGRATOR_SHADE_H
#define SHEEN_INTEGRATOR_SHADE_H

#include "integrator/caches.h"
#include "integrator/visibility.h"

/** What a picture reads: records that outlive it and, where these say nothing, its own. */
typedef struct PictureCaches {
    const SheenCaches *kept, *own;
} PictureCaches;

/**
 * Shades samples [first, ...) of every pixel up to as many as picture->samples has.
 * @param caches     NULL when there is no indirect light to read
 * @param uncovered  out: points whose indirect light is still missing, with their direct light already in the film, in
 *                   the order of tiles
 * Errors: SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_shade(const SheenWork *work, const PictureCaches *caches, uint32_t first,
                                        Picture *picture, SeenPoints *uncovered, SheenStats *stats);

/** Adds the indirect light of points that were sampled. @param E  [n] irradiance */
void sheen_shade_sampled(const ShadingPoint points[], size_t n, const Rgb E[], Picture *picture, SheenStats *stats);

/** Adds the indirect light of points that have records by now. */
void sheen_shade_uncovered(const SheenOptions *o, const PictureCaches *caches, const SeenPoints *uncovered,
                           Picture *picture, SheenStats *stats);

#endif
