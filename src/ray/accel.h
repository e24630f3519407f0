// SPDX-License-Identifier: Apache-2.0
// Ray queries. Embree hides behind this header; no other folder names it.
#ifndef SHEEN_RAY_ACCEL_H
#define SHEEN_RAY_ACCEL_H

#include "base/log.h"
#include "base/pool.h"
#include "scene/scene.h"

typedef struct SheenAccel SheenAccel;

/** A ray segment o + t d, t in [0, t_max]. d need not be unit. */
typedef struct Ray {
    Vec3 o;
    float t_max;
    Vec3 d;
} Ray;

/** The nearest intersection of a ray. */
typedef struct Hit {
    float t;           // ray parameter
    float u, v;        // barycentric coordinates of vertices 1 and 2 (triangles); unused otherwise
    uint32_t shape;    // index into scene->shapes, SHEEN_NONE for a miss
    uint32_t triangle; // index within the mesh
    uint32_t instance; // index into scene->instances, SHEEN_NONE for a shape of the world
} Hit;

/** Hints for a batch: coherent rays (camera, a gather's fan in sector order) trace faster. */
typedef enum SheenCoherence { SHEEN_INCOHERENT, SHEEN_COHERENT } SheenCoherence;

/**
 * Builds the acceleration structure with the robust traversal (no leaks through shared edges).
 * @param scene  borrowed; must outlive the result
 * @param pool   threads that build; borrowed during the call
 */
SHEEN_NODISCARD SheenStatus sheen_accel_create(const SheenScene *scene, SheenPool *pool, const SheenLog *log,
                                               SheenAccel **out);
void sheen_accel_destroy(SheenAccel **accel);

/**
 * Nearest hit of one ray, where a hole, a place that lets all light pass straight on, is no surface unless it shines;
 * hit->shape is SHEEN_NONE for a miss. Thread-safe.
 */
void sheen_accel_intersect(const SheenAccel *accel, const Ray *ray, Hit *hit);

/**
 * @return the share of light that passes the segment: 0 where anything opaque lies on it, 1 where nothing does, between
 *         the product of what the materials on it let pass straight on (scene/passage.h). Thread-safe.
 */
float sheen_accel_transmittance(const SheenAccel *accel, const Ray *ray);

/** @return true when no light passes the segment. Thread-safe. */
static inline bool sheen_accel_occluded(const SheenAccel *accel, const Ray *ray)
{
    return sheen_accel_transmittance(accel, ray) == 0.0f;
}

/**
 * Nearest hits of n rays, traced in packets of 16 in the order given. Rays with t_max < 0 are skipped (their hit is a
 * miss). A hit depends on the batch only, not on threads or earlier batches. Thread-safe.
 */
void sheen_accel_intersect_many(const SheenAccel *accel, SheenCoherence coherence, size_t n, const Ray rays[],
                                Hit hits[]);

/**
 * transmittance[i] is that of segment i, traced in packets of 16; of skipped rays (t_max < 0) it is 0. Always as
 * incoherent rays: for them alone it is known that Embree comes to an end. Thread-safe.
 */
void sheen_accel_transmittance_many(const SheenAccel *accel, size_t n, const Ray rays[], float transmittance[]);

#endif
