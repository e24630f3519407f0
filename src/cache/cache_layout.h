// SPDX-License-Identifier: Apache-2.0
// The layout of cache files: what writing and reading share. All numbers are little-endian; docs/cache-files.md has the
// table.
#ifndef SHEEN_CACHE_CACHE_LAYOUT_H
#define SHEEN_CACHE_CACHE_LAYOUT_H

#include "cache/cache_file.h"

#include <string.h>

/** Like that of PNG: damaged where a transfer changes line ends or the eighth bit. */
static const uint8_t cache_magic[8] = {0x89, 'S', 'H', 'C', '\r', '\n', 0x1a, '\n'};

enum {
    CACHE_HEADER_BYTES = 40,    // of the file, before `about`
    CACHE_PART_BYTES = 28,      // of a part, before its blocks
    CACHE_CHECKSUM_BYTES = 8,   // at the end of the file
    CACHE_ABOUT_MAX = 1 << 20,  // bytes
    CACHE_BLOCK_BYTES = 1 << 16 // of a block before compression, or those of one record where it has more
};
enum { CACHE_RECORD_FLOATS = 14 }; // p, n, R, R_min, R_sure, error, a, stretch; the light follows
enum { CACHE_FLAG_NEIGHBOR_CLAMPING = 1, CACHE_FLAGS = 1 };

/** Bytes of a record with its light. */
static inline size_t cache_row_bytes(size_t light_floats)
{
    return 4 * (CACHE_RECORD_FLOATS + light_floats);
}

/** Records of each block but the last. */
static inline uint32_t cache_block_rows(size_t row_bytes)
{
    return row_bytes < CACHE_BLOCK_BYTES ? (uint32_t)(CACHE_BLOCK_BYTES / row_bytes) : 1;
}

/** Floats of the light of one record. */
static inline size_t cache_light_floats(SheenCachePartKind kind, unsigned order)
{
    return kind == SHEEN_CACHE_PART_IRRADIANCE ? sizeof(IrradianceLight) / sizeof(float) : 9 * basis_size(order);
}

/** Whether a cache can make something of a record: of these numbers only an own radius may be without bound. */
static inline bool cache_record_is_sound(const Record *r)
{
    float length2 = v3_length2(r->n);
    return v3_finite(r->p) && length2 > 0.99f && length2 < 1.01f && isfinite(r->R) && r->R >= 0.0f &&
           isfinite(r->R_min) && r->R_min >= 0.0f && r->R_sure >= 0.0f && r->error >= 0.0f && r->a > 0.0f &&
           r->a <= 1.0f && v3_length2(r->stretch) < 1.0f;
}

static inline bool cache_light_is_sound(const float light[], size_t n)
{
    for (size_t i = 0; i < n; ++i)
        if (!isfinite(light[i])) return false;
    return true;
}

// ---- numbers ----------------------------------------------------------------------------------------------------

static inline void cache_put_u32(uint8_t *p, uint32_t x)
{
    for (unsigned i = 0; i < 4; ++i) p[i] = (uint8_t)(x >> 8 * i);
}
static inline void cache_put_u64(uint8_t *p, uint64_t x)
{
    for (unsigned i = 0; i < 8; ++i) p[i] = (uint8_t)(x >> 8 * i);
}
static inline void cache_put_f32(uint8_t *p, float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    cache_put_u32(p, bits);
}
static inline uint32_t cache_get_u32(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}
static inline uint64_t cache_get_u64(const uint8_t *p)
{
    return (uint64_t)cache_get_u32(p) | (uint64_t)cache_get_u32(p + 4) << 32;
}
static inline float cache_get_f32(const uint8_t *p)
{
    uint32_t bits = cache_get_u32(p);
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

#endif
