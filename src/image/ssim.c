// SPDX-License-Identifier: Apache-2.0
#include "image/ssim.h"

#include "image/plane.h"

#include <stdlib.h>

enum { window_radius = 5, n_planes = 8 };

static PlaneFilter make_window(void)
{
    PlaneFilter f = {.radius = window_radius};
    float sum = 0.0f;
    for (int i = -window_radius; i <= window_radius; ++i)
        sum += f.taps[window_radius + i] = expf(-(float)(i * i) / (2.0f * 1.5f * 1.5f));
    for (int i = 0; i <= 2 * window_radius; ++i) f.taps[i] /= sum;
    return f;
}

static float tone_mapped_luminance(Rgb c)
{
    return sheen_srgb_encode(0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b);
}

/** Similarity of one window. Source: wang2004, eq. (13), K1 = 0.01, K2 = 0.03, L = 1. */
static double similarity(double mx, double my, double xx, double yy, double xy)
{
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    double vx = xx - mx * mx, vy = yy - my * my, cov = xy - mx * my;
    return (2.0 * mx * my + c1) * (2.0 * cov + c2) / ((mx * mx + my * my + c1) * (vx + vy + c2));
}

SheenStatus sheen_ssim_compute(const SheenImage *reference, const SheenImage *image, const uint8_t *left_out,
                               const SheenLog *log, double *out)
{
    *out = 0.0;
    uint32_t width = reference->width, height = reference->height;
    if (width != image->width || height != image->height)
        return sheen_fail(log, SHEEN_ERR_INVALID, "pictures of different sizes cannot be compared");
    size_t n = (size_t)width * height;
    float *memory = malloc((n_planes * n + width + 2 * PLANE_MAX_RADIUS) * sizeof *memory);
    if (!memory) return sheen_fail(log, SHEEN_ERR_NOMEM, "comparing two pictures: out of memory");
    // Local means of x, y, x^2, y^2 and x y, in this order.
    float *mean[5], *x = memory + 5 * n, *y = memory + 6 * n, *product = memory + 7 * n, *row = memory + 8 * n;
    for (size_t i = 0; i < n; ++i) {
        x[i] = tone_mapped_luminance(image->pixels[i]);
        y[i] = tone_mapped_luminance(reference->pixels[i]);
    }
    const float *const factors[5][2] = {{x, NULL}, {y, NULL}, {x, x}, {y, y}, {x, y}};
    PlaneFilter window = make_window();
    for (int k = 0; k < 5; ++k) {
        mean[k] = memory + (size_t)k * n;
        for (size_t i = 0; i < n; ++i)
            product[i] = factors[k][1] ? factors[k][0][i] * factors[k][1][i] : factors[k][0][i];
        // The last plane is free as the rows' result: product is read before.
        sheen_plane_filter_x(product, width, height, &window, row, mean[k]);
        sheen_plane_filter_y(mean[k], width, height, &window, product);
        for (size_t i = 0; i < n; ++i) mean[k][i] = product[i];
    }
    uint32_t mx = width > 2 * window_radius ? window_radius : (width - 1) / 2;
    uint32_t my = height > 2 * window_radius ? window_radius : (height - 1) / 2;
    double sum = 0.0;
    uint64_t count = 0;
    for (uint32_t v = my; v < height - my; ++v) {
        for (uint32_t u = mx; u < width - mx; ++u) {
            size_t i = (size_t)v * width + u;
            if (left_out && left_out[i]) continue;
            sum += similarity((double)mean[0][i], (double)mean[1][i], (double)mean[2][i], (double)mean[3][i],
                              (double)mean[4][i]);
            ++count;
        }
    }
    free(memory);
    *out = count > 0 ? sum / (double)count : (double)NAN;
    return SHEEN_OK;
}
