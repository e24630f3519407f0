// SPDX-License-Identifier: Apache-2.0
// The hemisphere cut into rings and sectors of equal solid angle, plain or projected.
#ifndef SHEEN_GATHER_STRATA_H
#define SHEEN_GATHER_STRATA_H

#include "math/vec.h"

#include <stdint.h>

/** Most rings that strata may have. */
enum { SHEEN_RINGS_MAX = 512 };

/** What all cells have the same of: projected solid angle, for irradiance, or solid angle, for radiance. */
typedef enum SheenDensity { SHEEN_DENSITY_COSINE, SHEEN_DENSITY_UNIFORM } SheenDensity;

/** M rings times N sectors. Cells are numbered sector-major: cell k M + j is ring j (0 at the pole) of sector k. */
typedef struct SheenStrata {
    unsigned rings, sectors;
    SheenDensity density;
} SheenStrata;

/** Strata of about `n_rays` cells (at least 4) with N = pi M: cells near square. Source: ward1992-gradients, sec. 3. */
SheenStrata sheen_strata_cosine(unsigned n_rays);

/** The same of equal solid angle, with N = 4 M. Source: krivanek2005-improved-radiance-gradients, sec. 2. */
SheenStrata sheen_strata_uniform(unsigned n_rays);

static inline unsigned strata_count(SheenStrata s)
{
    return s.rings * s.sectors;
}

/** Density of the samples, one in each cell, with respect to solid angle; their sum over the hemisphere is 1. */
static inline float strata_pdf(SheenStrata s, float cos_theta)
{
    return s.density == SHEEN_DENSITY_UNIFORM ? 0.5f * SHEEN_INV_PI : SHEEN_INV_PI * cos_theta;
}

/**
 * The direction of a sample in cell (j, k), of the density of the strata within the cell.
 * @param u  position in the cell, [0, 1)^2
 * @return   unit, local: phi = 2 pi (k + u.y) / N and, with t = (j + u.x) / M, sin^2(theta) = t for cosine-weighted
 *           strata, cos(theta) = 1 - t for uniform ones
 */
Vec3 sheen_strata_direction(SheenStrata s, unsigned j, unsigned k, Vec2 u);

/** The cell that a direction lies in. @param d  local, unit, z >= 0 */
uint32_t sheen_strata_cell(SheenStrata s, Vec3 d);

/**
 * The cells beside cell (j, k), across edges and corners: 8, fewer at the pole and at the horizon.
 * @return their number
 */
static inline unsigned strata_neighbors(SheenStrata s, unsigned j, unsigned k, uint32_t out[8])
{
    unsigned sectors[3] = {k ? k - 1 : s.sectors - 1, k, k + 1 < s.sectors ? k + 1 : 0};
    unsigned lo = j ? j - 1 : 0, hi = j + 1 < s.rings ? j + 1 : j, n = 0;
    for (unsigned c = 0; c < 3; ++c)
        for (unsigned i = lo; i <= hi; ++i)
            if (c != 1 || i != j) out[n++] = sectors[c] * s.rings + i;
    return n;
}

/**
 * A jittered direction in each cell: those of sheen_strata_direction, to a few units in the last place, for random
 * numbers that are hashes of the key and the cell.
 * @param out  [cells]
 */
void sheen_strata_directions(SheenStrata s, uint32_t key, Vec3 out[]);

#endif
