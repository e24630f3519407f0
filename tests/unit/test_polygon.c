// SPDX-License-Identifier: Apache-2.0
// Polygons cut into triangles: of any simple polygon the triangles cover just its area, and none runs the other way.
#include "io/polygon.h"

#include "io_kit.h"

static Vec3 area_of(const Vec3 p[], const uint32_t t[3])
{
    return v3_scale(v3_cross(v3_sub(p[t[1]], p[t[0]]), v3_sub(p[t[2]], p[t[0]])), 0.5f);
}

/** The areas' sum is the polygon's only if no triangle lies outside or overlaps another; and each must face `n`. */
static void assert_covers(const Vec3 p[], uint32_t count, Vec3 n, float area)
{
    uint32_t(*t)[3] = calloc(count, sizeof *t);
    assert_non_null(t);
    assert_true(sheen_polygon_cut(p, count, t));
    double sum = 0.0;
    for (uint32_t i = 0; i + 2 < count; ++i) {
        for (int j = 0; j < 3; ++j) assert_true(t[i][j] < count);
        float a = v3_dot(area_of(p, t[i]), n);
        assert_true(a > -1e-5f * area); // rounding of the test's own sum
        sum += (double)a;
    }
    free(t);
    if (!(fabs(sum - (double)area) < 1e-4 * (double)area))
        fail_msg("%u corners: %g is not %g", count, sum, (double)area);
}

static void convex_polygons_become_fans(void **state)
{
    (void)state;
    const Vec3 p[5] = {{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {0, 2, 0}};
    uint32_t t[3][3];
    const uint32_t want[3][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
    assert_true(sheen_polygon_cut(p, 5, t));
    assert_memory_equal(t, want, sizeof want);
}

/** An arrow, each corner as the first, either way round, in all three planes. */
static void quads_with_an_inward_corner(void **state)
{
    (void)state;
    const float arrow[4][2] = {{0, 0}, {2, -1}, {0, 3}, {-2, -1}};
    for (int axis = 0; axis < 3; ++axis)
        for (int first = 0; first < 4; ++first)
            for (int back = 0; back < 2; ++back) {
                Vec3 p[4], n = v3(axis == 0, axis == 1, axis == 2);
                for (int i = 0; i < 4; ++i) {
                    const float *c = arrow[(first + (back ? 4 - i : i)) % 4];
                    p[i] = axis == 0 ? v3(7, c[0], c[1]) : axis == 1 ? v3(c[1], 7, c[0]) : v3(c[0], c[1], 7);
                }
                assert_covers(p, 4, back ? v3_neg(n) : n, 6.0f);
            }
}

/** Stars and combs of many corners, in a slanted plane. */
static void polygons_with_many_inward_corners(void **state)
{
    (void)state;
    enum { N = 600 };
    static Vec3 p[N];
    Vec3 n = v3_normalize(v3(1, 2, 3)), u = v3_normalize(v3_cross(n, v3(0, 0, 1))), v = v3_cross(n, u);
    float area = 0.0f;
    for (int i = 0; i < N; ++i) {
        float angle = 2.0f * SHEEN_PI * (float)i / N, radius = i % 2 ? 1.0f : 3.0f;
        p[i] = v3_add(v3_scale(u, radius * cosf(angle)), v3_scale(v, radius * sinf(angle)));
        area += 0.5f * 1.0f * 3.0f * sinf(2.0f * SHEEN_PI / N);
    }
    assert_covers(p, N, n, area);
    for (int i = 0; i < N / 2; ++i) { // teeth of height 1 on a back of height 1, and the way back along the ground
        p[i] = v3_add(v3_scale(u, (float)i), v3_scale(v, i % 2 ? 2.0f : 1.0f));
        p[N - 1 - i] = v3_scale(u, (float)i);
    }
    assert_covers(p, N, v3_neg(n), (float)(N / 2 - 1) * 1.5f);
}

/** A square with a square hole, tied to the outline by an edge that is walked twice. */
static void holes_tied_to_the_outline(void **state)
{
    (void)state;
    const Vec3 p[10] = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                        {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
    assert_covers(p, 10, v3(0, 0, 1), 12.0f);
}

/** Whatever the corners are, there are n - 2 triangles with indices in range, soon. */
static void nonsense_does_no_harm(void **state)
{
    (void)state;
    enum { N = 5000 };
    static Vec3 p[N];
    static uint32_t t[N][3];
    uint32_t seed = 1;
    for (int kind = 0; kind < 4; ++kind)
        for (uint32_t n = 3; n <= N; n = n * 3 / 2 + 1) {
            for (uint32_t i = 0; i < n; ++i) {
                seed = seed * 1664525u + 1013904223u;
                float x = (float)(seed >> 8) * 0x1p-24f, y = (float)(seed & 0xffff) * 0x1p-16f;
                p[i] = kind == 0   ? v3(x, y, 0)
                       : kind == 1 ? v3(x, x, x)
                       : kind == 2 ? v3(NAN, INFINITY, x)
                                   : v3(0, 0, 0);
                if (kind == 2 && i % 3) p[i] = v3(x * 1e38f, y * -1e38f, 1e38f);
            }
            memset(t, 0xff, sizeof t);
            assert_true(sheen_polygon_cut(p, n, t));
            for (uint32_t i = 0; i + 2 < n; ++i)
                for (int j = 0; j < 3; ++j) assert_true(t[i][j] < n);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(convex_polygons_become_fans),
        cmocka_unit_test(quads_with_an_inward_corner),
        cmocka_unit_test(polygons_with_many_inward_corners),
        cmocka_unit_test(holes_tied_to_the_outline),
        cmocka_unit_test(nonsense_does_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
