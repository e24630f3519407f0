// SPDX-License-Identifier: Apache-2.0
// What the two bases do about a tilt.
#ifndef SHEEN_BASIS_ROTATION_TABLES_H
#define SHEEN_BASIS_ROTATION_TABLES_H

#include "basis/rotation.h"

/** Cosines and sines of m times an angle, m = 0 .. n - 1. */
static inline void rotation_powers(unsigned n, Vec2 angle, float c[], float s[])
{
    c[0] = 1.0f;
    s[0] = 0.0f;
    for (unsigned m = 1; m < n; ++m) {
        c[m] = c[m - 1] * angle.x - s[m - 1] * angle.y;
        s[m] = c[m - 1] * angle.y + s[m - 1] * angle.x;
    }
}

/** Matrices of quarter turns about y: a tilt is two of these among three turns about z. */
typedef struct SheenQuarter {
    float *matrix;
} SheenQuarter;

SHEEN_NODISCARD SheenStatus sheen_quarter_create(unsigned n, SheenQuarter *out);
/** @param in, out  [n * n] with a stride; may be the same */
void sheen_quarter_rotate(const SheenQuarter *q, unsigned n, const SheenEuler *e, unsigned stride, const float in[],
                          float out[]);

/** Matrices of hemispherical functions that are tilted, for each degree from 0. */
typedef struct SheenTilt {
    float *matrix;
    unsigned degrees;
} SheenTilt;

SHEEN_NODISCARD SheenStatus sheen_tilt_create(unsigned n, float tilt_max, SheenTilt *out);
/** Rotates about y. @param x  [n * n] with a stride, in place */
void sheen_tilt_rotate(const SheenTilt *t, unsigned n, Vec2 beta, unsigned stride, float x[]);

#endif
