// SPDX-License-Identifier: Apache-2.0
#include "integrator/memo.h"

#include "math/frame.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { SLOTS = 1 << 20, PROBES_MAX = 16, NORMAL_STEPS = 12 };

typedef struct Slot {
    atomic_uint_least64_t key; // 0 is free
    atomic_bool ready;         // the value is written
    Rgb value;
} Slot;

struct SheenMemo {
    Slot *slots;
};

SheenStatus sheen_memo_create(SheenMemo **out)
{
    *out = calloc(1, sizeof **out);
    if (!*out) return SHEEN_ERR_NOMEM;
    (*out)->slots = calloc(SLOTS, sizeof(Slot));
    if (!(*out)->slots) {
        free(*out);
        *out = NULL;
        return SHEEN_ERR_NOMEM;
    }
    return SHEEN_OK;
}

void sheen_memo_destroy(SheenMemo **memo)
{
    if (!memo || !*memo) return;
    free((*memo)->slots);
    free(*memo);
    *memo = NULL;
}

static uint64_t mix(uint64_t h, uint64_t x)
{
    h = (h ^ x ^ 0xd6e8feb86659fd93u) * 0x9e3779b97f4a7c15u;
    return h ^ (h >> 32);
}

// The normal on the cube of directions: dominant axis and two steps on its face.
static Vec3 quantise_normal(Vec3 n, uint32_t *code)
{
    float a[3] = {n.x, n.y, n.z};
    unsigned axis = fabsf(n.x) >= fabsf(n.y) ? (fabsf(n.x) >= fabsf(n.z) ? 0 : 2) : (fabsf(n.y) >= fabsf(n.z) ? 1 : 2);
    float m = fabsf(a[axis]);
    unsigned u_axis = (axis + 1) % 3, v_axis = (axis + 2) % 3;
    // An odd number of steps keeps the axes themselves exact.
    const int half = NORMAL_STEPS / 2;
    int u = (int)lrintf(a[u_axis] / m * (float)half), v = (int)lrintf(a[v_axis] / m * (float)half);
    *code =
        (uint32_t)(((axis * 2 + (a[axis] < 0.0f)) * (2 * NORMAL_STEPS) + (unsigned)(u + half)) * (2 * NORMAL_STEPS) +
                   (unsigned)(v + half));
    float q[3];
    q[axis] = a[axis] < 0.0f ? -1.0f : 1.0f;
    q[u_axis] = (float)u / (float)half;
    q[v_axis] = (float)v / (float)half;
    return v3_normalize(v3(q[0], q[1], q[2]));
}

MemoCell sheen_memo_cell(Vec3 p, Vec3 n, float size, uint32_t tag)
{
    // The exponent alone, without the mantissa, is the power of two below.
    uint32_t level;
    memcpy(&level, &size, sizeof level);
    level &= 0x7f800000u;
    float side;
    memcpy(&side, &level, sizeof side);
    float inverse = 1.0f / side, depth = side * SHEEN_MEMO_DEPTH;
    MemoCell cell;
    uint32_t code;
    cell.n = quantise_normal(n, &code);
    Frame f = frame_from_normal(cell.n);
    Vec3 l = frame_to_local(&f, p);
    float x = floorf(l.x * inverse), y = floorf(l.y * inverse), z = floorf(l.z * inverse / SHEEN_MEMO_DEPTH);
    cell.center = frame_to_world(&f, v3((x + 0.5f) * side, (y + 0.5f) * side, (z + 0.5f) * depth));
    cell.depth = depth;
    // A 64-bit hash stands for all coordinates: two of a million cells share one in one of 10^7 pictures.
    uint64_t h = mix(mix(mix(mix(0, (uint64_t)(int64_t)x), (uint64_t)(int64_t)y), (uint64_t)(int64_t)z), code);
    h = mix(h, (uint64_t)level << 32 | tag);
    h ^= h >> 32;
    cell.key = h ? h : 1;
    return cell;
}

void sheen_memo_prefetch(const SheenMemo *memo, uint64_t key)
{
    __builtin_prefetch(&memo->slots[key & (SLOTS - 1)]);
}

bool sheen_memo_get(const SheenMemo *memo, uint64_t key, Rgb *value)
{
    for (size_t probe = 0; probe < PROBES_MAX; ++probe) {
        Slot *slot = &memo->slots[(key + probe) & (SLOTS - 1)];
        uint64_t k = atomic_load_explicit(&slot->key, memory_order_relaxed);
        if (k == 0) return false;
        if (k != key) continue;
        if (!atomic_load_explicit(&slot->ready, memory_order_acquire)) return false;
        *value = slot->value;
        return true;
    }
    return false;
}

void sheen_memo_put(SheenMemo *memo, uint64_t key, Rgb value)
{
    for (size_t probe = 0; probe < PROBES_MAX; ++probe) {
        Slot *slot = &memo->slots[(key + probe) & (SLOTS - 1)];
        uint64_t k = 0;
        if (!atomic_compare_exchange_strong_explicit(&slot->key, &k, key, memory_order_relaxed, memory_order_relaxed)) {
            if (k == key) return; // somebody else writes the same value
            continue;
        }
        slot->value = value;
        atomic_store_explicit(&slot->ready, true, memory_order_release);
        return;
    }
}
