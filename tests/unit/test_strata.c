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
            assert_true(fabsf(v3_length(out[i]) - 1.0f) < 1e-6f && out[i].z >= 0.0f);
            double sin2 = (double)out[i].x * (double)out[i].x + (double)out[i].y * (double)out[i].y;
            double ring = s.rings * (s.density == SHEEN_DENSITY_UNIFORM ? 1.0 - (double)out[i].z : sin2);
            double sector = s.sectors * angle_about_z(out[i]) / (2 * M_PI);
            assert_true(ring > j - 1e-3 && ring < j + 1 + 1e-3);
            assert_true(fabs(sector - (k + 0.5)) < 0.5 + 1e-3 || ring < 1e-3);
        }
}

static void test_directions(void **state)
{
    (void)state;
    static const unsigned counts[][2] = {{1, 3}, {1, 4}, {5, 3}, {7, 22}, {18, 57}, {512, 7}};
    Vec3 *out = malloc(512 * 57 * sizeof *out);
    assert_non_null(out);
    for (size_t i = 0; i < sizeof counts / sizeof *counts; ++i)
        for (uint32_t key = 0; key < 40; ++key) {
            check_strata((SheenStrata){counts[i][0], counts[i][1], SHEEN_DENSITY_COSINE}, hash_u32(key), out);
            check_strata((SheenStrata){counts[i][0], counts[i][1], SHEEN_DENSITY_UNIFORM}, hash_u32(key), out);
        }
    free(out);
}

// Rays by number of cells: near square cells, and bounds on both counts.
static void check_counts(SheenStrata make(unsigned), double sectors_per_ring)
{
    for (unsigned n = 0; n < 3000; ++n) {
        SheenStrata s = make(n);
        assert_true(s.rings >= 1 && s.sectors >= 3 && s.rings <= SHEEN_RINGS_MAX);
        if (n > 20) assert_true(fabs((double)strata_count(s) - n) <= 0.5 * s.rings + 1e-9);
        if (n > 200) assert_true(fabs((double)s.sectors / s.rings / sectors_per_ring - 1) < 0.15);
    }
    assert_int_equal(make(UINT32_MAX).rings, SHEEN_RINGS_MAX);
}

static void test_counts(void **state)
{
    (void)state;
    check_counts(sheen_strata_cosine, M_PI);
    check_counts(sheen_strata_uniform, 4.0);
    SheenStrata s = sheen_strata_uniform(1024);
    assert_true(s.rings == 16 && s.sectors == 64 && s.density == SHEEN_DENSITY_UNIFORM);
}

// The mean of 1 / pdf over the samples is the solid angle of the hemisphere, and each cell has the same share of them.
static void test_density(void **state)
{
    (void)state;
    enum { RAYS = 4096 };
    static Vec3 d[2 * RAYS];
    SheenStrata both[] = {sheen_strata_cosine(RAYS), sheen_strata_uniform(RAYS)};
    for (int i = 0; i < 2; ++i) {
        unsigned n = strata_count(both[i]);
        double sum = 0.0, projected = 0.0;
        sheen_strata_directions(both[i], 7, d);
        for (unsigned c = 0; c < n; ++c) {
            sum += 1.0 / (double)strata_pdf(both[i], d[c].z) / n;
            projected += (double)(d[c].z / strata_pdf(both[i], d[c].z)) / n;
        }
        // Uniform samples give 2 pi exactly and pi to a few 1e-5; cosine-weighted ones pi exactly, and 2 pi as well as
        // the ring at the horizon has it, which is 1 / 36 of 2 pi with a variance that is not bounded.
        assert_true(fabs(sum / (2 * M_PI) - 1.0) < (i ? 1e-6 : 0.05));
        assert_true(fabs(projected / M_PI - 1.0) < (i ? 1e-3 : 1e-6));
    }
}

// Each sample lies in its own cell; but one on a cell's edge may fall into the next by rounding.
static void test_cells(void **state)
{
    (void)state;
    static Vec3 d[2048];
    SheenStrata both[] = {sheen_strata_cosine(1024), sheen_strata_uniform(1024)};
    for (int i = 0; i < 2; ++i) {
        unsigned n = strata_count(both[i]), off = 0;
        sheen_strata_directions(both[i], 11, d);
        for (unsigned c = 0; c < n; ++c) off += sheen_strata_cell(both[i], d[c]) != c;
        assert_in_range(off, 0, 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_directions), cmocka_unit_test(test_counts),
                                       cmocka_unit_test(test_density), cmocka_unit_test(test_cells)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
