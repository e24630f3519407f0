// SPDX-License-Identifier: Apache-2.0
// Area lights whose radiance is a texture: light samples against a dense quadrature and against rays that find the same
// light, on every shape; what the eye sees of it.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "analytic/irradiance_kit.h"
#include "light/emission.h"

/** Six texels, all different, row 0 on top; the blue ones are dark. */
static const Rgb texels[6] = {{1, 4, 0}, {2, 0, 0}, {0, 9, 1}, {3, 1, 0}, {0, 0, 0}, {5, 2, 0}};

static SheenTexture picture(bool nearest)
{
    SheenTexture t = sheen_texture_constant(rgb_gray(0.0f));
    t.kind = SHEEN_TEXTURE_BITMAP;
    t.bitmap = (SheenBitmap){.width = 3, .height = 2, .floats = texels};
    t.nearest = nearest;
    return t;
}

/** A tube without lids about the z axis, radius 1, from z = 0 to 1, in 16 flat strips; uv as a label. */
static uint32_t tube(SheenBuilder *b, Vec3 at, uint32_t material)
{
    enum { N = 16 };
    SheenArena *arena = sheen_builder_arena(b);
    Vec3 *p = SHEEN_ARENA_NEW(arena, Vec3, 2 * N + 3);
    Vec2 *uv = SHEEN_ARENA_NEW(arena, Vec2, 2 * N + 2);
    uint32_t(*t)[3] = sheen_arena_alloc(arena, (size_t)2 * N, sizeof *t);
    assert_true(p && uv && t);
    for (uint32_t i = 0; i <= N; ++i)
        for (uint32_t k = 0; k < 2; ++k) {
            float phi = 2.0f * SHEEN_PI * (float)i / N;
            p[2 * i + k] = v3_add(at, v3(cosf(phi), sinf(phi), (float)k));
            uv[2 * i + k] = v2((float)i / N, (float)k);
        }
    for (uint32_t i = 0; i < N; ++i) {
        const uint32_t a = 2 * i, quad[2][3] = {{a, a + 2, a + 3}, {a, a + 3, a + 1}};
        memcpy(t[2 * i], quad, sizeof quad);
    }
    SheenShape s = {.kind = SHEEN_SHAPE_MESH, .material = material, .light = SHEEN_NONE, .name = "tube"};
    s.mesh = (SheenMesh){
        .n_vertices = 2 * N + 2, .n_triangles = 2 * N, .p = p, .uv = uv, .triangles = (const uint32_t(*)[3])t};
    return sheen_builder_add_shape(b, &s);
}

enum { SQUARE, SLANTED, DISK, SPHERE, TUBE, SHAPES };

/** A lamp above the floor point (0, 0, 0), which faces up. */
static void lamp_kit(int shape, bool nearest, Kit *kit)
{
    SheenBuilder *b = kit_begin();
    uint32_t black = kit_diffuse(b, 0.0f), lamp = SHEEN_NONE;
    kit_camera(b, v3(0, 0, -1), v3(0, 0, 1), v3(0, 1, 0), 1.0f);
    if (shape == SQUARE) lamp = kit_quad(b, v3(-0.5f, 0.5f, 1), v3(1, 0, 0), v3(0, -1, 0), black);
    if (shape == SLANTED) lamp = kit_quad(b, v3(-0.5f, 0.5f, 1), v3(1, 0.4f, 0), v3(0, -1, 0.3f), black);
    if (shape == DISK) lamp = kit_disk(b, v3(0.3f, 0.2f, 1), 0.7f, v3(0, 0, -1), black);
    if (shape == SPHERE) lamp = kit_sphere(b, v3(0.3f, 0.2f, 2), 0.9f, false, black);
    if (shape == TUBE) lamp = tube(b, v3(0, 1.6f, 0.1f), black);
    SheenTexture t = picture(nearest);
    assert_int_not_equal(sheen_builder_add_textured_area_light(b, lamp, &t), SHEEN_NONE);
    kit_end(b, 1, kit);
}

/** Irradiance at the floor point, green: mean and standard error. */
typedef struct Estimate {
    double mean, error;
} Estimate;

static Estimate estimate_of(double n, double sum, double sum2)
{
    return (Estimate){sum / n, sqrt(fmax(sum2 / n - sum / n * (sum / n), 0.0) / n)};
}

static Estimate by_light_samples(const Kit *kit, uint32_t n)
{
    double sum = 0.0, sum2 = 0.0;
    for (uint32_t i = 0; i < n; ++i) {
        Vec2 u = v2(hash_to_unit(hash_u32(2 * i)), hash_to_unit(hash_u32(2 * i + 1)));
        LightSample s;
        double E = 0.0;
        if (sheen_light_sample(kit->lights, 0, v3(0, 0, 0), u, &s)) E = (double)(s.radiance.g * maxf(s.wi.z, 0.0f));
        sum += E;
        sum2 += E * E;
    }
    return estimate_of(n, sum, sum2);
}

static Estimate by_rays(const Kit *kit, uint32_t n)
{
    double sum = 0.0, sum2 = 0.0;
    for (uint32_t i = 0; i < n; ++i) {
        Vec3 d = warp_cosine_hemisphere(v2(hash_to_unit(hash_u32(2 * i + 7)), hash_to_unit(hash_u32(~i))));
        Ray ray = {v3(0, 0, 0), INFINITY, d};
        Hit hit;
        sheen_accel_intersect_many(kit->accel, SHEEN_INCOHERENT, 1, &ray, &hit);
        if (hit.shape == SHEEN_NONE) continue;
        SurfacePoint s;
        sheen_surface_from_hit(kit->scene, &ray, &hit, &s);
        double E = (double)(SHEEN_PI * sheen_emitted(kit->scene, &s, v3_neg(d)).g);
        sum += E;
        sum2 += E * E;
    }
    return estimate_of(n, sum, sum2);
}

static void test_light_samples_and_rays_find_the_same_light(void **state)
{
    (void)state;
    for (int shape = 0; shape < SHAPES; ++shape) {
        Kit kit;
        lamp_kit(shape, true, &kit);
        Estimate a = by_light_samples(&kit, 200000), b = by_rays(&kit, 200000);
        show("shape %d: %.5f +- %.5f, %.5f +- %.5f\n", shape, a.mean, a.error, b.mean, b.error);
        // Right estimators differ by more once in 150,000; the errors are small enough to tell texels apart.
        assert_true(fabs(a.mean - b.mean) < 4.5 * hypot(a.error, b.error));
        assert_true(a.error < 0.01 * a.mean && b.error < 0.02 * b.mean);
        kit_free(&kit);
    }
}

/** The square's plane is z = 1: E = integral of L cos^2 / d^2; midpoints, a thousand a side, 1e-5 off at texel edges.
 */
static void test_a_textured_square_has_its_quadrature(void **state)
{
    (void)state;
    for (int nearest = 0; nearest < 2; ++nearest) {
        Kit kit;
        lamp_kit(SQUARE, nearest, &kit);
        SheenTexture t = picture(nearest);
        enum { N = 1000 };
        double E = 0.0;
        for (int i = 0; i < N * N; ++i) {
            double u = (i % N + 0.5) / N, v = (double)(i / N) / N + 0.5 / N, x = u - 0.5, y = 0.5 - v;
            double d2 = x * x + y * y + 1.0;
            E += (double)sheen_texture_eval(&t, v2((float)u, (float)v)).g / (d2 * d2) / ((double)N * N);
        }
        Estimate a = by_light_samples(&kit, 200000);
        show("quadrature %.5f, samples %.5f +- %.5f\n", E, a.mean, a.error);
        assert_true(fabs(a.mean - E) < 4.5 * a.error + 2e-5);
        assert_true(a.error < 0.005 * E);
        kit_free(&kit);
    }
}

/** The points of a light sample carry the radiance that a ray toward them finds, each for itself. */
static void test_each_sample_has_the_radiance_of_its_point(void **state)
{
    (void)state;
    for (int shape = 0; shape < SHAPES; ++shape) {
        Kit kit;
        lamp_kit(shape, false, &kit);
        int n_same = 0, n = 0;
        for (uint32_t i = 0; i < 2000; ++i) {
            Vec2 u = v2(hash_to_unit(hash_u32(2 * i)), hash_to_unit(hash_u32(2 * i + 1)));
            LightSample sample;
            if (!sheen_light_sample(kit.lights, 0, v3(0, 0, 0), u, &sample)) continue;
            Ray ray = {v3(0, 0, 0), INFINITY, sample.wi};
            Hit hit;
            sheen_accel_intersect_many(kit.accel, SHEEN_INCOHERENT, 1, &ray, &hit);
            SurfacePoint s;
            if (hit.shape == SHEEN_NONE) continue; // grazes the rim
            sheen_surface_from_hit(kit.scene, &ray, &hit, &s);
            Rgb a = rgb_scale(sample.radiance, sample.pdf), b = sheen_emitted(kit.scene, &s, v3_neg(sample.wi));
            float close = 0.01f * (1.0f + rgb_max(b)); // bilinear texels turn over within 0.3 of uv
            bool same = fabsf(a.r - b.r) < close && fabsf(a.g - b.g) < close && fabsf(a.b - b.b) < close;
            n_same += same;
            ++n;
        }
        // A tube's sample may have another wall of the tube before it.
        assert_true(n > 300); // most of a tube is turned away
        show("shape %d: %d of %d\n", shape, n_same, n);
        assert_true(n_same >= n - (shape == TUBE ? n / 4 : n / 500));
        kit_free(&kit);
    }
}

/** Green of the texture's mean: over the unit square for a square, and over the surface for a piece of it. */
static void test_choices_go_by_the_mean_over_the_surface(void **state)
{
    (void)state;
    Kit kit;
    lamp_kit(SQUARE, true, &kit);
    double all = 0.0;
    for (int i = 0; i < 6; ++i) all += (double)(texels[i].r + texels[i].g + texels[i].b) / 18.0;
    // A thousand stratified points tell 6 texels' areas to a thirtieth of a texel.
    assert_true(fabs((double)sheen_emission_mean(kit.scene, &kit.scene->lights[0]) - all) < 0.01 * all);
    assert_true(fabsf(kit.scene->lights[0].radiance.g - 16.0f / 6.0f) < 1e-5f);
    kit_free(&kit);
}

/** Twelve pixels of the square: the eye sees the picture upright, its top row on top. */
static void test_the_eye_sees_the_picture(void **state)
{
    (void)state;
    for (int integrator = 0; integrator < 2; ++integrator) {
        SheenBuilder *b = kit_begin();
        SheenCamera c = {.name = "camera", .to_world = transform_identity(), .orthographic = true, .width = 6};
        c.height = 4;
        sheen_builder_add_camera(b, &c);
        // Left in the picture is +x: from the left, below, toward the right and up.
        float h = 2.0f / 3.0f;
        uint32_t lamp = kit_quad(b, v3(1, -h, 1), v3(-2, 0, 0), v3(0, 2.0f * h, 0), kit_diffuse(b, 0.0f));
        SheenTexture t = picture(true);
        sheen_builder_add_textured_area_light(b, lamp, &t);
        Stage stage = stage_end(b, 1);
        SheenRenderSettings s = small_settings(1);
        s.integrator = (SheenIntegrator)integrator;
        s.width = 6, s.height = 4;
        SheenFilm *film = stage_render(&stage, &s, NULL);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 6; ++x) {
                Rgb got = film->color[6 * y + x], want = texels[3 * (y / 2) + x / 2];
                assert_true(fabsf(got.r - want.r) < 1e-5f && fabsf(got.g - want.g) < 1e-5f);
            }
        sheen_film_destroy(&film);
        stage_free(&stage);
    }
}

/** A floor under a textured square, by both integrators. */
static void test_both_integrators_light_the_floor_alike(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    kit_camera(b, v3(0, -1.5f, 0.8f), v3(0, 0, 0), v3(0, 0, 1), 0.7f);
    kit_quad(b, v3(-2, -2, 0), v3(4, 0, 0), v3(0, 4, 0), kit_diffuse(b, 0.6f));
    uint32_t lamp = kit_quad(b, v3(-0.5f, 0.5f, 0.5f), v3(1, 0, 0), v3(0, -1, 0), kit_diffuse(b, 0.3f));
    SheenTexture t = picture(true);
    sheen_builder_add_textured_area_light(b, lamp, &t);
    Stage stage = stage_end(b, 2);
    SheenRenderSettings s = small_settings(2);
    s.options.spp = 16;
    SheenFilm *film = stage_render(&stage, &s, NULL), *reference = stage_reference(&stage, &s, 256, 1);
    double a = film_mean_of(film, 0, 8, 32, 32), r = film_mean_of(reference, 0, 8, 32, 32);
    show("irradiance %.5f, path %.5f\n", a, r);
    assert_true(fabs(a - r) < 0.01 * r); // noise of 16 samples in 768 pixels, and of the cache
    sheen_film_destroy(&film);
    sheen_film_destroy(&reference);
    stage_free(&stage);
}

/** Irradiance of a surface across the light's axis (+z) at distance 2 from it, at x, y metres there. */
static Rgb across(const Kit *kit, float x, float y)
{
    LightSample s;
    if (!sheen_light_sample(kit->lights, 0, v3(x, y, 2), v2(0.5f, 0.5f), &s)) return rgb_gray(0.0f);
    assert_true(s.delta && fabsf(v3_length(s.target)) == 0.0f);
    return rgb_scale(s.radiance, -s.wi.z);
}

static void picture_kit(SheenLightKind kind, const SheenTexture *t, Kit *kit)
{
    SheenBuilder *b = kit_begin();
    kit_camera(b, v3(0, 0, -1), v3(0, 0, 1), v3(0, 1, 0), 1.0f);
    kit_sphere(b, v3(0, 0, -5), 1.0f, false, kit_diffuse(b, 0.5f));
    SheenLight light = {.kind = kind,
                        .radiance = rgb(2, 2, 2),
                        .texture = t,
                        .direction = v3(0, 0, 1),
                        .cos_inner = cosf(0.5f),
                        .cos_outer = cosf(0.5f),
                        .tan_x = 0.6f,
                        .tan_y = 0.4f,
                        .to_world = transform_identity()};
    assert_int_not_equal(sheen_builder_add_light(b, &light), SHEEN_NONE);
    kit_end(b, 1, kit);
}

/** The texels' places on the plane: u runs along x, v against y; each is as bright at its border as in the middle. */
static void test_a_projector_lights_a_plane_as_its_picture_is(void **state)
{
    (void)state;
    SheenTexture t = picture(true);
    Kit kit;
    picture_kit(SHEEN_LIGHT_PROJECTOR, &t, &kit);
    for (int i = 0; i < 600; ++i) {
        // Not on the borders of texels.
        float u = ((float)(i % 30) + 0.37f) / 30.0f, v = ((float)(i / 30) + 0.37f) / 20.0f;
        Rgb E = across(&kit, 2.0f * 0.6f * (2.0f * u - 1.0f), 2.0f * 0.4f * (1.0f - 2.0f * v));
        Rgb texel = texels[(v > 0.5f ? 0 : 3) + (int)(3.0f * u)]; // row 0 is on top, at v = 1
        assert_float_equal(E.g, 2.0f * texel.g / 4.0f, 1e-5f * (1.0f + texel.g));
        assert_float_equal(E.r, 2.0f * texel.r / 4.0f, 1e-5f * (1.0f + texel.r));
    }
    assert_true(rgb_is_black(across(&kit, 1.21f, 0.0f)) && rgb_is_black(across(&kit, 0.0f, -0.81f)));
    LightSample s;
    assert_false(sheen_light_sample(kit.lights, 0, v3(0, 0, -2), v2(0.5f, 0.5f), &s)); // behind it
    kit_free(&kit);
}

/** A spot's picture is a factor on its intensity: on the plane the cosine's cube is seen. */
static void test_a_spots_picture_is_a_factor(void **state)
{
    (void)state;
    SheenTexture t = picture(true);
    Kit with, without;
    picture_kit(SHEEN_LIGHT_SPOT, &t, &with);
    picture_kit(SHEEN_LIGHT_SPOT, NULL, &without);
    int n_lit = 0;
    for (int i = 0; i < 600; ++i) {
        float u = ((float)(i % 30) + 0.37f) / 30.0f, v = ((float)(i / 30) + 0.37f) / 20.0f;
        float x = 2.0f * 0.6f * (2.0f * u - 1.0f), y = 2.0f * 0.4f * (1.0f - 2.0f * v);
        Rgb E = across(&with, x, y), plain = across(&without, x, y),
            texel = texels[(v > 0.5f ? 0 : 3) + (int)(3.0f * u)];
        float cosine = 2.0f / sqrtf(x * x + y * y + 4.0f);
        if (plain.g > 0.0f) assert_float_equal(plain.g, 2.0f * cosine * cosine * cosine / 4.0f, 1e-5f);
        assert_float_equal(E.g, plain.g * texel.g, 1e-5f * (1.0f + texel.g));
        n_lit += E.r > 0.0f;
    }
    assert_true(n_lit > 200);
    kit_free(&with);
    kit_free(&without);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_light_samples_and_rays_find_the_same_light),
        cmocka_unit_test(test_a_textured_square_has_its_quadrature),
        cmocka_unit_test(test_each_sample_has_the_radiance_of_its_point),
        cmocka_unit_test(test_choices_go_by_the_mean_over_the_surface),
        cmocka_unit_test(test_the_eye_sees_the_picture),
        cmocka_unit_test(test_both_integrators_light_the_floor_alike),
        cmocka_unit_test(test_a_projector_lights_a_plane_as_its_picture_is),
        cmocka_unit_test(test_a_spots_picture_is_a_factor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
