// SPDX-License-Identifier: Apache-2.0
// The records of caches in a file, so that a later picture of the same scene need not gather them again.
// docs/cache-files.md tells the layout.
#ifndef SHEEN_CACHE_CACHE_FILE_H
#define SHEEN_CACHE_CACHE_FILE_H

#include "base/log.h"
#include "cache/irradiance_cache.h"
#include "cache/radiance_cache.h"

#include <stddef.h>

/** Version of the layout; a file of another is refused. */
enum { SHEEN_CACHE_FILE_VERSION = 4 };

/** What a file is made from; all is borrowed. */
typedef struct SheenCacheContents {
    uint64_t scene_hash;                                   // of the scene that the records are of
    const char *about;                                     // a JSON object: what else the records depend on
    const SheenIrradianceCache *irradiance;                // NULL for none
    const SheenRadianceCache *radiance[SHEEN_BASIS_COUNT]; // NULL for none
} SheenCacheContents;

/** The caches that a file has room for. */
typedef enum SheenCachePartKind {
    SHEEN_CACHE_PART_IRRADIANCE,
    SHEEN_CACHE_PART_HSH, // radiance, one a basis: SHEEN_CACHE_PART_HSH + basis
    SHEEN_CACHE_PART_SH,
    SHEEN_CACHE_PARTS
} SheenCachePartKind;

/** One cache of a file. */
typedef struct SheenCachePart {
    bool held;              // whether the file has this part; all else is zero otherwise
    bool neighbor_clamping; // of the store that the records were in
    float accuracy;         // of that store
    float cos_min;          // of that store
    unsigned order;         // of radiance, 1..SHEEN_ORDER_MAX; 0 of irradiance
    uint32_t n;             // records
    size_t light_floats;    // of one record: 27 as in IrradianceLight; 3 parts of [order * order] Rgb
    Record *records;        // [n]
    float *light;           // [n][light_floats]
} SheenCachePart;

/** A file in memory, all of it checked. */
typedef struct SheenCacheFile {
    uint64_t scene_hash;
    char *about; // a JSON object
    SheenCachePart parts[SHEEN_CACHE_PARTS];
} SheenCacheFile;

/**
 * Writes a file with all records in their order, with the radii that they have now. It appears whole or not at all, and
 * replaces one of the same name only when it is whole. Records with numbers that are not finite are left out, with a
 * warning: nothing could be made of them.
 * Errors: SHEEN_ERR_IO, SHEEN_ERR_NOMEM; SHEEN_ERR_INVALID where `about` is over 1 MiB or the file over 4 GiB long.
 */
SHEEN_NODISCARD SheenStatus sheen_cache_file_write(const char *path, const SheenCacheContents *contents,
                                                   const SheenLog *log);

/** The bytes of such a file. @param name  for messages @param data  from malloc, owned by the caller */
SHEEN_NODISCARD SheenStatus sheen_cache_file_encode(const char *name, const SheenCacheContents *contents,
                                                    const SheenLog *log, uint8_t **data, size_t *size);

/**
 * Reads a file. Everything is checked before any of it is given out: what is damaged, of another version, or holds what
 * no cache does, is refused as a whole.
 * @param out  owned by the caller, to be destroyed; NULL on failure
 * Errors: SHEEN_ERR_IO, SHEEN_ERR_PARSE, SHEEN_ERR_UNSUPPORTED for another version, SHEEN_ERR_NOMEM, with one line
 * `FILE: why`.
 */
SHEEN_NODISCARD SheenStatus sheen_cache_file_read(const char *path, const SheenLog *log, SheenCacheFile **out);

/** The same from memory. @param name  for messages */
SHEEN_NODISCARD SheenStatus sheen_cache_file_decode(const char *name, const uint8_t *data, size_t size,
                                                    const SheenLog *log, SheenCacheFile **out);
void sheen_cache_file_destroy(SheenCacheFile **file);

/**
 * Appends the file's irradiance records, if any, to those of a cache, in their order. Their radii stay as they are:
 * they were clamped when the records were made. Errors: SHEEN_ERR_NOMEM; some are appended then.
 */
SHEEN_NODISCARD SheenStatus sheen_cache_file_append_irradiance(const SheenCacheFile *file, SheenIrradianceCache *cache);

/** The same of the radiance records in the cache's basis. Of another order they are cut, or filled up with zeros: the
 *  lower bands are the same functions in all orders. */
SHEEN_NODISCARD SheenStatus sheen_cache_file_append_radiance(const SheenCacheFile *file, SheenRadianceCache *cache);

#endif
