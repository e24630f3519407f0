// SPDX-License-Identifier: Apache-2.0
// The cached integrators: visibility, fill, shade. `irradiance` samples what is glossy, `radiance` caches what of it
// harmonics can hold. Records outlive a picture: a scene that stands still is filled for some views, settled, and
// shaded from any.
#ifndef SHEEN_INTEGRATOR_CACHED_H
#define SHEEN_INTEGRATOR_CACHED_H

#include "integrator/caches.h"

typedef struct SheenCached SheenCached;

/**
 * @param work   what all views share is copied; borrows what it points to. Its view and `glossy` are not read
 * @param gloss  whether glossy light is cached where it can be
 * @param out    owned by the caller
 * Errors: SHEEN_ERR_INVALID, SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_cached_create(const SheenWork *work, bool gloss, SheenStats *stats,
                                                SheenCached **out);
void sheen_cached_destroy(SheenCached **cached);

/**
 * Adds a view's surroundings to those from which light beyond the first bounce is explored. To be called for all views
 * before the first is filled: what is explored is explored once.
 * Errors: SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_cached_look(SheenCached *cached, const SheenView *view, SheenStats *stats);

/**
 * Adds records until they cover what the first sample of each of a view's pixels sees. With records that covered it
 * before, nothing is done.
 * Errors: SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED; the records made so far stay.
 */
SHEEN_NODISCARD SheenStatus sheen_cached_fill(SheenCached *cached, const SheenView *view, SheenStats *stats);

/** Lets the records made since the last time learn from their neighbors. Is not cancelled. Errors: SHEEN_ERR_NOMEM. */
SHEEN_NODISCARD SheenStatus sheen_cached_settle(SheenCached *cached, SheenStats *stats);

/**
 * Renders a view into the film and counts into *stats, see work.h. The picture is a function of the scene, the view and
 * the settled records: what they leave uncovered, small things between the first samples of pixels, gets records of
 * the picture's own, which end with it, or is sampled, see give_way.h.
 * Errors: SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED (the film is then incomplete).
 */
SHEEN_NODISCARD SheenStatus sheen_cached_shade(SheenCached *cached, const SheenView *view, SheenFilm *film,
                                               SheenStats *stats);

/** The records. Those added from outside count as settled when sheen_cached_adopt is called after it. */
SheenCaches *sheen_cached_caches(SheenCached *cached);
void sheen_cached_adopt(SheenCached *cached);

#endif
