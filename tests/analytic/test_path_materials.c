// SPDX-License-Identifier: Apache-2.0
// Paths through materials of several parts, against what must come out.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "analytic/path_kit.h"

static SheenMaterial material(SheenMaterialKind kind)
{
    return (SheenMaterial){.kind = kind,
                           .reflectance = sheen_texture_constant(rgb_gray(1.0f)),
                           .specular_reflectance = sheen_texture_constant(rgb_gray(1.0f)),
                           .specular_transmittance = sheen_texture_constant(rgb_gray(1.0f)),
                           .alpha_u = sheen_texture_constant(rgb_gray(0.3f)),
                           .alpha_v = sheen_texture_constant(rgb_gray(0.3f)),
                           .weight = sheen_texture_constant(rgb_gray(0.4f)),
                           .nonlinear = true,
                           .ior = 1.5f,
                           .name = "kit"};
}

// A ball on which nothing is lost shows its surroundings' radiance. Direct light alone does it: the ball is convex.
// Renders direct light alone and asserts its mean: see kit_assert_mean. Takes the builder.
static void assert_direct_light(SheenBuilder *b, uint32_t spp, double expected, double slack, double sharp,
                                const char *what)
{
    Kit kit;
    kit_end(b, 2, &kit);
    kit.work.options.bounces = 0;
    kit.work.options.spp = spp;
    SheenFilm *film = kit_render(&kit, 0, NULL);
    kit_assert_mean(film, expected, slack, sharp, what);
    sheen_film_destroy(&film);
    kit_free(&kit);
}

static void ball_in_furnace(const SheenMaterial *m, double slack, const char *what)
{
    SheenBuilder *b = kit_begin();
    kit_constant_environment(b, rgb_gray(1.0f));
    kit_sphere(b, v3(0, 0, 4), 1.0f, false, sheen_builder_add_material(b, m));
    kit_camera(b, v3(0, 0, 0), v3(0, 0, 4), v3(0, 1, 0), 0.3f);
    assert_direct_light(b, 64, 1.0, slack, 3e-3, what);
}

static void test_white_plastic(void **state)
{
    (void)state;
    SheenMaterial m = material(SHEEN_MATERIAL_PLASTIC);
    ball_in_furnace(&m, 1e-4, "plastic");
}

static void test_white_rough_plastic(void **state)
{
    (void)state;
    SheenMaterial m = material(SHEEN_MATERIAL_ROUGH_PLASTIC);
    m.alpha_u = sheen_texture_constant(rgb_gray(0.05f));
    ball_in_furnace(&m, 6e-3, "rough plastic"); // single scattering loses half a percent at this roughness
}

static void test_white_mixture(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    kit_constant_environment(b, rgb_gray(1.0f));
    SheenMaterial plastic = material(SHEEN_MATERIAL_PLASTIC), blend = material(SHEEN_MATERIAL_BLEND);
    SheenMaterial mask = material(SHEEN_MATERIAL_MASK);
    plastic.two_sided = true;
    blend.nested[0] = sheen_builder_add_material(b, &plastic);
    blend.nested[1] = kit_mirror(b);
    mask.nested[0] = sheen_builder_add_material(b, &blend);
    kit_quad(b, v3(-2, -2, 3), v3(4, 0, 1), v3(0, 4, 0), sheen_builder_add_material(b, &mask));
    kit_camera(b, v3(0, 0, 0), v3(0, 0, 4), v3(0, 1, 0), 0.3f);
    // The mirror has one side and is black from behind; the camera is behind the quad.
    assert_direct_light(b, 256, 1.0 - 0.4 * 0.4, 1e-4, 3e-3, "mask of a blend");
}

// A sheet that lets 0.5 of the light through, diffusely, between two lamps: only the one behind it is seen through it.
static void test_lamp_behind_a_sheet(void **state)
{
    (void)state;
    for (int lamps = 1; lamps <= 2; ++lamps) {
        SheenBuilder *b = kit_begin();
        SheenMaterial m = material(SHEEN_MATERIAL_DIFFUSE_TRANSMIT);
        m.specular_transmittance = sheen_texture_constant(rgb_gray(0.5f));
        kit_quad(b, v3(-0.02f, -0.02f, 2), v3(0, 0.04f, 0), v3(0.04f, 0, 0), sheen_builder_add_material(b, &m));
        for (int i = 0; i < lamps; ++i) {
            SheenLight light = {.kind = SHEEN_LIGHT_POINT,
                                .radiance = rgb_gray(i == 0 ? 8.0f : 100.0f),
                                .position = v3(i == 0 ? 3.0f : 0.5f, 0, i == 0 ? 6.0f : 0.0f)};
            sheen_builder_add_light(b, &light);
        }
        kit_camera(b, v3(0, 0, 0), v3(0, 0, 2), v3(0, 1, 0), 0.002f);
        // I cos / d^2 = 8 (4 / 5) / 25
        assert_direct_light(b, 256, 0.5 / (double)SHEEN_PI * 0.256, 1e-3, 5e-3, "sheet");
    }
}

// Of a lamp of even radiance around all, rough glass shows what its albedo says, by light samples as by its own.
static void test_rough_glass_under_an_even_sky(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    SheenMaterial m = material(SHEEN_MATERIAL_ROUGH_DIELECTRIC);
    m.distribution = SHEEN_DISTRIBUTION_GGX;
    kit_constant_environment(b, rgb_gray(1.0f));
    kit_quad(b, v3(-1, -1, 2), v3(0, 2, 0), v3(2, 0, 0), sheen_builder_add_material(b, &m));
    kit_camera(b, v3(0, 0, 0), v3(0, 0, 2), v3(0, 1, 0), 0.002f);
    // The mean over normals in double precision, seen perpendicularly: 0.03560 reflected and 0.95279 let through, which
    // spreads over 1.5^2.
    assert_direct_light(b, 64, 0.03560 + 0.95279 / 2.25, 2e-4, 2e-3, "rough glass");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_white_plastic),
        cmocka_unit_test(test_white_rough_plastic),
        cmocka_unit_test(test_white_mixture),
        cmocka_unit_test(test_lamp_behind_a_sheet),
        cmocka_unit_test(test_rough_glass_under_an_even_sky),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
