// SPDX-License-Identifier: Apache-2.0
#include "scene/coat.h"

#include "math/fresnel.h"
#include "math/warp.h"

// Share of the light from v that a single scattering sends back (`reflected`) or through: the mean over visible normals
// of Fresnel's share times that which is not shadowed on the way out. eta: index beyond over index on the side of v.
static float share(const Microfacet *s, float eta, float cosine, bool reflected, uint32_t n)
{
    Vec3 v = v3(safe_sqrtf(1.0f - cosine * cosine), 0.0f, cosine);
    double sum = 0.0;
    for (uint32_t i = 0; i < n; ++i) {
        Vec3 m = sheen_microfacet_sample(s, v, warp_hammersley(i, n)), out = v3_reflect(v, m);
        float cos_t, c = v3_dot(v, m), f = sheen_fresnel_dielectric(c, eta, &cos_t);
        if (!reflected) out = v3_mad(v3_scale(v, -1.0f / eta), c / eta + cos_t, m);
        if ((out.z > 0.0f) == reflected) sum += (double)((reflected ? f : 1.0f - f) * sheen_microfacet_g1(s, out, m));
    }
    return clampf((float)(sum / n), 0.0f, 1.0f);
}

static void fill_row(SheenCoat *c, uint32_t row, float alpha)
{
    // Outside the cosines need many samples each; inside, where they are summed, the critical angle needs many cosines.
    enum { SAMPLES = 1024, INSIDE_COSINES = 256, INSIDE_SAMPLES = 256 };
    Microfacet s = {c->distribution, alpha, alpha};
    for (int i = 0; i < SHEEN_COAT_COSINES; ++i) {
        float cosine = maxf((float)i / (SHEEN_COAT_COSINES - 1), 1e-4f);
        c->transmittance[row][i] = share(&s, c->ior, cosine, false, SAMPLES);
    }
    double inside = 0.0;
    for (int i = 0; i < INSIDE_COSINES; ++i) {
        float cosine = ((float)i + 0.5f) / INSIDE_COSINES;
        inside += 2.0 * (double)(cosine * share(&s, 1.0f / c->ior, cosine, true, INSIDE_SAMPLES)) / INSIDE_COSINES;
    }
    // Below 1, so that what bounces inside has a finite sum.
    c->inside[row] = clampf((float)inside, 0.0f, 0.999f);
    // Exact for the interpolation that shading does: t and cosine are linear between entries.
    double mean = 0.0, h = 1.0 / (SHEEN_COAT_COSINES - 1);
    for (int i = 0; i + 1 < SHEEN_COAT_COSINES; ++i) {
        double a = (double)c->transmittance[row][i], b = (double)c->transmittance[row][i + 1];
        mean += 2.0 * h * h * (i * (a + b) / 2.0 + a / 6.0 + b / 3.0);
    }
    c->mean[row] = (float)mean;
}

const SheenCoat *sheen_coat_create(SheenArena *arena, float ior, SheenDistribution distribution, float alpha_min,
                                   float alpha_max)
{
    SheenCoat *c = SHEEN_ARENA_NEW(arena, SheenCoat, 1);
    if (!c) return NULL;
    *c = (SheenCoat){.ior = ior, .distribution = distribution, .alpha_min = alpha_min, .alpha_max = alpha_max};
    c->n_alphas = alpha_max > alpha_min ? SHEEN_COAT_ALPHAS : 1;
    for (uint32_t i = 0; i < c->n_alphas; ++i) {
        float t = c->n_alphas == 1 ? 0.0f : (float)i / (float)(c->n_alphas - 1);
        fill_row(c, i, lerpf(alpha_min, alpha_max, t));
    }
    return c;
}

// Where x lies among n entries: the lower one, and the share of the upper one.
static uint32_t locate(float x, uint32_t n, float *upper)
{
    float at = clampf(x, 0.0f, 1.0f) * (float)(n - 1);
    uint32_t i = (uint32_t)at;
    if (i > n - 2) i = n - 2;
    *upper = at - (float)i;
    return i;
}

static uint32_t row_of(const SheenCoat *c, float alpha, float *upper)
{
    *upper = 0.0f;
    if (c->n_alphas == 1) return 0;
    return locate((alpha - c->alpha_min) / (c->alpha_max - c->alpha_min), c->n_alphas, upper);
}

float sheen_coat_transmittance(const SheenCoat *c, float alpha, float cosine)
{
    float across, along;
    uint32_t row = row_of(c, alpha, &across), i = locate(fabsf(cosine), SHEEN_COAT_COSINES, &along);
    float t = lerpf(c->transmittance[row][i], c->transmittance[row][i + 1], along);
    if (across == 0.0f) return t;
    return lerpf(t, lerpf(c->transmittance[row + 1][i], c->transmittance[row + 1][i + 1], along), across);
}

static float of_rows(const SheenCoat *c, const float rows[], float alpha)
{
    float across;
    uint32_t row = row_of(c, alpha, &across);
    return across == 0.0f ? rows[row] : lerpf(rows[row], rows[row + 1], across);
}

float sheen_coat_mean(const SheenCoat *c, float alpha)
{
    return of_rows(c, c->mean, alpha);
}

float sheen_coat_inside(const SheenCoat *c, float alpha)
{
    return of_rows(c, c->inside, alpha);
}
