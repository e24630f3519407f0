// SPDX-License-Identifier: Apache-2.0
// What tests of cache files share: caches of any numbers, their bytes, and a log that keeps its last line.
#ifndef SHEEN_TESTS_CACHE_KIT_H
#define SHEEN_TESTS_CACHE_KIT_H

#include "base/hash.h"
#include "cache/cache_file.h"
#include "math/frame.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const Bounds kit_box = {{-1.0f, -1.0f, -1.0f}, {1.0f, 1.0f, 1.0f}};
#define KIT_ACCURACY 0.15f

/** Lines of a log. */
typedef struct KitLines {
    int errors, warnings;
    char last[1024];
} KitLines;

static inline void kit_keep_line(void *user, SheenLogLevel level, const char *text)
{
    KitLines *lines = user;
    lines->errors += level == SHEEN_LOG_ERROR;
    lines->warnings += level == SHEEN_LOG_WARNING;
    snprintf(lines->last, sizeof lines->last, "%s", text);
}

static inline float kit_unit(uint32_t i, uint32_t use)
{
    return hash_to_unit(hash_combine(i, use));
}

// On a floor, with about the same normal: records meet each other.
static inline Vec3 kit_point(uint32_t i)
{
    return v3(2.0f * kit_unit(i, 0) - 1.0f, 2.0f * kit_unit(i, 1) - 1.0f, 0.01f * kit_unit(i, 2));
}
static inline Vec3 kit_normal(uint32_t i)
{
    return v3_normalize(v3(0.2f * kit_unit(i, 3) - 0.1f, 0.2f * kit_unit(i, 4) - 0.1f, 1.0f));
}

static inline Record kit_record(uint32_t i)
{
    float R = 0.3f * expf(2.0f * kit_unit(i, 5));
    return (Record){.p = kit_point(i),
                    .n = kit_normal(i),
                    .R = R,
                    .a = KIT_ACCURACY * (1.0f - 0.2f * kit_unit(i, 8)),
                    .R_min = R * kit_unit(i, 6),
                    .R_sure = i % 5 ? R : INFINITY, // of a record that sees nothing but sky
                    .error = kit_unit(i, 7),
                    .stretch = record_stretch(frame_from_normal(kit_normal(i)).t, 1.0f + kit_unit(i, 9))};
}

static inline SheenIrradianceCache *kit_irradiance(void)
{
    SheenIrradianceCache *c = NULL;
    assert_int_equal(sheen_irradiance_cache_create(KIT_ACCURACY, true, &kit_box, &c), SHEEN_OK);
    return c;
}
static inline void kit_fill_irradiance(SheenIrradianceCache *c, uint32_t n)
{
    for (uint32_t i = 0; i < n; ++i) {
        Record r = kit_record(i);
        IrradianceLight light;
        for (uint32_t k = 0; k < sizeof light / sizeof(float); ++k) (&light.E.r)[k] = kit_unit(i, 10 + k);
        assert_int_equal(sheen_irradiance_cache_insert(c, &r, &light), SHEEN_OK);
    }
}

static inline SheenRadianceCache *kit_radiance(SheenBasis basis, unsigned order)
{
    SheenRadianceCache *c = NULL;
    assert_int_equal(
        sheen_radiance_cache_create(basis, order, basis == SHEEN_BASIS_HSH, KIT_ACCURACY, true, &kit_box, &c),
        SHEEN_OK);
    return c;
}
static inline void kit_fill_radiance(SheenRadianceCache *c, uint32_t n)
{
    float *light = calloc(radiance_light_floats(c), sizeof *light);
    assert_non_null(light);
    for (uint32_t i = 0; i < n; ++i) {
        Record r = kit_record(i + 1000);
        for (uint32_t part = 0; part < 3; ++part)
            for (uint32_t k = 0; k < 3 * basis_size(c->order); ++k)
                light[part * c->stride + k] = kit_unit(i, 100 + 10000 * part + k) - 0.3f;
        assert_int_equal(sheen_radiance_cache_insert(c, &r, light), SHEEN_OK);
    }
    free(light);
}

/** Caches of all kinds, and what a file of them is made from. */
typedef struct KitCaches {
    SheenIrradianceCache *irradiance;
    SheenRadianceCache *radiance[SHEEN_BASIS_COUNT];
    SheenCacheContents contents;
} KitCaches;

static inline void kit_caches_name(KitCaches *k)
{
    k->contents = (SheenCacheContents){.scene_hash = 0x0123456789abcdefu,
                                       .about = "{\"integrator\": \"radiance\", \"seed\": 7}",
                                       .irradiance = k->irradiance,
                                       .radiance = {k->radiance[0], k->radiance[1]}};
}
static inline KitCaches kit_caches(uint32_t n_irradiance, uint32_t n_hsh, uint32_t n_sh)
{
    KitCaches k = {.irradiance = kit_irradiance(),
                   .radiance = {kit_radiance(SHEEN_BASIS_HSH, 5), kit_radiance(SHEEN_BASIS_SH, 4)}};
    kit_fill_irradiance(k.irradiance, n_irradiance);
    kit_fill_radiance(k.radiance[SHEEN_BASIS_HSH], n_hsh);
    kit_fill_radiance(k.radiance[SHEEN_BASIS_SH], n_sh);
    kit_caches_name(&k);
    return k;
}
static inline void kit_caches_free(KitCaches *k)
{
    sheen_irradiance_cache_destroy(&k->irradiance);
    for (int b = 0; b < SHEEN_BASIS_COUNT; ++b) sheen_radiance_cache_destroy(&k->radiance[b]);
}

/** The bytes of a file, for free(). */
typedef struct KitBytes {
    uint8_t *data;
    size_t size;
} KitBytes;

static inline KitBytes kit_encode(const SheenCacheContents *contents)
{
    KitBytes b;
    KitLines lines = {0};
    SheenLog log = {kit_keep_line, &lines};
    assert_int_equal(sheen_cache_file_encode("kit.shc", contents, &log, &b.data, &b.size), SHEEN_OK);
    assert_int_equal(lines.errors + lines.warnings, 0);
    return b;
}

static inline SheenCacheFile *kit_decode(KitBytes b)
{
    SheenCacheFile *file = NULL;
    KitLines lines = {0};
    SheenLog log = {kit_keep_line, &lines};
    if (sheen_cache_file_decode("kit.shc", b.data, b.size, &log, &file) != SHEEN_OK) fail_msg("%s", lines.last);
    assert_int_equal(lines.errors + lines.warnings, 0);
    return file;
}

#endif
