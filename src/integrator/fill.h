// SPDX-License-Identifier: Apache-2.0
// Pass 2: records are made where shading points have none, in waves, until all points are covered.
#ifndef SHEEN_INTEGRATOR_FILL_H
#define SHEEN_INTEGRATOR_FILL_H

#include "cache/store.h"
#include "integrator/visibility.h"

/** How records of one kind are made and where they are kept. */
typedef struct RecordKind {
    size_t light_size; // bytes of a record's light
    const void *maker;
    /** Makes the record of a point, of accuracy a, and its light; a function of these and the key alone. Thread-safe
     *  for workers of different numbers. */
    void (*make)(const void *maker, const ShadingPoint *p, float a, uint32_t key, unsigned worker, SheenStats *stats,
                 Record *record, void *light);
    const SheenRecordStore *store;  // of the cache
    const SheenRecordStore *around; // other records that bound the radii of new ones; may be NULL
    void *cache;
    /** Stores both, copied. Errors: SHEEN_ERR_NOMEM. */
    SheenStatus (*insert)(void *cache, const Record *record, const void *light);
} RecordKind;

/**
 * @param points  [n]
 * @param open    out: whether a point needs a further record
 * Errors: SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_fill_is_open(const SheenWork *work, const SheenRecordStore *store,
                                               const ShadingPoint points[], size_t n, bool *open);

/**
 * Adds records until each point was covered once: later records' clamping may have uncovered some again. The result
 * depends on the store, the points and their order only.
 * @param points  [n] shading points, in the order of their pixels
 * Errors: SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_fill_run(const SheenWork *work, const RecordKind *kind, const ShadingPoint points[],
                                           size_t n, SheenStats *stats);

#endif
