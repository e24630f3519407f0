// SPDX-License-Identifier: Apache-2.0
// HDR-FLIP: the difference that a viewer sees who flips between two pictures. Source: andersson2020, andersson2021.
#ifndef SHEEN_IMAGE_FLIP_H
#define SHEEN_IMAGE_FLIP_H

#include "image/image.h"

/** The exposures at which the pictures are looked at, in stops, from the first to the last in equal steps. */
typedef struct SheenFlipExposures {
    float start, stop;
    unsigned count;
} SheenFlipExposures;

/**
 * Exposures between which all of the reference is neither black nor white.
 * @param reference  finite; a black one gives one exposure of 0
 * Errors: SHEEN_ERR_NOMEM. Source: andersson2021
 */
SHEEN_NODISCARD SheenStatus sheen_flip_exposures(const SheenImage *reference, const SheenLog *log,
                                                 SheenFlipExposures *out);

/**
 * The error of each pixel: the largest of LDR-FLIP over the exposures, tone-mapped after ACES, at 0.7 m from a monitor
 * of 0.7 m with 3840 pixels (67.02 pixels a degree).
 * @param reference, image  one size, finite
 * @param map               [height][width], in [0, 1]
 * Errors: SHEEN_ERR_INVALID for different sizes, SHEEN_ERR_NOMEM.
 */
SHEEN_NODISCARD SheenStatus sheen_flip_compute(const SheenImage *reference, const SheenImage *image,
                                               const SheenFlipExposures *exposures, const SheenLog *log, float *map);

#endif
