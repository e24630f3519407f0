// SPDX-License-Identifier: Apache-2.0
// Scenes whose radiance is the same everywhere: furnaces, lossless glass and mirrors, closed boxes that glow.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "analytic/path_kit.h"

// Every path has weight one: each pixel is exact but for the rounding of some sixty factors.
static void assert_each_pixel(const SheenFilm *film, Rgb expected)
{
    for (size_t i = 0; i < (size_t)film->width * film->height; ++i) {
        assert_true(fabsf(film->color[i].r - expected.r) <= 2e-5f * expected.r);
        assert_true(fabsf(film->color[i].g - expected.g) <= 2e-5f * expected.g);
        assert_true(fabsf(film->color[i].b - expected.b) <= 2e-5f * expected.b);
    }
}

static void test_environment_alone(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    kit_constant_environment(b, rgb(0.25f, 1.0f, 3.0f));
    kit_camera(b, v3(0, 0, 0), v3(0, 0, 1), v3(0, 1, 0), 1.0f);
    Kit kit;
    kit_end(b, 1, &kit);
    SheenFilm *film = kit_render(&kit, 0, NULL);
    assert_each_pixel(film, rgb(0.25f, 1.0f, 3.0f));
    sheen_film_destroy(&film);
    kit_free(&kit);
}

// A lossless delta surface only redirects: whatever it shows is the environment, also beside its silhouette. Spheres
// lie in each other's reflection. Paths of more than SHEEN_PATH_MAX_DELTA reflections would be missing; there are none
// between these two.
static void lossless(SheenMaterialKind kind, float ior)
{
    SheenBuilder *b = kit_begin();
    uint32_t material = kit_material(b, kind, 0.0f, ior);
    kit_constant_environment(b, rgb(0.25f, 1.0f, 3.0f));
    kit_sphere(b, v3(-0.7f, 0, 4), 1.0f, false, material);
    kit_quad(b, v3(0.5f, -1, 3.5f), v3(0, 2, 0), v3(2, 0, -0.5f), material);
    kit_camera(b, v3(0, 0, 0), v3(0, 0, 1), v3(0, 1, 0), 1.0f);
    Kit kit;
    kit_end(b, 2, &kit);
    kit.work.options.bounces = 0; // delta lobes are no bounces
    SheenStats stats = {0};
    SheenFilm *film = kit_render(&kit, 0, &stats);
    assert_each_pixel(film, rgb(0.25f, 1.0f, 3.0f));
    assert_true(stats.rays_specular > stats.rays_camera / 4); // the scene was there
    assert_int_equal(stats.rays_shadow, 0);
    sheen_film_destroy(&film);
    kit_free(&kit);
}

static void test_lossless_mirror(void **state)
{
    (void)state;
    lossless(SHEEN_MATERIAL_CONDUCTOR, 1.0f);
}
static void test_lossless_glass(void **state)
{
    (void)state;
    lossless(SHEEN_MATERIAL_THIN_DIELECTRIC, 1.5f);
}

// Glass of a closed body, from outside and from within, index above and below one.
static void test_lossless_glass_body(void **state)
{
    (void)state;
    for (int inside = 0; inside < 2; ++inside) {
        for (int dense = 0; dense < 2; ++dense) {
            SheenBuilder *b = kit_begin();
            kit_constant_environment(b, rgb(0.25f, 1.0f, 3.0f));
            float ior = dense ? 1.5f : 1.0f / 1.5f;
            kit_sphere(b, v3(0, 0, 4), 1.0f, false, kit_material(b, SHEEN_MATERIAL_DIELECTRIC, 0.0f, ior));
            kit_camera(b, v3(0, 0, inside ? 4.0f : 0.0f), v3(0, 0, 6), v3(0, 1, 0), 0.6f);
            Kit kit;
            kit_end(b, 2, &kit);
            SheenFilm *film = kit_render(&kit, 0, NULL);
            // From within, radiance is the square of the index times larger.
            float scale = inside ? ior * ior : 1.0f;
            assert_each_pixel(film, rgb_scale(rgb(0.25f, 1.0f, 3.0f), scale));
            sheen_film_destroy(&film);
            kit_free(&kit);
        }
    }
}

// White walls between which light goes to and fro lose nothing: the mean of every pixel is the environment's radiance.
static void test_white_furnace(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    uint32_t white = kit_diffuse(b, 1.0f);
    kit_constant_environment(b, rgb_gray(1.0f));
    kit_sphere(b, v3(0, 0, 4), 1.0f, false, white);
    kit_quad(b, v3(-3, -1, 1), v3(0, 0, 6), v3(6, 0, 0), white); // the floor, seen from above
    kit_quad(b, v3(-3, -1, 6), v3(0, 4, 0), v3(6, 0, 0), kit_mirror(b));
    kit_camera(b, v3(0, 0, 0), v3(0, 0, 4), v3(0, 1, 0), 0.8f);
    Kit kit;
    kit_end(b, 2, &kit);
    kit.work.options.bounces = 100000;
    kit.work.options.spp = 64;
    SheenFilm *film = kit_render(&kit, 0, NULL);
    kit_assert_mean(film, 1.0, 1e-5, 2e-3, "white furnace");
    // A pixel's standard deviation is below 0.06 here; seven of them are never seen in 1024 pixels.
    assert_true(kit_mean(film, 1.0).worst < 0.45);
    sheen_film_destroy(&film);
    kit_free(&kit);
}

// In a closed body of albedo rho that emits Le all over, light of k scatterings is Le rho^k, and B bounces allow B + 1.
static void glowing(bool sphere, float rho, uint32_t bounces, uint32_t light_samples)
{
    SheenBuilder *b = kit_begin();
    uint32_t material = kit_diffuse(b, rho);
    if (sphere)
        sheen_builder_add_area_light(b, kit_sphere(b, v3(0, 0, 0), 1.5f, true, material), rgb_gray(2.0f));
    else
        kit_box(b, material, 2.0f);
    kit_camera(b, v3(0.3f, -0.2f, 0.1f), v3(1, 1, 0.4f), v3(0, 0, 1), 1.6f);
    Kit kit;
    kit_end(b, 2, &kit);
    kit.work.options.bounces = bounces;
    kit.work.options.light_samples = light_samples;
    kit.work.options.spp = 16;
    double expected = 0.0, power = 2.0;
    for (uint32_t k = 0; k <= bounces + 1 && power > 1e-9; ++k, power *= (double)rho) expected += power;
    SheenFilm *film = kit_render(&kit, 1u << SHEEN_AOV_DIRECT | 1u << SHEEN_AOV_INDIRECT, NULL);
    char what[80];
    snprintf(what, sizeof what, "%s, rho %g, %u bounces", sphere ? "sphere" : "box", (double)rho, bounces);
    kit_assert_mean(film, expected, 1e-5, 5e-3, what);
    double direct = 0.0, indirect = 0.0;
    for (size_t i = 0; i < 32 * 32; ++i) {
        direct += (double)film->aov[SHEEN_AOV_DIRECT][3 * i + 1] / (32 * 32);
        indirect += (double)film->aov[SHEEN_AOV_INDIRECT][3 * i + 1] / (32 * 32);
    }
    // The direct layer holds the emitted light and that of one scattering; 1 % is above 4.5 standard errors.
    assert_true(fabs(direct - 2.0 * (1.0 + (double)rho)) < 0.01 * direct);
    if (bounces == 0) assert_true(indirect == 0.0);
    sheen_film_destroy(&film);
    kit_free(&kit);
}

static void test_glowing_box(void **state)
{
    (void)state;
    glowing(false, 0.5f, 0, 1);
    glowing(false, 0.8f, 1, 1);
    glowing(false, 0.8f, 3, 3);
    glowing(false, 0.7f, 100000, 1);
}

static void test_glowing_sphere(void **state)
{
    (void)state;
    glowing(true, 0.5f, 0, 2);
    glowing(true, 0.8f, 2, 1);
    glowing(true, 0.7f, 100000, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_environment_alone), cmocka_unit_test(test_lossless_mirror),
        cmocka_unit_test(test_lossless_glass),    cmocka_unit_test(test_lossless_glass_body),
        cmocka_unit_test(test_white_furnace),     cmocka_unit_test(test_glowing_box),
        cmocka_unit_test(test_glowing_sphere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
