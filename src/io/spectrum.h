// SPDX-License-Identifier: Apache-2.0
// Sampled spectra folded to linear sRGB.
#ifndef SHEEN_IO_SPECTRUM_H
#define SHEEN_IO_SPECTRUM_H

#include "math/vec.h"

#include <stddef.h>

/** Values at wavelengths, nanometres, in rising order; linear between them, zero outside. */
typedef struct SheenSpectrum {
    size_t n;
    const double *lambda, *value;
} SheenSpectrum;

/**
 * Colour of a spectrum that shines, or of a refractive index: the CIE 1931 tristimulus values, scaled so that a
 * constant spectrum 1 has the luminance 1, in sRGB primaries. A constant spectrum comes out reddish, as sRGB's white is
 * D65. Negative channels, outside the gamut, become 0.
 * Source: the matching functions are the multi-lobe fit of wyman2013-cie, eq. (4), good to about 1 %.
 */
Rgb sheen_spectrum_emission(const SheenSpectrum *s);

/** Colour of a reflectance under D65: a constant spectrum c has exactly the colour (c, c, c). Clamped below at 0. */
Rgb sheen_spectrum_reflectance(const SheenSpectrum *s);

/** Colour of a black body's radiance, W m^-2 sr^-1 nm^-1, at a temperature in kelvin (> 0). Source: Planck's law. */
Rgb sheen_spectrum_blackbody(double temperature);

#endif
