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

/** Irradiance at a point, for its own normal, by a gather that makes no record. Thread-safe for workers of different
 *  numbers. @param key  of its random numbers */
Rgb sheen_irradiance_sample(const SheenIrradianceMaker *maker, const ShadingPoint *p, uint32_t key, unsigned worker,
                            SheenStats *stats);

/** What sheen_fill_run needs to fill a cache; borrows both. */
RecordKind sheen_irradiance_kind(const SheenIrradianceMaker *maker, SheenIrradianceCache *cache);

#endif
