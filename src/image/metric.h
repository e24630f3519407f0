// SPDX-License-Identifier: Apache-2.0
// How far a picture is from its reference.
#ifndef SHEEN_IMAGE_METRIC_H
#define SHEEN_IMAGE_METRIC_H

#include "image/image.h"

/** All figures of `sheen compare`. Means over pixels and channels, x the image, r the reference. */
typedef struct SheenMetrics {
    double mse;         // mean (x - r)^2
    double rmse;        // its root
    double relmse;      // mean (x - r)^2 / (r^2 + 0.01)
    double mae;         // mean |x - r|
    double psnr;        // 10 log10(peak^2 / mse), dB; peak: see metric.c. Infinity for equal images
    double flip;        // mean of HDR-FLIP
    double ssim;        // mean structural similarity of tone-mapped luminance
    double bias;        // mean(x) / mean(r) - 1
    uint64_t nonfinite; // values of x or r that are NaN or infinite; left out of all figures
} SheenMetrics;

/** Compares two images of one size. Errors: SHEEN_ERR_INVALID for different sizes, SHEEN_ERR_NOMEM. */
SHEEN_NODISCARD SheenStatus sheen_metrics_compute(const SheenImage *reference, const SheenImage *image,
                                                  const SheenLog *log, SheenMetrics *out);

#endif
