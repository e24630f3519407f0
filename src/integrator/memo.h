// SPDX-License-Identifier: Apache-2.0
// A grid of remembered look-ups: values that are a pure function of a cell are computed once and read often.
#ifndef SHEEN_INTEGRATOR_MEMO_H
#define SHEEN_INTEGRATOR_MEMO_H

#include "base/status.h"
#include "math/vec.h"

#include <stdint.h>

typedef struct SheenMemo SheenMemo;

/** Thickness of a cell over its side. */
#define SHEEN_MEMO_DEPTH 0.125f

/**
 * A cell: a square of side `size` (a power of two) in the plane of the nearest of some hundred normals, and thin across
 * it, so that its centre lies on the surface however the surface lies in the world; and a tag of the caller's.
 */
typedef struct MemoCell {
    uint64_t key; // never 0
    Vec3 center;
    Vec3 n;      // unit, the quantised normal
    float depth; // thickness along n, metres
} MemoCell;

/** Finds the cell of a point. @param size  wanted side, metres; rounded down to a power of two. */
MemoCell sheen_memo_cell(Vec3 p, Vec3 n, float size, uint32_t tag);

SHEEN_NODISCARD SheenStatus sheen_memo_create(SheenMemo **out);
void sheen_memo_destroy(SheenMemo **memo);

/** @return true and the value when the cell has one. Thread-safe, also against sheen_memo_put. */
bool sheen_memo_get(const SheenMemo *memo, uint64_t key, Rgb *value);

/** Starts to load the slot of a key that sheen_memo_get will soon ask for. */
void sheen_memo_prefetch(const SheenMemo *memo, uint64_t key);

/**
 * Remembers a value; drops it where the table is crowded. All callers must put the same value for a key:
 * then nothing depends on who was first. Thread-safe.
 * @param value  channels not below zero; else it stands for "nothing there" and comes back as -1 in all of them
 * @return the value as sheen_memo_get gives it, of 14 significant bits: use this one, whether or not it was dropped
 */
Rgb sheen_memo_put(SheenMemo *memo, uint64_t key, Rgb value);

#endif
