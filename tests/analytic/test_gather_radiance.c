// SPDX-License-Identifier: Apache-2.0
// The gather's coefficients of radiance and their gradients against quadrature and a second implementation.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "analytic/radiance_reference.h"
#include "analytic/radiance_walls.h"

/** An estimate and its arrays. */
typedef struct Estimate {
    Rgb lambda[SHEEN_BASIS_MAX], slope[2][SHEEN_BASIS_MAX];
    float R, error;
} Estimate;

static void estimate(const KitGather *g, SheenBasis basis, unsigned n, SheenGradient gradient, Estimate *out)
{
    SheenRadianceTables *tables;
    assert_int_equal(sheen_radiance_tables_create(g->strata, basis, n, &tables), SHEEN_OK);
    RadianceSamples samples = kit_samples(g);
    RadianceEstimate e = {.lambda = out->lambda, .dx = out->slope[0], .dy = out->slope[1]};
    sheen_estimate_radiance(tables, &samples, gradient, &e);
    out->R = e.R;
    out->error = e.error;
    sheen_radiance_tables_destroy(&tables);
    assert_null(tables);
}

static double norm(unsigned n, const double a[])
{
    double sum = 0.0;
    for (unsigned i = 0; i < n * n; ++i) sum += a[i] * a[i];
    return sqrt(sum);
}

/** Distance of the red channel from exact values; green has to be twice red, and blue 0. */
static double distance_from(unsigned n, const Rgb got[], const double want[])
{
    double d[KIT_BASIS_MAX];
    for (unsigned i = 0; i < n * n; ++i) {
        d[i] = (double)got[i].r - want[i];
        assert_true(fabsf(got[i].g - 2.0f * got[i].r) <= 1e-5f * (1.0f + fabsf(got[i].r)));
        assert_true(got[i].b == 0.0f);
    }
    return norm(n, d);
}

// A distance of both gradients, relative to the length of both.
static double relative(unsigned n, Rgb got[2][SHEEN_BASIS_MAX], const double x[], const double y[])
{
    return hypot(distance_from(n, got[0], x), distance_from(n, got[1], y)) / hypot(norm(n, x), norm(n, y));
}

static KitGather g; // too large for some stacks
static Estimate e;

// ---- the judges -------------------------------------------------------------------------------------------------

static void test_quadrature_agrees_with_second_implementation(void **state)
{
    (void)state;
    for (int c = 0; c < KIT_CASES; ++c) {
        KitTruth t;
        kit_truth(&kit_cases[c], SHEEN_BASIS_HSH, 4, &t);
        const Reference *r = &references[c];
        for (int i = 0; i < REFERENCE_SIZE; ++i) {
            // Ten digits; the second implementation has other nodes. Differences of fourth order have h^4 / 30 of a
            // fifth derivative, which is some 1e3 at the sphere.
            assert_true(fabs(t.lambda[i] - r->lambda[i]) < 1e-8);
            assert_true(fabs(t.slope[0][i] - r->dx[i]) < 1e-7 && fabs(t.slope[1][i] - r->dy[i]) < 1e-7);
        }
    }
}

static void test_walls_agree_with_second_implementation(void **state)
{
    (void)state;
    for (int c = 0; c < KIT_CASES; ++c) {
        const Reference *r = &references[c];
        double integral[2][KIT_BASIS_MAX], edge[2][KIT_BASIS_MAX], nearer[2][KIT_BASIS_MAX], printed[2][KIT_BASIS_MAX];
        kit_gather(&kit_cases[c], 16, 64, JITTER_NONE, 0, &g);
        kit_wall_gradient(&g, SHEEN_BASIS_HSH, 4, WALLS_INTEGRAL, true, integral);
        kit_wall_gradient(&g, SHEEN_BASIS_HSH, 4, WALLS_EDGE, true, edge);
        kit_wall_gradient(&g, SHEEN_BASIS_HSH, 4, WALLS_EDGE, false, nearer);
        kit_wall_gradient(&g, SHEEN_BASIS_HSH, 4, WALLS_PRINTED, false, printed);
        for (int axis = 0; axis < 2; ++axis)
            for (int i = 0; i < REFERENCE_SIZE; ++i) { // misses are 1e9 away there
                assert_true(fabs(integral[axis][i] - r->integral[axis][i]) < 1e-8);
                assert_true(fabs(edge[axis][i] - r->edge[axis][i]) < 1e-8);
                assert_true(fabs(nearer[axis][i] - r->nearer[axis][i]) < 1e-8);
                assert_true(fabs(printed[axis][i] - r->printed[axis][i]) < 1e-8);
            }
    }
}

// ---- one gather -------------------------------------------------------------------------------------------------

static void test_cell_centers_agree_with_second_implementation(void **state)
{
    (void)state;
    for (int c = 0; c < KIT_CASES; ++c) {
        const Reference *r = &references[c];
        kit_gather(&kit_cases[c], 16, 64, JITTER_NONE, 0, &g);
        // Floats have 6e-8, the sums some 1e-6 of their largest terms. Differences, of step 3e-3, have that over the
        // step, and leave out a third derivative: 6e-5, measured.
        estimate(&g, SHEEN_BASIS_HSH, 4, SHEEN_GRADIENT_STRATIFIED, &e);
        assert_true(distance_from(4, e.lambda, r->cell_lambda) < 2e-6 * norm(4, r->cell_lambda));
        assert_true(relative(4, e.slope, r->integral[0], r->integral[1]) < 2e-6);
        assert_true(fabs((double)e.R / r->R - 1.0) < 1e-5);
        estimate(&g, SHEEN_BASIS_HSH, 4, SHEEN_GRADIENT_ANALYTICAL, &e);
        assert_true(relative(4, e.slope, r->analytical[0], r->analytical[1]) < 5e-6);
        estimate(&g, SHEEN_BASIS_HSH, 4, SHEEN_GRADIENT_NUMERICAL, &e);
        assert_true(relative(4, e.slope, r->analytical[0], r->analytical[1]) < 1e-4);
    }
}

/** Random light, distances and normals; a tenth is sky. */
static void gather_anything(unsigned rings, unsigned sectors, uint32_t seed)
{
    kit_gather(&kit_cases[0], rings, sectors, JITTER_CELL, seed, &g);
    for (unsigned i = 0; i < rings * sectors; ++i) {
        float L = (float)kit_number(seed, i, 2);
        bool sky = kit_number(seed, i, 3) < 0.1;
        g.L[i] = rgb(L, 2.0f * L, 0.0f);
        g.distance[i] = sky ? INFINITY : 0.5f + (float)kit_number(seed, i, 4);
        g.radiance[i] = (double)L;
        g.inverse[i] = sky ? 0.0 : 1.0 / (double)g.distance[i];
        float z = 2.0f * (float)kit_number(seed, i, 5) - 1.0f, phi = 6.28f * (float)kit_number(seed, i, 6);
        float s = sqrtf(1.0f - z * z);
        g.normals[i] = sky ? v3(NAN, NAN, NAN) : v3(s * cosf(phi), s * sinf(phi), z);
    }
}

// All orders and strata, those that do not fill a block of rings among them.
static void test_stratified_is_its_formula(void **state)
{
    (void)state;
    static const unsigned counts[][2] = {{1, 1}, {1, 3}, {5, 3}, {16, 64}, {17, 9}, {40, 21}};
    static const unsigned orders[] = {1, 2, 3, 5, 10, 12};
    for (size_t c = 0; c < sizeof counts / sizeof *counts; ++c)
        for (size_t o = 0; o < sizeof orders / sizeof *orders; ++o)
            for (int b = 0; b < 2; ++b) {
                SheenBasis basis = b ? SHEEN_BASIS_SH : SHEEN_BASIS_HSH;
                unsigned n = orders[o];
                double want[2][KIT_BASIS_MAX];
                gather_anything(counts[c][0], counts[c][1], (uint32_t)(100 * c + o));
                kit_wall_gradient(&g, basis, n, WALLS_INTEGRAL, true, want);
                estimate(&g, basis, n, SHEEN_GRADIENT_STRATIFIED, &e);
                double length = hypot(norm(n, want[0]), norm(n, want[1]));
                double off = hypot(distance_from(n, e.slope[0], want[0]), distance_from(n, e.slope[1], want[1]));
                assert_true(off <= 3e-6 * length + 1e-12); // of floats; 1 x 1 cells have no walls, and no light
            }
}

// Finite differences know nothing of the derivatives of the basis, nor of eq. (11). Normals face anywhere.
static void test_numerical_is_analytical(void **state)
{
    (void)state;
    static const unsigned orders[] = {1, 2, 4, 10};
    for (size_t o = 0; o < sizeof orders / sizeof *orders; ++o)
        for (int b = 0; b < 2; ++b) {
            unsigned n = orders[o];
            static Estimate numerical;
            double x[KIT_BASIS_MAX], y[KIT_BASIS_MAX];
            gather_anything(16, 63, (uint32_t)o);
            estimate(&g, b ? SHEEN_BASIS_SH : SHEEN_BASIS_HSH, n, SHEEN_GRADIENT_ANALYTICAL, &e);
            estimate(&g, b ? SHEEN_BASIS_SH : SHEEN_BASIS_HSH, n, SHEEN_GRADIENT_NUMERICAL, &numerical);
            for (unsigned i = 0; i < n * n; ++i) {
                x[i] = (double)e.slope[0][i].r;
                y[i] = (double)e.slope[1][i].r;
            }
            assert_true(relative(n, numerical.slope, x, y) < (n > 4 ? 1e-3 : 3e-4)); // of floats, and of n^2 step^2 / 6
        }
}

// One ray that grazes what it hits, at a cosine of 0.02: 0.05 takes its place where it divides.
static void test_grazing_hits_are_bounded(void **state)
{
    (void)state;
    kit_gather(&kit_cases[0], 16, 64, JITTER_NONE, 0, &g);
    for (int i = 0; i < 16 * 64; ++i) g.L[i] = rgb(i == 8 ? 1.0f : 0.0f, i == 8 ? 2.0f : 0.0f, 0.0f);
    Vec3 d = g.directions[8], side = v3_normalize(v3_cross(d, v3(0.0f, 0.0f, 1.0f)));
    Vec3 n = v3_mad(v3_scale(side, sqrtf(1.0f - 0.02f * 0.02f)), -0.02f, d);
    g.normals[8] = n;
    g.distance[8] = 2.0f;
    estimate(&g, SHEEN_BASIS_HSH, 1, SHEEN_GRADIENT_ANALYTICAL, &e);
    double scale = 2.0 * 3.141592653589793 / 1024.0 / sqrt(2.0 * 3.141592653589793) / 2.0;
    double x = scale * (double)(2.0f * d.x + (n.x + 0.02f * d.x) / 0.05f);
    double y = scale * (double)(2.0f * d.y + (n.y + 0.02f * d.y) / 0.05f);
    assert_true(relative(1, e.slope, &x, &y) < 1e-5);
    estimate(&g, SHEEN_BASIS_HSH, 1, SHEEN_GRADIENT_NUMERICAL, &e);
    assert_true(relative(1, e.slope, &x, &y) < 1e-3);
}

// ---- the mean of many -------------------------------------------------------------------------------------------

/** Means over gathers with jitter. */
typedef struct Mean {
    double lambda[KIT_BASIS_MAX], variance[KIT_BASIS_MAX], slope[2][KIT_BASIS_MAX];
    double error2; // mean square of the standard error that gathers tell
} Mean;

static void average(const KitCase *c, unsigned rings, SheenBasis basis, unsigned n, SheenGradient gradient,
                    unsigned repeats, Mean *out)
{
    memset(out, 0, sizeof *out);
    for (unsigned r = 0; r < repeats; ++r) {
        kit_gather(c, rings, 4 * rings, JITTER_CELL, r, &g);
        estimate(&g, basis, n, gradient, &e);
        out->error2 += (double)e.error * (double)e.error / repeats;
        for (unsigned i = 0; i < n * n; ++i) {
            double lambda = (double)e.lambda[i].r;
            out->lambda[i] += lambda / repeats;
            out->variance[i] += lambda * lambda / repeats;
            for (int axis = 0; axis < 2; ++axis) out->slope[axis][i] += (double)e.slope[axis][i].r / repeats;
        }
    }
    for (unsigned i = 0; i < n * n; ++i) out->variance[i] -= out->lambda[i] * out->lambda[i];
}

static double bias(unsigned n, double slope[2][KIT_BASIS_MAX], const KitTruth *t)
{
    double d[2][KIT_BASIS_MAX];
    for (int axis = 0; axis < 2; ++axis)
        for (unsigned i = 0; i < n * n; ++i) d[axis][i] = slope[axis][i] - t->slope[axis][i];
    return hypot(norm(n, d[0]), norm(n, d[1])) / hypot(norm(n, t->slope[0]), norm(n, t->slope[1]));
}

static void test_coefficients_are_unbiased_and_their_error_known(void **state)
{
    (void)state;
    enum { REPEATS = 200, N = 5 };
    const double luminance = 0.2126 + 2.0 * 0.7152; // of red 1, green 2
    for (int c = 0; c < KIT_CASES; ++c)
        for (int b = 0; b < 2; ++b) {
            SheenBasis basis = b ? SHEEN_BASIS_SH : SHEEN_BASIS_HSH;
            KitTruth t;
            Mean m;
            double variance = 0.0;
            kit_truth(&kit_cases[c], basis, N, &t);
            average(&kit_cases[c], 16, basis, N, SHEEN_GRADIENT_STRATIFIED, REPEATS, &m);
            for (int i = 0; i < N * N; ++i) {
                // 5 standard errors of the mean, for 150 numbers.
                assert_true(fabs(m.lambda[i] - t.lambda[i]) < 5.0 * sqrt(m.variance[i] / REPEATS) + 1e-6);
                variance += m.variance[i] / (N * N);
            }
            // SH have half of their squares below the horizon, where the light is known. The smaller of two squared
            // differences is too small for noise: 0.67 to 1.1, measured for orders 1 to 10 and 1024 to 16384 rays.
            double ratio = sqrt(m.error2 / variance) / luminance / (b ? sqrt(2.0) : 1.0);
            assert_true(ratio > 0.6 && ratio < 1.2);
        }
}

static void test_gradients_converge(void **state)
{
    (void)state;
    // Relative bias of the stratified one, n = 4 and 10, for 16 x 64 and 64 x 256 cells: measured 0.011, 0.001, 0.080,
    // 0.003 in the box, where the basis at the middles of the walls has 0.033, 0.003, 0.196, 0.024. At the edge of a
    // sphere the nearer distance is that of a sample inside it, and is too small: the bias falls with the root of the
    // number of rays. Bounds leave room for the noise of the mean.
    static const double bounds[KIT_CASES][2][2] = {
        {{0.016, 0.0025}, {0.1, 0.008}}, {{0.125, 0.085}, {0.225, 0.085}}, {{0.14, 0.09}, {0.275, 0.09}}};
    for (int c = 0; c < KIT_CASES; ++c)
        for (int o = 0; o < 2; ++o)
            for (int fine = 0; fine < 2; ++fine) {
                unsigned n = o ? 10 : 4;
                KitTruth t;
                Mean m;
                kit_truth(&kit_cases[c], SHEEN_BASIS_HSH, n, &t);
                average(&kit_cases[c], fine ? 64 : 16, SHEEN_BASIS_HSH, n, SHEEN_GRADIENT_STRATIFIED, fine ? 12 : 60,
                        &m);
                assert_true(bias(n, m.slope, &t) < bounds[c][o][fine]);
            }
}

static void test_analytical_is_blind_to_occlusion(void **state)
{
    (void)state;
    // Nothing is hidden in the box; the bright sphere hides what is as black as its surroundings. Before the ceiling
    // half of the gradient is missing at any number of rays.
    static const double least[KIT_CASES] = {0.0, 0.0, 0.5}, most[KIT_CASES] = {0.01, 0.03, 0.57};
    for (int c = 0; c < KIT_CASES; ++c) {
        KitTruth t;
        Mean m;
        kit_truth(&kit_cases[c], SHEEN_BASIS_HSH, 4, &t);
        average(&kit_cases[c], 32, SHEEN_BASIS_HSH, 4, SHEEN_GRADIENT_ANALYTICAL, 40, &m);
        assert_true(bias(4, m.slope, &t) >= least[c] && bias(4, m.slope, &t) < most[c]);
    }
}

static void test_printed_form_is_biased(void **state)
{
    (void)state;
    // krivanek2005-improved-radiance-gradients as printed, jitter in each cell: 0.68 and 0.71 of the gradient in the
    // box for n = 4, at 16 x 64 and 32 x 128 cells, where basis and width at the walls have 0.049 and 0.021.
    KitTruth t;
    kit_truth(&kit_cases[0], SHEEN_BASIS_HSH, 4, &t);
    for (unsigned rings = 16; rings <= 32; rings *= 2) {
        enum { REPEATS = 40 };
        double printed[2][KIT_BASIS_MAX] = {{0}}, edge[2][KIT_BASIS_MAX] = {{0}}, one[2][KIT_BASIS_MAX];
        for (unsigned r = 0; r < REPEATS; ++r) {
            kit_gather(&kit_cases[0], rings, 4 * rings, JITTER_CELL, r, &g);
            for (int form = 0; form < 2; ++form) {
                kit_wall_gradient(&g, SHEEN_BASIS_HSH, 4, form ? WALLS_EDGE : WALLS_PRINTED, false, one);
                for (int axis = 0; axis < 2; ++axis)
                    for (int i = 0; i < 16; ++i) (form ? edge : printed)[axis][i] += one[axis][i] / REPEATS;
            }
        }
        assert_true(bias(4, printed, &t) > 0.4);
        assert_true(bias(4, edge, &t) < (rings == 16 ? 0.06 : 0.03));
    }
}

// ---- limits -----------------------------------------------------------------------------------------------------

static void test_sky_and_uniform_light(void **state)
{
    (void)state;
    for (int b = 0; b < 2; ++b) {
        kit_gather(&kit_cases[0], 16, 64, JITTER_NONE, 0, &g);
        // Light of one color from near walls does not change, whatever the distances are.
        for (int i = 0; i < 16 * 64; ++i) g.L[i] = rgb(1.0f, 2.0f, 0.0f);
        estimate(&g, b ? SHEEN_BASIS_SH : SHEEN_BASIS_HSH, 4, SHEEN_GRADIENT_STRATIFIED, &e);
        // sqrt(2 pi), or half of sqrt(4 pi): the constant function is constant.
        assert_true(fabsf(e.lambda[0].r - (b ? 1.77245385f : 2.50662827f)) < 1e-5f);
        for (int i = 0; i < 16; ++i) assert_true(e.slope[0][i].r == 0.0f && e.slope[1][i].r == 0.0f);
        // No light from far away changes, whatever it is.
        kit_gather(&kit_cases[0], 16, 64, JITTER_CELL, 1, &g);
        for (int i = 0; i < 16 * 64; ++i) g.distance[i] = INFINITY;
        for (int kind = SHEEN_GRADIENT_STRATIFIED; kind < SHEEN_GRADIENT_NONE; ++kind) {
            estimate(&g, b ? SHEEN_BASIS_SH : SHEEN_BASIS_HSH, 4, (SheenGradient)kind, &e);
            assert_true(isinf(e.R));
            for (int i = 0; i < 16; ++i) assert_true(e.slope[0][i].r == 0.0f && e.slope[1][i].r == 0.0f);
        }
    }
}

// All lengths twice as long: half the gradient, to the last bit.
static void test_scale(void **state)
{
    (void)state;
    for (int kind = SHEEN_GRADIENT_STRATIFIED; kind < SHEEN_GRADIENT_NONE; ++kind) {
        static Estimate far;
        kit_gather(&kit_cases[2], 16, 64, JITTER_CELL, 3, &g);
        estimate(&g, SHEEN_BASIS_HSH, 4, (SheenGradient)kind, &e);
        for (int i = 0; i < 16 * 64; ++i) g.distance[i] *= 2.0f;
        estimate(&g, SHEEN_BASIS_HSH, 4, (SheenGradient)kind, &far);
        assert_true(far.R == 2.0f * e.R && far.error == e.error);
        for (int i = 0; i < 16; ++i) {
            assert_true(far.lambda[i].r == e.lambda[i].r);
            assert_true(far.slope[0][i].r == 0.5f * e.slope[0][i].r && far.slope[1][i].r == 0.5f * e.slope[1][i].r);
        }
    }
}

static void test_odd_numbers(void **state)
{
    (void)state;
    // A distance that is none takes part like the sky's; directions at the pole and at the horizon are finite.
    static const float odd[] = {0.0f, NAN, -1.0f, INFINITY, 1e-38f};
    kit_gather(&kit_cases[0], 512, 3, JITTER_CELL, 5, &g);
    for (int i = 0; i < 512 * 3; i += 7) g.distance[i] = odd[i % 5];
    g.directions[0] = v3(0.0f, 0.0f, 1.0f);
    g.directions[511] = v3(1.0f, 0.0f, 0.0f);
    for (int kind = SHEEN_GRADIENT_STRATIFIED; kind < SHEEN_GRADIENT_NONE; ++kind)
        for (int b = 0; b < 2; ++b) {
            estimate(&g, b ? SHEEN_BASIS_SH : SHEEN_BASIS_HSH, SHEEN_ORDER_MAX, (SheenGradient)kind, &e);
            for (int i = 0; i < SHEEN_BASIS_MAX; ++i)
                assert_true(rgb_finite(e.lambda[i]) && rgb_finite(e.slope[0][i]) && rgb_finite(e.slope[1][i]));
        }
}

static void test_without_gradient(void **state)
{
    (void)state;
    SheenRadianceTables *tables;
    kit_gather(&kit_cases[0], 16, 64, JITTER_CELL, 9, &g);
    estimate(&g, SHEEN_BASIS_HSH, 4, SHEEN_GRADIENT_STRATIFIED, &e);
    assert_int_equal(sheen_radiance_tables_create(g.strata, SHEEN_BASIS_HSH, 4, &tables), SHEEN_OK);
    RadianceSamples samples = {g.directions, g.L, g.distance, NULL};
    Rgb lambda[16];
    RadianceEstimate out = {.lambda = lambda};
    sheen_estimate_radiance(tables, &samples, SHEEN_GRADIENT_NONE, &out);
    assert_memory_equal(lambda, e.lambda, sizeof lambda);
    assert_true(out.R == e.R && out.error == e.error && !out.dx && !out.dy);
    sheen_radiance_tables_destroy(&tables);
}

static void test_tables_refuse(void **state)
{
    (void)state;
    static const struct {
        SheenStrata s;
        unsigned n;
    } bad[] = {{{16, 64, SHEEN_DENSITY_COSINE}, 4},         {{0, 64, SHEEN_DENSITY_UNIFORM}, 4},
               {{16, 0, SHEEN_DENSITY_UNIFORM}, 4},         {{16, 64, SHEEN_DENSITY_UNIFORM}, 0},
               {{16, 64, SHEEN_DENSITY_UNIFORM}, 33},       {{SHEEN_RINGS_MAX + 1, 64, SHEEN_DENSITY_UNIFORM}, 4},
               {{16, UINT32_MAX, SHEEN_DENSITY_UNIFORM}, 4}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        SheenRadianceTables *tables = (SheenRadianceTables *)&tables;
        assert_int_equal(sheen_radiance_tables_create(bad[i].s, SHEEN_BASIS_HSH, bad[i].n, &tables), SHEEN_ERR_INVALID);
        assert_null(tables);
    }
    SheenRadianceTables *none = NULL;
    sheen_radiance_tables_destroy(&none);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_quadrature_agrees_with_second_implementation),
        cmocka_unit_test(test_walls_agree_with_second_implementation),
        cmocka_unit_test(test_cell_centers_agree_with_second_implementation),
        cmocka_unit_test(test_stratified_is_its_formula),
        cmocka_unit_test(test_numerical_is_analytical),
        cmocka_unit_test(test_grazing_hits_are_bounded),
        cmocka_unit_test(test_coefficients_are_unbiased_and_their_error_known),
        cmocka_unit_test(test_gradients_converge),
        cmocka_unit_test(test_analytical_is_blind_to_occlusion),
        cmocka_unit_test(test_printed_form_is_biased),
        cmocka_unit_test(test_sky_and_uniform_light),
        cmocka_unit_test(test_scale),
        cmocka_unit_test(test_odd_numbers),
        cmocka_unit_test(test_without_gradient),
        cmocka_unit_test(test_tables_refuse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
