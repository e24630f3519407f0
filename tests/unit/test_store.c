// SPDX-License-Identifier: Apache-2.0
// The store of records: those with final radii, and the octree built anew from them.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/hash.h"
#include "cache/store.h"

#include <string.h>

enum { N = 1500, POINTS = 2000 };
static const Bounds box = {{-1.0f, -1.0f, -1.0f}, {1.0f, 1.0f, 1.0f}};

static float random_unit(uint32_t i, uint32_t use)
{
    return hash_to_unit(hash_combine(i, use));
}
static Vec3 random_point(uint32_t i)
{
    return v3(2.0f * random_unit(i, 0) - 1.0f, 2.0f * random_unit(i, 1) - 1.0f, 0.01f * random_unit(i, 2));
}
static Vec3 random_normal(uint32_t i)
{
    return v3_normalize(v3(0.2f * random_unit(i, 3) - 0.1f, 0.2f * random_unit(i, 4) - 0.1f, 1.0f));
}

static SheenRecordStore *store_begin(void)
{
    SheenRecordStore *s = NULL;
    assert_int_equal(sheen_store_create(0.15f, true, &box, &s), SHEEN_OK);
    return s;
}

// Records of many sizes on a floor, which clamp each other.
static SheenRecordStore *store_of_clamped(void)
{
    SheenRecordStore *s = store_begin();
    for (uint32_t i = 0; i < N; ++i) {
        float R = 0.2f * expf(3.0f * random_unit(i, 5));
        Record r = {.p = random_point(i),
                    .n = random_normal(i),
                    .R = R,
                    .a = 0.2f,
                    .R_min = R * random_unit(i, 6),
                    .R_sure = R};
        assert_int_equal(sheen_store_insert(s, &r), SHEEN_OK);
    }
    return s;
}

static SheenRecordStore *store_of_appended(const SheenRecordStore *from)
{
    SheenRecordStore *s = store_begin();
    for (uint32_t i = 0; i < from->n; ++i) assert_int_equal(sheen_store_append(s, &from->records[i]), SHEEN_OK);
    return s;
}

// At how many of many points two stores do not give the same bits, in the same order.
static unsigned differences(const SheenRecordStore *a, const SheenRecordStore *b, unsigned *met)
{
    unsigned n = 0;
    *met = 0;
    for (uint32_t i = 0; i < POINTS; ++i) {
        Vec3 p = random_point(i + N), normal = random_normal(i + N);
        Contributors x, y;
        sheen_store_find(a, p, normal, &x);
        sheen_store_find(b, p, normal, &y);
        bool same = x.n == y.n && x.cover == y.cover && memcmp(&x.weight_sum, &y.weight_sum, sizeof x.weight_sum) == 0;
        for (unsigned k = 0; k < x.n && same; ++k)
            same = x.record[k] == y.record[k] && memcmp(&x.weight[k], &y.weight[k], sizeof x.weight[k]) == 0;
        n += !same;
        *met += x.n;
    }
    return n;
}

static void test_appended_records_keep_their_radii(void **state)
{
    (void)state;
    SheenRecordStore *clamped = store_of_clamped(), *copy = store_of_appended(clamped);
    assert_int_equal(copy->n, N);
    assert_memory_equal(copy->records, clamped->records, N * sizeof *copy->records);
    // A small one beside them, which would shrink its neighbors if it were inserted.
    Record small = {
        .p = clamped->records[0].p, .n = v3(0, 0, 1), .R = 1e-3f, .a = 0.2f, .R_min = 0.0f, .R_sure = 1e-3f};
    assert_int_equal(sheen_store_append(copy, &small), SHEEN_OK);
    assert_memory_equal(copy->records, clamped->records, N * sizeof *copy->records);
    assert_int_equal(sheen_store_insert(clamped, &small), SHEEN_OK);
    assert_memory_not_equal(copy->records, clamped->records, N * sizeof *copy->records);
    sheen_store_destroy(&clamped);
    sheen_store_destroy(&copy);
}

// What a look-up meets, and in which order, depends on the radii that records had when they were inserted; after a
// reindex on the records alone.
static void test_reindexed_is_as_appended(void **state)
{
    (void)state;
    SheenRecordStore *s = store_of_clamped(), *copy = store_of_appended(s);
    unsigned met;
    // At some points only: it takes two records there whose nodes' levels changed order.
    assert_true(differences(s, copy, &met) > 5);
    assert_true(met > POINTS); // the comparison is about something
    uint64_t before = sheen_store_bytes(s);
    assert_int_equal(sheen_store_reindex(s), SHEEN_OK);
    assert_int_equal(differences(s, copy, &met), 0);
    assert_int_equal(sheen_store_bytes(s), sheen_store_bytes(copy));
    assert_true(sheen_store_bytes(s) != before);
    // Insertion goes on, with clamping, as in the copy.
    for (uint32_t i = 0; i < 100; ++i) {
        Record r = {
            .p = random_point(i + 2 * N), .n = random_normal(i), .R = 0.3f, .a = 0.2f, .R_min = 0.01f, .R_sure = 0.3f};
        assert_int_equal(sheen_store_insert(s, &r), SHEEN_OK);
        assert_int_equal(sheen_store_insert(copy, &r), SHEEN_OK);
    }
    assert_memory_equal(s->records, copy->records, s->n * sizeof *s->records);
    assert_int_equal(differences(s, copy, &met), 0);
    sheen_store_destroy(&s);
    sheen_store_destroy(&copy);
}

static void test_reindex_of_an_empty_store(void **state)
{
    (void)state;
    SheenRecordStore *s = store_begin();
    assert_int_equal(sheen_store_reindex(s), SHEEN_OK);
    Contributors found;
    sheen_store_find(s, v3(0, 0, 0), v3(0, 0, 1), &found);
    assert_int_equal(found.n, 0);
    sheen_store_destroy(&s);
}

// A record that was enlarged from 0.5 to 2: it reaches a R along the plane, less far for a picture that resolves more,
// and never less far than its own radius.
static void test_enlarged_records_give_way(void **state)
{
    (void)state;
    const Bounds bounds = {{-1, -1, -1}, {1, 1, 1}};
    const Vec3 n = v3(0, 0, 1);
    const struct {
        float most, reach; // in units of a
    } cases[] = {{INFINITY, 2.0f}, {3.0f, 2.0f}, {1.0f, 1.0f}, {0.1f, 0.5f}};
    SheenRecordStore *s;
    assert_int_equal(sheen_store_create(0.1f, false, &bounds, &s), SHEEN_OK);
    Record r = {.n = n, .R = 2.0f, .a = 0.1f, .R_min = 2.0f, .R_sure = 0.5f};
    assert_int_equal(sheen_store_insert(s, &r), SHEEN_OK);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        Contributors within, beyond;
        float reach = 0.1f * cases[i].reach;
        sheen_store_find_near(s, v3(0.99f * reach, 0, 0), n, 0.1f * cases[i].most, &within);
        sheen_store_find_near(s, v3(1.01f * reach, 0, 0), n, 0.1f * cases[i].most, &beyond);
        assert_int_equal(within.n, 1);
        assert_int_equal(beyond.n, 0);
    }
    sheen_store_destroy(&s);
}

// The ellipse's own equation, of a point in the plane of the record.
static bool in_ellipse(float x, float y, float angle, float along, float across)
{
    float u = x * cosf(angle) + y * sinf(angle), v = y * cosf(angle) - x * sinf(angle);
    return sqrf(u / along) + sqrf(v / across) < 1.0f;
}

// A stretched record serves an ellipse: of reach a R across and a R times its elongation along.
static void test_ellipse(void **state)
{
    (void)state;
    for (uint32_t turn = 0; turn < 8; ++turn) {
        const float angle = 0.4f * (float)turn, aspect = 1.0f + 0.14f * (float)turn;
        SheenRecordStore *s = store_begin();
        Record r = {.n = v3(0, 0, 1), .R = 2.0f, .a = 0.2f, .R_min = 0.1f, .R_sure = 2.0f};
        r.stretch = record_stretch(v3(cosf(angle), sinf(angle), 0.0f), aspect);
        assert_true(fabsf(record_elongation(&r) - aspect) < 1e-5f);
        assert_true(fabsf(record_reach(&r) - 0.4f * aspect) < 1e-5f);
        assert_int_equal(sheen_store_append(s, &r), SHEEN_OK);
        unsigned inside = 0;
        for (uint32_t i = 0; i < POINTS; ++i) {
            float x = 2.0f * random_unit(i, 20) - 1.0f, y = 2.0f * random_unit(i, 21) - 1.0f;
            Contributors c;
            sheen_store_find(s, v3(x, y, 0.0f), r.n, &c);
            // Within a millionth of its edge rounding decides.
            if (in_ellipse(x, y, angle, 0.399999f * aspect, 0.399999f)) assert_int_equal(c.n, 1);
            if (!in_ellipse(x, y, angle, 0.400001f * aspect, 0.400001f)) assert_int_equal(c.n, 0);
            inside += c.n;
        }
        assert_true(inside > 100);
        sheen_store_destroy(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ellipse),
        cmocka_unit_test(test_enlarged_records_give_way),
        cmocka_unit_test(test_appended_records_keep_their_radii),
        cmocka_unit_test(test_reindexed_is_as_appended),
        cmocka_unit_test(test_reindex_of_an_empty_store),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
