// SPDX-License-Identifier: Apache-2.0
// Pictures under each reconstruction filter: the corner of a lamp, whose blurred profile is the filter's own integral,
// light without detail, and the same bits at any number of threads.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "analytic/irradiance_kit.h"

enum { SIDE = 12 };
static const double corner[2] = {5.3, 6.8}; // where the lamp begins: it shines right of and below this, pixels

/** A lamp of radiance 1 seen straight from the front, its corner inside the picture. */
static Stage lamp_stage(unsigned threads)
{
    SheenBuilder *b = kit_begin();
    // A parallel camera at the origin looks along +z at a film two metres wide: a pixel is 2 / SIDE; +x is left.
    SheenCamera c = {.name = "camera", .to_world = transform_identity(), .orthographic = true, .width = SIDE};
    c.height = SIDE;
    sheen_builder_add_camera(b, &c);
    float x = (float)(1.0 - corner[0] * 2.0 / SIDE), y = (float)(1.0 - corner[1] * 2.0 / SIDE);
    uint32_t lamp = kit_quad(b, v3(x, y, 1), v3(0, -9, 0), v3(-9, 0, 0), kit_diffuse(b, 0.0f));
    sheen_builder_add_area_light(b, lamp, rgb_gray(1.0f));
    return stage_end(b, threads);
}

/** Share of the filter about a pixel's centre that lies beyond a coordinate: midpoints, exact to 1e-6. */
static double share_beyond(const SheenFilter *f, double pixel, double from)
{
    double r = (double)f->radius, all = 0.0, beyond = 0.0;
    enum { N = 40000 };
    for (int i = 0; i < N; ++i) {
        double x = r * ((i + 0.5) * 2.0 / N - 1.0), value = sheen_filter_eval(f, x);
        all += value;
        if (pixel + 0.5 + x > from) beyond += value;
    }
    return beyond / all;
}

static SheenRenderSettings settings_of(SheenIntegrator integrator, SheenFilterKind filter, uint32_t spp)
{
    SheenRenderSettings s = small_settings(1);
    s.integrator = integrator;
    s.width = s.height = SIDE;
    s.options.spp = spp;
    s.filter = sheen_filter_standard(filter);
    return s;
}

static void test_the_corner_of_a_lamp_has_the_filters_profile(void **state)
{
    (void)state;
    Stage stage = lamp_stage(2);
    for (SheenFilterKind kind = SHEEN_FILTER_BOX; kind < SHEEN_FILTER_KINDS; ++kind) {
        SheenFilter f = sheen_filter_standard(kind);
        SheenPixelFilter table;
        sheen_pixel_filter_init(&f, &table);
        for (SheenIntegrator i = SHEEN_INTEGRATOR_IRRADIANCE; i <= SHEEN_INTEGRATOR_PATH; ++i) {
            SheenRenderSettings s = settings_of(i, kind, 1024);
            SheenFilm *film = stage_render(&stage, &s, NULL);
            double worst = 0.0;
            for (int y = 0; y < SIDE; ++y)
                for (int x = 0; x < SIDE; ++x) {
                    double want = share_beyond(&f, x, corner[0]) * share_beyond(&f, y, corner[1]);
                    worst = fmax(worst, fabs((double)film->color[y * SIDE + x].g - want));
                }
            show("filter %d of gain %.3f, integrator %d: %.5f\n", kind, (double)table.gain, i, worst);
            // Of 1,024 stratified samples 32 rows and columns' worth cross an edge; where the signs change, too, and
            // there the difference is that of two weights.
            assert_true(worst < 0.004 + (table.has_signs ? 0.016 * (double)table.gain : 0.0));
            sheen_film_destroy(&film);
        }
    }
    stage_free(&stage);
}

static void test_light_without_detail_stays_without(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    kit_camera(b, v3(0, 0, 0), v3(0, 0, 1), v3(0, 1, 0), 1.0f);
    kit_constant_environment(b, rgb(1, 2, 3));
    kit_sphere(b, v3(0, 0, -9), 1.0f, false, kit_diffuse(b, 0.5f)); // behind the camera
    Stage stage = stage_end(b, 2);
    for (SheenFilterKind kind = SHEEN_FILTER_BOX; kind < SHEEN_FILTER_KINDS; ++kind)
        for (SheenIntegrator i = SHEEN_INTEGRATOR_IRRADIANCE; i <= SHEEN_INTEGRATOR_PATH; ++i)
            for (uint32_t spp = 1; spp <= 13; spp += 4) {
                SheenRenderSettings s = settings_of(i, kind, spp);
                SheenFilm *film = stage_render(&stage, &s, NULL);
                for (int p = 0; p < SIDE * SIDE; ++p) {
                    // Sums of up to 13 floats.
                    assert_true(fabsf(film->color[p].r - 1.0f) < 3e-6f);
                    assert_true(fabsf(film->color[p].b - 3.0f) < 9e-6f);
                }
                sheen_film_destroy(&film);
            }
    stage_free(&stage);
}

/** A lit room of which the edges show: colours and layers at one and at three threads. */
static void test_same_bits_at_any_number_of_threads(void **state)
{
    (void)state;
    for (SheenIntegrator i = SHEEN_INTEGRATOR_IRRADIANCE; i <= SHEEN_INTEGRATOR_PATH; ++i) {
        SheenFilm *films[2];
        for (unsigned k = 0; k < 2; ++k) {
            Stage stage = lamp_stage(k ? 3 : 1);
            SheenRenderSettings s = settings_of(i, SHEEN_FILTER_LANCZOS, 5);
            s.width = s.height = 50; // several tiles
            s.aovs = 1u << SHEEN_AOV_DEPTH | 1u << SHEEN_AOV_DIRECT;
            films[k] = stage_render(&stage, &s, NULL);
            stage_free(&stage);
        }
        size_t n = (size_t)films[0]->width * films[0]->height;
        assert_memory_equal(films[0]->color, films[1]->color, n * sizeof(Rgb));
        assert_memory_equal(films[0]->aov[SHEEN_AOV_DEPTH], films[1]->aov[SHEEN_AOV_DEPTH], n * sizeof(float));
        // The lamp is all direct light, and its depth is 1: all three layers are under the same filter.
        for (size_t p = 0; p < n; ++p) {
            assert_true(fabsf(films[0]->aov[SHEEN_AOV_DIRECT][3 * p] - films[0]->color[p].r) < 1e-6f);
            assert_true(fabsf(films[0]->aov[SHEEN_AOV_DEPTH][p] - films[0]->color[p].r) < 1e-5f);
        }
        sheen_film_destroy(&films[0]);
        sheen_film_destroy(&films[1]);
    }
}

/** Without a filter in the settings the camera's own holds. */
static void test_the_cameras_filter_is_the_default(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    SheenCamera c = {.name = "camera", .to_world = transform_identity(), .orthographic = true, .width = SIDE};
    c.height = SIDE;
    c.filter = sheen_filter_standard(SHEEN_FILTER_TENT);
    sheen_builder_add_camera(b, &c);
    uint32_t lamp = kit_quad(b, v3(0, 9, 1), v3(0, -18, 0), v3(-9, 0, 0), kit_diffuse(b, 0.0f));
    sheen_builder_add_area_light(b, lamp, rgb_gray(1.0f));
    Stage stage = stage_end(b, 1);
    SheenFilm *films[3];
    for (int k = 0; k < 3; ++k) {
        static const SheenFilterKind kinds[3] = {SHEEN_FILTER_UNSET, SHEEN_FILTER_TENT, SHEEN_FILTER_BOX};
        SheenRenderSettings s = settings_of(SHEEN_INTEGRATOR_PATH, kinds[k], 16);
        films[k] = stage_render(&stage, &s, NULL);
    }
    assert_memory_equal(films[0]->color, films[1]->color, SIDE * SIDE * sizeof(Rgb));
    assert_memory_not_equal(films[0]->color, films[2]->color, SIDE * SIDE * sizeof(Rgb));
    for (int k = 0; k < 3; ++k) sheen_film_destroy(&films[k]);
    stage_free(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_corner_of_a_lamp_has_the_filters_profile),
        cmocka_unit_test(test_light_without_detail_stays_without),
        cmocka_unit_test(test_same_bits_at_any_number_of_threads),
        cmocka_unit_test(test_the_cameras_filter_is_the_default),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
