// SPDX-License-Identifier: Apache-2.0
#include "base/arena.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { ALIGNMENT = 64, BLOCK_SIZE = 1 << 16 };

typedef struct Block {
    struct Block *next;
    size_t used, capacity;
    unsigned char *data;
} Block;

struct SheenArena {
    Block *head;
};

SheenArena *sheen_arena_create(void)
{
    return calloc(1, sizeof(SheenArena));
}

void sheen_arena_destroy(SheenArena **arena)
{
    if (!arena || !*arena) return;
    for (Block *b = (*arena)->head; b;) {
        Block *next = b->next;
        free(b->data);
        free(b);
        b = next;
    }
    free(*arena);
    *arena = NULL;
}

static Block *block_create(size_t capacity)
{
    Block *b = calloc(1, sizeof *b);
    if (!b) return NULL;
    b->data = aligned_alloc(ALIGNMENT, capacity);
    if (!b->data) {
        free(b);
        return NULL;
    }
    b->capacity = capacity;
    return b;
}

void *sheen_arena_alloc(SheenArena *arena, size_t n, size_t size)
{
    if (size && n > (SIZE_MAX - ALIGNMENT) / size) return NULL;
    size_t bytes = (n * size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    Block *b = arena->head;
    if (!b || b->capacity - b->used < bytes) {
        b = block_create(bytes > BLOCK_SIZE ? bytes : BLOCK_SIZE);
        if (!b) return NULL;
        // A large block goes behind the head, so that the head's free space is not lost.
        if (bytes > BLOCK_SIZE && arena->head) {
            b->next = arena->head->next;
            arena->head->next = b;
        } else {
            b->next = arena->head;
            arena->head = b;
        }
    }
    void *p = b->data + b->used;
    b->used += bytes;
    memset(p, 0, bytes);
    return p;
}

char *sheen_arena_strdup(SheenArena *arena, const char *text)
{
    size_t n = strlen(text) + 1;
    char *copy = sheen_arena_alloc(arena, n, 1);
    if (copy) memcpy(copy, text, n);
    return copy;
}
