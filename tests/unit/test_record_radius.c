// SPDX-License-Identifier: Apache-2.0
// Radii of records: bounded by what a picture resolves, of discs and of ellipses.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "integrator/record_radius.h"

static const float footprint = 0.01f, a = 0.2f;

static bool near(float x, float y)
{
    return fabsf(x - y) <= 1e-5f * y;
}

static Record ellipse(float shorter, float longer)
{
    SheenOptions o = sheen_options_default();
    o.reach_min = 4.0f;
    o.reach_max = 25.0f;
    Record r = {.n = v3(0, 0, 1), .a = a};
    const Frame frame = frame_from_normal(r.n);
    const HessianEllipse e = {0.6f, 0.8f, {shorter, longer}};
    record_set_ellipse(&o, footprint, &frame, &e, &r);
    assert_true(fabsf(v3_dot(r.stretch, r.n)) < 1e-6f);
    // The longer radius lies along (-s, c).
    assert_true(fabsf(v3_dot(r.stretch, frame_to_world(&frame, v3(0.6f, 0.8f, 0.0f)))) < 1e-6f);
    return r;
}

// Reaches are 4 to 25 pixels of a centimetre: R is 0.2 to 1.25 metres.
static void test_bounds(void **state)
{
    (void)state;
    Record r = ellipse(0.5f, 0.75f);
    assert_true(near(r.R, 0.5f) && near(r.R_sure, 0.5f) && near(record_elongation(&r), 1.5f));
    r = ellipse(0.5f, INFINITY); // no longer than twice as wide
    assert_true(near(r.R, 0.5f) && near(record_elongation(&r), 2.0f));
    r = ellipse(1.0f, 5.0f); // nor than the picture has use for
    assert_true(near(r.R, 1.0f) && near(record_elongation(&r), 1.25f));
    r = ellipse(INFINITY, INFINITY);
    assert_true(near(r.R, 1.25f) && isinf(r.R_sure) && record_elongation(&r) == 1.0f);
    r = ellipse(0.1f, 0.15f); // enlarged both ways
    assert_true(near(r.R, 0.2f) && near(r.R_sure, 0.1f) && record_elongation(&r) == 1.0f);
    r = ellipse(0.1f, 0.3f); // across
    assert_true(near(r.R, 0.2f) && near(record_elongation(&r), 1.5f));
    r = ellipse(0.0f, 0.0f); // a sliver
    assert_true(near(r.R, 0.2f) && near(r.R_sure, 0.02f) && record_elongation(&r) == 1.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
