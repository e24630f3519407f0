// SPDX-License-Identifier: Apache-2.0
// Pass 1: camera rays, the order of their samples, and shading points straight ahead, in mirrors and behind glass.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "analytic/path_kit.h"
#include "integrator/visibility.h"

// ---- camera -----------------------------------------------------------------------------------------------------

static void assert_direction(Vec3 d, Vec3 expected)
{
    assert_true(v3_length(v3_sub(d, v3_normalize(expected))) < 2e-6f);
}

// The horizontal angle is across the width, whatever the height; x in the picture is to the camera's right.
static void test_camera_rays(void **state)
{
    (void)state;
    static const uint32_t sizes[3][2] = {{40, 20}, {20, 40}, {1, 1}};
    for (int i = 0; i < 3; ++i) {
        float w = (float)sizes[i][0], h = (float)sizes[i][1], half = tanf(0.6f), high = half * h / w;
        SheenCamera camera = {.to_world = transform_look_at(v3(1, 2, 3), v3(1, 5, 3), v3(0, 0, 1)), .fov_x = 1.2f};
        SheenEye eye = sheen_eye(&camera, sizes[i][0], sizes[i][1]);
        // Looks along +y with z up: the right hand of the picture is +x.
        Ray center = sheen_eye_ray(&eye, 0.5f * w, 0.5f * h);
        assert_true(center.o.x == 1.0f && center.o.y == 2.0f && center.o.z == 3.0f && isinf(center.t_max));
        assert_direction(center.d, v3(0, 1, 0));
        assert_direction(sheen_eye_ray(&eye, 0, 0.5f * h).d, v3(-half, 1, 0));
        assert_direction(sheen_eye_ray(&eye, w, 0.5f * h).d, v3(half, 1, 0));
        assert_direction(sheen_eye_ray(&eye, 0, 0).d, v3(-half, 1, high));
        assert_direction(sheen_eye_ray(&eye, w, h).d, v3(half, 1, -high));
        assert_true(fabsf(eye.pixel - 2.0f * half / w) < 1e-6f);
    }
}

// A window of the film sees what the whole film sees there, and so does a film that is shifted.
static void test_windows_of_the_film(void **state)
{
    (void)state;
    SheenCamera camera = {.to_world = transform_look_at(v3(1, 2, 3), v3(1, 5, 3), v3(0, 0, 1)), .fov_x = 1.2f};
    for (int orthographic = 0; orthographic < 2; ++orthographic) {
        camera.orthographic = orthographic;
        camera.cut_lo = camera.cut_hi = v2(0, 0);
        SheenEye whole = sheen_eye(&camera, 40, 20);
        camera.cut_lo = v2(0.25f, 0.5f), camera.cut_hi = v2(0.5f, 0.25f); // 10 x 5 pixels from (10, 10) on
        SheenEye window = sheen_eye(&camera, 10, 5);
        camera.cut_lo = v2(0.1f, 0.2f), camera.cut_hi = v2(-0.1f, -0.2f);
        SheenEye shifted = sheen_eye(&camera, 40, 20);
        for (int i = 0; i < 3; ++i) {
            float x = 4.0f * (float)i, y = 2.0f * (float)i;
            Ray ray = sheen_eye_ray(&whole, 10.0f + x, 10.0f + y), part = sheen_eye_ray(&window, x, y);
            assert_direction(part.d, ray.d);
            assert_true(v3_length(v3_sub(part.o, ray.o)) < 1e-6f);
            ray = sheen_eye_ray(&whole, 4.0f + x, 4.0f + y), part = sheen_eye_ray(&shifted, x, y);
            assert_direction(part.d, ray.d);
            assert_true(v3_length(v3_sub(part.o, ray.o)) < 1e-6f);
        }
        assert_true(fabsf(window.pixel - whole.pixel) < 1e-6f);
    }
}

// Parallel rays from a window two wide, its height by the picture's shape.
static void test_orthographic_rays(void **state)
{
    (void)state;
    SheenCamera camera = {.to_world = transform_mul(transform_translate(5, 0, 0), transform_scale(3, 3, 3)),
                          .orthographic = true};
    SheenEye eye = sheen_eye(&camera, 40, 20);
    Ray corner = sheen_eye_ray(&eye, 0, 0), opposite = sheen_eye_ray(&eye, 40, 20);
    assert_direction(corner.d, v3(0, 0, 1));
    assert_direction(opposite.d, v3(0, 0, 1));
    assert_true(v3_length(v3_sub(corner.o, v3(8, 1.5f, 0))) < 1e-5f); // Mitsuba 3, but for its near clip
    assert_true(v3_length(v3_sub(opposite.o, v3(2, -1.5f, 0))) < 1e-5f);
    // A pixel is as large at any distance: 6 metres over 40.
    assert_true(fabsf(sheen_eye_footprint(&eye, 1.0f) - 0.15f) < 1e-6f);
    assert_true(fabsf(sheen_eye_footprint(&eye, 100.0f) - 0.15f) < 1e-6f);
}

// All rays of one point of the picture meet in the plane in focus, and their origins fill the lens.
static void test_lens_rays_meet_in_focus(void **state)
{
    (void)state;
    SheenCamera camera = {.to_world = transform_look_at(v3(1, 2, 3), v3(1, 5, 3), v3(0, 0, 1)),
                          .fov_x = 1.2f,
                          .aperture = 0.3f,
                          .focus = 5.0f};
    SheenEye eye = sheen_eye(&camera, 40, 20);
    assert_true(sheen_eye_has_lens(&eye));
    Ray pinhole = sheen_eye_ray(&eye, 7, 3);
    Vec3 sharp = v3_mad(pinhole.o, 5.0f / pinhole.d.y, pinhole.d); // looks along +y
    float farthest = 0.0f;
    SheenSampler sampler = sampler_make(1, 0);
    for (int i = 0; i < 256; ++i) {
        Ray ray = sheen_eye_lens_ray(&eye, 7, 3, sampler_2d(&sampler));
        assert_true(fabsf(ray.o.y - 2.0f) < 1e-6f);
        farthest = maxf(farthest, v3_length(v3_sub(ray.o, pinhole.o)));
        Vec3 met = v3_mad(ray.o, (sharp.y - ray.o.y) / ray.d.y, ray.d);
        assert_true(v3_length(v3_sub(met, sharp)) < 1e-5f);
    }
    // Of 256 points in a disk one lies beyond 0.9 of the radius but for a chance of 0.81^256.
    assert_true(farthest > 0.9f * 0.3f && farthest < 0.3f + 1e-6f);
}

// On an aligned square of a power of two each number from 0 to pixels x samples comes once.
static void test_sample_index_is_a_bijection(void **state)
{
    (void)state;
    enum { SIDE = 64, SPP = 3, N = SIDE * SIDE * SPP };
    static unsigned char seen[N];
    for (uint32_t y = 0; y < SIDE; ++y)
        for (uint32_t x = 0; x < SIDE; ++x)
            for (uint32_t s = 0; s < SPP; ++s) {
                uint32_t i = sheen_sample_index(x, y, SPP, s);
                assert_in_range(i, 0, N - 1);
                assert_int_equal(seen[i], 0);
                seen[i] = 1;
                // Also in the smaller squares: the four pixels of an aligned two by two follow each other.
                assert_int_equal(i / (4 * SPP), sheen_sample_index(x & ~1u, y & ~1u, SPP, 0) / (4 * SPP));
            }
}

static void test_tiles_cover_the_picture(void **state)
{
    (void)state;
    SheenWork work = {.width = 37, .height = 50};
    static unsigned char seen[37 * 50];
    for (uint32_t i = 0; i < sheen_tile_count(&work); ++i) {
        Tile t = sheen_tile(&work, i);
        assert_true(t.width > 0 && t.height > 0 && t.x + t.width <= 37 && t.y + t.height <= 50);
        for (uint32_t y = t.y; y < t.y + t.height; ++y)
            for (uint32_t x = t.x; x < t.x + t.width; ++x) ++seen[37 * y + x];
    }
    for (size_t i = 0; i < sizeof seen; ++i) assert_int_equal(seen[i], 1);
}

// Every bit of the coordinates has its place: x at the even ones, y at the odd ones.
static void test_sample_index_takes_all_bits(void **state)
{
    (void)state;
    for (unsigned k = 0; k < 16; ++k) {
        assert_int_equal(sheen_sample_index(1u << k, 0, 1, 0), 1u << (2 * k));
        assert_int_equal(sheen_sample_index(0, 1u << k, 1, 0), 2u << (2 * k));
    }
    assert_int_equal(sheen_sample_index(0xffff, 0, 1, 0), 0x55555555);
}

// ---- shading points ---------------------------------------------------------------------------------------------

/** A floor z = 0 of 40 x 40 seen from z = 4 straight down, 16 x 16 pixels of fov 0.5, and what `add` puts between. */
typedef void AddFn(SheenBuilder *b);

static void look_down(AddFn *add, Kit *kit, Visibility *v, SheenFilm **film)
{
    SheenBuilder *b = kit_begin();
    kit_quad(b, v3(-20, -20, 0), v3(40, 0, 0), v3(0, 40, 0), kit_diffuse(b, 0.5f));
    if (add) add(b);
    kit_camera(b, v3(0, 0, 4), v3(0, 0, 0), v3(0, 1, 0), 0.5f);
    kit_end(b, 1, kit);
    kit->work.width = kit->work.height = 16;
    kit->work.options.spp = 4;
    if (film) assert_int_equal(sheen_film_create(16, 16, (1u << SHEEN_AOV_COUNT) - 1u, film), SHEEN_OK);
    Tile tile = sheen_tile(&kit->work, 0);
    SheenStats stats = {0};
    *v = (Visibility){0};
    Picture picture = {0};
    if (film) assert_true(sheen_picture_create(&kit->work, *film, &picture));
    assert_true(
        sheen_visibility_trace(&kit->work, &tile, (SampleRange){0, 4, NULL}, film ? &picture : NULL, v, &stats));
    if (film) sheen_picture_average(&picture);
    sheen_picture_free(&picture);
    assert_int_equal(stats.rays_camera, 16 * 16 * 4);
    assert_int_equal(stats.nonfinite_samples, 0);
}

static void look_end(Kit *kit, Visibility *v)
{
    sheen_visibility_free(v);
    kit_free(kit);
}

static void test_straight_ahead(void **state)
{
    (void)state;
    Kit kit;
    Visibility v;
    SheenFilm *film;
    look_down(NULL, &kit, &v, &film);
    assert_int_equal(v.seen.n_points, 16 * 16 * 4);
    unsigned char count[256] = {0};
    float pixel = 2.0f * tanf(0.25f) / 16.0f;
    for (size_t i = 0; i < v.seen.n_points; ++i) {
        const ShadingPoint *p = &v.seen.points[i];
        assert_in_range(p->pixel, 0, 255);
        assert_in_range(p->sample, 0, 3);
        ++count[p->pixel];
        // The point projects into its pixel: picture x is world -x here, as +y is up and the eye looks along -z.
        Vec3 q = p->point.p;
        float x = 8.0f + q.x / (4.0f * pixel), y = 8.0f - q.y / (4.0f * pixel);
        assert_true(fabsf(q.z) < 1e-5f);
        assert_true(fabsf(x - (float)(p->pixel % 16) - 0.5f) < 0.5001f);
        assert_true(fabsf(y - (float)(p->pixel / 16) - 0.5f) < 0.5001f);
        assert_true(p->point.n.z == 1.0f && p->point.ng.z == 1.0f && p->point.origin.z > 0.0f);
        assert_true(p->throughput.g == 1.0f && p->point.reflectance.g == 0.5f);
        float distance = v3_length(v3_sub(v3(0, 0, 4), q));
        assert_true(fabsf(p->footprint - distance * pixel) < 1e-5f);
        assert_true(fabsf(film->aov[SHEEN_AOV_NORMAL][3 * p->pixel + 2] - 1.0f) < 1e-5f);
    }
    for (int i = 0; i < 256; ++i) assert_int_equal(count[i], 4);
    sheen_film_destroy(&film);
    look_end(&kit, &v);
}

static void add_mirror(SheenBuilder *b)
{
    // A mirror across the whole view, two metres below the eye, that throws it to a ceiling at z = 10.
    kit_quad(b, v3(-9, -9, 2), v3(18, 0, 0), v3(0, 18, 0), kit_material(b, SHEEN_MATERIAL_CONDUCTOR, 0.0f, 1.0f));
    kit_quad(b, v3(-20, -20, 10), v3(0, 40, 0), v3(40, 0, 0), kit_diffuse(b, 0.25f));
}

static void test_mirror(void **state)
{
    (void)state;
    Kit kit;
    Visibility v;
    look_down(add_mirror, &kit, &v, NULL);
    assert_int_equal(v.seen.n_points, 16 * 16 * 4);
    float pixel = 2.0f * tanf(0.25f) / 16.0f;
    for (size_t i = 0; i < v.seen.n_points; ++i) {
        const ShadingPoint *p = &v.seen.points[i];
        assert_true(fabsf(p->point.p.z - 10.0f) < 1e-5f && p->point.n.z == -1.0f);
        assert_true(fabsf(p->throughput.g - 1.0f) < 1e-5f && p->point.reflectance.g == 0.25f);
        // As far as from the mirrored eye at z = 0.
        float distance = v3_length(p->point.p);
        assert_true(fabsf(p->footprint - distance * pixel) < 1e-5f);
        float x = 8.0f + p->point.p.x / (10.0f * pixel);
        assert_true(fabsf(x - (float)(p->pixel % 16) - 0.5f) < 0.501f);
    }
    look_end(&kit, &v);
}

static void add_panes(SheenBuilder *b, int n)
{
    uint32_t glass = kit_material(b, SHEEN_MATERIAL_THIN_DIELECTRIC, 0.0f, 1.5f);
    for (int i = 0; i < n; ++i) kit_quad(b, v3(-9, -9, 2.0f - 0.2f * (float)i), v3(18, 0, 0), v3(0, 18, 0), glass);
    kit_quad(b, v3(-20, -20, 10), v3(0, 40, 0), v3(40, 0, 0), kit_diffuse(b, 0.25f)); // what they mirror
}
static void add_pane(SheenBuilder *b)
{
    add_panes(b, 1);
}
static void add_three_panes(SheenBuilder *b)
{
    add_panes(b, 3);
}

static void test_pane_splits(void **state)
{
    (void)state;
    Kit kit;
    Visibility v;
    look_down(add_pane, &kit, &v, NULL);
    assert_int_equal(v.seen.n_points, 2 * 16 * 16 * 4); // each sample once through and once back
    double sum = 0.0;
    for (size_t i = 0; i < v.seen.n_points; ++i) {
        const ShadingPoint *p = &v.seen.points[i];
        bool through = p->point.p.z < 1.0f;
        // At normal incidence R = 0.04 and the pane reflects 2 R / (1 + R); at 20 degrees hardly more.
        float R = 2.0f * 0.04f / 1.04f;
        assert_true(fabsf(p->throughput.g - (through ? 1.0f - R : R)) < 2e-3f);
        float distance = through ? v3_length(v3_sub(v3(0, 0, 4), p->point.p)) : v3_length(p->point.p);
        assert_true(fabsf(p->footprint - distance * 2.0f * tanf(0.25f) / 16.0f) < 1e-5f);
        sum += (double)p->throughput.g;
    }
    assert_true(fabs(sum / (16 * 16 * 4) - 1.0) < 1e-5);
    look_end(&kit, &v);
}

// However glass splits and, later, chooses: in sum each sample's ways carry one, but for those too faint to be seen.
static void test_lossless_glass_conserves(void **state)
{
    (void)state;
    Kit kit;
    Visibility v;
    look_down(add_three_panes, &kit, &v, NULL);
    double sum[16 * 16 * 4] = {0};
    for (size_t i = 0; i < v.seen.n_points; ++i) {
        const ShadingPoint *p = &v.seen.points[i];
        assert_true(p->throughput.g > 0.0f);
        sum[p->pixel * 4 + p->sample] += (double)p->throughput.g;
        // No two ways of one sample carry one number: it keys their light samples.
        for (size_t j = i + 1; j < v.seen.n_points && j < i + 64; ++j)
            if (v.seen.points[j].pixel == p->pixel && v.seen.points[j].sample == p->sample)
                assert_true(v.seen.points[j].branch != p->branch);
    }
    for (int i = 0; i < 16 * 16 * 4; ++i) assert_true(sum[i] > 0.998 && sum[i] < 1.00001);
    look_end(&kit, &v);
}

// Emitters and the sky go to the film: what is seen, in the mean over the samples, and no shading point is made of the
// sky.
static void test_film_takes_what_shines(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    uint32_t black = kit_diffuse(b, 0.0f);
    uint32_t lamp = kit_quad(b, v3(-20, -20, 0), v3(20, 0, 0), v3(0, 40, 0), black); // half of the view
    sheen_builder_add_area_light(b, lamp, rgb(3.0f, 2.0f, 1.0f));
    kit_constant_environment(b, rgb_gray(0.5f));
    kit_camera(b, v3(0, 0, 4), v3(0, 0, 0), v3(0, 1, 0), 0.5f);
    Kit kit;
    kit_end(b, 1, &kit);
    kit.work.width = kit.work.height = 16;
    kit.work.options.spp = 4;
    SheenFilm *film;
    assert_int_equal(sheen_film_create(16, 16, 1u << SHEEN_AOV_DIRECT, &film), SHEEN_OK);
    Visibility v = {0};
    SheenStats stats = {0};
    Tile tile = sheen_tile(&kit.work, 0);
    Picture picture;
    assert_true(sheen_picture_create(&kit.work, film, &picture));
    assert_true(sheen_visibility_trace(&kit.work, &tile, (SampleRange){0, 4, NULL}, &picture, &v, &stats));
    sheen_picture_average(&picture);
    sheen_picture_free(&picture);
    assert_int_equal(v.seen.n_points, 0); // the lamp reflects nothing
    for (uint32_t i = 0; i < 256; ++i) {
        Rgb expected = i % 16 < 8 ? rgb(3.0f, 2.0f, 1.0f) : rgb_gray(0.5f);
        assert_true(fabsf(film->color[i].r - expected.r) < 1e-5f && fabsf(film->color[i].b - expected.b) < 1e-5f);
        assert_true(film->aov[SHEEN_AOV_DIRECT][3 * i] == film->color[i].r);
    }
    sheen_film_destroy(&film);
    look_end(&kit, &v);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_camera_rays),
        cmocka_unit_test(test_windows_of_the_film),
        cmocka_unit_test(test_orthographic_rays),
        cmocka_unit_test(test_lens_rays_meet_in_focus),
        cmocka_unit_test(test_sample_index_is_a_bijection),
        cmocka_unit_test(test_sample_index_takes_all_bits),
        cmocka_unit_test(test_tiles_cover_the_picture),
        cmocka_unit_test(test_straight_ahead),
        cmocka_unit_test(test_mirror),
        cmocka_unit_test(test_pane_splits),
        cmocka_unit_test(test_lossless_glass_conserves),
        cmocka_unit_test(test_film_takes_what_shines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
