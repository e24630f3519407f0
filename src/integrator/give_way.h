// SPDX-License-Identifier: Apache-2.0
// Where caching gives way to sampling: a record takes a thousand rays, and among things smaller than a pixel it serves
// two or three points. There each point gathers by itself with a few rays, which end in the same deep records.
#ifndef SHEEN_INTEGRATOR_GIVE_WAY_H
#define SHEEN_INTEGRATOR_GIVE_WAY_H

#include "integrator/irradiance_record.h"

/** Rays of such a point. The samples of a pixel have theirs each. */
enum { SHEEN_SAMPLED_RAYS = 32 };

/**
 * Which points are to be sampled: those of squares of the picture in which fewer rays are needed so than for the
 * records that the points would need, as far apart as the records around let expect.
 * @param store    records that leave the points uncovered
 * @param sampled  [n] out
 * Depends on nothing else. Errors: SHEEN_ERR_NOMEM.
 */
SHEEN_NODISCARD SheenStatus sheen_give_way_choose(const SheenWork *work, const SheenRecordStore *store,
                                                  const ShadingPoint points[], size_t n, bool sampled[]);

/**
 * Irradiance at points, each by a gather of its own.
 * @param maker  of gathers of SHEEN_SAMPLED_RAYS
 * @param E      [n] out
 * Errors: SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_give_way_gather(const SheenWork *work, const SheenIrradianceMaker *maker,
                                                  const ShadingPoint points[], size_t n, Rgb E[], SheenStats *stats);

#endif
