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

static void test_gap(void **state)
{
    (void)state;
    SheenRenderSettings settings = robust_settings(128, 128);
    Stage shut = two_rooms(0.0f, 20.0f);
    const float gaps[] = {1e-4f, 1e-3f, 1e-2f};
    for (int i = 0; i < 3; ++i) {
        Stage open = two_rooms(gaps[i], 20.0f);
        for (int clamping = 1; clamping >= 0; --clamping) {
            settings.options.neighbor_clamping = clamping;
            SheenStats stats;
            SheenFilm *a = stage_render(&open, &settings, &stats), *b = stage_render(&shut, &settings, NULL);
            show("gap %g, clamping %d: %.2f %% of pixels off, %u records\n", (double)gaps[i], clamping,
                 100 * share_off(a, b), (unsigned)stats.records);
            robust_write(a, clamping ? "gap-clamped" : "gap-free", i == 0 ? "tenth" : i == 1 ? "mm" : "cm");
            robust_write(b, clamping ? "gap-clamped" : "gap-free", "shut");
            sheen_film_destroy(&a);
            sheen_film_destroy(&b);
        }
        if (getenv("SHEEN_SPP")) robust_measure(&open, &settings, 64, "gap-open");
        stage_free(&open);
    }
    stage_free(&shut);
}

/** The inside of a closed box with a wall of some thickness, lit on one side of it alone. */
static Stage thin_wall(float thickness, bool seen_lit)
{
    SheenBuilder *b = kit_begin();
    uint32_t paint = kit_diffuse(b, 0.7f);
    box(b, v3(-2, -1, 0), v3(2, 1, 2), 0, paint);
    uint32_t m = two_sided(b, paint);
    rectangle(b, v3(0, -1, 0), v3(0, 2, 0), v3(0, 0, 2), v3(-1, 0, 1), m);
    if (thickness > 0) rectangle(b, v3(thickness, -1, 0), v3(0, 2, 0), v3(0, 0, 2), v3(1, 0, 1), m);
    lamp(b, v3(1, 0, 1.6f), 0.4f, 100.0f);
    lamp(b, v3(-1, 0, 1.6f), 0.4f, 1e-3f);
    kit_camera(b, v3(seen_lit ? 1.9f : -1.9f, 0, 1.0f), v3(0, 0, 0.4f), v3(0, 0, 1), 1.0f);
    return stage_end(b, 2);
}

static void test_thin_walls(void **state)
{
    (void)state;
    const float thickness[] = {0.0f, 1e-5f, 1e-3f, 1e-2f};
    SheenRenderSettings settings = robust_settings(64, 64);
    for (int i = 0; i < 4; ++i) {
        Stage stage = thin_wall(thickness[i], false);
        char name[64];
        snprintf(name, sizeof name, "thin-%g", (double)thickness[i]);
        robust_measure(&stage, &settings, 64, name);
        stage_free(&stage);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_gap), cmocka_unit_test(test_thin_walls)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
