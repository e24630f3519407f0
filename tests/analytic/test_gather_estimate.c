// SPDX-License-Identifier: Apache-2.0
// The gather's estimates against closed forms and dense quadrature, in three scenes around a point at z = 0, normal +z.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/hash.h"
#include "gather/estimate.h"

#define show(...) (getenv("SHEEN_SHOW") ? (void)fprintf(stderr, __VA_ARGS__) : (void)0)

enum { RINGS = 16, SECTORS = 64, CELLS = RINGS * SECTORS };

/** What a ray meets: radiance and distance, 1e9 for a miss as in the reference values. */
typedef struct Seen {
    double L, r;
} Seen;
typedef Seen SceneFn(Vec3 p, Vec3 d);

// A: inside the box [0,4] x [0,3] x [0,2.5], whose walls and ceiling emit 1 + 0.25 x + 0.15 y z.
static Seen box(Vec3 p, Vec3 d)
{
    double tx = d.x > 0 ? (4.0 - p.x) / d.x : d.x < 0 ? -p.x / d.x : 1e9;
    double ty = d.y > 0 ? (3.0 - p.y) / d.y : d.y < 0 ? -p.y / d.y : 1e9;
    double tz = d.z > 0 ? (2.5 - p.z) / d.z : 1e9;
    double t = fmin(tx, fmin(ty, tz)), x = p.x + t * d.x, y = p.y + t * d.y, z = p.z + t * d.z;
    return (Seen){1.0 + 0.25 * x + 0.15 * y * z, t};
}

// Distance to the sphere of radius 0.3 about (0.5, 0.2, 0.9), or 1e9.
static double sphere(Vec3 p, Vec3 d)
{
    double v[3] = {0.5 - p.x, 0.2 - p.y, 0.9 - p.z};
    double b = d.x * v[0] + d.y * v[1] + d.z * v[2];
    double disc = b * b - (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] - 0.09);
    return disc > 0 && b > 0 ? b - sqrt(disc) : 1e9;
}

// B1: the sphere emits 1 on black.
static Seen bright_sphere(Vec3 p, Vec3 d)
{
    double t = sphere(p, d);
    return (Seen){t < 1e9 ? 1.0 : 0.0, t};
}

// B2: the sphere is black under an infinite ceiling at z = 2 that emits 1 / (1 + (x^2 + y^2) / 4).
static Seen dark_sphere(Vec3 p, Vec3 d)
{
    double t = sphere(p, d);
    if (t < 1e9) return (Seen){0.0, t};
    t = (2.0 - p.z) / d.z;
    double x = p.x + t * d.x, y = p.y + t * d.y;
    return (Seen){1.0 / (1.0 + (x * x + y * y) / 4.0), t};
}

/** What the last gather saw. */
static struct {
    Rgb L[64 * 256];
    float r[64 * 256];
} gathered;

static void gather(SceneFn *scene, Vec3 p, SheenStrata s, bool jitter, uint32_t seed, IrradianceEstimate *e)
{
    Rgb *L = gathered.L;
    float *r = gathered.r;
    assert_true(strata_count(s) <= 64 * 256);
    for (unsigned k = 0, i = 0; k < s.sectors; ++k)
        for (unsigned j = 0; j < s.rings; ++j, ++i) {
            uint32_t h = hash_combine(seed, i);
            Vec2 u = jitter ? v2(hash_to_unit(h), hash_to_unit(hash_u32(h ^ 77))) : v2(0.5f, 0.5f);
            Seen seen = scene(p, sheen_strata_direction(s, j, k, u));
            L[i] = rgb((float)seen.L, 2.0f * (float)seen.L, 0.0f);
            r[i] = (float)seen.r;
        }
    sheen_estimate_irradiance(s, L, r, e);
}

/** A scene with its exact irradiance and gradient (dense quadrature, 1e-9) and the sums over 16 x 64 cell centres. */
typedef struct Case {
    SceneFn *scene;
    Vec3 p;
    double E, gx, gy;                // exact
    double cell_E, cell_gx, cell_gy; // cell centres, computed in double by an independent program
} Case;

static const Case cases[] = {
    {box,
     {1.2f, 1.1f, 0.0f},
     5.273170284189028,
     0.6861197012556867,
     0.43891837726546995,
     5.273618777211173,
     0.7025505549557017,
     0.446162813849324},
    {bright_sphere,
     {0, 0, 0},
     0.22056970575779883,
     0.30077687148946886,
     0.1203107485731753,
     0.2239611950313036,
     0.3463564170718588,
     0.13237677186276395},
    {dark_sphere,
     {0, 0, 0},
     1.4114529432861636,
     -0.2883388580725195,
     -0.11533554320365216,
     1.4088654798737186,
     -0.3494530005961882,
     -0.13677478271137178},
};

static void test_cell_centres_agree_with_second_implementation(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const Case *c = &cases[i];
        IrradianceEstimate e;
        gather(c->scene, c->p, (SheenStrata){.rings = RINGS, .sectors = SECTORS}, false, 0, &e);
        // Directions are float: a ray or two of 1024 at the sphere's edge may fall on its other side, none did here;
        // what is left is float rounding of directions, some 1e-6 of a sum of 1024 terms of both signs.
        assert_true(fabs((double)e.E.r - c->cell_E) < 2e-5 * c->cell_E);
        assert_true(fabs((double)e.translation[0].r - c->cell_gx) < 5e-5);
        assert_true(fabs((double)e.translation[1].r - c->cell_gy) < 5e-5);
        assert_true(fabs((double)e.E.g - 2.0 * c->cell_E) < 4e-5 * c->cell_E);
        assert_true(e.E.b == 0.0f && e.translation[0].b == 0.0f && e.rotation[0].b == 0.0f);
    }
}

static void test_jittered_mean_is_the_exact_irradiance(void **state)
{
    (void)state;
    enum { REPEATS = 64 };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const Case *c = &cases[i];
        double sum = 0.0, sum2 = 0.0;
        for (uint32_t n = 0; n < REPEATS; ++n) {
            IrradianceEstimate e;
            gather(c->scene, c->p, (SheenStrata){.rings = RINGS, .sectors = SECTORS}, true, n + 1, &e);
            sum += (double)e.E.r;
            sum2 += (double)e.E.r * (double)e.E.r;
        }
        double mean = sum / REPEATS, sigma = sqrt(fmax(0.0, sum2 / REPEATS - mean * mean) / REPEATS);
        // The estimator is unbiased: five standard errors of the mean, one chance in two million.
        assert_true(fabs(mean - c->E) < 5.0 * sigma + 1e-6);
    }
}

static void test_gradient_converges_to_dense_quadrature(void **state)
{
    (void)state;
    // Relative bias of the mean gradient at 64 x 200 cells. In the smooth box the walls' estimate is of first order in
    // the cell, 1.1 % at 40 x 160. At an occluder's curved edge the distance of the nearer side is sampled inside the
    // silhouette and is too small: the published bias is 0.10 and 0.13 at 6400 rays and falls with the root of the
    // number of rays, to 0.07 and 0.09 here. A form that skips the first wall or takes cos(theta) of the sample instead
    // of the wall's is off by 0.04 and 0.2 in the box.
    const double bound[] = {0.015, 0.12, 0.14};
    enum { REPEATS = 24 };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const Case *c = &cases[i];
        double gx = 0.0, gy = 0.0;
        for (uint32_t n = 0; n < REPEATS; ++n) {
            IrradianceEstimate e;
            gather(c->scene, c->p, (SheenStrata){.rings = 64, .sectors = 200}, true, 1000 + n, &e);
            gx += (double)e.translation[0].r / REPEATS;
            gy += (double)e.translation[1].r / REPEATS;
        }
        assert_true(hypot(gx - c->gx, gy - c->gy) < bound[i] * hypot(c->gx, c->gy));
    }
}

static void test_rotation_gradient_is_the_derivative(void **state)
{
    (void)state;
    // A sky of radiance 1 + a d.x + b d.y. For n' turned toward +x, n x n' points along y, and dE = integral of L d.x:
    // the gradient's y component is a times the integral of d.x^2, its x component is -b times that of d.y^2.
    enum { M = 40, N = 126 };
    static Rgb L[M * N];
    static float r[M * N];
    const double a = 0.4, b = -0.3;
    SheenStrata s = {.rings = M, .sectors = N};
    for (unsigned k = 0, i = 0; k < N; ++k)
        for (unsigned j = 0; j < M; ++j, ++i) {
            Vec3 d = sheen_strata_direction(s, j, k, v2(0.5f, 0.5f));
            L[i] = rgb_gray((float)(1.0 + a * d.x + b * d.y));
            r[i] = INFINITY;
        }
    IrradianceEstimate e;
    sheen_estimate_irradiance(s, L, r, &e);
    // integral of L d.x over the hemisphere = a (2 pi / 3). L at the middle of a cell, in projected solid angle, for
    // its mean is short by 0.0007 of it at M = 40.
    double exact = 2.0 * 3.141592653589793 / 3.0;
    show("rotation: %.5f, %.5f of the exact\n", (double)e.rotation[1].r / (exact * a),
         -(double)e.rotation[0].r / (exact * b));
    assert_true(fabs((double)e.rotation[1].r - exact * a) < 0.0011 * exact * a);
    assert_true(fabs((double)e.rotation[0].r + exact * b) < 0.0011 * exact * fabs(b));
    assert_true(isinf(e.R));
    assert_true(fabsf(e.translation[0].r) == 0.0f && fabsf(e.translation[1].r) == 0.0f);
}

// Irradiance above z = 0 about a normal m bent from z, by quadrature.
static double bent_irradiance(SceneFn *scene, Vec3 p, Vec3 m)
{
    enum { Z = 300, PHI = 600 };
    double sum = 0.0;
    for (unsigned i = 0; i < Z; ++i)
        for (unsigned j = 0; j < PHI; ++j) {
            double z = (i + 0.5) / Z, s = sqrt(1 - z * z), phi = 2.0 * 3.141592653589793 * (j + 0.5) / PHI;
            Vec3 d = v3((float)(s * cos(phi)), (float)(s * sin(phi)), (float)z);
            sum += scene(p, d).L * fmax(0.0, (double)v3_dot(m, d));
        }
    return sum * 2.0 * 3.141592653589793 / ((double)Z * PHI);
}

// A black floor's horizon on one side, light on the other.
static Seen half_sky(Vec3 p, Vec3 d)
{
    (void)p;
    return (Seen){d.x > 0 ? 1.0 : 0.1, 1e9};
}

/** What a gather says about normals bent by theta: the largest error over eight azimuths, of the irradiance at n. */
typedef struct BentError {
    double all, without_lean, without_behind;
} BentError;

static BentError bent_error(SceneFn *scene, float theta)
{
    enum { REPEATS = 16, AZIMUTHS = 8 };
    const SheenStrata s = {.rings = RINGS, .sectors = SECTORS};
    const Vec3 p = v3(1.2f, 1.1f, 0.0f);
    const double level = bent_irradiance(scene, p, v3(0, 0, 1));
    BentError worst = {0, 0, 0};
    for (int a = 0; a < AZIMUTHS; ++a) {
        float phi = 2.0f * 3.1415927f * (float)a / AZIMUTHS, k = 1.0f - cosf(theta);
        Vec3 t = v3(cosf(phi), sinf(phi), 0), m = v3(t.x * sinf(theta), t.y * sinf(theta), 1.0f - k);
        double above = 0.0, mean = 0.0, lean = 0.0;
        for (uint32_t n = 0; n < REPEATS; ++n) {
            IrradianceEstimate e;
            BehindEstimate behind;
            gather(scene, p, s, true, n, &e);
            sheen_estimate_behind(s, gathered.L, &behind);
            // n x m = (-m.y, m.x, 0)
            above += (double)(e.E.r * m.z - m.y * e.rotation[0].r + m.x * e.rotation[1].r) / REPEATS;
            mean += (double)(k * behind.mean.r) / REPEATS;
            lean += (double)(k * behind.mean.r * (behind.lean[0] * t.x + behind.lean[1] * t.y)) / REPEATS;
        }
        double exact = bent_irradiance(scene, p, m);
        worst.all = fmax(worst.all, fabs(above + mean + lean - exact) / level);
        worst.without_lean = fmax(worst.without_lean, fabs(above + mean - exact) / level);
        worst.without_behind = fmax(worst.without_behind, fabs(above - exact) / level);
    }
    return worst;
}

static void test_bent_normals(void **state)
{
    (void)state;
    // Half as much again as was measured: 0.0008, 0.003, 0.005 and 0.010. Without lean it is 0.002, 0.02, 0.05 and
    // 0.10, without what is behind 0.005, 0.04, 0.11 and 0.22.
    static const struct {
        float theta;
        double most;
    } bounds[] = {{0.1f, 0.0005}, {0.3f, 0.0023}, {0.5f, 0.0057}, {0.7f, 0.011}};
    for (size_t i = 0; i < sizeof bounds / sizeof *bounds; ++i)
        for (int half = 0; half < 2; ++half) {
            BentError e = bent_error(half ? half_sky : box, bounds[i].theta);
            show("%s, bent by %.1f: %.4f, without lean %.4f, without what is behind %.4f\n", half ? "half" : "box",
                 (double)bounds[i].theta, e.all, e.without_lean, e.without_behind);
            assert_true(e.all < bounds[i].most);
        }
}

static void test_harmonic_mean(void **state)
{
    (void)state;
    const float d[] = {1.0f, 2.0f, 4.0f, INFINITY};
    assert_true(fabsf(sheen_harmonic_mean(4, d) - 4.0f / 1.75f) < 1e-6f);
    assert_true(isinf(sheen_harmonic_mean(1, d + 3)));
    // Scene A under uniform strata, cell centres: 1.97384042827804 by an independent program.
    static float r[CELLS];
    for (unsigned k = 0, i = 0; k < SECTORS; ++k)
        for (unsigned j = 0; j < RINGS; ++j, ++i) {
            double z = 1.0 - (j + 0.5) / RINGS, phi = 2.0 * 3.141592653589793 * (k + 0.5) / SECTORS;
            Vec3 dir = v3((float)(sqrt(1 - z * z) * cos(phi)), (float)(sqrt(1 - z * z) * sin(phi)), (float)z);
            r[i] = (float)box(v3(1.2f, 1.1f, 0.0f), dir).r;
        }
    assert_true(fabs((double)sheen_harmonic_mean(CELLS, r) - 1.9738404282780409) < 1e-5);
}

// A record whose gradient holds for a tenth of a metre, and is read up to half a metre away: what it says there must
// stay within what it says at a tenth, whatever the harmonic mean distance.
static void test_enlarged_gradient(void **state)
{
    (void)state;
    IrradianceEstimate e = {.E = rgb_gray(10.0f), .translation = {{60, 60, 60}, {80, 80, 80}}, .R = 1.0f};
    assert_float_equal(estimate_gradient_radius(&e), 0.1f, 1e-6f); // 10 / hypot(60, 80)
    IrradianceEstimate same = e;
    estimate_enlarge(0.1f, 0.1f, &same); // read no farther
    assert_true(same.translation[0].r == 60.0f && same.translation[1].b == 80.0f);
    estimate_enlarge(estimate_gradient_radius(&e), 0.5f, &e);
    assert_float_equal(0.5f * hypotf(e.translation[0].g, e.translation[1].g), 10.0f, 1e-4f);
    IrradianceEstimate black = {.translation = {{1, 1, 1}, {0, 0, 0}}, .R = 1.0f};
    estimate_enlarge(estimate_gradient_radius(&black), 0.5f, &black); // E of 0 stays 0
    assert_true(rgb_is_black(black.translation[0]));
    IrradianceEstimate even = {.E = rgb_gray(1.0f), .R = 0.3f};
    assert_true(estimate_gradient_radius(&even) == 0.3f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cell_centres_agree_with_second_implementation),
        cmocka_unit_test(test_jittered_mean_is_the_exact_irradiance),
        cmocka_unit_test(test_gradient_converges_to_dense_quadrature),
        cmocka_unit_test(test_rotation_gradient_is_the_derivative),
        cmocka_unit_test(test_bent_normals),
        cmocka_unit_test(test_harmonic_mean),
        cmocka_unit_test(test_enlarged_gradient),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
