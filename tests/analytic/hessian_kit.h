// SPDX-License-Identifier: Apache-2.0
// Second derivatives of what a gather estimates, by the library and by finite differences. To be included after CMocka.
#ifndef SHEEN_TESTS_ANALYTIC_HESSIAN_KIT_H
#define SHEEN_TESTS_ANALYTIC_HESSIAN_KIT_H

#include "analytic/radiance_kit.h"
#include "gather/hessian.h"

enum { CELLS_MAX = 8192 };

/** Symmetric 2 x 2, and the gradient beside it. */
typedef struct Second {
    double x, y, xx, xy, yy;
} Second;

static inline double norm(const Second *s)
{
    return sqrt(s->xx * s->xx + 2.0 * s->xy * s->xy + s->yy * s->yy);
}

static inline double distance2(const Second *a, const Second *b)
{
    double xx = a->xx - b->xx, xy = a->xy - b->xy, yy = a->yy - b->yy;
    return xx * xx + 2.0 * xy * xy + yy * yy;
}

/** A function of the point, and its derivatives by central differences of fourth order. */
typedef double Irradiance(const void *scene, Double3 p);

static inline Second differences(Irradiance *E, const void *scene, Double3 p, double h)
{
    static const double first[] = {1, -8, 0, 8, -1}, second[] = {-1, 16, -30, 16, -1};
    Second s = {0, 0, 0, 0, 0};
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 5; ++k) {
            double e = E(scene, d3(p.x + (i - 2) * h, p.y + (k - 2) * h, p.z));
            s.xy += first[i] * first[k] * e / (144.0 * h * h);
            if (k == 2) {
                s.x += first[i] * e / (12.0 * h);
                s.xx += second[i] * e / (12.0 * h * h);
            }
            if (i == 2) {
                s.y += first[k] * e / (12.0 * h);
                s.yy += second[k] * e / (12.0 * h * h);
            }
        }
    return s;
}

/** One gather. */
typedef struct Gather {
    SheenStrata strata;
    bool weighted; // or for irradiance
    Vec3 directions[CELLS_MAX], weight[CELLS_MAX];
    Rgb L[CELLS_MAX];
    float distance[CELLS_MAX];
} Gather;

static inline Second estimate(const Gather *m)
{
    IrradianceHessian h, same;
    float slope[2];
    sheen_estimate_lobe_hessian(m->strata, m->directions, m->weighted ? m->weight : NULL, m->L, m->distance, &h, slope);
    sheen_estimate_lobe_hessian(m->strata, m->directions, m->weighted ? m->weight : NULL, m->L, m->distance, &same,
                                NULL);
    assert_memory_equal(&h, &same, sizeof h);
    sheen_estimate_hessian(m->strata, m->directions, m->L, m->distance, &same, NULL);
    if (!m->weighted) assert_memory_equal(&h, &same, sizeof h);
    return (Second){(double)slope[0], (double)slope[1], (double)h.xx, (double)h.xy, (double)h.yy};
}

/** A screen of radiance 1 on black, one edge of which passes near the zenith. */
static const Double3 screen[4] = {{0.05, -0.5, 0.9}, {0.8, -0.5, 0.9}, {0.8, 0.7, 0.9}, {0.05, 0.7, 0.9}};

static inline Seen see_screen(Double3 p, Double3 d)
{
    double t = (0.9 - p.z) / d.z, x = p.x + t * d.x, y = p.y + t * d.y;
    bool hit = x > screen[0].x && x < screen[2].x && y > screen[0].y && y < screen[2].y;
    return hit ? (Seen){1.0, t, d3(0, 0, -1)} : (Seen){0.0, INFINITY, d3(0, 0, 0)};
}

/** A jittered gather of at most CELLS_MAX cells in a scene. */
static inline void gather_scene(KitScene *scene, Double3 p, SheenStrata s, uint32_t seed, Gather *out)
{
    out->strata = s;
    out->weighted = false;
    sheen_strata_directions(s, seed, out->directions);
    for (unsigned i = 0; i < strata_count(s); ++i) {
        Vec3 d = out->directions[i];
        Seen seen = scene(p, d3((double)d.x, (double)d.y, (double)d.z));
        out->L[i] = rgb_gray((float)seen.L);
        out->distance[i] = (float)seen.r;
    }
}

#endif
