// SPDX-License-Identifier: Apache-2.0
// Concave surfaces, coincident ones, small strong sources of indirect light, and sizes that differ by a million.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "analytic/robust_kit.h"

static uint32_t two_sided(SheenBuilder *b, uint32_t material)
{
    SheenMaterial m = *sheen_builder_material(b, material);
    m.two_sided = true;
    m.name = "two-sided";
    return sheen_builder_add_material(b, &m);
}

static void lamp(SheenBuilder *b, Vec3 center, float side, float radiance)
{
    uint32_t s = kit_quad(b, v3_sub(center, v3(0.5f * side, 0.5f * side, 0)), v3(0, side, 0), v3(side, 0, 0),
                          kit_diffuse(b, 0.0f));
    sheen_builder_add_area_light(b, s, rgb_gray(radiance));
}

static void axis_box(SheenBuilder *b, Vec3 lo, Vec3 hi, uint32_t material)
{
    Vec3 d = v3_sub(hi, lo), x = v3(d.x, 0, 0), y = v3(0, d.y, 0), z = v3(0, 0, d.z);
    kit_quad(b, lo, y, x, material);
    kit_quad(b, v3_add(lo, z), x, y, material);
    kit_quad(b, lo, x, z, material);
    kit_quad(b, v3_add(lo, y), z, x, material);
    kit_quad(b, lo, z, y, material);
    kit_quad(b, v3_add(lo, x), y, z, material);
}

// ---- concave surfaces -------------------------------------------------------------------------------------------

/** The inside of a cylinder about z, with smooth normals, from z = 0 to 2. */
static void tube(SheenBuilder *b, float radius, uint32_t sectors, uint32_t material)
{
    SheenArena *arena = sheen_builder_arena(b);
    Vec3 *p = SHEEN_ARENA_NEW(arena, Vec3, 2 * sectors + 1), *n = SHEEN_ARENA_NEW(arena, Vec3, 2 * sectors);
    uint32_t(*t)[3] = sheen_arena_alloc(arena, 2 * sectors, sizeof *t);
    assert_true(p && n && t);
    p[2 * sectors] = v3(0, 0, 0);
    for (uint32_t i = 0; i < sectors; ++i) {
        float phi = 2.0f * SHEEN_PI * (float)i / (float)sectors;
        uint32_t next = (i + 1) % sectors;
        Vec3 d = v3(cosf(phi), sinf(phi), 0);
        p[2 * i] = v3_scale(d, radius);
        p[2 * i + 1] = v3_add(p[2 * i], v3(0, 0, 2));
        n[2 * i] = n[2 * i + 1] = v3_neg(d);
        memcpy(t[2 * i], (uint32_t[3]){2 * i, 2 * i + 1, 2 * next + 1}, sizeof *t);
        memcpy(t[2 * i + 1], (uint32_t[3]){2 * i, 2 * next + 1, 2 * next}, sizeof *t);
    }
    SheenShape s = {.kind = SHEEN_SHAPE_MESH, .material = material, .light = SHEEN_NONE, .name = "tube"};
    s.mesh = (SheenMesh){2 * sectors, 2 * sectors, p, n, NULL, (const uint32_t(*)[3])t, NULL, NULL};
    sheen_builder_add_shape(b, &s);
}

typedef enum Inside { INSIDE_BOX, INSIDE_TUBE, INSIDE_BALL } Inside;

static Stage hollow(Inside inside)
{
    SheenBuilder *b = kit_begin();
    uint32_t paint = kit_diffuse(b, 0.6f);
    if (inside == INSIDE_BALL) {
        kit_sphere(b, v3(0, 0, 1), 1.0f, true, paint);
    } else {
        if (inside == INSIDE_TUBE) tube(b, 1.0f, 64, paint);
        kit_quad(b, v3(-1, -1, 0), v3(2, 0, 0), v3(0, 2, 0), paint);
        kit_quad(b, v3(-1, -1, 2), v3(0, 2, 0), v3(2, 0, 0), paint);
        if (inside == INSIDE_BOX) {
            kit_quad(b, v3(-1, -1, 0), v3(0, 2, 0), v3(0, 0, 2), paint);
            kit_quad(b, v3(1, -1, 0), v3(0, 0, 2), v3(0, 2, 0), paint);
            kit_quad(b, v3(-1, -1, 0), v3(0, 0, 2), v3(2, 0, 0), paint);
            kit_quad(b, v3(-1, 1, 0), v3(2, 0, 0), v3(0, 0, 2), paint);
        }
    }
    lamp(b, v3(0.2f, 0.3f, 1.7f), 0.3f, 20.0f);
    kit_camera(b, v3(0, -0.8f, 1.0f), v3(0, 1, 0.9f), v3(0, 0, 1), 1.4f);
    return stage_end(b, 2);
}

// With 256 paths the means are off by 0.0005 to 0.002 and blocks, rms, by 0.003 to 0.01; the noise of 96 comes on top.
// A tube and a ball of the room's width get 224 and 245 records where the room has 207: a surface that is in front of a
// record by its own bend must not need one of its own.
static void test_concave(void **state)
{
    (void)state;
    uint64_t flat = 0;
    const char *names[] = {"box", "tube", "ball"};
    for (int i = 0; i < 3; ++i) {
        Stage stage = hollow((Inside)i);
        SheenRenderSettings settings = robust_settings(64, 64);
        Robustness r = robust_measure(&stage, &settings, 96, names[i]);
        stage_free(&stage);
        if (i == 0) flat = r.stats.records;
        assert_true(r.stats.records < 2 * flat);
        assert_true(fabs(r.mean) < 0.006 && r.rms < 0.02);
    }
}

// ---- coincident surfaces ----------------------------------------------------------------------------------------

/** A board of two coincident quads, or `apart` metres apart, light and dark, seen from the front and in a mirror. */
static Stage board(float apart, bool pair)
{
    SheenBuilder *b = kit_begin();
    uint32_t paint = kit_diffuse(b, 0.6f), light = two_sided(b, kit_diffuse(b, 0.8f));
    kit_quad(b, v3(-2, -2, 0), v3(4, 0, 0), v3(0, 4, 0), paint);
    kit_quad(b, v3(-2, 2, 0), v3(4, 0, 0), v3(0, 0, 3), kit_mirror(b));
    kit_quad(b, v3(-0.7f, 0, 0.2f), v3(1.4f, 0, 0), v3(0, 0, 1.2f), light);
    if (pair) kit_quad(b, v3(-0.7f, apart, 0.2f), v3(1.4f, 0, 0), v3(0, 0, 1.2f), two_sided(b, kit_diffuse(b, 0.1f)));
    kit_constant_environment(b, rgb_gray(0.3f));
    lamp(b, v3(1.0f, -1.5f, 2.5f), 0.5f, 10.0f);
    kit_camera(b, v3(0.6f, -3.5f, 1.6f), v3(0, 0, 0.7f), v3(0, 0, 1), 1.0f);
    return stage_end(b, 2);
}

// At the same place a ray meets whichever it is found to meet, and a pencil of rays another than a single one: the mean
// is off by 0.009 and the block where the board stands on its shadow by 0.09. A hundredth of a millimetre apart, and
// without the second board, it is 0.001 and 0.015.
static void test_coincident(void **state)
{
    (void)state;
    const float apart[] = {0.0f, 1e-5f, 1e-3f};
    for (int i = 0; i < 4; ++i) {
        Stage stage = board(i < 3 ? apart[i] : 0.0f, i < 3);
        char name[32];
        snprintf(name, sizeof name, i < 3 ? "pair-%g" : "single", i < 3 ? (double)apart[i] : 0.0);
        SheenRenderSettings settings = robust_settings(64, 64);
        Robustness r = robust_measure(&stage, &settings, 96, name);
        stage_free(&stage);
        bool same = i < 3 && apart[i] == 0.0f;
        assert_true(fabs(r.mean) < (same ? 0.02 : 0.004) && r.worst < (same ? 0.2 : 0.04));
    }
}

// ---- small strong sources ---------------------------------------------------------------------------------------

/** Stairs on whose treads the sun shines through slits of a roof. */
static Stage stairs(void)
{
    SheenBuilder *b = kit_begin();
    uint32_t paint = kit_diffuse(b, 0.5f), white = kit_diffuse(b, 0.8f), roof = two_sided(b, paint);
    kit_quad(b, v3(-1.5f, -2, 0), v3(3, 0, 0), v3(0, 3, 0), paint);
    kit_quad(b, v3(-1.5f, 1, 0), v3(3, 0, 0), v3(0, 0, 2), paint);
    kit_quad(b, v3(-1.5f, -2, 0), v3(0, 3, 0), v3(0, 0, 2), paint);
    kit_quad(b, v3(-1.5f, -2, 2), v3(3, 0, 0), v3(0, 1.99f, 0), roof);
    for (int i = 0; i < 5; ++i) {
        float y = 0.2f * (float)i;
        axis_box(b, v3(-0.5f, y, 0.0f), v3(1.0f, 1.0f, 0.16f * (float)(i + 1)), white);
        kit_quad(b, v3(-1.5f, y + 0.03f, 2), v3(3, 0, 0), v3(0, 0.16f, 0), roof);
    }
    SheenLight sun = {.kind = SHEEN_LIGHT_DIRECTIONAL,
                      .radiance = rgb_gray(10.0f),
                      .shape = SHEEN_NONE,
                      .direction = v3(0, 0, -1),
                      .to_world = transform_identity(),
                      .to_light = transform_identity()};
    sheen_builder_add_light(b, &sun);
    kit_camera(b, v3(0.5f, -2.2f, 1.4f), v3(-0.1f, 1, 0.7f), v3(0, 0, 1), 0.9f);
    return stage_end(b, 2);
}

// Strips of sun three centimetres wide, less than a pixel, light the risers behind them. The mean is off by 0.034,
// blocks by 0.08 rms against 1024 paths (0.011 and 0.12 at 256 x 256, by the risers' feet, where light falls off within
// the least reach of a record); 256 have noise of 0.035.
static void test_small_sources(void **state)
{
    (void)state;
    Stage stage = stairs();
    SheenRenderSettings settings = robust_settings(64, 64);
    Robustness r = robust_measure(&stage, &settings, 256, "stairs");
    stage_free(&stage);
    assert_true(fabs(r.mean) < 0.06 && r.rms < 0.13);
}

// ---- scales -----------------------------------------------------------------------------------------------------

/** A box and a ball of `small` metres on a table before the camera in a room `large` metres wide. */
static Stage scales(float small, float large)
{
    SheenBuilder *b = kit_begin();
    uint32_t paint = kit_diffuse(b, 0.6f), white = kit_diffuse(b, 0.8f);
    float h = 0.5f * large;
    kit_quad(b, v3(-h, -h, 0), v3(large, 0, 0), v3(0, large, 0), paint);
    kit_quad(b, v3(-h, -h, large), v3(0, large, 0), v3(large, 0, 0), paint);
    kit_quad(b, v3(-h, -h, 0), v3(0, large, 0), v3(0, 0, large), paint);
    kit_quad(b, v3(h, -h, 0), v3(0, 0, large), v3(0, large, 0), paint);
    kit_quad(b, v3(-h, -h, 0), v3(0, 0, large), v3(large, 0, 0), paint);
    kit_quad(b, v3(-h, h, 0), v3(large, 0, 0), v3(0, 0, large), paint);
    axis_box(b, v3(-small, 0, 0), v3(0, small, small), white);
    kit_sphere(b, v3(0.7f * small, 0.3f * small, 0.5f * small), 0.5f * small, false, kit_diffuse(b, 0.4f));
    lamp(b, v3(0.1f * large, 0, 0.9f * large), 0.3f * large, 10.0f);
    kit_camera(b, v3(0.3f * small, -3.0f * small, 1.5f * small), v3(0, 0, 0.5f * small), v3(0, 0, 1), 0.9f);
    return stage_end(b, 2);
}

/** The reverse: a kilometre of hills seen from a box of centimetres: walls before the camera, all else far. */
static Stage porthole(float small, float large)
{
    SheenBuilder *b = kit_begin();
    uint32_t paint = kit_diffuse(b, 0.6f);
    kit_quad(b, v3(-large, -large, -small), v3(2 * large, 0, 0), v3(0, 2 * large, 0), paint);
    axis_box(b, v3(-0.4f * large, 0.5f * large, -small), v3(0, 0.9f * large, 0.4f * large), paint);
    for (int side = -1; side <= 1; side += 2)
        kit_quad(b, v3((float)side * small, -small, -0.5f * small), side < 0 ? v3(0, 2 * small, 0) : v3(0, 0, small),
                 side < 0 ? v3(0, 0, small) : v3(0, 2 * small, 0), two_sided(b, paint));
    kit_constant_environment(b, rgb_gray(1.0f));
    kit_camera(b, v3(0, -small, 0), v3(0, large, 0.05f * large), v3(0, 0, 1), 1.7f);
    return stage_end(b, 2);
}

// A millimetre before the camera in a room of a kilometre, and walls a centimetre away before hills of a kilometre: off
// in the mean by as much as with sizes that differ by ten, 0.007 (a ball on the floor; most of it is deep light), and
// with no more than two and a half times the records.
static void test_scales(void **state)
{
    (void)state;
    uint64_t records = 0;
    for (int i = 0; i < 4; ++i) {
        Stage stage = i == 0   ? scales(1.0f, 10.0f)
                      : i == 1 ? scales(1e-3f, 1000.0f)
                      : i == 2 ? porthole(1.0f, 10.0f)
                               : porthole(1e-2f, 1000.0f);
        const char *names[] = {"scale-10", "scale-million", "porthole-10", "porthole-million"};
        SheenRenderSettings settings = robust_settings(64, 64);
        Robustness r = robust_measure(&stage, &settings, 96, names[i]);
        stage_free(&stage);
        if (i % 2 == 1) assert_true(r.stats.records < 3 * records);
        records = r.stats.records;
        assert_true(fabs(r.mean) < 0.012 && r.worst < 0.06);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_concave), cmocka_unit_test(test_coincident),
                                       cmocka_unit_test(test_small_sources), cmocka_unit_test(test_scales)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
