// SPDX-License-Identifier: Apache-2.0
// Gathers in the scenes of radiance_kit.h, and sums over the walls of their cells in several forms, printed ones among
// them: slow, in double, straight from the formula.
#ifndef SHEEN_TESTS_ANALYTIC_RADIANCE_WALLS_H
#define SHEEN_TESTS_ANALYTIC_RADIANCE_WALLS_H

#include "analytic/radiance_kit.h"
#include "base/hash.h"
#include "gather/radiance.h"

enum { KIT_CELLS_MAX = 64 * 256 };

/** Where in its cell a sample lies. */
typedef enum Jitter {
    JITTER_NONE,         // at the center
    JITTER_CELL,         // anywhere, for each cell anew
    JITTER_RINGS_SECTORS // one number for each ring and one for each sector, as the indices are printed
} Jitter;

/** A gather, for the library and, angles and distances in double, for the sums below. */
typedef struct KitGather {
    SheenStrata strata;
    Vec3 directions[KIT_CELLS_MAX], normals[KIT_CELLS_MAX];
    Rgb L[KIT_CELLS_MAX];
    float distance[KIT_CELLS_MAX];
    double cos_theta[KIT_CELLS_MAX], phi[KIT_CELLS_MAX], radiance[KIT_CELLS_MAX], inverse[KIT_CELLS_MAX];
} KitGather;

static inline double kit_number(uint32_t seed, uint32_t i, uint32_t dimension)
{
    return (double)hash_to_unit(hash_combine(hash_combine(seed, dimension), i));
}

static inline void kit_place(Jitter jitter, uint32_t seed, unsigned j, unsigned k, unsigned cell, double u[2])
{
    u[0] = u[1] = 0.5;
    if (jitter == JITTER_NONE) return;
    u[0] = kit_number(seed, jitter == JITTER_CELL ? cell : j, 0);
    u[1] = kit_number(seed, jitter == JITTER_CELL ? cell : k, 1);
}

/** Strata of equal solid angle. Radiance is gray but for green, which is twice, and blue, which is black. */
static inline void kit_gather(const KitCase *c, unsigned rings, unsigned sectors, Jitter jitter, uint32_t seed,
                              KitGather *g)
{
    g->strata = (SheenStrata){rings, sectors, SHEEN_DENSITY_UNIFORM};
    for (unsigned k = 0, i = 0; k < sectors; ++k)
        for (unsigned j = 0; j < rings; ++j, ++i) {
            double u[2];
            kit_place(jitter, seed, j, k, i, u);
            double z = 1.0 - (j + u[0]) / rings, phi = 2.0 * 3.141592653589793 * (k + u[1]) / sectors;
            double s = sqrt(1.0 - z * z);
            Double3 d = d3(s * cos(phi), s * sin(phi), z);
            Seen seen = c->scene(c->p, d);
            g->cos_theta[i] = z;
            g->phi[i] = phi;
            g->radiance[i] = seen.L;
            g->inverse[i] = 1.0 / seen.r;
            g->directions[i] = v3((float)d.x, (float)d.y, (float)d.z);
            g->normals[i] = v3((float)seen.n.x, (float)seen.n.y, (float)seen.n.z);
            g->L[i] = rgb((float)seen.L, 2.0f * (float)seen.L, 0.0f);
            g->distance[i] = (float)seen.r;
        }
}

static inline RadianceSamples kit_samples(const KitGather *g)
{
    return (RadianceSamples){g->directions, g->L, g->distance, g->normals};
}

/** Where the sums take the basis, and the width of a cell at its edge to the sector before. */
typedef enum WallForm {
    WALLS_PRINTED, // at the sample, where 1 / (M sin(theta)) is the width
    WALLS_CENTER,  // the same at the center of the cell
    WALLS_EDGE,    // at the middle of each wall, and the width that it has
    WALLS_INTEGRAL // the same, and the integral along the walls between sectors
} WallForm;

static inline double kit_approach(double a, double b, bool mean)
{
    return mean && fmax(a, b) < 1.5 * fmin(a, b) ? 0.5 * (a + b) : fmax(a, b);
}

/** Integral of the basis from one zenith angle to another. */
static inline void kit_wall_integral(const Gauss *gauss, SheenBasis basis, unsigned n, double from, double to,
                                     double phi, double out[KIT_BASIS_MAX])
{
    memset(out, 0, KIT_BASIS_MAX * sizeof *out);
    for (int i = 0; i < KIT_NODES; ++i) {
        double u = gauss->x[i], b[KIT_BASIS_MAX];
        kit_basis(basis, n, cos(to - (to - from) * u * u), phi, b);
        for (unsigned c = 0; c < n * n; ++c) out[c] += 2.0 * u * gauss->w[i] * (to - from) * b[c];
    }
}

/**
 * Gradient by what the walls uncover.
 * @param mean  whether distances that are less than a factor of 1.5 apart count by the mean of their inverses
 */
static inline void kit_wall_gradient(const KitGather *g, SheenBasis basis, unsigned n, WallForm form, bool mean,
                                     double out[2][KIT_BASIS_MAX])
{
    const double two_pi = 6.283185307179586;
    unsigned M = g->strata.rings, N = g->strata.sectors;
    bool at_wall = form == WALLS_EDGE || form == WALLS_INTEGRAL;
    Gauss gauss;
    kit_gauss(&gauss);
    memset(out, 0, 2 * sizeof out[0]);
    for (unsigned k = 0; k < N; ++k)
        for (unsigned j = 0; j < M; ++j) {
            unsigned i = k * M + j, ring = i - 1, sector = (k ? k - 1 : N - 1) * M + j;
            double upper = 1.0 - (double)j / M, lower = 1.0 - (j + 1.0) / M, center = 1.0 - (j + 0.5) / M;
            double middle = two_pi * (k + 0.5) / N, edge = two_pi * k / N;
            double z = form == WALLS_PRINTED ? g->cos_theta[i] : center;
            double phi = form == WALLS_PRINTED ? g->phi[i] : middle;
            double at_ring[KIT_BASIS_MAX], at_sector[KIT_BASIS_MAX];
            kit_basis(basis, n, at_wall ? upper : z, at_wall ? middle : phi, at_ring);
            kit_basis(basis, n, z, at_wall ? edge : phi, at_sector);
            double width = at_wall ? acos(fmax(0.0, lower)) - acos(upper) : 1.0 / (M * sqrt(1.0 - z * z));
            if (form == WALLS_INTEGRAL) {
                kit_wall_integral(&gauss, basis, n, acos(upper), acos(fmax(0.0, lower)), edge, at_sector);
                width = 1.0;
            }
            double u = 0.0, v = width * kit_approach(g->inverse[i], g->inverse[sector], mean) *
                                (g->radiance[i] - g->radiance[sector]);
            if (j)
                u = two_pi / N * upper * sqrt(1.0 - upper * upper) *
                    kit_approach(g->inverse[i], g->inverse[ring], mean) * (g->radiance[i] - g->radiance[ring]);
            for (unsigned b = 0; b < n * n; ++b) {
                out[0][b] += u * cos(middle) * at_ring[b] - v * sin(edge) * at_sector[b];
                out[1][b] += u * sin(middle) * at_ring[b] + v * cos(edge) * at_sector[b];
            }
        }
}

#endif
