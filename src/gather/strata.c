// SPDX-License-Identifier: Apache-2.0
#include "gather/strata.h"

SheenStrata sheen_strata_cosine(unsigned n_rays)
{
    if (n_rays < 4) n_rays = 4;
    unsigned rings = (unsigned)lrintf(sqrtf((float)n_rays * SHEEN_INV_PI));
    if (rings < 1) rings = 1;
    if (rings > SHEEN_RINGS_MAX) rings = SHEEN_RINGS_MAX;
    unsigned sectors = (unsigned)lrintf((float)n_rays / (float)rings);
    return (SheenStrata){rings, sectors < 3 ? 3 : sectors};
}

Vec3 sheen_strata_direction(SheenStrata s, unsigned j, unsigned k, Vec2 u)
{
    float sin2 = ((float)j + u.x) / (float)s.rings;
    float phi = 2.0f * SHEEN_PI * ((float)k + u.y) / (float)s.sectors;
    float r = sqrtf(sin2);
    return v3(r * cosf(phi), r * sinf(phi), safe_sqrtf(1.0f - sin2));
}
