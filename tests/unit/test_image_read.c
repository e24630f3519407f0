// SPDX-License-Identifier: Apache-2.0
// Every kind of picture that is read, from small files that other programs made (fuzz/corpus/image), and what becomes
// of them when they are cut or damaged.
#include "image/image.h"

#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define CORPUS SHEEN_TEST_SOURCE_DIR "/fuzz/corpus/image/"

typedef struct Lines {
    int errors, warnings;
    char last[1024];
} Lines;

static void count_line(void *user, SheenLogLevel level, const char *text)
{
    Lines *lines = user;
    lines->errors += level == SHEEN_LOG_ERROR;
    lines->warnings += level == SHEEN_LOG_WARNING;
    snprintf(lines->last, sizeof lines->last, "%s", text);
}

static const char *path_of(const char *name)
{
    static char path[1024];
    snprintf(path, sizeof path, CORPUS "%s", name);
    return path;
}

/** All test pictures are 8 x 6: linear ones (x / 8, y / 6 * 6 / 8, 1 / 2), 8-bit ones (32 x, 40 y, 128). */
static Rgb linear_pixel(uint32_t x, uint32_t y)
{
    return (Rgb){(float)x / 8.0f, (float)y / 8.0f, 0.5f};
}

static Rgb byte_pixel(uint32_t x, uint32_t y)
{
    return (Rgb){sheen_srgb_decode((float)(32 * x) / 255.0f), sheen_srgb_decode((float)(40 * y) / 255.0f),
                 sheen_srgb_decode(128.0f / 255.0f)};
}

static Rgb gray(float v)
{
    return (Rgb){v, v, v};
}

static Rgb gray_linear(uint32_t x, uint32_t y)
{
    return gray(linear_pixel(x, y).r);
}

static Rgb gray_byte(uint32_t x, uint32_t y)
{
    return gray(byte_pixel(x, y).r);
}

static Rgb stripes(uint32_t x, uint32_t y)
{
    (void)y;
    return gray((float)(x % 2));
}

static Rgb first_column(uint32_t x, uint32_t y)
{
    (void)x;
    return linear_pixel(0, y);
}

static Rgb eightfold(uint32_t x, uint32_t y)
{
    Rgb c = linear_pixel(x, y);
    return (Rgb){8.0f * c.r, 8.0f * c.g, 8.0f * c.b};
}

/** Data window (8, -19) .. (15, -14) in a display window (10, -20) .. (17, -15): shifted, cut and black outside. */
static Rgb shifted(uint32_t x, uint32_t y)
{
    return x <= 5 && y >= 1 ? linear_pixel(x + 2, y - 1) : (Rgb){0};
}

typedef struct Case {
    const char *name;
    Rgb (*want)(uint32_t x, uint32_t y);
    float bound;
    int warnings;
} Case;

static void check_case(const Case *c)
{
    Lines lines = {0};
    SheenLog log = {count_line, &lines};
    SheenImage image;
    SheenStatus status = sheen_image_read(path_of(c->name), &log, &image);
    if (status) fail_msg("%s: %s", c->name, lines.last);
    assert_int_equal(image.width, 8);
    assert_int_equal(image.height, 6);
    assert_int_equal(lines.warnings, c->warnings);
    for (uint32_t y = 0; y < 6; ++y) {
        for (uint32_t x = 0; x < 8; ++x) {
            Rgb want = c->want(x, y), got = image.pixels[y * 8 + x];
            if (!(fabsf(got.r - want.r) <= c->bound && fabsf(got.g - want.g) <= c->bound &&
                  fabsf(got.b - want.b) <= c->bound))
                fail_msg("%s at (%u, %u): %g %g %g, want %g %g %g", c->name, x, y, (double)got.r, (double)got.g,
                         (double)got.b, (double)want.r, (double)want.g, (double)want.b);
        }
    }
    sheen_image_free(&image);
}

static void test_linear_pictures(void **state)
{
    (void)state;
    // Eighths are exact in half, float and RGBE; B44 and PXR24 keep them too.
    static const Case cases[] = {
        {"little.pfm", linear_pixel, 0, 0},    {"big.pfm", linear_pixel, 0, 0},
        {"gray.pfm", gray_linear, 0, 0},       {"plain.hdr", linear_pixel, 0, 0},
        {"runs.hdr", linear_pixel, 0, 0},      {"exposed.hdr", linear_pixel, 0, 0},
        {"repeat.hdr", first_column, 0, 0},    {"none_float.exr", linear_pixel, 0, 0},
        {"rle_half.exr", linear_pixel, 0, 0},  {"zip_half.exr", linear_pixel, 0, 0},
        {"piz_float.exr", linear_pixel, 0, 0}, {"pxr24_float.exr", linear_pixel, 0, 0},
        {"b44_half.exr", linear_pixel, 0, 0},  {"uint.exr", eightfold, 0, 0},
        {"tiled.exr", linear_pixel, 0, 0},     {"luminance.exr", gray_linear, 0, 0},
        {"layer.exr", linear_pixel, 0, 1},     {"windows.exr", shifted, 0, 0},
        {"parts.exr", linear_pixel, 0, 1},     {"parts_depth_first.exr", linear_pixel, 0, 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) check_case(&cases[i]);
}

static void test_byte_pictures(void **state)
{
    (void)state;
    const float exact = 1e-6f;
    const float jpeg = 0.02f; // quality 100: two steps of 255 near white, where the curve's slope is 2.3
    const Case cases[] = {
        {"rgb8.png", byte_pixel, exact, 0},       {"rgb16.png", byte_pixel, exact, 0},
        {"rgba8.png", byte_pixel, exact, 0},      {"gray8.png", gray_byte, exact, 0},
        {"gray16.png", gray_byte, exact, 0},      {"grayalpha8.png", gray_byte, exact, 0},
        {"gray1.png", stripes, exact, 0},         {"palette8.png", byte_pixel, exact, 0},
        {"interlaced.png", byte_pixel, exact, 0}, {"rgb.jpg", byte_pixel, jpeg, 0},
        {"progressive.jpg", byte_pixel, jpeg, 0}, {"gray.jpg", gray_byte, jpeg, 0},
        {"rgb.tga", byte_pixel, exact, 0},        {"upward.tga", byte_pixel, exact, 0},
        {"gray.tga", gray_byte, exact, 0},        {"palette.tga", byte_pixel, exact, 0},
        {"rle.tga", byte_pixel, exact, 0},        {"rgb.bmp", byte_pixel, exact, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) check_case(&cases[i]);
}

/** A block of ones, its corners at (5, 3) and (29, 19), in black: what each compression does at an edge. */
static void test_compressed_steps(void **state)
{
    (void)state;
    static const char *const names[] = {"rle_step.exr",   "zip_step.exr", "piz_step.exr",
                                        "pxr24_step.exr", "b44_step.exr", "b44a_step.exr"};
    for (int i = 0; i < 6; ++i) {
        SheenImage image;
        assert_int_equal(sheen_image_read(path_of(names[i]), NULL, &image), SHEEN_OK);
        assert_true(image.width == 40 && image.height == 32);
        for (uint32_t y = 0; y < 32; ++y) {
            for (uint32_t x = 0; x < 40; ++x) {
                float want = x >= 5 && x < 30 && y >= 3 && y < 20 ? 1.0f : 0.0f, got = image.pixels[y * 40 + x].g;
                assert_true(fabsf(got - want) < 0.01f); // B44 keeps 6 bits of a difference, here in a log scale
            }
        }
        sheen_image_free(&image);
    }
}

static void test_read_bytes(void **state)
{
    (void)state;
    static const char *const names[] = {"rgb8.png", "rgb16.png", "palette8.png", "rgb.tga", "rgb.bmp"};
    for (int i = 0; i < 5; ++i) {
        uint32_t width, height;
        uint8_t *pixels;
        assert_true(sheen_image_is_8bit(names[i]));
        assert_int_equal(sheen_image_read_bytes(path_of(names[i]), NULL, &width, &height, &pixels), SHEEN_OK);
        assert_true(width == 8 && height == 6);
        for (uint32_t k = 0; k < 48; ++k) {
            assert_int_equal(pixels[3 * k], 32 * (k % 8));
            assert_int_equal(pixels[3 * k + 1], 40 * (k / 8));
            assert_int_equal(pixels[3 * k + 2], 128);
        }
        free(pixels);
    }
    uint32_t width, height;
    uint8_t *pixels;
    assert_false(sheen_image_is_8bit("a.exr"));
    assert_int_equal(sheen_image_read_bytes(path_of("plain.hdr"), NULL, &width, &height, &pixels),
                     SHEEN_ERR_UNSUPPORTED);
    assert_null(pixels);
}

// Alpha as other programs wrote it: 77 everywhere, and eighths across; none where there is none.
static void test_read_alpha(void **state)
{
    (void)state;
    static const char *const names[] = {"rgba8.png", "grayalpha8.png", "rgb8.png", "rgb.jpg", "rgb.tga", "rgb.bmp"};
    for (int i = 0; i < 6; ++i) {
        uint32_t width, height;
        uint8_t *pixels;
        assert_int_equal(sheen_image_read_alpha(path_of(names[i]), NULL, &width, &height, &pixels), SHEEN_OK);
        assert_int_equal(pixels != NULL, i < 2);
        for (uint32_t k = 0; pixels && k < 3 * 48; ++k) assert_int_equal(pixels[k], i == 0 ? 77 : 32 * (k / 3 % 8));
        free(pixels);
    }
}

static void expect_failure(const void *data, size_t size, SheenStatus want, const char *reason)
{
    Lines lines = {0};
    SheenLog log = {count_line, &lines};
    SheenImage image = {1, 1, NULL};
    SheenStatus status = sheen_image_decode(data, size, "PICTURE", &log, &image);
    if (status != want) fail_msg("status %d (%s), want %d: %s", (int)status, lines.last, (int)want, reason);
    assert_int_equal(lines.errors, 1);
    assert_memory_equal(lines.last, "PICTURE: ", 9);
    if (!strstr(lines.last, reason)) fail_msg("'%s' does not say '%s'", lines.last, reason);
    assert_true(image.pixels == NULL && image.width == 0);
}

/** Portable pixmaps: any white, two bytes above 255, comments; a header that claims the sky is refused. */
static void test_pixmaps(void **state)
{
    (void)state;
    static const struct {
        const char *data;
        size_t size;
        float green; // of the last pixel, encoded
    } cases[] = {{"P5 1 1 255\n\x80", 12, 128},
                 {"P6\n# 9999999999\n1 1 15\n\x3\x5\x1", 26, 85},
                 {"P5\t2 1 65535 \0\0\x40\x1", 17, 64},
                 {"P6 1 1 256 \0\1\1\0\0\1", 17, 255},
                 {"P5 1 1 15\n\x20", 11, 255}};
    for (int i = 0; i < 5; ++i) {
        SheenImage image;
        assert_int_equal(sheen_image_decode(cases[i].data, cases[i].size, "pixmap", NULL, &image), SHEEN_OK);
        float green = 255.0f * sheen_srgb_encode(image.pixels[image.width - 1].g);
        assert_true(fabsf(green - cases[i].green) < 0.01f);
        sheen_image_free(&image);
    }
    static const char *const broken[] = {"P5 42949672970 1 255 abcdefghij",
                                         "P5 1 1 65536 abc",
                                         "P5 1 1 0 abc",
                                         "P6 1 x 255 abc",
                                         "P6 1 1 255",
                                         "P5 -1 1 255 abc"};
    for (int i = 0; i < 6; ++i) expect_failure(broken[i], strlen(broken[i]), SHEEN_ERR_PARSE, "header");
    expect_failure("P5\t2 4   1615\t", 14, SHEEN_ERR_PARSE, "ends before");
    expect_failure("P6 2 1 255\nabc", 14, SHEEN_ERR_PARSE, "ends before");
}

static size_t load(const char *path, uint8_t buffer[static 8192])
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t n = fread(buffer, 1, 8192, file);
    fclose(file);
    assert_in_range(n, 1, 8191);
    return n;
}

static void test_refused_kinds(void **state)
{
    (void)state;
    static const struct {
        const char *name, *reason;
    } cases[] = {{"cmyk.jpg", "CMYK"}, {"dwab_half.exr", "DWAB"}, {"b44_float.exr", "B44"}};
    uint8_t data[8192];
    for (int i = 0; i < 3; ++i)
        expect_failure(data, load(path_of(cases[i].name), data), SHEEN_ERR_UNSUPPORTED, cases[i].reason);
    expect_failure("", 0, SHEEN_ERR_UNSUPPORTED, "not a picture");
    expect_failure("GIF89a and so on", 16, SHEEN_ERR_UNSUPPORTED, "not a picture");
    static const char xyze[] = "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd";
    expect_failure(xyze, sizeof xyze - 1, SHEEN_ERR_UNSUPPORTED, "xyze");
    static const char columns[] = "#?RADIANCE\n\n+X 1 +Y 1\nabcd";
    expect_failure(columns, sizeof columns - 1, SHEEN_ERR_UNSUPPORTED, "columns");
}

/** Sizes are believed only within the limits, and only when the file is long enough for them. */
static void test_claimed_sizes(void **state)
{
    (void)state;
    static const struct {
        const char *header;
        SheenStatus status;
        const char *reason;
    } cases[] = {
        {"PF\n0 5\n-1\n", SHEEN_ERR_PARSE, "empty"},
        {"PF\n65537 1\n-1\n", SHEEN_ERR_UNSUPPORTED, "65537 x 1"},
        {"PF\n65536 65536\n-1\n", SHEEN_ERR_UNSUPPORTED, "allowed"},
        {"PF\n999999999 999999999\n-1\n", SHEEN_ERR_UNSUPPORTED, "allowed"},
        {"PF\n16384 16384\n-1\n", SHEEN_ERR_PARSE, "cannot be in a file of"},
        {"PF\n-5 5\n-1\n", SHEEN_ERR_PARSE, "header"},
        {"PF\n5 5\n0\n", SHEEN_ERR_PARSE, "header"},
        {"PF\n5 5\nnan\n", SHEEN_ERR_PARSE, "header"},
        {"PF\n5 5\n-1\n", SHEEN_ERR_PARSE, "ends before"},
        {"#?RADIANCE\n\n-Y 60000 +X 60000\n", SHEEN_ERR_UNSUPPORTED, "allowed"},
        {"#?RADIANCE\n\n-Y 9000 +X 9000\n", SHEEN_ERR_PARSE, "cannot be in a file of"},
        {"#?RADIANCE\n\n-Y 0 +X 9\n", SHEEN_ERR_PARSE, "empty"},
        {"#?RADIANCE\n\n-Y 9 +X 9\n", SHEEN_ERR_PARSE, "scanline 0"},
        {"#?RADIANCE\nEXPOSURE=0\n\n-Y 9 +X 9\n", SHEEN_ERR_PARSE, "exposure"},
        {"#?RADIANCE\nEXPOSURE=1e-42\n\n-Y 9 +X 9\n", SHEEN_ERR_PARSE, "exposure"},
        {"#?RADIANCE\nno end", SHEEN_ERR_PARSE, "header"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i)
        expect_failure(cases[i].header, strlen(cases[i].header), cases[i].status, cases[i].reason);
}

/**
 * No prefix of a file is a picture, except that the last bytes of some formats hold nothing needed, and each is refused
 * with one line. The copies are exact in length, so that the address sanitizer sees a read past the end.
 */
static void test_cut_files(void **state)
{
    (void)state;
    DIR *dir = opendir(CORPUS);
    assert_non_null(dir);
    int n_files = 0;
    for (struct dirent *e; (e = readdir(dir));) {
        if (!strchr("abcdefghijklmnopqrstuvwxyz", e->d_name[0]) || !strchr(e->d_name, '.')) continue;
        if (!strcmp(e->d_name, "parts.exr")) continue; // what is cut is a part that nobody asked for
        uint8_t data[8192];
        size_t n = load(path_of(e->d_name), data);
        SheenImage image;
        if (sheen_image_decode(data, n, "PICTURE", NULL, &image)) continue;
        sheen_image_free(&image);
        ++n_files;
        for (size_t cut = 0; cut < n; ++cut) {
            uint8_t *copy = malloc(cut ? cut : 1);
            assert_non_null(copy);
            memcpy(copy, data, cut);
            Lines lines = {0};
            SheenLog log = {count_line, &lines};
            SheenStatus status = sheen_image_decode(copy, cut, "PICTURE", &log, &image);
            if (status == SHEEN_OK && cut < n - 16) fail_msg("%s cut to %zu bytes was read", e->d_name, cut);
            if (lines.errors != (status ? 1 : 0)) fail_msg("%s cut to %zu: %d lines", e->d_name, cut, lines.errors);
            sheen_image_free(&image);
            free(copy);
        }
    }
    closedir(dir);
    assert_true(n_files >= 20);
}

static void test_missing_files(void **state)
{
    (void)state;
    Lines lines = {0};
    SheenLog log = {count_line, &lines};
    SheenImage image;
    assert_int_equal(sheen_image_read("/nonexistent/a.exr", &log, &image), SHEEN_ERR_IO);
    assert_string_equal(lines.last, "/nonexistent/a.exr: No such file or directory");
    assert_int_equal(sheen_image_read("/", &log, &image), SHEEN_ERR_IO);
    assert_string_equal(lines.last, "/: Is a directory");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_linear_pictures),  cmocka_unit_test(test_byte_pictures),
        cmocka_unit_test(test_compressed_steps), cmocka_unit_test(test_read_bytes),
        cmocka_unit_test(test_read_alpha),       cmocka_unit_test(test_pixmaps),
        cmocka_unit_test(test_refused_kinds),    cmocka_unit_test(test_claimed_sizes),
        cmocka_unit_test(test_cut_files),        cmocka_unit_test(test_missing_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
