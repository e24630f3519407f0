// SPDX-License-Identifier: Apache-2.0
#include "image/metric.h"

#include "image/flip.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define assert_near(got, want, bound)                                                                                  \
    do { /* written so that a NaN fails */                                                                             \
        double g_ = (got), w_ = (want);                                                                                \
        if (!(fabs(g_ - w_) <= (bound))) fail_msg("%s = %.9g, want %.9g", #got, g_, w_);                               \
    } while (0)

typedef struct Pair {
    SheenImage reference, image;
} Pair;

static Pair pair_create(uint32_t width, uint32_t height)
{
    Pair p = {{width, height, calloc((size_t)width * height, sizeof(Rgb))},
              {width, height, calloc((size_t)width * height, sizeof(Rgb))}};
    assert_true(p.reference.pixels && p.image.pixels);
    return p;
}

static void pair_free(Pair *p)
{
    sheen_image_free(&p->reference);
    sheen_image_free(&p->image);
}

static void fill(SheenImage *image, Rgb value)
{
    for (size_t i = 0; i < (size_t)image->width * image->height; ++i) image->pixels[i] = value;
}

/** A bright spot with waves, and the same with a finer wave on it and a tint. */
static Pair make_waves(uint32_t width, uint32_t height)
{
    Pair p = pair_create(width, height);
    for (uint32_t v = 0; v < height; ++v) {
        for (uint32_t u = 0; u < width; ++u) {
            double w = width, x = u, y = v, dx = x - 0.3 * w, dy = y - 0.6 * height;
            double base = 0.02 + 4.0 * exp(-(dx * dx + dy * dy) / (0.02 * w * w));
            double r = base * (1.0 + 0.5 * sin(0.7 * x)), g = base * (1.0 + 0.5 * sin(0.5 * y + 1.0));
            double b = base * (1.0 + 0.5 * cos(0.3 * x + 0.4 * y)), k = 1.0 + 0.2 * sin(2.1 * x + 1.3 * y);
            p.reference.pixels[v * width + u] = (Rgb){(float)r, (float)g, (float)b};
            p.image.pixels[v * width + u] = (Rgb){(float)(r * k + 0.01), (float)(g * k), (float)(b * k + 0.02)};
        }
    }
    return p;
}

static SheenMetrics compare(const Pair *p)
{
    SheenMetrics m;
    assert_int_equal(sheen_metrics_compute(&p->reference, &p->image, NULL, &m), SHEEN_OK);
    return m;
}

static void test_equal_pictures(void **state)
{
    (void)state;
    Pair p = make_waves(31, 17);
    memcpy(p.image.pixels, p.reference.pixels, 31 * 17 * sizeof(Rgb));
    SheenMetrics m = compare(&p);
    assert_true(m.mse == 0.0 && m.rmse == 0.0 && m.relmse == 0.0 && m.mae == 0.0 && m.bias == 0.0 && m.flip == 0.0);
    assert_true(isinf(m.psnr) && m.psnr > 0.0);
    assert_near(m.ssim, 1.0, 1e-12);
    assert_int_equal(m.nonfinite, 0);
    pair_free(&p);
}

/** Reference 2, image 2.5 in one channel of three: all means are known. */
static void test_closed_form(void **state)
{
    (void)state;
    Pair p = pair_create(20, 30);
    fill(&p.reference, (Rgb){2.0f, 2.0f, 2.0f});
    fill(&p.image, (Rgb){2.0f, 2.5f, 2.0f});
    SheenMetrics m = compare(&p);
    assert_near(m.mse, 0.25 / 3.0, 1e-15);
    assert_near(m.rmse, sqrt(0.25 / 3.0), 1e-15);
    assert_near(m.relmse, 0.25 / 4.01 / 3.0, 1e-15);
    assert_near(m.mae, 0.5 / 3.0, 1e-15);
    assert_near(m.bias, 0.5 / 6.0, 1e-15);
    assert_near(m.psnr, 10.0 * log10(4.0 / (0.25 / 3.0)), 1e-12);
    pair_free(&p);
}

static void test_nonfinite_values_are_counted_and_left_out(void **state)
{
    (void)state;
    Pair p = pair_create(20, 30);
    fill(&p.reference, (Rgb){2.0f, 2.0f, 2.0f});
    fill(&p.image, (Rgb){2.5f, 2.5f, 2.5f});
    SheenMetrics clean = compare(&p);
    p.image.pixels[7].g = NAN;
    p.image.pixels[99].r = INFINITY;
    p.reference.pixels[99].r = -INFINITY; // the same value of both: one
    p.reference.pixels[599].b = NAN;
    SheenMetrics m = compare(&p);
    assert_int_equal(m.nonfinite, 3);
    assert_near(m.mse, clean.mse, 1e-12);
    assert_near(m.relmse, clean.relmse, 1e-12);
    assert_near(m.bias, clean.bias, 1e-12);
    // Filters see black in both at such a pixel, which its neighbours notice a little.
    assert_near(m.flip, clean.flip, 0.02);
    assert_near(m.ssim, clean.ssim, 0.02);
    fill(&p.image, (Rgb){NAN, NAN, NAN});
    m = compare(&p);
    assert_int_equal(m.nonfinite, 1800);
    assert_true(isnan(m.mse) && isnan(m.bias) && isnan(m.psnr) && isnan(m.flip) && isnan(m.ssim));
    pair_free(&p);
}

/**
 * HDR-FLIP against its authors' program, flip-evaluator 1.7 from PyPI, on the pictures of make_waves:
 * flip_evaluator.evaluate(reference, image, "HDR", applyMagma=False) gives map, mean and parameters.
 */
static void test_flip_agrees_with_its_authors(void **state)
{
    (void)state;
    static const struct {
        uint32_t width, height;
        double mean, start, stop;
        unsigned count;
    } cases[] = {
        {64, 48, 0.35218575596809387, -1.3648407459259033, 6.230834484100342, 8},
        {33, 21, 0.33929142355918884, -1.3909128904342651, 5.838842391967773, 8},
        {5, 3, 0.36352089047431946, -0.6148759126663208, 5.558133125305176, 7},
        {3, 1, 0.3687807321548462, 1.5041460990905762, 5.928868293762207, 5},
        {2, 1, 0.22859793901443481, 5.858460903167725, 5.858460903167725, 2},
        {1, 1, 0.1971450001001358, 6.308143138885498, 6.308143138885498, 2},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        Pair p = make_waves(cases[i].width, cases[i].height);
        SheenFlipExposures e;
        assert_int_equal(sheen_flip_exposures(&p.reference, NULL, &e), SHEEN_OK);
        assert_near((double)e.start, cases[i].start, 1e-5);
        assert_near((double)e.stop, cases[i].stop, 1e-5);
        assert_int_equal(e.count, cases[i].count);
        // They agree to 4e-6; the rest is the rounding of the primaries.
        assert_near(compare(&p).flip, cases[i].mean, 2e-5);
        pair_free(&p);
    }
}

/** One exposure at a time, as with parameters={"startExposure": e, "stopExposure": e}: the first pixels of the map. */
static void test_flip_map_at_one_exposure(void **state)
{
    (void)state;
    static const struct {
        float exposure;
        double mean, pixel[3];
    } cases[] = {
        {0.0f, 0.09650007635354996, {0.13266827, 0.12344506, 0.11150378}},
        {-2.0f, 0.028809214010834694, {0.02387743, 0.02142026, 0.01834184}},
        {3.0f, 0.30797532200813293, {0.45698982, 0.4391016, 0.4249511}},
    };
    Pair p = make_waves(64, 48);
    for (int i = 0; i < 3; ++i) {
        static float map[64 * 48];
        SheenFlipExposures e = {cases[i].exposure, cases[i].exposure, 1};
        assert_int_equal(sheen_flip_compute(&p.reference, &p.image, &e, NULL, map), SHEEN_OK);
        double sum = 0.0;
        for (int k = 0; k < 64 * 48; ++k) sum += (double)map[k];
        assert_near(sum / (64 * 48), cases[i].mean, 2e-5);
        for (int k = 0; k < 3; ++k) assert_near((double)map[k], cases[i].pixel[k], 2e-5);
    }
    pair_free(&p);
}

static double luma(Rgb c)
{
    return (double)sheen_srgb_encode(0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b);
}

/** SSIM by its definition: a window of 11 x 11 around each pixel whose window lies inside. */
static double ssim_by_definition(const Pair *p)
{
    uint32_t width = p->image.width, height = p->image.height;
    double total = 0.0, n = 0.0;
    for (uint32_t v = 5; v + 5 < height; ++v) {
        for (uint32_t u = 5; u + 5 < width; ++u, n += 1.0) {
            double s = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
            for (int pass = 0; pass < 2; ++pass) { // first the means, then the moments about them
                double mx = x, my = y;
                for (int j = -5; j <= 5; ++j) {
                    for (int i = -5; i <= 5; ++i) {
                        double w = exp(-(i * i + j * j) / 4.5);
                        size_t at = (size_t)((int)v + j) * width + (size_t)((int)u + i);
                        double a = luma(p->image.pixels[at]), b = luma(p->reference.pixels[at]);
                        if (pass == 0) {
                            s += w;
                            x += w * a;
                            y += w * b;
                        } else {
                            xx += w * (a - mx) * (a - mx) / s;
                            yy += w * (b - my) * (b - my) / s;
                            xy += w * (a - mx) * (b - my) / s;
                        }
                    }
                }
                if (pass == 0) {
                    x /= s;
                    y /= s;
                }
            }
            total += (2 * x * y + 1e-4) * (2 * xy + 9e-4) / ((x * x + y * y + 1e-4) * (xx + yy + 9e-4));
        }
    }
    return total / n;
}

static void test_ssim_agrees_with_its_definition(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{64, 48}, {11, 11}, {12, 30}};
    for (int i = 0; i < 3; ++i) {
        Pair p = make_waves(sizes[i][0], sizes[i][1]);
        // Variances are differences of means of squares in float: 1e-7 against the constant 9e-4.
        assert_near(compare(&p).ssim, ssim_by_definition(&p), 3e-4);
        pair_free(&p);
    }
}

static void test_small_and_odd_pictures(void **state)
{
    (void)state;
    for (uint32_t width = 1; width < 14; width += 3) {
        for (uint32_t height = 1; height < 14; height += 4) {
            Pair p = make_waves(width, height);
            SheenMetrics m = compare(&p);
            assert_true(m.flip > 0.0 && m.flip < 1.0 && m.ssim > -1.0 && m.ssim <= 1.0);
            pair_free(&p);
        }
    }
    // Black against white, huge against tiny: extremes, yet numbers.
    static const float values[] = {0.0f, 1e-30f, 1.0f, 1e30f, 3e38f, -1.0f};
    for (int i = 0; i < 6; ++i) {
        for (int k = 0; k < 6; ++k) {
            Pair p = pair_create(3, 2);
            fill(&p.reference, (Rgb){values[i], 0.0f, values[i]});
            fill(&p.image, (Rgb){values[k], values[k], 0.0f});
            SheenMetrics m = compare(&p);
            assert_true(m.flip >= 0.0 && m.flip <= 1.0 && m.ssim >= -1.0 && m.ssim <= 1.0 + 1e-12);
            assert_false(isnan(m.mse) || isnan(m.relmse) || isnan(m.bias));
            pair_free(&p);
        }
    }
}

static void test_sizes_must_agree(void **state)
{
    (void)state;
    Pair p = pair_create(4, 3);
    Pair q = pair_create(3, 4);
    SheenMetrics m;
    assert_int_equal(sheen_metrics_compute(&p.reference, &q.image, NULL, &m), SHEEN_ERR_INVALID);
    pair_free(&p);
    pair_free(&q);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_equal_pictures),
        cmocka_unit_test(test_closed_form),
        cmocka_unit_test(test_nonfinite_values_are_counted_and_left_out),
        cmocka_unit_test(test_flip_agrees_with_its_authors),
        cmocka_unit_test(test_flip_map_at_one_exposure),
        cmocka_unit_test(test_ssim_agrees_with_its_definition),
        cmocka_unit_test(test_small_and_odd_pictures),
        cmocka_unit_test(test_sizes_must_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
