// SPDX-License-Identifier: Apache-2.0
// The picture of the cached integrators in the making: every pixel gets the same few samples first; where those of its
// neighbors scatter, it gets more.
#ifndef SHEEN_INTEGRATOR_PICTURE_H
#define SHEEN_INTEGRATOR_PICTURE_H

#include "integrator/work.h"

enum {
    SHEEN_NOISE_GROUPS = 4, // parts of a pixel's first samples that are told apart
    SHEEN_MORE_MAX = 15     // most further samples of a pixel, times the first
};

/** Sums over the samples of each pixel. */
typedef struct Picture {
    SheenFilm *film;   // borrowed; sums until sheen_picture_average
    uint32_t spp;      // first samples of each pixel
    uint32_t *samples; // [pixels] samples of each, the first included
    float *groups;     // [pixels][SHEEN_NOISE_GROUPS] luminance of groups of the first samples
    uint32_t *served;  // [pixels] shading points that records serve; NULL where no layer of them is wanted
} Picture;

/** @return false when out of memory */
bool sheen_picture_create(const SheenWork *work, SheenFilm *film, Picture *out);
void sheen_picture_free(Picture *picture);

/** Adds what a sample of a pixel found to the colour and to `aov`; non-finite values are counted and left out. */
void sheen_picture_add(Picture *picture, uint32_t pixel, uint32_t sample, Rgb value, SheenAov aov, SheenStats *stats);

/**
 * Decides how many samples each pixel needs for a standard error of `noise` times its brightness, dark pixels counting
 * as a quarter as bright as half of all. What the samples of a pixel may scatter by is told by its neighbors alone: a
 * decision by its own would make pixels that by chance missed what is bright stop early, and the picture too dark.
 * @param more  out: how many the pixels get beside the first, in all
 * @return false when out of memory
 */
bool sheen_picture_plan(float noise, Picture *picture, uint64_t *more);

/** Turns the sums into means: over samples, over the shading points served, or into shares; see SheenAov. */
void sheen_picture_average(Picture *picture);

#endif
