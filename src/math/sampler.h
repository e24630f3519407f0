// SPDX-License-Identifier: Apache-2.0
// Low-discrepancy samples: Owen-scrambled Sobol' pairs, padded, keyed by what they are for. All of it is here, without
// branches, so that a loop over samples becomes vector instructions.
#ifndef SHEEN_MATH_SAMPLER_H
#define SHEEN_MATH_SAMPLER_H

#include "base/hash.h"
#include "math/vec.h"

/** One sample's stream of dimensions. A value; copy it to replay. */
typedef struct SheenSampler {
    uint32_t key;   // hash of seed and pixel, or of seed and record
    uint32_t index; // which sample of the key's sequence
    uint32_t dim;   // dimensions drawn so far
} SheenSampler;

/**
 * @param key    the sequence; sequences of different keys are independent
 * @param index  sample number; the first 2^k samples of a key are stratified in every pair of dimensions drawn together
 */
static inline SheenSampler sampler_make(uint32_t key, uint32_t index)
{
    return (SheenSampler){key, index, 0};
}

static inline uint32_t sampler_reverse_bits(uint32_t x)
{
    x = __builtin_bswap32(x);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

// Owen scrambling of reversed bits by a hash whose every output bit depends on lower bits only.
// Source: burley2020-owen, with the constants of vegdahl2021-owen.
static inline uint32_t sampler_laine_karras(uint32_t x, uint32_t seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Second dimension of the Sobol' sequence from the reversed index, which is the first. Its generator matrix is Pascal's
// triangle modulo 2, which the five doubling steps below apply.
static inline uint32_t sampler_sobol_second(uint32_t x)
{
    x ^= x << 16;
    x ^= (x & 0x00ff00ffu) << 8;
    x ^= (x & 0x0f0f0f0fu) << 4;
    x ^= (x & 0x33333333u) << 2;
    x ^= (x & 0x55555555u) << 1;
    return x;
}

/** @return the next dimension in [0, 1). */
static inline float sampler_1d(SheenSampler *s)
{
    uint32_t seed = hash_combine(s->key, s->dim++);
    uint32_t first = sampler_laine_karras(sampler_reverse_bits(s->index), seed);
    return hash_to_unit(sampler_reverse_bits(sampler_laine_karras(sampler_reverse_bits(first), hash_u32(seed))));
}

/** @return the next two dimensions in [0, 1)^2, a (0, 2)-sequence over the index. */
static inline Vec2 sampler_2d(SheenSampler *s)
{
    uint32_t seed = hash_combine(s->key, s->dim);
    s->dim += 2;
    // The index is shuffled by scrambling it, too: reversed it is the first dimension.
    uint32_t first = sampler_laine_karras(sampler_reverse_bits(s->index), seed);
    uint32_t second = sampler_sobol_second(first);
    uint32_t x = sampler_laine_karras(sampler_reverse_bits(first), hash_u32(seed ^ 0x68bc21ebu));
    uint32_t y = sampler_laine_karras(sampler_reverse_bits(second), hash_u32(seed ^ 0x02e5be93u));
    return v2(hash_to_unit(sampler_reverse_bits(x)), hash_to_unit(sampler_reverse_bits(y)));
}

#endif
