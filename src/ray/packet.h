// SPDX-License-Identifier: Apache-2.0
// Fields of a packet of n rays. Embree names them in C++ only: in memory they are arrays of n 32-bit words, one field
// after another in the order of struct RTCRayHit. Included by src/ray only.
#ifndef SHEEN_RAY_PACKET_H
#define SHEEN_RAY_PACKET_H

#include "math/vec.h"

#include <embree3/rtcore.h>
#include <stddef.h>
#include <stdint.h>

typedef union Word {
    float f;
    uint32_t u;
} Word;

/** Of the ray, then of the hit. */
enum {
    ORG_X,
    ORG_Y,
    ORG_Z,
    T_NEAR,
    DIR_X,
    DIR_Y,
    DIR_Z,
    TIME,
    T_FAR,
    MASK,
    ID,
    FLAGS,
    NG_X,
    NG_Y,
    NG_Z,
    HIT_U,
    HIT_V,
    PRIMITIVE,
    GEOMETRY,
    INSTANCE
};
_Static_assert(sizeof(struct RTCRay) >= T_FAR * sizeof(float) &&
                   offsetof(struct RTCRay, tfar) == T_FAR * sizeof(float) &&
                   offsetof(struct RTCRay, id) == ID * sizeof(float) &&
                   offsetof(struct RTCRayHit, hit.u) == HIT_U * sizeof(float) &&
                   offsetof(struct RTCRayHit, hit.geomID) == GEOMETRY * sizeof(float) &&
                   offsetof(struct RTCRayHit, hit.instID) == INSTANCE * sizeof(float),
               "the order of Embree's fields");

/** A field of a packet of rays, or of rays with hits. */
static inline Word *packet_field(void *packet, unsigned n, unsigned which, unsigned lane)
{
    return (Word *)packet + (size_t)which * n + lane;
}

/** A field of a packet of hits that stands alone. */
static inline Word *packet_hit_field(void *hits, unsigned n, unsigned which, unsigned lane)
{
    return packet_field(hits, n, which - NG_X, lane);
}

static inline Vec3 packet_origin(void *packet, unsigned n, unsigned i)
{
    return v3(packet_field(packet, n, ORG_X, i)->f, packet_field(packet, n, ORG_Y, i)->f,
              packet_field(packet, n, ORG_Z, i)->f);
}

static inline Vec3 packet_direction(void *packet, unsigned n, unsigned i)
{
    return v3(packet_field(packet, n, DIR_X, i)->f, packet_field(packet, n, DIR_Y, i)->f,
              packet_field(packet, n, DIR_Z, i)->f);
}

#endif
