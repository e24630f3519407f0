// SPDX-License-Identifier: Apache-2.0
// Lists of seen points: what goes in comes out, in order, with its own lobe.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "integrator/seen_points.h"

#include <stdlib.h>

static ShadingPoint point(uint32_t i)
{
    return (ShadingPoint){.pixel = i, .sample = 3 * i, .footprint = (float)i};
}

static unsigned order_of(uint32_t i)
{
    return 1 + i % 7;
}

// A lobe whose numbers tell whose it is, in a block of its own size.
static void add_glossy(uint32_t i, bool with_lobe, SeenPoints *seen)
{
    size_t n = basis_size(order_of(i));
    Rgb *lobe = malloc(n * sizeof *lobe);
    assert_non_null(lobe);
    for (size_t k = 0; k < n; ++k) lobe[k] = rgb((float)i, (float)k, (float)n);
    ShadingPoint p = point(i);
    SheenBasis basis = i % 2 ? SHEEN_BASIS_SH : SHEEN_BASIS_HSH;
    assert_true(sheen_seen_add_glossy(&p, basis, order_of(i), with_lobe ? lobe : NULL, seen));
    free(lobe);
}

static void check_glossy(const SeenPoints *seen, size_t at, uint32_t i, bool with_lobe)
{
    const GlossyPoint *g = &seen->glossy[at];
    assert_int_equal(g->at.pixel, i);
    assert_int_equal(g->at.sample, 3 * i);
    assert_true((g->basis == SHEEN_BASIS_SH) == (i % 2 == 1));
    if (!with_lobe) return;
    size_t n = basis_size(order_of(i));
    assert_int_equal(g->order, order_of(i));
    assert_true(g->lobe + n <= seen->n_lobes);
    for (size_t k = 0; k < n; ++k) {
        Rgb c = seen->lobes[g->lobe + k];
        assert_true(c.r == (float)i && c.g == (float)k && c.b == (float)n);
    }
}

static void test_points(void **state)
{
    (void)state;
    SeenPoints a = {0}, b = {0};
    ShadingPoint three[3] = {point(0), point(1), point(2)};
    assert_true(sheen_seen_add(NULL, 0, &a));
    assert_int_equal(a.n_points, 0);
    for (int i = 0; i < 500; ++i) assert_true(sheen_seen_add(three, 3, &a));
    assert_true(sheen_seen_add(three + 2, 1, &b) && sheen_seen_append(&a, &b));
    assert_int_equal(b.n_points, 1501);
    for (uint32_t i = 0; i < 1501; ++i) assert_int_equal(b.points[i].pixel, (i + 2) % 3);
    seen_clear(&b);
    assert_int_equal(b.n_points, 0);
    sheen_seen_free(&a);
    sheen_seen_free(&b);
    assert_null(b.points);
}

static void test_lobes(void **state)
{
    (void)state;
    enum { N = 300 };
    SeenPoints a = {0}, b = {0};
    for (uint32_t i = 0; i < N; ++i) add_glossy(i, true, &a);
    add_glossy(N, true, &b);
    assert_true(sheen_seen_append(&a, &b)); // behind another lobe: the numbers move
    assert_true(sheen_seen_append(&a, &b));
    assert_int_equal(b.n_glossy, 2 * N + 1);
    check_glossy(&b, 0, N, true);
    for (uint32_t i = 0; i < N; ++i) {
        check_glossy(&a, i, i, true);
        check_glossy(&b, 1 + i, i, true);
        check_glossy(&b, 1 + N + i, i, true);
    }
    seen_clear(&b);
    assert_int_equal(b.n_glossy + b.n_lobes, 0);
    add_glossy(5, true, &b);
    check_glossy(&b, 0, 5, true);
    sheen_seen_free(&a);
    sheen_seen_free(&b);
}

// Where only the place matters there is no lobe; the others keep theirs, in whatever order both come.
static void test_places_among_lobes(void **state)
{
    (void)state;
    SeenPoints a = {0}, b = {0};
    for (uint32_t i = 0; i < 50; ++i) add_glossy(i, i % 3 == 0, &a);
    assert_true(sheen_seen_append(&a, &b));
    assert_int_equal(b.n_glossy, 50);
    assert_int_equal(b.n_lobes, a.n_lobes);
    for (uint32_t i = 0; i < 50; ++i) check_glossy(&b, i, i, i % 3 == 0);
    sheen_seen_free(&a);
    sheen_seen_free(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_points),
        cmocka_unit_test(test_lobes),
        cmocka_unit_test(test_places_among_lobes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
