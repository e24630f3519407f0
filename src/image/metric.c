// SPDX-License-Identifier: Apache-2.0
// The figures of `sheen compare`. The peak of the PSNR is the largest value of the reference.
#include "image/metric.h"

#include "image/flip.h"
#include "image/ssim.h"

#include <stdlib.h>

/** Sums over the values that are finite in both pictures. */
typedef struct Sums {
    double square, relative, absolute, x, r;
    float peak;
    uint64_t n, nonfinite;
} Sums;

static void add_values(const SheenImage *reference, const SheenImage *image, Sums *s)
{
    const float *r = &reference->pixels->r, *x = &image->pixels->r;
    size_t n = (size_t)image->width * image->height * 3;
    for (size_t i = 0; i < n; ++i) {
        if (!isfinite(x[i]) || !isfinite(r[i])) {
            ++s->nonfinite;
            continue;
        }
        double ref = (double)r[i], d = (double)x[i] - ref;
        s->square += d * d;
        s->relative += d * d / (ref * ref + 0.01);
        s->absolute += fabs(d);
        s->x += (double)x[i];
        s->r += ref;
        s->peak = maxf(s->peak, r[i]);
        ++s->n;
    }
}

/** Copies of both pictures in which a pixel that is not finite in either is black, for the filters. */
typedef struct FinitePair {
    SheenImage reference, image;
    uint8_t *left_out; // [height][width], 1 where a pixel was not finite
    uint64_t n_left;   // pixels that count
} FinitePair;

static void pair_free(FinitePair *pair)
{
    sheen_image_free(&pair->reference);
    sheen_image_free(&pair->image);
    free(pair->left_out);
}

static bool pixel_finite(Rgb c)
{
    return isfinite(c.r) && isfinite(c.g) && isfinite(c.b);
}

static bool pair_create(const SheenImage *reference, const SheenImage *image, FinitePair *pair)
{
    size_t n = (size_t)image->width * image->height;
    *pair = (FinitePair){.reference = *reference, .image = *image, .left_out = calloc(n, 1)};
    pair->reference.pixels = calloc(n, sizeof(Rgb));
    pair->image.pixels = calloc(n, sizeof(Rgb));
    if (!pair->left_out || !pair->reference.pixels || !pair->image.pixels) return false;
    for (size_t i = 0; i < n; ++i) {
        if (!pixel_finite(reference->pixels[i]) || !pixel_finite(image->pixels[i])) {
            pair->left_out[i] = 1;
            continue;
        }
        pair->reference.pixels[i] = reference->pixels[i];
        pair->image.pixels[i] = image->pixels[i];
        ++pair->n_left;
    }
    return true;
}

static SheenStatus flip_mean(const FinitePair *pair, const SheenLog *log, double *out)
{
    size_t n = (size_t)pair->image.width * pair->image.height;
    float *map = malloc(n * sizeof *map);
    if (!map) return sheen_fail(log, SHEEN_ERR_NOMEM, "comparing two pictures: out of memory");
    SheenFlipExposures exposures;
    SheenStatus status = sheen_flip_exposures(&pair->reference, log, &exposures);
    if (!status) status = sheen_flip_compute(&pair->reference, &pair->image, &exposures, log, map);
    double sum = 0.0;
    for (size_t i = 0; !status && i < n; ++i) sum += pair->left_out[i] ? 0.0 : (double)map[i];
    free(map);
    *out = pair->n_left > 0 ? sum / (double)pair->n_left : (double)NAN;
    return status;
}

SheenStatus sheen_metrics_compute(const SheenImage *reference, const SheenImage *image, const SheenLog *log,
                                  SheenMetrics *out)
{
    *out = (SheenMetrics){0};
    if (reference->width != image->width || reference->height != image->height || image->width == 0 ||
        image->height == 0)
        return sheen_fail(log, SHEEN_ERR_INVALID, "a picture of %u x %u pixels cannot be compared with one of %u x %u",
                          image->width, image->height, reference->width, reference->height);
    Sums s = {0};
    add_values(reference, image, &s);
    FinitePair pair;
    SheenStatus status = SHEEN_OK;
    if (!pair_create(reference, image, &pair))
        status = sheen_fail(log, SHEEN_ERR_NOMEM, "comparing two pictures: out of memory");
    SheenMetrics m = {.nonfinite = s.nonfinite};
    if (!status) status = flip_mean(&pair, log, &m.flip);
    if (!status) status = sheen_ssim_compute(&pair.reference, &pair.image, pair.left_out, log, &m.ssim);
    pair_free(&pair);
    if (status) return status;
    double n = (double)s.n; // 0 makes all figures NaN: nothing was compared
    m.mse = s.square / n;
    m.rmse = sqrt(m.mse);
    m.relmse = s.relative / n;
    m.mae = s.absolute / n;
    m.psnr = 10.0 * log10((double)s.peak * (double)s.peak / m.mse);
    m.bias = s.x == s.r && s.n > 0 ? 0.0 : s.x / s.r - 1.0; // black equals black
    m.mean = s.x / n;
    m.reference_mean = s.r / n;
    m.peak = (double)s.peak;
    *out = m;
    return SHEEN_OK;
}

double sheen_metrics_flicker(const SheenImage reference[2], const SheenImage image[2])
{
    const float *r0 = &reference[0].pixels->r, *r1 = &reference[1].pixels->r;
    const float *x0 = &image[0].pixels->r, *x1 = &image[1].pixels->r;
    size_t n = (size_t)image->width * image->height * 3;
    double sum = 0.0;
    uint64_t count = 0;
    for (size_t i = 0; i < n; ++i) {
        double change = ((double)x1[i] - (double)x0[i]) - ((double)r1[i] - (double)r0[i]);
        if (!isfinite(change)) continue;
        sum += fabs(change) / ((double)maxf(r0[i], 0.0f) + 0.1);
        ++count;
    }
    return sum / (double)count;
}
