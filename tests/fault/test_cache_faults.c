// SPDX-License-Identifier: Apache-2.0
// Broken cache files are refused as a whole with one line; a writer that is stopped leaves the old file whole.
#include "cache_kit.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <xxhash.h>
#include <zstd.h>

// Where things are in the file of `small`.
enum { VERSION = 8, PARTS = 12, BYTES = 16, ABOUT = 32, RESERVED = 36, DESCRIPTION = 40 };
enum { KIND = 0, ORDER = 4, FLAGS = 8, ACCURACY = 12, COS_MIN = 16, COUNT = 20, FLOATS = 24, BLOCK = 28 };

static KitBytes small(void)
{
    KitCaches made = kit_caches(4, 2, 0);
    KitBytes b = kit_encode(&made.contents);
    kit_caches_free(&made);
    return b;
}

static size_t first_part(KitBytes b)
{
    return DESCRIPTION + b.data[ABOUT];
}

static void put_u32(uint8_t *p, uint32_t x)
{
    for (unsigned i = 0; i < 4; ++i) p[i] = (uint8_t)(x >> 8 * i);
}
static void put_f32(uint8_t *p, float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    put_u32(p, bits);
}

// Makes length and checksum right, so that only what lies within is wrong.
static void seal(KitBytes b)
{
    for (unsigned i = 0; i < 8; ++i) b.data[BYTES + i] = (uint8_t)((uint64_t)b.size >> 8 * i);
    uint64_t sum = XXH3_64bits(b.data, b.size - 8);
    for (unsigned i = 0; i < 8; ++i) b.data[b.size - 8 + i] = (uint8_t)(sum >> 8 * i);
}

static SheenStatus refused(const uint8_t *data, size_t size, const char *why)
{
    // A copy of exactly this size, so that a sanitizer sees what reads beyond.
    uint8_t *copy = malloc(size ? size : 1);
    assert_non_null(copy);
    if (size) memcpy(copy, data, size);
    KitLines lines = {0};
    SheenLog log = {kit_keep_line, &lines};
    SheenCacheFile *file = (void *)&lines;
    SheenStatus status = sheen_cache_file_decode("bad.shc", copy, size, &log, &file);
    free(copy);
    assert_int_not_equal(status, SHEEN_OK);
    assert_null(file);
    assert_int_equal(lines.errors, 1);
    assert_int_equal(lines.warnings, 0);
    if (strncmp(lines.last, "bad.shc: ", 9) != 0 || !strstr(lines.last, why))
        fail_msg("'%s' does not say '%s'", lines.last, why);
    return status;
}

static void test_truncated_at_each_length(void **state)
{
    (void)state;
    KitBytes b = small();
    for (size_t n = 0; n < b.size; ++n)
        refused(b.data, n, n == 0 ? "is empty" : n < 48 ? "ends in its header" : "is cut off");
    free(b.data);
}

static void test_each_byte_flipped(void **state)
{
    (void)state;
    KitBytes b = small();
    for (size_t i = 0; i < b.size; ++i)
        for (unsigned bit = 0; bit < 8; ++bit) {
            b.data[i] ^= (uint8_t)(1u << bit);
            refused(b.data, b.size, i < 8 ? "not a cache file" : i < 12 ? "of version" : "");
            b.data[i] ^= (uint8_t)(1u << bit);
        }
    SheenCacheFile *file = kit_decode(b); // all is as before
    sheen_cache_file_destroy(&file);
    free(b.data);
}

static void test_other_versions(void **state)
{
    (void)state;
    KitBytes b = small();
    static const uint32_t versions[] = {0, 2, 3, 5, 17, UINT32_MAX};
    for (size_t i = 0; i < sizeof versions / sizeof *versions; ++i) {
        put_u32(b.data + VERSION, versions[i]);
        seal(b);
        assert_int_equal(refused(b.data, b.size, "this program reads version 4"), SHEEN_ERR_UNSUPPORTED);
    }
    free(b.data);
}

static void test_more_than_the_file(void **state)
{
    (void)state;
    KitBytes b = small();
    b.data = realloc(b.data, b.size + 100);
    assert_non_null(b.data);
    memset(b.data + b.size, 0, 100);
    refused(b.data, b.size + 100, "goes on after its end, by 100 bytes");
    b.size += 100; // the same as part of the file
    seal(b);
    refused(b.data, b.size, "100 bytes follow the records");
    free(b.data);
}

// Sets four bytes of the file.
static void wrong(size_t at, uint32_t value, const char *why)
{
    KitBytes b = small();
    put_u32(b.data + at, value);
    seal(b);
    refused(b.data, b.size, why);
    free(b.data);
}
static void wrong_float(size_t at, float value, const char *why)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    wrong(at, bits, why);
}

static void test_wrong_headers(void **state)
{
    (void)state;
    KitBytes b = small();
    size_t part = first_part(b);
    free(b.data);
    wrong(PARTS, 4, "ends before its records do");
    wrong(PARTS, UINT32_MAX, "ends before its records do");
    wrong(PARTS, 1, "bytes follow the records");
    wrong(PARTS, 0, "bytes follow the records");
    wrong(RESERVED, 1, "where there should be none");
    wrong(ABOUT, UINT32_MAX, "description of 4294967295 bytes");
    wrong(ABOUT, 1u << 20, "description of 1048576 bytes");
    wrong(ABOUT, 3, "no JSON object");
    wrong(ABOUT, 0, "no JSON object");
    wrong(DESCRIPTION, 0, "no JSON object");
    const char *numbers = "numbers that no cache can have";
    wrong(part + KIND, 3, "kind 3");
    wrong(part + KIND, UINT32_MAX, "kind 4294967295");
    wrong(part + KIND, 1, numbers); // radiance of order 0
    wrong(part + ORDER, 1, numbers);
    wrong(part + FLAGS, 2, numbers);
    wrong(part + FLOATS, 20, numbers);
    wrong(part + FLOATS, UINT32_MAX, numbers);
    wrong_float(part + ACCURACY, 0.0f, numbers);
    wrong_float(part + ACCURACY, 1.5f, numbers);
    wrong_float(part + ACCURACY, NAN, numbers);
    wrong_float(part + COS_MIN, -2.0f, numbers);
    wrong_float(part + COS_MIN, NAN, numbers);
    wrong(part + COUNT, 3, "another size");
    wrong(part + COUNT, 0, "");
    // Counts that no file of this size can hold are refused before anything is allocated for them.
    wrong(part + COUNT, UINT32_MAX, "another size");
    wrong(part + BLOCK, UINT32_MAX, "ends before its irradiance records do");
    wrong(part + BLOCK, 0, "another size");
    wrong(part + BLOCK + 4, 0, "another size"); // no longer a frame of Zstandard
}

static void test_wrong_radiance_headers(void **state)
{
    (void)state;
    KitBytes b = small();
    size_t part = first_part(b) + BLOCK;
    part += 4 + (b.data[part] | (size_t)b.data[part + 1] << 8);
    free(b.data);
    const char *numbers = "numbers that no cache can have";
    wrong(part + KIND, 0, "kind 0, unknown or met twice");
    wrong(part + ORDER, 0, numbers);
    wrong(part + ORDER, 6, numbers);
    wrong(part + ORDER, SHEEN_ORDER_MAX + 1, numbers);
    wrong(part + ORDER, UINT32_MAX, numbers);
    wrong(part + FLOATS, 9 * 16, numbers);
    wrong(part + COUNT, 72, "another size");
}

// A file of one irradiance record with these numbers.
static KitBytes file_of(const float row[41])
{
    KitCaches made = kit_caches(0, 0, 0);
    made.contents.radiance[0] = made.contents.radiance[1] = NULL;
    KitBytes b = kit_encode(&made.contents);
    uint8_t bytes[4 * 41], packed[1000];
    for (size_t i = 0; i < 41; ++i) put_f32(bytes + 4 * i, row[i]);
    size_t n = ZSTD_compress(packed, sizeof packed, bytes, sizeof bytes, 1);
    assert_false(ZSTD_isError(n));
    put_u32(b.data + first_part(b) + COUNT, 1);
    b.data = realloc(b.data, b.size + 4 + n);
    assert_non_null(b.data);
    put_u32(b.data + b.size - 8, (uint32_t)n);
    memcpy(b.data + b.size - 4, packed, n);
    b.size += 4 + n;
    seal(b);
    kit_caches_free(&made);
    return b;
}

static void test_wrong_records(void **state)
{
    (void)state;
    const float good[41] = {0, 0, 0, 0, 0, 1, 1, 0.5f, 1, 0.5f, 0.15f, 0.5f, 0, 0, 3, 3, 3};
    static const struct {
        size_t at;
        float value;
    } cases[] = {{0, NAN},      {2, INFINITY}, {3, 1},    {3, NAN},  {6, -1},        {6, NAN},
                 {6, INFINITY}, {7, INFINITY}, {8, NAN},  {9, -1},   {10, 0},        {10, 2},
                 {10, NAN},     {11, 1},       {12, NAN}, {34, NAN}, {40, -INFINITY}};
    KitBytes b = file_of(good); // the file is right but for what follows
    SheenCacheFile *file = kit_decode(b);
    assert_int_equal(file->parts[SHEEN_CACHE_PART_IRRADIANCE].n, 1);
    assert_true(file->parts[SHEEN_CACHE_PART_IRRADIANCE].records[0].R_min == 0.5f);
    sheen_cache_file_destroy(&file);
    free(b.data);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        float row[41];
        memcpy(row, good, sizeof row);
        row[cases[i].at] = cases[i].value;
        b = file_of(row);
        refused(b.data, b.size, "irradiance record 0 has numbers that no record can have");
        free(b.data);
    }
}

// Blocks of other frames that claim the right size.
static void test_blocks_that_do_not_unpack(void **state)
{
    (void)state;
    KitBytes b = small();
    size_t at = first_part(b) + BLOCK, n = b.data[at] | (size_t)b.data[at + 1] << 8, refusals = 0;
    for (size_t i = at + 4 + 12; i < at + 4 + n; ++i) {
        KitLines lines = {0};
        SheenLog log = {kit_keep_line, &lines};
        SheenCacheFile *file = NULL;
        b.data[i] ^= 0x55;
        seal(b);
        SheenStatus status = sheen_cache_file_decode("bad.shc", b.data, b.size, &log, &file);
        assert_int_equal(lines.errors, status != SHEEN_OK);
        assert_true((file == NULL) == (status != SHEEN_OK)); // other numbers may be fine ones
        refusals += status != SHEEN_OK;
        sheen_cache_file_destroy(&file);
        b.data[i] ^= 0x55;
    }
    assert_true(refusals > 10);
    free(b.data);
}

// ---- the disk ---------------------------------------------------------------------------------------------------

static char path[300];

static int make_path(void **state)
{
    (void)state;
    const char *base = getenv("TMPDIR");
    char dir[200];
    snprintf(dir, sizeof dir, "%s/sheen-cache-XXXXXX", base ? base : "/tmp");
    if (!mkdtemp(dir)) return -1;
    snprintf(path, sizeof path, "%s/a.shc", dir);
    return 0;
}

static int remove_path(void **state)
{
    (void)state;
    char command[400];
    *strrchr(path, '/') = 0;
    snprintf(command, sizeof command, "rm -r '%s'", path);
    return system(command);
}

static void test_files_that_cannot_be_read(void **state)
{
    (void)state;
    KitLines lines = {0};
    SheenLog log = {kit_keep_line, &lines};
    SheenCacheFile *file = NULL;
    assert_int_equal(sheen_cache_file_read(path, &log, &file), SHEEN_ERR_IO);
    assert_int_equal(sheen_cache_file_read("/", &log, &file), SHEEN_ERR_IO);
    assert_int_equal(lines.errors, 2);
    assert_null(file);
}

// @return how many irradiance records the file has that is there
static uint32_t records_there(void)
{
    KitLines lines = {0};
    SheenLog log = {kit_keep_line, &lines};
    SheenCacheFile *file = NULL;
    if (sheen_cache_file_read(path, &log, &file) != SHEEN_OK) fail_msg("%s", lines.last);
    uint32_t n = file->parts[SHEEN_CACHE_PART_IRRADIANCE].n;
    sheen_cache_file_destroy(&file);
    return n;
}

/** A limit on the size of files stands for a full disk: write() fails half way. */
static void test_disk_is_full(void **state)
{
    (void)state;
    KitCaches old = kit_caches(4, 0, 0), larger = kit_caches(500, 100, 0);
    assert_int_equal(sheen_cache_file_write(path, &old.contents, NULL), SHEEN_OK);
    pid_t child = fork();
    if (child == 0) {
        signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &(struct rlimit){4096, 4096});
        KitLines lines = {0};
        SheenLog log = {kit_keep_line, &lines};
        SheenStatus status = sheen_cache_file_write(path, &larger.contents, &log);
        _exit(status == SHEEN_ERR_IO && lines.errors == 1 && strstr(lines.last, "a.shc: ") ? 0 : 1);
    }
    int code = 0;
    assert_int_equal(waitpid(child, &code, 0), child);
    assert_true(WIFEXITED(code) && WEXITSTATUS(code) == 0);
    assert_int_equal(records_there(), 4);
    kit_caches_free(&old);
    kit_caches_free(&larger);
}

/** A child writes two files in turn until it is killed, at many moments: one of the two is there each time, whole. */
static void test_killed_while_writing(void **state)
{
    (void)state;
    KitCaches a = kit_caches(3000, 100, 0), b = kit_caches(3001, 120, 0);
    assert_int_equal(sheen_cache_file_write(path, &a.contents, NULL), SHEEN_OK);
    unsigned met[2] = {0};
    for (useconds_t round = 0; round < 40; ++round) {
        pid_t child = fork();
        assert_true(child >= 0);
        while (child == 0)
            if (sheen_cache_file_write(path, &b.contents, NULL) != SHEEN_OK ||
                sheen_cache_file_write(path, &a.contents, NULL) != SHEEN_OK)
                _exit(1);
        usleep(2000 + 613 * round); // a file takes some milliseconds
        kill(child, SIGKILL);
        int code = 0;
        assert_int_equal(waitpid(child, &code, 0), child);
        assert_true(WIFSIGNALED(code));
        uint32_t n = records_there();
        assert_in_range(n, 3000, 3001);
        ++met[n - 3000];
    }
    assert_true(met[0] + met[1] == 40);
    kit_caches_free(&a);
    kit_caches_free(&b);
}

int main(void)
{
#define ON_DISK(test) cmocka_unit_test_setup_teardown(test, make_path, remove_path)
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_truncated_at_each_length),
        cmocka_unit_test(test_each_byte_flipped),
        cmocka_unit_test(test_other_versions),
        cmocka_unit_test(test_more_than_the_file),
        cmocka_unit_test(test_wrong_headers),
        cmocka_unit_test(test_wrong_radiance_headers),
        cmocka_unit_test(test_wrong_records),
        cmocka_unit_test(test_blocks_that_do_not_unpack),
        ON_DISK(test_files_that_cannot_be_read),
        ON_DISK(test_disk_is_full),
        ON_DISK(test_killed_while_writing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
