// SPDX-License-Identifier: Apache-2.0
// Pictures as video has them: values of the standard, where colour stands, odd sides, broken numbers.
#include "image/yuv.h"

#include "image/image.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { side = 8, canary = 77 };

typedef struct Planes {
    uint8_t y[side + 1][side], u[side / 2 + 1][side / 2], v[side / 2 + 1][side / 2]; // the last rows are not written
} Planes;

static Planes encode(const Rgb *pixels, uint32_t w, uint32_t h, float exposure)
{
    Planes p;
    memset(&p, canary, sizeof p);
    SheenYuv out = {.plane = {p.y[0], p.u[0], p.v[0]}, .stride = {side, side / 2, side / 2}};
    assert_int_equal(sheen_yuv_encode(pixels, w, h, exposure, &out), SHEEN_OK);
    return p;
}

static Planes encode_even(Rgb c, float exposure)
{
    Rgb pixels[side * side];
    for (int i = 0; i < side * side; ++i) pixels[i] = c;
    return encode(pixels, side, side, exposure);
}

// The values of ITU-R BT.709 at 100 % saturation, as colour bars have them.
static void test_bars(void **state)
{
    (void)state;
    static const struct {
        Rgb c;
        uint8_t y, u, v;
    } bars[] = {
        {{0, 0, 0}, 16, 128, 128}, {{1, 1, 1}, 235, 128, 128}, {{1, 1, 0}, 219, 16, 138}, {{0, 1, 1}, 188, 154, 16},
        {{0, 1, 0}, 173, 42, 26},  {{1, 0, 1}, 78, 214, 230},  {{1, 0, 0}, 63, 102, 240}, {{0, 0, 1}, 32, 240, 118},
    };
    for (size_t i = 0; i < sizeof bars / sizeof *bars; ++i) {
        Planes p = encode_even(bars[i].c, 0.0f);
        for (int k = 0; k < side * side; ++k) assert_int_equal(p.y[k / side][k % side], bars[i].y);
        for (int k = 0; k < side * side / 4; ++k) {
            assert_int_equal(p.u[k / (side / 2)][k % (side / 2)], bars[i].u);
            assert_int_equal(p.v[k / (side / 2)][k % (side / 2)], bars[i].v);
        }
        assert_int_equal(p.y[side][0], canary);
        assert_int_equal(p.u[side / 2][0], canary);
    }
}

static void test_curve_and_exposure(void **state)
{
    (void)state;
    // Linear 0.5 is 0.7354 on the sRGB curve; a stop more is white.
    assert_int_equal(encode_even(rgb_gray(0.5f), 0.0f).y[3][3], (int)(16.5f + 219.0f * sheen_srgb_encode(0.5f)));
    assert_int_equal(encode_even(rgb_gray(0.5f), 1.0f).y[3][3], 235);
    assert_int_equal(encode_even(rgb_gray(9.0f), 0.0f).y[3][3], 235);
    assert_int_equal(encode_even(rgb_gray(-1.0f), 0.0f).y[3][3], 16);
    assert_int_equal(encode_even(rgb_gray(NAN), 0.0f).y[3][3], 16);
    assert_int_equal(encode_even(rgb_gray(INFINITY), 0.0f).u[1][1], 128);
    assert_int_equal(encode_even(rgb_gray(0.0f), INFINITY).y[3][3], 16);
}

// A blue column: the pair that it is the left one of gets half of it; between two pairs each gets a quarter.
static void test_where_color_stands(void **state)
{
    (void)state;
    for (int column = 2; column <= 3; ++column) {
        Rgb pixels[side * side] = {0};
        for (int y = 0; y < side; ++y) pixels[y * side + column] = rgb(0, 0, 1);
        Planes p = encode(pixels, side, side, 0.0f);
        for (int y = 0; y < side / 2; ++y) {
            assert_int_equal(p.u[y][0], 128);
            assert_int_equal(p.u[y][1], column == 2 ? 128 + 56 : 128 + 28);
            assert_int_equal(p.u[y][2], column == 2 ? 128 : 128 + 28);
            assert_int_equal(p.y[2 * y][column], 32);
            assert_int_equal(p.y[2 * y + 1][column - 1], 16);
        }
    }
    // A blue row is half of its pair.
    Rgb pixels[side * side] = {0};
    for (int x = 0; x < side; ++x) pixels[3 * side + x] = rgb(0, 0, 1);
    Planes p = encode(pixels, side, side, 0.0f);
    assert_int_equal(p.u[0][1], 128);
    assert_int_equal(p.u[1][1], 128 + 56);
    assert_int_equal(p.u[2][1], 128);
}

static void test_odd_sides_repeat_the_last(void **state)
{
    (void)state;
    Rgb pixels[3 * 5];
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 3; ++x) pixels[3 * y + x] = rgb_gray(0.1f * (float)(x + y));
    assert_int_equal(sheen_yuv_side(3), 4);
    assert_int_equal(sheen_yuv_side(6), 6);
    Planes p = encode(pixels, 3, 5, 0.0f);
    for (int y = 0; y < 6; ++y) assert_int_equal(p.y[y][3], p.y[y][2]);
    for (int x = 0; x < 4; ++x) assert_int_equal(p.y[5][x], p.y[4][x]);
    assert_true(p.y[4][2] > p.y[3][2] && p.y[3][2] > p.y[3][1]);
    assert_int_equal(p.y[6][0], canary);
    assert_int_equal(p.y[0][4], canary);
    Planes one = encode(pixels + 14, 1, 1, 0.0f);
    assert_true(one.y[0][0] == one.y[1][1] && one.u[0][0] == 128 && one.y[0][2] == canary);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bars),
        cmocka_unit_test(test_curve_and_exposure),
        cmocka_unit_test(test_where_color_stands),
        cmocka_unit_test(test_odd_sides_repeat_the_last),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
