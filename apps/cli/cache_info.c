// SPDX-License-Identifier: Apache-2.0
#include "cache_info.h"

#include "cli.h"
#include "json_text.h"

/** Where the records are, and their radii: least, mean and largest. */
static void add_extent(json_t *object, const SheenCachePart *part)
{
    Bounds bounds = bounds_empty();
    double sum = 0.0, lo = INFINITY, hi = 0.0;
    for (uint32_t i = 0; i < part->n; ++i) {
        const Record *r = &part->records[i];
        double R = (double)r->R;
        bounds.lo = v3_min(bounds.lo, r->p);
        bounds.hi = v3_max(bounds.hi, r->p);
        sum += R;
        lo = R < lo ? R : lo;
        hi = R > hi ? R : hi;
    }
    if (part->n == 0) return;
    json_object_set_new(object, "radius", json_pack("[f, f, f]", lo, sum / part->n, hi));
    json_object_set_new(object, "bounds", json_bounds(&bounds));
}

static json_t *part_json(SheenCachePartKind kind, const SheenCachePart *part)
{
    if (!part->held) return json_null();
    json_t *object = json_pack("{s:I}", "records", (json_int_t)part->n);
    if (kind != SHEEN_CACHE_PART_IRRADIANCE) json_object_set_new(object, "order", json_integer(part->order));
    // Hemispherical records serve points with other normals, or only their own.
    if (kind == SHEEN_CACHE_PART_HSH) json_object_set_new(object, "tilted", json_boolean(part->cos_min < 0.0f));
    json_object_set_new(object, "accuracy", json_real(cli_decimal(part->accuracy)));
    json_object_set_new(object, "neighbor_clamping", json_boolean(part->neighbor_clamping));
    add_extent(object, part);
    return object;
}

json_t *cache_info_json(const char *path, const SheenCacheFile *file)
{
    return json_pack("{s:o, s:s, s:i, s:o, s:o, s:o, s:o, s:o}", "file", json_text(path), "kind", "cache", "version",
                     SHEEN_CACHE_FILE_VERSION, "scene_hash", json_hash(file->scene_hash), "made_with",
                     json_loads(file->about, 0, NULL), "irradiance",
                     part_json(SHEEN_CACHE_PART_IRRADIANCE, &file->parts[SHEEN_CACHE_PART_IRRADIANCE]), "radiance_hsh",
                     part_json(SHEEN_CACHE_PART_HSH, &file->parts[SHEEN_CACHE_PART_HSH]), "radiance_sh",
                     part_json(SHEEN_CACHE_PART_SH, &file->parts[SHEEN_CACHE_PART_SH]));
}
