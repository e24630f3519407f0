// SPDX-License-Identifier: Apache-2.0
#include "basis/rotation.h"

#include "basis/rotation_tables.h"

#include <stdlib.h>

struct SheenRotation {
    SheenBasis basis;
    unsigned n;
    SheenQuarter quarter; // of spherical functions
    SheenTilt tilt;       // of hemispherical ones
};

// R is found column by column and row by row: gamma and beta from its last column, then alpha from the second row of
// Rz(-gamma) R = Ry(beta) Rz(alpha), which is (sin(alpha), cos(alpha), 0). Near a tilt of 0 or pi, where only the sum
// or the difference of alpha and gamma is determined, that makes alpha whatever fits the gamma found.
SheenEuler sheen_euler_between(const Frame *from, const Frame *to)
{
    Vec3 column = frame_to_local(to, from->n);
    float s = sqrtf(column.x * column.x + column.y * column.y);
    Vec2 gamma = s > 0.0f ? v2(column.x / s, column.y / s) : v2(1.0f, 0.0f);
    Vec3 y = v3_mad(v3_scale(to->b, gamma.x), -gamma.y, to->t); // to's y axis turned by gamma, in the world
    return (SheenEuler){v2(v3_dot(y, from->b), v3_dot(y, from->t)), v2(column.z, s), gamma};
}

// With a constant number of channels, the innermost loop is none.
static inline void turn(unsigned n, const float c[], const float s[], unsigned channels, const float in[], float out[])
{
    for (unsigned l = 0; l < n; ++l) {
        const float *from = in + basis_index(l, 0) * channels;
        float *to = out + basis_index(l, 0) * channels;
        for (unsigned k = 0; k < channels; ++k) to[k] = from[k];
        for (unsigned m = 1; m <= l; ++m)
            for (unsigned k = 0; k < channels; ++k) {
                ptrdiff_t minus = (ptrdiff_t)k - (ptrdiff_t)(m * channels);
                float p = from[m * channels + k], q = from[minus];
                to[m * channels + k] = p * c[m] - q * s[m];
                to[minus] = p * s[m] + q * c[m];
            }
    }
}

void sheen_rotate_z(unsigned n, Vec2 angle, unsigned channels, const float in[], float out[])
{
    float c[SHEEN_ORDER_MAX], s[SHEEN_ORDER_MAX];
    rotation_powers(n, angle, c, s);
    if (channels == 1)
        turn(n, c, s, 1, in, out);
    else if (channels == 3)
        turn(n, c, s, 3, in, out);
    else
        turn(n, c, s, channels, in, out);
}

SheenStatus sheen_rotation_create(SheenBasis basis, unsigned n, float tilt_max, SheenRotation **out)
{
    *out = NULL;
    if (n < 1 || n > (basis == SHEEN_BASIS_SH ? SHEEN_ORDER_MAX : SHEEN_TILT_ORDER_MAX)) return SHEEN_ERR_INVALID;
    SheenRotation *r = calloc(1, sizeof *r);
    if (!r) return SHEEN_ERR_NOMEM;
    r->basis = basis;
    r->n = n;
    SheenStatus status =
        basis == SHEEN_BASIS_SH ? sheen_quarter_create(n, &r->quarter) : sheen_tilt_create(n, tilt_max, &r->tilt);
    if (status == SHEEN_OK)
        *out = r;
    else
        sheen_rotation_destroy(&r);
    return status;
}

void sheen_rotation_destroy(SheenRotation **rotation)
{
    if (!rotation || !*rotation) return;
    free((*rotation)->quarter.matrix);
    free((*rotation)->tilt.matrix);
    free(*rotation);
    *rotation = NULL;
}

void sheen_rotation_apply(const SheenRotation *r, SheenEuler e, unsigned channels, const float in[], float out[])
{
    if (r->basis == SHEEN_BASIS_SH) {
        for (unsigned k = 0; k < channels; ++k) sheen_quarter_rotate(&r->quarter, r->n, &e, channels, in + k, out + k);
        return;
    }
    sheen_rotate_z(r->n, e.alpha, channels, in, out);
    for (unsigned k = 0; k < channels; ++k) sheen_tilt_rotate(&r->tilt, r->n, e.beta, channels, out + k);
    sheen_rotate_z(r->n, e.gamma, channels, out, out);
}
