// SPDX-License-Identifier: Apache-2.0
#include "image/yuv.h"

#include "image/image.h"

#include <stdlib.h>

static float brightness(Rgb c)
{
    return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b;
}

static uint8_t quantize(float zero, float range, float x)
{
    return (uint8_t)rintf(zero + range * x);
}

static void encode_row(const Rgb *from, uint32_t width, float scale, Rgb *to)
{
    for (uint32_t x = 0; x < width; ++x)
        to[x] = rgb(sheen_srgb_encode(scale * from[x].r), sheen_srgb_encode(scale * from[x].g),
                    sheen_srgb_encode(scale * from[x].b));
    if (width & 1u) to[width] = to[width - 1];
}

/** The colour of a pair of columns in two rows: a triangle about the left one, and both rows alike. */
static Rgb chroma_of(const Rgb *rows[2], uint32_t x)
{
    uint32_t left = x > 0 ? x - 1 : 0;
    Rgb sum = rgb_gray(0.0f);
    for (int i = 0; i < 2; ++i) {
        sum = rgb_mad(sum, 0.125f, rows[i][left]);
        sum = rgb_mad(sum, 0.25f, rows[i][x]);
        sum = rgb_mad(sum, 0.125f, rows[i][x + 1]);
    }
    return sum;
}

static void write_rows(const Rgb *rows[2], uint32_t width, uint32_t y, const SheenYuv *out)
{
    for (uint32_t i = 0; i < 2; ++i)
        for (uint32_t x = 0; x < width; ++x)
            out->plane[0][(y + i) * out->stride[0] + x] = quantize(16.0f, 219.0f, brightness(rows[i][x]));
    for (uint32_t x = 0; x < width; x += 2) {
        Rgb c = chroma_of(rows, x);
        float luma = brightness(c);
        out->plane[1][y / 2 * out->stride[1] + x / 2] = quantize(128.0f, 224.0f, (c.b - luma) / 1.8556f);
        out->plane[2][y / 2 * out->stride[2] + x / 2] = quantize(128.0f, 224.0f, (c.r - luma) / 1.5748f);
    }
}

SheenStatus sheen_yuv_encode(const Rgb *pixels, uint32_t width, uint32_t height, float exposure, const SheenYuv *out)
{
    size_t side = sheen_yuv_side(width);
    Rgb *buffer = malloc(2 * side * sizeof *buffer);
    if (!buffer) return SHEEN_ERR_NOMEM;
    float scale = clampf(exp2f(exposure), 0.0f, 0x1p126f);
    for (uint32_t y = 0; y < height; y += 2) {
        const Rgb *rows[2] = {buffer, y + 1 < height ? buffer + side : buffer};
        encode_row(pixels + (size_t)y * width, width, scale, buffer);
        if (y + 1 < height) encode_row(pixels + ((size_t)y + 1) * width, width, scale, buffer + side);
        write_rows(rows, (uint32_t)side, y, out);
    }
    free(buffer);
    return SHEEN_OK;
}
