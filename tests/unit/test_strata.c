// SPDX-License-Identifier: Apache-2.0
// The directions of all strata at once: those of one cell at a time, each in its own cell.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/hash.h"
#include "gather/strata.h"

static double angle_about_z(Vec3 d) // [0, 2 pi)
{
    double phi = atan2((double)d.y, (double)d.x);
    return phi < 0 ? phi + 2 * M_PI : phi;
}

static void check_strata(SheenStrata s, uint32_t key, Vec3 *out)
{
    sheen_strata_directions(s, key, out);
    for (unsigned k = 0, i = 0; k < s.sectors; ++k)
        for (unsigned j = 0; j < s.rings; ++j, ++i) {
            uint32_t hash = hash_combine(key, i);
            Vec2 u = v2(hash_to_unit(hash), hash_to_unit(hash_u32(hash ^ 0x5bd1e995u)));
            Vec3 d = sheen_strata_direction(s, j, k, u);
            // sinf and cosf of angles up to 2 pi, whose own rounding is 2.4e-7, and the square root at the horizon.
            assert_true(fabsf(out[i].x - d.x) < 1e-6f && fabsf(out[i].y - d.y) < 1e-6f);
            assert_true(fabsf(out[i].z * out[i].z - d.z * d.z) < 1e-6f);
            assert_true(fabsf(v3_length(out[i]) - 1.0f) < 1e-6f);
            double ring = s.rings * ((double)out[i].x * (double)out[i].x + (double)out[i].y * (double)out[i].y);
            double sector = s.sectors * angle_about_z(out[i]) / (2 * M_PI);
            assert_true(ring > j - 1e-3 && ring < j + 1 + 1e-3);
            assert_true(fabs(sector - (k + 0.5)) < 0.5 + 1e-3 || ring < 1e-3);
        }
}

static void test_directions(void **state)
{
    (void)state;
    static const SheenStrata strata[] = {{1, 3}, {1, 4}, {5, 3}, {7, 22}, {18, 57}, {512, 7}};
    Vec3 *out = malloc(512 * 57 * sizeof *out);
    assert_non_null(out);
    for (size_t i = 0; i < sizeof strata / sizeof *strata; ++i)
        for (uint32_t key = 0; key < 40; ++key) check_strata(strata[i], hash_u32(key), out);
    free(out);
}

// Rays by number of cells: near square cells, and bounds on both counts.
static void test_counts(void **state)
{
    (void)state;
    for (unsigned n = 0; n < 3000; ++n) {
        SheenStrata s = sheen_strata_cosine(n);
        assert_true(s.rings >= 1 && s.sectors >= 3 && s.rings <= SHEEN_RINGS_MAX);
        if (n > 20) assert_true(fabs((double)strata_count(s) - n) <= 0.5 * s.rings + 1e-9);
        if (n > 200) assert_true(fabs((double)s.sectors / s.rings / M_PI - 1) < 0.15);
    }
    assert_int_equal(sheen_strata_cosine(UINT32_MAX).rings, SHEEN_RINGS_MAX);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_directions), cmocka_unit_test(test_counts)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
