// SPDX-License-Identifier: Apache-2.0
// Irradiance on a plane under each kind of light against closed forms, as rendered pictures of the plane.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "analytic/path_kit.h"
#include "material/bsdf.h"
#include "math/sampler.h"
#include "math/warp.h"

static const float ALBEDO = 0.6f;

// The picture shows a few millimetres of the plane z = 0 about a point, obliquely from high above: over such a patch E
// changes by less than SLACK for lights half a metre away and more.
static const double SLACK = 1e-4;

typedef struct Plane {
    SheenBuilder *b;
    Vec3 at; // the point looked at
} Plane;

static Plane plane_begin(float x, float y)
{
    Plane p = {kit_begin(), v3(x, y, 0.0f)};
    kit_quad(p.b, v3(-50, -50, 0), v3(100, 0, 0), v3(0, 100, 0), kit_diffuse(p.b, ALBEDO));
    kit_camera(p.b, v3_add(p.at, v3(-1.0f, -1.5f, 0.5f)), p.at, v3(0, 0, 1), 0.001f);
    return p;
}

// Renders and compares with the irradiance E: the plane's radiance is albedo E / pi.
static void plane_expect(Plane *p, double E, uint32_t light_samples, const char *what)
{
    Kit kit;
    kit_end(p->b, 2, &kit);
    kit.work.options.bounces = 0;
    kit.work.options.light_samples = light_samples;
    kit.work.options.spp = 64;
    SheenFilm *film = kit_render(&kit, 0, NULL);
    double expected = (double)ALBEDO * E / (double)SHEEN_PI;
    if (E > 0.0)
        kit_assert_mean(film, expected, SLACK, 6e-3, what);
    else
        assert_true(kit_mean(film, 0.0).worst == 0.0);
    sheen_film_destroy(&film);
    kit_free(&kit);
}

static uint32_t black(SheenBuilder *b)
{
    return kit_diffuse(b, 0.0f);
}

// E = I cos / d^2 = I h / (h^2 + x^2)^(3/2).
static void test_point_light(void **state)
{
    (void)state;
    for (int i = 0; i < 3; ++i) {
        Plane p = plane_begin((float)i * 0.8f, 0.3f);
        SheenLight light = {.kind = SHEEN_LIGHT_POINT, .radiance = rgb_gray(5.0f), .shape = SHEEN_NONE};
        light.position = v3(0, 0.3f, 1.2f);
        sheen_builder_add_light(p.b, &light);
        double x = (double)p.at.x, h = (double)1.2f;
        plane_expect(&p, 5.0 * h / pow(h * h + x * x, 1.5), 1, "point light");
    }
}

// Full intensity within the inner cone, linear in the angle to zero at the outer one.
static void test_spot_light(void **state)
{
    (void)state;
    const double h = 2.0, inner = 0.2, outer = 0.5;
    static const double angle[] = {0.1, 0.35, 0.6};
    static const double share[] = {1.0, 0.5, 0.0};
    for (int i = 0; i < 3; ++i) {
        double x = h * tan(angle[i]);
        Plane p = plane_begin((float)x, 0.0f);
        SheenLight light = {.kind = SHEEN_LIGHT_SPOT,
                            .radiance = rgb_gray(5.0f),
                            .shape = SHEEN_NONE,
                            .position = v3(0, 0, (float)h),
                            .direction = v3(0, 0, -1),
                            .cos_inner = (float)cos(inner),
                            .cos_outer = (float)cos(outer)};
        sheen_builder_add_light(p.b, &light);
        plane_expect(&p, share[i] * 5.0 * h / pow(h * h + x * x, 1.5), 1, "spot light");
    }
}

static void test_directional_light(void **state)
{
    (void)state;
    for (int below = 0; below < 2; ++below) {
        Plane p = plane_begin(0.5f, 0.5f);
        SheenLight light = {.kind = SHEEN_LIGHT_DIRECTIONAL, .radiance = rgb_gray(3.0f), .shape = SHEEN_NONE};
        light.direction = v3(0.6f, 0, below ? 0.8f : -0.8f);
        sheen_builder_add_light(p.b, &light);
        plane_expect(&p, below ? 0.0 : 3.0 * 0.8, 1, "directional light");
    }
}

static void test_constant_environment(void **state)
{
    (void)state;
    Plane p = plane_begin(0, 0);
    kit_constant_environment(p.b, rgb_gray(2.0f));
    plane_expect(&p, 2.0 * (double)SHEEN_PI, 1, "environment");
}

// A disk of radius r parallel to the plane at height h, its axis a from the point. Source: howell2010.
static double disk_irradiance(double L, double r, double h, double a)
{
    double H = h / a, R = r / a, Z = 1.0 + H * H + R * R;
    double F = a > 0.0 ? 0.5 * (1.0 - (Z - 2.0 * R * R) / sqrt(Z * Z - 4.0 * R * R)) : r * r / (h * h + r * r);
    return L * (double)SHEEN_PI * F;
}

static void test_disk_light(void **state)
{
    (void)state;
    for (int i = 0; i < 6; ++i) {
        double a = i % 3 * 0.9, r = 0.5, h = 0.7;
        Plane p = plane_begin((float)a, 0.0f);
        uint32_t disk = kit_disk(p.b, v3(0, 0, (float)h), (float)r, v3(0, 0, -1), black(p.b));
        sheen_builder_add_area_light(p.b, disk, rgb_gray(4.0f));
        plane_expect(&p, disk_irradiance(4.0, r, h, a), i < 3 ? 1 : 4, "disk light");
    }
    // From behind a light is dark.
    Plane p = plane_begin(0.0f, 0.0f);
    sheen_builder_add_area_light(p.b, kit_disk(p.b, v3(0, 0, 1), 0.5f, v3(0, 0, 1), black(p.b)), rgb_gray(4.0f));
    plane_expect(&p, 0.0, 1, "disk light from behind");
}

// A rectangle a x b parallel to the plane at height h, one corner above the point. Source: howell2010.
static double corner_factor(double a, double b, double h)
{
    double A = a / h, B = b / h, u = sqrt(1.0 + A * A), v = sqrt(1.0 + B * B);
    return (A / u * atan(B / u) + B / v * atan(A / v)) / (2.0 * (double)SHEEN_PI);
}

static void test_rectangle_light(void **state)
{
    (void)state;
    // The rectangle [0, 1] x [0, 0.5]: from its corner, from below its middle, and from outside, where the factors of
    // the rectangles that reach up to the point add and subtract.
    static const float at[3][2] = {{0, 0}, {0.5f, 0.25f}, {-0.7f, 0}};
    for (int i = 0; i < 6; ++i) {
        int k = i % 3;
        double h = i < 3 ? 0.6 : 0.3, F = 0.0;
        if (k == 0) F = corner_factor(1.0, 0.5, h);
        if (k == 1) F = 4.0 * corner_factor(0.5, 0.25, h);
        if (k == 2) F = corner_factor(1.0 + (double)0.7f, 0.5, h) - corner_factor((double)0.7f, 0.5, h);
        Plane p = plane_begin(at[k][0], at[k][1]);
        uint32_t quad = kit_quad(p.b, v3(0, 0, (float)h), v3(0, 0.5f, 0), v3(1, 0, 0), black(p.b)); // faces down
        sheen_builder_add_area_light(p.b, quad, rgb_gray(4.0f));
        plane_expect(&p, 4.0 * (double)SHEEN_PI * F, i < 3 ? 1 : 4, "rectangle light");
    }
}

// A sphere that is wholly above the horizon: E = pi L (r / d)^2 cos.
static double sphere_irradiance(double L, double r, double x, double h)
{
    double d2 = x * x + h * h;
    return (double)SHEEN_PI * L * r * r / d2 * h / sqrt(d2);
}

static void test_sphere_light(void **state)
{
    (void)state;
    for (int i = 0; i < 3; ++i) {
        Plane p = plane_begin((float)i * 0.5f, 0.0f);
        uint32_t sphere = kit_sphere(p.b, v3(0, 0, 1), 0.45f, false, black(p.b));
        sheen_builder_add_area_light(p.b, sphere, rgb_gray(4.0f));
        plane_expect(&p, sphere_irradiance(4.0, (double)0.45f, i * 0.5, 1.0), 1, "sphere light");
    }
}

// A large mirror beside the plane shows a second sphere, which only scattered rays find: they must count fully.
static void test_light_in_a_mirror(void **state)
{
    (void)state;
    Plane p = plane_begin(1.5f, 0.0f);
    kit_quad(p.b, v3(0, -50, 0), v3(0, 100, 0), v3(0, 0, 100), kit_mirror(p.b)); // faces +x
    // Seen from the point, the sphere and its image are 37 degrees apart and 20 and 13 degrees in radius.
    uint32_t sphere = kit_sphere(p.b, v3(1.0f, 0, 2.0f), 0.7f, false, black(p.b));
    sheen_builder_add_area_light(p.b, sphere, rgb_gray(4.0f));
    double r = (double)0.7f;
    plane_expect(&p, sphere_irradiance(4.0, r, 0.5, 2.0) + sphere_irradiance(4.0, r, 2.5, 2.0), 1, "light in a mirror");
}

// Under a pane the sky is dimmed by the pane's transmittance: T = 1 - 2 R / (1 + R) for all inner reflections.
static void test_environment_through_a_pane(void **state)
{
    (void)state;
    Plane p = plane_begin(0, 0);
    uint32_t pane = kit_material(p.b, SHEEN_MATERIAL_THIN_DIELECTRIC, 0.0f, 1.5f);
    // So wide that only the lowest 1/2000 of the sky's sine, 1/4e6 of E, is not behind it.
    kit_quad(p.b, v3(-1000, -1000, 0.6f), v3(2000, 0, 0), v3(0, 2000, 0), pane);
    kit_constant_environment(p.b, rgb_gray(2.0f));
    double E = 0.0;
    enum { N = 2000 };
    for (int i = 0; i < N; ++i) {
        float c, cos_i = (float)sqrt((i + 0.5) / N); // cos^2 is uniform under the cosine
        double R = (double)sheen_fresnel_dielectric(cos_i, 1.5f, &c);
        E += 2.0 * (double)SHEEN_PI * (1.0 - 2.0 * R / (1.0 + R)) / N;
    }
    plane_expect(&p, E, 1, "environment through a pane");
}

typedef struct Estimate {
    double sum, sum2;
    int n;
} Estimate;

static void estimate_add(Estimate *e, double value)
{
    e->sum += value;
    e->sum2 += value * value;
    ++e->n;
}
static double estimate_mean(const Estimate *e)
{
    return e->sum / e->n;
}
static double estimate_error(const Estimate *e)
{
    double mean = estimate_mean(e);
    return sqrt((e->sum2 / e->n - mean * mean) / e->n);
}

// Irradiance from light samples alone.
static Estimate irradiance_by_lights(const Kit *kit, const SurfacePoint *s, int n)
{
    Estimate e = {0};
    for (int i = 0; i < n; ++i) {
        SheenSampler sampler = sampler_make(11u, (uint32_t)i);
        float u = sampler_1d(&sampler);
        uint32_t light;
        LightSample ls;
        double value = 0.0;
        float choice = sheen_lights_choose(kit->lights, s->p, s->ng, &u, &light);
        assert_true(choice > 0.0f);
        if (sheen_light_sample(kit->lights, light, s->p, sampler_2d(&sampler), &ls) && v3_dot(ls.wi, s->ng) > 0.0f) {
            Ray shadow = sheen_shadow_ray(s, &ls);
            if (!sheen_accel_occluded(kit->accel, &shadow))
                value = (double)(v3_dot(ls.wi, s->ng) * ls.radiance.g / choice);
        }
        estimate_add(&e, value);
    }
    return e;
}

// Irradiance from cosine-distributed rays alone.
static Estimate irradiance_by_rays(const Kit *kit, const SurfacePoint *s, int n)
{
    Estimate e = {0};
    Frame frame = frame_from_normal(s->ng);
    for (int i = 0; i < n; ++i) {
        SheenSampler sampler = sampler_make(12u, (uint32_t)i);
        Ray ray = sheen_surface_ray(s, frame_to_world(&frame, warp_cosine_hemisphere(sampler_2d(&sampler))));
        Hit hit;
        SurfacePoint found;
        Rgb L;
        sheen_accel_intersect(kit->accel, &ray, &hit);
        if (hit.shape == SHEEN_NONE) {
            L = sheen_environment(kit->scene, ray.d);
        } else {
            sheen_surface_from_hit(kit->scene, &ray, &hit, &found);
            L = sheen_emitted(kit->scene, &found, v3_neg(ray.d));
        }
        estimate_add(&e, (double)(L.g * SHEEN_PI));
    }
    return e;
}

// Lights of all kinds and sizes at once, shadowing each other: the weighted picture has the mean of either technique.
static void test_weighted_equals_each_technique(void **state)
{
    (void)state;
    Plane p = plane_begin(0.2f, -0.1f);
    uint32_t ball = kit_sphere(p.b, v3(0.3f, 0, 0.8f), 0.25f, false, black(p.b));
    uint32_t disk = kit_disk(p.b, v3(0, 0.2f, 1.6f), 0.8f, v3(0, 0, -1), black(p.b));
    uint32_t quad = kit_quad(p.b, v3(1.2f, -0.5f, 0.1f), v3(0, 0, 0.7f), v3(0, 1.0f, 0), black(p.b)); // faces -x
    sheen_builder_add_area_light(p.b, ball, rgb_gray(5.0f));
    sheen_builder_add_area_light(p.b, disk, rgb_gray(2.0f));
    sheen_builder_add_area_light(p.b, quad, rgb_gray(3.0f));
    kit_constant_environment(p.b, rgb_gray(0.5f));
    Kit kit;
    kit_end(p.b, 2, &kit);
    SurfacePoint s = {.p = p.at, .ng = v3(0, 0, 1), .ns = v3(0, 0, 1), .clearance = 1e-6f};
    Estimate by_lights = irradiance_by_lights(&kit, &s, 1 << 16), by_rays = irradiance_by_rays(&kit, &s, 1 << 16);
    double scale = (double)(ALBEDO * SHEEN_INV_PI);
    for (uint32_t light_samples = 1; light_samples <= 3; light_samples += 2) {
        kit.work.options.bounces = 0;
        kit.work.options.spp = 64;
        kit.work.options.light_samples = light_samples;
        SheenFilm *film = kit_render(&kit, 0, NULL);
        KitMean m = kit_mean(film, 0.0);
        assert_true(m.error < 2e-3 * m.mean);
        // The errors are those of independent samples, which these are better than: 4.5 of them are ample.
        double el = scale * estimate_error(&by_lights), er = scale * estimate_error(&by_rays);
        assert_true(el < 0.01 * m.mean && er < 0.01 * m.mean);
        assert_true(fabs(m.mean - scale * estimate_mean(&by_lights)) < 4.5 * hypot(m.error, el) + SLACK * m.mean);
        assert_true(fabs(m.mean - scale * estimate_mean(&by_rays)) < 4.5 * hypot(m.error, er) + SLACK * m.mean);
        sheen_film_destroy(&film);
    }
    kit_free(&kit);
}

// The first vertex takes as many light samples as asked for, and they are different ones: in the half shadow of a ball
// under a lamp eight of them leave much less noise than one.
static void test_light_samples(void **state)
{
    (void)state;
    Plane p = plane_begin(0.25f, 0.0f);
    kit_sphere(p.b, v3(0, 0, 0.5f), 0.25f, false, black(p.b));
    uint32_t lamp = kit_quad(p.b, v3(-0.3f, -0.3f, 2.0f), v3(0, 0.6f, 0), v3(0.6f, 0, 0), black(p.b)); // faces down
    sheen_builder_add_area_light(p.b, lamp, rgb_gray(4.0f));
    Kit kit;
    kit_end(p.b, 2, &kit);
    kit.work.options.bounces = 0;
    kit.work.options.spp = 1;
    SheenStats one = {0}, eight = {0};
    SheenFilm *film_one = kit_render(&kit, 0, &one);
    kit.work.options.light_samples = 8;
    SheenFilm *film_eight = kit_render(&kit, 0, &eight);
    assert_int_equal(one.rays_shadow, 32 * 32); // the whole lamp is above the horizon
    assert_int_equal(eight.rays_shadow, 8 * 32 * 32);
    double error_one = kit_mean(film_one, 0.0).error, error_eight = kit_mean(film_eight, 0.0).error;
    assert_true(error_one > 0.0 && error_eight < error_one / 2.5); // sqrt(8) = 2.8 when independent, better stratified
    sheen_film_destroy(&film_one);
    sheen_film_destroy(&film_eight);
    kit_free(&kit);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_point_light),
        cmocka_unit_test(test_spot_light),
        cmocka_unit_test(test_directional_light),
        cmocka_unit_test(test_constant_environment),
        cmocka_unit_test(test_disk_light),
        cmocka_unit_test(test_rectangle_light),
        cmocka_unit_test(test_sphere_light),
        cmocka_unit_test(test_light_in_a_mirror),
        cmocka_unit_test(test_environment_through_a_pane),
        cmocka_unit_test(test_weighted_equals_each_technique),
        cmocka_unit_test(test_light_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
