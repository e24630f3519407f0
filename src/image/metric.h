// SPDX-License-Identifier: Apache-2.0
// How far a picture is from its reference.
#ifndef SHEEN_IMAGE_METRIC_H
#define SHEEN_IMAGE_METRIC_H

#include "image/image.h"

/** All figures of `sheen compare`. Means over pixels and channels, x the image, r the reference. */
typedef struct SheenMetrics {
    double mse;                  // mean (x - r)^2
    double rmse;                 // its root
    double relmse;               // mean (x - r)^2 / (r^2 + 0.01)
    double mae;                  // mean |x - r|
    double psnr;                 // 10 log10(peak^2 / mse), dB; peak: see metric.c. Infinity for equal images
    double flip;                 // mean of HDR-FLIP
    double ssim;                 // mean structural similarity of tone-mapped luminance
    double bias;                 // mean(x) / mean(r) - 1
    uint64_t nonfinite;          // values of x or r that are NaN or infinite; left out of all figures
    double mean, reference_mean; // of x and of r
    double peak;                 // largest value of r, at least 0
} SheenMetrics;

/** Compares two images of one size. Errors: SHEEN_ERR_INVALID for different sizes, SHEEN_ERR_NOMEM. */
SHEEN_NODISCARD SheenStatus sheen_metrics_compute(const SheenImage *reference, const SheenImage *image,
                                                  const SheenLog *log, SheenMetrics *out);

/**
 * Flicker between two consecutive frames: mean over pixels and channels of |(x1 - x0) - (r1 - r0)| / (r0 + 0.1), where
 * a negative r0 counts as 0. Values that are not finite in any of the four are left out; NaN when none is left.
 * @param reference, image  two frames each, all of one size
 */
double sheen_metrics_flicker(const SheenImage reference[2], const SheenImage image[2]);

#endif
