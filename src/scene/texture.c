// SPDX-License-Identifier: Apache-2.0
#include "scene/texture.h"

#include <stddef.h>

SheenTexture sheen_texture_constant(Rgb value)
{
    return (SheenTexture){
        .kind = SHEEN_TEXTURE_CONSTANT, .value = value, .scale = {1, 1, 1}, .uv = {{1, 0, 0}, {0, 1, 0}}};
}

void sheen_texture_scale(SheenTexture *t, Rgb factor)
{
    t->value = rgb_mul(t->value, factor);
    t->value2 = rgb_mul(t->value2, factor);
    t->scale = rgb_mul(t->scale, factor);
}

static Rgb texel(const SheenBitmap *b, uint32_t x, uint32_t y)
{
    size_t i = (size_t)y * b->width + x;
    if (b->floats) return b->floats[i];
    const uint8_t *c = b->bytes + 3 * i;
    return rgb(b->decode[c[0]], b->decode[c[1]], b->decode[c[2]]);
}

/** Folds a coordinate into [0, 1] (a period at most), so that any finite value fits an integer after scaling. */
static float fold(float t, SheenWrap wrap)
{
    if (!isfinite(t)) return 0.0f;
    switch (wrap) {
    case SHEEN_WRAP_REPEAT:
        return t - floorf(t);
    case SHEEN_WRAP_MIRROR:
        t = fabsf(t - 2.0f * floorf(0.5f * t + 0.5f)); // triangle wave of period 2: 0 at even, 1 at odd integers
        return minf(t, 1.0f);
    case SHEEN_WRAP_CLAMP:
        break;
    }
    return clampf(t, 0.0f, 1.0f);
}

/** Index of a texel in [-1, size], one step outside at most: wraps around or stays at the border. */
static uint32_t wrap_index(int64_t i, uint32_t size, SheenWrap wrap)
{
    if (i >= 0 && i < (int64_t)size) return (uint32_t)i;
    bool low = i < 0;
    if (wrap == SHEEN_WRAP_REPEAT) return low ? size - 1 : 0;
    return low ? 0 : size - 1; // mirroring repeats the border texel
}

static Rgb eval_bitmap(const SheenTexture *t, float u, float v)
{
    const SheenBitmap *b = &t->bitmap;
    // Rows run downward, v upward.
    float x = fold(u, t->wrap_u) * (float)b->width;
    float y = (1.0f - fold(v, t->wrap_v)) * (float)b->height;
    if (t->nearest) {
        // v on a texel border belongs to the texel above it, hence the ceiling.
        return texel(b, wrap_index((int64_t)floorf(x), b->width, t->wrap_u),
                     wrap_index((int64_t)ceilf(y) - 1, b->height, t->wrap_v));
    }
    x -= 0.5f, y -= 0.5f;
    float fx = floorf(x), fy = floorf(y), ax = x - fx, ay = y - fy;
    uint32_t x0 = wrap_index((int64_t)fx, b->width, t->wrap_u), x1 = wrap_index((int64_t)fx + 1, b->width, t->wrap_u);
    uint32_t y0 = wrap_index((int64_t)fy, b->height, t->wrap_v), y1 = wrap_index((int64_t)fy + 1, b->height, t->wrap_v);
    Rgb sum = rgb_scale(texel(b, x0, y0), (1.0f - ax) * (1.0f - ay));
    sum = rgb_mad(sum, ax * (1.0f - ay), texel(b, x1, y0));
    sum = rgb_mad(sum, (1.0f - ax) * ay, texel(b, x0, y1));
    return rgb_mad(sum, ax * ay, texel(b, x1, y1));
}

/** Whether a coordinate is near an integer. */
static bool on_line(const SheenTexture *t, float x)
{
    x = fold(x, SHEEN_WRAP_REPEAT);
    return minf(x, 1.0f - x) < t->line_width;
}

Rgb sheen_texture_eval(const SheenTexture *t, Vec2 uv)
{
    if (t->kind == SHEEN_TEXTURE_CONSTANT || sheen_texture_is_of_mesh(t)) return t->value;
    float u = t->uv[0][0] * uv.x + t->uv[0][1] * uv.y + t->uv[0][2];
    float v = t->uv[1][0] * uv.x + t->uv[1][1] * uv.y + t->uv[1][2];
    if (t->kind == SHEEN_TEXTURE_BITMAP) return rgb_mul(t->scale, eval_bitmap(t, u, v));
    if (t->kind == SHEEN_TEXTURE_GRID) return on_line(t, u) || on_line(t, v) ? t->value2 : t->value;
    // Two by two fields in the unit square; the first colour where both halves are the same.
    bool right = fold(u, SHEEN_WRAP_REPEAT) > 0.5f, top = fold(v, SHEEN_WRAP_REPEAT) > 0.5f;
    return right == top ? t->value : t->value2;
}

Vec2 sheen_texture_gradient(const SheenTexture *t, Vec2 uv)
{
    const SheenBitmap *b = &t->bitmap;
    if (t->kind != SHEEN_TEXTURE_BITMAP || t->nearest) return v2(0.0f, 0.0f);
    float u = t->uv[0][0] * uv.x + t->uv[0][1] * uv.y + t->uv[0][2];
    float v = t->uv[1][0] * uv.x + t->uv[1][1] * uv.y + t->uv[1][2];
    float x = fold(u, t->wrap_u) * (float)b->width - 0.5f, y = (1.0f - fold(v, t->wrap_v)) * (float)b->height - 0.5f;
    float fx = floorf(x), fy = floorf(y), ax = x - fx, ay = y - fy;
    uint32_t x0 = wrap_index((int64_t)fx, b->width, t->wrap_u), x1 = wrap_index((int64_t)fx + 1, b->width, t->wrap_u);
    uint32_t y0 = wrap_index((int64_t)fy, b->height, t->wrap_v), y1 = wrap_index((int64_t)fy + 1, b->height, t->wrap_v);
    Rgb k = t->scale;
    float a = rgb_luminance(rgb_mul(k, texel(b, x0, y0))), c = rgb_luminance(rgb_mul(k, texel(b, x1, y0)));
    float d = rgb_luminance(rgb_mul(k, texel(b, x0, y1))), e = rgb_luminance(rgb_mul(k, texel(b, x1, y1)));
    float du = lerpf(c - a, e - d, ay) * (float)b->width, dv = -lerpf(d - a, e - c, ax) * (float)b->height;
    // Odd periods of a mirrored texture run backward.
    if (t->wrap_u == SHEEN_WRAP_MIRROR && fmodf(fabsf(floorf(u)), 2.0f) == 1.0f) du = -du;
    if (t->wrap_v == SHEEN_WRAP_MIRROR && fmodf(fabsf(floorf(v)), 2.0f) == 1.0f) dv = -dv;
    return v2(du * t->uv[0][0] + dv * t->uv[1][0], du * t->uv[0][1] + dv * t->uv[1][1]);
}

static Rgb mean_of_bitmap(const SheenBitmap *b)
{
    double sum[3] = {0.0, 0.0, 0.0};
    for (uint32_t y = 0; y < b->height; ++y)
        for (uint32_t x = 0; x < b->width; ++x) {
            Rgb c = texel(b, x, y);
            sum[0] += (double)c.r, sum[1] += (double)c.g, sum[2] += (double)c.b;
        }
    double n = (double)b->width * (double)b->height;
    if (!(n > 0.0)) return rgb_gray(0.0f);
    return rgb((float)(sum[0] / n), (float)(sum[1] / n), (float)(sum[2] / n));
}

Rgb sheen_texture_mean(const SheenTexture *t)
{
    switch (t->kind) {
    case SHEEN_TEXTURE_CONSTANT:
    case SHEEN_TEXTURE_VERTEX_COLOR:
    case SHEEN_TEXTURE_FACE_COLOR:
        return t->value;
    case SHEEN_TEXTURE_BITMAP:
        return rgb_mul(t->scale, mean_of_bitmap(&t->bitmap));
    case SHEEN_TEXTURE_CHECKERBOARD:
        return rgb_scale(rgb_add(t->value, t->value2), 0.5f);
    case SHEEN_TEXTURE_GRID:
        break;
    }
    float side = maxf(1.0f - 2.0f * t->line_width, 0.0f), field = side * side;
    return rgb_mad(rgb_scale(t->value2, 1.0f - field), field, t->value);
}
