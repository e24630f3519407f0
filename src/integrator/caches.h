// SPDX-License-Identifier: Apache-2.0
// The caches of all kinds of light that one set of records needs.
#ifndef SHEEN_INTEGRATOR_CACHES_H
#define SHEEN_INTEGRATOR_CACHES_H

#include "cache/irradiance_cache.h"
#include "cache/radiance_cache.h"
#include "integrator/work.h"

/** Owned by whoever created them. */
typedef struct SheenCaches {
    SheenIrradianceCache *irradiance;
    SheenRadianceCache *radiance[SHEEN_BASIS_COUNT]; // NULL without glossy light to keep
} SheenCaches;

/**
 * Makes empty caches, those of glossy light where work->glossy is.
 * @param out  all NULL, or to be freed when this fails too
 */
SHEEN_NODISCARD SheenStatus sheen_caches_create(const SheenWork *work, SheenCaches *out);
void sheen_caches_free(SheenCaches *caches);

/** How many records there are of each kind. */
typedef struct RecordCounts {
    uint32_t irradiance, radiance[SHEEN_BASIS_COUNT];
} RecordCounts;
RecordCounts sheen_caches_counts(const SheenCaches *caches);

static inline uint64_t record_counts_radiance(const RecordCounts *n)
{
    uint64_t sum = 0;
    for (int b = 0; b < SHEEN_BASIS_COUNT; ++b) sum += n->radiance[b];
    return sum;
}

static inline uint64_t record_counts_all(const RecordCounts *n)
{
    return n->irradiance + record_counts_radiance(n);
}

/**
 * Lets the records after the first `settled` ones learn from their neighbors, see cache/smooth.h.
 * Errors: SHEEN_ERR_NOMEM.
 */
SHEEN_NODISCARD SheenStatus sheen_caches_smooth(const SheenWork *work, const RecordCounts *settled,
                                                const SheenCaches *caches);

/** Adds the records and their bytes to the statistics. */
void sheen_caches_count(const SheenCaches *caches, SheenStats *stats);

#endif
