// SPDX-License-Identifier: Apache-2.0
// What tests of readers share: a folder of their own, a log that remembers, and loading of scenes from text.
#ifndef SHEEN_TESTS_IO_KIT_H
#define SHEEN_TESTS_IO_KIT_H

#include "base/arena.h"
#include "io/load.h"

#include <ftw.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

typedef struct Kit {
    char folder[64];
    SheenLog log;
    int n_errors, n_warnings;
    char error[1024];     // the last
    char warnings[16384]; // all, a line each
    SheenArena *arena;
    SheenScene *scene;
} Kit;

static inline void kit_log(void *user, SheenLogLevel level, const char *text)
{
    Kit *k = user;
    if (level == SHEEN_LOG_ERROR) {
        k->n_errors++;
        snprintf(k->error, sizeof k->error, "%s", text);
    } else if (level == SHEEN_LOG_WARNING) {
        k->n_warnings++;
        size_t n = strlen(k->warnings);
        snprintf(k->warnings + n, sizeof k->warnings - n, "%s\n", text);
    }
}

static inline int kit_set_up(void **state)
{
    Kit *k = calloc(1, sizeof *k);
    if (!k) return 1;
    strcpy(k->folder, "/tmp/sheen-test-XXXXXX");
    k->log = (SheenLog){kit_log, k};
    k->arena = sheen_arena_create();
    *state = k;
    return !mkdtemp(k->folder) || !k->arena;
}

static inline int kit_remove(const char *path, const struct stat *info, int type, struct FTW *ftw)
{
    (void)info, (void)type, (void)ftw;
    return remove(path);
}

static inline int kit_tear_down(void **state)
{
    Kit *k = *state;
    sheen_scene_destroy(&k->scene);
    sheen_arena_destroy(&k->arena);
    nftw(k->folder, kit_remove, 16, FTW_DEPTH | FTW_PHYS);
    free(k);
    return 0;
}

/** Forgets messages and the scene. */
static inline void kit_reset(Kit *k)
{
    sheen_scene_destroy(&k->scene);
    k->n_errors = k->n_warnings = 0;
    k->error[0] = k->warnings[0] = '\0';
}

static inline void kit_path(const Kit *k, const char *name, char out[256])
{
    snprintf(out, 256, "%s/%s", k->folder, name);
}

/** Path of a file of the scene collection: SHEEN_SCENES names its folder, else ../shared/scenes is meant. */
static inline void kit_shared_path(const char *name, char out[512])
{
    const char *folder = getenv("SHEEN_SCENES");
    if (folder)
        snprintf(out, 512, "%s/%s", folder, name);
    else
        snprintf(out, 512, "%s/../shared/scenes/%s", SHEEN_TEST_SOURCE_DIR, name);
}

static inline void kit_write_bytes(const Kit *k, const char *name, const void *data, size_t size)
{
    char path[256];
    kit_path(k, name, path);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(data, 1, size, f), size);
    fclose(f);
}

static inline void kit_write(const Kit *k, const char *name, const char *text)
{
    kit_write_bytes(k, name, text, strlen(text));
}

/** Loads a scene file of the folder into k->scene. */
static inline SheenStatus kit_load(Kit *k, const char *name)
{
    char path[256];
    kit_reset(k);
    kit_path(k, name, path);
    return sheen_scene_load(path, &k->log, &k->scene);
}

/** Loads `body` inside <scene version=...>; body begins on line 2. */
static inline SheenStatus kit_load_version(Kit *k, const char *version, const char *body)
{
    size_t size = strlen(body) + 128;
    char *text = malloc(size);
    assert_non_null(text);
    snprintf(text, size, "<scene version=\"%s\">\n%s\n</scene>\n", version, body);
    kit_write(k, "scene.xml", text);
    free(text);
    return kit_load(k, "scene.xml");
}

/** The scene must load. */
static inline const SheenScene *kit_scene(Kit *k, const char *body)
{
    SheenStatus s = kit_load_version(k, "3.0.0", body);
    if (s) print_message("%s\n", k->error);
    assert_int_equal(s, SHEEN_OK);
    assert_non_null(k->scene);
    return k->scene;
}

/** The scene must be refused with one line that holds `place` (after the folder) and `what`. */
static inline void kit_refused(Kit *k, const char *body, SheenStatus status, const char *place, const char *what)
{
    SheenStatus s = kit_load_version(k, "3.0.0", body);
    char expected[512];
    snprintf(expected, sizeof expected, "%s/%s: ", k->folder, place);
    if (s != status || strncmp(k->error, expected, strlen(expected)) != 0 || !strstr(k->error, what))
        print_message("status %d, said: '%s'\nwanted: %d, '%s...%s'\n", s, k->error, status, expected, what);
    assert_int_equal(s, status);
    assert_null(k->scene);
    assert_int_equal(k->n_errors, 1);
    assert_memory_equal(k->error, expected, strlen(expected));
    assert_non_null(strstr(k->error, what));
}

static inline void kit_assert_v3(Vec3 got, Vec3 want, float eps)
{
    if (!(fabsf(got.x - want.x) <= eps && fabsf(got.y - want.y) <= eps && fabsf(got.z - want.z) <= eps))
        fail_msg("(%g %g %g) is not (%g %g %g)", (double)got.x, (double)got.y, (double)got.z, (double)want.x,
                 (double)want.y, (double)want.z);
}

static inline void kit_assert_rgb(Rgb got, Rgb want, float eps)
{
    kit_assert_v3(v3(got.r, got.g, got.b), v3(want.r, want.g, want.b), eps);
}

#define KIT_TEST(f) cmocka_unit_test_setup_teardown(f, kit_set_up, kit_tear_down)

#endif
