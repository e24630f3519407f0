// SPDX-License-Identifier: Apache-2.0
#include "io/spectrum.h"

/** Wavelengths of the sums, nanometres. */
enum { LAMBDA_MIN = 360, LAMBDA_MAX = 830 };

typedef struct Xyz {
    double x, y, z;
} Xyz;

static double lobe(double lambda, double peak, double left, double right)
{
    double t = (lambda - peak) / (lambda < peak ? left : right);
    return exp(-0.5 * t * t);
}

static Xyz matching(double l)
{
    return (Xyz){1.056 * lobe(l, 599.8, 37.9, 31.0) + 0.362 * lobe(l, 442.0, 16.0, 26.7) -
                     0.065 * lobe(l, 501.1, 20.4, 26.2),
                 0.821 * lobe(l, 568.8, 46.9, 40.5) + 0.286 * lobe(l, 530.9, 16.3, 31.1),
                 1.217 * lobe(l, 437.0, 11.8, 36.0) + 0.681 * lobe(l, 459.0, 26.0, 13.8)};
}

/** Relative power of the illuminant D65, 10 nm steps from 380 nm. Source: ISO/CIE 11664-2. */
static double d65(double lambda)
{
    static const double table[] = {49.9755, 54.6482, 82.7549, 91.486,  93.4318, 86.6823, 104.865, 117.008, 117.812,
                                   114.861, 115.923, 108.811, 109.354, 107.802, 104.79,  107.689, 104.405, 104.046,
                                   100.0,   96.3342, 95.788,  88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992,
                                   80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.349,  61.604,  69.8856,
                                   75.087,  63.5927, 46.4182, 66.8054, 63.3828};
    const int n = (int)(sizeof table / sizeof *table);
    double t = (lambda - 380.0) / 10.0;
    if (t < 0.0 || t > n - 1) return 0.0;
    int i = t < n - 2 ? (int)t : n - 2;
    return table[i] + (t - i) * (table[i + 1] - table[i]);
}

static double value_at(const SheenSpectrum *s, double lambda)
{
    if (s->n == 0 || lambda < s->lambda[0] || lambda > s->lambda[s->n - 1]) return 0.0;
    size_t lo = 0, hi = s->n - 1;
    while (hi - lo > 1) {
        size_t middle = lo + (hi - lo) / 2;
        if (s->lambda[middle] <= lambda)
            lo = middle;
        else
            hi = middle;
    }
    double width = s->lambda[hi] - s->lambda[lo];
    double t = width > 0.0 ? (lambda - s->lambda[lo]) / width : 0.0;
    return s->value[lo] + t * (s->value[hi] - s->value[lo]);
}

/** Adds one wavelength's share to the sums. */
static void add(Xyz *sum, double lambda, double value)
{
    Xyz m = matching(lambda);
    sum->x += value * m.x, sum->y += value * m.y, sum->z += value * m.z;
}

/** Source: IEC 61966-2-1. Not clamped. */
static void xyz_to_rgb(Xyz c, double out[3])
{
    out[0] = 3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z;
    out[1] = -0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z;
    out[2] = 0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z;
}

static Rgb clamped(const double c[3])
{
    return rgb((float)fmax(c[0], 0.0), (float)fmax(c[1], 0.0), (float)fmax(c[2], 0.0));
}

Rgb sheen_spectrum_emission(const SheenSpectrum *s)
{
    Xyz sum = {0, 0, 0}, one = {0, 0, 0};
    double c[3];
    for (int l = LAMBDA_MIN; l <= LAMBDA_MAX; ++l) {
        add(&sum, l, value_at(s, l));
        add(&one, l, 1.0);
    }
    xyz_to_rgb((Xyz){sum.x / one.y, sum.y / one.y, sum.z / one.y}, c);
    return clamped(c);
}

Rgb sheen_spectrum_reflectance(const SheenSpectrum *s)
{
    Xyz sum = {0, 0, 0}, white = {0, 0, 0};
    double c[3], w[3];
    for (int l = LAMBDA_MIN; l <= LAMBDA_MAX; ++l) {
        add(&sum, l, d65(l) * value_at(s, l));
        add(&white, l, d65(l));
    }
    xyz_to_rgb(sum, c);
    xyz_to_rgb(white, w);
    for (int i = 0; i < 3; ++i) c[i] /= w[i]; // the fit's white is not quite sRGB's
    return clamped(c);
}

Rgb sheen_spectrum_blackbody(double temperature)
{
    const double h = 6.62607015e-34, light = 2.99792458e8, k = 1.380649e-23;
    enum { N = LAMBDA_MAX - LAMBDA_MIN + 1 };
    double lambda[N], value[N];
    for (int i = 0; i < N; ++i) {
        lambda[i] = LAMBDA_MIN + i;
        double l = 1e-9 * lambda[i];
        value[i] = 1e-9 * 2.0 * h * light * light / (l * l * l * l * l * expm1(h * light / (l * k * temperature)));
    }
    return sheen_spectrum_emission(&(SheenSpectrum){N, lambda, value});
}
