// SPDX-License-Identifier: Apache-2.0
// Failures of the world: one line with the file's name and the reason, nothing left behind, an old file untouched.
#include "image/image.h"

#include <dirent.h>
#include <errno.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static char dir[200]; // made for each test

static int make_dir(void **state)
{
    (void)state;
    const char *base = getenv("TMPDIR");
    snprintf(dir, sizeof dir, "%s/sheen-faults-XXXXXX", base ? base : "/tmp");
    return mkdtemp(dir) ? 0 : -1;
}

static int count_entries(void)
{
    int n = 0;
    DIR *d = opendir(dir);
    assert_non_null(d);
    for (struct dirent *e; (e = readdir(d));) n += e->d_name[0] != '.';
    closedir(d);
    return n;
}

static int remove_dir(void **state)
{
    (void)state;
    char path[600];
    DIR *d = opendir(dir);
    for (struct dirent *e; d && (e = readdir(d));) {
        if (e->d_name[0] == '.') continue;
        snprintf(path, sizeof path, "%s/%s", dir, e->d_name);
        remove(path);
    }
    if (d) closedir(d);
    return rmdir(dir);
}

typedef struct Lines {
    int n;
    char last[1024];
} Lines;

static void keep_line(void *user, SheenLogLevel level, const char *text)
{
    (void)level;
    Lines *lines = user;
    ++lines->n;
    snprintf(lines->last, sizeof lines->last, "%s", text);
}

/** Writes noise of 64 x 64 pixels, which no format makes smaller than 8 kB, and checks the line of the failure. */
static SheenStatus write_noise(const char *path, Lines *lines)
{
    static Rgb pixels[64 * 64];
    uint32_t h = 1;
    for (size_t i = 0; i < 3 * 64 * 64; ++i) {
        h = h * 1664525u + 1013904223u;
        (&pixels[0].r)[i] = (float)(h >> 8) * 0x1p-24f;
    }
    SheenImageView view = {.width = 64, .height = 64, .pixels = pixels};
    SheenLog log = {keep_line, lines};
    return sheen_image_write(path, &view, 0.0f, &log);
}

static void expect_failure(const char *path, SheenStatus want, const char *reason)
{
    Lines lines = {0};
    assert_int_equal(write_noise(path, &lines), want);
    assert_int_equal(lines.n, 1);
    assert_memory_equal(lines.last, path, strlen(path));
    assert_non_null(strstr(lines.last, reason));
}

static const char *in_dir(const char *name)
{
    static char path[600];
    snprintf(path, sizeof path, "%s/%s", dir, name);
    return path;
}

static void test_unknown_ending(void **state)
{
    (void)state;
    expect_failure(in_dir("a.jpg"), SHEEN_ERR_UNSUPPORTED, ".exr");
    expect_failure(in_dir("a"), SHEEN_ERR_UNSUPPORTED, ".exr");
    assert_false(sheen_image_writable_format("a.jpg") || sheen_image_writable_format("exr"));
    assert_true(sheen_image_writable_format("a.EXR") && sheen_image_writable_format("dir/a.b.png"));
    assert_int_equal(count_entries(), 0);
}

static void test_path_is_a_directory(void **state)
{
    (void)state;
    assert_int_equal(mkdir(in_dir("taken.exr"), 0777), 0);
    expect_failure(in_dir("taken.exr"), SHEEN_ERR_IO, strerror(EISDIR));
    assert_int_equal(count_entries(), 1);
}

static void test_directory_is_missing(void **state)
{
    (void)state;
    expect_failure(in_dir("none/a.exr"), SHEEN_ERR_IO, strerror(ENOENT));
}

/** Root may write anywhere, so that a child gives its rights away first. */
static void test_directory_is_not_writable(void **state)
{
    (void)state;
    assert_int_equal(chmod(dir, 0555), 0);
    pid_t child = fork();
    if (child == 0) {
        if (geteuid() == 0 && setuid(65534) != 0) _exit(3);
        Lines lines = {0};
        bool good = write_noise(in_dir("a.exr"), &lines) == SHEEN_ERR_IO && lines.n == 1 &&
                    strstr(lines.last, strerror(EACCES)) != NULL;
        _exit(good ? 0 : 1);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    chmod(dir, 0777);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    assert_int_equal(count_entries(), 0);
}

/** A limit on the size of files stands for a full disk: write() fails half way. */
static void test_disk_is_full(void **state)
{
    (void)state;
    static const char *const names[] = {"a.exr", "a.hdr", "a.pfm", "a.png"};
    for (int i = 0; i < 4; ++i) {
        const char *path = in_dir(names[i]);
        FILE *old = fopen(path, "w");
        assert_non_null(old);
        fputs("old", old);
        fclose(old);
        pid_t child = fork();
        if (child == 0) {
            signal(SIGXFSZ, SIG_IGN);
            setrlimit(RLIMIT_FSIZE, &(struct rlimit){4096, 4096});
            Lines lines = {0};
            bool good = write_noise(path, &lines) == SHEEN_ERR_IO && lines.n == 1 && strstr(lines.last, path) &&
                        strstr(lines.last, strerror(EFBIG));
            _exit(good ? 0 : 1);
        }
        int status = 0;
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
        assert_int_equal(count_entries(), i + 1); // no temporary file
        char content[8] = {0};
        old = fopen(path, "r");
        assert_non_null(old);
        assert_int_equal(fread(content, 1, sizeof content, old), 3);
        fclose(old);
        assert_string_equal(content, "old");
    }
}

// The sanitizers keep terabytes of addresses for themselves, so that no limit can be put on them.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LIMITS_WORK 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define LIMITS_WORK 0
#endif
#endif
#ifndef LIMITS_WORK
#define LIMITS_WORK 1
#endif

/** @return the bytes of addresses that this process uses. */
static rlim_t used_addresses(void)
{
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    assert_non_null(file);
    assert_int_equal(fscanf(file, "%lu", &pages), 1);
    fclose(file);
    return (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE);
}

/** Runs `work` in a child that can have only `more` bytes beyond what it has. @return its value */
static int run_limited(rlim_t more, int (*work)(void))
{
    pid_t child = fork();
    if (child == 0) {
        rlim_t limit = used_addresses() + more;
        setrlimit(RLIMIT_AS, &(struct rlimit){limit, limit});
        _exit(work());
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

/** A header that claims 3 GB, in a file just long enough to be believed. */
static int read_too_large(void)
{
    static char file[20000] = "#?RADIANCE\n\n-Y 16384 +X 16384\n";
    Lines lines = {0};
    SheenLog log = {keep_line, &lines};
    SheenImage image;
    SheenStatus status = sheen_image_decode(file, sizeof file, "large.hdr", &log, &image);
    return status == SHEEN_ERR_NOMEM && lines.n == 1 && !strcmp(lines.last, "large.hdr: out of memory") ? 0 : 1;
}

static Rgb many_pixels[1024 * 1024];

static int write_too_large(void)
{
    static const char *const names[] = {"a.pfm", "a.exr", "a.hdr", "a.png"};
    uint32_t h = 1; // noise, which no format makes small
    for (size_t i = 0; i < 3 * 1024 * 1024; ++i) {
        h = h * 1664525u + 1013904223u;
        (&many_pixels[0].r)[i] = (float)(h >> 8) * 0x1p-24f;
    }
    for (int i = 0; i < 4; ++i) {
        Lines lines = {0};
        SheenLog log = {keep_line, &lines};
        SheenImageView view = {.width = 1024, .height = 1024, .pixels = many_pixels};
        const char *path = in_dir(names[i]);
        SheenStatus status = sheen_image_write(path, &view, 0.0f, &log);
        if (status != SHEEN_ERR_NOMEM || lines.n != 1 || !strstr(lines.last, "out of memory")) return 1 + i;
    }
    return 0;
}

static void test_memory_is_short(void **state)
{
    (void)state;
    if (!LIMITS_WORK) skip();
    assert_int_equal(run_limited((rlim_t)1 << 30, read_too_large), 0);
    assert_int_equal(run_limited((rlim_t)2 << 20, write_too_large), 0);
    assert_int_equal(count_entries(), 0);
}

static void test_impossible_views(void **state)
{
    (void)state;
    Rgb pixel = {0};
    SheenImageView empty = {.width = 0, .height = 1, .pixels = &pixel};
    assert_int_equal(sheen_image_write(in_dir("a.exr"), &empty, 0.0f, NULL), SHEEN_ERR_INVALID);
    float value = 0.0f;
    SheenLayer twice[] = {{"depth", 1, "Z", &value}, {"depth", 1, "Z", &value}};
    SheenImageView doubled = {.width = 1, .height = 1, .pixels = &pixel, .layers = twice, .n_layers = 2};
    assert_int_equal(sheen_image_write(in_dir("a.exr"), &doubled, 0.0f, NULL), SHEEN_ERR_INVALID);
    SheenAttribute reserved = {"compression", "much"};
    SheenImageView odd = {.width = 1, .height = 1, .pixels = &pixel, .attributes = &reserved, .n_attributes = 1};
    assert_int_equal(sheen_image_write(in_dir("a.exr"), &odd, 0.0f, NULL), SHEEN_ERR_INVALID);
    assert_int_equal(count_entries(), 0);
}

int main(void)
{
#define IN_DIR(test) cmocka_unit_test_setup_teardown(test, make_dir, remove_dir)
    const struct CMUnitTest tests[] = {
        IN_DIR(test_unknown_ending),       IN_DIR(test_path_is_a_directory),
        IN_DIR(test_directory_is_missing), IN_DIR(test_directory_is_not_writable),
        IN_DIR(test_disk_is_full),         IN_DIR(test_memory_is_short),
        IN_DIR(test_impossible_views),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
