// SPDX-License-Identifier: Apache-2.0
// From the bytes of a file to its records, trusting none of them.
#include "cache/cache_layout.h"

#include <jansson.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <xxhash.h>
#include <zstd.h>

/** A file that is read; `size` is without the checksum. */
typedef struct Decoder {
    const char *name;
    const SheenLog *log;
    const uint8_t *data;
    size_t size, at;
    ZSTD_DCtx *zstd;
    uint8_t *rows; // one block, unpacked
} Decoder;

static SheenStatus refuse(const Decoder *d, const char *format, ...) __attribute__((format(printf, 2, 3)));
static SheenStatus refuse(const Decoder *d, const char *format, ...)
{
    char why[256];
    va_list args;
    va_start(args, format);
    vsnprintf(why, sizeof why, format, args);
    va_end(args);
    return sheen_fail(d->log, SHEEN_ERR_PARSE, "%s: %s", d->name, why);
}

static SheenStatus out_of_memory(const Decoder *d)
{
    return sheen_fail(d->log, SHEEN_ERR_NOMEM, "%s: out of memory", d->name);
}

static const char *const part_names[SHEEN_CACHE_PARTS] = {
    [SHEEN_CACHE_PART_IRRADIANCE] = "irradiance",
    [SHEEN_CACHE_PART_HSH] = "hemispherical radiance",
    [SHEEN_CACHE_PART_SH] = "spherical radiance",
};

// ---- the whole --------------------------------------------------------------------------------------------------

// The order of these tests gives the most useful of several reasons.
static SheenStatus check_frame(Decoder *d)
{
    size_t magic = d->size < sizeof cache_magic ? d->size : sizeof cache_magic;
    if (d->size == 0) return refuse(d, "the file is empty");
    if (memcmp(d->data, cache_magic, magic) != 0) return refuse(d, "not a cache file");
    if (d->size < CACHE_HEADER_BYTES + CACHE_CHECKSUM_BYTES) return refuse(d, "the file ends in its header");
    uint32_t version = cache_get_u32(d->data + 8);
    if (version != SHEEN_CACHE_FILE_VERSION)
        return sheen_fail(d->log, SHEEN_ERR_UNSUPPORTED,
                          "%s: a cache file of version %u; this program reads version %d", d->name, version,
                          SHEEN_CACHE_FILE_VERSION);
    uint64_t bytes = cache_get_u64(d->data + 16);
    if (d->size < bytes)
        return refuse(d, "the file is cut off: %llu of %llu bytes are there", (unsigned long long)d->size,
                      (unsigned long long)bytes);
    if (d->size > bytes)
        return refuse(d, "the file goes on after its end, by %llu bytes", (unsigned long long)(d->size - bytes));
    d->size -= CACHE_CHECKSUM_BYTES;
    if (XXH3_64bits(d->data, d->size) != cache_get_u64(d->data + d->size))
        return refuse(d, "the file is damaged: its checksum does not hold");
    return SHEEN_OK;
}

static SheenStatus read_about(Decoder *d, SheenCacheFile *file)
{
    uint32_t length = cache_get_u32(d->data + 32);
    if (cache_get_u32(d->data + 36) != 0) return refuse(d, "the header has a value where there should be none");
    if (length > CACHE_ABOUT_MAX || length > d->size - CACHE_HEADER_BYTES)
        return refuse(d, "the header promises a description of %u bytes", length);
    const char *text = (const char *)d->data + CACHE_HEADER_BYTES;
    json_t *json = json_loadb(text, length, JSON_REJECT_DUPLICATES, NULL);
    bool is_object = json_is_object(json);
    json_decref(json);
    if (!is_object) return refuse(d, "the description is no JSON object");
    file->about = malloc(length + 1);
    if (!file->about) return out_of_memory(d);
    memcpy(file->about, text, length);
    file->about[length] = 0;
    d->at = CACHE_HEADER_BYTES + length;
    return SHEEN_OK;
}

// ---- parts ------------------------------------------------------------------------------------------------------

// Adds up the blocks of a part before anything is allocated for them.
static SheenStatus check_blocks(const Decoder *d, SheenCachePartKind kind, uint32_t n, size_t row_bytes)
{
    uint32_t per_block = cache_block_rows(row_bytes);
    size_t at = d->at;
    for (uint32_t left = n; left > 0;) {
        uint32_t rows = left < per_block ? left : per_block;
        uint32_t packed = d->size - at < 4 ? 0 : cache_get_u32(d->data + at);
        if (d->size - at < 4 || packed > d->size - at - 4)
            return refuse(d, "the file ends before its %s records do", part_names[kind]);
        if (ZSTD_getFrameContentSize(d->data + at + 4, packed) != rows * row_bytes)
            return refuse(d, "a block of the %s records has another size than theirs", part_names[kind]);
        at += 4 + packed;
        left -= rows;
    }
    return SHEEN_OK;
}

static void read_floats(const uint8_t *bytes, size_t n, float out[])
{
    for (size_t i = 0; i < n; ++i) out[i] = cache_get_f32(bytes + 4 * i);
}

static SheenStatus read_record(const Decoder *d, SheenCachePartKind kind, const uint8_t *row, SheenCachePart *part)
{
    float head[CACHE_RECORD_FLOATS], *light = part->light + part->n * part->light_floats;
    read_floats(row, CACHE_RECORD_FLOATS, head);
    read_floats(row + sizeof head, part->light_floats, light);
    Record *r = &part->records[part->n];
    *r = (Record){.p = v3(head[0], head[1], head[2]),
                  .n = v3(head[3], head[4], head[5]),
                  .R = head[6],
                  .R_min = head[7],
                  .R_sure = head[8],
                  .error = head[9],
                  .a = head[10],
                  .stretch = v3(head[11], head[12], head[13])};
    if (!cache_record_is_sound(r) || !cache_light_is_sound(light, part->light_floats))
        return refuse(d, "%s record %u has numbers that no record can have", part_names[kind], part->n);
    ++part->n;
    return SHEEN_OK;
}

static SheenStatus read_block(Decoder *d, SheenCachePartKind kind, uint32_t rows, SheenCachePart *part)
{
    size_t row_bytes = cache_row_bytes(part->light_floats), bytes = rows * row_bytes;
    uint32_t packed = cache_get_u32(d->data + d->at);
    if (ZSTD_decompressDCtx(d->zstd, d->rows, bytes, d->data + d->at + 4, packed) != bytes)
        return refuse(d, "a block of the %s records does not unpack", part_names[kind]);
    d->at += 4 + packed;
    SheenStatus status = SHEEN_OK;
    for (uint32_t i = 0; i < rows && status == SHEEN_OK; ++i)
        status = read_record(d, kind, d->rows + i * row_bytes, part);
    return status;
}

// @return whether the numbers before the blocks are those of a cache
static bool part_is_sound(SheenCachePartKind kind, const SheenCachePart *p, uint32_t flags)
{
    bool order = kind == SHEEN_CACHE_PART_IRRADIANCE ? p->order == 0 : p->order >= 1 && p->order <= SHEEN_ORDER_MAX;
    return order && (flags & ~(uint32_t)CACHE_FLAGS) == 0 && p->accuracy > 0.0f && p->accuracy <= 1.0f &&
           p->cos_min >= -1.0f && p->cos_min <= 1.0f && p->light_floats == cache_light_floats(kind, p->order);
}

static SheenStatus read_records(Decoder *d, SheenCachePartKind kind, uint32_t n, SheenCachePart *p)
{
    size_t row_bytes = cache_row_bytes(p->light_floats);
    uint32_t per_block = cache_block_rows(row_bytes);
    SheenStatus status = check_blocks(d, kind, n, row_bytes);
    if (status != SHEEN_OK || n == 0) return status;
    if (n > SIZE_MAX / row_bytes) return out_of_memory(d); // of a 32-bit machine
    p->records = malloc(n * sizeof *p->records);
    p->light = malloc(n * p->light_floats * sizeof *p->light);
    d->rows = malloc(per_block * row_bytes);
    if (!p->records || !p->light || !d->rows) status = out_of_memory(d);
    while (p->n < n && status == SHEEN_OK) {
        uint32_t rows = n - p->n < per_block ? n - p->n : per_block;
        status = read_block(d, kind, rows, p);
    }
    free(d->rows);
    d->rows = NULL;
    return status;
}

static SheenStatus read_part(Decoder *d, SheenCacheFile *file)
{
    if (d->size - d->at < CACHE_PART_BYTES) return refuse(d, "the file ends before its records do");
    const uint8_t *head = d->data + d->at;
    uint32_t kind = cache_get_u32(head), flags = cache_get_u32(head + 8), n = cache_get_u32(head + 20);
    if (kind >= SHEEN_CACHE_PARTS || file->parts[kind].held)
        return refuse(d, "records of kind %u, unknown or met twice", kind);
    SheenCachePart *p = &file->parts[kind];
    *p = (SheenCachePart){.held = true,
                          .neighbor_clamping = flags & CACHE_FLAG_NEIGHBOR_CLAMPING,
                          .accuracy = cache_get_f32(head + 12),
                          .cos_min = cache_get_f32(head + 16),
                          .order = cache_get_u32(head + 4),
                          .light_floats = cache_get_u32(head + 24)};
    if (!part_is_sound(kind, p, flags))
        return refuse(d, "the header of the %s records has numbers that no cache can have", part_names[kind]);
    d->at += CACHE_PART_BYTES;
    return read_records(d, kind, n, p);
}

static SheenStatus read_file(Decoder *d, SheenCacheFile *file)
{
    SheenStatus status = check_frame(d);
    if (status != SHEEN_OK) return status;
    file->scene_hash = cache_get_u64(d->data + 24);
    uint32_t n_parts = cache_get_u32(d->data + 12);
    status = read_about(d, file);
    for (uint32_t i = 0; i < n_parts && status == SHEEN_OK; ++i) status = read_part(d, file);
    if (status == SHEEN_OK && d->at != d->size)
        status = refuse(d, "%llu bytes follow the records", (unsigned long long)(d->size - d->at));
    return status;
}

SheenStatus sheen_cache_file_decode(const char *name, const uint8_t *data, size_t size, const SheenLog *log,
                                    SheenCacheFile **out)
{
    Decoder d = {.name = name, .log = log, .data = data, .size = size, .zstd = ZSTD_createDCtx()};
    *out = calloc(1, sizeof **out);
    SheenStatus status = *out && d.zstd ? read_file(&d, *out) : out_of_memory(&d);
    ZSTD_freeDCtx(d.zstd);
    if (status != SHEEN_OK) sheen_cache_file_destroy(out);
    return status;
}

void sheen_cache_file_destroy(SheenCacheFile **file)
{
    if (!file || !*file) return;
    for (int i = 0; i < SHEEN_CACHE_PARTS; ++i) {
        free((*file)->parts[i].records);
        free((*file)->parts[i].light);
    }
    free((*file)->about);
    free(*file);
    *file = NULL;
}
