// SPDX-License-Identifier: Apache-2.0
// The sampler's promises: stratified in every elementary interval, independent between keys and dimensions.
#include "math/sampler.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

enum { LOG2_MAX = 10 };

// A sequence is a (0, 2)-sequence in base 2 when every run of 2^k samples that starts at a multiple of 2^k has exactly
// one point in each of the 2^k boxes of size 2^-i x 2^-(k-i), for each i.
static void test_pairs_are_a_02_sequence(void **state)
{
    (void)state;
    for (uint32_t key = 1; key <= 5; ++key) {
        for (uint32_t dim = 0; dim < 6; ++dim) {
            for (int k = 0; k <= LOG2_MAX; ++k) {
                uint32_t n = 1u << k, first = (key % 3u) * n;
                for (int i = 0; i <= k; ++i) {
                    unsigned char taken[1 << LOG2_MAX] = {0};
                    for (uint32_t s = first; s < first + n; ++s) {
                        SheenSampler sampler = {hash_u32(key), s, dim};
                        Vec2 u = sampler_2d(&sampler);
                        assert_true(u.x >= 0.0f && u.x < 1.0f && u.y >= 0.0f && u.y < 1.0f);
                        uint32_t cell =
                            ((uint32_t)(u.x * (float)(1u << i)) << (k - i)) | (uint32_t)(u.y * (float)(1u << (k - i)));
                        assert_int_equal(taken[cell], 0);
                        taken[cell] = 1;
                    }
                }
            }
        }
    }
}

static void test_single_dimensions_are_stratified(void **state)
{
    (void)state;
    for (uint32_t dim = 0; dim < 20; ++dim) {
        for (int k = 0; k <= LOG2_MAX; ++k) {
            uint32_t n = 1u << k;
            unsigned char taken[1 << LOG2_MAX] = {0};
            for (uint32_t s = 0; s < n; ++s) {
                SheenSampler sampler = {77u, s, dim};
                float u = sampler_1d(&sampler);
                assert_true(u >= 0.0f && u < 1.0f);
                uint32_t cell = (uint32_t)(u * (float)n);
                assert_int_equal(taken[cell], 0);
                taken[cell] = 1;
            }
        }
    }
}

// Correlation of two sets of n uniform numbers; of independent ones it has the standard deviation 1 / sqrt(n).
static double correlation(const float *a, const float *b, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; ++i) sum += ((double)a[i] - 0.5) * ((double)b[i] - 0.5);
    return 12.0 * sum / n;
}

enum { N_KEYS = 1 << 16 };

// The same sample and dimension under keys that differ little, as neighbouring pixels' do: 5 standard deviations are
// 0.0195. A key that reached the numbers only through some bits would give a correlation near 1.
static void test_keys_are_independent(void **state)
{
    (void)state;
    static float at_key[N_KEYS], at_next[N_KEYS], at_y[N_KEYS];
    for (uint32_t index = 0; index < 8; ++index) {
        for (uint32_t key = 0; key < N_KEYS; ++key) {
            SheenSampler a = sampler_make(key, index), b = sampler_make(key + 1, index);
            Vec2 u = sampler_2d(&a);
            at_key[key] = u.x;
            at_y[key] = u.y;
            at_next[key] = sampler_2d(&b).x;
        }
        assert_true(fabs(correlation(at_key, at_next, N_KEYS)) < 0.0195);
        assert_true(fabs(correlation(at_key, at_y, N_KEYS)) < 0.0195);
    }
}

// Padded dimensions of one key: over the first n samples two dimensions are two independent shuffles of strata, whose
// correlation has the standard deviation 1 / sqrt(n); 20 pairs for each of 16 keys, so 5.5 of them are allowed.
static void test_dimensions_are_independent(void **state)
{
    (void)state;
    enum { N = 4096, DIMS = 8 };
    static float u[DIMS][N];
    for (uint32_t key = 0; key < 16; ++key) {
        for (uint32_t i = 0; i < N; ++i) {
            SheenSampler s = sampler_make(hash_u32(key), i);
            for (int d = 0; d < DIMS; d += 4) {
                Vec2 pair = sampler_2d(&s);
                u[d][i] = pair.x;
                u[d + 1][i] = pair.y;
                u[d + 2][i] = sampler_1d(&s);
                u[d + 3][i] = sampler_1d(&s);
            }
        }
        for (int a = 0; a < DIMS; ++a) {
            for (int b = a + 1; b < DIMS; ++b) assert_true(fabs(correlation(u[a], u[b], N)) < 5.5 / 64.0);
        }
    }
}

// What the sampler is for: the mean of a smooth function over 4096 pairs. Independent random numbers would err by
// sqrt(7/144 / 4096) = 3.4e-3; a scrambled (0, 2)-sequence by about n^-3/2, here below 2e-4 (a hundred keys tried).
static void test_integrates_better_than_random(void **state)
{
    (void)state;
    for (uint32_t key = 0; key < 32; ++key) {
        double sum = 0.0;
        for (uint32_t i = 0; i < 4096; ++i) {
            SheenSampler s = sampler_make(hash_u32(key), i);
            Vec2 u = sampler_2d(&s);
            sum += (double)u.x * (double)u.y;
        }
        assert_true(fabs(sum / 4096.0 - 0.25) < 2e-4);
    }
}

static void test_copy_replays(void **state)
{
    (void)state;
    SheenSampler a = sampler_make(123u, 45u), b = a;
    assert_true(a.dim == 0);
    float x = sampler_1d(&a);
    Vec2 y = sampler_2d(&a);
    assert_int_equal(a.dim, 3);
    assert_true(x == sampler_1d(&b));
    Vec2 z = sampler_2d(&b);
    assert_memory_equal(&y, &z, sizeof y);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pairs_are_a_02_sequence),       cmocka_unit_test(test_single_dimensions_are_stratified),
        cmocka_unit_test(test_keys_are_independent),          cmocka_unit_test(test_dimensions_are_independent),
        cmocka_unit_test(test_integrates_better_than_random), cmocka_unit_test(test_copy_replays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
