// SPDX-License-Identifier: Apache-2.0
// Thinning of a wave: what is accepted is spread, what is dropped is covered.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/hash.h"
#include "cache/record.h"
#include "integrator/thin.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH = 64, HEIGHT = 48, N = WIDTH * HEIGHT };
static const float A = 0.15f, PIXEL = 0.01f, CELL_PX = 12.0f;

static float random_unit(uint32_t i, uint32_t use)
{
    return hash_to_unit(hash_combine(i, use));
}

// A folded sheet of paper seen from above: one point a pixel, with a fold in the middle, and a spacing of its own.
static void make_points(ShadingPoint points[N], uint32_t candidates[N], float spacing[N])
{
    for (uint32_t i = 0; i < N; ++i) {
        uint32_t x = i % WIDTH, y = i / WIDTH;
        Vec3 n = x < WIDTH / 2 ? v3(0, 0, 1) : v3_normalize(v3(0.3f, 0, 1));
        points[i] = (ShadingPoint){.pixel = i, .footprint = PIXEL};
        points[i].point.p = v3(PIXEL * (float)x, PIXEL * (float)y, 0.0f);
        points[i].point.n = points[i].point.ng = n;
        candidates[i] = i;
        spacing[i] = PIXEL * (2.0f + (CELL_PX - 2.0f) * random_unit(i / 7, 1));
    }
}

static void shuffle(uint32_t candidates[N], uint32_t seed)
{
    for (uint32_t i = N - 1; i > 0; --i) {
        uint32_t j = hash_combine(seed, i) % (i + 1), c = candidates[i];
        candidates[i] = candidates[j];
        candidates[j] = c;
    }
}

// Whether a record of that reach at q would hold the candidate: the definition.
static bool covers(const ShadingPoint *q, const ShadingPoint *c, float reach)
{
    float d2 = v3_length2(v3_sub(q->point.p, c->point.p));
    return record_weight(reach / A, d2, v3_dot(q->point.n, c->point.n)) > 1.0f / A;
}

static size_t thin(const ShadingPoint points[], size_t n, const uint32_t candidates[], const float spacing[],
                   uint32_t accepted[])
{
    size_t count = 99;
    static float a[N];
    for (size_t i = 0; i < N; ++i) a[i] = A;
    assert_int_equal(sheen_thin(CELL_PX, WIDTH, points, n, candidates, spacing, a, accepted, &count), SHEEN_OK);
    return count;
}

static void test_spread_and_covered(void **state)
{
    (void)state;
    static ShadingPoint points[N];
    static uint32_t candidates[N], accepted[N];
    static float spacing[N];
    for (uint32_t seed = 0; seed < 3; ++seed) {
        make_points(points, candidates, spacing);
        if (seed) shuffle(candidates, seed);
        size_t n = thin(points, N, candidates, spacing, accepted), at = 0;
        assert_true(n > 20 && n < N / 4);
        // Walk the candidates again: `at` accepted ones lie before each.
        for (size_t i = 0; i < N; ++i) {
            const ShadingPoint *c = &points[candidates[i]];
            size_t held = 0;
            for (size_t j = 0; j < at; ++j) held += covers(&points[accepted[j]], c, spacing[i]);
            if (at < n && accepted[at] == candidates[i]) {
                assert_int_equal(held, 0);
                ++at;
            } else {
                assert_true(held > 0);
            }
        }
        assert_int_equal(at, n); // nothing else was accepted, and all in order
    }
}

// With one spacing for all, no two accepted points with the same normal are nearer than it.
static void test_mutual_spacing(void **state)
{
    (void)state;
    static ShadingPoint points[N];
    static uint32_t candidates[N], accepted[N];
    static float spacing[N];
    make_points(points, candidates, spacing);
    shuffle(candidates, 5);
    for (size_t i = 0; i < N; ++i) spacing[i] = 8.0f * PIXEL;
    size_t n = thin(points, N, candidates, spacing, accepted), across = 0;
    for (size_t i = 0; i < n; ++i)
        for (size_t j = 0; j < i; ++j) {
            const DiffusePoint *p = &points[accepted[i]].point, *q = &points[accepted[j]].point;
            float d = v3_length(v3_sub(p->p, q->p));
            // The fold of 17 degrees is more than the weight bridges at any distance: 1 - cos 17 > a^2.
            if (p->n.x == q->n.x)
                assert_true(d >= 8.0f * PIXEL * 0.9999f);
            else
                across += d < 8.0f * PIXEL;
        }
    assert_true(across > 0); // on both sides of the fold points stand close to each other
    // A packing of discs of radius 4 is at most as dense as hexagons: 2 / sqrt(3) points a spacing^2, and the border.
    assert_true((double)n < 1.16 * (WIDTH + 8) * (HEIGHT + 8) / 64.0);
}

static void test_first_is_accepted(void **state)
{
    (void)state;
    static ShadingPoint points[N];
    static uint32_t candidates[N], accepted[N];
    static float spacing[N];
    make_points(points, candidates, spacing);
    uint32_t two[2] = {700, 701};
    float wide[2] = {8.0f * PIXEL, 8.0f * PIXEL};
    assert_int_equal(thin(points, 2, two, wide, accepted), 1);
    assert_int_equal(accepted[0], 700);
    two[0] = 701, two[1] = 700;
    assert_int_equal(thin(points, 2, two, wide, accepted), 1);
    assert_int_equal(accepted[0], 701);
    // What counts is the reach that a record at the candidate would have.
    wide[1] = 0.5f * PIXEL;
    assert_int_equal(thin(points, 2, two, wide, accepted), 2);
}

// Only the candidates' order and places count: not their number in the array, not what else lies there.
static void test_order_alone(void **state)
{
    (void)state;
    static ShadingPoint points[N], moved[N];
    static uint32_t candidates[N], there[N], accepted[N], accepted_there[N];
    static float spacing[N];
    make_points(points, candidates, spacing);
    shuffle(candidates, 9);
    size_t half = N / 2;
    for (uint32_t i = 0; i < N; ++i) moved[N - 1 - i] = points[i];
    for (size_t i = 0; i < half; ++i) there[i] = N - 1 - candidates[i];
    size_t n = thin(points, half, candidates, spacing, accepted);
    assert_int_equal(thin(moved, half, there, spacing, accepted_there), n);
    for (size_t i = 0; i < n; ++i) assert_int_equal(accepted_there[i], N - 1 - accepted[i]);
    // Again: the same.
    assert_int_equal(thin(points, half, candidates, spacing, accepted_there), n);
    assert_memory_equal(accepted, accepted_there, n * sizeof *accepted);
}

static void test_empty(void **state)
{
    (void)state;
    assert_int_equal(thin(NULL, 0, NULL, NULL, NULL), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_spread_and_covered),
        cmocka_unit_test(test_mutual_spacing),
        cmocka_unit_test(test_first_is_accepted),
        cmocka_unit_test(test_order_alone),
        cmocka_unit_test(test_empty),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
