// SPDX-License-Identifier: Apache-2.0
// A sun with a disk: what it sends, where it is seen, and that no way of finding it counts twice.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "analytic/irradiance_kit.h"
#include "light/light.h"
#include "math/sampler.h"

static const float REAL = 0.0046757f; // half of 0.5358 degrees

static void add_sun(SheenBuilder *b, Vec3 to_sun, float disk, float irradiance)
{
    SheenLight sun = {.kind = SHEEN_LIGHT_DIRECTIONAL, .radiance = rgb_gray(irradiance), .disk = disk};
    sun.direction = v3_neg(to_sun);
    sheen_builder_add_light(b, &sun);
}

static double disk_radiance(double irradiance, double disk)
{
    return irradiance / ((double)SHEEN_PI * sin(disk) * sin(disk));
}

static SheenRenderSettings settings_of(int integrator, uint32_t bounces, uint32_t spp)
{
    SheenRenderSettings s = small_settings(bounces);
    s.integrator = integrator ? SHEEN_INTEGRATOR_PATH : SHEEN_INTEGRATOR_IRRADIANCE;
    s.options.spp = spp;
    return s;
}

// Samples fill the disk evenly, and the density is that of its solid angle: radiance over density is the irradiance.
static void test_samples_are_even_over_the_disk(void **state)
{
    (void)state;
    enum { N = 1 << 12 };
    static const float disks[] = {0.0002f, 0.0046757f, 0.1f, 1.2f};
    for (int i = 0; i < 4; ++i) {
        SheenBuilder *b = kit_begin();
        Vec3 to_sun = v3(0.6f, 0.0f, 0.8f);
        add_sun(b, to_sun, disks[i], 3.0f);
        kit_disk(b, v3(0, 0, 0), 1.0f, v3(0, 0, 1), kit_diffuse(b, 0.5f));
        Kit kit;
        kit_end(b, 1, &kit);
        uint32_t sun;
        assert_int_equal(sheen_lights_suns(kit.lights, &sun), 1);
        assert_false(sheen_light_is_delta(kit.lights, sun));
        double r = (double)disks[i], height = 2.0 * sin(0.5 * r) * sin(0.5 * r), facing = 0.0, inner = 0.0;
        for (uint32_t k = 0; k < N; ++k) {
            SheenSampler sampler = sampler_make(3, k);
            LightSample s;
            assert_true(sheen_light_sample(kit.lights, sun, v3(0, 0, 0), sampler_2d(&sampler), &s));
            assert_true(s.infinite && !s.delta);
            assert_true(fabs((double)s.pdf * 2.0 * (double)SHEEN_PI * height - 1.0) < 1e-5);
            facing += (double)(s.radiance.g * v3_dot(s.wi, to_sun)) / N;
            double sine = (double)v3_length(v3_cross(s.wi, to_sun));
            // Half of the solid angle is within 1 - cos = height / 2. The rim may round to either side.
            inner += 1.0 - sqrt(fmax(1.0 - sine * sine, 0.0)) < 0.5 * height ? 1.0 / N : 0.0;
            if (sine < 0.999 * sin(r)) {
                assert_true(sheen_light_pdf_escape(kit.lights, sun, s.wi) == s.pdf);
                assert_true(fabs((double)sheen_suns(kit.lights, s.wi).g / disk_radiance(3.0, r) - 1.0) < 1e-5);
            }
        }
        assert_true(fabs(facing / 3.0 - 1.0) < 1e-3);        // stratified: 1 / N of the disk is astray
        if (r > 0.01) assert_true(fabs(inner - 0.5) < 2e-3); // 1 - cos is lost in float for narrower ones
        Vec3 beside = v3_normalize(v3_add(to_sun, v3_scale(v3(0.8f, 0, -0.6f), 1.01f * tanf(disks[i]))));
        assert_true(rgb_is_black(sheen_suns(kit.lights, beside)));
        assert_true(sheen_light_pdf_escape(kit.lights, sun, beside) == 0.0f);
        assert_true(rgb_is_black(sheen_suns(kit.lights, v3_neg(to_sun))));
        kit_free(&kit);
    }
}

// The camera sees the disk, in a mirror too; the picture of all of it sums to the irradiance.
static void test_the_disk_is_seen(void **state)
{
    (void)state;
    for (int integrator = 0; integrator < 2; ++integrator)
        for (int mirrored = 0; mirrored < 2; ++mirrored)
            for (int whole = 0; whole < 2; ++whole) {
                SheenBuilder *b = kit_begin();
                add_sun(b, v3(0, 0, 1), REAL, 3.0f);
                if (mirrored) kit_quad(b, v3(-1, -1, 0), v3(2, 0, 0), v3(0, 2, 0), kit_mirror(b));
                float fov = whole ? 3.0f * REAL : 0.5f * REAL;
                if (mirrored)
                    kit_camera(b, v3(0, 0, 1), v3(0, 0, 0), v3(0, 1, 0), fov);
                else
                    kit_camera(b, v3(0, 0, 0), v3(0, 0, 1), v3(0, 1, 0), fov);
                SheenRenderSettings s = settings_of(integrator, 0, 16);
                SheenFilm *film = stage_picture(b, &s);
                double L = disk_radiance(3.0, (double)REAL), side = 2.0 * tan(0.5 * (double)fov);
                if (whole) // the rim passes through one pixel in twelve, 16 samples each
                    assert_true(fabs(film_mean(film) * side * side / 3.0 - 1.0) < 5e-3);
                else
                    assert_true(kit_mean(film, L).worst < 1e-5 * L);
                sheen_film_destroy(&film);
            }
}

// A wide sun, found by light samples and by the BSDF's own, lights a plane by its irradiance times the cosine; at the
// horizon by L (r - sin r cos r), the integral over the upper half of its disk. A faint lamp beside makes it be chosen.
static void test_a_plane_under_a_wide_sun(void **state)
{
    (void)state;
    for (int integrator = 0; integrator < 2; ++integrator)
        for (int low = 0; low < 2; ++low) {
            const float r = 0.5f;
            SheenBuilder *b = kit_begin();
            kit_quad(b, v3(-9, -9, 0), v3(18, 0, 0), v3(0, 18, 0), kit_diffuse(b, 0.5f));
            add_sun(b, low ? v3(1, 0, 0) : v3(0.6f, 0, 0.8f), r, 2.0f);
            SheenLight lamp = {.kind = SHEEN_LIGHT_POINT, .radiance = rgb_gray(0.001f), .position = v3(0, 0, 1)};
            sheen_builder_add_light(b, &lamp);
            kit_camera(b, v3(0, -1, 1), v3(0, 0, 0), v3(0, 0, 1), 0.01f);
            SheenRenderSettings s = settings_of(integrator, 0, 128);
            if (!integrator) s.options.light_samples = 1; // it is to choose
            SheenFilm *film = stage_picture(b, &s);
            double E = low ? disk_radiance(2.0, (double)r) * ((double)r - sin((double)r) * cos((double)r)) : 1.6;
            kit_assert_mean(film, 0.5 * (E + 0.001) / (double)SHEEN_PI, 1e-4, 5e-3, low ? "low sun" : "sun");
            sheen_film_destroy(&film);
        }
}

// A sun is a lamp far away: glossy surfaces show both alike, where light samples and reflected rays share the work.
static void test_a_sun_is_a_far_lamp(void **state)
{
    (void)state;
    for (int integrator = 0; integrator < 2; ++integrator) {
        double mean[2];
        for (int far = 0; far < 2; ++far) {
            const float r = 0.15f, distance = 2000.0f;
            const Vec3 to_sun = v3(0, -0.6f, 0.8f);
            SheenBuilder *b = kit_begin();
            SheenMaterial metal = {.kind = SHEEN_MATERIAL_ROUGH_CONDUCTOR,
                                   .specular_reflectance = sheen_texture_constant(rgb_gray(1.0f)),
                                   .eta = rgb_gray(0.2f),
                                   .k = rgb_gray(3.0f),
                                   .alpha_u = sheen_texture_constant(rgb_gray(0.15f)),
                                   .alpha_v = sheen_texture_constant(rgb_gray(0.15f)),
                                   .distribution = SHEEN_DISTRIBUTION_GGX,
                                   .name = "metal"};
            kit_sphere(b, v3(0, 0, 0), 1.0f, false, sheen_builder_add_material(b, &metal));
            float L = (float)disk_radiance(2.0, (double)r);
            if (far) {
                float radius = distance * tanf(r);
                uint32_t disk = kit_disk(b, v3_scale(to_sun, distance), radius, v3_neg(to_sun), kit_diffuse(b, 0.0f));
                sheen_builder_add_area_light(b, disk, rgb_gray(L));
            } else {
                add_sun(b, to_sun, r, 2.0f);
            }
            kit_camera(b, v3(0, -4, 0), v3(0, 0, 0), v3(0, 0, 1), 0.5f);
            SheenRenderSettings s = settings_of(integrator, 0, 64);
            SheenFilm *film = stage_picture(b, &s);
            mean[far] = film_mean(film);
            sheen_film_destroy(&film);
        }
        show("sun %.5f, lamp %.5f\n", mean[0], mean[1]);
        // 65536 samples, each off by about its size: 0.4 %, and half of it between independent ones.
        assert_true(mean[0] > 0.01 && fabs(mean[0] / mean[1] - 1.0) < 0.01);
    }
}

// In a scene read from numbers a disk too narrow to be found, or without a number, is a direction.
static void test_disks_out_of_range(void **state)
{
    (void)state;
    static const float disks[] = {0.0f, -1.0f, 1e-6f, NAN, 100.0f};
    for (int i = 0; i < 5; ++i) {
        SheenBuilder *b = kit_begin();
        add_sun(b, v3(0, 0, 1), disks[i], 3.0f);
        kit_disk(b, v3(0, 0, 0), 1.0f, v3(0, 0, 1), kit_diffuse(b, 0.5f));
        Kit kit;
        kit_end(b, 1, &kit);
        uint32_t sun;
        assert_int_equal(sheen_lights_suns(kit.lights, &sun), i == 4);
        if (i == 4) assert_true(kit.scene->lights[0].disk < 0.5f * SHEEN_PI);
        kit_free(&kit);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_samples_are_even_over_the_disk),
        cmocka_unit_test(test_the_disk_is_seen),
        cmocka_unit_test(test_a_plane_under_a_wide_sun),
        cmocka_unit_test(test_a_sun_is_a_far_lamp),
        cmocka_unit_test(test_disks_out_of_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
