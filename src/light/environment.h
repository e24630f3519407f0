// SPDX-License-Identifier: Apache-2.0
// The light of an environment image: lookup, and directions drawn in proportion to it.
#ifndef SHEEN_LIGHT_ENVIRONMENT_H
#define SHEEN_LIGHT_ENVIRONMENT_H

#include "base/arena.h"
#include "light/light.h"

/**
 * Draws directions in proportion to the luminance of an environment above a threshold. The pixels span a grid of cells
 * with a pixel at each corner, within which the radiance is bilinear; so is the density, but for the sine of the polar
 * angle, so that it is nowhere zero where there is radiance above the threshold.
 */
typedef struct EnvironmentSampler {
    const SheenLight *light;
    float threshold;         // luminance that is not sampled; W m^-2 sr^-1
    uint32_t n_rows, n_cols; // cells; none for a constant environment
    double *row_cdf;         // [n_rows + 1], from 0 to 1
    double *col_cdf;         // [n_rows][n_cols + 1], each from 0 to 1
    double weight;           // sum over the cells of mean luminance times sine
    float flux;              // integral over the sphere of what is sampled, mean of the channels
    Vec3 flux_vector;        // the same of radiance times direction
} EnvironmentSampler;

/**
 * @param light  environment light, borrowed
 * @param arena  gets the tables
 * The flux is 0 when nothing is above the threshold. Errors: SHEEN_ERR_NOMEM.
 */
SHEEN_NODISCARD SheenStatus sheen_environment_sampler_init(const SheenLight *light, SheenEnvironmentSplit split,
                                                           SheenArena *arena, EnvironmentSampler *out);

/** @return false when nothing arrives. `radiance` is the sampled part of it, not divided by the pdf. */
bool sheen_environment_sampler_sample(const EnvironmentSampler *e, Vec2 u, Vec3 *wi, Rgb *radiance, float *pdf);

/** @return the density of wi, 1/sr. */
float sheen_environment_sampler_pdf(const EnvironmentSampler *e, Vec3 wi);

/** @return radiance of an environment light along wi (unit). */
Rgb sheen_environment_radiance(const SheenLight *light, Vec3 wi);

#endif
