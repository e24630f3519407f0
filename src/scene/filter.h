// SPDX-License-Identifier: Apache-2.0
// Reconstruction filters: how a pixel averages the light about its centre. All are products of one function of x and
// the same function of y.
#ifndef SHEEN_SCENE_FILTER_H
#define SHEEN_SCENE_FILTER_H

typedef enum SheenFilterKind {
    SHEEN_FILTER_UNSET, // nobody has said: a camera's is a box
    SHEEN_FILTER_BOX,
    SHEEN_FILTER_TENT,
    SHEEN_FILTER_GAUSSIAN,    // less its value at the radius, so that it ends there without a step
    SHEEN_FILTER_MITCHELL,    // the two-parameter cubics
    SHEEN_FILTER_CATMULL_ROM, // the one of them that interpolates: b = 0, c = 1/2
    SHEEN_FILTER_LANCZOS,     // sinc under the main lobe of a wider one; as many lobes to a side as its radius
    SHEEN_FILTER_KINDS
} SheenFilterKind;

typedef struct SheenFilter {
    SheenFilterKind kind;
    float radius; // zero from here on, pixels
    float stddev; // gaussian, pixels
    float b, c;   // cubics
} SheenFilter;

/**
 * @return a filter with the parameters that Mitsuba gives it: a box of one pixel, a tent of radius 1, a gaussian of
 *         stddev 0.5 to 4 of them, mitchell with b = c = 1/3, lanczos with 3 lobes; all zero for SHEEN_FILTER_UNSET
 */
SheenFilter sheen_filter_standard(SheenFilterKind kind);

/** A gaussian that ends after 4 standard deviations. @param stddev  pixels, positive */
SheenFilter sheen_filter_gaussian(float stddev);

/**
 * @param x  distance from the pixel's centre along one axis, pixels
 * @return the filter's value, not normalized; negative in side lobes of the cubics and of lanczos
 * Source: mitchell1988 (the cubics), jakob2022-mitsuba3 (how the others end). Pure, thread-safe.
 */
double sheen_filter_eval(const SheenFilter *filter, double x);

#endif
