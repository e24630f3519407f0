// SPDX-License-Identifier: Apache-2.0
// Filter importance sampling against the filters themselves: densities, signs, moments, stratification, weights.
#include "film/pixel_filter.h"
#include "math/sampler.h"
#include "unit/chi_squared.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { N_FILTERS = 9 };

static void all_filters(SheenFilter out[N_FILTERS])
{
    for (int i = 0; i < 6; ++i) out[i] = sheen_filter_standard((SheenFilterKind)(SHEEN_FILTER_BOX + i));
    out[6] = sheen_filter_gaussian(0.3f);
    out[7] = (SheenFilter){.kind = SHEEN_FILTER_MITCHELL, .radius = 2.0f, .b = 0.2f, .c = 0.5f};
    out[8] = (SheenFilter){.kind = SHEEN_FILTER_LANCZOS, .radius = 2.0f};
}

/** Integral of the filter, of its absolute value where `size`, from lo to hi: midpoints, 1e-3 or less apart. */
static double integral(const SheenFilter *f, double lo, double hi, bool size)
{
    int n = 10 + (int)((hi - lo) * 2000.0);
    double sum = 0.0, step = (hi - lo) / n;
    for (int i = 0; i < n; ++i) {
        double value = sheen_filter_eval(f, lo + (i + 0.5) * step);
        sum += size ? fabs(value) : value;
    }
    return sum * step;
}

// What Mitsuba 3 says of its filters (scalar_rgb, ReconstructionFilter.eval), to the five digits that it was asked for.
static void test_values_are_mitsubas(void **state)
{
    (void)state;
    static const double x[7] = {0.0, 0.25, 0.49, 0.75, 1.1, 1.5, 1.9};
    static const double want[N_FILTERS][7] = {
        {1, 1, 1, 0, 0, 0, 0},
        {1, 0.75, 0.51, 0.25, 0, 0, 0},
        // For the gaussian Mitsuba takes a fast exponential, 4e-4 off: this is its formula.
        {0.99966, 0.88216, 0.61833, 0.32432, 0.08859, 0.01077, 0.0004},
        {0.88889, 0.78212, 0.54595, 0.25608, 0.0135, -0.03472, -0.00294},
        {1, 0.86719, 0.57622, 0.22656, -0.0405, -0.0625, -0.0045},
        {1, 0.89007, 0.62117, 0.27019, -0.07092, -0.13509, -0.02377},
        {0.99966, 0.70631, 0.26312, 0.0436, 0.00087, 0, 0},
        {0.93333, 0.82083, 0.5703, 0.25833, -0.0162, -0.05833, -0.00447},
        {1, 0.87735, 0.58705, 0.23535, -0.05111, -0.06368, -0.00271},
    };
    SheenFilter filters[N_FILTERS];
    all_filters(filters);
    for (int f = 0; f < N_FILTERS; ++f)
        for (int i = 0; i < 7; ++i) {
            double got = sheen_filter_eval(&filters[f], x[i]);
            if (!(fabs(got - want[f][i]) < 2e-5)) fail_msg("filter %d at %g: %.6f, not %.6f", f, x[i], got, want[f][i]);
            assert_true(sheen_filter_eval(&filters[f], -x[i]) == got);
        }
}

enum { BINS = 64 };

/** Independent numbers, so that chi-squared is what it is. */
static void test_density_is_the_size_of_the_filter(void **state)
{
    (void)state;
    SheenFilter filters[N_FILTERS];
    all_filters(filters);
    for (uint32_t f = 0; f < N_FILTERS; ++f) {
        SheenPixelFilter p;
        sheen_pixel_filter_init(&filters[f], &p);
        double observed[2][BINS] = {{0}}, expected[BINS], radius = (double)filters[f].radius;
        enum { N = 100000 };
        for (uint32_t i = 0; i < N; ++i) {
            Vec2 u = v2(hash_to_unit(hash_combine(2 * i, f)), hash_to_unit(hash_combine(2 * i + 1, f)));
            bool negative;
            Vec2 place = sheen_pixel_filter_sample(&p, u, &negative);
            double at[2] = {(double)place.x - 0.5, (double)place.y - 0.5};
            double value = sheen_filter_eval(&filters[f], at[0]) * sheen_filter_eval(&filters[f], at[1]);
            assert_true(negative == (value < 0.0) || fabs(value) < 1e-6);
            for (int axis = 0; axis < 2; ++axis) {
                assert_true(fabs(at[axis]) <= radius * (1.0 + 1e-6));
                int bin = (int)((at[axis] / radius + 1.0) * 0.5 * BINS);
                observed[axis][bin < 0 ? 0 : bin < BINS ? bin : BINS - 1] += 1.0;
            }
        }
        double all = integral(&filters[f], -radius, radius, true), width = 2.0 * radius / BINS;
        for (int i = 0; i < BINS; ++i)
            expected[i] = N * integral(&filters[f], -radius + i * width, -radius + (i + 1) * width, true) / all;
        for (int axis = 0; axis < 2; ++axis)
            assert_true(chi_squared_deviation(BINS, observed[axis], expected) < CHI_SQUARED_LIMIT);
    }
}

/** The samples' weighted sums are the filter's moments, which a grid of numbers shows to the table's precision. */
static void test_weighted_samples_have_the_moments_of_the_filter(void **state)
{
    (void)state;
    SheenFilter filters[N_FILTERS];
    all_filters(filters);
    for (int f = 0; f < N_FILTERS; ++f) {
        SheenPixelFilter p;
        sheen_pixel_filter_init(&filters[f], &p);
        enum { SIDE = 1000 };
        double sum[4] = {0}; // of 1, x, x^2 y^2, (x > 0.4) (y > -0.2)
        for (int i = 0; i < SIDE * SIDE; ++i) {
            bool negative;
            Vec2 u = v2(((float)(i % SIDE) + 0.5f) / SIDE, ((float)(i / SIDE) + 0.5f) / SIDE);
            Vec2 place = sheen_pixel_filter_sample(&p, u, &negative);
            double w = (negative ? -1.0 : 1.0) * (double)p.gain / ((double)SIDE * SIDE);
            double x = (double)place.x - 0.5, y = (double)place.y - 0.5;
            sum[0] += w;
            sum[1] += w * x;
            sum[2] += w * x * x * y * y;
            sum[3] += x > 0.4 && y > -0.2 ? w : 0.0;
        }
        double r = (double)filters[f].radius, all = integral(&filters[f], -r, r, false), second = 0.0;
        for (int i = 0; i < 20000; ++i) {
            double x = r * ((i + 0.5) / 10000.0 - 1.0);
            second += x * x * sheen_filter_eval(&filters[f], x) * r / 10000.0 / all;
        }
        double corner = integral(&filters[f], 0.4, r, false) * integral(&filters[f], -0.2, r, false) / (all * all);
        // A grid cell's probability is 1e-6 and one row's 1e-3; edges and sign changes fall inside rows.
        assert_true(fabs(sum[0] - 1.0) < 4e-3);
        assert_true(fabs(sum[1]) < 1e-5);
        assert_true(fabs(sum[2] - second * second) < 4e-3);
        assert_true(fabs(sum[3] - corner) < 4e-3);
    }
}

/** Sixteen samples of one pixel: one in each of sixteen strips of equal probability, along both axes. */
static void test_samples_are_stratified_under_the_filter(void **state)
{
    (void)state;
    SheenFilter f = sheen_filter_standard(SHEEN_FILTER_GAUSSIAN);
    SheenPixelFilter p;
    sheen_pixel_filter_init(&f, &p);
    double all = integral(&f, -2.0, 2.0, false);
    for (uint32_t key = 0; key < 50; ++key) {
        unsigned strips[2] = {0, 0};
        for (uint32_t i = 0; i < 16; ++i) {
            SheenSampler sampler = sampler_make(hash_u32(key), i);
            bool negative;
            Vec2 place = sheen_pixel_filter_sample(&p, sampler_2d(&sampler), &negative);
            strips[0] |= 1u << (int)(16.0 * integral(&f, -2.0, (double)place.x - 0.5, false) / all);
            strips[1] |= 1u << (int)(16.0 * integral(&f, -2.0, (double)place.y - 0.5, false) / all);
        }
        // A sample within 1e-5 of a strip's border may be counted with its neighbor; none of these is.
        assert_int_equal(strips[0], 0xffff);
        assert_int_equal(strips[1], 0xffff);
    }
}

static void test_a_box_leaves_samples_where_they_are(void **state)
{
    (void)state;
    SheenFilter f = sheen_filter_standard(SHEEN_FILTER_BOX), unset = {0};
    SheenPixelFilter p;
    for (int k = 0; k < 2; ++k) {
        sheen_pixel_filter_init(k ? &unset : &f, &p);
        for (uint32_t i = 0; i < 10000; ++i) {
            Vec2 u = v2(hash_to_unit(hash_u32(i)), hash_to_unit(hash_u32(~i)));
            bool negative = true;
            Vec2 place = sheen_pixel_filter_sample(&p, u, &negative);
            // 0.5 - (0.5 - u) rounds once.
            assert_true(fabsf(place.x - u.x) < 1e-7f && fabsf(place.y - u.y) < 1e-7f && !negative);
            place = sheen_pixel_filter_sample(NULL, u, &negative);
            assert_true(place.x == u.x && place.y == u.y && !negative);
        }
    }
}

static void test_weights_have_mean_one(void **state)
{
    (void)state;
    SheenFilter filters[N_FILTERS];
    all_filters(filters);
    for (int f = 0; f < N_FILTERS; ++f) {
        SheenPixelFilter p;
        sheen_pixel_filter_init(&filters[f], &p);
        for (uint32_t n = 1; n <= 64; ++n)
            for (uint32_t negative = 0; negative <= (p.has_signs ? n : 0); ++negative) {
                double w[2];
                sheen_pixel_filter_weights(&p, n, negative, w);
                assert_true(fabs(w[0] * (n - negative) + w[1] * negative - n) < 1e-10 * n);
                // Apart by twice the gain, unless there is one sort only.
                if (p.has_signs) assert_true(fabs(w[0] - w[1] - 2.0 * (double)p.gain) < 1e-12);
            }
        assert_int_equal(p.has_signs, filters[f].kind >= SHEEN_FILTER_MITCHELL);
        double expected = 0.0, w[2]; // the share of negative samples makes them gain and -gain
        double r = (double)filters[f].radius, share = 0.5 * (1.0 - 1.0 / (double)p.gain);
        sheen_pixel_filter_weights(&p, 1u << 30, (uint32_t)(share * (1u << 30)), w);
        expected = integral(&filters[f], -r, r, true) / integral(&filters[f], -r, r, false);
        if (p.has_signs) assert_true(fabs(w[0] - expected * expected) < 1e-3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values_are_mitsubas),
        cmocka_unit_test(test_density_is_the_size_of_the_filter),
        cmocka_unit_test(test_weighted_samples_have_the_moments_of_the_filter),
        cmocka_unit_test(test_samples_are_stratified_under_the_filter),
        cmocka_unit_test(test_a_box_leaves_samples_where_they_are),
        cmocka_unit_test(test_weights_have_mean_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
