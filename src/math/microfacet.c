// SPDX-License-Identifier: Apache-2.0
#include "math/microfacet.h"

#define INV_SQRT_PI 0.56418958354775628695f

// Source: walter2007, with a roughness for each axis as in heitz2014-masking.
float sheen_microfacet_d(const Microfacet *s, Vec3 m)
{
    if (!(m.z > 0.0f)) return 0.0f;
    float x = m.x / s->alpha_u, y = m.y / s->alpha_v, c2 = m.z * m.z, slope2 = x * x + y * y;
    float area = SHEEN_PI * s->alpha_u * s->alpha_v;
    float d = s->distribution == SHEEN_DISTRIBUTION_GGX ? 1.0f / (area * sqrf(slope2 + c2))
                                                        : expf(-slope2 / c2) / (area * c2 * c2);
    return isfinite(d) ? d : 0.0f; // a grazing normal of Beckmann's: 0 / 0
}

// 1 over (1 + Lambda): heitz2014-masking. Both are exact, where rational fits are often used for
// Beckmann's, so that the visible normals are a density.
float sheen_microfacet_g1(const Microfacet *s, Vec3 v, Vec3 m)
{
    if (!(v3_dot(v, m) * v.z > 0.0f)) return 0.0f;
    float projected2 = sqrf(s->alpha_u * v.x) + sqrf(s->alpha_v * v.y);
    if (projected2 == 0.0f) return 1.0f;
    float tan2 = projected2 / (v.z * v.z);
    if (s->distribution == SHEEN_DISTRIBUTION_GGX) return 2.0f / (1.0f + sqrtf(1.0f + tan2));
    float a = 1.0f / sqrtf(tan2);
    if (a > 4.0f) return 1.0f;                             // to rounding
    if (a < 1e-3f) return 2.0f / (1.0f + INV_SQRT_PI / a); // the series; the difference below would cancel
    return 2.0f / (1.0f + erff(a) + expf(-a * a) * INV_SQRT_PI / a);
}

float sheen_microfacet_pdf(const Microfacet *s, Vec3 v, Vec3 m)
{
    float d = sheen_microfacet_d(s, m);
    return d > 0.0f ? d * sheen_microfacet_g1(s, v, m) * fabsf(v3_dot(v, m) / v.z) : 0.0f;
}

// The inverse of erf on (-1, 1), to some units in the last place. Source: giles2010-erfinv
static float erf_inverse(float x)
{
    float w = -logf((1.0f - x) * (1.0f + x)), p;
    if (w < 5.0f) {
        w -= 2.5f;
        p = 2.81022636e-08f;
        p = 3.43273939e-07f + p * w;
        p = -3.5233877e-06f + p * w;
        p = -4.39150654e-06f + p * w;
        p = 0.00021858087f + p * w;
        p = -0.00125372503f + p * w;
        p = -0.00417768164f + p * w;
        p = 0.246640727f + p * w;
        p = 1.50140941f + p * w;
    } else {
        w = sqrtf(w) - 3.0f;
        p = -0.000200214257f;
        p = 0.000100950558f + p * w;
        p = 0.00134934322f + p * w;
        p = -0.00367342844f + p * w;
        p = 0.00573950773f + p * w;
        p = -0.0076224613f + p * w;
        p = 0.00943887047f + p * w;
        p = 1.00167406f + p * w;
        p = 2.83297682f + p * w;
    }
    return p * x;
}

// Slope toward the viewer of a Gaussian surface of unit roughness, among those seen at angle theta. With b = erf(slope)
// the distribution is F(b) = (1 + b + tan exp(-slope^2) / sqrt(pi)) / F(erf(cot)), smooth and rising, which Newton's
// steps invert; halving takes over where they leave the bracket. Source: jakob2014-beckmann
static float visible_beckmann_slope(float cos_theta, float u)
{
    float tan_theta = safe_sqrtf(1.0f - cos_theta * cos_theta) / cos_theta;
    if (!(tan_theta > 1e-6f)) return erf_inverse(clampf(2.0f * u - 1.0f, -1.0f + 1e-6f, 1.0f - 1e-6f));
    float cot_theta = 1.0f / tan_theta, high = erff(cot_theta), low = -1.0f;
    float wanted =
        clampf(u, 1e-6f, 1.0f - 1e-6f) * (1.0f + high + tan_theta * INV_SQRT_PI * expf(-cot_theta * cot_theta));
    float b = high - (1.0f + high) * erff(sqrtf(-logf(clampf(u, 1e-6f, 1.0f - 1e-6f)))); // exact at grazing angles
    for (int i = 0; i < 10; ++i) {
        if (!(b > low && b < high)) b = 0.5f * (low + high);
        float slope = erf_inverse(clampf(b, -1.0f + 1e-7f, 1.0f - 1e-7f));
        float value = 1.0f + b + tan_theta * INV_SQRT_PI * expf(-slope * slope) - wanted;
        if (fabsf(value) < 1e-6f * wanted) break;
        if (value > 0.0f)
            high = b;
        else
            low = b;
        b -= value / (1.0f - slope * tan_theta);
    }
    return erf_inverse(clampf(b, -1.0f + 1e-7f, 1.0f - 1e-7f));
}

// Both distributions are those of unit roughness, stretched; v is stretched the other way. Source: heitz2014-visible
static Vec3 sample_beckmann(const Microfacet *s, Vec3 v, Vec2 u)
{
    Vec3 h = v3_normalize(v3(s->alpha_u * v.x, s->alpha_v * v.y, v.z));
    float r = sqrtf(h.x * h.x + h.y * h.y), c = r > 0.0f ? h.x / r : 1.0f, q = r > 0.0f ? h.y / r : 0.0f;
    float along = visible_beckmann_slope(h.z, u.x);
    float across = erf_inverse(clampf(2.0f * u.y - 1.0f, -1.0f + 1e-7f, 1.0f - 1e-7f));
    // Slopes are those of the height, so that a normal has them negated.
    return v3_normalize(v3(-s->alpha_u * (c * along - q * across), -s->alpha_v * (q * along + c * across), 1.0f));
}

// The visible hemisphere is a half disk and a half ellipse, seen from h. Source: heitz2018-ggx
static Vec3 sample_ggx(const Microfacet *s, Vec3 v, Vec2 u)
{
    Vec3 h = v3_normalize(v3(s->alpha_u * v.x, s->alpha_v * v.y, v.z));
    float l2 = h.x * h.x + h.y * h.y;
    Vec3 t1 = l2 > 0.0f ? v3_scale(v3(-h.y, h.x, 0.0f), 1.0f / sqrtf(l2)) : v3(1.0f, 0.0f, 0.0f);
    Vec3 t2 = v3_cross(h, t1);
    float r = sqrtf(u.x), phi = 2.0f * SHEEN_PI * u.y;
    float a = r * cosf(phi), b = lerpf(safe_sqrtf(1.0f - a * a), r * sinf(phi), 0.5f * (1.0f + h.z));
    Vec3 n = v3_mad(v3_mad(v3_scale(t1, a), b, t2), safe_sqrtf(1.0f - a * a - b * b), h);
    return v3_normalize(v3(s->alpha_u * n.x, s->alpha_v * n.y, maxf(n.z, 1e-6f)));
}

Vec3 sheen_microfacet_sample(const Microfacet *s, Vec3 v, Vec2 u)
{
    return s->distribution == SHEEN_DISTRIBUTION_GGX ? sample_ggx(s, v, u) : sample_beckmann(s, v, u);
}
