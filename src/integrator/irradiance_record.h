// SPDX-License-Identifier: Apache-2.0
// How irradiance records are made.
#ifndef SHEEN_INTEGRATOR_IRRADIANCE_RECORD_H
#define SHEEN_INTEGRATOR_IRRADIANCE_RECORD_H

#include "cache/irradiance_cache.h"
#include "integrator/deep.h"
#include "integrator/fill.h"

typedef struct SheenIrradianceMaker SheenIrradianceMaker;

/**
 * @param deep   light beyond the first bounce; NULL when it is traced as paths, or when there is none
 * @param rays   first ones of each gather
 * @param error  relative standard error of irradiance for which more rays follow
 * @param out    owned by the caller; borrows work and deep
 */
SHEEN_NODISCARD SheenStatus sheen_irradiance_maker_create(const SheenWork *work, const SheenDeep *deep, uint32_t rays,
                                                          float error, SheenIrradianceMaker **out);
void sheen_irradiance_maker_destroy(SheenIrradianceMaker **maker);

/** What sheen_fill_run needs to fill a cache; borrows both. */
RecordKind sheen_irradiance_kind(const SheenIrradianceMaker *maker, SheenIrradianceCache *cache);

#endif
