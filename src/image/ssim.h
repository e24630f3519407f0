// SPDX-License-Identifier: Apache-2.0
// Structural similarity of two pictures. Source: wang2004.
#ifndef SHEEN_IMAGE_SSIM_H
#define SHEEN_IMAGE_SSIM_H

#include "image/image.h"

/**
 * Mean structural similarity of sRGB-encoded luminance, clamped to [0, 1], in a Gaussian window of 11 x 11 with a
 * standard deviation of 1.5. The mean goes over the pixels whose window lies inside of the picture; in a picture
 * smaller than the window over those in the middle, its border repeated.
 * @param reference, image  one size, finite
 * @param left_out          [height][width], nonzero where a pixel does not count; may be NULL
 * @param out               in [-1, 1]; NaN when no pixel counts
 * Errors: SHEEN_ERR_INVALID for different sizes, SHEEN_ERR_NOMEM.
 */
SHEEN_NODISCARD SheenStatus sheen_ssim_compute(const SheenImage *reference, const SheenImage *image,
                                               const uint8_t *left_out, const SheenLog *log, double *out);

#endif
