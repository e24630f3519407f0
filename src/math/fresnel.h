// SPDX-License-Identifier: Apache-2.0
// How much light an interface between two media reflects. Unpolarized: the mean of both polarizations.
#ifndef SHEEN_MATH_FRESNEL_H
#define SHEEN_MATH_FRESNEL_H

#include "math/vec.h"

/** Reflectance of a smooth dielectric. eta: interior over exterior; cos_i > 0 from outside, < 0 from inside.
 *  *cos_t: cosine of the refracted direction on the other side, sign opposite to cos_i; 0 at total reflection. */
float sheen_fresnel_dielectric(float cos_i, float eta, float *cos_t);

/** Reflectance of a smooth conductor of relative index eta + i k, for cos_i in [0, 1], one channel. */
float sheen_fresnel_conductor(float cos_i, float eta, float k);

/** The same for all channels. */
static inline Rgb fresnel_conductor_rgb(float cos_i, Rgb eta, Rgb k)
{
    return rgb(sheen_fresnel_conductor(cos_i, eta.r, k.r), sheen_fresnel_conductor(cos_i, eta.g, k.g),
               sheen_fresnel_conductor(cos_i, eta.b, k.b));
}

/**
 * @param eta  index beyond the interface over that on the light's side; < 1 for light from within
 * @return reflectance of a smooth dielectric for light that arrives alike from everywhere: 2 int F(c) c dc, to 1e-5
 */
float sheen_fresnel_diffuse(float eta);

#endif
