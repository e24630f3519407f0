// SPDX-License-Identifier: Apache-2.0
// The clear sky and its sun: luminance and colour by the angles, after preetham1999.
#ifndef SHEEN_IO_SKY_H
#define SHEEN_IO_SKY_H

#include "math/vec.h"

/** Haze for which the model was fitted: 2 is very clear, 10 hazy. */
#define SHEEN_TURBIDITY_MIN 2.0
#define SHEEN_TURBIDITY_MAX 10.0

/** Width of the sun as seen from the Earth, degrees. */
#define SHEEN_SUN_WIDTH 0.5358

/** A place and a time, for the sun's position. */
typedef struct SheenSkyTime {
    double latitude, longitude; // degrees, north and east positive
    double timezone;            // hours ahead of UTC
    int year, month, day;
    double hour; // of the clock there, with its fraction
} SheenSkyTime;

/** @return the unit direction to the sun as x east, y up, z south; good to about half a degree. */
Vec3 sheen_sun_direction(const SheenSkyTime *time);

/**
 * @param turbidity  in [SHEEN_TURBIDITY_MIN, SHEEN_TURBIDITY_MAX]
 * @param theta_sun  angle between the zenith and the sun, radians, in [0, pi / 2]
 * @return luminance of the zenith, cd/m^2
 */
double sheen_sky_zenith(double turbidity, double theta_sun);

/** The sky for one place of the sun, ready to be looked at. */
typedef struct SheenSky {
    double coefficients[3][5]; // of Perez's function, for luminance and chromaticities x and y
    double scale[3];           // W m^-2 sr^-1 nm^-1 for the luminance
} SheenSky;

SheenSky sheen_sky_make(double turbidity, double theta_sun);

/**
 * Radiance, W m^-2 sr^-1 nm^-1: the luminance over 683 lm/W and the integral of the luminosity function, 106.86 nm.
 * @param cos_theta  of the angle to the zenith; nothing comes from below the horizon
 * @param cos_gamma  of the angle to the sun
 */
Rgb sheen_sky_radiance(const SheenSky *sky, double cos_theta, double cos_gamma);

/** @return what the sun sends through the air onto a surface that faces it, W m^-2 nm^-1. */
Rgb sheen_sun_irradiance(double turbidity, double theta_sun);

#endif
