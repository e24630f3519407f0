// SPDX-License-Identifier: Apache-2.0
#include "math/sampler.h"

static uint32_t reverse_bits(uint32_t x)
{
    x = __builtin_bswap32(x);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

// Owen scrambling of reversed bits by a hash whose every output bit depends on lower bits only.
// Source: burley2020-owen, with the constants of vegdahl2021-owen.
static uint32_t laine_karras(uint32_t x, uint32_t seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

static uint32_t owen_scramble(uint32_t x, uint32_t seed)
{
    return reverse_bits(laine_karras(reverse_bits(x), seed));
}

// Second dimension of the Sobol' sequence; the first is the reversed index. Its generator matrix is Pascal's triangle
// modulo 2, which the five doubling steps below apply to the reversed index.
static uint32_t sobol_second(uint32_t index)
{
    uint32_t x = reverse_bits(index);
    x ^= x << 16;
    x ^= (x & 0x00ff00ffu) << 8;
    x ^= (x & 0x0f0f0f0fu) << 4;
    x ^= (x & 0x33333333u) << 2;
    x ^= (x & 0x55555555u) << 1;
    return x;
}

float sampler_1d(SheenSampler *s)
{
    uint32_t seed = hash_combine(s->key, s->dim++);
    uint32_t i = owen_scramble(s->index, seed);
    return hash_to_unit(owen_scramble(reverse_bits(i), hash_u32(seed)));
}

Vec2 sampler_2d(SheenSampler *s)
{
    uint32_t seed = hash_combine(s->key, s->dim);
    s->dim += 2;
    uint32_t i = owen_scramble(s->index, seed);
    return v2(hash_to_unit(owen_scramble(reverse_bits(i), hash_u32(seed ^ 0x68bc21ebu))),
              hash_to_unit(owen_scramble(sobol_second(i), hash_u32(seed ^ 0x02e5be93u))));
}
