// SPDX-License-Identifier: Apache-2.0
// Cache files on the disk, and from a file into caches.
#include "cache/cache_file.h"

#include "image/whole_file.h"

#include <stdlib.h>
#include <string.h>

SheenStatus sheen_cache_file_write(const char *path, const SheenCacheContents *contents, const SheenLog *log)
{
    uint8_t *data;
    size_t size;
    SheenStatus status = sheen_cache_file_encode(path, contents, log, &data, &size);
    if (status != SHEEN_OK) return status;
    if (size > SHEEN_FILE_MAX)
        status = sheen_fail(log, SHEEN_ERR_INVALID, "%s: the records take %llu bytes, which is too many for a file",
                            path, (unsigned long long)size);
    else
        status = sheen_file_write(path, data, size, log);
    free(data);
    return status;
}

SheenStatus sheen_cache_file_read(const char *path, const SheenLog *log, SheenCacheFile **out)
{
    *out = NULL;
    uint8_t *data;
    size_t size;
    SheenStatus status = sheen_file_read(path, log, &data, &size);
    if (status == SHEEN_OK) status = sheen_cache_file_decode(path, data, size, log, out);
    free(data);
    return status;
}

SheenStatus sheen_cache_file_append_irradiance(const SheenCacheFile *file, SheenIrradianceCache *cache)
{
    const SheenCachePart *part = &file->parts[SHEEN_CACHE_PART_IRRADIANCE];
    for (uint32_t i = 0; i < part->n; ++i) {
        IrradianceLight light;
        memcpy(&light, part->light + i * part->light_floats, sizeof light);
        SheenStatus status = sheen_irradiance_cache_append(cache, &part->records[i], &light);
        if (status != SHEEN_OK) return status;
    }
    return SHEEN_OK;
}

SheenStatus sheen_cache_file_append_radiance(const SheenCacheFile *file, SheenRadianceCache *cache)
{
    const SheenCachePart *part = &file->parts[SHEEN_CACHE_PART_HSH + (unsigned)cache->basis];
    if (part->n == 0) return SHEEN_OK;
    float *light = calloc(radiance_light_floats(cache), sizeof *light);
    SheenStatus status = light ? SHEEN_OK : SHEEN_ERR_NOMEM;
    unsigned order = part->order < cache->order ? part->order : cache->order;
    size_t n = part->light_floats / 3;
    for (uint32_t i = 0; i < part->n && status == SHEEN_OK; ++i) {
        const float *from = part->light + i * part->light_floats;
        for (size_t k = 0; k < 3; ++k)
            memcpy(light + k * cache->stride, from + k * n, 3 * basis_size(order) * sizeof *light);
        status = sheen_radiance_cache_append(cache, &part->records[i], light);
    }
    free(light);
    return status;
}
