// SPDX-License-Identifier: Apache-2.0
// Light must not pass walls: under a wall that ends a millimetre above the floor, and through thin ones lit on one
// side.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "analytic/robust_kit.h"

/** An axis-aligned rectangle about a corner, with its front toward `inside`. */
static uint32_t rectangle(SheenBuilder *b, Vec3 p, Vec3 e1, Vec3 e2, Vec3 inside, uint32_t material)
{
    Vec3 center = v3_mad(v3_mad(p, 0.5f, e1), 0.5f, e2);
    bool flip = v3_dot(v3_cross(e1, e2), v3_sub(inside, center)) < 0.0f;
    return flip ? kit_quad(b, p, e2, e1, material) : kit_quad(b, p, e1, e2, material);
}

/** The inner walls of a box but for the one at its largest (`open` 1) or least (-1) x. */
static void box(SheenBuilder *b, Vec3 lo, Vec3 hi, int open, uint32_t material)
{
    Vec3 c = v3_scale(v3_add(lo, hi), 0.5f), d = v3_sub(hi, lo);
    Vec3 x = v3(d.x, 0, 0), y = v3(0, d.y, 0), z = v3(0, 0, d.z);
    rectangle(b, lo, x, y, c, material);
    rectangle(b, v3_add(lo, z), x, y, c, material);
    rectangle(b, lo, x, z, c, material);
    rectangle(b, v3_add(lo, y), x, z, c, material);
    if (open >= 0) rectangle(b, lo, y, z, c, material);
    if (open <= 0) rectangle(b, v3_add(lo, x), y, z, c, material);
}

static void lamp(SheenBuilder *b, Vec3 center, float side, float radiance)
{
    uint32_t s = kit_quad(b, v3_sub(center, v3(0.5f * side, 0.5f * side, 0)), v3(0, side, 0), v3(side, 0, 0),
                          kit_diffuse(b, 0.0f));
    sheen_builder_add_area_light(b, s, rgb_gray(radiance));
}

static uint32_t two_sided(SheenBuilder *b, uint32_t material)
{
    SheenMaterial m = *sheen_builder_material(b, material);
    m.two_sided = true;
    m.name = "two-sided";
    return sheen_builder_add_material(b, &m);
}

/** A dim room (x < 0) and a bright one on one floor; the wall between them, a sheet, ends `gap` above it. */
static Stage two_rooms(float gap, float bright)
{
    SheenBuilder *b = kit_begin();
    uint32_t paint = kit_diffuse(b, 0.6f);
    box(b, v3(-2, -1, 0), v3(2, 1, 2), 0, paint);
    rectangle(b, v3(0, -1, gap), v3(0, 2, 0), v3(0, 0, 2 - gap), v3(-1, 0, 1), two_sided(b, paint));
    lamp(b, v3(-1, 0, 1.6f), 0.4f, 1.0f);
    lamp(b, v3(1, 0, 1.6f), 0.4f, bright);
    kit_camera(b, v3(-1.9f, 0, 1.0f), v3(0, 0, 0.4f), v3(0, 0, 1), 1.0f);
    return stage_end(b, 2);
}

/** The share of pixels that differ by more than a tenth, but for the rows on which the gap itself is seen. */
static double share_off(const SheenFilm *a, const SheenFilm *b)
{
    // The camera looks down by atan(0.6 / 1.9), and at the wall's foot by atan(1 / 1.9); 1 rad is the picture's width.
    double below = tan(atan(1.0 / 1.9) - atan(0.6 / 1.9)) / (2.0 * tan(0.5)), row = (0.5 + below) * a->height;
    size_t off = 0, n = 0;
    for (uint32_t y = 0; y < a->height; ++y) {
        if (fabs(y + 0.5 - row) <= 1.0) continue;
        for (uint32_t x = 0; x < a->width; ++x, ++n) {
            double u = (double)rgb_luminance(a->color[y * a->width + x]);
            double v = (double)rgb_luminance(b->color[y * a->width + x]);
            if (fabs(u - v) > 0.1 * v) ++off;
        }
    }
    return (double)off / (double)n;
}

static double gap_share_off(const Stage *open, const Stage *shut, bool clamping, const char *name)
{
    SheenRenderSettings settings = robust_settings(128, 128);
    settings.options.neighbor_clamping = clamping;
    SheenStats stats;
    SheenFilm *a = stage_render(open, &settings, &stats), *b = stage_render(shut, &settings, NULL);
    double off = share_off(a, b);
    show("%s: %.2f %% of pixels off, %u records\n", name, 100 * off, (unsigned)stats.records);
    robust_write(a, name, "open");
    robust_write(b, name, "shut");
    sheen_film_destroy(&a);
    sheen_film_destroy(&b);
    return off;
}

// The light that comes through a gap of a millimetre is 2 % of what the dim room has: the rooms with and without it
// look the same but for the gap itself, in all but 0.07 % of the pixels. Where deep records serve what lies behind a
// wall it is 1.3 %; the picture's records do not reach so far, with clamping or without.
static void test_gap(void **state)
{
    (void)state;
    Stage shut = two_rooms(0.0f, 20.0f), open = two_rooms(1e-3f, 20.0f), crack = two_rooms(1e-4f, 20.0f);
    assert_true(gap_share_off(&open, &shut, true, "gap") < 0.005);
    assert_true(gap_share_off(&open, &shut, false, "gap-without-clamping") < 0.005);
    assert_true(gap_share_off(&crack, &shut, true, "crack") < 0.005);
    if (getenv("SHEEN_SPP")) {
        SheenRenderSettings settings = robust_settings(128, 128);
        robust_measure(&open, &settings, 0, "gap");
    }
    stage_free(&shut);
    stage_free(&open);
    stage_free(&crack);
}

// A lamp that is hidden behind a wall, a hundred thousand times as strong as the one that is seen. Hits of gathers ask
// both: a choice by what they would send without the wall left a quarter of the light out, and blocks off by 2.7.
static void test_hidden_lamp(void **state)
{
    (void)state;
    Stage strong = two_rooms(0.0f, 1e5f), weak = two_rooms(0.0f, 1.0f);
    SheenRenderSettings settings = robust_settings(64, 64);
    SheenFilm *a = stage_render(&strong, &settings, NULL), *b = stage_render(&weak, &settings, NULL);
    Robustness r;
    robust_compare(a, b, &r);
    show("hidden lamp: mean %+.2g, worst block %.2g\n", r.mean, r.worst);
    assert_true(fabs(r.mean) < 0.005 && r.worst < 0.02); // all but the same
    sheen_film_destroy(&a);
    sheen_film_destroy(&b);
    stage_free(&strong);
    stage_free(&weak);
}

/** A box with a lamp behind a wall with a doorway, seen from the side that is lit through it alone. */
static Stage doorway(float thickness)
{
    SheenBuilder *b = kit_begin();
    uint32_t paint = kit_diffuse(b, 0.7f);
    box(b, v3(-2, -1, 0), v3(2, 1, 2), 0, paint);
    uint32_t wall = two_sided(b, paint);
    rectangle(b, v3(0, -1, 0), v3(0, 1.2f, 0), v3(0, 0, 2), v3(-1, 0, 1), wall);
    if (thickness > 0) {
        rectangle(b, v3(thickness, -1, 0), v3(0, 1.2f, 0), v3(0, 0, 2), v3(1, 0, 1), wall);
        rectangle(b, v3(0, 0.2f, 0), v3(thickness, 0, 0), v3(0, 0, 2), v3(0, 1, 1), wall);
    }
    lamp(b, v3(1.4f, -0.5f, 1.6f), 0.4f, 50.0f);
    kit_camera(b, v3(-1.9f, 0.1f, 1.2f), v3(0, -0.4f, 0.5f), v3(0, 0, 1), 1.2f);
    return stage_end(b, 2);
}

static void test_thin_walls(void **state)
{
    (void)state;
    const float thickness[] = {0.0f, 1e-2f};
    SheenRenderSettings settings = robust_settings(64, 64);
    for (int i = 0; i < 2; ++i) {
        Stage stage = doorway(thickness[i]);
        Robustness r = robust_measure(&stage, &settings, 96, i ? "thin-wall" : "sheet");
        // 1.4 and 3.1 % against 1024 paths; a block of 96 has noise of 3.7 %.
        assert_true(fabs(r.mean) < 0.03 && r.rms < 0.06);
        stage_free(&stage);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_gap), cmocka_unit_test(test_hidden_lamp),
                                       cmocka_unit_test(test_thin_walls)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
