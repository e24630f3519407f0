// SPDX-License-Identifier: Apache-2.0
#include "integrator/memo.h"

#include "math/frame.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

enum { SLOTS = 1 << 20, PROBES_MAX = 16, NORMAL_STEPS = 12, HUGE_PAGE = 1 << 21 };

// Four slots share a cache line.
typedef struct Slot {
    atomic_uint_least64_t key;   // 0 is free
    atomic_uint_least64_t value; // packed; 0 is not yet written
} Slot;

struct SheenMemo {
    Slot *slots;
};

SheenStatus sheen_memo_create(SheenMemo **out)
{
    *out = calloc(1, sizeof **out);
    if (!*out) return SHEEN_ERR_NOMEM;
    (*out)->slots = aligned_alloc(HUGE_PAGE, SLOTS * sizeof(Slot));
    if (!(*out)->slots) {
        free(*out);
        *out = NULL;
        return SHEEN_ERR_NOMEM;
    }
    // Look-ups are spread over the whole table: in small pages each would first wait for the page's address.
    (void)madvise((*out)->slots, SLOTS * sizeof(Slot), MADV_HUGEPAGE);
    memset((*out)->slots, 0, SLOTS * sizeof(Slot));
    return SHEEN_OK;
}

void sheen_memo_destroy(SheenMemo **memo)
{
    if (!memo || !*memo) return;
    free((*memo)->slots);
    free(*memo);
    *memo = NULL;
}

// ---- cells ------------------------------------------------------------------------------------------------------

// The normal on the surface of a cube of an even number of steps a side, so that the axes themselves are exact.
static Vec3 quantise_normal(Vec3 n, uint64_t *code)
{
    const float half = NORMAL_STEPS / 2;
    float scale = half / maxf(fabsf(n.x), maxf(fabsf(n.y), fabsf(n.z)));
    Vec3 q = v3(rintf(n.x * scale), rintf(n.y * scale), rintf(n.z * scale));
    q = v3_add(q, v3(0.0f, 0.0f, 0.0f)); // a negative zero would turn the frame about the normal
    *code = (uint64_t)((((int)q.x + NORMAL_STEPS) * 64 + (int)q.y + NORMAL_STEPS) * 64 + (int)q.z + NORMAL_STEPS);
    return v3_normalize(q);
}

// Four products that do not wait for each other, then two rounds that mix all bits into all others. Source of the
// rounds: steele2014-splittable. A sum of products: with exclusive or, (x, y) and (-x, -y) would often meet.
static uint64_t hash_cell(int64_t x, int64_t y, int64_t z, uint64_t rest)
{
    uint64_t h = (uint64_t)x * 0x9e3779b97f4a7c15u + (uint64_t)y * 0xd6e8feb86659fd93u;
    h += (uint64_t)z * 0xa0761d6478bd642fu + rest * 0xe7037ed1a0b428dbu;
    h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9u;
    h = (h ^ h >> 27) * 0x94d049bb133111ebu;
    return h ^ h >> 31;
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
    uint64_t code;
    cell.n = quantise_normal(n, &code);
    Frame f = frame_from_normal(cell.n);
    Vec3 l = frame_to_local(&f, p);
    float x = floorf(l.x * inverse), y = floorf(l.y * inverse), z = floorf(l.z * inverse / SHEEN_MEMO_DEPTH);
    cell.center = frame_to_world(&f, v3((x + 0.5f) * side, (y + 0.5f) * side, (z + 0.5f) * depth));
    cell.depth = depth;
    // A 60-bit hash stands for all coordinates: two of a million cells share one in one of 10^6 pictures.
    // The lowest bits are the place within a square of four by four cells: those lie side by side in the table, in four
    // cache lines.
    int64_t i = (int64_t)x, j = (int64_t)y;
    uint64_t h = hash_cell(i >> 2, j >> 2, (int64_t)z, code << 42 ^ (uint64_t)tag << 8 ^ level >> 23);
    h = h << 4 | (uint64_t)(i & 3) << 2 | (uint64_t)(j & 3);
    cell.key = h ? h : 1;
    return cell;
}

// ---- values -----------------------------------------------------------------------------------------------------

static const uint64_t nothing = UINT64_MAX;

// A channel without sign in 21 bits: the exponent and 13 bits of the mantissa, rounded.
static uint64_t pack_channel(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (bits + 0x200u) >> 10 & 0x1fffffu;
}

static float unpack_channel(uint64_t packed)
{
    uint32_t bits = (uint32_t)(packed & 0x1fffffu) << 10;
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

// The topmost bit is always set.
static uint64_t pack(Rgb v)
{
    if (!(v.r >= 0.0f && v.g >= 0.0f && v.b >= 0.0f)) return nothing;
    return UINT64_C(1) << 63 | pack_channel(v.r) << 42 | pack_channel(v.g) << 21 | pack_channel(v.b);
}

static Rgb unpack(uint64_t packed)
{
    if (packed == nothing) return rgb_gray(-1.0f);
    return rgb(unpack_channel(packed >> 42), unpack_channel(packed >> 21), unpack_channel(packed));
}

// ---- the table --------------------------------------------------------------------------------------------------

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
        uint64_t packed = atomic_load_explicit(&slot->value, memory_order_relaxed);
        *value = unpack(packed);
        return packed != 0;
    }
    return false;
}

Rgb sheen_memo_put(SheenMemo *memo, uint64_t key, Rgb value)
{
    uint64_t packed = pack(value);
    for (size_t probe = 0; probe < PROBES_MAX; ++probe) {
        Slot *slot = &memo->slots[(key + probe) & (SLOTS - 1)];
        uint64_t k = 0;
        bool free_slot =
            atomic_compare_exchange_strong_explicit(&slot->key, &k, key, memory_order_relaxed, memory_order_relaxed);
        if (free_slot) atomic_store_explicit(&slot->value, packed, memory_order_relaxed);
        if (free_slot || k == key) break; // somebody else writes the same value
    }
    return unpack(packed);
}
