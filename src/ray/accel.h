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

/** Hints for a batch: coherent rays (camera, a gather's fan in sector order, shadow rays to one light) trace faster. */
typedef enum SheenCoherence { SHEEN_INCOHERENT, SHEEN_COHERENT } SheenCoherence;

/**
 * Builds the acceleration structure with the robust traversal (no leaks through shared edges).
 * @param scene  borrowed; must outlive the result
 * @param pool   threads that build; borrowed during the call
 */
SHEEN_NODISCARD SheenStatus sheen_accel_create(const SheenScene *scene, SheenPool *pool, const SheenLog *log,
                                               SheenAccel **out);
void sheen_accel_destroy(SheenAccel **accel);

/** Nearest hit of one ray; hit->shape is SHEEN_NONE for a miss. Thread-safe. */
void sheen_accel_intersect(const SheenAccel *accel, const Ray *ray, Hit *hit);

/** @return true when anything lies on the segment. Thread-safe. */
bool sheen_accel_occluded(const SheenAccel *accel, const Ray *ray);

/**
 * Nearest hits of n rays, traced in packets of 16 in the order given. Rays with t_max < 0 are skipped (their hit is a
 * miss). A hit depends on the batch only, not on threads or earlier batches. Thread-safe.
 */
void sheen_accel_intersect_many(const SheenAccel *accel, SheenCoherence coherence, size_t n, const Ray rays[],
                                Hit hits[]);

/** occluded[i] = 1 when anything lies on segment i; skipped rays (t_max < 0) count as occluded. Thread-safe. */
void sheen_accel_occluded_many(const SheenAccel *accel, SheenCoherence coherence, size_t n, const Ray rays[],
                               unsigned char occluded[]);

#endif
