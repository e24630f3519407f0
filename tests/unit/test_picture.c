// SPDX-License-Identifier: Apache-2.0
// Further samples of noisy pixels: how many, told by whom, and that they bias nothing.
#include "base/hash.h"
#include "integrator/picture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIDE = 9, PIXELS = SIDE * SIDE, SPP = 16 };

static SheenFilm *begin(Picture *picture)
{
    SheenWork work = {.width = SIDE, .height = SIDE, .options = {.spp = SPP}};
    SheenFilm *film;
    assert_int_equal(sheen_film_create(SIDE, SIDE, 1u << SHEEN_AOV_DIRECT | 1u << SHEEN_AOV_PRIMITIVE, &film),
                     SHEEN_OK);
    assert_true(sheen_picture_create(&work, film, picture));
    return film;
}

static void end(SheenFilm *film, Picture *picture)
{
    sheen_picture_free(picture);
    sheen_film_destroy(&film);
}

static uint64_t plan(Picture *picture, float noise)
{
    uint64_t more;
    assert_true(sheen_picture_plan(noise, picture, &more));
    return more;
}

// Every sample of group g of every pixel has luminance value[g].
static void add_groups(Picture *picture, const float value[SHEEN_NOISE_GROUPS])
{
    SheenStats stats = {0};
    for (uint32_t i = 0; i < PIXELS; ++i)
        for (uint32_t s = 0; s < SPP; ++s)
            sheen_picture_add(picture, i, s, rgb_gray(value[s * SHEEN_NOISE_GROUPS / SPP]), SHEEN_AOV_DIRECT, &stats);
}

static void test_smooth_pixels_get_no_more(void **state)
{
    (void)state;
    Picture picture;
    SheenFilm *film = begin(&picture);
    add_groups(&picture, (const float[]){1.0f, 1.0f, 1.0f, 1.0f});
    assert_int_equal(plan(&picture, 0.01f), 0);
    for (int i = 0; i < PIXELS; ++i) assert_int_equal(picture.samples[i], SPP);
    end(film, &picture);
}

static void test_counts_follow_the_variance(void **state)
{
    (void)state;
    Picture picture;
    SheenFilm *film = begin(&picture);
    // Mean 1; the groups' means are off by 0.1, so that the variance of their mean is 4 * 0.01 / (4 * 3) = 1 / 300.
    add_groups(&picture, (const float[]){0.9f, 1.1f, 0.9f, 1.1f});
    // The error allowed is noise * (1 + 1/4), the median counting a quarter beside the brightness.
    const float noise = 0.04f;
    uint32_t expected = (uint32_t)ceil(SPP / 300.0 / (0.05 * 0.05)); // 21.3
    uint64_t more = plan(&picture, noise);
    for (int i = 0; i < PIXELS; ++i) assert_in_range(picture.samples[i], expected, expected + 1); // rounding of floats
    assert_in_range(more, (uint64_t)PIXELS * (expected - SPP), (uint64_t)PIXELS * (expected + 1 - SPP));
    plan(&picture, 1e-6f);
    for (int i = 0; i < PIXELS; ++i) assert_int_equal(picture.samples[i], SPP * (1 + SHEEN_MORE_MAX));
    end(film, &picture);
}

static void test_a_pixel_does_not_decide_for_itself(void **state)
{
    (void)state;
    enum { MIDDLE = PIXELS / 2 };
    Picture picture;
    SheenFilm *film = begin(&picture);
    add_groups(&picture, (const float[]){1.0f, 1.0f, 1.0f, 1.0f});
    SheenStats stats = {0};
    sheen_picture_add(&picture, MIDDLE, 3, rgb_gray(1000.0f), SHEEN_AOV_DIRECT, &stats);
    plan(&picture, 0.01f);
    assert_int_equal(picture.samples[MIDDLE], SPP);
    assert_int_equal(picture.samples[MIDDLE + 1], SPP * (1 + SHEEN_MORE_MAX));
    assert_int_equal(picture.samples[MIDDLE - 2 * SIDE], SPP * (1 + SHEEN_MORE_MAX));
    assert_int_equal(picture.samples[MIDDLE - 3 * SIDE], SPP);
    end(film, &picture);
}

static void test_average(void **state)
{
    (void)state;
    Picture picture;
    SheenFilm *film = begin(&picture);
    SheenStats stats = {0};
    picture.samples[5] = 20;
    film_add(film, SHEEN_AOV_PRIMITIVE, 5, 0, rgb(7.0f, 8.0f, 9.0f));
    for (uint32_t s = 0; s < 20; ++s)
        sheen_picture_add(&picture, 5, s, rgb((float)s, 2.0f, 1.0f), SHEEN_AOV_DIRECT, &stats);
    sheen_picture_add(&picture, 5, 0, rgb(NAN, 0.0f, 0.0f), SHEEN_AOV_DIRECT, &stats);
    sheen_picture_average(&picture);
    // Sums of integers and a quotient of them: exact but for the rounding of 1 / 20.
    assert_true(fabsf(film->color[5].r - 9.5f) < 1e-5f && fabsf(film->color[5].g - 2.0f) < 1e-6f);
    assert_true(film->aov[SHEEN_AOV_DIRECT][15] == film->color[5].r);
    assert_true(film->aov[SHEEN_AOV_PRIMITIVE][15] == 7.0f);
    assert_int_equal(stats.nonfinite_samples, 1);
    end(film, &picture);
}

// Pixels whose samples are 50 with a chance of 1/50, else 0: of 16, seven in ten pixels see none that is bright. If a
// pixel decided by its own samples, those would stop there and the others, given 240 more, dilute what they have: the
// mean would fall to about a half.
static void test_further_samples_bias_nothing(void **state)
{
    (void)state;
    enum { TRIALS = 200 };
    double sum = 0.0, square = 0.0;
    for (uint32_t t = 0; t < TRIALS; ++t) {
        Picture picture;
        SheenFilm *film = begin(&picture);
        SheenStats stats = {0};
        double mean = 0.0;
        for (int pass = 0; pass < 2; ++pass) {
            for (uint32_t i = 0; i < PIXELS; ++i)
                for (uint32_t s = pass ? SPP : 0; s < picture.samples[i]; ++s) {
                    float u = hash_to_unit(hash_combine(hash_combine(t, i), s));
                    Rgb value = rgb_gray(u < 0.02f ? 50.0f : 0.0f);
                    sheen_picture_add(&picture, i, s, value, SHEEN_AOV_DIRECT, &stats);
                }
            if (pass == 0) plan(&picture, 0.3f);
        }
        sheen_picture_average(&picture);
        for (int i = 0; i < PIXELS; ++i) mean += (double)film->color[i].r / PIXELS;
        sum += mean;
        square += mean * mean;
        end(film, &picture);
    }
    double mean = sum / TRIALS, error = sqrt((square / TRIALS - mean * mean) / TRIALS);
    assert_true(error < 0.02);                   // or the next line would prove little
    assert_true(fabs(mean - 1.0) < 4.0 * error); // one run in 16,000 fails by chance; the numbers are fixed
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_smooth_pixels_get_no_more),          cmocka_unit_test(test_counts_follow_the_variance),
        cmocka_unit_test(test_a_pixel_does_not_decide_for_itself), cmocka_unit_test(test_average),
        cmocka_unit_test(test_further_samples_bias_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
