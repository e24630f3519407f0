// SPDX-License-Identifier: Apache-2.0
// What is written is read back: each format within its own precision.
#include "image/image.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

enum { width = 37, height = 21 };

/** Values over ten decades, zeros, and runs of equal pixels; odd sides, so that no tile or word boundary hides a slip.
 */
static void make_picture(Rgb pixels[height][width])
{
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            float t = (float)(y * width + x) / (height * width);
            pixels[y][x] = x < 12 ? (Rgb){0.25f, 0.5f, (float)(y % 3)}
                                  : (Rgb){powf(10.0f, 10.0f * t - 5.0f), t, 0.5f + 0.5f * sinf(17.0f * t)};
        }
    }
    pixels[3][4] = (Rgb){0.0f, 0.0f, 0.0f};
}

static char *temporary_path(const char *ending)
{
    static char path[256];
    const char *dir = getenv("TMPDIR");
    snprintf(path, sizeof path, "%s/sheen-test-%ld%s", dir ? dir : "/tmp", (long)getpid(), ending);
    return path;
}

static void write_and_read(const char *ending, float exposure, Rgb pixels[height][width], SheenImage *out)
{
    make_picture(pixels);
    char *path = temporary_path(ending);
    SheenImageView view = {.width = width, .height = height, .pixels = &pixels[0][0]};
    assert_int_equal(sheen_image_write(path, &view, exposure, NULL), SHEEN_OK);
    assert_int_equal(sheen_image_read(path, NULL, out), SHEEN_OK);
    unlink(path);
    assert_int_equal(out->width, width);
    assert_int_equal(out->height, height);
}

static void test_float_formats_are_exact(void **state)
{
    (void)state;
    for (int i = 0; i < 2; ++i) {
        Rgb pixels[height][width];
        SheenImage image;
        write_and_read(i ? ".pfm" : ".exr", 3.0f, pixels, &image);
        assert_memory_equal(image.pixels, pixels, sizeof pixels);
        sheen_image_free(&image);
    }
}

static void test_hdr_keeps_eight_bits_of_the_largest(void **state)
{
    (void)state;
    Rgb pixels[height][width];
    SheenImage image;
    write_and_read(".hdr", 3.0f, pixels, &image);
    for (int i = 0; i < width * height; ++i) {
        Rgb want = (&pixels[0][0])[i], got = image.pixels[i];
        // Half a step of a mantissa in [128, 255]: 1/256 of the largest component.
        float bound = maxf(want.r, maxf(want.g, want.b)) / 256.0f;
        assert_true(fabsf(got.r - want.r) <= bound && fabsf(got.g - want.g) <= bound && fabsf(got.b - want.b) <= bound);
    }
    sheen_image_free(&image);
}

static void test_hdr_survives_all_numbers(void **state)
{
    (void)state;
    Rgb pixels[] = {{INFINITY, NAN, -1.0f}, {1e38f, 3e38f, 0.0f}, {1e-44f, 0.0f, 0.0f}, {255.7f, 1.0f, 0.0f}};
    SheenImageView view = {.width = 4, .height = 1, .pixels = pixels};
    SheenImage image;
    char *path = temporary_path(".hdr");
    assert_int_equal(sheen_image_write(path, &view, 0.0f, NULL), SHEEN_OK);
    assert_int_equal(sheen_image_read(path, NULL, &image), SHEEN_OK);
    unlink(path);
    assert_true(image.pixels[0].r > 1.6e38f && image.pixels[0].g == 0.0f && image.pixels[0].b == 0.0f);
    assert_true(image.pixels[1].g > 1.6e38f);
    assert_true(image.pixels[2].r == 0.0f);
    assert_true(image.pixels[3].r == 256.0f); // rounds up over a power of two
    sheen_image_free(&image);
}

static void test_png_is_srgb_after_exposure(void **state)
{
    (void)state;
    Rgb pixels[height][width];
    SheenImage image;
    write_and_read(".png", 1.0f, pixels, &image);
    for (int i = 0; i < 3 * width * height; ++i) {
        float want = minf(2.0f * (&pixels[0][0].r)[i], 1.0f), got = (&image.pixels[0].r)[i];
        // Half a step of 1/255 in the encoded value.
        assert_true(fabsf(sheen_srgb_encode(got) - sheen_srgb_encode(want)) < 0.501f / 255.0f);
    }
    sheen_image_free(&image);
}

static void test_files_do_not_vary(void **state)
{
    (void)state;
    static const char *const endings[] = {".exr", ".hdr", ".pfm", ".png"};
    Rgb pixels[height][width];
    make_picture(pixels);
    SheenImageView view = {.width = width, .height = height, .pixels = &pixels[0][0]};
    for (int i = 0; i < 4; ++i) {
        static char content[2][65536];
        size_t size[2];
        for (int k = 0; k < 2; ++k) {
            char *path = temporary_path(endings[i]);
            assert_int_equal(sheen_image_write(path, &view, 0.0f, NULL), SHEEN_OK);
            FILE *file = fopen(path, "rb");
            assert_non_null(file);
            size[k] = fread(content[k], 1, sizeof content[k], file);
            fclose(file);
            unlink(path);
        }
        assert_true(size[0] > 100 && size[0] < sizeof content[0]);
        assert_int_equal(size[0], size[1]);
        assert_memory_equal(content[0], content[1], size[0]);
    }
}

/** Layers and attributes do not disturb the colour; what they hold is read as text from the file. */
static void test_exr_holds_layers_and_attributes(void **state)
{
    (void)state;
    Rgb pixels[height][width];
    make_picture(pixels);
    static float depth[height][width], normal[height][width][3];
    SheenLayer layers[] = {{"normal", 3, "XYZ", &normal[0][0][0]}, {"depth", 1, "Z", &depth[0][0]}};
    SheenAttribute attributes[] = {{"sheenSeed", "17"}, {"sheenAttributeWithAQuiteLongNameIndeed", "a = b"}};
    SheenImageView view = {width, height, &pixels[0][0], layers, 2, attributes, 2};
    char *path = temporary_path(".exr");
    assert_int_equal(sheen_image_write(path, &view, 0.0f, NULL), SHEEN_OK);
    SheenImage image;
    assert_int_equal(sheen_image_read(path, NULL, &image), SHEEN_OK);
    assert_memory_equal(image.pixels, pixels, sizeof pixels);
    sheen_image_free(&image);

    char head[2048] = {0};
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t n = fread(head, 1, sizeof head - 1, file);
    fclose(file);
    unlink(path);
    static const char *const in_order[] = {"channels", "B", "G", "R", "depth.Z", "normal.X", "normal.Y", "normal.Z"};
    const char *at = head;
    for (int i = 0; i < 8; ++i) {
        size_t length = strlen(in_order[i]) + 1; // with the zero behind the name
        at = memmem(at, n - (size_t)(at - head), in_order[i], length);
        assert_non_null(at);
        at += length;
    }
    assert_non_null(memmem(head, n,
                           "sheenSeed\0string\0\2\0\0\0"
                           "17",
                           22));
    assert_non_null(memmem(head, n, "sheenAttributeWithAQuiteLongNameIndeed", 39));
}

static void assert_layer(const SheenImageLayer *layer, const char *name, const char *first, const char *last)
{
    assert_string_equal(layer->name, name);
    assert_string_equal(layer->channels[0], first);
    assert_string_equal(layer->channels[layer->n_channels - 1], last);
}

/** Layers come back by the alphabet, the channels of colours as R, G, B. Other formats have none. */
static void test_layers_are_read(void **state)
{
    (void)state;
    Rgb pixels[height][width];
    make_picture(pixels);
    static float depth[height * width], normal[height * width * 3], albedo[height * width * 3];
    for (int i = 0; i < height * width; ++i) depth[i] = 0.37f * (float)i - 5.0f;
    for (int i = 0; i < height * width * 3; ++i) normal[i] = 1.0f / (float)(i + 1), albedo[i] = (float)(i % 3) + 0.01f;
    SheenLayer layers[] = {{"normal", 3, "XYZ", normal}, {"depth", 1, "Z", depth}, {"albedo", 3, "RGB", albedo}};
    SheenImageView view = {width, height, &pixels[0][0], layers, 3, NULL, 0};
    char *path = temporary_path(".exr");
    assert_int_equal(sheen_image_write(path, &view, 0.0f, NULL), SHEEN_OK);
    SheenImageLayers read;
    assert_int_equal(sheen_image_read_layers(path, NULL, &read), SHEEN_OK);
    unlink(path);
    assert_int_equal(read.n, 3);
    assert_true(read.width == width && read.height == height);
    assert_layer(&read.layers[0], "albedo", "albedo.R", "albedo.B");
    assert_layer(&read.layers[1], "depth", "depth.Z", "depth.Z");
    assert_layer(&read.layers[2], "normal", "normal.X", "normal.Z");
    assert_true(read.layers[0].color && !read.layers[1].color && !read.layers[2].color);
    assert_memory_equal(read.layers[0].data, albedo, sizeof albedo);
    assert_memory_equal(read.layers[1].data, depth, sizeof depth);
    assert_memory_equal(read.layers[2].data, normal, sizeof normal);
    sheen_image_layers_free(&read);
    path = temporary_path(".hdr");
    assert_int_equal(sheen_image_write(path, &view, 0.0f, NULL), SHEEN_OK);
    assert_int_equal(sheen_image_read_layers(path, NULL, &read), SHEEN_OK);
    assert_int_equal(read.n, 0);
    unlink(path);
}

/** However well a chunk compresses: noise of ever more bits, so that some end with as many bytes as they began with. */
static void test_exr_keeps_noise(void **state)
{
    (void)state;
    enum { W = 48, H = 16, N = W * H };
    static Rgb pixels[N];
    char *path = temporary_path(".exr");
    for (uint32_t round = 0; round < 400; ++round) {
        uint32_t x = 1 + round * 2654435761u;
        for (uint32_t i = 0; i < N; ++i) {
            float c[3];
            for (int k = 0; k < 3; ++k) {
                x ^= x << 13, x ^= x >> 17, x ^= x << 5;
                // The first bytes of some pixels repeat, those of the others do not.
                uint32_t bits = 0x3f000000u | (x & (i < round ? 0x000fffffu : 0x007fffffu));
                memcpy(&c[k], &bits, sizeof bits);
            }
            pixels[i] = rgb(c[0], c[1], c[2]);
        }
        const SheenImageView view = {.width = W, .height = H, .pixels = pixels};
        SheenImage image;
        assert_int_equal(sheen_image_write(path, &view, 0.0f, NULL), SHEEN_OK);
        assert_int_equal(sheen_image_read(path, NULL, &image), SHEEN_OK);
        if (memcmp(image.pixels, pixels, sizeof pixels) != 0) fail_msg("round %u differs", round);
        sheen_image_free(&image);
    }
    unlink(path);
}

static void test_srgb_curve(void **state)
{
    (void)state;
    // IEC 61966-2-1: both ends, the joint of the two pieces, and the inverse at all bytes.
    assert_true(sheen_srgb_encode(0.0f) == 0.0f && fabsf(sheen_srgb_encode(1.0f) - 1.0f) < 1e-6f);
    assert_true(fabsf(sheen_srgb_encode(0.0031308f) - 0.04045f) < 1e-5f);
    assert_true(fabsf(sheen_srgb_encode(0.5f) - 0.735357f) < 1e-5f);
    assert_true(sheen_srgb_encode(NAN) == 0.0f && sheen_srgb_encode(-1.0f) == 0.0f && sheen_srgb_decode(NAN) == 0.0f);
    for (int i = 0; i < 256; ++i)
        assert_int_equal((int)lrintf(255.0f * sheen_srgb_encode(sheen_srgb_decode((float)i / 255.0f))), i);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_float_formats_are_exact),
        cmocka_unit_test(test_hdr_keeps_eight_bits_of_the_largest),
        cmocka_unit_test(test_hdr_survives_all_numbers),
        cmocka_unit_test(test_png_is_srgb_after_exposure),
        cmocka_unit_test(test_files_do_not_vary),
        cmocka_unit_test(test_exr_holds_layers_and_attributes),
        cmocka_unit_test(test_layers_are_read),
        cmocka_unit_test(test_exr_keeps_noise),
        cmocka_unit_test(test_srgb_curve),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
