// SPDX-License-Identifier: Apache-2.0
// Hot spots: what is found joins, what matters is chosen, and the rays toward them have the density that is claimed.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/hash.h"
#include "integrator/hot_spot.h"

static const SheenStrata strata = {.rings = 11, .sectors = 36};

static Vec2 numbers(uint32_t i)
{
    return v2(hash_to_unit(hash_combine(i, 1)), hash_to_unit(hash_combine(i, 2)));
}

static void test_near_hits_join(void **state)
{
    (void)state;
    HotSpots s = {0};
    sheen_hot_spots_add(&s, v3(0, 0, 2), 2.0f, 10.0f);
    sheen_hot_spots_add(&s, v3(0.05f, 0, 2), 2.0f, 30.0f);
    sheen_hot_spots_add(&s, v3(1, 0, 2), 2.0f, 20.0f);
    assert_int_equal(s.n, 2);
    assert_int_equal(s.spots[0].hits, 2);
    assert_true(s.spots[0].radiance == 30.0f);
    assert_true(s.spots[0].radius >= 0.05f && s.spots[0].radius < 0.2f);
    for (uint32_t i = 0; i < 2000; ++i) sheen_hot_spots_add(&s, v3((float)i, 5, 0), 1.0f, 1.0f);
    assert_int_equal(s.n, SHEEN_HOT_SPOTS_MAX);
}

// One spot before the point, one behind, one so dim that it does not matter, one so wide that the strata find it.
static void test_choice(void **state)
{
    (void)state;
    HotSpots s = {.n = 4,
                  .spots = {{v3(0.5f, 0, 2), 0.05f, 500.0f, 1},
                            {v3(0, 0, -2), 0.05f, 500.0f, 1},
                            {v3(0, 0.5f, 2), 0.05f, 0.1f, 1},
                            {v3(0, -1, 2), 1.0f, 500.0f, 1}}};
    Frame frame = frame_from_normal(v3(0, 0, 1));
    Guide g;
    sheen_guide_choose(&s, v3(0, 0, 0), &frame, strata, 1.0f, 0.02f, &g);
    assert_int_equal(g.n, 1);
    assert_int_equal(g.cones[0].spot, 0);
    assert_true(g.cones[0].rays > 2);
    sheen_guide_choose(&s, v3(0, 0, 0), &frame, strata, 0.0f, 0.02f, &g); // nothing is known of the mean
    assert_int_equal(g.n, 0);
}

// As many spots as there may be cones, each of which wants many rays: all together get no more than there are strata,
// each still gets some, and the densities are those of the rays that are left.
static void test_rays_are_limited(void **state)
{
    (void)state;
    HotSpots s = {.n = SHEEN_CONES_MAX};
    for (uint32_t i = 0; i < s.n; ++i) {
        float phi = 2.0f * SHEEN_PI * (float)i / (float)s.n;
        s.spots[i] = (HotSpot){v3(cosf(phi), sinf(phi), 1.0f), 0.03f, 1000.0f, 1};
    }
    Frame frame = frame_from_normal(v3(0, 0, 1));
    Guide g;
    sheen_guide_choose(&s, v3(0, 0, 0), &frame, strata, 1.0f, 0.02f, &g);
    assert_int_equal(g.n, SHEEN_CONES_MAX);
    uint32_t rays = 0;
    for (uint32_t i = 0; i < g.n; ++i) {
        rays += g.cones[i].rays;
        float omega = 2.0f * SHEEN_PI * g.cones[i].sin2_max / (1.0f + sqrtf(1.0f - g.cones[i].sin2_max));
        assert_true(g.cones[i].rays > 0);
        assert_float_equal(g.cones[i].density * omega, (float)g.cones[i].rays, 1e-3f * (float)g.cones[i].rays);
    }
    assert_in_range(rays, SHEEN_CONES_MAX, strata_count(strata));
}

static HotSpots two_spots(void)
{
    return (HotSpots){.n = 2, .spots = {{v3(1, 0, 1), 0.1f, 200.0f, 1}, {v3(1.05f, 0.1f, 1.1f), 0.12f, 100.0f, 1}}};
}

// Directions of a cone lie in it, and guide_density there is what the numbers of rays say: its integral over the sphere
// is the number of all rays.
static void test_cone_density(void **state)
{
    (void)state;
    HotSpots s = two_spots();
    Frame frame = frame_from_normal(v3(0, 0, 1));
    Guide g;
    sheen_guide_choose(&s, v3(0, 0, 0), &frame, strata, 1.0f, 0.02f, &g);
    assert_int_equal(g.n, 2);
    double rays = 0.0, integral = 0.0;
    for (uint32_t c = 0; c < g.n; ++c) {
        rays += g.cones[c].rays;
        for (uint32_t i = 0; i < 1000; ++i)
            assert_true(guide_density(&g, sheen_cone_direction(&g.cones[c], numbers(i))) >= g.cones[c].density);
    }
    enum { STEPS = 2000 };
    for (uint32_t i = 0; i < STEPS; ++i)
        for (uint32_t j = 0; j < STEPS; ++j) {
            float z = (float)(i + 0.5) / STEPS, phi = 2.0f * SHEEN_PI * (float)(j + 0.5) / STEPS, r = sqrtf(1 - z * z);
            integral += (double)guide_density(&g, v3(r * cosf(phi), r * sinf(phi), z));
        }
    integral *= 2.0 * 3.14159265358979 / ((double)STEPS * STEPS);
    assert_float_equal((float)(integral / rays), 1.0f, 0.01f); // the quadrature's step is 1/60 of a cone's width
}

// The mean of weight times radiance is the irradiance over pi whatever the guide says: with light from a spot, from a
// place that is no spot, and from all around.
static void test_guided_direction_is_unbiased(void **state)
{
    (void)state;
    HotSpots s = two_spots();
    Frame frame = frame_from_normal(v3_normalize(v3(0.3f, -0.2f, 1)));
    Guide g;
    sheen_guide_choose(&s, v3(0, 0, 0), &frame, strata, 1.0f, 0.02f, &g);
    assert_true(g.n > 0);
    Vec3 p = v3(0.02f, 0.01f, 0); // beside the gather's point
    Vec3 spot = frame_to_local(&frame, v3_normalize(v3_sub(v3(1, 0, 1), p))), other = v3_normalize(v3(-0.5f, 0.5f, 1));
    enum { N = 400000 };
    double sum[3] = {0, 0, 0}, squares[3] = {0, 0, 0}, exact[3];
    const float cos_spot = cosf(0.05f), cos_other = cosf(0.3f);
    for (uint32_t i = 0; i < N; ++i) {
        Vec3 d;
        float w = sheen_guide_direction(&g, p, &frame, hash_to_unit(hash_combine(i, 3)), numbers(i), &d);
        if (d.z <= 0.0f) w = 0.0f;
        double value[3] = {v3_dot(d, spot) > cos_spot ? (double)w : 0.0, v3_dot(d, other) > cos_other ? (double)w : 0.0,
                           (double)w};
        for (int k = 0; k < 3; ++k) sum[k] += value[k], squares[k] += value[k] * value[k];
    }
    // A cone of half angle t about an axis of elevation cosine c sends c sin^2(t) of what the hemisphere would.
    exact[0] = (double)spot.z * sin(0.05) * sin(0.05);
    exact[1] = (double)other.z * sin(0.3) * sin(0.3);
    exact[2] = 1.0;
    for (int k = 0; k < 3; ++k) {
        double mean = sum[k] / N, error = sqrt((squares[k] / N - mean * mean) / N);
        assert_true(fabs(mean - exact[k]) < 4.5 * error + 1e-6);
    }
    // The spot is what the guide is for: cosine-weighted rays would have a relative deviation of 1 / sqrt(share).
    double mean = sum[0] / N, deviation = sqrt(squares[0] / N - mean * mean) / mean;
    assert_true(deviation < 0.2 / sqrt(exact[0]));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_near_hits_join),
        cmocka_unit_test(test_choice),
        cmocka_unit_test(test_rays_are_limited),
        cmocka_unit_test(test_cone_density),
        cmocka_unit_test(test_guided_direction_is_unbiased),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
