// SPDX-License-Identifier: Apache-2.0
// Which of a wave's uncovered points get a record: as few as if they were made one after another.
#ifndef SHEEN_INTEGRATOR_THIN_H
#define SHEEN_INTEGRATOR_THIN_H

#include "integrator/visibility.h"

/**
 * Walks the candidates in order and accepts each that no accepted one before it is expected to cover: one does when a
 * record with reach `spacing` at the candidate would hold it.
 * @param cell_px    largest spacing, pixels: only points within so many pixels are compared
 * @param width      of the picture, pixels
 * @param candidates [n] indices into points
 * @param spacing    [n] metres
 * @param a          [points] accuracy of a record there
 * @param accepted   [n] room for the accepted indices into points
 * Errors: SHEEN_ERR_NOMEM. Serial: its result is the order in which records are made.
 */
SHEEN_NODISCARD SheenStatus sheen_thin(float cell_px, uint32_t width, const ShadingPoint points[], size_t n,
                                       const uint32_t candidates[], const float spacing[], const float a[],
                                       uint32_t accepted[], size_t *n_accepted);

#endif
