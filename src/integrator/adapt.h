// SPDX-License-Identifier: Apache-2.0
// Adaptive caching: records whose light is told from their neighbors' where both speak become more accurate.
// Source: krivanek2006-making-caching-practical sec. 4.
#ifndef SHEEN_INTEGRATOR_ADAPT_H
#define SHEEN_INTEGRATOR_ADAPT_H

#include "cache/irradiance_cache.h"
#include "cache/radiance_cache.h"
#include "integrator/seen_points.h"
#include "integrator/work.h"

/** What records are compared by: points that some of a picture's pixels see, and the light that reaches these pixels
 *  without the caches. */
typedef struct SheenAdaptView {
    SeenPoints seen; // with their lobes
    float *direct;   // [pixels] luminance, W m^-2 sr^-1; only of those pixels that see points
} SheenAdaptView;

/**
 * Traces one sample of every second pixel both ways, with its direct light.
 * @param out  owned by the caller; to be freed when this fails too
 * Errors: SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_adapt_look(const SheenWork *work, SheenStats *stats, SheenAdaptView *out);
void sheen_adapt_free(SheenAdaptView *view);

/** The cache whose records are compared: one of the two, the other NULL. */
typedef struct AdaptCache {
    SheenIrradianceCache *irradiance;
    SheenRadianceCache *radiance;
} AdaptCache;

static inline SheenRecordStore *adapt_store(const AdaptCache *cache)
{
    return cache->irradiance ? cache->irradiance->store : cache->radiance->store;
}

/**
 * One pass over all points: where a point tells a record's contribution from the others', the least weighty of such
 * records is left out there, by an accuracy just too fine for it. A record gets the least accuracy that any point asks
 * for, but no less than record_least_accuracy. All points see the records as they are at the start, so that the
 * result depends on nothing else. The octree is left as it is.
 * @param touched  [2] only points that a sphere of one of these holds are looked at; NULL: all are
 * Errors: SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED; the cache is unchanged then.
 */
SHEEN_NODISCARD SheenStatus sheen_adapt_pass(const SheenWork *work, const SheenAdaptView *view,
                                             SheenOctree *const touched[2], const AdaptCache *cache);

/** A record's part in what a point shows. */
typedef struct AdaptShare {
    uint32_t record;
    float weight; // w; of records that speak only where no other does, what they count for
    float Y;      // luminance that the point would show by this record alone
    float sigma;  // standard error of Y
    bool fixed;   // the record cannot be left out
} AdaptShare;

/**
 * The records that a point leaves out.
 * @param share       [n] is put into another order: those that stay come first
 * @param direct      luminance of what the point shows besides
 * @param discernible the Weber fraction
 * @return how many stay; at least 1 where n is
 * Source: krivanek2006-making-caching-practical secs. 4.1, 4.3, with sigma of each record propagated through the
 * weights, which the paper leaves open.
 */
unsigned sheen_adapt_tell(float discernible, float direct, unsigned n, AdaptShare share[]);

#endif
