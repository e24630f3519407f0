// SPDX-License-Identifier: Apache-2.0
// Light behind and through masks, in both integrators.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "analytic/irradiance_kit.h"

static uint32_t add_mask(SheenBuilder *b, SheenTexture opacity, float albedo)
{
    SheenMaterial below = {.kind = SHEEN_MATERIAL_DIFFUSE,
                           .reflectance = sheen_texture_constant(rgb_gray(albedo)),
                           .two_sided = true,
                           .name = "leaf"};
    SheenMaterial m = {.kind = SHEEN_MATERIAL_MASK, .weight = opacity, .name = "mask"};
    m.nested[0] = sheen_builder_add_material(b, &below);
    return sheen_builder_add_material(b, &m);
}

static uint32_t gray_mask(SheenBuilder *b, float opacity, float albedo)
{
    return add_mask(b, sheen_texture_constant(rgb_gray(opacity)), albedo);
}

/** A field of side 2 / fields in opacities 1 and 0 by turns over a sheet. */
static SheenTexture checkerboard(float fields)
{
    SheenTexture t = sheen_texture_constant(rgb_gray(1.0f));
    t.kind = SHEEN_TEXTURE_CHECKERBOARD;
    t.value2 = rgb_gray(0.0f);
    t.uv[0][0] = t.uv[1][1] = 0.5f * fields;
    return t;
}

/** The square [-1, 1]^2 at height z. */
static uint32_t sheet(SheenBuilder *b, float z, uint32_t material)
{
    return kit_quad(b, v3(-1, -1, z), v3(2, 0, 0), v3(0, 2, 0), material);
}

/** A white floor under a point light at height 2, seen from below height 1: pixel (i, j) shows a square of side 1/16.
 */
static SheenBuilder *lit_floor(void)
{
    SheenBuilder *b = kit_begin();
    sheet(b, 0.0f, kit_diffuse(b, 0.8f));
    SheenLight light = {.kind = SHEEN_LIGHT_POINT, .radiance = rgb(5, 4, 3), .shape = SHEEN_NONE};
    light.position = v3(0, 0, 2);
    sheen_builder_add_light(b, &light);
    kit_camera(b, v3(0, 0, 0.5f), v3(0, 0, 0), v3(0, 1, 0), 2.0f * atanf(2.0f));
    return b;
}

static SheenRenderSettings direct_settings(SheenIntegrator integrator)
{
    SheenRenderSettings s = small_settings(0);
    s.integrator = integrator;
    s.options.spp = 4;
    return s;
}

// With the same seed both pictures ask the lamp from the same points: they differ by the factor and nothing else.
static void test_a_point_light_behind_sheets(void **state)
{
    (void)state;
    for (int integrator = 0; integrator < 2; ++integrator) {
        SheenRenderSettings s = direct_settings(integrator ? SHEEN_INTEGRATOR_PATH : SHEEN_INTEGRATOR_IRRADIANCE);
        SheenFilm *open = stage_picture(lit_floor(), &s);
        // Irradiance I h / d^3 times albedo / pi in the middle, where it changes least.
        double middle = film_mean_of(open, 15, 15, 17, 17), I = (double)rgb_luminance(rgb(5, 4, 3));
        assert_true(fabs(middle / (0.8 * I / 4.0 / (double)SHEEN_PI) - 1.0) < 3e-3); // 1.5 r^2 / h^2, r < 0.09
        for (int sheets = 1; sheets <= 2; ++sheets) {
            SheenBuilder *b = lit_floor();
            sheet(b, 1.0f, gray_mask(b, 0.3f, 0.0f));
            if (sheets == 2) sheet(b, 1.5f, gray_mask(b, 0.5f, 0.0f));
            SheenFilm *film = stage_picture(b, &s);
            for (size_t i = 0; i < 32 * 32; ++i) {
                float want = open->color[i].g * (sheets == 2 ? 0.35f : 0.7f);
                assert_true(want > 0.0f && fabsf(film->color[i].g - want) <= 1e-6f * want); // rounding of sums of 4
            }
            sheen_film_destroy(&film);
        }
        sheen_film_destroy(&open);
    }
}

// The shadow of the board's fields, twice as large on the floor, is there exactly or not at all.
static void test_the_shadow_of_a_checkerboard(void **state)
{
    (void)state;
    for (int integrator = 0; integrator < 2; ++integrator) {
        SheenRenderSettings s = direct_settings(integrator ? SHEEN_INTEGRATOR_PATH : SHEEN_INTEGRATOR_IRRADIANCE);
        SheenFilm *open = stage_picture(lit_floor(), &s);
        SheenBuilder *b = lit_floor();
        sheet(b, 1.0f, add_mask(b, checkerboard(8.0f), 0.0f)); // fields of 1/4, on the floor 1/2: 8 pixels
        SheenFilm *film = stage_picture(b, &s);
        unsigned dark = 0, lit = 0;
        for (uint32_t y = 0; y < 32; ++y)
            for (uint32_t x = 0; x < 32; ++x) {
                if (x % 8 == 0 || x % 8 == 7 || y % 8 == 0 || y % 8 == 7) continue; // an edge may lie in it
                float got = film->color[32 * y + x].g, want = open->color[32 * y + x].g;
                bool opaque = (x / 8 % 2 == 0) != (y / 8 % 2 == 0); // rows run downward: so it is at the lower left
                assert_true(got == (opaque ? 0.0f : want));
                ++*(opaque ? &dark : &lit);
            }
        assert_true(dark == lit && dark == 8 * 36);
        sheen_film_destroy(&film);
        sheen_film_destroy(&open);
    }
}

/** A patch of a floor of albedo 0.5 seen from inside a dome of opacity 0.4. */
static SheenBuilder *under_a_dome(void)
{
    SheenBuilder *b = kit_begin();
    sheet(b, 0.0f, kit_diffuse(b, 0.5f));
    kit_sphere(b, v3(0, 0, 0), 3.0f, true, gray_mask(b, 0.4f, 0.0f));
    kit_camera(b, v3(0.3f, 0.2f, 0.9f), v3(0, 0, 0), v3(0, 1, 0), 0.2f);
    return b;
}

// Under a black dome that lets 0.6 pass, the floor's radiance is 0.5 * 0.6 * the sky's, however it is found.
static void test_an_environment_behind_a_dome(void **state)
{
    (void)state;
    for (int integrator = 0; integrator < 2; ++integrator) {
        SheenBuilder *b = under_a_dome();
        kit_constant_environment(b, rgb_gray(2.0f));
        SheenRenderSettings s = small_settings(2);
        s.integrator = integrator ? SHEEN_INTEGRATOR_PATH : SHEEN_INTEGRATOR_IRRADIANCE;
        s.options.spp = integrator ? 64 : 4;
        SheenFilm *film = stage_picture(b, &s);
        // The gathers of a cached picture are few; each stops some of its rays by chance.
        if (integrator)
            kit_assert_mean(film, 0.6, 1e-5, 5e-3, "dome");
        else
            assert_true(fabs(film_mean(film) - 0.6) < 0.02 * 0.6);
        sheen_film_destroy(&film);
    }
}

// Paths through a mask find a lamp with the weight of their last scattering: light samples and paths together give what
// paths alone give. The latter is made by lights that know of no emitter.
static void test_paths_with_and_without_light_samples(void **state)
{
    (void)state;
    double mean[2], error[2];
    for (int alone = 0; alone < 2; ++alone) {
        Kit kit, dark;
        for (int lit = 0; lit < 2; ++lit) {
            SheenBuilder *b = kit_begin();
            sheet(b, 0.0f, kit_diffuse(b, 0.8f));
            sheet(b, 0.4f, gray_mask(b, 0.3f, 0.6f));
            sheet(b, 0.6f, add_mask(b, checkerboard(6.0f), 0.9f));
            uint32_t lamp = kit_disk(b, v3(0, 0, 1), 0.6f, v3(0, 0, -1), gray_mask(b, 0.5f, 0.4f));
            uint32_t behind = kit_disk(b, v3(0, 0, 1.2f), 0.9f, v3(0, 0, -1), kit_diffuse(b, 0.0f));
            if (lit) {
                sheen_builder_add_area_light(b, lamp, rgb_gray(3.0f));
                sheen_builder_add_area_light(b, behind, rgb_gray(2.0f)); // seen through the other
            }
            kit_camera(b, v3(0, -0.7f, 0.2f), v3(0, 0, 0), v3(0, 0, 1), 1.2f);
            kit_end(b, 2, lit ? &kit : &dark);
        }
        if (alone) kit.work.lights = dark.lights;
        kit.work.options.bounces = 3;
        kit.work.options.spp = alone ? 256 : 128;
        SheenFilm *film = kit_render(&kit, 0, NULL);
        mean[alone] = film_mean(film);
        // Between rows of pixels there is no stratification: their scatter about a smooth picture bounds the noise.
        double sum = 0.0;
        for (size_t i = 0; i + 32 < 32 * 32; ++i) sum += pow((double)(film->color[i].g - film->color[i + 32].g), 2.0);
        error[alone] = sqrt(0.5 * sum) / (32.0 * 32.0);
        sheen_film_destroy(&film);
        kit_free(&kit);
        kit_free(&dark);
    }
    show("together %.5f +- %.5f, alone %.5f +- %.5f\n", mean[0], error[0], mean[1], error[1]);
    assert_true(error[0] < 0.015 * mean[0] && error[1] < 0.03 * mean[1]);
    assert_true(fabs(mean[0] - mean[1]) < 4.5 * hypot(error[0], error[1]));
}

// White leaves of any opacity among themselves lose nothing.
static void test_white_furnace(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    kit_constant_environment(b, rgb_gray(1.0f));
    kit_sphere(b, v3(0, 0, 4), 1.0f, false, gray_mask(b, 0.5f, 1.0f));
    kit_smooth_sphere(b, v3(0.8f, 0.3f, 3), 0.5f, 6, gray_mask(b, 0.7f, 1.0f));
    kit_quad(b, v3(-3, -1, 1), v3(0, 0, 6), v3(6, 0, 0), add_mask(b, checkerboard(20.0f), 1.0f));
    kit_quad(b, v3(-3, -1, 6), v3(0, 4, 0), v3(6, 0, 0), gray_mask(b, 0.0f, 0.0f));
    kit_quad(b, v3(-3, -1, 7), v3(0, 4, 0), v3(6, 0, 0), kit_mirror(b));
    kit_camera(b, v3(0, 0, 0), v3(0, 0, 4), v3(0, 1, 0), 0.8f);
    Kit kit;
    kit_end(b, 2, &kit);
    kit.work.options.bounces = 100000;
    kit.work.options.spp = 64;
    SheenFilm *film = kit_render(&kit, 0, NULL);
    kit_assert_mean(film, 1.0, 1e-5, 2e-3, "furnace of leaves");
    sheen_film_destroy(&film);
    kit_free(&kit);
}

// A hundred thin layers darken by each and no more: passage does not count against any depth.
static void test_foliage_of_a_hundred_layers(void **state)
{
    (void)state;
    for (int integrator = 0; integrator < 2; ++integrator) {
        SheenBuilder *b = kit_begin();
        kit_constant_environment(b, rgb_gray(1.0f));
        for (int i = 0; i < 100; ++i) sheet(b, 1.0f + 0.01f * (float)i, gray_mask(b, 0.02f, 0.0f));
        kit_camera(b, v3(0, 0, 0), v3(0, 0, 1), v3(0, 1, 0), 0.2f);
        SheenRenderSettings s = direct_settings(integrator ? SHEEN_INTEGRATOR_PATH : SHEEN_INTEGRATOR_IRRADIANCE);
        s.options.spp = integrator ? 64 : 1;
        SheenFilm *film = stage_picture(b, &s);
        double expected = pow(0.98, 100.0);
        KitMean m = kit_mean(film, expected);
        if (integrator)
            kit_assert_mean(film, expected, 1e-5, 0.02, "layers");
        else
            assert_true(m.worst < 1e-5 * expected); // rounding of a hundred factors
        sheen_film_destroy(&film);
    }
}

// The cached picture of a room with leaves before the lamp, and a coated ball, against paths.
static void test_a_room_with_leaves(void **state)
{
    (void)state;
    SheenBuilder *b = kit_room(1.0f, 0.5f, SHEEN_MATERIAL_PLASTIC, true);
    kit_quad(b, v3(-0.7f, -0.7f, 0.5f), v3(1.4f, 0, 0), v3(0, 1.4f, 0.1f), add_mask(b, checkerboard(7.0f), 0.6f));
    kit_quad(b, v3(-0.5f, -0.5f, 0.0f), v3(0.9f, 0, 0.2f), v3(0, 0.8f, 0), gray_mask(b, 0.6f, 0.7f));
    Stage stage = stage_end(b, 2);
    SheenRenderSettings s = small_settings(8);
    s.options.spp = 16;
    s.options.gather_rays = 256;
    assert_agrees_with_paths(&stage, &s, 128, 0.01, 0.06, "leaves"); // as the room of test_irradiance_glossy
    stage_free(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_point_light_behind_sheets),
        cmocka_unit_test(test_the_shadow_of_a_checkerboard),
        cmocka_unit_test(test_an_environment_behind_a_dome),
        cmocka_unit_test(test_paths_with_and_without_light_samples),
        cmocka_unit_test(test_white_furnace),
        cmocka_unit_test(test_foliage_of_a_hundred_layers),
        cmocka_unit_test(test_a_room_with_leaves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
