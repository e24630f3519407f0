// SPDX-License-Identifier: Apache-2.0
// Irradiance records: what each says where it is, and what all of them say at a point.
#ifndef SHEEN_CACHE_IRRADIANCE_CACHE_H
#define SHEEN_CACHE_IRRADIANCE_CACHE_H

#include "cache/store.h"

/** The light of one record. */
typedef struct IrradianceLight {
    Rgb E;               // irradiance, W/m^2
    Vec3 translation[3]; // gradient of E for a shift of p, per channel, W/m^3; in the plane of n
    Vec3 rotation[3];    // gradient of E for a rotation n x n', per channel
    Rgb behind;          // for normals bent away from n: see sheen_irradiance_interpolate_bent
    Vec3 lean;           // its change with the way in which they are bent, relative; in the plane of n
} IrradianceLight;

/**
 * Irradiance that a record predicts at (p, n): first order in the shift d and the turn w = n_i x n; never negative.
 * Source: ward1992-gradients eq. (7); the sign of the rotation as in gather/estimate.h.
 */
static inline Rgb irradiance_predict(const Record *record, const IrradianceLight *light, Vec3 p, Vec3 n)
{
    Vec3 d = v3_sub(p, record->p), w = v3_cross(record->n, n);
    const Vec3 *t = light->translation, *r = light->rotation;
    return rgb(maxf(0.0f, light->E.r + v3_dot(d, t[0]) + v3_dot(w, r[0])),
               maxf(0.0f, light->E.g + v3_dot(d, t[1]) + v3_dot(w, r[1])),
               maxf(0.0f, light->E.b + v3_dot(d, t[2]) + v3_dot(w, r[2])));
}

/**
 * Weighted mean of the contributors' predictions: sum w_i E_i(p, n) / sum w_i with w_i = w - 1/a.
 * @param light  [records] of the store
 * @return irradiance, W/m^2; black when `c` is empty
 * Source: ward1992-gradients eq. (8) with the weight of tabellion2004-gi-film, which has no seams.
 */
Rgb sheen_irradiance_interpolate(const SheenRecordStore *store, const IrradianceLight light[], const Contributors *c,
                                 Vec3 p, Vec3 n);

/**
 * The same where a map bends the normal to m, but the surface still hides what is below n. Records lie on the surface
 * as it is without the map and are read at m: with t the direction in the plane of n in which m is bent by theta, each
 * one's prediction becomes
 *   E cos(theta) + (n x m) . rotation + (1 - cos(theta)) behind (1 + lean . t).
 * The first two terms are the integral of L m . wi above n, without approximation. That counts light from between the
 * planes of m and n negatively; the last term takes it out again, see gather/estimate.h.
 * @param bent  m, unit
 */
Rgb sheen_irradiance_interpolate_bent(const SheenRecordStore *store, const IrradianceLight light[],
                                      const Contributors *c, Vec3 p, Vec3 n, Vec3 bent);

/** Records with their light. */
typedef struct SheenIrradianceCache {
    SheenRecordStore *store;
    IrradianceLight *light; // [store->n]
    uint32_t capacity;
} SheenIrradianceCache;

/** As sheen_store_create. */
SHEEN_NODISCARD SheenStatus sheen_irradiance_cache_create(float accuracy, bool neighbor_clamping, const Bounds *bounds,
                                                          SheenIrradianceCache **out);
void sheen_irradiance_cache_destroy(SheenIrradianceCache **cache);

/** As sheen_store_insert; stores a copy of the light too. */
SHEEN_NODISCARD SheenStatus sheen_irradiance_cache_insert(SheenIrradianceCache *cache, const Record *record,
                                                          const IrradianceLight *light);

/** As sheen_store_append; stores a copy of the light too. */
SHEEN_NODISCARD SheenStatus sheen_irradiance_cache_append(SheenIrradianceCache *cache, const Record *record,
                                                          const IrradianceLight *light);

uint64_t sheen_irradiance_cache_bytes(const SheenIrradianceCache *cache);

#endif
