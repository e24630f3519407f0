// SPDX-License-Identifier: Apache-2.0
// How radiance records are made.
#ifndef SHEEN_INTEGRATOR_RADIANCE_RECORD_H
#define SHEEN_INTEGRATOR_RADIANCE_RECORD_H

#include "cache/radiance_cache.h"
#include "integrator/deep.h"
#include "integrator/fill.h"

typedef struct SheenRadianceMaker SheenRadianceMaker;

/**
 * @param deep  light beyond the first bounce; NULL when it is traced as paths, or when there is none
 * @param like  a cache with the basis and the order of the records
 * @param out   owned by the caller; borrows work, deep and `like`
 */
SHEEN_NODISCARD SheenStatus sheen_radiance_maker_create(const SheenWork *work, const SheenDeep *deep,
                                                        const SheenRadianceCache *like, SheenRadianceMaker **out);
void sheen_radiance_maker_destroy(SheenRadianceMaker **maker);

/** What sheen_fill_run needs to fill a cache; borrows both. */
RecordKind sheen_radiance_kind(const SheenRadianceMaker *maker, SheenRadianceCache *cache);

#endif
