// SPDX-License-Identifier: Apache-2.0
// Adaptive caching of a room: when a fill is done, no point tells records apart and none is without one.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "analytic/glossy_kit.h"

#include "integrator/adapt.h"
#include "integrator/cached.h"
#include "integrator/fill.h"
#include "integrator/first_points.h"

enum { SIDE = 96 };

/** A room with caches that were filled for its camera. */
typedef struct Filled {
    Stage stage;
    SheenLights *lights;
    SheenAccel *accel;
    SheenWork work;
    SheenView view;
    SheenGlossyCache *glossy; // like that of the caches
    SheenCached *cached;
    SheenStats stats;
} Filled;

static void fill_room(Thing thing, bool adaptive, Filled *f)
{
    *f = (Filled){.stage = room(thing, &phong)};
    assert_int_equal(sheen_lights_create(f->stage.scene, SHEEN_ENVIRONMENT_HARD, &kit_log_sink, &f->lights), SHEEN_OK);
    assert_int_equal(sheen_accel_create(f->stage.scene, f->stage.pool, &kit_log_sink, &f->accel), SHEEN_OK);
    SheenOptions o = small(2).options;
    o.adaptive = adaptive;
    const SheenWork work = {.scene = f->stage.scene,
                            .accel = f->accel,
                            .lights = f->lights,
                            .options = o,
                            .pool = f->stage.pool,
                            .log = &kit_log_sink};
    f->view = (SheenView){&f->stage.scene->cameras[0], SIDE, SIDE, NULL};
    assert_int_equal(sheen_cached_create(&work, true, &f->stats, &f->cached), SHEEN_OK);
    assert_int_equal(sheen_cached_look(f->cached, &f->view, &f->stats), SHEEN_OK);
    assert_int_equal(sheen_cached_fill(f->cached, &f->view, &f->stats), SHEEN_OK);
    f->work = sheen_work_for(&work, &f->view);
    assert_int_equal(sheen_glossy_cache_create(&work, &f->glossy), SHEEN_OK);
    f->work.glossy = f->glossy;
}

static void filled_free(Filled *f)
{
    sheen_cached_destroy(&f->cached);
    sheen_glossy_cache_destroy(&f->glossy);
    sheen_accel_destroy(&f->accel);
    sheen_lights_destroy(&f->lights);
    stage_free(&f->stage);
}

static uint32_t count_refined(const SheenRecordStore *store, float accuracy)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < store->n; ++i) n += store->records[i].a < accuracy;
    return n;
}

// Whether a further pass would change nothing.
static void assert_converged(const SheenWork *work, const SheenAdaptView *view, const AdaptCache *cache)
{
    const SheenRecordStore *store = adapt_store(cache);
    float *before = malloc((store->n + 1) * sizeof *before);
    assert_non_null(before);
    for (uint32_t i = 0; i < store->n; ++i) before[i] = store->records[i].a;
    assert_int_equal(sheen_adapt_pass(work, view, NULL, cache), SHEEN_OK);
    for (uint32_t i = 0; i < store->n; ++i) assert_true(store->records[i].a == before[i]);
    free(before);
}

static void test_converged(void **state)
{
    (void)state;
    Filled f;
    fill_room(BOARD, true, &f);
    SheenCaches *caches = sheen_cached_caches(f.cached);
    uint32_t fine = count_refined(caches->irradiance->store, f.work.options.accuracy);
    assert_true(fine > 0 && fine < caches->irradiance->store->n);
    SeenPoints seen = {0};
    bool open = true;
    assert_int_equal(sheen_first_points(&f.work, NULL, &f.stats, &seen), SHEEN_OK);
    assert_int_equal(sheen_fill_is_open(&f.work, caches->irradiance->store, seen.points, seen.n_points, &open),
                     SHEEN_OK);
    assert_false(open);
    SheenAdaptView view;
    assert_int_equal(sheen_adapt_look(&f.work, &f.stats, &view), SHEEN_OK);
    assert_true(view.seen.n_points > SIDE * SIDE / 8 && view.seen.n_glossy > 0);
    assert_converged(&f.work, &view, &(AdaptCache){.irradiance = caches->irradiance});
    uint32_t glossy = 0;
    for (int b = 0; b < SHEEN_BASIS_COUNT; ++b) {
        assert_converged(&f.work, &view, &(AdaptCache){.radiance = caches->radiance[b]});
        glossy += count_refined(caches->radiance[b]->store, f.work.options.accuracy);
    }
    show("refined: %u of irradiance, %u of radiance\n", fine, glossy);
    assert_true(glossy > 0);
    sheen_adapt_free(&view);
    sheen_seen_free(&seen);
    filled_free(&f);
}

static void test_switched_off(void **state)
{
    (void)state;
    Filled f;
    fill_room(BOARD, false, &f);
    SheenCaches *caches = sheen_cached_caches(f.cached);
    assert_int_equal(count_refined(caches->irradiance->store, f.work.options.accuracy), 0);
    for (int b = 0; b < SHEEN_BASIS_COUNT; ++b)
        assert_int_equal(count_refined(caches->radiance[b]->store, f.work.options.accuracy), 0);
    filled_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_converged),
        cmocka_unit_test(test_switched_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
