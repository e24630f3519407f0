// SPDX-License-Identifier: Apache-2.0
// Low-discrepancy samples: Owen-scrambled Sobol' pairs, padded, keyed by what they are for.
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

/** @return the next dimension in [0, 1). */
float sampler_1d(SheenSampler *s);

/** @return the next two dimensions in [0, 1)^2, a (0, 2)-sequence over the index. */
Vec2 sampler_2d(SheenSampler *s);

#endif
