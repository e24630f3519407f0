// SPDX-License-Identifier: Apache-2.0
// Surfaces that let light through, as Embree's callbacks see them: hits in holes are rejected, and shadow rays are
// weakened by what is between. Included by src/ray only.
#ifndef SHEEN_RAY_HOLES_H
#define SHEEN_RAY_HOLES_H

#include "ray/packet.h"
#include "scene/scene.h"

/** A shape, the user data of its geometry. */
typedef struct TracedShape {
    const SheenScene *scene;
    const SheenShape *shape;
    bool pierced; // light passes it somewhere
} TracedShape;

TracedShape sheen_traced_shape(const SheenScene *scene, const SheenShape *shape);

/** A hit on a pierced shape, in the shape's own space. */
typedef struct PiercedHit {
    Vec3 p, d;         // the point, and where the ray goes
    float t, u, v;     // as in Hit
    uint32_t triangle; // as in Hit
    uint32_t geometry, instance;
} PiercedHit;

/** @return true when the hit is in a hole, where a ray goes on as if there was nothing. What shines is always hit. */
bool sheen_hole_at(const TracedShape *s, const PiercedHit *hit);

enum { SHADOW_SEEN = 8 };

/**
 * What one shadow ray has met. The sum is of integers, so that it does not depend on the order in which Embree comes to
 * the surfaces, which differs between builds of its tree.
 */
typedef struct Shadow {
    uint64_t absorbed; // sum of -log2 of the shares that were let through, in units of 2^-40
    uint32_t n;
    struct {
        uint32_t geometry, instance;
        float t;
    } seen[SHADOW_SEEN]; // the last of them
} Shadow;

/** The context of shadow rays; `rtc` is what Embree knows of it. */
typedef struct ShadowContext {
    struct RTCIntersectContext rtc;
    Shadow *shadows; // by the rays' ids
} ShadowContext;

/**
 * Weakens a shadow ray by a hit. A second hit on a shape at the same distance, on the other triangle of an edge, counts
 * as the first.
 * @return true when no light is left
 */
bool sheen_shadow_meet(const TracedShape *s, const PiercedHit *hit, Shadow *shadow);

/** @return the share of light that is left, [0, 1]. */
float sheen_shadow_transmittance(const Shadow *shadow);

/** Makes Embree ask for the holes of a mesh. */
void sheen_holes_filter(RTCGeometry geometry);

#endif
