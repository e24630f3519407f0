// SPDX-License-Identifier: Apache-2.0
// The clear sky against its published formulas and against nature.
#include "io/sky.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define CANDELAS (683.0 * 106.86)

static void the_zenith_follows_the_formula(void **state)
{
    (void)state;
    // (4.0453 T - 4.9710) tan((4/9 - T/120)(pi - 2 theta)) - 0.2155 T + 2.4192 in kcd/m^2, by a calculator.
    static const struct {
        double turbidity, theta, luminance;
    } cases[] = {{2.0, 0.0, 15500.672}, {3.0, 0.6435011, 8830.917}, {6.0, 1.0, 10456.570}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        double zenith = sheen_sky_zenith(cases[i].turbidity, cases[i].theta);
        assert_true(fabs(zenith / cases[i].luminance - 1.0) < 1e-5); // the figures' digits
        SheenSky sky = sheen_sky_make(cases[i].turbidity, cases[i].theta);
        float radiance = rgb_luminance(sheen_sky_radiance(&sky, 1.0, cos(cases[i].theta)));
        // The matrix of sRGB and the luminance of its primaries have 4 digits.
        assert_true(fabs((double)radiance * CANDELAS / zenith - 1.0) < 1e-3);
    }
}

static void colours_follow_the_formula(void **state)
{
    (void)state;
    // Turbidity 3, the sun at 0.6435011 from the zenith; preetham1999's tables put in by hand, apart from this code.
    SheenSky sky = sheen_sky_make(3.0, 0.6435011);
    static const struct {
        double cos_theta, cos_gamma;
        float r, g, b;
    } cases[] = {{1.0, 0.8, 0.0799695f, 0.1221653f, 0.2302951f}, {0.2, 0.5, 0.1284728f, 0.1509916f, 0.2011262f}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        Rgb c = sheen_sky_radiance(&sky, cases[i].cos_theta, cases[i].cos_gamma);
        assert_float_equal(c.r, cases[i].r, 1e-6f);
        assert_float_equal(c.g, cases[i].g, 1e-6f);
        assert_float_equal(c.b, cases[i].b, 1e-6f);
    }
}

static void the_sky_is_blue_above_and_brightest_at_the_sun(void **state)
{
    (void)state;
    const double theta = 0.8;
    SheenSky sky = sheen_sky_make(3.0, theta);
    Rgb up = sheen_sky_radiance(&sky, 1.0, cos(theta));
    assert_true(up.b > 1.5f * up.g && up.g > up.r);
    Rgb sun = sheen_sky_radiance(&sky, cos(theta), 1.0), away = sheen_sky_radiance(&sky, cos(theta), cos(2.0 * theta));
    assert_true(rgb_luminance(sun) > 2.0f * rgb_luminance(away));
    assert_true(rgb_is_black(sheen_sky_radiance(&sky, -0.01, 0.0)));
    // Nowhere is it negative or not a number, for any haze and height of the sun.
    for (int t = 0; t <= 16; ++t)
        for (int s = 0; s <= 8; ++s) {
            sky = sheen_sky_make(2.0 + 0.5 * t, s * 0.19634954);
            for (int i = 0; i <= 8; ++i)
                for (int j = -8; j <= 8; ++j) {
                    Rgb c = sheen_sky_radiance(&sky, i / 8.0, j / 8.0);
                    assert_true(rgb_finite(c) && c.r >= 0.0f && c.g >= 0.0f && c.b >= 0.0f);
                }
        }
}

static void the_sun_fades_and_reddens(void **state)
{
    (void)state;
    // Outside the air it would be about 1.9 W m^-2 nm^-1 at 550 nm; a clear noon has 100,000 lx and more.
    float noon = rgb_luminance(sheen_sun_irradiance(2.0, 0.0));
    assert_true((double)noon * CANDELAS > 9e4 && (double)noon * CANDELAS < 1.4e5);
    float before = INFINITY;
    for (double turbidity = 2.0; turbidity <= 10.0; turbidity += 1.0) {
        Rgb c = sheen_sun_irradiance(turbidity, 1.0);
        assert_true(c.r > 0.0f && c.g > 0.0f && c.b > 0.0f);
        assert_true(rgb_luminance(c) < before);
        before = rgb_luminance(c);
    }
    Rgb high = sheen_sun_irradiance(3.0, 0.2), low = sheen_sun_irradiance(3.0, 1.5);
    assert_true(low.b / low.r < 0.5f * high.b / high.r && low.r < high.r);
    assert_true(rgb_finite(sheen_sun_irradiance(10.0, 1.5707963)));
}

static void the_sun_stands_where_the_almanac_has_it(void **state)
{
    (void)state;
    // Noon at the equinox on the equator: overhead. The formulas are good to half a degree or so: 0.01 rad.
    SheenSkyTime t = {.year = 2010, .month = 3, .day = 21, .hour = 12.0 + 7.4 / 60.0}; // the sun is late by 7.4 minutes
    assert_true(sheen_sun_direction(&t).y > cosf(0.01f));
    // Midsummer noon at 52 degrees north: 61.4 degrees high, in the south.
    t = (SheenSkyTime){.latitude = 52, .year = 2010, .month = 6, .day = 21, .hour = 12.0 + 1.7 / 60.0};
    Vec3 d = sheen_sun_direction(&t);
    assert_float_equal(d.y, 0.878f, 0.01f);
    assert_float_equal(d.z, 0.478f, 0.01f);
    // In the morning in the east; by a clock an hour ahead it stands an hour earlier.
    t.hour = 6.0;
    d = sheen_sun_direction(&t);
    assert_true(d.x > 0.8f && d.y > 0.0f);
    t.timezone = 1.0, t.hour = 7.0;
    assert_true(v3_length(v3_sub(sheen_sun_direction(&t), d)) < 1e-5f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_zenith_follows_the_formula),
        cmocka_unit_test(colours_follow_the_formula),
        cmocka_unit_test(the_sky_is_blue_above_and_brightest_at_the_sun),
        cmocka_unit_test(the_sun_fades_and_reddens),
        cmocka_unit_test(the_sun_stands_where_the_almanac_has_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
