// SPDX-License-Identifier: Apache-2.0
// Pass 2: records are made where shading points have none, in waves, until all points are covered.
#ifndef SHEEN_INTEGRATOR_FILL_H
#define SHEEN_INTEGRATOR_FILL_H

#include "cache/store.h"
#include "integrator/visibility.h"

/** How records of one kind are made and kept. */
typedef struct RecordKind {
    const SheenRecordStore *store;
    size_t light_size; // bytes of a record's light
    void *user;
    /** Makes the record of a point, and its light; a function of the point and the key alone. Thread-safe for workers
     *  of different numbers. */
    void (*make)(void *user, const ShadingPoint *p, uint32_t key, unsigned worker, SheenStats *stats, Record *record,
                 void *light);
    /** Stores both, copied. Errors: SHEEN_ERR_NOMEM. */
    SheenStatus (*insert)(void *user, const Record *record, const void *light);
} RecordKind;

/**
 * Adds records until each point is covered. The result depends on the points and their order only.
 * @param points  [n] shading points, in the order of their pixels
 * Errors: SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_fill_run(const SheenWork *work, const RecordKind *kind, const ShadingPoint points[],
                                           size_t n, SheenStats *stats);

#endif
