// SPDX-License-Identifier: Apache-2.0
// The statistics of a run are one JSON object with every key that the manual promises, of the right type.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

/** Runs the program on the Cornell box. @return its statistics, a new reference */
static json_t *stats_of(const char *options)
{
    const char *sheen = getenv("SHEEN_BIN");
    assert_non_null(sheen);
    char command[2048];
    snprintf(command, sizeof command,
             "f=$(mktemp -d) && '%s' render '%s/scenes/cornell-box.xml' -o $f/a.exr --stats - --size 24x16 --quiet "
             "--gather-rays 64 --accuracy 0.5 %s; code=$?; rm -r $f; exit $code",
             sheen, SHEEN_TEST_SOURCE_DIR, options);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    json_error_t error;
    json_t *stats = json_loadf(pipe, JSON_REJECT_DUPLICATES, &error);
    if (!stats) print_error("%s at line %d\n", error.text, error.line);
    assert_int_equal(pclose(pipe), 0);
    assert_true(json_is_object(stats));
    return stats;
}

static json_int_t integer(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    if (!json_is_integer(value)) print_error("no integer: %s\n", key);
    assert_true(json_is_integer(value));
    assert_true(json_integer_value(value) >= 0);
    return json_integer_value(value);
}

static double seconds(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    if (!json_is_real(value)) print_error("no seconds: %s\n", key);
    assert_true(json_is_real(value));
    assert_true(json_real_value(value) >= 0.0);
    return json_real_value(value);
}

static const char *text(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    if (!json_is_string(value)) print_error("no text: %s\n", key);
    assert_true(json_is_string(value));
    return json_string_value(value);
}

static void check_keys(const json_t *stats)
{
    static const char *const times[] = {"load",   "build",       "visibility", "fill",
                                        "direct", "interpolate", "write",      "total"};
    static const char *const rays[] = {"camera", "shadow", "gather", "path", "specular"};
    static const char *const records[] = {"irradiance", "radiance", "light_vector", "reused", "new", "deleted"};
    static const char *const counters[] = {"threads", "seed",    "cache_bytes", "peak_rss_bytes",
                                           "passes",  "refined", "spp_done",    "nonfinite_samples"};
    text(stats, "version");
    text(stats, "scene");
    assert_true(json_is_object(json_object_get(stats, "options")));
    const json_t *size = json_object_get(stats, "size");
    assert_int_equal(json_array_size(size), 2);
    assert_int_equal(json_integer_value(json_array_get(size, 0)), 24);
    assert_int_equal(json_integer_value(json_array_get(size, 1)), 16);
    double sum = 0.0;
    assert_true(json_number_value(json_object_get(stats, "spp_mean")) >= (double)integer(stats, "spp_done"));
    const json_t *time = json_object_get(stats, "time");
    for (size_t i = 0; i < sizeof times / sizeof *times - 1; ++i) sum += seconds(time, times[i]);
    // The stages do not overlap, so that they are at most the whole.
    assert_true(sum <= seconds(time, "total") + 1e-3);
    assert_true(seconds(time, "refine") <= seconds(time, "fill"));
    for (size_t i = 0; i < sizeof rays / sizeof *rays; ++i) integer(json_object_get(stats, "rays"), rays[i]);
    for (size_t i = 0; i < sizeof records / sizeof *records; ++i)
        integer(json_object_get(stats, "records"), records[i]);
    for (size_t i = 0; i < sizeof counters / sizeof *counters; ++i) integer(stats, counters[i]);
    assert_true(integer(stats, "peak_rss_bytes") > 1000000); // Embree alone takes more
    const json_t *frames = json_object_get(stats, "frames");
    assert_int_equal(json_array_size(frames), 1);
    integer(json_array_get(frames, 0), "frame");
    seconds(json_array_get(frames, 0), "time");
    integer(json_array_get(frames, 0), "records");
}

static void test_irradiance(void **state)
{
    (void)state;
    json_t *stats = stats_of("--integrator irradiance --spp 2 --threads 2 --seed 5");
    check_keys(stats);
    assert_string_equal(text(stats, "integrator"), "irradiance");
    assert_int_equal(integer(stats, "threads"), 2);
    assert_int_equal(integer(stats, "seed"), 5);
    const json_t *records = json_object_get(stats, "records"), *rays = json_object_get(stats, "rays");
    assert_true(integer(records, "irradiance") > 0);
    assert_true(integer(records, "new") >= integer(records, "irradiance"));
    // At least one ray a sample; every record gathers at least half of the 64 rays, whatever the grid of strata.
    assert_true(integer(rays, "camera") >= 24 * 16 * 2);
    assert_true(integer(rays, "gather") >= 32 * integer(records, "irradiance"));
    assert_true(integer(stats, "cache_bytes") > 0);
    // Records are refined unless that is turned off.
    assert_true(integer(stats, "refined") > 0 && seconds(json_object_get(stats, "time"), "refine") > 0.0);
    json_decref(stats);
    stats = stats_of("--integrator irradiance --spp 2 --adaptive off");
    assert_true(integer(stats, "refined") == 0 && seconds(json_object_get(stats, "time"), "refine") == 0.0);
    json_decref(stats);
}

static void test_path(void **state)
{
    (void)state;
    json_t *stats = stats_of("--integrator path --spp 3 --bounces 2");
    check_keys(stats);
    assert_string_equal(text(stats, "integrator"), "path");
    assert_int_equal(integer(stats, "spp_done"), 3);
    assert_int_equal(integer(json_object_get(stats, "records"), "irradiance"), 0);
    const json_t *options = json_object_get(stats, "options");
    assert_int_equal(integer(options, "bounces"), 2);
    assert_int_equal(integer(options, "spp"), 3);
    assert_string_equal(text(options, "filter"), "box"); // the scene's
    assert_string_equal(text(options, "integrator"), "path");
    json_decref(stats);
}

static void test_time_limit(void **state)
{
    (void)state;
    json_t *stats = stats_of("--integrator path --time-limit 0.3");
    check_keys(stats);
    assert_true(integer(stats, "passes") >= 1);
    assert_true(integer(stats, "spp_done") >= 1);
    // It may end late by one pass; no pass of so small a picture takes seconds, not even under a sanitizer.
    double total = seconds(json_object_get(stats, "time"), "total");
    assert_true(total > 0.2 && total < 10.0);
    json_decref(stats);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_irradiance),
        cmocka_unit_test(test_path),
        cmocka_unit_test(test_time_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
