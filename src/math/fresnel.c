// SPDX-License-Identifier: Apache-2.0
#include "math/fresnel.h"

// Source: born1999, sec. 1.5.2.
float sheen_fresnel_dielectric(float cos_i, float eta, float *cos_t)
{
    *cos_t = -cos_i;
    if (eta == 1.0f) return 0.0f;                     // exactly, so that light passes straight through
    float relative = cos_i > 0.0f ? eta : 1.0f / eta; // index beyond over index on the side of the ray
    float c = minf(fabsf(cos_i), 1.0f);
    float c_t2 = (relative * relative - 1.0f + c * c) / (relative * relative);
    *cos_t = 0.0f;
    if (!(c_t2 > 0.0f)) return 1.0f; // total reflection; also an index that is no index
    float c_t = sqrtf(c_t2);
    *cos_t = cos_i > 0.0f ? -c_t : c_t;
    float s = (c - relative * c_t) / (c + relative * c_t);
    float p = (relative * c - c_t) / (relative * c + c_t);
    return minf(0.5f * (s * s + p * p), 1.0f);
}

// With eta_t cos_t = a + i b: a^2 + b^2 is `m`, and the moduli of both amplitudes follow without complex numbers.
// Source: born1999, sec. 14.2; in this form lagarde2013-fresnel.
float sheen_fresnel_conductor(float cos_i, float eta, float k)
{
    float c2 = cos_i * cos_i, s2 = 1.0f - c2;
    float t = eta * eta - k * k - s2;
    float m = sqrtf(t * t + 4.0f * eta * eta * k * k);
    float a2c = 2.0f * cos_i * safe_sqrtf(0.5f * (m + t));
    float rs = (m + c2 - a2c) / (m + c2 + a2c);
    float p = c2 * m + s2 * s2, q = a2c * s2;
    float rp = rs * (p - q) / (p + q);
    float r = 0.5f * (rs + rp);
    return r >= 0.0f && r <= 1.0f ? r : 1.0f; // 0 / 0 of a metal without index, infinite indices
}

// By the midpoint rule. Beyond the critical angle, where the integrand bends, the integral is known: F is 1.
float sheen_fresnel_diffuse(float eta)
{
    enum { STEPS = 256 };
    if (!(eta > 0.0f) || !isfinite(eta)) return 1.0f;
    double total = eta < 1.0f ? 1.0 - (double)eta * (double)eta : 0.0; // share of sin^2 that is reflected totally
    double sum = 0.0;
    for (int i = 0; i < STEPS; ++i) {
        // x^2 crowds the steps where the reflectance rises fastest, at the smallest cosines.
        double x = (i + 0.5) / STEPS, s2 = (1.0 - total) * (1.0 - x * x * x * x);
        float cos_t, cosine = (float)sqrt(1.0 - s2);
        sum += (double)sheen_fresnel_dielectric(cosine, eta, &cos_t) * 4.0 * x * x * x;
    }
    return minf((float)(total + (1.0 - total) * sum / STEPS), 1.0f);
}
