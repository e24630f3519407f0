// SPDX-License-Identifier: Apache-2.0
// Shadow rays, traced: they reach the light that was sampled, and nothing slips through what lies before it.
#include "ray/accel.h"
#include "unit/light_scene.h"

#define N_RAYS 20000

typedef struct Traced {
    LightScene lights;
    SheenPool *pool;
    SheenAccel *accel;
} Traced;

static Traced trace_begin(LightScene s)
{
    Traced t = {.lights = s};
    light_scene_end(&t.lights, SHEEN_ENVIRONMENT_WHOLE);
    assert_int_equal(sheen_pool_create(1, &t.pool), SHEEN_OK);
    assert_int_equal(sheen_accel_create(t.lights.scene, t.pool, NULL, &t.accel), SHEEN_OK);
    return t;
}

static void trace_end(Traced *t)
{
    sheen_accel_destroy(&t->accel);
    sheen_pool_destroy(&t->pool);
    light_scene_destroy(&t->lights);
}

static void add_wall(LightScene *s, const Vec3 corners[4])
{
    SheenArena *arena = sheen_builder_arena(s->builder);
    Vec3 *p = SHEEN_ARENA_NEW(arena, Vec3, 5);
    memcpy(p, corners, 4 * sizeof *p);
    static const uint32_t t[2][3] = {{0, 1, 2}, {0, 2, 3}};
    SheenShape shape = {
        .kind = SHEEN_SHAPE_MESH, .mesh = {.n_vertices = 4, .n_triangles = 2, .p = p, .triangles = t}, .name = "wall"};
    sheen_builder_add_shape(s->builder, &shape);
}

static void square(Vec3 out[4], Vec3 center, float half)
{
    for (int i = 0; i < 4; ++i) out[i] = v3_add(center, v3(i == 1 || i == 2 ? half : -half, i >= 2 ? half : -half, 0));
}

/** @return how many of the samples of light 0 are cut off from points around `p` with normal up. */
static int count_occluded(const Traced *t, Vec3 p, float spread)
{
    Random r = {1, 0};
    int n = 0, n_sampled = 0;
    for (int i = 0; i < N_RAYS; ++i) {
        SurfacePoint s = {.p = v3_add(p, v3(random_in(&r, -spread, spread), random_in(&r, -spread, spread), 0)),
                          .ng = v3(0, 0, 1),
                          .ns = v3(0, 0, 1)};
        s.clearance = sheen_surface_clearance(s.p, s.ng, 2.0f * spread);
        LightSample sample;
        if (!sheen_light_sample(t->lights.lights, 0, s.p, random_2d(&r), &sample)) continue;
        ++n_sampled;
        Ray ray = sheen_shadow_ray(&s, &sample);
        n += sheen_accel_occluded(t->accel, &ray);
    }
    assert_true(n_sampled > N_RAYS / 2);
    return n;
}

// A lamp that faces down, a millimetre (times the scale) under a ceiling, at every scale and far from the origin: no
// shadow ray meets the floor that it starts from, the lamp or the ceiling. The same lamp above the ceiling is dark.
static void test_lamp_at_a_wall(void **state)
{
    (void)state;
    const float scales[] = {1e-4f, 0.1f, 1, 100, 1e4f};
    const Vec3 origins[] = {{0, 0, 0}, {30, -20, 10}};
    for (size_t i = 0; i < sizeof scales / sizeof *scales; ++i)
        for (size_t j = 0; j < sizeof origins / sizeof *origins; ++j)
            for (int side = 0; side < 2; ++side)
                for (int kind = 0; kind < 3; ++kind) {
                    float k = scales[i], gap = (side ? 1e-3f : -1e-3f) * k;
                    Vec3 o = v3_scale(origins[j], k), v[4], lamp = v3_add(o, v3(0, 0, 3 * k + gap));
                    LightScene s = light_scene_begin();
                    square(v, lamp, 0.3f * k);
                    Vec3 down[4] = {v[0], v[3], v[2], v[1]};
                    if (kind == 0) add_quad(&s, down, rgb_gray(1));
                    if (kind == 1) add_triangle(&s, down[0], down[1], down[2], rgb_gray(1));
                    if (kind == 2) add_disk(&s, lamp, v3(0.3f * k, 0, 0), v3(0, -0.3f * k, 0), rgb_gray(1));
                    square(v, o, 2 * k); // floor
                    add_wall(&s, v);
                    square(v, v3_add(o, v3(0, 0, 3 * k)), 2 * k); // ceiling
                    add_wall(&s, v);
                    Traced t = trace_begin(s);
                    int n = count_occluded(&t, o, 1.9f * k);
                    if (side == 0)
                        assert_int_equal(n, 0);
                    else
                        assert_true(n > N_RAYS / 2); // all that were sampled
                    trace_end(&t);
                }
}

// A lamp of a metre at the origin, seen from kilometres away: its own coordinates are small, the ray's rounding is not.
static void test_far_lamp(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; ++kind) {
        LightScene s = light_scene_begin();
        Vec3 v[4], n = v3_normalize(v3(0.3f, 0.5f, -1)), t = v3_normalize(v3_cross(n, v3(0, 1, 0))), b = v3_cross(n, t);
        for (int i = 0; i < 4; ++i)
            v[i] = v3_mad(v3_scale(t, i == 1 || i == 2 ? 0.5f : -0.5f), i >= 2 ? 0.5f : -0.5f, b);
        if (kind == 0) add_quad(&s, v, rgb_gray(1));
        if (kind == 1) add_triangle(&s, v[0], v[1], v[2], rgb_gray(1));
        if (kind == 2) add_disk(&s, v3(0, 0, 0), v3_scale(t, 0.5f), v3_scale(b, 0.5f), rgb_gray(1));
        Traced traced = trace_begin(s);
        assert_int_equal(count_occluded(&traced, v3(123, 456, -9000), 2000), 0);
        trace_end(&traced);
    }
}

static void test_sphere(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    Vec3 v[4];
    add_sphere(&s, v3(1, 2, 3), 0.5f, false, rgb_gray(1));
    square(v, v3(1, 2, 0), 2);
    add_wall(&s, v);
    Traced t = trace_begin(s);
    assert_int_equal(count_occluded(&t, v3(1, 2, 0), 1.9f), 0);
    trace_end(&t);
}

// What a shadow ray reaches, a ray without end in the same direction hits, with the same density.
static void test_the_ray_beyond_hits_the_light(void **state)
{
    (void)state;
    Vec3 v[4];
    square(v, v3(0, 0, 3), 0.5f);
    Vec3 down[4] = {v[0], v[3], v[2], v[1]};
    for (int kind = 0; kind < 4; ++kind) {
        LightScene s = light_scene_begin();
        if (kind == 0) add_quad(&s, down, rgb_gray(2));
        if (kind == 1) add_sphere(&s, v3(0, 0, 3), 0.5f, false, rgb_gray(2));
        if (kind == 2) add_disk(&s, v3(0, 0, 3), v3(0.5f, 0, 0), v3(0, -0.3f, 0), rgb_gray(2));
        if (kind == 3) add_box(&s, v3(-0.5f, -0.5f, 3), v3(0.5f, 0.5f, 4), rgb_gray(2));
        Traced t = trace_begin(s);
        assert_int_equal(sheen_lights_of_shape(t.lights.lights, 0), 0);
        Random r = {1, 0};
        int n = 0, n_hit = 0;
        for (int i = 0; i < N_RAYS; ++i) {
            Vec3 p = v3(random_in(&r, -2, 2), random_in(&r, -2, 2), 0);
            LightSample sample;
            if (!sheen_light_sample(t.lights.lights, 0, p, random_2d(&r), &sample)) continue;
            ++n;
            Ray ray = {p, INFINITY, sample.wi};
            Hit hit;
            sheen_accel_intersect(t.accel, &ray, &hit);
            if (hit.shape == SHEEN_NONE) continue;
            SurfacePoint q;
            sheen_surface_from_hit(t.lights.scene, &ray, &hit, &q);
            Rgb l = sheen_emitted(t.lights.scene, &q, v3_neg(sample.wi));
            float pdf = sheen_light_pdf_hit(t.lights.lights, 0, p, &q);
            if (l.g != 2 || fabsf(pdf / sample.pdf - 1) > 1e-3f) continue;
            assert_true(fabsf(sample.radiance.g * sample.pdf - l.g) < 1e-5f);
            assert_true(rgb_is_black(sheen_emitted(t.lights.scene, &q, sample.wi))); // nothing from behind
            ++n_hit;
        }
        // All but a few in a thousand, whose rays pass the rim or meet the neighbour triangle in rounding.
        assert_true(n > N_RAYS / 4 && n_hit > n - n / 200);
        trace_end(&t);
    }
}

static void test_infinite_and_point_lights(void **state)
{
    (void)state;
    SheenLight lights[] = {
        {.kind = SHEEN_LIGHT_DIRECTIONAL, .radiance = rgb_gray(1), .direction = v3(0.6f, 0, -0.8f)},
        {.kind = SHEEN_LIGHT_POINT, .radiance = rgb_gray(1), .position = v3(0, 0, 1)},
    };
    for (int kind = 0; kind < 2; ++kind)
        for (int roof = 0; roof < 2; ++roof) {
            LightScene s = light_scene_begin();
            Vec3 v[4];
            square(v, v3(0, 0, 0), 5);
            add_wall(&s, v);
            // Over the point light it casts no shadow, in the sun it does.
            square(v, v3(0, 0, 2), 5);
            if (roof) add_wall(&s, v);
            sheen_builder_add_light(s.builder, &lights[kind]);
            Traced t = trace_begin(s);
            int n = count_occluded(&t, v3(0, 0, 0), 1);
            assert_int_equal(n, kind == 0 && roof ? N_RAYS : 0);
            trace_end(&t);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lamp_at_a_wall),
        cmocka_unit_test(test_far_lamp),
        cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_the_ray_beyond_hits_the_light),
        cmocka_unit_test(test_infinite_and_point_lights),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
