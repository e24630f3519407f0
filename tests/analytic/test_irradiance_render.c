// SPDX-License-Identifier: Apache-2.0
// How the irradiance integrator makes a picture: the same at any number of threads, at any scale, stoppable, layered.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "analytic/irradiance_kit.h"

static const unsigned ALL_LAYERS = (1u << SHEEN_AOV_COUNT) - 1u;

// The room with a glass ball and a mirror, under a sky that its windows let in: every branch is taken.
static SheenBuilder *full_room(void)
{
    SheenBuilder *b = kit_room(1.0f, 0.7f, SHEEN_MATERIAL_DIELECTRIC, true);
    kit_sphere(b, v3(0.4f, 0.5f, 0.3f), 0.3f, false, kit_mirror(b));
    return b;
}

static void assert_same_film(const SheenFilm *a, const SheenFilm *b)
{
    size_t n = (size_t)a->width * a->height;
    assert_memory_equal(a->color, b->color, n * sizeof *a->color);
    for (int i = 0; i < SHEEN_AOV_COUNT; ++i)
        assert_memory_equal(a->aov[i], b->aov[i], n * sheen_aov_info[i].n_channels * sizeof(float));
}

static void assert_same_counters(SheenStats a, SheenStats b)
{
    a.time_visibility = a.time_fill = a.time_refine = a.time_direct = a.time_interpolate = 0.0;
    b.time_visibility = b.time_fill = b.time_refine = b.time_direct = b.time_interpolate = 0.0;
    assert_memory_equal(&a, &b, sizeof a);
}

static void test_same_picture_at_any_number_of_threads(void **state)
{
    (void)state;
    static const struct {
        uint32_t bounces;
        SheenSecondary secondary;
        bool clamping;
    } cases[] = {{0, SHEEN_SECONDARY_CACHE, false},
                 {1, SHEEN_SECONDARY_CACHE, true},
                 {8, SHEEN_SECONDARY_CACHE, false},
                 {8, SHEEN_SECONDARY_PATH, true}};
    static const unsigned threads[] = {1, 2, 7};
    enum { CASES = sizeof cases / sizeof *cases };
    SheenFilm *first[CASES] = {0};
    SheenStats first_stats[CASES];
    for (int t = 0; t < 3; ++t) {
        Stage stage = stage_end(full_room(), threads[t]);
        for (int i = 0; i < CASES; ++i) {
            SheenRenderSettings s = small_settings(cases[i].bounces);
            s.width = 37; // no multiple of the tile
            s.height = 21;
            s.aovs = ALL_LAYERS;
            s.options.spp = 2;
            s.options.gather_rays = 64;
            s.options.secondary = cases[i].secondary;
            s.options.neighbor_clamping = cases[i].clamping;
            SheenStats stats;
            SheenFilm *film = stage_render(&stage, &s, &stats);
            assert_true(stats.records > 0); // without a bounce they hold the lamp in the mirror
            if (t == 0) {
                first[i] = film;
                first_stats[i] = stats;
                continue;
            }
            assert_same_film(first[i], film);
            assert_same_counters(first_stats[i], stats);
            sheen_film_destroy(&film);
        }
        stage_free(&stage);
    }
    for (int i = 0; i < CASES; ++i) sheen_film_destroy(&first[i]);
}

static void test_seed_changes_the_noise_only(void **state)
{
    (void)state;
    Stage stage = stage_end(kit_room(1.0f, 0.7f, SHEEN_MATERIAL_DIFFUSE, true), 2);
    SheenRenderSettings s = small_settings(2);
    SheenFilm *a = stage_render(&stage, &s, NULL);
    s.options.seed = 1;
    SheenFilm *b = stage_render(&stage, &s, NULL);
    size_t equal = 0;
    for (size_t i = 0; i < 32 * 32; ++i) equal += a->color[i].g == b->color[i].g;
    double off = film_mean(a) / film_mean(b) - 1.0;
    show("seed: mean %.2g, %zu equal\n", off, equal);
    assert_true(fabs(off) < 0.02); // 4,096 light samples that deviate by a third, and 100 records of 128 rays
    assert_true(equal < 32 * 32 / 10);
    sheen_film_destroy(&a);
    sheen_film_destroy(&b);
    stage_free(&stage);
}

// ---- cancel -----------------------------------------------------------------------------------------------------

typedef struct Watch {
    const char *stage; // cancels when this one reports
    atomic_bool cancel;
    int calls;
} Watch;

static void watch_progress(void *user, const char *stage, double done, uint64_t records)
{
    (void)done, (void)records;
    Watch *w = user;
    ++w->calls;
    if (w->stage && strcmp(stage, w->stage) == 0) atomic_store(&w->cancel, true);
}

static void test_cancel(void **state)
{
    (void)state;
    static const char *const stages[] = {NULL, "build", "visibility", "deep light", "fill", "shade"};
    Stage stage =
        stage_end(full_room(), 1); // the thread that reports is the one that works: tiles are left when it does
    SheenRenderSettings s = small_settings(3);
    s.width = s.height = 64;
    s.options.gather_rays = 64;
    s.options.spp = 1;
    for (int i = 0; i < 6; ++i) {
        Watch w = {.stage = stages[i]};
        SheenProgress progress = {watch_progress, &w};
        atomic_store(&w.cancel, i == 0); // at once
        SheenFilm *film = NULL;
        SheenStats stats;
        SheenRenderTimes times;
        SheenStatus status =
            sheen_render(stage.scene, &s, stage.pool, &w.cancel, &progress, &kit_log_sink, &film, &stats, &times);
        if (status != SHEEN_ERR_CANCELLED) fprintf(stderr, "cancelled at %s: %d\n", stages[i], status);
        assert_int_equal(status, SHEEN_ERR_CANCELLED);
        assert_null(film);
        assert_true(w.calls > 0);
        if (i == 0) assert_int_equal(stats.rays_camera, 0);
    }
    stage_free(&stage);
}

// ---- layers -----------------------------------------------------------------------------------------------------

static void test_direct_and_indirect_make_the_colour(void **state)
{
    (void)state;
    Stage stage = stage_end(full_room(), 2);
    SheenRenderSettings s = small_settings(3);
    s.aovs = ALL_LAYERS;
    SheenFilm *film = stage_render(&stage, &s, NULL);
    double direct = 0.0, indirect = 0.0, covered = 0.0;
    for (size_t i = 0; i < 32 * 32; ++i) {
        const float *d = film->aov[SHEEN_AOV_DIRECT] + 3 * i, *in = film->aov[SHEEN_AOV_INDIRECT] + 3 * i;
        Rgb c = film->color[i];
        // Sums of some dozen terms in another order.
        assert_true(fabsf(d[0] + in[0] - c.r) <= 1e-5f * c.r);
        assert_true(fabsf(d[1] + in[1] - c.g) <= 1e-5f * c.g);
        assert_true(fabsf(d[2] + in[2] - c.b) <= 1e-5f * c.b);
        direct += (double)d[1];
        indirect += (double)in[1];
        covered += film->aov[SHEEN_AOV_COVERAGE][i] > 0.0f;
        float error = film->aov[SHEEN_AOV_ERROR][i];
        assert_true(error >= 0.0f && error < 1.0f);
    }
    assert_true(direct > 0.0 && indirect > 0.0);
    assert_true(covered > 32 * 32 - 100); // all but the lamp
    sheen_film_destroy(&film);
    stage_free(&stage);
}

// ---- size -------------------------------------------------------------------------------------------------------

static void test_tiny_pictures(void **state)
{
    (void)state;
    Stage stage = stage_end(full_room(), 2);
    static const uint32_t sizes[4][2] = {{1, 1}, {1, 7}, {40, 1}, {3, 2}};
    for (int i = 0; i < 4; ++i) {
        SheenRenderSettings s = small_settings(2);
        s.width = sizes[i][0];
        s.height = sizes[i][1];
        SheenFilm *film = stage_render(&stage, &s, NULL);
        for (size_t k = 0; k < (size_t)s.width * s.height; ++k)
            assert_true(rgb_finite(film->color[k]) && film->color[k].g > 0.0f);
        sheen_film_destroy(&film);
    }
    stage_free(&stage);
}

// A doll's house and a hall a thousand times larger look the same. Scales by powers of two change no rounding; others
// do. Where all coordinates are below 1/32 m rays leave surfaces by 15
// micrometres, which is 1.5 % of the smallest room.
static void test_scale_does_not_show(void **state)
{
    (void)state;
    static const float scales[3] = {1024.0f, 1e3f, 1e-3f};
    static const double mean_bound[3] = {0.001, 0.002, 0.01}, block_bound[3] = {0.01, 0.01, 0.03};
    Stage stage = stage_end(kit_room(1.0f, 0.7f, SHEEN_MATERIAL_DIFFUSE, true), 2);
    SheenRenderSettings s = small_settings(3);
    SheenStats stats, scaled_stats;
    SheenFilm *film = stage_render(&stage, &s, &stats);
    for (int i = 0; i < 3; ++i) {
        Stage other = stage_end(kit_room(scales[i], 0.7f, SHEEN_MATERIAL_DIFFUSE, true), 2);
        SheenFilm *scaled = stage_render(&other, &s, &scaled_stats);
        double off = film_mean(scaled) / film_mean(film) - 1.0;
        BlockDifference d = film_blocks(scaled, film);
        show("scale %g: mean %.2g, worst block %.2g, records %d and %d\n", (double)scales[i], off, d.worst,
             (int)stats.records, (int)scaled_stats.records);
        assert_true(fabs(off) < mean_bound[i]);
        assert_true(d.worst < block_bound[i]);
        sheen_film_destroy(&scaled);
        stage_free(&other);
    }
    sheen_film_destroy(&film);
    stage_free(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_picture_at_any_number_of_threads),
        cmocka_unit_test(test_seed_changes_the_noise_only),
        cmocka_unit_test(test_cancel),
        cmocka_unit_test(test_direct_and_indirect_make_the_colour),
        cmocka_unit_test(test_tiny_pictures),
        cmocka_unit_test(test_scale_does_not_show),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
