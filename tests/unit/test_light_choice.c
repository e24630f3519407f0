// SPDX-License-Identifier: Apache-2.0
// The choice among lights: probabilities that are probabilities, that are kept, that miss no light, and that fit.
#include "unit/chi_squared.h"
#include "unit/light_scene.h"

static Vec3 random_point(Random *r, float size)
{
    float x = random_in(r, -size, size), y = random_in(r, -size, size);
    return v3(x, y, random_in(r, -size, size));
}

static void add_random_rectangle(LightScene *s, Random *r, Vec3 center, float size)
{
    Frame f = frame_from_normal(warp_sphere(random_2d(r)));
    Vec3 x = v3_scale(f.t, random_in(r, 0.1f, 1) * size), y = v3_scale(f.b, random_in(r, 0.1f, 1) * size);
    Vec3 v[4] = {center, v3_add(center, x), v3_add(v3_add(center, x), y), v3_add(center, y)};
    add_quad(s, v, rgb_gray(random_in(r, 0.1f, 3)));
}

/** An open mesh of three triangles in a fan, bent. */
static void add_random_fan(LightScene *s, Random *r, Vec3 center)
{
    Vec3 v[5] = {center};
    for (int i = 1; i < 5; ++i) v[i] = v3_add(center, random_point(r, 0.5f));
    static const uint32_t t[3][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
    add_mesh(s, 5, v, 3, t, rgb_gray(random_in(r, 0.1f, 3)));
}

/** Lights of every kind within a cube of 4 m; 15 of them. */
static LightScene scene_of_all_kinds(uint32_t seed)
{
    Random r = {seed, 0};
    LightScene s = light_scene_begin();
    for (int i = 0; i < 3; ++i) add_random_rectangle(&s, &r, random_point(&r, 2), 1);
    add_random_fan(&s, &r, random_point(&r, 2));
    add_random_fan(&s, &r, random_point(&r, 2));
    Vec3 a = random_point(&r, 2);
    add_box(&s, a, v3_add(a, v3(0.3f, 0.5f, 0.7f)), rgb_gray(1));
    add_sphere(&s, random_point(&r, 2), 0.4f, false, rgb_gray(2));
    add_sphere(&s, v3(0, 0, 0), 20, true, rgb_gray(0.1f));
    add_triangle(&s, random_point(&r, 2), random_point(&r, 2), random_point(&r, 2), rgb_gray(1));
    Frame f = frame_from_normal(warp_sphere(random_2d(&r)));
    add_disk(&s, random_point(&r, 2), v3_scale(f.t, 0.3f), v3_scale(f.b, 0.6f), rgb_gray(3));
    for (int i = 0; i < 2; ++i) {
        SheenLight point = {.kind = SHEEN_LIGHT_POINT, .radiance = rgb(0.1f, 2, 1), .position = random_point(&r, 2)};
        sheen_builder_add_light(s.builder, &point);
    }
    SheenLight spot = {.kind = SHEEN_LIGHT_SPOT,
                       .radiance = rgb_gray(5),
                       .position = random_point(&r, 2),
                       .direction = warp_sphere(random_2d(&r)),
                       .cos_inner = 0.9f,
                       .cos_outer = 0.5f};
    sheen_builder_add_light(s.builder, &spot);
    SheenLight sun = {.kind = SHEEN_LIGHT_DIRECTIONAL, .radiance = rgb_gray(1), .direction = v3(0.6f, 0, -0.8f)};
    sheen_builder_add_light(s.builder, &sun);
    Rgb pixels[8 * 4] = {{0}};
    pixels[10] = rgb(4, 3, 2);
    add_environment(&s, 8, 4, pixels, transform_identity());
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    assert_int_equal(sheen_lights_count(s.lights), 15);
    return s;
}

static LightScene scene_of_many(uint32_t n)
{
    Random r = {5, 0};
    LightScene s = light_scene_begin();
    for (uint32_t i = 0; i < n; ++i) {
        Vec3 p = random_point(&r, 5);
        if (i % 3 == 0)
            add_random_rectangle(&s, &r, p, 0.2f);
        else if (i % 3 == 1)
            add_sphere(&s, p, 0.05f, false, rgb_gray(1));
        else
            sheen_builder_add_light(
                s.builder, &(SheenLight){.kind = SHEEN_LIGHT_POINT, .radiance = rgb_gray(0.01f), .position = p});
    }
    SheenLight sun = {.kind = SHEEN_LIGHT_DIRECTIONAL, .radiance = rgb_gray(1), .direction = v3(0.6f, 0, -0.8f)};
    sheen_builder_add_light(s.builder, &sun);
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    assert_int_equal(sheen_lights_count(s.lights), n + 1);
    return s;
}

// ---- probabilities ----------------------------------------------------------------------------------------------

// The rest to 1 is the probability of choosing none: with many lights, of a group that holds none in view.
static void check_sum(const LightScene *s, int n_points, double least)
{
    Random r = {11, 0};
    uint32_t n_lights = sheen_lights_count(s->lights);
    for (int i = 0; i < n_points; ++i) {
        Vec3 p = random_point(&r, 3), n = warp_sphere(random_2d(&r));
        double sum = 0;
        for (uint32_t k = 0; k < n_lights; ++k) sum += (double)sheen_lights_choose_probability(s->lights, p, n, k);
        if (!(sum <= 1 + 1e-5 && sum >= least - 1e-5)) fail_msg("probabilities sum to %.9g", sum);
    }
}

// Frequencies are the probabilities, and the rescaled number is uniform.
static void check_frequencies(const LightScene *s, Vec3 p, Vec3 n)
{
    enum { N = 100000, BINS = 64, MAX_LIGHTS = 2048 };
    static double observed[MAX_LIGHTS], expected[MAX_LIGHTS], bins[BINS], flat[BINS];
    uint32_t n_lights = sheen_lights_count(s->lights);
    assert_true(n_lights < MAX_LIGHTS);
    memset(observed, 0, sizeof observed);
    memset(bins, 0, sizeof bins);
    expected[n_lights] = N; // none
    for (uint32_t i = 0; i < n_lights; ++i) {
        expected[i] = N * (double)sheen_lights_choose_probability(s->lights, p, n, i);
        expected[n_lights] -= expected[i];
    }
    expected[n_lights] = fmax(expected[n_lights], 0);
    Random r = {3, 0};
    double n_chosen = 0;
    for (int i = 0; i < N; ++i) {
        float u = random_1d(&r);
        uint32_t light;
        float probability = sheen_lights_choose(s->lights, p, n, &u, &light);
        if (probability == 0) {
            observed[n_lights] += 1;
            continue;
        }
        n_chosen += 1;
        assert_true(light < n_lights && u >= 0 && u < 1);
        assert_true(probability == sheen_lights_choose_probability(s->lights, p, n, light));
        observed[light] += 1;
        bins[(int)(u * BINS)] += 1;
    }
    for (int i = 0; i < BINS; ++i) flat[i] = n_chosen / BINS;
    assert_true(chi_squared_deviation(n_lights + 1, observed, expected) < CHI_SQUARED_LIMIT);
    assert_true(chi_squared_deviation(BINS, bins, flat) < CHI_SQUARED_LIMIT);
}

static void test_probabilities(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 3; ++seed) {
        LightScene s = scene_of_all_kinds(seed);
        check_sum(&s, 2000, 1);
        check_frequencies(&s, v3(0.1f, 0.2f, 0.3f), v3_normalize(v3(1, -2, 3)));
        light_scene_destroy(&s);
    }
}

static void test_probabilities_of_many(void **state)
{
    (void)state;
    const uint32_t n[] = {255, 256, 1000, 2000};
    for (size_t i = 0; i < sizeof n / sizeof *n; ++i) {
        LightScene s = scene_of_many(n[i]);
        check_sum(&s, 5, n[i] < 256 ? 1 : 0.95);
        if (n[i] == 1000) check_frequencies(&s, v3(0.1f, 0.2f, 0.3f), v3_normalize(v3(1, -2, 3)));
        light_scene_destroy(&s);
    }
}

static void test_too_many(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    SheenLight sun = {.kind = SHEEN_LIGHT_DIRECTIONAL, .radiance = rgb_gray(1), .direction = v3(0, 0, -1)};
    for (int i = 0; i < 257; ++i) sheen_builder_add_light(s.builder, &sun);
    assert_int_equal(sheen_builder_commit(&s.builder, &s.scene), SHEEN_OK);
    assert_int_equal(sheen_lights_create(s.scene, SHEEN_ENVIRONMENT_WHOLE, NULL, &s.lights), SHEEN_ERR_UNSUPPORTED);
    assert_null(s.lights);
    light_scene_destroy(&s);
}

static void test_one_and_none(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    float u = 0.3f;
    uint32_t light;
    assert_true(sheen_lights_choose(s.lights, v3(0, 0, 0), v3(0, 0, 1), &u, &light) == 0);
    light_scene_destroy(&s);
    s = light_scene_begin();
    add_sphere(&s, v3(0, 0, 3), 1, false, rgb_gray(1));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    assert_true(sheen_lights_choose(s.lights, v3(0, 0, 0), v3(0, 0, 1), &u, &light) == 1);
    assert_true(u == 0.3f && light == 0);
    assert_true(sheen_lights_choose_probability(s.lights, v3(0, 0, 0), v3(0, 0, 1), 0) == 1);
    light_scene_destroy(&s);
}

// Both lamps are under the floor: no light is chosen.
static void test_none_above_the_horizon(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_sphere(&s, v3(0, 0, -3), 1, false, rgb_gray(1));
    add_sphere(&s, v3(5, 0, -2), 1, false, rgb_gray(1));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    float u = 0.3f;
    uint32_t light;
    assert_true(sheen_lights_choose(s.lights, v3(0, 0, 0), v3(0, 0, 1), &u, &light) == 0);
    assert_true(sheen_lights_choose_probability(s.lights, v3(0, 0, 0), v3(0, 0, 1), 0) == 0);
    light_scene_destroy(&s);
}

static void test_points_of_nonsense(void **state)
{
    (void)state;
    LightScene s = scene_of_all_kinds(1);
    const float bad[] = {NAN, INFINITY, 1e30f, -1e38f};
    for (int i = 0; i < 4; ++i) {
        float u = 0.5f;
        uint32_t light = 0;
        float probability = sheen_lights_choose(s.lights, v3(bad[i], 0, 0), v3(0, 0, 1), &u, &light);
        assert_true(probability >= 0 && probability <= 1 && light < 15);
    }
    light_scene_destroy(&s);
}

// ---- fit --------------------------------------------------------------------------------------------------------

/** Irradiance of each light by n samples. @return the sum */
static double irradiances(const LightScene *s, Vec3 p, Vec3 n, int n_samples, Random *r, double e[])
{
    double sum = 0;
    for (uint32_t k = 0; k < sheen_lights_count(s->lights); ++k) {
        e[k] = 0;
        for (int i = 0; i < n_samples; ++i) {
            LightSample sample;
            if (!sheen_light_sample(s->lights, k, p, random_2d(r), &sample)) continue;
            Rgb l = sample.radiance;
            e[k] += (double)((l.r + l.g + l.b) / 3 * maxf(v3_dot(sample.wi, n), 0)) / n_samples;
        }
        sum += e[k];
    }
    return sum;
}

// A random search for a point where a light shines but is never asked.
static void check_none_missed(const LightScene *s, int n_points)
{
    static double e[2048];
    Random r = {17, 0};
    for (int i = 0; i < n_points; ++i) {
        Vec3 p = random_point(&r, 3), n = warp_sphere(random_2d(&r));
        double sum = irradiances(s, p, n, 4, &r, e);
        for (uint32_t k = 0; k < sheen_lights_count(s->lights); ++k) {
            // Less than this is within rounding of the horizon.
            if (!(e[k] > 1e-6 * sum)) continue;
            if (!(sheen_lights_choose_probability(s->lights, p, n, k) > 0))
                fail_msg("light %u brings %g of %g to (%g, %g, %g) but is never chosen", k, e[k], sum, (double)p.x,
                         (double)p.y, (double)p.z);
        }
    }
}

static void test_no_light_is_missed(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 10; ++seed) {
        LightScene s = scene_of_all_kinds(seed);
        check_none_missed(&s, 2000);
        light_scene_destroy(&s);
    }
    LightScene s = scene_of_many(400);
    check_none_missed(&s, 5);
    light_scene_destroy(&s);
}

// A strip of which only the end is above the horizon: on average it is well below.
static void test_a_strip_that_ends_above_the_horizon(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    const Vec3 strip[4] = {{1, -0.01f, -1}, {1, -0.01f, 0.05f}, {1, 0.01f, 0.05f}, {1, 0.01f, -1}}; // faces the origin
    add_quad(&s, strip, rgb_gray(1));
    add_sphere(&s, v3(0, 0, 3), 0.1f, false, rgb_gray(1));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    double e[2];
    Random r = {1, 0};
    irradiances(&s, v3(0, 0, 0), v3(0, 0, 1), 1000, &r, e);
    assert_true(e[0] > 1e-5);
    assert_true(sheen_lights_choose_probability(s.lights, v3(0, 0, 0), v3(0, 0, 1), 0) > 1e-4f);
    light_scene_destroy(&s);
}

/** Relative standard deviation of an estimate by one light, if the chosen light were known without noise. */
static double noise_of_choice(const LightScene *s, int n_points, Vec3 (*place)(Random *r), Vec3 n, double *worst)
{
    static double e[64];
    Random r = {23, 0};
    double mean = 0;
    *worst = 0;
    for (int i = 0; i < n_points; ++i) {
        Vec3 p = place(&r);
        double sum = irradiances(s, p, n, 256, &r, e), second = 0;
        for (uint32_t k = 0; k < sheen_lights_count(s->lights); ++k)
            if (e[k] > 0) second += e[k] * e[k] / (double)sheen_lights_choose_probability(s->lights, p, n, k);
        double noise = sqrt(fmax(second / (sum * sum) - 1, 0));
        mean += noise / n_points;
        *worst = fmax(*worst, noise);
    }
    return mean;
}

static Vec3 on_the_floor(Random *r)
{
    return v3(random_in(r, -3, 3), random_in(r, -3, 3), 0);
}

static Vec3 on_the_wall(Random *r)
{
    return v3(-3, random_in(r, -3, 3), random_in(r, 0, 3));
}

// A room with twelve lamps under the ceiling and a large window: the estimates are so close that almost all noise is
// left to where on the light.
static void test_the_choice_fits_rectangles(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    for (int i = 0; i < 12; ++i) {
        float x = -2.4f + 1.6f * (float)(i % 4), y = -2 + 2 * (float)(i / 4);
        Vec3 v[4] = {{x, y, 2.9f}, {x, y + 0.5f, 2.9f}, {x + 0.5f, y + 0.5f, 2.9f}, {x + 0.5f, y, 2.9f}};
        add_quad(&s, v, rgb_gray(10));
    }
    Vec3 window[4] = {{3, -2, 0.5f}, {3, -2, 2.5f}, {3, 2, 2.5f}, {3, 2, 0.5f}}; // into the room
    add_quad(&s, window, rgb_gray(5));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    double worst, mean = noise_of_choice(&s, 500, on_the_floor, v3(0, 0, 1), &worst);
    // Measured 0.009 and 0.036; power alone would give 0.9.
    if (!(mean < 0.02 && worst < 0.1)) fail_msg("floor: noise %.3f, worst %.3f", mean, worst);
    mean = noise_of_choice(&s, 500, on_the_wall, v3(1, 0, 0), &worst);
    if (!(mean < 0.02 && worst < 0.1)) fail_msg("wall: noise %.3f, worst %.3f", mean, worst);
    light_scene_destroy(&s);
}

static void test_the_choice_fits_all_kinds(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 4; ++seed) {
        LightScene s = scene_of_all_kinds(seed);
        double worst, mean = noise_of_choice(&s, 100, on_the_floor, v3_normalize(v3(1, 2, 3)), &worst);
        // Measured 0.08 to 0.13, up to 1.6 where a part of the environment that is below the horizon is asked for.
        if (!(mean < 0.2 && worst < 2.5)) fail_msg("all kinds: noise %.3f, worst %.3f", mean, worst);
        light_scene_destroy(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_probabilities),
        cmocka_unit_test(test_probabilities_of_many),
        cmocka_unit_test(test_too_many),
        cmocka_unit_test(test_one_and_none),
        cmocka_unit_test(test_none_above_the_horizon),
        cmocka_unit_test(test_points_of_nonsense),
        cmocka_unit_test(test_no_light_is_missed),
        cmocka_unit_test(test_a_strip_that_ends_above_the_horizon),
        cmocka_unit_test(test_the_choice_fits_rectangles),
        cmocka_unit_test(test_the_choice_fits_all_kinds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
