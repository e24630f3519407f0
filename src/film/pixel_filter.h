// SPDX-License-Identifier: Apache-2.0
// Filter importance sampling: the samples of a pixel lie as densely as its filter is high, so that each counts the same
// and belongs to its own pixel alone. Where the filter is below zero a sample counts negatively.
#ifndef SHEEN_FILM_PIXEL_FILTER_H
#define SHEEN_FILM_PIXEL_FILTER_H

#include "math/vec.h"
#include "scene/filter.h"

#include <stdbool.h>
#include <stdint.h>

/** Cells of the table of one half of an axis, and sign changes there, which make cells of their own. */
enum { SHEEN_PIXEL_FILTER_CELLS = 512, SHEEN_PIXEL_FILTER_ROOTS = 32 };

/** A filter made ready for drawing: the density |f| of a distance along an axis, linear within cells. */
typedef struct SheenPixelFilter {
    uint32_t n;                                                       // cells
    float x[SHEEN_PIXEL_FILTER_CELLS + SHEEN_PIXEL_FILTER_ROOTS + 1]; // their ends, pixels, from 0 to the radius
    float f[SHEEN_PIXEL_FILTER_CELLS + SHEEN_PIXEL_FILTER_ROOTS + 1]; // |f| there
    float cdf[SHEEN_PIXEL_FILTER_CELLS + SHEEN_PIXEL_FILTER_ROOTS + 1];
    bool negative[SHEEN_PIXEL_FILTER_CELLS + SHEEN_PIXEL_FILTER_ROOTS];
    uint16_t guide[SHEEN_PIXEL_FILTER_CELLS]; // [i] the cell where cdf reaches i / CELLS: the search begins there
    float gain;     // integral of |f| over that of f, of both axes: what a sample counts for but for the sign
    bool has_signs; // f is negative somewhere
} SheenPixelFilter;

/** @param filter  SHEEN_FILTER_UNSET is a box */
void sheen_pixel_filter_init(const SheenFilter *filter, SheenPixelFilter *out);

/**
 * Draws the place of a sample.
 * @param f         NULL for a box of one pixel
 * @param u         in [0, 1)^2; samples that are stratified there are stratified under the filter
 * @param negative  gets whether the sample counts negatively
 * @return in pixels from the upper left corner of the pixel; (0.5, 0.5) is the centre
 * Source: ernst2006-filter-importance-sampling. Pure, thread-safe.
 */
Vec2 sheen_pixel_filter_sample(const SheenPixelFilter *f, Vec2 u, bool *negative);

/**
 * What samples count for in the mean of a pixel's n samples, when n_negative of them are negative: [0] the others,
 * [1] the negative ones. These are gain and -gain, moved so far that the n weights have mean 1: a picture without
 * detail comes out without noise, and a single sample counts 1.
 * @param f  NULL for a box
 */
void sheen_pixel_filter_weights(const SheenPixelFilter *f, uint32_t n, uint32_t n_negative, double weight[2]);

#endif
