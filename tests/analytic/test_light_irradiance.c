// SPDX-License-Identifier: Apache-2.0
// Irradiance of unoccluded lights, from light samples alone, against closed forms.
#include "unit/light_scene.h"

// Five standard errors: all means below together miss by chance once in some 10^4 seeds, and the seed is fixed. The
// relative part is for means without noise, where only rounding is left.
#define SIGMAS 5.0
#define ROUNDING 2e-5

#define N_SAMPLES 40000

static Moments irradiance(const LightScene *s, uint32_t light, Vec3 p, Vec3 n, uint32_t seed)
{
    Random r = {seed, 0};
    Moments m = {0};
    for (int i = 0; i < N_SAMPLES; ++i) {
        LightSample sample;
        bool any = sheen_light_sample(s->lights, light, p, random_2d(&r), &sample);
        moments_add(&m, any ? (double)(sample.radiance.g * maxf(v3_dot(sample.wi, n), 0.0f)) : 0.0);
    }
    return m;
}

static void check(const LightScene *s, uint32_t light, Vec3 p, Vec3 n, double expected)
{
    Moments m = irradiance(s, light, p, n, 1);
    double tolerance = SIGMAS * moments_error(&m) + ROUNDING * expected;
    if (!(fabs(moments_mean(&m) - expected) <= tolerance))
        fail_msg("irradiance %.8g, expected %.8g +- %.2g", moments_mean(&m), expected, tolerance);
}

// Lambert's formula for a polygon wholly above the horizon, in double.
static double polygon_irradiance(const Vec3 v[], int n_vertices, Vec3 p, Vec3 n)
{
    double e = 0.0;
    for (int i = 0; i < n_vertices; ++i) {
        Vec3 a = v3_sub(v[i], p), b = v3_sub(v[(i + 1) % n_vertices], p);
        double ax = (double)a.x, ay = (double)a.y, az = (double)a.z, bx = (double)b.x, by = (double)b.y,
               bz = (double)b.z;
        double cx = ay * bz - az * by, cy = az * bx - ax * bz, cz = ax * by - ay * bx;
        double length = sqrt(cx * cx + cy * cy + cz * cz), dot = ax * bx + ay * by + az * bz;
        e -= 0.5 * atan2(length, dot) / length * (cx * (double)n.x + cy * (double)n.y + cz * (double)n.z);
    }
    return e;
}

static const Vec3 ceiling[4] = {{-1, -0.5f, 2}, {-1, 0.5f, 2}, {1, 0.5f, 2}, {1, -0.5f, 2}}; // faces down
static const Vec3 up = {0, 0, 1};

static void test_rectangle(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_quad(&s, ceiling, rgb_gray(3));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    // Near, far, beside, millimetres under the edge, and so far that the area takes over.
    const Vec3 p[] = {{0, 0, 0},         {0.3f, 0.2f, 1.99f}, {5, -4, 0}, {1, 0.5f, 1.998f}, {0.2f, 0.1f, 1.999999f},
                      {300, 200, -1000}, {2e4f, 0, -1e5f}};
    for (size_t i = 0; i < sizeof p / sizeof *p; ++i)
        check(&s, 0, p[i], up, 3 * polygon_irradiance(ceiling, 4, p[i], up));
    light_scene_destroy(&s);
}

static void test_triangle(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_triangle(&s, ceiling[0], ceiling[1], ceiling[2], rgb_gray(3));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    const Vec3 p[] = {{0, 0, 0},  {-0.5f, 0.2f, 1.9f}, {-0.5f, 0.2f, 1.9999f}, {-0.5f, 0.2f, 1.999999f},
                      {5, -4, 0}, {30, 20, -100},      {1e3f, 0, -1e3f}};
    for (size_t i = 0; i < sizeof p / sizeof *p; ++i)
        check(&s, 0, p[i], up, 3 * polygon_irradiance(ceiling, 3, p[i], up));
    light_scene_destroy(&s);
}

static void test_quadrilateral_that_is_no_rectangle(void **state)
{
    (void)state;
    const Vec3 v[4] = {{-1, -0.5f, 2}, {-0.5f, 0.5f, 2}, {1, 0.75f, 2}, {1, -0.5f, 2}};
    LightScene s = light_scene_begin();
    add_quad(&s, v, rgb_gray(3));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    const Vec3 p[] = {{0, 0, 0}, {0.3f, 0.2f, 1.9f}, {5, -4, 0}};
    for (size_t i = 0; i < sizeof p / sizeof *p; ++i) check(&s, 0, p[i], up, 3 * polygon_irradiance(v, 4, p[i], up));
    light_scene_destroy(&s);
}

// On the axis E = pi L r^2 / (r^2 + h^2); an ellipse far away is its area over the square of the distance.
static void test_disk(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_disk(&s, v3(0, 0, 2), v3(0.5f, 0, 0), v3(0, -0.5f, 0), rgb_gray(3));
    add_disk(&s, v3(0, 0, 2), v3(0.5f, 0.1f, 0), v3(0.3f, -0.2f, 0), rgb_gray(3));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    const float h[] = {1e-3f, 0.1f, 1, 100};
    for (size_t i = 0; i < sizeof h / sizeof *h; ++i) {
        double d = 2.0 - (double)(2 - h[i]);
        check(&s, 0, v3(0, 0, 2 - h[i]), up, 3.14159265358979 * 3 * 0.25 / (0.25 + d * d));
    }
    double area = 3.14159265358979 * (0.5 * 0.2 + 0.1 * 0.3);
    check(&s, 1, v3(0, 0, -1000), up, 3 * area / (1002.0 * 1002.0));
    light_scene_destroy(&s);
}

// E = pi L (r/d)^2 cos when the sphere is fully above the horizon; inside, E = pi L.
static void test_sphere(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_sphere(&s, v3(1, 2, 5), 0.5f, false, rgb_gray(3));
    add_sphere(&s, v3(1, 2, 5), 7, true, rgb_gray(3));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    const Vec3 p[] = {{1, 2, 4.49f}, {1, 2, 0}, {4, 2, 1}, {1, 2, -3000}};
    for (size_t i = 0; i < sizeof p / sizeof *p; ++i) {
        Vec3 d = v3_sub(v3(1, 2, 5), p[i]);
        double d2 = (double)v3_length2(d), cosine = (double)d.z / sqrt(d2);
        check(&s, 0, p[i], up, 3.14159265358979 * 3 * 0.25 / d2 * cosine);
    }
    check(&s, 1, v3(-1, 4, 3), v3_normalize(v3(1, 2, -3)), 3.14159265358979 * 3);
    light_scene_destroy(&s);
}

// Half a sphere is above the horizon of a point level with its centre. Irradiance is radiance times the area of the
// directions projected to the ground: that of half a cap of half-angle sigma is the segment of the unit disk beyond the
// chord at cos sigma, sigma - sin sigma cos sigma.
static void test_sphere_cut_by_the_horizon(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_sphere(&s, v3(2, 0, 0), 1, false, rgb_gray(3));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    double sigma = asin(0.5);
    check(&s, 0, v3(0, 0, 0), up, 3 * (sigma - sin(sigma) * cos(sigma)));
    light_scene_destroy(&s);
}

// A closed mesh: the sum over its sides that are in view.
static void test_box(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_box(&s, v3(-1, -1, 2), v3(1, 1, 3), rgb_gray(3));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    const Vec3 below[4] = {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}};
    const Vec3 side[4] = {{1, -1, 2}, {1, 1, 2}, {1, 1, 3}, {1, -1, 3}};
    Vec3 p = v3(3, 0, 0);
    check(&s, 0, p, up, 3 * (polygon_irradiance(below, 4, p, up) + polygon_irradiance(side, 4, p, up)));
    light_scene_destroy(&s);
}

static void test_nothing_from_behind(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_quad(&s, ceiling, rgb_gray(3));
    add_triangle(&s, ceiling[0], ceiling[1], ceiling[2], rgb_gray(3));
    add_disk(&s, v3(0, 0, 2), v3(0.5f, 0, 0), v3(0, -0.5f, 0), rgb_gray(3));
    add_sphere(&s, v3(0, 0, 3), 0.5f, true, rgb_gray(3));
    add_sphere(&s, v3(0, 0, 5), 3, false, rgb_gray(3));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    assert_int_equal(sheen_lights_count(s.lights), 5);
    for (uint32_t i = 0; i < 5; ++i) {
        LightSample sample;
        assert_false(sheen_light_sample(s.lights, i, v3(0.1f, 0.2f, 4), v2(0.5f, 0.5f), &sample));
    }
    light_scene_destroy(&s);
}

static void test_point_spot_directional(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    float rad = SHEEN_PI / 180;
    SheenLight point = {.kind = SHEEN_LIGHT_POINT, .radiance = rgb_gray(3), .position = v3(0, 0, 2)};
    SheenLight spot = {.kind = SHEEN_LIGHT_SPOT,
                       .radiance = rgb_gray(3),
                       .position = v3(0, 0, 0),
                       .direction = v3(0, 0, 1),
                       .cos_inner = cosf(15 * rad),
                       .cos_outer = cosf(20 * rad)};
    SheenLight sun = {.kind = SHEEN_LIGHT_DIRECTIONAL, .radiance = rgb_gray(3), .direction = v3(0.6f, 0, -0.8f)};
    sheen_builder_add_light(s.builder, &point);
    sheen_builder_add_light(s.builder, &spot);
    sheen_builder_add_light(s.builder, &sun);
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    check(&s, 0, v3(0, 0, 0), up, 3.0 / 4.0);
    check(&s, 2, v3(7, 8, 9), up, 3.0 * 0.8);
    // Mitsuba 3's spot (cutoff 20, beam width 15 degrees, intensity 3) at distance 2, seen face to face.
    const double degrees[] = {0, 10, 14.9, 16, 18, 19.9, 21}, expected[] = {.75, .75, .75, .6, .3, .015, 0};
    for (size_t i = 0; i < sizeof degrees / sizeof *degrees; ++i) {
        float a = (float)degrees[i] * rad;
        Vec3 d = v3(sinf(a), 0, cosf(a));
        LightSample sample;
        double e = sheen_light_sample(s.lights, 1, v3_scale(d, 2), v2(0, 0), &sample) ? (double)sample.radiance.g : 0.0;
        assert_true(fabs(e - expected[i]) <= 1e-5); // the angle in float
    }
    light_scene_destroy(&s);
}

static void test_constant_environment(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    SheenLight light = {.kind = SHEEN_LIGHT_ENVIRONMENT, .radiance = rgb(1, 2, 3)};
    sheen_builder_add_light(s.builder, &light);
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    check(&s, 0, v3(7, 8, 9), v3_normalize(v3(1, 2, 3)), 3.14159265358979 * 2);
    light_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rectangle),
        cmocka_unit_test(test_triangle),
        cmocka_unit_test(test_quadrilateral_that_is_no_rectangle),
        cmocka_unit_test(test_disk),
        cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_sphere_cut_by_the_horizon),
        cmocka_unit_test(test_box),
        cmocka_unit_test(test_nothing_from_behind),
        cmocka_unit_test(test_point_spot_directional),
        cmocka_unit_test(test_constant_environment),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
