// SPDX-License-Identifier: Apache-2.0
// Records of one kind are made and refined until nothing changes any more.
#ifndef SHEEN_INTEGRATOR_CONVERGE_H
#define SHEEN_INTEGRATOR_CONVERGE_H

#include "integrator/adapt.h"
#include "integrator/fill.h"

/** What converges. */
typedef struct Convergence {
    const SheenWork *work;
    const RecordKind *kind;
    AdaptCache cache;     // that the records are kept in
    unsigned rounds;      // at most
    SheenAdaptView *view; // made when it is first needed; NULL: records are not refined
} Convergence;

/**
 * Adds records until each point is covered and, with a view, until none of its points tells records apart, in rounds:
 * records where there are none, then one pass of refinement. A round after the first looks only at what the one before
 * touched: later records' clamping uncovers points again, and so does refinement. The result depends on the cache, the
 * points, their order and the view only.
 * @param points  [n] shading points, in the order of their pixels
 * Errors: SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED; the records made so far stay.
 * Source: krivanek2006-making-caching-practical sec. 4.2, algorithm 1, with a pass for all points in place of a queue.
 */
SHEEN_NODISCARD SheenStatus sheen_converge(const Convergence *c, const ShadingPoint points[], size_t n,
                                           SheenStats *stats);

#endif
