// SPDX-License-Identifier: Apache-2.0
#include "gather/allocate.h"

#include "math/vec.h"

#include <stddef.h>

// The standard deviation over the neighbors of ring j, sector k: what lies beside a cell tells what may be in it.
static float deviation_of(SheenStrata s, const float value[], unsigned j, unsigned k)
{
    uint32_t beside[8];
    unsigned n = strata_neighbors(s, j, k, beside);
    float sum = 0.0f, squares = 0.0f;
    for (unsigned i = 0; i < n; ++i) {
        sum += value[beside[i]];
        squares += value[beside[i]] * value[beside[i]];
    }
    float mean = sum / (float)n;
    return safe_sqrtf(squares / (float)n - mean * mean);
}

// Cells get density times their deviation rays in all, the first included.
static uint32_t extra_of(float deviation, float density)
{
    float rays = deviation * density;
    return !(rays >= 1.5f) ? 0 : rays > (float)SHEEN_EXTRA_MAX ? SHEEN_EXTRA_MAX : (uint32_t)(rays - 0.5f);
}

uint32_t sheen_strata_allocate(SheenStrata s, const float value[], float error, uint32_t most, float deviation[],
                               uint32_t extra[], float *expected)
{
    unsigned n = strata_count(s);
    double total = 0.0, deviations = 0.0, variance = 0.0;
    for (unsigned k = 0; k < s.sectors; ++k)
        for (unsigned j = 0; j < s.rings; ++j) {
            size_t i = (size_t)k * s.rings + j;
            deviation[i] = deviation_of(s, value, j, k);
            total += (double)value[i];
            deviations += (double)deviation[i];
            variance += (double)deviation[i] * (double)deviation[i];
            extra[i] = 0;
        }
    double allowed = (double)error * total;
    allowed *= allowed;
    *expected = total > 0.0 ? (float)(sqrt(variance) / total) : 0.0f;
    if (!(variance > allowed) || !(allowed > 0.0)) return 0;
    // With `density` rays for each unit of deviation the variance of the sum is deviations / density; no more than
    // `most` rays are spent beside the first.
    double density = deviations / allowed;
    double afford = ((double)most + n) / deviations;
    uint32_t sum;
    do {
        sum = 0;
        float d = (float)(density < afford ? density : afford);
        for (unsigned i = 0; i < n; ++i) sum += extra[i] = extra_of(deviation[i], d);
        afford *= 0.9;
    } while (sum > most);
    variance = 0.0;
    for (unsigned i = 0; i < n; ++i) variance += (double)deviation[i] * (double)deviation[i] / (1.0 + extra[i]);
    *expected = (float)(sqrt(variance) / total);
    return sum;
}
