// SPDX-License-Identifier: Apache-2.0
// The pool: each item once, one item a worker at a time, cancel between items, many batches on one pool.
#include "base/pool.h"

#include <sched.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MAX_WORKERS = 7 };

typedef struct Batch {
    atomic_uint *runs;                // [n] how often each item ran
    atomic_uint inside[MAX_WORKERS];  // items at work on a worker now
    atomic_uint overlaps, bad_worker; // violations; workers must not call assertions
    atomic_uint total;
    unsigned n_workers;
    atomic_bool *cancel;
    unsigned cancel_after;
} Batch;

static void run_item(void *user, size_t item, unsigned worker)
{
    Batch *b = user;
    if (worker >= b->n_workers) {
        atomic_fetch_add(&b->bad_worker, 1);
        return;
    }
    if (atomic_fetch_add(&b->inside[worker], 1) != 0) atomic_fetch_add(&b->overlaps, 1);
    atomic_fetch_add(&b->runs[item], 1);
    unsigned number = atomic_fetch_add(&b->total, 1) + 1;
    if (number == b->cancel_after) atomic_store(b->cancel, true);
    // Items counted later wait for the flag: the worker that raises it may be kept from doing so.
    while (b->cancel_after > 0 && number > b->cancel_after && !atomic_load(b->cancel)) sched_yield();
    atomic_fetch_sub(&b->inside[worker], 1);
}

static const unsigned thread_counts[] = {1, 2, 3, MAX_WORKERS};
enum { N_COUNTS = sizeof thread_counts / sizeof thread_counts[0], MAX_ITEMS = 3000 };

static void test_each_item_runs_once(void **state)
{
    (void)state;
    for (int c = 0; c < N_COUNTS; ++c) {
        SheenPool *pool = NULL;
        assert_int_equal(sheen_pool_create(thread_counts[c], &pool), SHEEN_OK);
        assert_int_equal(sheen_pool_size(pool), thread_counts[c]);
        static const size_t sizes[] = {0, 1, 2, 5, 64, MAX_ITEMS};
        for (int repeat = 0; repeat < 20; ++repeat) {
            size_t n = sizes[repeat % 6];
            Batch b = {.runs = calloc(MAX_ITEMS, sizeof *b.runs), .n_workers = thread_counts[c]};
            assert_non_null(b.runs);
            assert_true(sheen_pool_run(pool, n, run_item, &b, NULL));
            for (size_t i = 0; i < MAX_ITEMS; ++i) assert_int_equal(b.runs[i], i < n ? 1 : 0);
            assert_int_equal(b.overlaps, 0);
            assert_int_equal(b.bad_worker, 0);
            free(b.runs);
        }
        sheen_pool_destroy(&pool);
        assert_null(pool);
    }
}

static void test_cancel_stops_between_items(void **state)
{
    (void)state;
    for (int c = 0; c < N_COUNTS; ++c) {
        SheenPool *pool = NULL;
        assert_int_equal(sheen_pool_create(thread_counts[c], &pool), SHEEN_OK);
        atomic_bool cancel = false;
        Batch b = {.runs = calloc(MAX_ITEMS, sizeof *b.runs),
                   .n_workers = thread_counts[c],
                   .cancel = &cancel,
                   .cancel_after = 100};
        assert_false(sheen_pool_run(pool, MAX_ITEMS, run_item, &b, &cancel));
        // When the flag rises, each other worker may have one item in hand or just taken.
        assert_in_range(b.total, 100, 100 + thread_counts[c] - 1);
        for (size_t i = 0; i < MAX_ITEMS; ++i) assert_true(b.runs[i] <= 1);

        // Cancelled from the start: nothing runs.
        memset(b.runs, 0, MAX_ITEMS * sizeof *b.runs);
        b.total = 0;
        assert_false(sheen_pool_run(pool, MAX_ITEMS, run_item, &b, &cancel));
        assert_int_equal(b.total, 0);

        // And the pool is as good as new afterwards.
        atomic_store(&cancel, false);
        b.cancel_after = 0;
        assert_true(sheen_pool_run(pool, MAX_ITEMS, run_item, &b, &cancel));
        assert_int_equal(b.total, MAX_ITEMS);
        free(b.runs);
        sheen_pool_destroy(&pool);
    }
}

static void test_creation(void **state)
{
    (void)state;
    SheenPool *pool = NULL;
    assert_int_equal(sheen_pool_create(1025, &pool), SHEEN_ERR_INVALID);
    assert_null(pool);
    assert_int_equal(sheen_pool_create(0, &pool), SHEEN_OK);
    assert_true(sheen_pool_size(pool) >= 1);
    sheen_pool_destroy(&pool);
    sheen_pool_destroy(&pool);
    sheen_pool_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_item_runs_once),
        cmocka_unit_test(test_cancel_stops_between_items),
        cmocka_unit_test(test_creation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
