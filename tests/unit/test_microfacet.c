// SPDX-License-Identifier: Apache-2.0
// Distributions of microfacets are densities; tables of rough interfaces join what is known of smooth ones.
#include "math/fresnel.h"
#include "math/microfacet.h"
#include "scene/coat.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void assert_near(double got, double want, double tolerance)
{
    if (!(fabs(got - want) <= tolerance)) fail_msg("%.9g, want %.9g +- %.2g", got, want, tolerance);
}

static const Microfacet surfaces[] = {
    {SHEEN_DISTRIBUTION_GGX, 0.1f, 0.1f},      {SHEEN_DISTRIBUTION_GGX, 0.5f, 0.5f},
    {SHEEN_DISTRIBUTION_GGX, 0.8f, 0.2f},      {SHEEN_DISTRIBUTION_BECKMANN, 0.1f, 0.1f},
    {SHEEN_DISTRIBUTION_BECKMANN, 0.6f, 0.6f}, {SHEEN_DISTRIBUTION_BECKMANN, 0.2f, 0.8f},
};
enum { N_SURFACES = sizeof surfaces / sizeof *surfaces };

// int D(m) g(m) dm over the hemisphere, with steps that crowd at the normal.
static double integral(const Microfacet *s, Vec3 v, bool visible)
{
    enum { STEPS = 400, AROUND = 128 };
    double sum = 0;
    for (int i = 0; i < STEPS; ++i) {
        float x = ((float)i + 0.5f) / STEPS, theta = 0.5f * SHEEN_PI * x * x, d_theta = SHEEN_PI * x / STEPS;
        for (int k = 0; k < AROUND; ++k) {
            float phi = 2 * SHEEN_PI * ((float)k + 0.5f) / AROUND;
            Vec3 m = v3(sinf(theta) * cosf(phi), sinf(theta) * sinf(phi), cosf(theta));
            float g = visible ? sheen_microfacet_g1(s, v, m) * maxf(v3_dot(v, m), 0) : m.z;
            sum += (double)(sheen_microfacet_d(s, m) * g * sinf(theta) * d_theta) * 2 * (double)SHEEN_PI / AROUND;
        }
    }
    return sum;
}

// The microfacets' area seen from the normal is the surface's.
static void test_projected_area(void **state)
{
    (void)state;
    for (int i = 0; i < N_SURFACES; ++i) assert_near(integral(&surfaces[i], v3(0, 0, 1), false), 1, 1e-3);
}

// Those that are seen from v cover the surface as it is seen from v: what makes Smith's function the right one.
static void test_visible_area(void **state)
{
    (void)state;
    const Vec3 views[] = {{0, 0, 1}, {0.5f, 0.3f, 0.8124038f}, {-0.3f, 0.9f, 0.3162278f}, {0.9f, 0.42f, 0.1166190f}};
    for (int i = 0; i < N_SURFACES; ++i)
        for (int k = 0; k < 4; ++k)
            assert_near(integral(&surfaces[i], views[k], true), (double)views[k].z, 2e-3 * (double)views[k].z + 2e-4);
}

// At the ends of the unit square too, where inverses of distributions have their poles.
static void test_samples_are_normals(void **state)
{
    (void)state;
    const float ends[] = {0, 1e-7f, 0.5f, 0x1.fffffep-1f};
    const Vec3 views[] = {{0, 0, 1}, {1, 0, 1e-6f}, {0.6f, 0, 0.8f}, {-0.7f, 0.7f, 0.1414214f}};
    for (int i = 0; i < N_SURFACES; ++i)
        for (int k = 0; k < 64; ++k) {
            Vec3 m = sheen_microfacet_sample(&surfaces[i], views[k / 16], v2(ends[k & 3], ends[k >> 2 & 3]));
            assert_true(v3_finite(m) && m.z >= 0 && fabsf(v3_length(m) - 1) < 1e-5f);
            float pdf = sheen_microfacet_pdf(&surfaces[i], views[k / 16], m);
            assert_true(pdf >= 0 && isfinite(pdf));
        }
}

static void test_diffuse_fresnel(void **state)
{
    (void)state;
    assert_near((double)sheen_fresnel_diffuse(1.5f), 0.0918, 1e-4); // Walsh's closed form
    assert_near((double)sheen_fresnel_diffuse(1 / 1.5f), 0.5963, 1e-4);
    assert_true(sheen_fresnel_diffuse(1) == 0);
    // What passes one way passes the other, spread over the squared index.
    for (float eta = 1.05f; eta < 3; eta += 0.2f)
        assert_near(1 - (double)sheen_fresnel_diffuse(eta), (double)(eta * eta * (1 - sheen_fresnel_diffuse(1 / eta))),
                    2e-4);
    const float nonsense[] = {0, -1, NAN, INFINITY, 1e30f, 1e-30f};
    for (int i = 0; i < 6; ++i) {
        float f = sheen_fresnel_diffuse(nonsense[i]);
        assert_true(f >= 0 && f <= 1);
    }
}

static void test_coats(void **state)
{
    (void)state;
    SheenArena *arena = sheen_arena_create();
    for (int d = 0; d < 2; ++d) {
        const SheenCoat *smooth = sheen_coat_create(arena, 1.5f, (SheenDistribution)d, 0.002f, 0.002f);
        for (float c = 0.1f; c <= 1; c += 0.1f) {
            float cos_t, t = 1 - sheen_fresnel_dielectric(c, 1.5f, &cos_t);
            assert_near((double)sheen_coat_transmittance(smooth, 0.002f, c), (double)t, 2e-3);
            assert_near((double)sheen_coat_transmittance(smooth, 0.002f, -c), (double)t, 2e-3);
        }
        assert_near((double)sheen_coat_inside(smooth, 0.002f), 0.5963, 2e-3);
        assert_near((double)sheen_coat_mean(smooth, 0.002f), 1 - 0.0918, 2e-3);
        // A table over the roughness agrees with those of one roughness, at its rows and between.
        const SheenCoat *many = sheen_coat_create(arena, 1.5f, (SheenDistribution)d, 0.1f, 0.8f);
        for (float alpha = 0.1f; alpha < 0.8f; alpha += 0.15f) {
            const SheenCoat *one = sheen_coat_create(arena, 1.5f, (SheenDistribution)d, alpha, alpha);
            for (float c = 0.05f; c <= 1; c += 0.19f)
                assert_near((double)sheen_coat_transmittance(many, alpha, c),
                            (double)sheen_coat_transmittance(one, alpha, c), 0.01); // linear between rows
            assert_near((double)sheen_coat_inside(many, alpha), (double)sheen_coat_inside(one, alpha), 2e-3);
            assert_near((double)sheen_coat_mean(many, alpha), (double)sheen_coat_mean(one, alpha), 2e-3);
        }
    }
    sheen_arena_destroy(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_projected_area),
        cmocka_unit_test(test_visible_area),
        cmocka_unit_test(test_samples_are_normals),
        cmocka_unit_test(test_diffuse_fresnel),
        cmocka_unit_test(test_coats),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
