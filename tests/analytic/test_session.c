// SPDX-License-Identifier: Apache-2.0
// Sessions: records that outlive a picture, read from several views.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "analytic/glossy_kit.h"

#include <string.h>

/** A room seen from two places. */
typedef struct Walk {
    Stage stage;
    SheenCamera there;
    SheenShot shots[2];
    SheenSession *session;
    SheenStats stats;
} Walk;

static SheenSession *session_of(const Stage *stage, const SheenRenderSettings *s, SheenStats *stats)
{
    SheenSessionDesc desc = {.scene = stage->scene,
                             .integrator = s->integrator,
                             .options = s->options,
                             .pool = stage->pool,
                             .log = &kit_log_sink};
    SheenSession *session = NULL;
    double build;
    assert_int_equal(sheen_session_create(&desc, stats, &build, &session), SHEEN_OK);
    return session;
}

// Two views that overlap, of small pictures with few samples, so that many points lie between the first ones.
static void walk_begin(const Stage *stage, Walk *w)
{
    *w = (Walk){.stage = *stage};
    SheenRenderSettings s = small(3);
    w->session = session_of(stage, &s, &w->stats);
    w->there = stage->scene->cameras[0];
    w->there.to_world = transform_mul(transform_translate(0.1, 0.05, -0.1), w->there.to_world);
    for (int i = 0; i < 2; ++i) w->shots[i] = (SheenShot){.width = 24, .height = 24};
    w->shots[0].camera = &stage->scene->cameras[0];
    w->shots[1].camera = &w->there;
}

static void walk_end(Walk *w)
{
    sheen_session_destroy(&w->session);
    stage_free(&w->stage);
}

static void look(Walk *w, int shot)
{
    assert_int_equal(sheen_session_look(w->session, &w->shots[shot], &w->stats), SHEEN_OK);
}

// @return how many records were added
static uint32_t fill(Walk *w, int shot)
{
    RecordCounts before = sheen_caches_counts(sheen_session_caches(w->session));
    assert_int_equal(sheen_session_fill(w->session, &w->shots[shot], &w->stats), SHEEN_OK);
    RecordCounts after = sheen_caches_counts(sheen_session_caches(w->session));
    return (uint32_t)(record_counts_all(&after) - record_counts_all(&before));
}

static void settle(Walk *w)
{
    assert_int_equal(sheen_session_settle(w->session, &w->stats), SHEEN_OK);
}

static SheenFilm *shade(Walk *w, int shot)
{
    SheenFilm *film = NULL;
    assert_int_equal(sheen_session_shade(w->session, &w->shots[shot], 0, &film, &w->stats), SHEEN_OK);
    return film;
}

static void assert_same_bits(const SheenFilm *a, const SheenFilm *b)
{
    assert_memory_equal(a->color, b->color, (size_t)a->width * a->height * sizeof *a->color);
}

// Each picture is a function of the settled records and its view, whatever was shaded before; and what was filled
// stays covered, so that nothing is added for it again.
static void check_views(Thing thing)
{
    Stage stage = room(thing, &phong);
    Walk w;
    walk_begin(&stage, &w);
    look(&w, 0);
    look(&w, 1);
    uint32_t first = fill(&w, 0), second = fill(&w, 1);
    show("%s: %u records, the second view %u more\n", thing_name[thing], first, second);
    assert_true(first > 0 && second > 0 && second < first);
    settle(&w);
    SheenFilm *here = shade(&w, 0), *there = shade(&w, 1), *again = shade(&w, 0);
    assert_same_bits(here, again);
    assert_true(memcmp(here->color, there->color, 24 * 24 * sizeof *here->color) != 0);
    assert_int_equal(fill(&w, 0), 0);
    assert_int_equal(fill(&w, 1), 0);
    settle(&w); // learns nothing twice
    SheenFilm *settled = shade(&w, 0);
    assert_same_bits(here, settled);
    sheen_film_destroy(&here);
    sheen_film_destroy(&there);
    sheen_film_destroy(&again);
    sheen_film_destroy(&settled);
    walk_end(&w);
}

static void test_views_of_a_board(void **state)
{
    (void)state;
    check_views(BOARD);
}

static void test_views_of_a_ball(void **state)
{
    (void)state;
    check_views(BALL);
}

// Records of one view serve another: a picture from records of another place alone agrees with one from its own. The
// bound: both are within 2 % of paths (test_radiance_integrator).
static void test_records_of_another_view(void **state)
{
    (void)state;
    Stage stage = room(BOARD, &phong);
    Walk w;
    walk_begin(&stage, &w);
    look(&w, 0);
    fill(&w, 0);
    settle(&w);
    SheenFilm *borrowed = shade(&w, 1);
    fill(&w, 1);
    settle(&w);
    SheenFilm *own = shade(&w, 1);
    double off = film_mean(borrowed) / film_mean(own) - 1.0;
    show("from another view's records: mean off by %.2g\n", off);
    assert_true(fabs(off) < 0.02);
    sheen_film_destroy(&borrowed);
    sheen_film_destroy(&own);
    walk_end(&w);
}

// A picture of a session is the picture that sheen_render gives.
static void test_one_view(void **state)
{
    (void)state;
    Stage stage = room(BALL, &phong);
    SheenRenderSettings s = small(3);
    s.width = s.height = 24;
    SheenFilm *alone = stage_render(&stage, &s, NULL);
    Walk w;
    walk_begin(&stage, &w);
    look(&w, 0);
    fill(&w, 0);
    settle(&w);
    SheenFilm *film = shade(&w, 0);
    assert_same_bits(alone, film);
    sheen_film_destroy(&alone);
    sheen_film_destroy(&film);
    walk_end(&w);
}

// The path integrator keeps nothing.
static void test_paths(void **state)
{
    (void)state;
    Stage stage = room(BOARD, &phong);
    SheenRenderSettings s = small(2);
    s.integrator = SHEEN_INTEGRATOR_PATH;
    SheenStats stats = {0};
    SheenSession *session = session_of(&stage, &s, &stats);
    SheenShot shot = {.camera = &stage.scene->cameras[0], .width = 16, .height = 16};
    assert_null(sheen_session_caches(session));
    assert_int_equal(sheen_session_look(session, &shot, &stats), SHEEN_OK);
    assert_int_equal(sheen_session_fill(session, &shot, &stats), SHEEN_OK);
    assert_int_equal(sheen_session_settle(session, &stats), SHEEN_OK);
    SheenFilm *film = NULL, *alone = stage_render(&stage, &s, NULL);
    assert_int_equal(sheen_session_shade(session, &shot, 0, &film, &stats), SHEEN_OK);
    assert_same_bits(alone, film);
    sheen_film_destroy(&film);
    sheen_film_destroy(&alone);
    sheen_session_destroy(&session);
    stage_free(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_views_of_a_board),
        cmocka_unit_test(test_views_of_a_ball),
        cmocka_unit_test(test_records_of_another_view),
        cmocka_unit_test(test_one_view),
        cmocka_unit_test(test_paths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
