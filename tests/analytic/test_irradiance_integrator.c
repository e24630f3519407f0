// SPDX-License-Identifier: Apache-2.0
// The irradiance integrator where the answer is known: furnaces, a constant sky, no light, walls that must not leak.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "analytic/irradiance_kit.h"

// In a closed body of albedo rho that emits E all over, light of k scatterings is E rho^k, and B bounces allow B + 1.
static void furnace(float rho, uint32_t bounces, SheenSecondary secondary)
{
    SheenBuilder *b = kit_begin();
    uint32_t material = kit_diffuse(b, rho);
    kit_box(b, material, 1.0f);
    sheen_builder_add_area_light(b, kit_sphere(b, v3(0.5f, 0.4f, -0.6f), 0.4f, false, material), rgb_gray(1.0f));
    kit_camera(b, v3(-0.7f, -0.6f, 0.3f), v3(1, 1, -0.6f), v3(0, 0, 1), 1.4f);
    Stage stage = stage_end(b, 2);
    SheenRenderSettings s = small_settings(bounces);
    s.options.secondary = secondary;
    s.options.gather_rays = 512;
    double expected = 0.0, power = 1.0;
    for (uint32_t k = 0; k <= bounces + 1; ++k, power *= (double)rho) expected += power;
    SheenFilm *film = stage_render(&stage, &s, NULL);
    double mean = film_mean(film), worst = 0.0;
    for (uint32_t y = 0; y < 32; y += 8)
        for (uint32_t x = 0; x < 32; x += 8)
            worst = fmax(worst, fabs(film_mean_of(film, x, y, x + 8, y + 8) / expected - 1.0));
    show("furnace %g, %u bounces, %d: mean off by %.2g, worst block %.2g\n", (double)rho, bounces, secondary,
         mean / expected - 1.0, worst);
    // The light sample of a box's pixel deviates by a third; 4,096 of them make 0.5 %, and 256 of a block 2 %; that of
    // a gather's ray too, which makes 1.5 % of a record, of which there are dozens. Deep light that is lost anywhere
    // adds up over the bounces.
    assert_true(fabs(mean / expected - 1.0) < 0.005);
    assert_true(worst < 0.04);
    sheen_film_destroy(&film);
    stage_free(&stage);
}

static void test_furnace(void **state)
{
    (void)state;
    static const uint32_t bounces[5] = {0, 1, 2, 3, 8};
    for (int i = 0; i < 5; ++i) {
        furnace(0.5f, bounces[i], SHEEN_SECONDARY_CACHE);
        furnace(0.8f, bounces[i], SHEEN_SECONDARY_CACHE);
        if (i < 4) furnace(0.5f, bounces[i], SHEEN_SECONDARY_PATH);
    }
}

// Under a sky of radiance L a convex body of albedo rho has radiance rho L everywhere.
static void convex(uint32_t bounces, int body, float slack, const char *what)
{
    SheenBuilder *b = kit_begin();
    uint32_t material = kit_diffuse(b, 0.6f);
    kit_constant_environment(b, rgb(0.5f, 2.0f, 1.0f));
    if (body == 0) kit_quad(b, v3(-50, -50, -1), v3(100, 0, 0), v3(0, 100, 0), material);
    if (body == 1) kit_sphere(b, v3(0, 4, 0), 3.0f, false, material);
    if (body == 2) kit_smooth_sphere(b, v3(0, 4, 0), 3.0f, 12, material);
    kit_camera(b, v3(0, 0, 0), v3(0, 1, body ? 0.0f : -0.9f), v3(0, 0, 1), 0.9f);
    Stage stage = stage_end(b, 2);
    SheenRenderSettings s = small_settings(bounces);
    SheenStats stats;
    SheenFilm *film = stage_render(&stage, &s, &stats);
    float worst = 0.0f;
    for (size_t i = 0; i < 32 * 32; ++i) {
        Rgb c = film->color[i];
        worst = fmaxf(worst, fabsf(c.r / 0.3f - 1.0f));
        worst = fmaxf(worst, fabsf(c.g / 1.2f - 1.0f));
        worst = fmaxf(worst, fabsf(c.b / 0.6f - 1.0f));
    }
    show("%s, %u bounces: worst pixel %.2g\n", what, bounces, (double)worst);
    assert_true(worst < slack);
    assert_true(stats.records > 0);
    assert_int_equal(stats.rays_shadow, 0); // nothing in this sky is hard
    sheen_film_destroy(&film);
    stage_free(&stage);
}

static void test_constant_sky(void **state)
{
    (void)state;
    for (uint32_t bounces = 0; bounces <= 8; bounces += 8) {
        convex(bounces, 0, 1e-4f, "plane");
        convex(bounces, 1, 0.02f, "sphere");
        // Where the shading normal leans out of its facet by t, that facet hides (1 - cos t) / 2 of the sky: 3 % at the
        // corners of this mesh, where t is 21 degrees.
        convex(bounces, 2, 0.034f, "smooth mesh");
    }
}

static void test_no_light(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    kit_box(b, kit_diffuse(b, 0.8f), 0.0f);
    kit_camera(b, v3(0, 0, 0), v3(1, 0, 0), v3(0, 0, 1), 1.0f);
    Stage stage = stage_end(b, 2);
    for (uint32_t bounces = 0; bounces <= 3; bounces += 3) {
        SheenRenderSettings s = small_settings(bounces);
        SheenFilm *film = stage_render(&stage, &s, NULL);
        for (size_t i = 0; i < 32 * 32; ++i) assert_true(rgb_is_black(film->color[i]));
        sheen_film_destroy(&film);
    }
    stage_free(&stage);
}

static void test_nothing_to_see(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    kit_sphere(b, v3(0, -5, 0), 1.0f, false, kit_diffuse(b, 0.5f)); // behind the camera
    kit_constant_environment(b, rgb_gray(0.25f));
    kit_camera(b, v3(0, 0, 0), v3(0, 1, 0), v3(0, 0, 1), 1.0f);
    Stage stage = stage_end(b, 2);
    SheenRenderSettings s = small_settings(8);
    SheenStats stats;
    SheenFilm *film = stage_render(&stage, &s, &stats);
    for (size_t i = 0; i < 32 * 32; ++i) assert_true(film->color[i].g == 0.25f);
    assert_int_equal(stats.records, 0);
    sheen_film_destroy(&film);
    stage_free(&stage);
}

// Two rooms side by side, a wall of 1 mm between them, a lamp in the left one; both open toward the camera, beyond
// which there is nothing. No light reaches the right room in any number of bounces.
static void test_no_leak_through_a_thin_wall(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    uint32_t white = kit_diffuse(b, 0.8f);
    const float w = 0.0005f;
    for (int side = 0; side < 2; ++side) {
        float x0 = side ? w : -1.0f, x1 = side ? 1.0f : -w, dx = x1 - x0;
        kit_quad(b, v3(x0, -1, -0.5f), v3(dx, 0, 0), v3(0, 2, 0), white); // floor
        kit_quad(b, v3(x0, -1, 0.5f), v3(0, 2, 0), v3(dx, 0, 0), white);  // ceiling
        kit_quad(b, v3(x0, 1, -0.5f), v3(dx, 0, 0), v3(0, 0, 1), white);  // back, seen from -y
        kit_quad(b, v3(x0, -1, -0.5f), v3(0, 2, 0), v3(0, 0, 1), white);  // left wall
        kit_quad(b, v3(x1, -1, -0.5f), v3(0, 0, 1), v3(0, 2, 0), white);  // right wall
    }
    uint32_t lamp = kit_quad(b, v3(-0.7f, 0, 0.49f), v3(0, 0.4f, 0), v3(0.4f, 0, 0), kit_diffuse(b, 0.0f));
    sheen_builder_add_area_light(b, lamp, rgb_gray(5.0f));
    kit_camera(b, v3(0, -3, 0), v3(0, 0, 0), v3(0, 0, 1), 2.0f * atanf(0.5f));
    Stage stage = stage_end(b, 2);
    static const SheenSecondary secondary[2] = {SHEEN_SECONDARY_CACHE, SHEEN_SECONDARY_PATH};
    for (int i = 0; i < 2; ++i) {
        SheenRenderSettings s = small_settings(3);
        s.width = 64;
        s.options.secondary = secondary[i];
        SheenFilm *film = stage_render(&stage, &s, NULL);
        // A record serves four pixels at least, so up to here light shines on beside the wall. Farther away there is
        // what the dark room's gathers see of that, and of deep records' light that reaches as far.
        enum { BESIDE = 4 };
        double lit = film_mean_of(film, 0, 0, 32, 32), dark = film_mean_of(film, 32 + BESIDE, 0, 64, 32), worst = 0.0;
        for (uint32_t y = 0; y < 32; ++y)
            for (uint32_t x = 32 + BESIDE; x < 64; ++x)
                worst = fmax(worst, (double)rgb_luminance(film->color[64 * y + x]));
        show("leak: lit %.3g, dark %.2g of it, worst pixel %.2g of it\n", lit, dark / lit, worst / lit);
        assert_true(lit > 0.1);
        assert_true(dark <= 0.005 * lit);
        assert_true(worst <= 0.03 * lit);
        sheen_film_destroy(&film);
    }
    stage_free(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_furnace),
        cmocka_unit_test(test_constant_sky),
        cmocka_unit_test(test_no_light),
        cmocka_unit_test(test_nothing_to_see),
        cmocka_unit_test(test_no_leak_through_a_thin_wall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
