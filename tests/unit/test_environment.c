// SPDX-License-Identifier: Apache-2.0
// Environments: the look-up, the sampler, and the split into a soft part and a sampled one.
#include "unit/chi_squared.h"
#include "unit/light_scene.h"

static void assert_near(double got, double want, double tolerance)
{
    if (!(fabs(got - want) <= tolerance)) fail_msg("%.9g, want %.9g +- %.2g", got, want, tolerance);
}

static Transform turned(void)
{
    return transform_rotate(v3(1, 2, 3), 40 * 3.14159265358979 / 180);
}

#define WIDTH 24
#define HEIGHT 13

// Smooth sky, dark below, and a sun of one pixel.
static void paint(Rgb pixels[WIDTH * HEIGHT], float sun)
{
    for (int j = 0; j < HEIGHT; ++j)
        for (int i = 0; i < WIDTH; ++i)
            pixels[j * WIDTH + i] = j < 8 ? rgb(1 + 0.5f * sinf((float)i), 1, 2 - 0.1f * (float)j) : rgb_gray(0);
    pixels[3 * WIDTH + 1] = rgb(sun, 0.8f * sun, 0.6f * sun);
}

static LightScene scene_of_image(float sun, SheenEnvironmentSplit split)
{
    Rgb pixels[WIDTH * HEIGHT];
    paint(pixels, sun);
    LightScene s = light_scene_begin();
    add_environment(&s, WIDTH, HEIGHT, pixels, turned());
    light_scene_end(&s, split);
    return s;
}

// Values of Mitsuba 3.9's `envmap`, rotated by 40 degrees about (1, 2, 3).
static void test_lookup_as_mitsuba(void **state)
{
    (void)state;
    Rgb pixels[3 * 4];
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 4; ++i) pixels[j * 4 + i] = rgb(1 + (float)(j * 4 + i), 20 - 3 * (float)i, 0.5f * (float)j);
    LightScene s = light_scene_begin();
    add_environment(&s, 4, 3, pixels, turned());
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    static const struct {
        Vec3 d;
        double r, g, b;
    } expected[] = {
        {{0.0f, 1.0f, 0.0f}, 2.91097593, 18.7475185, 0.186685264},
        {{1.0f, 0.0f, 0.0f}, 7.07727098, 17.6099358, 0.660072923},
        {{0.0f, 0.0f, 1.0f}, 5.99564552, 14.9081545, 0.412295461},
        {{-0.32929278f, -0.5488213f, 0.76834982f}, 7.30519915, 13.7680244, 0.528484225},
        {{0.545454545f, 0.181818182f, -0.818181818f}, 5.97226238, 19.6851292, 0.608413219},
        {{-0.992372124f, 0.110263569f, 0.0551317846f}, 6.19081926, 11.6527319, 0.30104959},
    };
    for (size_t i = 0; i < sizeof expected / sizeof *expected; ++i) {
        Rgb l = sheen_environment(s.scene, expected[i].d);
        // Angles in float, times the steps of the image.
        assert_near((double)l.r, expected[i].r, 2e-5);
        assert_near((double)l.g, expected[i].g, 2e-5);
        assert_near((double)l.b, expected[i].b, 2e-6);
    }
    light_scene_destroy(&s);
}

// Between the last column and the first; at the poles, whose row is one point.
static void test_lookup_at_the_seam_and_the_poles(void **state)
{
    (void)state;
    Rgb pixels[3 * 4];
    for (int i = 0; i < 12; ++i) pixels[i] = i < 4 ? rgb_gray(7) : i < 8 ? rgb_gray((float)i) : rgb_gray(9);
    LightScene s = light_scene_begin();
    add_environment(&s, 4, 3, pixels, transform_identity());
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    assert_near((double)sheen_environment(s.scene, v3(0, 0, -1)).g, 0.5 * (4 + 7), 1e-5);
    assert_near((double)sheen_environment(s.scene, v3(0, 1, 0)).g, 7, 1e-5);
    assert_near((double)sheen_environment(s.scene, v3(0, -1, 0)).g, 9, 1e-5);
    light_scene_destroy(&s);
}

// ---- sampling ---------------------------------------------------------------------------------------------------

#define SUBDIVIDE 12
#define N_CELLS (WIDTH * (HEIGHT - 1))

// The place of a direction in the image, in cells of the sampler's grid.
static void place_of(const LightScene *s, Vec3 wi, double *x, double *y)
{
    Vec3 d = transform_vector(&s->scene->lights[0].to_light, wi);
    double u = atan2((double)d.x, -(double)d.z) / (2 * 3.14159265358979) * WIDTH - 0.5;
    *x = u < 0 ? u + WIDTH : u;
    *y = acos(fmax(-1, fmin(1, (double)d.y))) / 3.14159265358979 * (HEIGHT - 1);
}

static Vec3 direction_of(const LightScene *s, double x, double y)
{
    double phi = 2 * 3.14159265358979 * (x + 0.5) / WIDTH, theta = 3.14159265358979 * y / (HEIGHT - 1);
    Vec3 d = v3((float)(sin(theta) * sin(phi)), (float)cos(theta), (float)(-sin(theta) * cos(phi)));
    return transform_vector(&s->scene->lights[0].to_world, d);
}

/** Sums over midpoints within the cells: `f` of the direction times its solid angle. */
static double integrate(const LightScene *s, double (*f)(const LightScene *s, Vec3 wi), double cells[N_CELLS])
{
    double sum = 0;
    for (int j = 0; j < (HEIGHT - 1) * SUBDIVIDE; ++j) {
        double step = 3.14159265358979 / ((HEIGHT - 1) * SUBDIVIDE);
        double solid_angle = (cos(j * step) - cos((j + 1) * step)) * 2 * 3.14159265358979 / (WIDTH * SUBDIVIDE);
        for (int i = 0; i < WIDTH * SUBDIVIDE; ++i) {
            double value = f(s, direction_of(s, (i + 0.5) / SUBDIVIDE, (j + 0.5) / SUBDIVIDE)) * solid_angle;
            sum += value;
            if (cells) cells[j / SUBDIVIDE * WIDTH + i / SUBDIVIDE] += value;
        }
    }
    return sum;
}

static double density(const LightScene *s, Vec3 wi)
{
    return (double)sheen_light_pdf_escape(s->lights, 0, wi);
}

static const Vec3 normal = {0.26726124f, 0.53452248f, -0.80178373f};

static double whole_irradiance(const LightScene *s, Vec3 wi)
{
    return (double)(sheen_environment(s->scene, wi).g * maxf(v3_dot(wi, normal), 0));
}

static double soft_irradiance(const LightScene *s, Vec3 wi)
{
    return (double)(sheen_environment_soft(s->lights, wi).g * maxf(v3_dot(wi, normal), 0));
}

static void check_samples(float sun, SheenEnvironmentSplit split)
{
    enum { N = 300000 };
    LightScene s = scene_of_image(sun, split);
    assert_int_equal(sheen_lights_environment(s.lights), 0);
    static double observed[N_CELLS], expected[N_CELLS];
    memset(observed, 0, sizeof observed);
    memset(expected, 0, sizeof expected);
    double sum = integrate(&s, density, expected);
    for (int i = 0; i < N_CELLS; ++i) expected[i] *= N;
    Random r = {1, 0};
    Moments e = {0};
    for (int k = 0; k < N; ++k) {
        LightSample sample;
        assert_true(sheen_light_sample(s.lights, 0, v3(1, 2, 3), random_2d(&r), &sample));
        assert_true(sample.infinite && !sample.delta);
        double x, y;
        place_of(&s, sample.wi, &x, &y);
        int i = (int)fmin(x, WIDTH - 1), j = (int)fmin(y, HEIGHT - 2);
        observed[j * WIDTH + i] += 1;
        moments_add(&e, (double)(sample.radiance.g * maxf(v3_dot(sample.wi, normal), 0)));
        // What is sampled and what is left are the whole. Directions are floats: the sun's flank is steep, and near
        // the poles the azimuth is coarse.
        Rgb part = rgb_scale(sample.radiance, sample.pdf), soft = sheen_environment_soft(s.lights, sample.wi);
        double whole = (double)sheen_environment(s.scene, sample.wi).r,
               slack = 1e-5 * ((double)sun + whole) / fmax(sin(y * 3.14159265358979 / (HEIGHT - 1)), 1e-4);
        assert_near((double)part.r + (double)soft.r, whole, slack);
        // The same within rounding at the edges of cells; near the poles a sine in float.
        double pdf = density(&s, sample.wi);
        if (x - floor(x) > 1e-3 && x - floor(x) < 0.999 && y > 1e-2 && y < HEIGHT - 1.01)
            assert_near(pdf / (double)sample.pdf, 1, 2e-3);
    }
    assert_near(sum, 1, 1e-3); // midpoints, in a smooth density
    assert_true(chi_squared_deviation(N_CELLS, observed, expected) < CHI_SQUARED_LIMIT);
    // Sampled and soft light are the whole also in sum; midpoints are good to 1e-3.
    double whole = integrate(&s, whole_irradiance, NULL), soft = integrate(&s, soft_irradiance, NULL);
    assert_near(moments_mean(&e) + soft, whole, 5 * moments_error(&e) + 1e-3 * whole);
    if (split == SHEEN_ENVIRONMENT_WHOLE)
        assert_true(soft == 0);
    else
        assert_true(soft > 0.05 * whole && soft < 0.95 * whole);
    light_scene_destroy(&s);
}

static void test_samples_follow_the_density(void **state)
{
    (void)state;
    check_samples(1, SHEEN_ENVIRONMENT_WHOLE);
    check_samples(1000, SHEEN_ENVIRONMENT_WHOLE);
    check_samples(100, SHEEN_ENVIRONMENT_HARD);
}

// One bright pixel in the dark: E of its bilinear tent by quadrature, and every sample meets it.
static void test_one_bright_pixel(void **state)
{
    (void)state;
    Rgb pixels[WIDTH * HEIGHT] = {{0}};
    pixels[4 * WIDTH] = rgb_gray(1000); // at the seam
    LightScene s = light_scene_begin();
    add_environment(&s, WIDTH, HEIGHT, pixels, transform_identity());
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    Random r = {4, 0};
    Moments e = {0};
    for (int i = 0; i < 20000; ++i) {
        LightSample sample;
        assert_true(sheen_light_sample(s.lights, 0, v3(0, 0, 0), random_2d(&r), &sample));
        assert_true(sample.radiance.g > 0);
        moments_add(&e, (double)(sample.radiance.g * maxf(v3_dot(sample.wi, normal), 0)));
    }
    double whole = integrate(&s, whole_irradiance, NULL);
    assert_near(moments_mean(&e), whole, 5 * moments_error(&e) + 5e-3 * whole);
    // The density is the light itself: only cosine and sine vary.
    assert_true(moments_error(&e) * sqrt(20000) < 0.25 * whole);
    light_scene_destroy(&s);
}

// Wherever there is light that the sampler answers for, it has a density.
static void test_density_where_there_is_light(void **state)
{
    (void)state;
    for (int split = 0; split < 2; ++split) {
        LightScene s = scene_of_image(100, split ? SHEEN_ENVIRONMENT_HARD : SHEEN_ENVIRONMENT_WHOLE);
        Random r = {9, 0};
        for (int i = 0; i < 200000; ++i) {
            Vec3 wi = warp_sphere(random_2d(&r));
            Rgb rest = rgb_sub(sheen_environment(s.scene, wi), sheen_environment_soft(s.lights, wi));
            if (rgb_luminance(rest) > 1e-4f) assert_true(density(&s, wi) > 0);
        }
        light_scene_destroy(&s);
    }
}

// ---- the split --------------------------------------------------------------------------------------------------

static void test_even_environments_have_no_hard_part(void **state)
{
    (void)state;
    Rgb pixels[WIDTH * HEIGHT];
    paint(pixels, 1); // nothing over four times the mean
    for (int image = 0; image < 2; ++image) {
        LightScene s = light_scene_begin();
        SheenLight constant = {.kind = SHEEN_LIGHT_ENVIRONMENT, .radiance = rgb(1, 2, 3)};
        if (image)
            add_environment(&s, WIDTH, HEIGHT, pixels, turned());
        else
            sheen_builder_add_light(s.builder, &constant);
        light_scene_end(&s, SHEEN_ENVIRONMENT_HARD);
        assert_int_equal(sheen_lights_count(s.lights), 0);
        assert_int_equal(sheen_lights_environment(s.lights), SHEEN_NONE);
        Rgb soft = sheen_environment_soft(s.lights, normal), whole = sheen_environment(s.scene, normal);
        assert_memory_equal(&soft, &whole, sizeof soft);
        assert_true(whole.g > 0);
        light_scene_destroy(&s);
    }
}

static void test_no_environment(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    SheenLight point = {.kind = SHEEN_LIGHT_POINT, .radiance = rgb_gray(1)};
    sheen_builder_add_light(s.builder, &point);
    light_scene_end(&s, SHEEN_ENVIRONMENT_HARD);
    assert_true(rgb_is_black(sheen_environment(s.scene, normal)));
    assert_true(rgb_is_black(sheen_environment_soft(s.lights, normal)));
    assert_int_equal(sheen_lights_environment(s.lights), SHEEN_NONE);
    light_scene_destroy(&s);
}

static void test_bad_pixels(void **state)
{
    (void)state;
    for (int height = 1; height <= HEIGHT; height += HEIGHT - 1) {
        Rgb pixels[WIDTH * HEIGHT];
        for (int i = 0; i < WIDTH * HEIGHT; ++i) pixels[i] = rgb(1, 1, 1);
        pixels[2] = rgb(NAN, -1, 2);
        pixels[5] = rgb(INFINITY, 1, 1);
        LightScene s = light_scene_begin();
        add_environment(&s, WIDTH, (uint32_t)height, pixels, transform_identity());
        light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
        Random r = {9, 0};
        for (int i = 0; i < 10000; ++i) {
            Rgb l = sheen_environment(s.scene, warp_sphere(random_2d(&r)));
            assert_true(l.r >= 0 && l.g >= 0 && rgb_finite(l));
            LightSample sample;
            if (!sheen_light_sample(s.lights, 0, normal, random_2d(&r), &sample)) continue;
            assert_true(rgb_finite(sample.radiance) && isfinite(sample.pdf) && v3_finite(sample.wi));
        }
        light_scene_destroy(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lookup_as_mitsuba),
        cmocka_unit_test(test_lookup_at_the_seam_and_the_poles),
        cmocka_unit_test(test_samples_follow_the_density),
        cmocka_unit_test(test_one_bright_pixel),
        cmocka_unit_test(test_density_where_there_is_light),
        cmocka_unit_test(test_even_environments_have_no_hard_part),
        cmocka_unit_test(test_no_environment),
        cmocka_unit_test(test_bad_pixels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
