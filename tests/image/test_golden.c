// SPDX-License-Identifier: Apache-2.0
// The bundled scenes cost no more, and come out no worse, than golden.csv says: records, rays and relMSE of small
// pictures, with the defaults and 8 bounces.
//
// References are tests/image/golden/SCENE.hdr: path tracing with 2,048 samples a pixel; the furnace's is the closed
// form in its scene file. After a change that is meant to move the numbers, run the test with SHEEN_GOLDEN=write and
// commit the new table: its diff shows what the change cost or gained.
#include "image/image.h"
#include "image/metric.h"
#include "io/load.h"
#include "render/render.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define GOLDEN_DIR SHEEN_TEST_SOURCE_DIR "/tests/image/"
#define HEADING "scene,integrator,width,height,spp,records,rays,relmse\n"
enum { MAX_ROWS = 32, BOUNCES = 8 };

// Counts are the same at any number of threads, but another processor's or compiler's rounding moves a few decisions,
// which moves the error more: its least part is noise.
#define COUNT_SLACK 1.05
#define ERROR_SLACK 1.25

typedef struct Row {
    char scene[32], integrator[16];
    uint32_t width, height, spp;
    double records, rays, relmse;
} Row;

static void print_message_of_library(void *user, SheenLogLevel level, const char *text)
{
    (void)user;
    if (level != SHEEN_LOG_INFO) print_message("%s\n", text);
}

static const SheenLog console = {print_message_of_library, NULL};

static size_t read_rows(Row rows[MAX_ROWS])
{
    FILE *file = fopen(GOLDEN_DIR "golden.csv", "r");
    assert_non_null(file);
    char line[256];
    assert_non_null(fgets(line, sizeof line, file));
    assert_string_equal(line, HEADING);
    size_t n = 0;
    while (n < MAX_ROWS && fgets(line, sizeof line, file)) {
        Row *r = &rows[n++];
        int got = sscanf(line, "%31[^,],%15[^,],%u,%u,%u,%lf,%lf,%lf", r->scene, r->integrator, &r->width, &r->height,
                         &r->spp, &r->records, &r->rays, &r->relmse);
        assert_int_equal(got, 8);
    }
    fclose(file);
    assert_true(n > 0);
    return n;
}

static void write_rows(const Row *rows, size_t n)
{
    FILE *file = fopen(GOLDEN_DIR "golden.csv", "w");
    assert_non_null(file);
    fputs(HEADING, file);
    for (size_t i = 0; i < n; ++i)
        fprintf(file, "%s,%s,%u,%u,%u,%.0f,%.0f,%.3g\n", rows[i].scene, rows[i].integrator, rows[i].width,
                rows[i].height, rows[i].spp, rows[i].records, rows[i].rays, rows[i].relmse);
    assert_int_equal(fclose(file), 0);
}

/** The converged picture of a row; free with sheen_image_free. */
static SheenImage reference(const Row *row)
{
    SheenImage image = {0};
    if (strcmp(row->scene, "furnace") == 0) {
        image = (SheenImage){row->width, row->height, malloc(sizeof(Rgb) * row->width * row->height)};
        assert_non_null(image.pixels);
        float all = 1.0f - ldexpf(1.0f, -(BOUNCES + 2));
        for (uint32_t i = 0; i < row->width * row->height; ++i) image.pixels[i] = (Rgb){all, all, all};
        return image;
    }
    char path[512];
    snprintf(path, sizeof path, GOLDEN_DIR "golden/%.31s.hdr", row->scene);
    assert_int_equal(sheen_image_read(path, &console, &image), SHEEN_OK);
    return image;
}

static SheenIntegrator integrator_named(const char *name)
{
    if (strcmp(name, "path") == 0) return SHEEN_INTEGRATOR_PATH;
    return strcmp(name, "radiance") == 0 ? SHEEN_INTEGRATOR_RADIANCE : SHEEN_INTEGRATOR_IRRADIANCE;
}

/** Renders the row's picture and returns the row with what it cost. */
static Row measured(const Row *row, SheenPool *pool)
{
    char path[512];
    snprintf(path, sizeof path, SHEEN_TEST_SOURCE_DIR "/scenes/%.31s.xml", row->scene);
    SheenScene *scene;
    assert_int_equal(sheen_scene_load(path, &console, &scene), SHEEN_OK);
    SheenRenderSettings settings = {.integrator = integrator_named(row->integrator),
                                    .width = row->width,
                                    .height = row->height,
                                    .options = sheen_options_default()};
    settings.options.spp = row->spp;
    settings.options.bounces = BOUNCES;
    SheenFilm *film;
    SheenStats stats;
    SheenRenderTimes times;
    assert_int_equal(sheen_render(scene, &settings, pool, NULL, NULL, &console, &film, &stats, &times), SHEEN_OK);

    SheenImage want = reference(row), got = {film->width, film->height, film->color};
    SheenMetrics metrics;
    assert_int_equal(sheen_metrics_compute(&want, &got, &console, &metrics), SHEEN_OK);
    assert_int_equal(metrics.nonfinite, 0);
    assert_int_equal(stats.nonfinite_samples, 0);
    Row out = *row;
    out.records = (double)(stats.records + stats.radiance_records);
    out.rays =
        (double)(stats.rays_camera + stats.rays_shadow + stats.rays_gather + stats.rays_path + stats.rays_specular);
    out.relmse = metrics.relmse;
    sheen_image_free(&want);
    sheen_film_destroy(&film);
    sheen_scene_destroy(&scene);
    return out;
}

static bool within(const Row *row, const char *what, double got, double golden, double slack)
{
    if (got <= golden * slack) return true;
    print_error("%s, %s: %s is %.4g, golden.csv says %.4g\n", row->scene, row->integrator, what, got, golden);
    return false;
}

static void test_bundled_scenes_cost_and_err_no_more_than_golden(void **state)
{
    (void)state;
    Row rows[MAX_ROWS];
    size_t n = read_rows(rows);
    const char *mode = getenv("SHEEN_GOLDEN");
    bool write = mode && strcmp(mode, "write") == 0, fine = true;
    SheenPool *pool;
    assert_int_equal(sheen_pool_create(0, &pool), SHEEN_OK);
    for (size_t i = 0; i < n; ++i) {
        Row got = measured(&rows[i], pool);
        if (!write) {
            fine &= within(&got, "records", got.records, rows[i].records, COUNT_SLACK);
            fine &= within(&got, "rays", got.rays, rows[i].rays, COUNT_SLACK);
            fine &= within(&got, "relMSE", got.relmse, rows[i].relmse, ERROR_SLACK);
        }
        rows[i] = got;
    }
    sheen_pool_destroy(&pool);
    if (write) write_rows(rows, n);
    assert_true(fine);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_bundled_scenes_cost_and_err_no_more_than_golden)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
