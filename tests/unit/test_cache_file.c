// SPDX-License-Identifier: Apache-2.0
// Cache files: what is written comes back bit by bit, and look-ups give the same bits.
#include "cache_kit.h"

#include "math/frame.h"

#include <xxhash.h>

enum { POINTS = 500 };

static KitCaches from_file(const SheenCacheFile *file)
{
    KitCaches k = kit_caches(0, 0, 0);
    assert_int_equal(sheen_cache_file_append_irradiance(file, k.irradiance), SHEEN_OK);
    for (int b = 0; b < SHEEN_BASIS_COUNT; ++b)
        assert_int_equal(sheen_cache_file_append_radiance(file, k.radiance[b]), SHEEN_OK);
    return k;
}

static void assert_same_records(const SheenRecordStore *a, const SheenRecordStore *b)
{
    assert_int_equal(a->n, b->n);
    if (a->n) assert_memory_equal(a->records, b->records, a->n * sizeof *a->records);
}

static void assert_same_bits(const KitCaches *a, const KitCaches *b)
{
    assert_same_records(a->irradiance->store, b->irradiance->store);
    size_t n = a->irradiance->store->n;
    if (n) assert_memory_equal(a->irradiance->light, b->irradiance->light, n * sizeof *a->irradiance->light);
    for (int i = 0; i < SHEEN_BASIS_COUNT; ++i) {
        const SheenRadianceCache *x = a->radiance[i], *y = b->radiance[i];
        assert_same_records(x->store, y->store);
        if (x->store->n)
            assert_memory_equal(x->light, y->light, x->store->n * radiance_light_floats(x) * sizeof *x->light);
    }
}

static void test_round_trip(void **state)
{
    (void)state;
    // 528 irradiance records make a block: none, one, a block, one more, and several with a rest.
    static const uint32_t sizes[][3] = {{0, 0, 0}, {1, 1, 1}, {528, 70, 0}, {529, 0, 110}, {1300, 150, 117}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i) {
        KitCaches made = kit_caches(sizes[i][0], sizes[i][1], sizes[i][2]);
        KitBytes bytes = kit_encode(&made.contents);
        SheenCacheFile *file = kit_decode(bytes);
        assert_true(file->scene_hash == made.contents.scene_hash);
        assert_string_equal(file->about, made.contents.about);
        for (int p = 0; p < SHEEN_CACHE_PARTS; ++p) {
            const SheenCachePart *part = &file->parts[p];
            assert_true(part->held && part->neighbor_clamping && part->accuracy == KIT_ACCURACY);
            assert_int_equal(part->n, sizes[i][p]);
        }
        assert_int_equal(file->parts[SHEEN_CACHE_PART_HSH].order, 5);
        assert_int_equal(file->parts[SHEEN_CACHE_PART_SH].order, 4);
        KitCaches read = from_file(file);
        assert_same_bits(&made, &read);
        KitBytes again = kit_encode(&read.contents);
        assert_int_equal(again.size, bytes.size);
        assert_memory_equal(again.data, bytes.data, bytes.size);
        free(bytes.data);
        free(again.data);
        sheen_cache_file_destroy(&file);
        assert_null(file);
        kit_caches_free(&made);
        kit_caches_free(&read);
    }
}

static Rgb look_up_irradiance(const SheenIrradianceCache *c, uint32_t i, unsigned *met)
{
    Vec3 p = kit_point(i), n = kit_normal(i);
    Contributors found;
    sheen_store_find(c->store, p, n, &found);
    *met += found.n;
    return sheen_irradiance_interpolate(c->store, c->light, &found, p, n);
}

static Rgb look_up_radiance(const SheenRadianceCache *c, uint32_t i)
{
    Vec3 p = kit_point(i), n = kit_normal(i);
    Rgb lobe[16];
    for (uint32_t k = 0; k < 16; ++k) lobe[k] = rgb_gray(kit_unit(i, 50 + k));
    Contributors found;
    sheen_store_find(c->store, p, n, &found);
    return sheen_radiance_reflect(c, &found, p, n, &(RadianceLobe){4, lobe});
}

// The caches that were written, once indexed anew, and those that are read say the same.
static void test_look_ups_give_the_same_bits(void **state)
{
    (void)state;
    KitCaches made = kit_caches(1300, 300, 300);
    KitBytes bytes = kit_encode(&made.contents);
    SheenCacheFile *file = kit_decode(bytes);
    KitCaches read = from_file(file);
    assert_int_equal(sheen_store_reindex(made.irradiance->store), SHEEN_OK);
    for (int b = 0; b < SHEEN_BASIS_COUNT; ++b)
        assert_int_equal(sheen_store_reindex(made.radiance[b]->store), SHEEN_OK);
    unsigned met = 0, bright = 0;
    for (uint32_t i = 2000; i < 2000 + POINTS; ++i) {
        Rgb a = look_up_irradiance(made.irradiance, i, &met), b = look_up_irradiance(read.irradiance, i, &met);
        assert_memory_equal(&a, &b, sizeof a);
        for (int k = 0; k < SHEEN_BASIS_COUNT; ++k) {
            a = look_up_radiance(made.radiance[k], i);
            b = look_up_radiance(read.radiance[k], i);
            assert_memory_equal(&a, &b, sizeof a);
            bright += !rgb_is_black(a);
        }
    }
    assert_true(met > 2 * POINTS && bright > POINTS / 2); // the comparison is about something
    free(bytes.data);
    sheen_cache_file_destroy(&file);
    kit_caches_free(&made);
    kit_caches_free(&read);
}

static void test_parts_that_are_not_there(void **state)
{
    (void)state;
    KitCaches made = kit_caches(20, 10, 5);
    made.contents.irradiance = NULL;
    made.contents.radiance[SHEEN_BASIS_HSH] = NULL;
    KitBytes bytes = kit_encode(&made.contents);
    SheenCacheFile *file = kit_decode(bytes);
    assert_true(!file->parts[SHEEN_CACHE_PART_IRRADIANCE].held && !file->parts[SHEEN_CACHE_PART_HSH].held);
    KitCaches read = from_file(file);
    assert_int_equal(read.irradiance->store->n, 0);
    assert_int_equal(read.radiance[SHEEN_BASIS_HSH]->store->n, 0);
    assert_int_equal(read.radiance[SHEEN_BASIS_SH]->store->n, 5);
    free(bytes.data);
    sheen_cache_file_destroy(&file);
    kit_caches_free(&made);
    kit_caches_free(&read);
}

static void test_records_of_files_add_up(void **state)
{
    (void)state;
    KitCaches made = kit_caches(30, 20, 10);
    // Radii that clamping would change: those of files whose records have never met.
    made.irradiance->store->records[7].R *= 0.01f;
    made.radiance[SHEEN_BASIS_SH]->store->records[3].R *= 0.01f;
    KitBytes bytes = kit_encode(&made.contents);
    SheenCacheFile *file = kit_decode(bytes);
    KitCaches read = from_file(file);
    assert_int_equal(sheen_cache_file_append_irradiance(file, read.irradiance), SHEEN_OK);
    assert_int_equal(sheen_cache_file_append_radiance(file, read.radiance[SHEEN_BASIS_SH]), SHEEN_OK);
    assert_int_equal(read.irradiance->store->n, 60);
    assert_int_equal(read.radiance[SHEEN_BASIS_SH]->store->n, 20);
    const Record *two = read.irradiance->store->records, *one = made.irradiance->store->records;
    assert_memory_equal(two, one, 30 * sizeof *one);
    assert_memory_equal(two + 30, one, 30 * sizeof *one);
    two = read.radiance[SHEEN_BASIS_SH]->store->records, one = made.radiance[SHEEN_BASIS_SH]->store->records;
    assert_memory_equal(two, one, 10 * sizeof *one);
    assert_memory_equal(two + 10, one, 10 * sizeof *one);
    free(bytes.data);
    sheen_cache_file_destroy(&file);
    kit_caches_free(&made);
    kit_caches_free(&read);
}

// Records of order 5 in caches of order 3 and 7: the bands that both have stay, others are dropped or zero.
static void test_other_orders(void **state)
{
    (void)state;
    KitCaches made = kit_caches(0, 25, 0);
    KitBytes bytes = kit_encode(&made.contents);
    SheenCacheFile *file = kit_decode(bytes);
    for (unsigned order = 3; order <= 7; order += 4) {
        SheenRadianceCache *c = kit_radiance(SHEEN_BASIS_HSH, order);
        const SheenRadianceCache *from = made.radiance[SHEEN_BASIS_HSH];
        assert_int_equal(sheen_cache_file_append_radiance(file, c), SHEEN_OK);
        assert_int_equal(c->store->n, 25);
        for (uint32_t i = 0; i < 25; ++i)
            for (size_t part = 0; part < 3; ++part)
                for (size_t k = 0; k < c->stride; ++k) {
                    float got = c->light[i * radiance_light_floats(c) + part * c->stride + k], want = 0.0f;
                    if (k < 3 * basis_size(order < 5 ? order : 5))
                        want = from->light[i * radiance_light_floats(from) + part * from->stride + k];
                    assert_true(got == want);
                }
        sheen_radiance_cache_destroy(&c);
    }
    free(bytes.data);
    sheen_cache_file_destroy(&file);
    kit_caches_free(&made);
}

static void test_records_that_are_not_finite(void **state)
{
    (void)state;
    KitCaches made = kit_caches(40, 20, 0);
    made.irradiance->light[3].E.g = NAN;
    made.irradiance->light[39].rotation[2].z = INFINITY;
    made.irradiance->store->records[7].R = INFINITY;
    made.radiance[SHEEN_BASIS_HSH]->light[5] = -INFINITY;
    made.radiance[SHEEN_BASIS_HSH]->store->records[1].error = NAN;
    KitBytes bytes;
    KitLines lines = {0};
    SheenLog log = {kit_keep_line, &lines};
    assert_int_equal(sheen_cache_file_encode("a.shc", &made.contents, &log, &bytes.data, &bytes.size), SHEEN_OK);
    assert_int_equal(lines.warnings, 1);
    assert_string_equal(lines.last, "a.shc: 5 records with numbers that are not finite are left out");
    SheenCacheFile *file = kit_decode(bytes);
    assert_int_equal(file->parts[SHEEN_CACHE_PART_IRRADIANCE].n, 37);
    assert_int_equal(file->parts[SHEEN_CACHE_PART_HSH].n, 18);
    // The others keep their order.
    const Record *r = file->parts[SHEEN_CACHE_PART_IRRADIANCE].records;
    assert_memory_equal(r, made.irradiance->store->records, 3 * sizeof *r);
    assert_memory_equal(r + 3, made.irradiance->store->records + 4, 3 * sizeof *r);
    assert_memory_equal(r + 6, made.irradiance->store->records + 8, 31 * sizeof *r);
    free(bytes.data);
    sheen_cache_file_destroy(&file);
    kit_caches_free(&made);
}

// The layout as docs/cache-files.md tells it, read by its table alone.
static void test_layout(void **state)
{
    (void)state;
    KitCaches made = kit_caches(1, 0, 0);
    made.contents.about = "{\"a\":1}";
    made.contents.radiance[SHEEN_BASIS_SH] = NULL;
    KitBytes b = kit_encode(&made.contents);
    static const uint8_t head[] = {
        0x89, 'S',  'H',  'C',  '\r', '\n', 0x1a, '\n',                                    // what it is
        4,    0,    0,    0,    2,    0,    0,    0,                                       // version, parts
        0,    0,    0,    0,    0,    0,    0,    0,                                       // bytes, set below
        0xef, 0xcd, 0xab, 0x89, 0x67, 0x45, 0x23, 0x01,                                    // scene
        7,    0,    0,    0,    0,    0,    0,    0,    '{', '"', 'a', '"', ':', '1', '}', // description
        0,    0,    0,    0,    0,    0,    0,    0,    1,   0,   0,   0, // irradiance, no order, clamped
        0x9a, 0x99, 0x19, 0x3e, 0,    0,    0x80, 0xbf, 1,   0,   0,   0, // 0.15, -1, one record
        27,   0,    0,    0,                                              // of so many floats of light
    };
    uint8_t want[sizeof head];
    memcpy(want, head, sizeof head);
    for (unsigned i = 0; i < 8; ++i) want[16 + i] = (uint8_t)((uint64_t)b.size >> 8 * i);
    assert_true(b.size > sizeof head);
    assert_memory_equal(b.data, want, sizeof want);
    const uint8_t *block = b.data + sizeof head;
    size_t packed = block[0] | (size_t)block[1] << 8;
    static const uint8_t zstd_magic[] = {0x28, 0xb5, 0x2f, 0xfd};
    assert_memory_equal(block + 4, zstd_magic, sizeof zstd_magic);
    static const uint8_t hsh[] = {1,    0,    0, 0, 5,    0,    0, 0, 1, 0, 0,   0, 0x9a, 0x99,
                                  0x19, 0x3e, 0, 0, 0x80, 0xbf, 0, 0, 0, 0, 225, 0, 0,    0};
    assert_memory_equal(block + 4 + packed, hsh, sizeof hsh);
    assert_int_equal(sizeof head + 4 + packed + sizeof hsh + 8, b.size);
    uint64_t sum = 0;
    for (unsigned i = 0; i < 8; ++i) sum |= (uint64_t)b.data[b.size - 8 + i] << 8 * i;
    assert_true(sum == XXH3_64bits(b.data, b.size - 8));
    free(b.data);
    kit_caches_free(&made);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_look_ups_give_the_same_bits),
        cmocka_unit_test(test_parts_that_are_not_there),
        cmocka_unit_test(test_records_of_files_add_up),
        cmocka_unit_test(test_other_orders),
        cmocka_unit_test(test_records_that_are_not_finite),
        cmocka_unit_test(test_layout),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
