// SPDX-License-Identifier: Apache-2.0
#include "io/sky.h"

#include "io/spectrum.h"

#define PI 3.14159265358979323846
// Luminance, cd/m^2, of a constant spectrum of 1 W m^-2 sr^-1 nm^-1.
#define CANDELAS (683.0 * 106.86)

// ---- the sun's position -----------------------------------------------------------------------------------------

static int day_of_year(int year, int month, int day)
{
    static const int before[12] = {0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
    bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
    int m = month < 1 ? 1 : month > 12 ? 12 : month;
    return before[m - 1] + day + (leap && m > 2);
}

Vec3 sheen_sun_direction(const SheenSkyTime *time)
{
    // preetham1999, appendix A.6: the equation of time and the sun's declination.
    double j = day_of_year(time->year, time->month, time->day), latitude = time->latitude * (PI / 180.0);
    double solar = time->hour + 0.170 * sin(4.0 * PI * (j - 80.0) / 373.0) - 0.129 * sin(2.0 * PI * (j - 8.0) / 355.0) +
                   (time->longitude - 15.0 * time->timezone) / 15.0;
    double declination = 0.4093 * sin(2.0 * PI * (j - 81.0) / 368.0);
    double angle = PI * (solar - 12.0) / 12.0; // of the hour, positive in the afternoon
    double up = sin(latitude) * sin(declination) + cos(latitude) * cos(declination) * cos(angle);
    double north = cos(latitude) * sin(declination) - sin(latitude) * cos(declination) * cos(angle);
    double east = -cos(declination) * sin(angle);
    return v3_normalize(v3((float)east, (float)up, (float)-north));
}

// ---- the sky ----------------------------------------------------------------------------------------------------

// preetham1999, appendix A.2: slope and constant over the turbidity of Perez's A to E for luminance, x and y.
static const double distribution[3][5][2] = {
    {{0.1787, -1.4630}, {-0.3554, 0.4275}, {-0.0227, 5.3251}, {0.1206, -2.5771}, {-0.0670, 0.3703}},
    {{-0.0193, -0.2592}, {-0.0665, 0.0008}, {-0.0004, 0.2125}, {-0.0641, -0.8989}, {-0.0033, 0.0452}},
    {{-0.0167, -0.2608}, {-0.0950, 0.0092}, {-0.0079, 0.2102}, {-0.0441, -1.6537}, {-0.0109, 0.0529}},
};

// The same place: the zenith's x and y, powers 2 to 0 of the turbidity by powers 3 to 0 of the sun's angle.
static const double zenith_color[2][3][4] = {
    {{0.00166, -0.00375, 0.00209, 0.0}, {-0.02903, 0.06377, -0.03202, 0.00394}, {0.11693, -0.21196, 0.06052, 0.25886}},
    {{0.00275, -0.00610, 0.00317, 0.0}, {-0.04214, 0.08970, -0.04153, 0.00516}, {0.15346, -0.26756, 0.06670, 0.26688}},
};

double sheen_sky_zenith(double turbidity, double theta_sun)
{
    double chi = (4.0 / 9.0 - turbidity / 120.0) * (PI - 2.0 * theta_sun);
    double kilo = (4.0453 * turbidity - 4.9710) * tan(chi) - 0.2155 * turbidity + 2.4192;
    return kilo > 0.0 ? 1000.0 * kilo : 0.0;
}

static double chromaticity(const double m[3][4], double turbidity, double theta)
{
    double value = 0.0;
    for (int i = 0; i < 3; ++i)
        value = value * turbidity + ((m[i][0] * theta + m[i][1]) * theta + m[i][2]) * theta + m[i][3];
    return value;
}

static double perez(const double c[5], double cos_theta, double cos_gamma)
{
    cos_gamma = fmin(fmax(cos_gamma, -1.0), 1.0);
    double near_horizon = exp(c[1] / fmax(cos_theta, 1e-4)); // B < 0: goes to zero there
    return (1.0 + c[0] * near_horizon) * (1.0 + c[2] * exp(c[3] * acos(cos_gamma)) + c[4] * cos_gamma * cos_gamma);
}

SheenSky sheen_sky_make(double turbidity, double theta_sun)
{
    SheenSky sky;
    double zenith[3] = {sheen_sky_zenith(turbidity, theta_sun) / CANDELAS,
                        chromaticity(zenith_color[0], turbidity, theta_sun),
                        chromaticity(zenith_color[1], turbidity, theta_sun)};
    for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < 5; ++i) sky.coefficients[k][i] = distribution[k][i][0] * turbidity + distribution[k][i][1];
        sky.scale[k] = zenith[k] / perez(sky.coefficients[k], 1.0, cos(theta_sun));
    }
    return sky;
}

Rgb sheen_sky_radiance(const SheenSky *sky, double cos_theta, double cos_gamma)
{
    double v[3];
    if (!(cos_theta >= 0.0)) return rgb_gray(0.0f);
    for (int k = 0; k < 3; ++k) v[k] = sky->scale[k] * perez(sky->coefficients[k], cos_theta, cos_gamma);
    if (!(v[0] > 0.0 && v[2] > 1e-3)) return rgb_gray(0.0f);
    double X = v[1] / v[2] * v[0], Y = v[0], Z = (1.0 - v[1] - v[2]) / v[2] * v[0];
    // sRGB primaries, IEC 61966-2-1.
    return rgb(maxf((float)(3.2404542 * X - 1.5371385 * Y - 0.4985314 * Z), 0.0f),
               maxf((float)(-0.9692660 * X + 1.8760108 * Y + 0.0415560 * Z), 0.0f),
               maxf((float)(0.0556434 * X - 0.2040259 * Y + 1.0572252 * Z), 0.0f));
}

// ---- the sun ----------------------------------------------------------------------------------------------------

/** A black body of the sun's surface, W m^-2 sr^-1 nm^-1. Source: Planck's law. */
static double planck(double nanometres)
{
    const double h = 6.62607015e-34, c = 2.99792458e8, k = 1.380649e-23, kelvin = 5772.0;
    double lambda = nanometres * 1e-9;
    return 1e-9 * 2.0 * h * c * c / (pow(lambda, 5.0) * (exp(h * c / (lambda * k * kelvin)) - 1.0));
}

Rgb sheen_sun_irradiance(double turbidity, double theta_sun)
{
    enum { N = 48 }; // steps of 10 nm
    const double solid_angle = 6.79e-5;
    // preetham1999, appendix A.1: the way through the air, and what scatters there. Its ozone and gases, tables that
    // take some per cent more, are left out.
    double mass = 1.0 / (cos(theta_sun) + 0.15 * pow(93.885 - theta_sun * (180.0 / PI), -1.253));
    double beta = 0.04608 * turbidity - 0.04586;
    double lambda[N], value[N];
    for (int i = 0; i < N; ++i) {
        lambda[i] = 360.0 + 10.0 * i;
        double micrometres = lambda[i] * 1e-3;
        double rayleigh = 0.008735 * pow(micrometres, -4.08), haze = beta * pow(micrometres, -1.3);
        value[i] = solid_angle * planck(lambda[i]) * exp(-mass * (rayleigh + haze));
    }
    return sheen_spectrum_emission(&(SheenSpectrum){N, lambda, value});
}
