// SPDX-License-Identifier: Apache-2.0
// How the path integrator makes a picture: the same at any number of threads and passes, in time, stoppable, layered.
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "analytic/path_kit.h"

static const unsigned ALL_LAYERS = (1u << SHEEN_AOV_COUNT) - 1u;

// A box with a light, a mirror ball and a glass ball: every kind of vertex.
static void room(unsigned threads, Kit *kit)
{
    SheenBuilder *b = kit_begin();
    kit_box(b, kit_diffuse(b, 0.7f), 0.0f);
    uint32_t lamp = kit_quad(b, v3(-0.3f, -0.3f, 0.99f), v3(0, 0.6f, 0), v3(0.6f, 0, 0), kit_diffuse(b, 0.0f));
    sheen_builder_add_area_light(b, lamp, rgb(4.0f, 5.0f, 3.0f));
    kit_sphere(b, v3(-0.4f, 0.4f, -0.6f), 0.4f, false, kit_mirror(b));
    kit_sphere(b, v3(0.4f, 0.2f, -0.6f), 0.4f, false, kit_material(b, SHEEN_MATERIAL_DIELECTRIC, 0.0f, 1.5f));
    kit_camera(b, v3(0, -0.95f, 0), v3(0, 0, -0.1f), v3(0, 0, 1), 1.5f);
    kit_end(b, threads, kit);
    kit->work.width = 53; // not a multiple of the tile
    kit->work.height = 37;
    kit->work.options.spp = 37;
    kit->work.options.bounces = 4;
}

static void assert_same_film(const SheenFilm *a, const SheenFilm *b)
{
    size_t n = (size_t)a->width * a->height;
    assert_memory_equal(a->color, b->color, n * sizeof *a->color);
    for (int i = 0; i < SHEEN_AOV_COUNT; ++i)
        assert_memory_equal(a->aov[i], b->aov[i], n * sheen_aov_info[i].n_channels * sizeof(float));
}

static void test_same_picture_at_any_number_of_threads(void **state)
{
    (void)state;
    static const unsigned threads[] = {1, 2, 7};
    SheenFilm *first = NULL;
    SheenStats first_stats = {0};
    for (int i = 0; i < 3; ++i) {
        Kit kit;
        room(threads[i], &kit);
        SheenStats stats = {0};
        SheenFilm *film = kit_render(&kit, ALL_LAYERS, &stats);
        if (i == 0) {
            first = film;
            first_stats = stats;
            assert_int_equal(stats.rays_camera, 53 * 37 * 37);
            assert_int_equal(stats.spp_done, 37);
            assert_int_equal(stats.passes, 7); // 1 + 1 + 2 + 4 + 8 + 16 + 5
            assert_true(stats.rays_shadow > 0 && stats.rays_path > 0 && stats.rays_specular > 0);
        } else {
            assert_same_film(first, film);
            assert_memory_equal(&first_stats, &stats, sizeof stats);
            sheen_film_destroy(&film);
        }
        kit_free(&kit);
    }
    sheen_film_destroy(&first);
}

static void test_seed_changes_the_noise_only(void **state)
{
    (void)state;
    Kit kit;
    room(2, &kit);
    SheenFilm *a = kit_render(&kit, 0, NULL);
    kit.work.options.seed = 1;
    SheenFilm *b = kit_render(&kit, 0, NULL);
    double sum_a = 0.0, sum_b = 0.0;
    size_t n = 53 * 37, equal = 0;
    for (size_t i = 0; i < n; ++i) {
        sum_a += (double)a->color[i].g;
        sum_b += (double)b->color[i].g;
        equal += a->color[i].g == b->color[i].g;
    }
    assert_true(fabs(sum_a / sum_b - 1.0) < 0.02); // 73,000 samples of a deviation near the mean: 4 standard errors
    assert_true(equal < n / 10);                   // the lamp itself is free of noise
    sheen_film_destroy(&a);
    sheen_film_destroy(&b);
    kit_free(&kit);
}

// The picture of a limited time is that of its number of samples; how they were cut into passes does not show.
static void test_time_limit(void **state)
{
    (void)state;
    Kit kit;
    room(2, &kit);
    kit.work.options.time_limit = 1.0;
    kit.work.options.spp = 1; // does not bind
    SheenStats stats = {0};
    double start = sheen_clock_seconds();
    SheenFilm *limited = kit_render(&kit, ALL_LAYERS, &stats);
    double seconds = sheen_clock_seconds() - start;
    assert_true(stats.passes > 1 && stats.spp_done > 1);
    // A pass that was expected to end in time may be held up by a sanitizer and by others on the machine: hence the
    // generous bound.
    assert_true(seconds < 1.0 + 10.0);
    kit.work.options.time_limit = 0.0;
    kit.work.options.spp = stats.spp_done;
    SheenFilm *counted = kit_render(&kit, ALL_LAYERS, NULL);
    assert_same_film(limited, counted);
    sheen_film_destroy(&limited);
    sheen_film_destroy(&counted);

    // No time at all still gives one pass.
    kit.work.options.time_limit = 1e-9;
    stats = (SheenStats){0};
    SheenFilm *one = kit_render(&kit, 0, &stats);
    assert_int_equal(stats.spp_done, 1);
    sheen_film_destroy(&one);
    kit_free(&kit);
}

typedef struct Watch {
    pthread_t caller;
    atomic_bool cancel;
    double cancel_at, last;
    int calls, strangers, backwards;
} Watch;

static void watch_progress(void *user, const char *stage, double done, uint64_t records)
{
    (void)stage, (void)records;
    Watch *w = user;
    ++w->calls;
    if (!pthread_equal(w->caller, pthread_self())) ++w->strangers;
    if (!(done >= w->last && done <= 1.0)) ++w->backwards;
    w->last = done;
    if (done >= w->cancel_at) atomic_store(&w->cancel, true);
}

static void test_progress_and_cancel(void **state)
{
    (void)state;
    Kit kit;
    room(3, &kit);
    Watch w = {.caller = pthread_self(), .cancel_at = 2.0};
    SheenProgress progress = {watch_progress, &w};
    kit.work.progress = &progress;
    kit.work.cancel = &w.cancel;
    SheenFilm *film = kit_render(&kit, 0, NULL);
    assert_true(w.calls >= 2);
    assert_int_equal(w.strangers, 0);
    assert_int_equal(w.backwards, 0);
    assert_true(w.last == 1.0);

    // Samples for hours: only the cancel ends it.
    kit.work.options.spp = 100000000;
    w.last = 0.0;
    w.cancel_at = 1e-9;
    SheenStats stats = {0};
    double start = sheen_clock_seconds();
    assert_int_equal(sheen_path_render(&kit.work, film, &stats), SHEEN_ERR_CANCELLED);
    assert_true(sheen_clock_seconds() - start < 2.0);
    assert_true(stats.rays_camera > 0);

    // Raised before: nothing is done.
    stats = (SheenStats){0};
    assert_int_equal(sheen_path_render(&kit.work, film, &stats), SHEEN_ERR_CANCELLED);
    assert_int_equal(stats.rays_camera, 0);
    sheen_film_destroy(&film);
    kit_free(&kit);
}

static float layer(const SheenFilm *film, SheenAov aov, uint32_t x, uint32_t y, unsigned c)
{
    return film->aov[aov][((size_t)y * film->width + x) * sheen_aov_info[aov].n_channels + c];
}

// A camera 2 above a square of 2 x 2 that fills the middle of the picture.
static void test_layers(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    kit_diffuse(b, 0.1f);
    kit_sphere(b, v3(0, 0, 50), 0.1f, false, 0); // never seen: the square is shape 1
    uint32_t square = kit_quad(b, v3(-1, -1, 0), v3(2, 0, 0), v3(0, 2, 0), kit_diffuse(b, 0.6f));
    sheen_builder_add_area_light(b, square, rgb_gray(0.5f));
    kit_constant_environment(b, rgb_gray(1.0f));
    kit_camera(b, v3(0, 0, 2), v3(0, 0, 0), v3(0, 1, 0), 2.0f * atanf(1.0f)); // 4 x 4 at the plane
    Kit kit;
    kit_end(b, 2, &kit);
    kit.work.options.spp = 1024;
    kit.work.width = kit.work.height = 8;
    SheenFilm *film = kit_render(&kit, ALL_LAYERS, NULL);
    for (uint32_t y = 0; y < 8; ++y) {
        for (uint32_t x = 0; x < 8; ++x) {
            bool on = x >= 2 && x < 6 && y >= 2 && y < 6;
            for (unsigned c = 0; c < 3; ++c) {
                float color = c == 0   ? film->color[8 * y + x].r
                              : c == 1 ? film->color[8 * y + x].g
                                       : film->color[8 * y + x].b;
                float sum = layer(film, SHEEN_AOV_DIRECT, x, y, c) + layer(film, SHEEN_AOV_INDIRECT, x, y, c);
                assert_true(fabsf(sum - color) <= 1e-5f * color);
                assert_true(fabsf(layer(film, SHEEN_AOV_ALBEDO, x, y, c) - (on ? 0.6f : 0.0f)) < 1e-5f);
            }
            assert_true(layer(film, SHEEN_AOV_PRIMITIVE, x, y, 0) == (on ? 1.0f : -1.0f));
            assert_true(layer(film, SHEEN_AOV_PRIMITIVE, x, y, 2) == -1.0f);
            assert_true(fabsf(layer(film, SHEEN_AOV_NORMAL, x, y, 2) - (on ? 1.0f : 0.0f)) < 1e-5f);
            // Pixel centres, as means over a symmetric pixel; 1024 stratified samples place them to 1/1024 of a pixel,
            // and the picture is seen as a right-handed world looks from +z.
            float px = ((float)x + 0.5f) * 0.5f - 2.0f, py = 2.0f - ((float)y + 0.5f) * 0.5f;
            if (!on) continue;
            assert_true(fabsf(layer(film, SHEEN_AOV_POSITION, x, y, 0) - px) < 1e-3f);
            assert_true(fabsf(layer(film, SHEEN_AOV_POSITION, x, y, 1) - py) < 1e-3f);
            assert_true(fabsf(layer(film, SHEEN_AOV_UV, x, y, 0) - 0.5f * (px + 1.0f)) < 1e-3f);
            assert_true(fabsf(layer(film, SHEEN_AOV_UV, x, y, 1) - 0.5f * (py + 1.0f)) < 1e-3f);
            // The mean distance over a pixel differs from that of its centre by less than 0.5 %.
            float d = sqrtf(4.0f + px * px + py * py);
            assert_true(fabsf(layer(film, SHEEN_AOV_DEPTH, x, y, 0) - d) < 0.005f * d);
        }
    }
    for (int a = SHEEN_AOV_RECORDS; a <= SHEEN_AOV_TRANSPORT; ++a)
        for (size_t i = 0; i < (size_t)64 * sheen_aov_info[a].n_channels; ++i) assert_true(film->aov[a][i] == 0.0f);
    sheen_film_destroy(&film);
    kit_free(&kit);
}

// A bright half plane whose edge crosses the middle pixel at 0.3 of its width: the pixel's value is its coverage.
static void test_pixels_are_boxes(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    uint32_t quad = kit_quad(b, v3(-0.2f, -10, 0), v3(10, 0, 0), v3(0, 20, 0), kit_diffuse(b, 0.0f));
    sheen_builder_add_area_light(b, quad, rgb_gray(1.0f));
    kit_camera(b, v3(0, 0, 1), v3(0, 0, 0), v3(0, 1, 0), 2.0f * atanf(1.5f)); // three pixels of width 1
    Kit kit;
    kit_end(b, 1, &kit);
    kit.work.width = kit.work.height = 3;
    kit.work.options.spp = 256;
    SheenFilm *film = kit_render(&kit, 0, NULL);
    for (int y = 0; y < 3; ++y) {
        // 256 samples stratified in x: the edge falls into one stratum of 1/256.
        assert_true(film->color[3 * y].g == 0.0f);
        assert_true(fabsf(film->color[3 * y + 1].g - 0.7f) <= 1.0f / 256.0f);
        assert_true(fabsf(film->color[3 * y + 2].g - 1.0f) < 1e-6f);
    }
    sheen_film_destroy(&film);
    kit_free(&kit);
}

// Emission near the largest float overflows in shading: the samples are dropped and counted, and the picture is finite.
static void test_nonfinite_samples_are_counted(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    kit_box(b, kit_diffuse(b, 0.9f), 3e38f);
    kit_camera(b, v3(0, 0, 0), v3(1, 0, 0), v3(0, 0, 1), 1.0f);
    Kit kit;
    kit_end(b, 1, &kit);
    kit.work.options.spp = 4;
    SheenFilm *film = NULL;
    SheenStats stats = {0};
    assert_int_equal(sheen_film_create(32, 32, 0, &film), SHEEN_OK);
    assert_int_equal(sheen_path_render(&kit.work, film, &stats), SHEEN_OK);
    assert_in_range(stats.nonfinite_samples, 32 * 32 * 2, 32 * 32 * 4);
    for (size_t i = 0; i < 32 * 32; ++i) assert_true(rgb_finite(film->color[i]));
    sheen_film_destroy(&film);
    kit_free(&kit);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_picture_at_any_number_of_threads),
        cmocka_unit_test(test_seed_changes_the_noise_only),
        cmocka_unit_test(test_time_limit),
        cmocka_unit_test(test_progress_and_cancel),
        cmocka_unit_test(test_layers),
        cmocka_unit_test(test_pixels_are_boxes),
        cmocka_unit_test(test_nonfinite_samples_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
