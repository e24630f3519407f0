// SPDX-License-Identifier: Apache-2.0
// The radiance integrator in rooms against path tracing, and against the irradiance integrator.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "analytic/glossy_kit.h"

// Bounds: the rooms' means are off by up to 0.9 % (with a mirror before the board 1.5 %: behind it gathers take what is
// glossy for diffuse), of both cached integrators alike; blocks by up to 5.8 %.
static const double MEAN = 0.012, BLOCK = 0.08;

static const char *const gradient_name[] = {"stratified", "analytical", "numerical", "none"};

static void test_things_in_a_room(void **state)
{
    (void)state;
    SheenRenderSettings s = small(2);
    check_both_sides(room, BOARD, &phong, &s, MEAN, BLOCK);
    check_both_sides(room, BALL, &phong, &s, MEAN, BLOCK);
}

// The other gradients; all basis choices above are with the stratified ones.
static void test_gradients(void **state)
{
    (void)state;
    Stage stage = room(BOARD, &phong);
    SheenRenderSettings s = small(2);
    Reference r = reference(&stage, &s, 128);
    for (int g = SHEEN_GRADIENT_ANALYTICAL; g <= SHEEN_GRADIENT_NONE; ++g) {
        s.options.gradients = (SheenGradient)g;
        check(&stage, &s, &r, MEAN, BLOCK, "board", gradient_name[g]);
    }
    sheen_film_destroy(&r.film);
    stage_free(&stage);
}

// The ceiling beside a glossy wall sees itself in it, which is darker than what a Lambertian wall would send, and the
// wall's upper edge shows the ceiling. Gathers, and deep ones, turn along glossy lobes: blocks are off by up to 2.3 %,
// the mean by 0.2 %; where they take the wall for Lambertian by 4.3 % and 0.7 %.
static void test_edge_of_a_glossy_wall(void **state)
{
    (void)state;
    const Gloss gloss = {"wall", SHEEN_MATERIAL_PHONG, 0, 0, 22, 0.1f};
    SheenBuilder *b = kit_begin();
    add_walls(b);
    add_lamp(b, 1.0f);
    add_thing(b, BOARD, add_gloss(b, &gloss));
    kit_camera(b, v3(0.3f, -0.5f, 0), v3(0.3f, 0.9f, 0.9f), v3(0, 0, 1), 0.4f);
    Stage stage = stage_end(b, 2);
    SheenRenderSettings s = small(8);
    s.options.order = 10;
    Reference r = reference(&stage, &s, 256);
    check(&stage, &s, &r, 0.005, 0.035, "edge of a glossy wall", "radiance");
    sheen_film_destroy(&r.film);
    stage_free(&stage);
}

// Both cached integrators, against paths and against each other. Eight bounces: `irradiance` gives what it sees in a
// glossy reflection one more than it should, see docs/irradiance-caching.md.
static void check_both(const Stage *stage, const SheenRenderSettings *s, const Reference *r, double mean,
                       const char *what)
{
    SheenRenderSettings sampled = *s;
    SheenStats stats;
    sampled.integrator = SHEEN_INTEGRATOR_IRRADIANCE;
    SheenFilm *a = stage_render(stage, s, &stats), *b = stage_render(stage, &sampled, NULL);
    assert_true(stats.radiance_records > 0);
    BlockDifference d = film_blocks(a, b);
    double off = film_mean(a) / film_mean(b) - 1.0;
    show("%s: radiance over irradiance: mean off by %.2g, worst block by %.2g\n", what, off, d.worst);
    assert_agrees(a, r, mean, BLOCK, what, "radiance");
    assert_agrees(b, r, mean, BLOCK, what, "irradiance");
    // A block of both has noise of its own: up to 3.8 % was measured.
    assert_true(fabs(off) < 0.01 && d.worst < 0.06);
    sheen_film_destroy(&a);
    sheen_film_destroy(&b);
}

// Where the share lies between 0 and 1, light is neither lost nor doubled.
static void test_shares(void **state)
{
    (void)state;
    Stage stage = room(BOARD, &sharp);
    float share = share_of(&stage, stage.scene->n_shapes - 1, 0.9f);
    assert_true(share > 0.2f && share < 0.8f);
    SheenRenderSettings s = small(8);
    s.options.order = 10;
    s.width = s.height = 24;
    Reference r = reference(&stage, &s, 128);
    check_both(&stage, &s, &r, MEAN, "board, partly cached");
    sheen_film_destroy(&r.film);
    stage_free(&stage);
}

// ---- seen through other things ----------------------------------------------------------------------------------

typedef enum Before { MIRROR, PANE, MASK, BEFORES } Before;

static Stage room_behind(Before before, bool there)
{
    SheenBuilder *b = kit_begin();
    add_walls(b);
    add_light(b, SHEEN_LIGHT_POINT, v3(0.1f, -0.2f, 0.7f), 0.0f);
    add_thing(b, BOARD, add_gloss(b, &phong));
    Vec3 p = v3(-0.9f, -0.4f, -0.9f), x = v3(1.8f, 0, 0), z = v3(0, 0, 1.8f);
    if (before == MIRROR) {
        kit_quad(b, v3(-1, -0.95f, -1), z, x, kit_mirror(b));
        kit_camera(b, v3(0.1f, 0.3f, 0.1f), v3(0, -1, 0), v3(0, 0, 1), 1.0f);
        return stage_end(b, 2);
    }
    if (there && before == PANE) kit_quad(b, p, x, z, kit_material(b, SHEEN_MATERIAL_THIN_DIELECTRIC, 0, 1.0f));
    if (there && before == MASK) {
        SheenMaterial m = {.kind = SHEEN_MATERIAL_MASK,
                           .weight = sheen_texture_constant(rgb_gray(0.3f)),
                           .nested = {kit_diffuse(b, 0.5f), 0},
                           .name = "mask"};
        kit_quad(b, p, x, z, sheen_builder_add_material(b, &m));
    }
    add_camera(b, BOARD);
    return stage_end(b, 2);
}

static void test_seen_through_other_things(void **state)
{
    (void)state;
    static const char *const name[] = {"in a mirror", "behind a pane", "behind a mask"};
    for (Before before = 0; before < BEFORES; ++before) {
        Stage stage = room_behind(before, true);
        SheenRenderSettings s = small(8);
        s.width = s.height = 24;
        Reference r = reference(&stage, &s, 64);
        check_both(&stage, &s, &r, before == MIRROR ? 0.02 : MEAN, name[before]);
        sheen_film_destroy(&r.film);
        stage_free(&stage);
    }
}

// ---- nothing to cache -------------------------------------------------------------------------------------------

static bool same_picture(const SheenFilm *a, const SheenFilm *b)
{
    return memcmp(a->color, b->color, (size_t)a->width * a->height * sizeof *a->color) == 0;
}

// Without a lobe that harmonics can hold the pictures of both cached integrators are the same, to the last bit.
static void test_nothing_to_cache(void **state)
{
    (void)state;
    Stage stage = room(BALL, &narrow);
    for (uint32_t bounces = 0; bounces <= 2; bounces += 2) {
        SheenRenderSettings s = small(bounces);
        SheenStats stats;
        SheenFilm *a = stage_render(&stage, &s, &stats);
        assert_int_equal(stats.radiance_records, 0);
        s.integrator = SHEEN_INTEGRATOR_IRRADIANCE;
        SheenFilm *b = stage_render(&stage, &s, NULL);
        assert_true(same_picture(a, b));
        sheen_film_destroy(&a);
        sheen_film_destroy(&b);
    }
    stage_free(&stage);
}

// A room of nothing but rough metal: no point is diffuse to the camera, and light that a gather finds was reflected by
// metal too. Paths of 128 samples leave 0.3 % of noise; from the second bounce on metal counts as diffuse.
static void test_no_diffuse_surface(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    uint32_t m = add_gloss(b, &metal);
    kit_box(b, m, 0.0f);
    add_lamp(b, 1.0f);
    add_camera(b, BOARD);
    Stage stage = stage_end(b, 2);
    double mean = 0.0;
    for (uint32_t bounces = 0; bounces <= 8; bounces += bounces < 1 ? 1 : 7) {
        SheenRenderSettings s = small(bounces);
        SheenStats stats;
        SheenFilm *film = stage_render(&stage, &s, &stats);
        assert_true(bounces == 0 || stats.radiance_records > 0);
        assert_true(film_mean(film) > 1.1 * mean);
        mean = film_mean(film);
        Reference r = reference(&stage, &s, 128);
        show("%u bounces: %g, paths %g\n", bounces, mean, film_mean(r.film));
        assert_true(fabs(mean / film_mean(r.film) - 1.0) < 0.015);
        sheen_film_destroy(&film);
        sheen_film_destroy(&r.film);
    }
    stage_free(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_things_in_a_room),
        cmocka_unit_test(test_edge_of_a_glossy_wall),
        cmocka_unit_test(test_gradients),
        cmocka_unit_test(test_shares),
        cmocka_unit_test(test_seen_through_other_things),
        cmocka_unit_test(test_nothing_to_cache),
        cmocka_unit_test(test_no_diffuse_surface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
