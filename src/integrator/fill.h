// SPDX-License-Identifier: Apache-2.0
// Pass 2: records are made where shading points have none, in waves, until all points are covered.
#ifndef SHEEN_INTEGRATOR_FILL_H
#define SHEEN_INTEGRATOR_FILL_H

#include "cache/irradiance_cache.h"
#include "integrator/deep.h"
#include "integrator/visibility.h"

typedef struct SheenFill SheenFill;

/**
 * @param deep  light beyond the first bounce; NULL when it is traced as paths, or when there is none
 * @param out   owned by the caller; borrows work, deep and cache
 */
SHEEN_NODISCARD SheenStatus sheen_fill_create(const SheenWork *work, const SheenDeep *deep, SheenIrradianceCache *cache,
                                              SheenFill **out);
void sheen_fill_destroy(SheenFill **fill);

/**
 * Adds records to the cache until each point is covered. The result depends on the points and their order only.
 * @param points  [n] shading points, in the order of their pixels
 * Errors: SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_fill_run(SheenFill *fill, const ShadingPoint points[], size_t n, SheenStats *stats);

#endif
