// SPDX-License-Identifier: Apache-2.0
// Radiance records: the light that comes in at a point from everywhere, as coefficients with gradients, and what a
// glossy lobe makes of it at a point nearby.
//
// Records in hemispherical harmonics hold them in the local frame about their normal; records in spherical harmonics,
// for curved surfaces, in the world's frame, so that nothing is rotated between record and point. In both, the shift of
// the point is measured in the record's local frame.
#ifndef SHEEN_CACHE_RADIANCE_CACHE_H
#define SHEEN_CACHE_RADIANCE_CACHE_H

#include "basis/rotation.h"
#include "cache/store.h"
#include "math/frame.h"

/** Records with their light. */
typedef struct SheenRadianceCache {
    SheenRecordStore *store;
    SheenBasis basis;
    unsigned order;          // n: n * n coefficients a record
    SheenRotation *rotation; // of that basis and order
    float *light;            // [records][3 parts: coefficients, their d/dx, their d/dy][stride]
    size_t stride;           // 3 n * n, rounded up
    uint32_t capacity;
} SheenRadianceCache;

/**
 * @param accuracy, neighbor_clamping, bounds  as of sheen_store_create
 * @param tilted  whether hemispherical records serve points with other normals, by rotation; else those that differ by
 *                more than half a degree are left out. Spherical ones always do.
 */
SHEEN_NODISCARD SheenStatus sheen_radiance_cache_create(SheenBasis basis, unsigned order, bool tilted, float accuracy,
                                                        bool neighbor_clamping, const Bounds *bounds,
                                                        SheenRadianceCache **out);
void sheen_radiance_cache_destroy(SheenRadianceCache **cache);

/** Floats of one record's light: three parts of [n * n] Rgb each, cache->stride floats apart, zero beyond. */
static inline size_t radiance_light_floats(const SheenRadianceCache *cache)
{
    return 3 * cache->stride;
}

/** As sheen_store_insert; stores a copy of the light too. @param light [radiance_light_floats] */
SHEEN_NODISCARD SheenStatus sheen_radiance_cache_insert(SheenRadianceCache *cache, const Record *record,
                                                        const float light[]);

/** As sheen_store_append; stores a copy of the light too. */
SHEEN_NODISCARD SheenStatus sheen_radiance_cache_append(SheenRadianceCache *cache, const Record *record,
                                                        const float light[]);

/** A lobe at a point: f(wo, .) cos(theta_i) in harmonics. */
typedef struct RadianceLobe {
    unsigned order;          // at most that of the cache
    const Rgb *coefficients; // [order * order]; spherical ones in the world's frame, others in frame_from_normal(n)
} RadianceLobe;

/**
 * Radiance that a lobe reflects: the weighted mean over the contributors of the dot product of the lobe with the
 * record's light, moved to the point. Not below zero.
 * @param c     of cache->store, at (p, n); black when it is empty
 * Source: krivanek2005-radiance-caching eqs. (12), (13): the gradient is applied in the record's frame, then the lobe
 * is rotated rather than the light; weights as those of sheen_irradiance_interpolate.
 */
Rgb sheen_radiance_reflect(const SheenRadianceCache *cache, const Contributors *c, Vec3 p, Vec3 n,
                           const RadianceLobe *lobe);

uint64_t sheen_radiance_cache_bytes(const SheenRadianceCache *cache);

#endif
