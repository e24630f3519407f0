// SPDX-License-Identifier: Apache-2.0
// The grid of remembered look-ups: its cells, and its table under threads and when full.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/hash.h"
#include "base/pool.h"
#include "integrator/memo.h"
#include "math/frame.h"
#include "math/warp.h"

#include <stdlib.h>

static Vec3 random_normal(uint32_t i)
{
    uint32_t h = hash_u32(i ^ 0x51ed2701u);
    return warp_sphere(v2(hash_to_unit(h), hash_to_unit(hash_u32(h))));
}
static Vec3 random_point(uint32_t i, float size)
{
    uint32_t x = hash_u32(i ^ 0xabcdu), y = hash_u32(x), z = hash_u32(y);
    return v3_scale(v3(hash_to_unit(x) - 0.5f, hash_to_unit(y) - 0.5f, hash_to_unit(z) - 0.5f), size);
}

// The point lies in its cell: half a side from the centre in the plane, half the depth across it.
static void test_center_is_near(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 20000; ++i) {
        Vec3 n = random_normal(i), p = random_point(i, 20.0f);
        float size = 0.01f * expf(4.0f * hash_to_unit(hash_u32(i)));
        MemoCell c = sheen_memo_cell(p, n, size, 0);
        assert_true(c.key != 0);
        assert_true(fabsf(v3_length(c.n) - 1.0f) < 1e-5f);
        float side = c.depth / SHEEN_MEMO_DEPTH;
        assert_true(side <= size && size < 2.0f * side);
        assert_true(frexpf(side, &(int){0}) == 0.5f); // a power of two
        Frame f = frame_from_normal(c.n);
        Vec3 l = frame_to_local(&f, v3_sub(p, c.center));
        // Coordinates up to 20 are rounded to 1e-6, in a turn there and back of a few operations.
        assert_true(fabsf(l.x) <= 0.5f * side + 1e-5f && fabsf(l.y) <= 0.5f * side + 1e-5f);
        assert_true(fabsf(l.z) <= 0.5f * c.depth + 1e-5f);
    }
}

// The quantised normal: six steps to each side of a face of the cube are at most 1/12 in both coordinates off.
static void test_normal_is_near(void **state)
{
    (void)state;
    float worst = 1.0f;
    for (uint32_t i = 0; i < 20000; ++i) {
        Vec3 n = random_normal(i);
        worst = minf(worst, v3_dot(n, sheen_memo_cell(v3(0, 0, 0), n, 1.0f, 0).n));
    }
    assert_true(worst > cosf(hypotf(1.0f / 12.0f, 1.0f / 12.0f)) - 1e-5f);
    // Walls and floors are exact.
    static const Vec3 axes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int i = 0; i < 6; ++i) assert_true(v3_dot(sheen_memo_cell(v3(0, 0, 0), axes[i], 1.0f, 0).n, axes[i]) == 1.0f);
}

static void test_same_cell_for_near_points(void **state)
{
    (void)state;
    int compared = 0;
    for (uint32_t i = 0; i < 2000; ++i) {
        Vec3 n = random_normal(i), p = random_point(i, 4.0f);
        MemoCell c = sheen_memo_cell(p, n, 0.1f, 7);
        float a[3] = {fabsf(c.n.x), fabsf(c.n.y), fabsf(c.n.z)};
        int ties = (fabsf(a[0] - a[1]) < 0.03f) + (fabsf(a[1] - a[2]) < 0.03f) + (fabsf(a[2] - a[0]) < 0.03f);
        if (ties && fmaxf(a[0], fmaxf(a[1], a[2])) < 0.74f) continue; // an edge of the cube belongs to two faces
        ++compared;
        Frame f = frame_from_normal(c.n);
        float side = c.depth / SHEEN_MEMO_DEPTH;
        // The corners of a cell a tenth smaller, and the normals a hair beside its own.
        for (int k = 0; k < 8; ++k) {
            Vec3 l = v3(k & 1 ? 0.45f : -0.45f, k & 2 ? 0.45f : -0.45f, (k & 4 ? 0.45f : -0.45f) * SHEEN_MEMO_DEPTH);
            Vec3 q = v3_add(c.center, frame_to_world(&f, v3_scale(l, side)));
            Vec3 m = v3_normalize(v3_add(c.n, random_point(i + (uint32_t)k, 0.02f)));
            MemoCell d = sheen_memo_cell(q, m, 0.1f, 7);
            assert_true(d.key == c.key);
            assert_memory_equal(&d.center, &c.center, sizeof c.center);
        }
    }
    assert_true(compared > 1000);
}

static void test_different_cells(void **state)
{
    (void)state;
    Vec3 p = v3(0.3f, 0.2f, 0.1f), n = v3(0, 0, 1);
    uint64_t key = sheen_memo_cell(p, n, 0.1f, 0).key;
    assert_true(key != sheen_memo_cell(p, n, 0.1f, 1).key);            // tag
    assert_true(key != sheen_memo_cell(p, n, 0.2f, 0).key);            // level
    assert_true(key != sheen_memo_cell(p, v3(0, 0, -1), 0.1f, 0).key); // the other side of a wall
    assert_true(key != sheen_memo_cell(p, v3(0, 1, 0), 0.1f, 0).key);  // a corner
    assert_true(key == sheen_memo_cell(p, n, 0.11f, 0).key);           // the same power of two
    for (int a = 0; a < 3; ++a) {                                      // neighbors
        Vec3 step = a == 0 ? v3(0.0625f, 0, 0) : a == 1 ? v3(0, 0.0625f, 0) : v3(0, 0, 0.0625f * SHEEN_MEMO_DEPTH);
        assert_true(key != sheen_memo_cell(v3_add(p, step), n, 0.1f, 0).key);
        assert_true(key != sheen_memo_cell(v3_sub(p, step), n, 0.1f, 0).key);
    }
}

static int compare_keys(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

// A block of 2^20 cells about the origin, in five directions, four levels and two tags: all keys differ. Of random
// 64-bit keys two are equal in one of 30 million such blocks.
static void test_no_collisions(void **state)
{
    (void)state;
    enum { N = 1 << 20 };
    static const Vec3 normals[5] = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}, {-1, 0, 0}};
    uint64_t *keys = malloc(N * sizeof *keys);
    assert_non_null(keys);
    size_t n = 0;
    for (uint32_t i = 0; n < N; ++i) {
        uint32_t kind = i / 32768; // 32 x 32 x 32 cells of each kind
        Vec3 m = normals[kind % 5];
        float size = ldexpf(1.0f, -(int)(kind / 5 % 4));
        Frame f = frame_from_normal(m);
        Vec3 l = v3(((float)(i % 32) - 15.5f) * size, ((float)(i / 32 % 32) - 15.5f) * size,
                    ((float)(i / 1024 % 32) - 15.5f) * size * SHEEN_MEMO_DEPTH);
        keys[n++] = sheen_memo_cell(frame_to_world(&f, l), m, size, kind / 20).key;
    }
    qsort(keys, N, sizeof *keys, compare_keys);
    size_t equal = 0;
    for (size_t i = 1; i < N; ++i) equal += keys[i] == keys[i - 1];
    assert_int_equal(equal, 0);
    free(keys);
}

// ---- the table --------------------------------------------------------------------------------------------------

static uint64_t key_of(uint64_t i)
{
    // Four keys to each of 5000 slots, so that keys meet and probing is at work; never 0.
    return (uint64_t)hash_u32((uint32_t)i) << 32 | (i % 5000 * 16 + 1);
}
static Rgb value_of(uint64_t i)
{
    return rgb((float)i, (float)i + 0.5f, 1.0f / (float)(i + 1));
}
// Half of the last of 14 significant bits.
static bool near(float kept, float value)
{
    return fabsf(kept - value) <= 0x1p-14f * value;
}
static bool same(Rgb kept, Rgb value)
{
    return near(kept.r, value.r) && near(kept.g, value.g) && near(kept.b, value.b);
}

static void test_values(void **state)
{
    (void)state;
    SheenMemo *memo = NULL;
    assert_int_equal(sheen_memo_create(&memo), SHEEN_OK);
    static const float values[] = {0.0f, 1e-37f, 1e-3f, 0.3f, 1.0f, 0x1.fffffep0f, 7.7f, 1e5f, 3e38f};
    Rgb kept, got;
    for (uint64_t i = 0; i < sizeof values / sizeof *values; ++i) {
        Rgb v = rgb(values[i], 2.0f, values[(i + 3) % 9]);
        kept = sheen_memo_put(memo, i + 1, v);
        assert_true(same(kept, v) && kept.g == 2.0f); // a power of two is exact
        assert_true(sheen_memo_get(memo, i + 1, &got));
        assert_memory_equal(&got, &kept, sizeof got); // who computed it goes on with the same as who reads it
    }
    static const Rgb none[] = {{-1, -1, -1}, {0, -1e-9f, 0}, {1, 2, NAN}};
    for (uint64_t i = 0; i < 3; ++i) {
        kept = sheen_memo_put(memo, 100 + i, none[i]);
        assert_true(sheen_memo_get(memo, 100 + i, &got));
        assert_true(kept.r == -1.0f && kept.g == -1.0f && kept.b == -1.0f);
        assert_memory_equal(&got, &kept, sizeof got);
    }
    sheen_memo_destroy(&memo);
}

typedef struct Crowd {
    SheenMemo *memo;
    atomic_uint wrong, found;
} Crowd;

// Every key is put and read by several items at once.
static void crowd_task(void *user, size_t item, unsigned worker)
{
    (void)worker;
    Crowd *c = user;
    for (uint64_t i = 0; i < 500; ++i) {
        uint64_t k = (i + 100 * item) % 20000;
        Rgb v = rgb_gray(0.0f);
        if (sheen_memo_get(c->memo, key_of(k), &v)) {
            if (same(v, value_of(k)))
                atomic_fetch_add(&c->found, 1);
            else
                atomic_fetch_add(&c->wrong, 1);
        } else {
            sheen_memo_prefetch(c->memo, key_of(k));
            sheen_memo_put(c->memo, key_of(k), value_of(k));
        }
    }
}

static void test_threads(void **state)
{
    (void)state;
    Crowd c = {0};
    SheenPool *pool = NULL;
    assert_int_equal(sheen_memo_create(&c.memo), SHEEN_OK);
    assert_int_equal(sheen_pool_create(4, &pool), SHEEN_OK);
    assert_true(sheen_pool_run(pool, 400, crowd_task, &c, NULL));
    assert_int_equal(atomic_load(&c.wrong), 0);
    assert_true(atomic_load(&c.found) > 100000); // 200,000 visits to 20,000 keys
    for (uint64_t i = 0; i < 20000; ++i) {
        Rgb v;
        assert_true(sheen_memo_get(c.memo, key_of(i), &v));
        assert_true(same(v, value_of(i)));
    }
    Rgb v;
    assert_false(sheen_memo_get(c.memo, key_of(20001), &v));
    sheen_pool_destroy(&pool);
    sheen_memo_destroy(&c.memo);
    assert_null(c.memo);
    sheen_memo_destroy(NULL);
}

// A full table forgets some and answers the rest; it neither hangs nor mixes them up.
static void test_full_table(void **state)
{
    (void)state;
    enum { N = 2500000 };
    SheenMemo *memo = NULL;
    assert_int_equal(sheen_memo_create(&memo), SHEEN_OK);
    for (uint64_t i = 1; i <= N; ++i) sheen_memo_put(memo, i * 0x9e3779b97f4a7c15u, value_of(i));
    size_t kept = 0, wrong = 0;
    for (uint64_t i = 1; i <= N; ++i) {
        Rgb v;
        if (!sheen_memo_get(memo, i * 0x9e3779b97f4a7c15u, &v)) continue;
        wrong += !same(v, value_of(i));
        ++kept;
    }
    assert_true(kept > 100000 && kept < N); // it was full
    assert_int_equal(wrong, 0);
    sheen_memo_destroy(&memo);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_center_is_near),
        cmocka_unit_test(test_normal_is_near),
        cmocka_unit_test(test_same_cell_for_near_points),
        cmocka_unit_test(test_different_cells),
        cmocka_unit_test(test_no_collisions),
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_full_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
