// SPDX-License-Identifier: Apache-2.0
// The reader of cache files on any bytes, as they are and with their length and checksum made right: no crash, one line
// for a refusal, and what it lets through is written and read again as it is.
#include "cache/cache_layout.h"
#include "errors.h"

#include <stdlib.h>

#include <xxhash.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static SheenCacheFile *decode(const uint8_t *data, size_t size)
{
    int errors = 0;
    SheenLog log = {count_errors, &errors};
    SheenCacheFile *file;
    SheenStatus status = sheen_cache_file_decode("fuzz.shc", data, size, &log, &file);
    if ((status == SHEEN_OK) != (errors == 0) || errors > 1 || (status == SHEEN_OK) != (file != NULL)) abort();
    return file;
}

// Puts the file's records into caches, looks some up, writes them, and reads that.
static void use(const SheenCacheFile *file)
{
    enum { ORDER = 3 };
    const Bounds bounds = {{-1, -1, -1}, {1, 1, 1}};
    SheenIrradianceCache *irradiance = NULL;
    SheenRadianceCache *radiance = NULL;
    uint8_t *data = NULL;
    size_t size = 0;
    if (sheen_irradiance_cache_create(0.2f, true, &bounds, &irradiance) == SHEEN_OK &&
        sheen_radiance_cache_create(SHEEN_BASIS_HSH, ORDER, false, 0.2f, true, &bounds, &radiance) == SHEEN_OK &&
        sheen_cache_file_append_irradiance(file, irradiance) == SHEEN_OK &&
        sheen_cache_file_append_radiance(file, radiance) == SHEEN_OK) {
        for (uint32_t i = 0; i < irradiance->store->n && i < 8; ++i) {
            const Record *r = &irradiance->store->records[i];
            Contributors found;
            sheen_store_find(irradiance->store, r->p, r->n, &found);
            sheen_irradiance_interpolate(irradiance->store, irradiance->light, &found, r->p, r->n);
        }
        SheenCacheContents contents = {file->scene_hash, file->about, irradiance, {radiance, NULL}};
        if (sheen_cache_file_encode("again.shc", &contents, NULL, &data, &size) == SHEEN_OK) {
            SheenCacheFile *again = decode(data, size);
            for (int p = 0; p <= SHEEN_CACHE_PART_HSH; ++p)
                if (!again || again->parts[p].n != file->parts[p].n) abort();
            sheen_cache_file_destroy(&again);
        }
    }
    free(data);
    sheen_irradiance_cache_destroy(&irradiance);
    sheen_radiance_cache_destroy(&radiance);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    SheenCacheFile *file = decode(data, size);
    sheen_cache_file_destroy(&file);
    if (size < CACHE_HEADER_BYTES + CACHE_CHECKSUM_BYTES) return 0;
    uint8_t *sealed = malloc(size);
    if (!sealed) return 0;
    memcpy(sealed, data, size);
    memcpy(sealed, cache_magic, sizeof cache_magic);
    cache_put_u32(sealed + 8, SHEEN_CACHE_FILE_VERSION);
    cache_put_u64(sealed + 16, size);
    cache_put_u64(sealed + size - CACHE_CHECKSUM_BYTES, XXH3_64bits(sealed, size - CACHE_CHECKSUM_BYTES));
    file = decode(sealed, size);
    if (file) use(file);
    sheen_cache_file_destroy(&file);
    free(sealed);
    return 0;
}
