// SPDX-License-Identifier: Apache-2.0
// From caches to the bytes of a file.
#include "cache/cache_layout.h"

#include <stdlib.h>

#include <xxhash.h>
#include <zstd.h>

// Measured on glossy records: higher levels take several times as long for one or two percent.
static const int compression_level = 1;

/** The file so far, and what compressing takes. */
typedef struct Encoder {
    const char *name;
    const SheenLog *log;
    uint8_t *data;
    size_t size, capacity;
    ZSTD_CCtx *zstd;
    uint64_t left_out; // records
} Encoder;

/** One cache, as rows of floats. */
typedef struct Source {
    SheenCachePartKind kind;
    unsigned order;
    size_t light_floats;
    const SheenRecordStore *store;
    const IrradianceLight *irradiance;
    const SheenRadianceCache *radiance;
} Source;

// @return room for n more bytes at the end; NULL when out of memory
static uint8_t *room(Encoder *e, size_t n)
{
    if (n > SIZE_MAX / 4 - e->size) return NULL;
    if (e->size + n > e->capacity) {
        size_t capacity = 2 * (e->size + n);
        uint8_t *grown = realloc(e->data, capacity);
        if (!grown) return NULL;
        e->data = grown;
        e->capacity = capacity;
    }
    return e->data + e->size;
}

// The light of a record without the padding that it has in memory.
static void copy_light(const Source *s, uint32_t record, float out[])
{
    if (s->irradiance) {
        memcpy(out, &s->irradiance[record], sizeof *s->irradiance);
        return;
    }
    const SheenRadianceCache *c = s->radiance;
    const float *light = c->light + record * radiance_light_floats(c);
    size_t n = s->light_floats / 3;
    for (size_t i = 0; i < 3; ++i) memcpy(out + i * n, light + i * c->stride, n * sizeof *out);
}

// A record and its light. @return whether they are sound
static bool copy_row(const Source *s, uint32_t record, float out[])
{
    const Record *r = &s->store->records[record];
    const float head[CACHE_RECORD_FLOATS] = {r->p.x, r->p.y,       r->p.z,       r->n.x,      r->n.y,
                                             r->n.z, r->R,         r->R_min,     r->R_sure,   r->error,
                                             r->a,   r->stretch.x, r->stretch.y, r->stretch.z};
    memcpy(out, head, sizeof head);
    copy_light(s, record, out + CACHE_RECORD_FLOATS);
    return cache_record_is_sound(r) && cache_light_is_sound(out + CACHE_RECORD_FLOATS, s->light_floats);
}

// Compresses n rows. Noisy floats have little to squeeze out: files are a tenth smaller than their numbers. Bytes
// sorted by significance would save 3 % more.
static SheenStatus put_block(Encoder *e, size_t row_bytes, uint32_t n, const uint8_t *rows)
{
    size_t bytes = n * row_bytes, bound = ZSTD_compressBound(bytes);
    uint8_t *out = room(e, 4 + bound);
    if (!out) return SHEEN_ERR_NOMEM;
    size_t packed = ZSTD_compressCCtx(e->zstd, out + 4, bound, rows, bytes, compression_level);
    if (ZSTD_isError(packed)) return SHEEN_ERR_NOMEM; // with enough room nothing else fails
    cache_put_u32(out, (uint32_t)packed);
    e->size += 4 + packed;
    return SHEEN_OK;
}

// @param n  out: how many were written
static SheenStatus put_rows(Encoder *e, const Source *s, float row[], uint8_t *rows, uint32_t *n)
{
    size_t row_bytes = cache_row_bytes(s->light_floats);
    uint32_t filled = 0;
    *n = 0;
    for (uint32_t i = 0; i < s->store->n; ++i) {
        if (!copy_row(s, i, row)) continue;
        ++*n;
        for (size_t k = 0; k < row_bytes / 4; ++k) cache_put_f32(rows + filled * row_bytes + 4 * k, row[k]);
        if (++filled < cache_block_rows(row_bytes)) continue;
        SheenStatus status = put_block(e, row_bytes, filled, rows);
        if (status != SHEEN_OK) return status;
        filled = 0;
    }
    return filled > 0 ? put_block(e, row_bytes, filled, rows) : SHEEN_OK;
}

static SheenStatus put_part(Encoder *e, const Source *s)
{
    size_t row_bytes = cache_row_bytes(s->light_floats), at = e->size;
    float *row = malloc(row_bytes);
    uint8_t *rows = malloc(row_bytes * cache_block_rows(row_bytes));
    SheenStatus status = row && rows && room(e, CACHE_PART_BYTES) ? SHEEN_OK : SHEEN_ERR_NOMEM;
    uint32_t n = 0;
    if (status == SHEEN_OK) {
        e->size += CACHE_PART_BYTES;
        status = put_rows(e, s, row, rows, &n);
    }
    if (status == SHEEN_OK) {
        uint8_t *head = e->data + at; // where it is now
        cache_put_u32(head, s->kind);
        cache_put_u32(head + 4, s->order);
        cache_put_u32(head + 8, s->store->neighbor_clamping ? CACHE_FLAG_NEIGHBOR_CLAMPING : 0);
        cache_put_f32(head + 12, s->store->accuracy);
        cache_put_f32(head + 16, s->store->cos_min);
        cache_put_u32(head + 20, n);
        cache_put_u32(head + 24, (uint32_t)s->light_floats);
        e->left_out += s->store->n - n;
    }
    free(row);
    free(rows);
    return status;
}

static unsigned sources_of(const SheenCacheContents *c, Source out[SHEEN_CACHE_PARTS])
{
    unsigned n = 0;
    if (c->irradiance)
        out[n++] = (Source){.kind = SHEEN_CACHE_PART_IRRADIANCE,
                            .light_floats = cache_light_floats(SHEEN_CACHE_PART_IRRADIANCE, 0),
                            .store = c->irradiance->store,
                            .irradiance = c->irradiance->light};
    for (unsigned b = 0; b < SHEEN_BASIS_COUNT; ++b) {
        const SheenRadianceCache *r = c->radiance[b];
        if (!r) continue;
        SheenCachePartKind kind = (SheenCachePartKind)(SHEEN_CACHE_PART_HSH + b);
        out[n++] = (Source){.kind = kind,
                            .order = r->order,
                            .light_floats = cache_light_floats(kind, r->order),
                            .store = r->store,
                            .radiance = r};
    }
    return n;
}

static SheenStatus put_file(Encoder *e, const SheenCacheContents *c)
{
    Source sources[SHEEN_CACHE_PARTS];
    unsigned n = sources_of(c, sources);
    size_t about = strlen(c->about);
    if (about > CACHE_ABOUT_MAX)
        return sheen_fail(e->log, SHEEN_ERR_INVALID, "%s: what it is about is too long", e->name);
    uint8_t *head = room(e, CACHE_HEADER_BYTES + about);
    if (!head) return SHEEN_ERR_NOMEM;
    memset(head, 0, CACHE_HEADER_BYTES);
    memcpy(head, cache_magic, sizeof cache_magic);
    cache_put_u32(head + 8, SHEEN_CACHE_FILE_VERSION);
    cache_put_u32(head + 12, n);
    cache_put_u64(head + 24, c->scene_hash);
    cache_put_u32(head + 32, (uint32_t)about);
    memcpy(head + CACHE_HEADER_BYTES, c->about, about);
    e->size += CACHE_HEADER_BYTES + about;
    for (unsigned i = 0; i < n; ++i) {
        SheenStatus status = put_part(e, &sources[i]);
        if (status != SHEEN_OK) return status;
    }
    uint8_t *tail = room(e, CACHE_CHECKSUM_BYTES);
    if (!tail) return SHEEN_ERR_NOMEM;
    cache_put_u64(e->data + 16, e->size + CACHE_CHECKSUM_BYTES);
    cache_put_u64(tail, XXH3_64bits(e->data, e->size));
    e->size += CACHE_CHECKSUM_BYTES;
    return SHEEN_OK;
}

SheenStatus sheen_cache_file_encode(const char *name, const SheenCacheContents *contents, const SheenLog *log,
                                    uint8_t **data, size_t *size)
{
    *data = NULL;
    *size = 0;
    Encoder e = {.name = name, .log = log, .zstd = ZSTD_createCCtx()};
    SheenStatus status = e.zstd ? put_file(&e, contents) : SHEEN_ERR_NOMEM;
    ZSTD_freeCCtx(e.zstd);
    if (status != SHEEN_OK) {
        free(e.data);
        return status == SHEEN_ERR_NOMEM ? sheen_fail(log, status, "%s: out of memory", name) : status;
    }
    if (e.left_out > 0)
        sheen_warn(log, "%s: %llu records with numbers that are not finite are left out", name,
                   (unsigned long long)e.left_out);
    *data = e.data;
    *size = e.size;
    return SHEEN_OK;
}
