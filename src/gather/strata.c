// SPDX-License-Identifier: Apache-2.0
#include "gather/strata.h"

#include "base/hash.h"

#include <stddef.h>

// Rings, each with 1 / rings_per_sector sectors.
static SheenStrata cut(unsigned n_rays, float rings_per_sector, SheenDensity density)
{
    if (n_rays < 4) n_rays = 4;
    unsigned rings = (unsigned)lrintf(sqrtf((float)n_rays * rings_per_sector));
    if (rings < 1) rings = 1;
    if (rings > SHEEN_RINGS_MAX) rings = SHEEN_RINGS_MAX;
    unsigned sectors = (unsigned)lrintf((float)n_rays / (float)rings);
    return (SheenStrata){rings, sectors < 3 ? 3 : sectors, density};
}

SheenStrata sheen_strata_cosine(unsigned n_rays)
{
    return cut(n_rays, SHEEN_INV_PI, SHEEN_DENSITY_COSINE);
}

SheenStrata sheen_strata_uniform(unsigned n_rays)
{
    return cut(n_rays, 0.25f, SHEEN_DENSITY_UNIFORM);
}

// Squared sine and cosine of the zenith angle that a share t of the samples is below.
static inline float sin2_at(bool uniform, float t)
{
    return uniform ? t * (2.0f - t) : t;
}
static inline float cos_at(bool uniform, float t)
{
    float rest = maxf(1.0f - t, 0.0f);
    return uniform ? rest : sqrtf(rest);
}

Vec3 sheen_strata_direction(SheenStrata s, unsigned j, unsigned k, Vec2 u)
{
    bool uniform = s.density == SHEEN_DENSITY_UNIFORM;
    float t = ((float)j + u.x) / (float)s.rings;
    float phi = 2.0f * SHEEN_PI * ((float)k + u.y) / (float)s.sectors;
    float r = sqrtf(sin2_at(uniform, t));
    return v3(r * cosf(phi), r * sinf(phi), cos_at(uniform, t));
}

// The cells of one sector. The angle from the sector's middle is at most pi / 3: there these Taylor polynomials are as
// exact as floats are, and the loop has no calls, so that it becomes vector instructions.
static void sector_directions(SheenStrata s, unsigned k, uint32_t key, Vec3 *restrict out)
{
    float width = 2.0f * SHEEN_PI / (float)s.sectors, per_ring = 1.0f / (float)s.rings;
    float middle = ((float)k + 0.5f) * width, c = cosf(middle), d = sinf(middle);
    uint32_t first = k * s.rings;
    bool uniform = s.density == SHEEN_DENSITY_UNIFORM;
    for (uint32_t j = 0; j < s.rings; ++j) {
        uint32_t hash = hash_combine(key, first + j);
        float a = (hash_to_unit(hash_u32(hash ^ 0x5bd1e995u)) - 0.5f) * width, a2 = a * a;
        float cos_a = 1.0f + a2 * (-1.0f / 2 +
                                   a2 * (1.0f / 24 + a2 * (-1.0f / 720 + a2 * (1.0f / 40320 - a2 * (1.0f / 3628800)))));
        float sin_a = a * (1.0f + a2 * (-1.0f / 6 + a2 * (1.0f / 120 + a2 * (-1.0f / 5040 + a2 * (1.0f / 362880)))));
        float t = ((float)j + hash_to_unit(hash)) * per_ring, r = sqrtf(sin2_at(uniform, t));
        out[j] = v3(r * (c * cos_a - d * sin_a), r * (d * cos_a + c * sin_a), cos_at(uniform, t));
    }
}

void sheen_strata_directions(SheenStrata s, uint32_t key, Vec3 out[])
{
    for (unsigned k = 0; k < s.sectors; ++k) sector_directions(s, k, key, out + (size_t)k * s.rings);
}

uint32_t sheen_strata_cell(SheenStrata s, Vec3 d)
{
    float turn = atan2f(d.y, d.x) * (0.5f * SHEEN_INV_PI);
    float out = s.density == SHEEN_DENSITY_UNIFORM ? 1.0f - d.z : d.x * d.x + d.y * d.y;
    uint32_t k = (uint32_t)((turn < 0.0f ? turn + 1.0f : turn) * (float)s.sectors);
    uint32_t j = (uint32_t)(out * (float)s.rings);
    return (k < s.sectors ? k : s.sectors - 1) * s.rings + (j < s.rings ? j : s.rings - 1);
}
