// SPDX-License-Identifier: Apache-2.0
// One channel of a picture and separable filters on it. Inner header.
#ifndef SHEEN_IMAGE_PLANE_H
#define SHEEN_IMAGE_PLANE_H

#include <stdint.h>

enum { PLANE_MAX_RADIUS = 15 };

/** Weights at -radius .. radius. */
typedef struct PlaneFilter {
    int radius;
    float taps[2 * PLANE_MAX_RADIUS + 1];
} PlaneFilter;

/**
 * Filters along the rows: out[y][x] = sum_k taps[radius + k] in[y][x + k]. Beyond the border its pixels repeat.
 * @param in, out  [height][width], distinct
 * @param row      scratch, width + 2 PLANE_MAX_RADIUS floats
 */
void sheen_plane_filter_x(const float *in, uint32_t width, uint32_t height, const PlaneFilter *filter, float *row,
                          float *out);

/** The same along the columns. */
void sheen_plane_filter_y(const float *in, uint32_t width, uint32_t height, const PlaneFilter *filter, float *out);

#endif
