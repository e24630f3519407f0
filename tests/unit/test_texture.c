// SPDX-License-Identifier: Apache-2.0
// Textures: orientation, wrapping, filtering, means.
#include "scene/texture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

// Sums of four products of numbers up to 4 in float.
#define EPS 2e-6f

// Top row 1 2, bottom row 3 4, as gray.
static const Rgb pixels[4] = {{1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}};

static SheenTexture bitmap(SheenWrap wrap, bool nearest)
{
    SheenTexture t = sheen_texture_constant(rgb_gray(0));
    t.kind = SHEEN_TEXTURE_BITMAP;
    t.bitmap = (SheenBitmap){.width = 2, .height = 2, .floats = pixels};
    t.wrap_u = t.wrap_v = wrap;
    t.nearest = nearest;
    return t;
}

static float at(const SheenTexture *t, float u, float v)
{
    return sheen_texture_eval(t, v2(u, v)).g;
}

static void texel_centers_give_the_texels_and_v_grows_upward(void **state)
{
    (void)state;
    for (int nearest = 0; nearest < 2; ++nearest) {
        SheenTexture t = bitmap(SHEEN_WRAP_REPEAT, nearest);
        assert_float_equal(at(&t, 0.25f, 0.25f), 3.0f, EPS);
        assert_float_equal(at(&t, 0.75f, 0.25f), 4.0f, EPS);
        assert_float_equal(at(&t, 0.25f, 0.75f), 1.0f, EPS);
        assert_float_equal(at(&t, 0.75f, 0.75f), 2.0f, EPS);
        assert_float_equal(at(&t, 5.25f, -3.75f), 3.0f, EPS);
    }
}

static void bilinear_is_linear_between_centers(void **state)
{
    (void)state;
    SheenTexture t = bitmap(SHEEN_WRAP_CLAMP, false);
    assert_float_equal(at(&t, 0.5f, 0.5f), 2.5f, EPS);
    assert_float_equal(at(&t, 0.375f, 0.75f), 1.25f, EPS);
    assert_float_equal(at(&t, 0.25f, 0.625f), 1.5f, EPS);
}

static void borders_follow_the_wrap_mode(void **state)
{
    (void)state;
    SheenTexture repeat = bitmap(SHEEN_WRAP_REPEAT, false), clamp = bitmap(SHEEN_WRAP_CLAMP, false),
                 mirror = bitmap(SHEEN_WRAP_MIRROR, false);
    assert_float_equal(at(&repeat, 0.0f, 0.75f), 1.5f, EPS); // half of the texel at the other end
    assert_float_equal(at(&clamp, 0.0f, 0.75f), 1.0f, EPS);
    assert_float_equal(at(&mirror, 0.0f, 0.75f), 1.0f, EPS);
    assert_float_equal(at(&clamp, 7.0f, -9.0f), 4.0f, EPS);
    assert_float_equal(at(&mirror, 1.25f, 0.75f), 2.0f, EPS);
    assert_float_equal(at(&mirror, -0.75f, 0.75f), 2.0f, EPS);
    assert_float_equal(at(&mirror, 2.25f, 2.25f), 3.0f, EPS);
    assert_float_equal(at(&mirror, -1.25f, 0.25f), 4.0f, EPS);
}

static void odd_coordinates_stay_inside(void **state)
{
    (void)state;
    const float odd[] = {0.0f, 1.0f, -1e-9f, 0x1.fffffep-1f, 1e30f, -1e30f, 3e9f, INFINITY, -INFINITY, NAN};
    for (int wrap = 0; wrap < 3; ++wrap)
        for (int nearest = 0; nearest < 2; ++nearest) {
            SheenTexture t = bitmap((SheenWrap)wrap, nearest);
            for (size_t i = 0; i < sizeof odd / sizeof *odd; ++i)
                for (size_t j = 0; j < sizeof odd / sizeof *odd; ++j) {
                    float value = at(&t, odd[i], odd[j]);
                    assert_true(value >= 1.0f - EPS && value <= 4.0f + EPS); // NaN fails
                }
        }
}

static void bytes_go_through_their_table(void **state)
{
    (void)state;
    float decode[256];
    for (int i = 0; i < 256; ++i) decode[i] = (float)i * 2.0f;
    const uint8_t bytes[3] = {10, 20, 30};
    SheenTexture t = sheen_texture_constant(rgb_gray(0));
    t.kind = SHEEN_TEXTURE_BITMAP;
    t.bitmap = (SheenBitmap){.width = 1, .height = 1, .bytes = bytes, .decode = decode};
    Rgb c = sheen_texture_eval(&t, v2(0.3f, 0.9f)), mean = sheen_texture_mean(&t);
    assert_true(c.r == 20.0f && c.g == 40.0f && c.b == 60.0f);
    assert_true(mean.r == 20.0f && mean.g == 40.0f && mean.b == 60.0f);
}

static void uv_transform_comes_first(void **state)
{
    (void)state;
    SheenTexture t = bitmap(SHEEN_WRAP_REPEAT, true);
    t.uv[0][0] = 0.0f, t.uv[0][1] = 2.0f, t.uv[0][2] = 0.25f; // u' = 2 v + 0.25
    t.uv[1][0] = 1.0f, t.uv[1][1] = 0.0f, t.uv[1][2] = 0.5f;  // v' = u + 0.5
    assert_float_equal(at(&t, 0.25f, 0.25f), 2.0f, EPS);
}

static void checkerboard_has_four_fields(void **state)
{
    (void)state;
    SheenTexture t = sheen_texture_constant(rgb_gray(1));
    t.kind = SHEEN_TEXTURE_CHECKERBOARD;
    t.value2 = rgb_gray(3);
    assert_float_equal(at(&t, 0.25f, 0.25f), 1.0f, 0.0f);
    assert_float_equal(at(&t, 0.75f, 0.25f), 3.0f, 0.0f);
    assert_float_equal(at(&t, 0.25f, 0.75f), 3.0f, 0.0f);
    assert_float_equal(at(&t, -0.25f, 1.75f), 1.0f, 0.0f);
    assert_float_equal(sheen_texture_mean(&t).r, 2.0f, 0.0f);
}

static void grids_have_lines_along_the_unit_squares(void **state)
{
    (void)state;
    SheenTexture t = sheen_texture_constant(rgb_gray(1));
    t.kind = SHEEN_TEXTURE_GRID;
    t.value2 = rgb_gray(3);
    t.line_width = 0.1f;
    assert_float_equal(at(&t, 0.5f, 0.5f), 1.0f, 0.0f);
    assert_float_equal(at(&t, 0.05f, 0.5f), 3.0f, 0.0f);
    assert_float_equal(at(&t, 0.95f, 0.5f), 3.0f, 0.0f);
    assert_float_equal(at(&t, 0.5f, -0.05f), 3.0f, 0.0f);
    assert_float_equal(at(&t, 0.5f, 7.15f), 1.0f, 0.0f);
    assert_float_equal(sheen_texture_mean(&t).r, 0.64f * 1.0f + 0.36f * 3.0f, 1e-6f); // fields of 0.8 x 0.8
}

static void a_scale_multiplies_all_kinds(void **state)
{
    (void)state;
    SheenTexture t = bitmap(SHEEN_WRAP_REPEAT, false);
    Vec2 before = sheen_texture_gradient(&t, v2(0.5f, 0.5f));
    sheen_texture_scale(&t, rgb_gray(0.5f));
    sheen_texture_scale(&t, rgb_gray(0.5f));
    assert_float_equal(at(&t, 0.25f, 0.25f), 0.75f, EPS);
    assert_float_equal(sheen_texture_mean(&t).b, 0.625f, EPS);
    Vec2 after = sheen_texture_gradient(&t, v2(0.5f, 0.5f));
    assert_true(before.x != 0.0f);
    assert_float_equal(after.x, 0.25f * before.x, 1e-5f);
    t = sheen_texture_constant(rgb_gray(1));
    t.kind = SHEEN_TEXTURE_CHECKERBOARD;
    t.value2 = rgb_gray(3);
    sheen_texture_scale(&t, rgb(1, 2, 3));
    assert_float_equal(at(&t, 0.25f, 0.25f), 2.0f, 0.0f);
    assert_float_equal(at(&t, 0.75f, 0.25f), 6.0f, 0.0f);
}

static void means_are_exact(void **state)
{
    (void)state;
    SheenTexture t = bitmap(SHEEN_WRAP_REPEAT, false);
    assert_float_equal(sheen_texture_mean(&t).b, 2.5f, 0.0f);
    t = sheen_texture_constant(rgb(0.1f, 0.2f, 0.3f));
    assert_float_equal(sheen_texture_mean(&t).b, 0.3f, 0.0f);
    assert_float_equal(sheen_texture_eval(&t, v2(NAN, 0)).r, 0.1f, 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texel_centers_give_the_texels_and_v_grows_upward),
        cmocka_unit_test(bilinear_is_linear_between_centers),
        cmocka_unit_test(borders_follow_the_wrap_mode),
        cmocka_unit_test(odd_coordinates_stay_inside),
        cmocka_unit_test(bytes_go_through_their_table),
        cmocka_unit_test(uv_transform_comes_first),
        cmocka_unit_test(checkerboard_has_four_fields),
        cmocka_unit_test(grids_have_lines_along_the_unit_squares),
        cmocka_unit_test(a_scale_multiplies_all_kinds),
        cmocka_unit_test(means_are_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
