// SPDX-License-Identifier: Apache-2.0
// The arena: aligned, zeroed, stable memory, and no overflow of sizes.
#include "base/arena.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static void test_memory_is_aligned_zeroed_and_stable(void **state)
{
    (void)state;
    enum { N = 2000 };
    static unsigned char *block[N];
    SheenArena *arena = sheen_arena_create();
    assert_non_null(arena);
    // Sizes from nothing to four times a block of the arena, in an order that mixes small and large.
    for (size_t i = 0; i < N; ++i) {
        size_t size = i % 100 == 99 ? (i % 400 + 1) * 700 : (i * 37) % 300;
        block[i] = sheen_arena_alloc(arena, size, 1);
        assert_non_null(block[i]);
        assert_int_equal((uintptr_t)block[i] % 64, 0);
        for (size_t k = 0; k < size; ++k) assert_int_equal(block[i][k], 0);
        if (size) memset(block[i], (int)(i & 0xff), size);
    }
    for (size_t i = 0; i < N; ++i) {
        size_t size = i % 100 == 99 ? (i % 400 + 1) * 700 : (i * 37) % 300;
        for (size_t k = 0; k < size; ++k) assert_int_equal(block[i][k], i & 0xff);
    }
    sheen_arena_destroy(&arena);
    assert_null(arena);
    sheen_arena_destroy(&arena);
    sheen_arena_destroy(NULL);
}

static void test_sizes_that_overflow_are_refused(void **state)
{
    (void)state;
    SheenArena *arena = sheen_arena_create();
    assert_non_null(arena);
    // The last leaves a product just below the largest size, which rounding up to the alignment would wrap to zero.
    static const size_t huge[][2] = {
        {SIZE_MAX, 2}, {2, SIZE_MAX}, {SIZE_MAX / 2 + 1, 2}, {SIZE_MAX, 1}, {SIZE_MAX - 10, 1}};
    for (size_t i = 0; i < sizeof huge / sizeof huge[0]; ++i)
        assert_null(sheen_arena_alloc(arena, huge[i][0], huge[i][1]));
    assert_non_null(SHEEN_ARENA_NEW(arena, double, 10));
    assert_non_null(sheen_arena_alloc(arena, 0, SIZE_MAX));
    assert_non_null(sheen_arena_alloc(arena, SIZE_MAX, 0));
    sheen_arena_destroy(&arena);
}

static void test_strings_are_copied(void **state)
{
    (void)state;
    SheenArena *arena = sheen_arena_create();
    char text[] = "a name";
    char *copy = sheen_arena_strdup(arena, text), *empty = sheen_arena_strdup(arena, "");
    text[0] = 'X';
    assert_string_equal(copy, "a name");
    assert_string_equal(empty, "");
    sheen_arena_destroy(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_memory_is_aligned_zeroed_and_stable),
        cmocka_unit_test(test_sizes_that_overflow_are_refused),
        cmocka_unit_test(test_strings_are_copied),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
