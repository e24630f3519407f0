// SPDX-License-Identifier: Apache-2.0
// Memory that is freed as a whole: the scene's arrays live in one arena.
#ifndef SHEEN_BASE_ARENA_H
#define SHEEN_BASE_ARENA_H

#include <stddef.h>

typedef struct SheenArena SheenArena;

/** @return a new, empty arena owned by the caller, or NULL when out of memory. */
SheenArena *sheen_arena_create(void);

/** Frees the arena and everything allocated from it, and sets *arena to NULL. NULL-safe. */
void sheen_arena_destroy(SheenArena **arena);

/**
 * @return zeroed memory for `n` objects of `size` bytes, aligned to 64 bytes, that never moves and lives as long as the
 *         arena; NULL when out of memory or when n * size overflows. n = 0 gives a valid pointer to nothing.
 * Not thread-safe.
 */
void *sheen_arena_alloc(SheenArena *arena, size_t n, size_t size);

/** @return a copy of the string in the arena, or NULL when out of memory. */
char *sheen_arena_strdup(SheenArena *arena, const char *text);

#define SHEEN_ARENA_NEW(arena, T, n) ((T *)sheen_arena_alloc((arena), (n), sizeof(T)))

#endif
