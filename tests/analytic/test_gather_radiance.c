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
        double edge[2][KIT_BASIS_MAX], nearer[2][KIT_BASIS_MAX], printed[2][KIT_BASIS_MAX];
        kit_gather(&kit_cases[c], 16, 64, JITTER_NONE, 0, &g);
        kit_wall_gradient(&g, SHEEN_BASIS_HSH, 4, WALLS_EDGE, true, edge);
        kit_wall_gradient(&g, SHEEN_BASIS_HSH, 4, WALLS_EDGE, false, nearer);
        kit_wall_gradient(&g, SHEEN_BASIS_HSH, 4, WALLS_PRINTED, false, printed);
        for (int axis = 0; axis < 2; ++axis)
            for (int i = 0; i < REFERENCE_SIZE; ++i) { // misses are 1e9 away there
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
        assert_true(relative(4, e.slope, r->edge[0], r->edge[1]) < 2e-6);
        assert_true(fabs((double)e.R / r->R - 1.0) < 1e-5);
        estimate(&g, SHEEN_BASIS_HSH, 4, SHEEN_GRADIENT_ANALYTICAL, &e);
        assert_true(relative(4, e.slope, r->analytical[0], r->analytical[1]) < 5e-6);
        estimate(&g, SHEEN_BASIS_HSH, 4, SHEEN_GRADIENT_NUMERICAL, &e);
        assert_true(relative(4, e.slope, r->analytical[0], r->analytical[1]) < 1e-4);
    }
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
        cmocka_unit_test(test_tables_refuse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
