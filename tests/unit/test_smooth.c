// SPDX-License-Identifier: Apache-2.0
// Smoothing of records: noise goes, a gradient stays, an edge between light and dark stays.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/hash.h"
#include "cache/smooth.h"

#include <math.h>
#include <stdlib.h>

enum { SIDE = 40, N = SIDE * SIDE };
static const float SPACING = 0.1f, A = 0.2f, NOISE = 0.1f;
static const Bounds bounds = {{-1, -1, -1}, {5, 5, 1}};

static float normal_deviate(uint32_t i)
{
    float sum = 0.0f; // of 12 uniform numbers: variance 1
    for (uint32_t k = 0; k < 12; ++k) sum += hash_to_unit(hash_combine(i, k)) - 0.5f;
    return sum;
}

// Records on a square grid in the plane z = 0, each reaching its neighbor; E rises along x.
static SheenIrradianceCache *make_cache(float noise, float slope)
{
    SheenIrradianceCache *c;
    assert_int_equal(sheen_irradiance_cache_create(A, false, &bounds, &c), SHEEN_OK);
    for (uint32_t i = 0; i < N; ++i) {
        Vec3 p = v3(SPACING * (float)(i % SIDE), SPACING * (float)(i / SIDE), 0);
        float E = (1.0f + slope * p.x) * (1.0f + noise * normal_deviate(i)), R = 1.1f * SPACING / A;
        Record r = {.p = p, .n = v3(0, 0, 1), .a = A, .R = R, .R_min = R, .R_sure = R, .error = noise};
        IrradianceLight light = {.E = rgb_gray(E)};
        for (int k = 0; k < 3; ++k) light.translation[k] = v3(slope, 0, 0);
        assert_int_equal(sheen_irradiance_cache_insert(c, &r, &light), SHEEN_OK);
    }
    return c;
}

static void smooth(SheenIrradianceCache *c, unsigned threads)
{
    SheenPool *pool;
    assert_int_equal(sheen_pool_create(threads, &pool), SHEEN_OK);
    assert_int_equal(sheen_irradiance_cache_smooth(c, 0, &bounds, pool, NULL), SHEEN_OK);
    sheen_pool_destroy(&pool);
}

static double relative_rms(const SheenIrradianceCache *c, float slope, double *mean)
{
    double sum = 0.0, squares = 0.0;
    for (uint32_t i = 0; i < N; ++i) {
        double off = (double)(c->light[i].E.g / (1.0f + slope * c->store->records[i].p.x)) - 1.0;
        sum += off;
        squares += off * off;
    }
    *mean = sum / N;
    return sqrt(squares / N);
}

static void test_noise_goes_and_slope_stays(void **state)
{
    (void)state;
    const float slopes[] = {0.0f, 0.5f};
    for (int i = 0; i < 2; ++i) {
        SheenIrradianceCache *c = make_cache(NOISE, slopes[i]);
        double mean, before = relative_rms(c, slopes[i], &mean);
        smooth(c, 2);
        double after = relative_rms(c, slopes[i], &mean);
        // The four neighbors at one reach have twice the variance of the record's own, so the best that the mean of
        // five can do is 1 / sqrt(3) of the noise; those at the diagonals help a little more.
        assert_true(after < 0.65 * before);
        // 1600 records leave 0.1 / 40 of the mean; weights by value favour the low ones by less.
        assert_true(fabs(mean) < 0.01);
        sheen_irradiance_cache_destroy(&c);
    }
}

static void test_without_noise_nothing_changes(void **state)
{
    (void)state;
    SheenIrradianceCache *c = make_cache(0.0f, 0.5f), *same = make_cache(0.0f, 0.5f);
    smooth(c, 1);
    assert_memory_equal(c->light, same->light, N * sizeof *c->light);
    sheen_irradiance_cache_destroy(&c);
    sheen_irradiance_cache_destroy(&same);
}

// Two floors that a thin wall divides: a thousandth on the dark side must not become a hundredth.
static void test_darkness_stays_dark(void **state)
{
    (void)state;
    SheenIrradianceCache *c = make_cache(NOISE, 0.0f);
    const float dark = 1e-3f;
    for (uint32_t i = 0; i < N; ++i)
        if (c->store->records[i].p.x > 2.0f) c->light[i].E = rgb_scale(c->light[i].E, dark);
    smooth(c, 2);
    for (uint32_t i = 0; i < N; ++i) {
        float E = c->light[i].E.g;
        assert_true(c->store->records[i].p.x > 2.0f ? E < 2.0f * dark : E > 0.5f);
    }
    sheen_irradiance_cache_destroy(&c);
}

// Radiance records of order 2 on the same grid, whose first coefficient is noisy and rises by `slope` a metre, and
// whose own radii were cut by their gradients.
static SheenRadianceCache *make_radiance(float slope)
{
    SheenRadianceCache *c;
    assert_int_equal(sheen_radiance_cache_create(SHEEN_BASIS_HSH, 2, false, A, false, &bounds, &c), SHEEN_OK);
    float *light = calloc(radiance_light_floats(c), sizeof *light);
    assert_non_null(light);
    Frame frame = frame_from_normal(v3(0, 0, 1));
    for (uint32_t i = 0; i < N; ++i) {
        Vec3 p = v3(SPACING * (float)(i % SIDE), SPACING * (float)(i / SIDE), 0);
        float R = 1.1f * SPACING / A;
        Record r = {.p = p, .n = v3(0, 0, 1), .a = A, .R = R, .R_min = R, .R_sure = 0.1f * R, .error = NOISE};
        for (size_t k = 0; k < 3; ++k) {
            light[k] = (1.0f + slope * p.x) * (1.0f + NOISE * normal_deviate(i));
            light[c->stride + k] = slope * frame.t.x;
            light[2 * c->stride + k] = slope * frame.b.x;
        }
        assert_int_equal(sheen_radiance_cache_insert(c, &r, light), SHEEN_OK);
    }
    free(light);
    return c;
}

// @return root mean square of the relative deviation of the first coefficient
static double radiance_deviation(const SheenRadianceCache *c, float slope)
{
    double squares = 0.0;
    for (uint32_t i = 0; i < N; ++i) {
        float L = c->light[i * radiance_light_floats(c)];
        double off = (double)(L / (1.0f + slope * c->store->records[i].p.x)) - 1.0;
        squares += off * off;
    }
    return sqrt(squares / N);
}

static void test_noise_of_radiance_goes(void **state)
{
    (void)state;
    const float slopes[] = {0.0f, 0.5f};
    SheenPool *pool;
    assert_int_equal(sheen_pool_create(2, &pool), SHEEN_OK);
    for (int i = 0; i < 2; ++i) {
        SheenRadianceCache *c = make_radiance(slopes[i]);
        double before = radiance_deviation(c, slopes[i]);
        assert_int_equal(sheen_radiance_cache_smooth(c, 0, &bounds, pool, NULL), SHEEN_OK);
        assert_true(radiance_deviation(c, slopes[i]) < 0.65 * before); // as of irradiance
        sheen_radiance_cache_destroy(&c);
    }
    sheen_pool_destroy(&pool);
}

// Refined records learn less: their light was told apart.
static void test_refined_radiance_learns_less(void **state)
{
    (void)state;
    float a[N];
    SheenPool *pool;
    SheenRadianceCache *coarse = make_radiance(0.5f), *fine = make_radiance(0.5f);
    for (int i = 0; i < N; ++i) a[i] = 0.25f * A;
    sheen_store_refine(fine->store, a);
    double before = radiance_deviation(fine, 0.5f);
    assert_int_equal(sheen_pool_create(2, &pool), SHEEN_OK);
    assert_int_equal(sheen_radiance_cache_smooth(coarse, 0, &bounds, pool, NULL), SHEEN_OK);
    assert_int_equal(sheen_radiance_cache_smooth(fine, 0, &bounds, pool, NULL), SHEEN_OK);
    double learnt = before - radiance_deviation(fine, 0.5f), most = before - radiance_deviation(coarse, 0.5f);
    assert_true(learnt > 0.0 && learnt < 0.9 * most); // 0.84 of it; all where accuracies are not asked for
    sheen_pool_destroy(&pool);
    sheen_radiance_cache_destroy(&coarse);
    sheen_radiance_cache_destroy(&fine);
}

// Records before the first that learns stay as they are.
static void test_settled_records_stay(void **state)
{
    (void)state;
    SheenIrradianceCache *c = make_cache(NOISE, 0.5f), *same = make_cache(NOISE, 0.5f);
    SheenPool *pool;
    assert_int_equal(sheen_pool_create(2, &pool), SHEEN_OK);
    assert_int_equal(sheen_irradiance_cache_smooth(c, N / 2, &bounds, pool, NULL), SHEEN_OK);
    sheen_pool_destroy(&pool);
    assert_memory_equal(c->light, same->light, N / 2 * sizeof *c->light);
    assert_memory_not_equal(c->light + N / 2, same->light + N / 2, N / 2 * sizeof *c->light);
    sheen_irradiance_cache_destroy(&c);
    sheen_irradiance_cache_destroy(&same);
}

// A dark, small record, as in a crack, under more large bright ones than a look-up has room for: it stays dark.
static void test_small_record_stays_itself(void **state)
{
    (void)state;
    SheenIrradianceCache *c = make_cache(NOISE, 0.0f);
    for (uint32_t i = 0; i < 100; ++i) {
        float R = 1.0f / A;
        Vec3 p = v3(1.0f + 1e-3f * (float)i, 1.55f, 0);
        Record large = {.p = p, .n = v3(0, 0, 1), .a = A, .R = R, .R_min = R, .R_sure = R, .error = NOISE};
        IrradianceLight bright = {.E = rgb_gray(1.0f)};
        assert_int_equal(sheen_irradiance_cache_insert(c, &large, &bright), SHEEN_OK);
    }
    Record dark = {.p = v3(1.25f, 1.55f, 0), .n = v3(0, 0, 1), .a = A, .R = 0.1f, .R_min = 0.1f, .R_sure = 0.1f};
    dark.error = NOISE;
    IrradianceLight black = {.E = rgb_gray(1e-3f)};
    assert_int_equal(sheen_irradiance_cache_insert(c, &dark, &black), SHEEN_OK);
    smooth(c, 1);
    // Its own variance is 1/100 where the others, a thousand times as bright, count for (.1 .. .5)^2 700^2 each.
    assert_true(c->light[c->store->n - 1].E.g < 2e-3f);
    sheen_irradiance_cache_destroy(&c);
}

static void test_threads_do_not_matter(void **state)
{
    (void)state;
    SheenIrradianceCache *a = make_cache(NOISE, 0.5f), *b = make_cache(NOISE, 0.5f);
    smooth(a, 1);
    smooth(b, 7);
    assert_memory_equal(a->light, b->light, N * sizeof *a->light);
    sheen_irradiance_cache_destroy(&a);
    sheen_irradiance_cache_destroy(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_noise_goes_and_slope_stays),    cmocka_unit_test(test_noise_of_radiance_goes),
        cmocka_unit_test(test_refined_radiance_learns_less),  cmocka_unit_test(test_settled_records_stay),
        cmocka_unit_test(test_without_noise_nothing_changes), cmocka_unit_test(test_darkness_stays_dark),
        cmocka_unit_test(test_small_record_stays_itself),     cmocka_unit_test(test_threads_do_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
