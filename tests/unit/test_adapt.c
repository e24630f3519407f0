// SPDX-License-Identifier: Apache-2.0
// The metric of adaptive caching, and what refinement makes of records.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "integrator/adapt.h"
#include "integrator/record_radius.h"

static AdaptShare share(uint32_t record, float weight, float Y)
{
    return (AdaptShare){.record = record, .weight = weight, .Y = Y};
}

static void test_alike_stay(void **state)
{
    (void)state;
    AdaptShare s[3] = {share(0, 10, 1.0f), share(1, 7, 1.01f), share(2, 6, 0.99f)};
    assert_int_equal(sheen_adapt_tell(0.02f, 0.0f, 3, s), 3);
    assert_int_equal(sheen_adapt_tell(0.02f, 0.0f, 1, s), 1);
    assert_int_equal(sheen_adapt_tell(0.02f, 0.0f, 0, s), 0);
}

// Records of 1 and 1.2 with weights 10 and 5: the mean is 1.0667. It differs by 6.25 % from the first alone, by 12.5 %
// from the second: both are told up to a fraction of .0625, and the lighter one goes. So it is for thresholds below
// and above, wherever the threshold comes from.
static void test_the_lightest_that_is_told_goes(void **state)
{
    (void)state;
    const struct {
        float discernible, direct, sigma;
        unsigned stay;
    } cases[] = {
        {0.060f, 0, 0, 1},    {0.066f, 0, 0, 1},   // there the heavier one is told alone
        {0.130f, 0, 0, 2},    {0.02f, 5.0f, 0, 1}, // .02 (1.0667 + 5) = .121 < .1333, the heavier one again
        {0.02f, 5.7f, 0, 2},                       // .1353
        {0.02f, 0, 0.2f, 2},                       // sigma of the mean .149, of the first alone .2
        {0.02f, 0, 0.01f, 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        AdaptShare s[2] = {share(0, 10, 1.0f), share(1, 5, 1.2f)};
        s[0].sigma = s[1].sigma = cases[i].sigma;
        unsigned stay = sheen_adapt_tell(cases[i].discernible, cases[i].direct, 2, s);
        assert_int_equal(stay, cases[i].stay);
        if (i == 0 || i == 6) assert_int_equal(s[1].record, 1);
        if (i == 1 || i == 3) assert_int_equal(s[1].record, 0);
    }
}

static void test_fixed_records_stay(void **state)
{
    (void)state;
    AdaptShare s[2] = {share(0, 10, 1.0f), share(1, 5, 2.0f)};
    s[1].fixed = true;
    assert_int_equal(sheen_adapt_tell(0.02f, 0.0f, 2, s), 1); // the other goes
    assert_int_equal(s[1].record, 0);
    AdaptShare both[2] = {share(0, 10, 1.0f), share(1, 5, 2.0f)};
    both[0].fixed = both[1].fixed = true;
    assert_int_equal(sheen_adapt_tell(0.02f, 0.0f, 2, both), 2);
}

// Two dark records far away beside two bright ones: both dark ones go, the lighter first.
static void test_one_after_another(void **state)
{
    (void)state;
    AdaptShare s[4] = {share(0, 5.1f, 0.5f), share(1, 20, 1.0f), share(2, 18, 1.0f), share(3, 5.2f, 0.5f)};
    assert_int_equal(sheen_adapt_tell(0.02f, 0.0f, 4, s), 2);
    assert_int_equal(s[3].record, 0);
    assert_int_equal(s[2].record, 3);
}

// The least reach stays where it is, others shrink with a; what is not finer changes nothing.
static void test_refined_records(void **state)
{
    (void)state;
    const Bounds bounds = {{-1, -1, -1}, {1, 1, 1}};
    SheenRecordStore *s;
    assert_int_equal(sheen_store_create(0.2f, true, &bounds, &s), SHEEN_OK);
    for (int i = 0; i < 3; ++i) {
        Record r = {
            .p = v3(0.5f * (float)i - 0.5f, 0, 0), .n = v3(0, 0, 1), .R = 2, .a = 0.2f, .R_min = 0.5f, .R_sure = 2};
        assert_int_equal(sheen_store_append(s, &r), SHEEN_OK);
    }
    const float a[3] = {0.1f, INFINITY, 0.3f};
    sheen_store_refine(s, a);
    assert_true(s->records[0].a == 0.1f && s->records[0].R == 2.0f && s->records[0].R_min == 1.0f);
    for (int i = 1; i < 3; ++i) assert_true(s->records[i].a == 0.2f && s->records[i].R_min == 0.5f);
    assert_int_equal(sheen_store_reindex(s), SHEEN_OK);
    // Along the plane records reach a R: .2 and .4.
    Contributors c;
    sheen_store_find(s, v3(-0.71f, 0, 0), v3(0, 0, 1), &c);
    assert_int_equal(c.n, 0);
    sheen_store_find(s, v3(-0.69f, 0, 0), v3(0, 0, 1), &c);
    assert_int_equal(c.n, 1);
    sheen_store_find(s, v3(0.89f, 0, 0), v3(0, 0, 1), &c);
    assert_int_equal(c.n, 1);
    // What a new record there may be expected to be like: as accurate as the nearest.
    assert_true(sheen_store_expect(s, v3(-0.45f, 0, 0)).a == 0.1f);
    assert_true(sheen_store_expect(s, v3(0.05f, 0, 0)).a == 0.2f);
    sheen_store_destroy(&s);
}

/** Two records of irradiance 1 and 2 on a plane, both of which serve a point between them. */
typedef struct Pair {
    SheenIrradianceCache *cache;
    SheenPool *pool;
    SheenWork work;
    ShadingPoint point;
    float direct;
    SheenAdaptView view;
} Pair;

static void pair_begin(float direct, Pair *p)
{
    const Bounds bounds = {{-1, -1, -1}, {1, 1, 1}};
    const Vec3 n = v3(0, 0, 1);
    *p = (Pair){.direct = direct, .work.options = sheen_options_default()};
    assert_int_equal(sheen_pool_create(1, &p->pool), SHEEN_OK);
    p->work.pool = p->pool;
    assert_int_equal(sheen_irradiance_cache_create(0.2f, true, &bounds, &p->cache), SHEEN_OK);
    for (int i = 0; i < 2; ++i) {
        Record r = {.p = v3(0.3f * (float)i, 0, 0), .n = n, .R = 2, .a = 0.2f, .R_min = 0.01f, .R_sure = 2};
        IrradianceLight light = {.E = rgb_gray(1.0f + (float)i)};
        assert_int_equal(sheen_irradiance_cache_append(p->cache, &r, &light), SHEEN_OK);
    }
    p->point = (ShadingPoint){.point = {.p = v3(0.1f, 0, 0), .ng = n, .n = n, .bent = n, .reflectance = rgb_gray(1.0f)},
                              .throughput = rgb_gray(1.0f),
                              .footprint = 0.01f};
    p->view = (SheenAdaptView){.seen = {.points = &p->point, .n_points = 1}, .direct = &p->direct};
}

// @return records that serve the point after a pass
static unsigned pair_pass(Pair *p, SheenOctree *const touched[2], Contributors *c)
{
    assert_int_equal(sheen_adapt_pass(&p->work, &p->view, touched, &(AdaptCache){.irradiance = p->cache}), SHEEN_OK);
    assert_int_equal(sheen_store_reindex(p->cache->store), SHEEN_OK);
    sheen_store_find(p->cache->store, p->point.point.p, p->point.point.n, c);
    return c->n;
}

static void pair_end(Pair *p)
{
    sheen_irradiance_cache_destroy(&p->cache);
    sheen_pool_destroy(&p->pool);
}

// The farther record is left out at the point, and just there: its a is hardly less than its distance over R, 0.2 / 2.
static void test_a_pass_leaves_out(void **state)
{
    (void)state;
    Pair p;
    Contributors c;
    pair_begin(0.0f, &p);
    assert_int_equal(pair_pass(&p, NULL, &c), 1);
    assert_int_equal(c.record[0], 0);
    float a = p.cache->store->records[1].a;
    assert_true(a < 0.1f && a > 0.0999f);
    assert_true(p.cache->store->records[0].a == 0.2f);
    pair_end(&p);
}

// Before bright direct light the difference is not told; where nothing was touched it is not looked for.
static void test_a_pass_leaves_alone(void **state)
{
    (void)state;
    const Bounds bounds = {{-1, -1, -1}, {1, 1, 1}};
    Pair p;
    Contributors c;
    pair_begin(1e3f, &p);
    assert_int_equal(pair_pass(&p, NULL, &c), 2);
    pair_end(&p);
    pair_begin(0.0f, &p);
    SheenOctree *touched[2];
    for (int i = 0; i < 2; ++i) assert_int_equal(sheen_octree_create(&bounds, &touched[i]), SHEEN_OK);
    assert_int_equal(sheen_octree_insert(touched[0], v3(0.5f, 0, 0), 0.39f, 0), SHEEN_OK);
    assert_int_equal(pair_pass(&p, touched, &c), 2);
    assert_int_equal(sheen_octree_insert(touched[1], v3(0.5f, 0, 0), 0.41f, 0), SHEEN_OK);
    assert_int_equal(pair_pass(&p, touched, &c), 1);
    for (int i = 0; i < 2; ++i) sheen_octree_destroy(&touched[i]);
    pair_end(&p);
}

static void test_accuracies(void **state)
{
    (void)state;
    SheenOptions o = sheen_options_default();
    o.accuracy = 0.2f;
    assert_true(record_first_accuracy(&o, 0.0f) == 0.2f);
    assert_true(record_first_accuracy(&o, 0.1f) == 1.4f * 0.1f);
    assert_true(record_first_accuracy(&o, 0.19f) == 0.2f);
    Record r = {.R = 2, .a = 0.2f, .R_min = 0.1f};
    assert_true(record_least_accuracy(&o, &r) == 0.05f);
    r.R_min = 1.0f; // its reach may become half of what it is
    assert_true(record_least_accuracy(&o, &r) == 0.1f);
    o.adaptive = false;
    assert_true(record_first_accuracy(&o, 0.1f) == 0.2f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_pass_leaves_out),  cmocka_unit_test(test_a_pass_leaves_alone),
        cmocka_unit_test(test_alike_stay),         cmocka_unit_test(test_the_lightest_that_is_told_goes),
        cmocka_unit_test(test_fixed_records_stay), cmocka_unit_test(test_one_after_another),
        cmocka_unit_test(test_refined_records),    cmocka_unit_test(test_accuracies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
