// SPDX-License-Identifier: Apache-2.0
// Integer hashes: all random numbers are keyed by what they are for (seed, pixel, record, dimension), never by a
// thread.
#ifndef SHEEN_BASE_HASH_H
#define SHEEN_BASE_HASH_H

#include <stdint.h>

/** A bijective 32-bit mixer. Source: wellons2018-hash-prospector, "lowbias32". */
static inline uint32_t hash_u32(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

/** Mixes a further word into a hash; the order matters. */
static inline uint32_t hash_combine(uint32_t h, uint32_t x)
{
    return hash_u32(h ^ (hash_u32(x + 0x9e3779b9u) + (h << 6) + (h >> 2)));
}

/** @return the hash as a float in [0, 1). */
static inline float hash_to_unit(uint32_t h)
{
    return (float)(h >> 8) * 0x1p-24f;
}

#endif
