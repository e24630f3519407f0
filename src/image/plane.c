// SPDX-License-Identifier: Apache-2.0
#include "image/plane.h"

#include <stddef.h>
#include <string.h>

/** out += weight * in. Written so that the compiler makes vectors of it, as all the time of the metrics is here. */
static void add_scaled(const float *restrict in, float weight, uint32_t n, float *restrict out)
{
    for (uint32_t i = 0; i < n; ++i) out[i] += weight * in[i];
}

void sheen_plane_filter_x(const float *in, uint32_t width, uint32_t height, const PlaneFilter *filter, float *row,
                          float *out)
{
    uint32_t radius = (uint32_t)filter->radius;
    memset(out, 0, (size_t)width * height * sizeof *out);
    for (uint32_t y = 0; y < height; ++y) {
        const float *from = in + (size_t)y * width;
        for (uint32_t k = 0; k < radius; ++k) {
            row[k] = from[0];
            row[radius + width + k] = from[width - 1];
        }
        memcpy(row + radius, from, width * sizeof *row);
        for (uint32_t k = 0; k <= 2 * radius; ++k) add_scaled(row + k, filter->taps[k], width, out + (size_t)y * width);
    }
}

void sheen_plane_filter_y(const float *in, uint32_t width, uint32_t height, const PlaneFilter *filter, float *out)
{
    memset(out, 0, (size_t)width * height * sizeof *out);
    for (int64_t y = 0; y < height; ++y) {
        for (int k = -filter->radius; k <= filter->radius; ++k) {
            int64_t from = y + k < 0 ? 0 : y + k >= height ? (int64_t)height - 1 : y + k;
            add_scaled(in + from * width, filter->taps[filter->radius + k], width, out + y * width);
        }
    }
}
