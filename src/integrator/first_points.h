// SPDX-License-Identifier: Apache-2.0
// What the first sample of each pixel sees: where the fill looks for gaps, and from where deep light is explored.
#ifndef SHEEN_INTEGRATOR_FIRST_POINTS_H
#define SHEEN_INTEGRATOR_FIRST_POINTS_H

#include "integrator/visibility.h"

/**
 * Traces the first sample of each pixel.
 * @param ends    [pixels] 0 for pixels to leave out; NULL: none
 * @param points  out: is added to, in the order of tiles
 * Errors: SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_first_points(const SheenWork *work, const uint32_t ends[], SheenStats *stats,
                                               SeenPoints *points);

#endif
