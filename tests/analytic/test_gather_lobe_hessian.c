// SPDX-License-Identifier: Apache-2.0
// The gather's Hessian of what a lobe sends on, against finite differences of quadratures.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "analytic/hessian_kit.h"

static Gather g; // large

// (axis . d)^e cos(theta), a polynomial, without the cut where axis . d is negative: the coefficients of spherical
// harmonics up to e + 1 that the kit integrates are enough for it.
static const Double3 axis = {0.5656854249492380, 0.4242640687119285, 0.7071067811865476};

static double lobe(unsigned exponent, Double3 d)
{
    return d.z * pow(d3_dot(axis, d), exponent);
}

static Vec3 lobe_weight(unsigned exponent, Double3 d)
{
    double c = d3_dot(axis, d), k = pow(c, exponent), slope = exponent * pow(c, exponent - 1.0) * d.z;
    return v3((float)(slope * (axis.x - c * d.x)), (float)(slope * (axis.y - c * d.y)),
              (float)(k + slope * (axis.z - c * d.z)));
}

/** A scene seen through a lobe. */
typedef struct LobeCase {
    KitScene *scene;
    Double3 p;
    unsigned exponent;
    double bound[3];
    double coefficients[KIT_BASIS_MAX]; // of the lobe
} LobeCase;

static double screen_lobe(const LobeCase *c, Double3 p, const Gauss *nodes)
{
    double sum = 0.0, x0 = screen[0].x, y0 = screen[0].y, width = screen[2].x - x0, height = screen[2].y - y0;
    for (int i = 0; i < KIT_NODES; ++i)
        for (int k = 0; k < KIT_NODES; ++k) {
            Double3 v = d3_mad(d3(x0 + width * nodes->x[i], y0 + height * nodes->x[k], screen[0].z), -1.0, p);
            double r = sqrt(d3_dot(v, v)), area = nodes->w[i] * width * nodes->w[k] * height;
            sum += area * v.z / (r * r * r) * lobe(c->exponent, d3(v.x / r, v.y / r, v.z / r));
        }
    return sum;
}

static double lobe_integral(const void *lobe_case, Double3 p)
{
    const LobeCase *c = lobe_case;
    Gauss nodes;
    kit_gauss(&nodes);
    if (c->scene == see_screen) return screen_lobe(c, p, &nodes);
    Coefficients light = {SHEEN_BASIS_SH, c->exponent + 2, {0}};
    kit_integrate(&nodes, c->scene, p, &light);
    double sum = 0.0;
    for (unsigned i = 0; i < light.n * light.n; ++i) sum += light.of[i] * c->coefficients[i];
    return sum;
}

static void project_lobe(LobeCase *c)
{
    enum { TURNS = 32 };
    Gauss nodes;
    kit_gauss(&nodes);
    Coefficients sum = {SHEEN_BASIS_SH, c->exponent + 2, {0}};
    for (int i = 0; i < KIT_NODES; ++i)
        for (int k = 0; k < TURNS; ++k) {
            double z = 2.0 * nodes.x[i] - 1.0, s = sqrt(1.0 - z * z), phi = 2.0 * 3.141592653589793 * k / TURNS;
            Double3 d = d3(s * cos(phi), s * sin(phi), z);
            kit_add(&sum, d, 2.0 * nodes.w[i] * 2.0 * 3.141592653589793 / TURNS * lobe(c->exponent, d));
        }
    memcpy(c->coefficients, sum.of, sizeof sum.of);
}

static void test_lobes(void **state)
{
    (void)state;
    // Bounds as above. What is left at 6400 rays are silhouettes again.
    static LobeCase lobes[] = {
        {kit_box, {1.2, 1.1, 0}, 7, {0.029, 0.0077, 0.0009}, {0}},
        {see_screen, {0, 0, 0}, 7, {0.16, 0.08, 0.025}, {0}},
        {kit_dark_sphere, {0, 0, 0}, 7, {0.175, 0.132, 0.2}, {0}},
        {kit_bright_sphere, {0, 0, 0}, 7, {0.148, 0.235, 0.29}, {0}},
    };
    static const unsigned rays[] = {400, 1024, 6400}, repeats[] = {60, 40, 10};
    for (size_t i = 0; i < sizeof lobes / sizeof *lobes; ++i) {
        LobeCase *c = &lobes[i];
        project_lobe(c);
        Second want = differences(lobe_integral, c, c->p, 0.02);
        for (int r = 0; r < 3; ++r) {
            double sum = 0.0;
            for (uint32_t seed = 0; seed < repeats[r]; ++seed) {
                gather_scene(c->scene, c->p, sheen_strata_cosine(rays[r]), 1000 + seed, &g);
                for (unsigned k = 0; k < strata_count(g.strata); ++k) {
                    Vec3 d = g.directions[k];
                    g.weight[k] = lobe_weight(c->exponent, d3((double)d.x, (double)d.y, (double)d.z));
                }
                g.weighted = true;
                Second is = estimate(&g);
                sum += distance2(&is, &want) / repeats[r];
            }
            assert_true(sqrt(sum) < c->bound[r] * norm(&want));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lobes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
