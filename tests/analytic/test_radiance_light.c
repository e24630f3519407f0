// SPDX-License-Identifier: Apache-2.0
// Which light cached lobes show, and which light samples: lamps, the sky; at any brightness.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "analytic/glossy_kit.h"

// A board alone, seen at 45 degrees; its normal is z.
static SheenBuilder *lone_board(const Gloss *gloss, bool behind)
{
    SheenBuilder *b = kit_begin();
    uint32_t m = add_gloss(b, gloss);
    if (behind)
        kit_quad(b, v3(-3, -3, 0), v3(0, 6, 0), v3(6, 0, 0), m);
    else
        kit_quad(b, v3(-3, -3, 0), v3(6, 0, 0), v3(0, 6, 0), m);
    kit_camera(b, v3(0, -2, 2), v3(0, 0, 0), v3(0, 0, 1), 0.5f);
    return b;
}

typedef enum Light { POINT, DIRECTION, SUN, LAMP, LIGHTS } Light;
static const char *const light_name[LIGHTS] = {"point light", "directional light", "sun", "small lamp"};

// Direct light alone, near the mirror's direction, where the highlight is: light samples stand for all of it, cached
// lobes do not see it again. What is between two samples of a pixel is all that differs: blocks by 0.1 % at most, and
// the lamp's mean, over seeds and on the sharp lobe, by 0.2 %: noise.
static void check_direct(const Gloss *gloss, bool behind, Light light)
{
    SheenBuilder *b = lone_board(gloss, behind);
    Vec3 at = v3(0.2f, 1.5f, 1.5f);
    if (light == POINT) add_light(b, SHEEN_LIGHT_POINT, at, 0.0f);
    if (light == DIRECTION || light == SUN) add_light(b, SHEEN_LIGHT_DIRECTIONAL, at, light == SUN ? 0.1f : 0.0f);
    if (light == LAMP)
        sheen_builder_add_area_light(
            b, kit_quad(b, v3(0, 1.5f, 1.5f), v3(0.2f, 0, 0), v3(0, -0.14f, 0.14f), kit_diffuse(b, 0)),
            rgb_gray(20.0f));
    Stage stage = stage_end(b, 2);
    float share = share_of(&stage, 0, 0.7071f);
    assert_true(gloss == &phong ? share == 1.0f : share > 0.2f && share < 0.8f);
    bool wide = light == SUN || light == LAMP;
    SheenRenderSettings s = small(1);
    s.options.order = 10;
    s.options.spp = wide ? 64 : 16;
    Reference r = reference(&stage, &s, 128);
    check(&stage, &s, &r, wide ? 0.004 : 0.001, wide ? 0.008 : 0.003, light_name[light], gloss->name);
    sheen_film_destroy(&r.film);
    stage_free(&stage);
}

static void test_direct_light_is_not_doubled(void **state)
{
    (void)state;
    for (Light light = 0; light < LIGHTS; ++light) {
        check_direct(&phong, light == DIRECTION, light);
        check_direct(&sharp, light == SUN, light);
    }
}

static double albedo_of(const SheenScene *scene, float cos_theta)
{
    enum { ROWS = 256, COLUMNS = 512 };
    SurfacePoint s = {.ng = v3(0, 0, 1), .ns = v3(0, 0, 1), .instance = SHEEN_NONE};
    Bsdf bsdf = sheen_bsdf_at(scene, &s);
    Vec3 wo = v3(sqrtf(1.0f - cos_theta * cos_theta), 0, cos_theta);
    double sum = 0.0;
    for (int i = 0; i < ROWS; ++i)
        for (int j = 0; j < COLUMNS; ++j) {
            float z = ((float)i + 0.5f) / ROWS, phi = 2.0f * SHEEN_PI * ((float)j + 0.5f) / COLUMNS;
            float x = sqrtf(1.0f - z * z);
            sum += (double)rgb_luminance(sheen_bsdf_eval(&bsdf, wo, v3(x * cosf(phi), x * sinf(phi), z)));
        }
    return sum * 2.0 * M_PI / (ROWS * COLUMNS);
}

// Under an even sky a convex thing shows its albedo, with and without bounces. Seen from afar, all of the board at
// nearly the same angle. One record serves it all, whose own noise is 0.7 % over seeds: the bound is three times that.
static void test_even_sky(void **state)
{
    (void)state;
    static const float cosines[] = {1.0f, 0.7f, 0.35f};
    for (int behind = 0; behind < 2; ++behind)
        for (int i = 0; i < 3; ++i)
            for (int basis = 1; basis < 3; ++basis) {
                SheenBuilder *b = kit_begin();
                uint32_t m = add_gloss(b, &phong);
                Vec3 x = v3(6, 0, 0), y = v3(0, 6, 0);
                kit_quad(b, v3(-3, -3, 0), behind ? y : x, behind ? x : y, m);
                kit_constant_environment(b, rgb_gray(1.0f));
                float z = cosines[i];
                kit_camera(b, v3_scale(v3(0, -sqrtf(1.0f - z * z), z), 30.0f), v3(0, 0, 0), v3(1, 0, 0), 0.02f);
                Stage stage = stage_end(b, 2);
                SheenRenderSettings s = small((uint32_t)i % 2);
                s.options.basis = (SheenBasisChoice)basis;
                SheenStats stats;
                SheenFilm *film = stage_render(&stage, &s, &stats);
                assert_true(stats.radiance_records > 0);
                double off = film_mean(film) / albedo_of(stage.scene, z) - 1.0;
                show("even sky, %s, cosine %g, behind %d: off by %.2g\n", basis_name[basis], (double)z, behind, off);
                assert_true(fabs(off) < 0.02);
                sheen_film_destroy(&film);
                stage_free(&stage);
            }
}

// A sky that is brighter on one side and above, without a sun.
static void add_soft_sky(SheenBuilder *b)
{
    enum { WIDTH = 32, HEIGHT = 16 };
    Rgb *pixels = SHEEN_ARENA_NEW(sheen_builder_arena(b), Rgb, WIDTH * HEIGHT);
    assert_non_null(pixels);
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
            pixels[y * WIDTH + x] = rgb_gray(1.2f + 0.8f * cosf(2.0f * SHEEN_PI * (float)x / WIDTH) - 0.02f * (float)y);
    SheenLight light = {.kind = SHEEN_LIGHT_ENVIRONMENT,
                        .radiance = rgb_gray(1.0f),
                        .shape = SHEEN_NONE,
                        .environment = {.width = WIDTH, .height = HEIGHT, .floats = pixels},
                        .to_world = transform_identity(),
                        .to_light = transform_identity()};
    sheen_builder_add_light(b, &light);
}

static Stage under_the_sky(Thing thing, const Gloss *gloss)
{
    SheenBuilder *b = kit_begin();
    add_thing(b, thing, add_gloss(b, gloss));
    add_soft_sky(b);
    add_camera(b, thing);
    return stage_end(b, 2);
}

// What a lobe reflects of a soft sky is in the records alone, without bounces too; that it is brighter on one
// side shows whether the lobe points the right way. Off by 0.8 % in the mean and 1.3 % a block at most, that of the
// ball by what tilted records lose at the horizon: in spherical harmonics, if they were black below it, 1.9 and 2.4 %.
static void test_soft_sky(void **state)
{
    (void)state;
    SheenRenderSettings direct = small(0), bounce = small(1);
    direct.options.order = bounce.options.order = 10;
    check_both_sides(under_the_sky, BOARD, &phong, &direct, 0.01, 0.015);
    check_both_sides(under_the_sky, BOARD, &brushed, &bounce, 0.01, 0.015);
    check_both_sides(under_the_sky, BALL, &brushed, &direct, 0.01, 0.015);
}

// ---- any brightness ---------------------------------------------------------------------------------------------

// Light whose squares are beyond floats, far up and far down, makes the same picture. Variances of a gather do
// underflow and overflow, so that a few rays go elsewhere: 0.3 % of the mean.
static void test_any_brightness(void **state)
{
    (void)state;
    static const float brightness[] = {0x1p0f, 0x1p-80f, 0x1p80f};
    double mean[3];
    for (int i = 0; i < 3; ++i) {
        Stage stage = room_lit(BOARD, &phong, brightness[i]);
        SheenRenderSettings s = small(2);
        SheenFilm *film = stage_render(&stage, &s, NULL);
        mean[i] = film_mean(film) / (double)brightness[i];
        show("brightness %g: mean %.6g\n", (double)brightness[i], mean[i]);
        assert_true(fabs(mean[i] / mean[0] - 1.0) < 0.01);
        sheen_film_destroy(&film);
        stage_free(&stage);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_direct_light_is_not_doubled),
        cmocka_unit_test(test_even_sky),
        cmocka_unit_test(test_soft_sky),
        cmocka_unit_test(test_any_brightness),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
