// SPDX-License-Identifier: Apache-2.0
// Records learn from their neighbors: the noise of the gathers is averaged out before it is seen.
#ifndef SHEEN_CACHE_SMOOTH_H
#define SHEEN_CACHE_SMOOTH_H

#include "base/pool.h"
#include "cache/irradiance_cache.h"
#include "cache/radiance_cache.h"

/**
 * Replaces the irradiance and the gradients of each record by means over what it and its neighbors, as far as twice the
 * reach that they would have at the accuracy of the cache, say there: each weighed by the inverse of its variance,
 * which is that of its gather and, for a neighbor, the square of the interpolation error to be expected. A record
 * without noise stays as it is.
 * @param first   records before it stay as they are, and are learnt from
 * @param cancel  may be NULL
 * Errors: SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED; the cache is unchanged then. The result does not depend on the pool.
 */
SHEEN_NODISCARD SheenStatus sheen_irradiance_cache_smooth(SheenIrradianceCache *cache, uint32_t first,
                                                          const Bounds *bounds, SheenPool *pool,
                                                          const atomic_bool *cancel);

/** The same of radiance records, by the mean of what comes in. Hemispherical ones learn from their like alone: those
 *  with the same normal, to half a degree. Those that were refined learn less. */
SHEEN_NODISCARD SheenStatus sheen_radiance_cache_smooth(SheenRadianceCache *cache, uint32_t first, const Bounds *bounds,
                                                        SheenPool *pool, const atomic_bool *cancel);

#endif
