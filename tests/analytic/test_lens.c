// SPDX-License-Identifier: Apache-2.0
// The blur of a thin lens, known exactly for the edge of a large lamp that is out of focus, in both integrators.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "analytic/irradiance_kit.h"

#define SIDE 32

static const float aperture = 0.5f, focus = 2.0f, half = 0.5f; // half: of the picture's width at distance 1

/** The part of a unit disk beyond the distance t from its centre. */
static double beyond(double t)
{
    t = fmin(fmax(t, -1.0), 1.0);
    return (acos(t) - t * sqrt(1.0 - t * t)) / 3.14159265358979324;
}

/**
 * From a point x of the lens through f of the plane in focus, a ray is at 2 f - x twice as far away: it hits the lamp,
 * which lies below 0 there, for x > 2 f.
 */
static double expected(uint32_t column)
{
    enum { STEPS = 64 };
    double sum = 0.0;
    for (int i = 0; i < STEPS; ++i) {
        double u = (column + (i + 0.5) / STEPS) / SIDE; // +x is to the left in the picture
        sum += beyond(2.0 * (double)focus * (double)half * (1.0 - 2.0 * u) / (double)aperture);
    }
    return sum / STEPS;
}

static void an_edge_out_of_focus_is_blurred(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    uint32_t lamp = kit_quad(b, v3(-50, -50, 2.0f * focus), v3(0, 100, 0), v3(50, 0, 0), kit_diffuse(b, 0.0f));
    sheen_builder_add_area_light(b, lamp, rgb_gray(1.0f));
    SheenCamera camera = {.name = "lens",
                          .to_world = transform_identity(),
                          .fov_x = 2.0f * atanf(half),
                          .aperture = aperture,
                          .focus = focus,
                          .width = SIDE,
                          .height = SIDE};
    sheen_builder_add_camera(b, &camera);
    Stage stage = stage_end(b, 2);
    SheenRenderSettings settings = small_settings(0);
    settings.options.spp = 64;
    for (int paths = 0; paths < 2; ++paths) {
        SheenFilm *film = paths ? stage_reference(&stage, &settings, 64, 0) : stage_render(&stage, &settings, NULL);
        for (uint32_t x = 0; x < SIDE; ++x) {
            double mean = film_mean_of(film, x, 0, x + 1, SIDE);
            // 4.5 standard errors of 64 independent samples in each of 32 pixels, at most 0.5 each.
            if (!(fabs(mean - expected(x)) < 4.5 * 0.5 / sqrt(64.0 * SIDE)))
                fail_msg("integrator %d, column %u: %g, expected %g", paths, x, mean, expected(x));
        }
        sheen_film_destroy(&film);
    }
    stage_free(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(an_edge_out_of_focus_is_blurred)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
