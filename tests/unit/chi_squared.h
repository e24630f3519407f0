// SPDX-License-Identifier: Apache-2.0
// Does a sampler draw from the density that it claims? Pearson's chi-squared test over bins.
#ifndef SHEEN_TESTS_UNIT_CHI_SQUARED_H
#define SHEEN_TESTS_UNIT_CHI_SQUARED_H

#include <math.h>
#include <stddef.h>

/**
 * @param observed  [n_bins] counts
 * @param expected  [n_bins] counts; bins that expect fewer than 10 are pooled
 * @return how many standard deviations the statistic lies above what chance gives, by the cube root transformation that
 *         makes chi-squared nearly normal. Source: wilson1931
 */
static inline double chi_squared_deviation(size_t n_bins, const double observed[], const double expected[])
{
    double chi2 = 0.0, pool_observed = 0.0, pool_expected = 0.0, freedom = -1.0;
    for (size_t i = 0; i < n_bins; ++i) {
        if (expected[i] < 10.0) {
            pool_observed += observed[i];
            pool_expected += expected[i];
            continue;
        }
        chi2 += (observed[i] - expected[i]) * (observed[i] - expected[i]) / expected[i];
        freedom += 1.0;
    }
    if (pool_expected > 0.5) {
        chi2 += (pool_observed - pool_expected) * (pool_observed - pool_expected) / pool_expected;
        freedom += 1.0;
    } else if (pool_observed > 5.0) {
        return INFINITY; // samples where there should be none
    }
    if (freedom < 1.0) return chi2 > 1e-6 ? INFINITY : 0.0;
    double v = 2.0 / (9.0 * freedom);
    return (cbrt(chi2 / freedom) - (1.0 - v)) / sqrt(v);
}

/** Significance: 1 in 30,000 for one test. There are some fifty, with fixed seeds. */
#define CHI_SQUARED_LIMIT 4.0

#endif
