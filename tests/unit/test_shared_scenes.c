// SPDX-License-Identifier: Apache-2.0
// Every scene of the collection loads and holds what its description promises. The collection is not in the
// repository: SHEEN_SCENES names its folder, else ../shared/scenes is tried; what is absent is skipped and counted.
#include "io/file_path.h"
#include "io_kit.h"
#include "scene/builder.h"

typedef struct Expected {
    const char *file;
    uint32_t n_triangles; // in the files, those without area included
    uint32_t n_lights;
} Expected;

static const Expected scenes[] = {
    {"mitsuba/cornell-box/scene.xml", 36, 1},      {"mitsuba/cornell-box/scene_v3.xml", 36, 1},
    {"mitsuba/dining-room/scene.xml", 269538, 2},  {"mitsuba/living-room/scene.xml", 143163, 1},
    {"mitsuba/mitsuba-tutorials/cbox.xml", 12, 1}, {"mitsuba/mitsuba-tutorials/simple.xml", 2256, 2},
    {"mitsuba/staircase2/scene.xml", 30927, 13},   {"mitsuba/staircase2/scene_v3.xml", 30927, 13},
    {"mitsuba/veach-ajar/scene.xml", 382690, 1},   {"mitsuba/veach-ajar/scene_v3.xml", 382690, 1},
    {"mitsuba/veach-bidir/scene.xml", 11544, 2},   {"mitsuba/veach-bidir/scene_v3.xml", 11544, 2},
    {"mitsuba/veach-mis/scene.xml", 52, 3},        {"mitsuba/veach-mis/scene_v3.xml", 52, 3},
};

/** Sums the triangles that the builder's warnings say it left out ("FILE: NAME: 6 of 38 triangles ..."). */
static uint32_t left_out(const Kit *k)
{
    uint32_t sum = 0;
    for (const char *p = k->warnings; (p = strstr(p, " triangles have no area")); ++p) {
        const char *q = p;
        while (q > k->warnings && q[-1] != ':') --q;
        sum += (uint32_t)strtoul(q, NULL, 10);
    }
    return sum;
}

static void check(Kit *k, const Expected *e, const char *path)
{
    kit_reset(k);
    SheenStatus s = sheen_scene_load(path, &k->log, &k->scene);
    if (s) fail_msg("%s", k->error);
    if (k->scene->n_triangles + left_out(k) != e->n_triangles)
        fail_msg("%s: %llu triangles and %u left out, not %u", e->file, (unsigned long long)k->scene->n_triangles,
                 left_out(k), e->n_triangles);
    assert_int_equal(k->scene->n_lights, e->n_lights);
    assert_int_equal(k->scene->n_cameras, 1);
    assert_true(k->scene->cameras[0].spp > 0);
    assert_false(bounds_is_empty(&k->scene->bounds));
}

static void all_load_with_their_triangles_and_lights(void **state)
{
    Kit *k = *state;
    int skipped = 0, n = (int)(sizeof scenes / sizeof *scenes);
    for (int i = 0; i < n; ++i) {
        char path[512];
        kit_shared_path(scenes[i].file, path);
        if (sheen_path_readable(path))
            check(k, &scenes[i], path);
        else
            ++skipped;
    }
    print_message("%d of %d scenes skipped: not there\n", skipped, n);
}

/** The two spellings of one scene give the same shapes. (The materials of staircase2 were edited between them.) */
static void versions_agree(void **state)
{
    Kit *k = *state;
    static const char *const names[] = {"cornell-box", "staircase2", "veach-mis"};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        char path[2][512], file[64];
        for (int j = 0; j < 2; ++j) {
            snprintf(file, sizeof file, "mitsuba/%s/scene%s.xml", names[i], j ? "_v3" : "");
            kit_shared_path(file, path[j]);
        }
        if (!sheen_path_readable(path[0]) || !sheen_path_readable(path[1])) continue;
        kit_reset(k);
        SheenScene *old = NULL;
        assert_int_equal(sheen_scene_load(path[0], &k->log, &old), SHEEN_OK);
        assert_int_equal(sheen_scene_load(path[1], &k->log, &k->scene), SHEEN_OK);
        assert_int_equal(old->n_shapes, k->scene->n_shapes);
        kit_assert_v3(old->bounds.lo, k->scene->bounds.lo, 1e-4f); // six digits in the files
        kit_assert_v3(old->bounds.hi, k->scene->bounds.hi, 1e-4f);
        assert_float_equal(old->cameras[0].fov_x, k->scene->cameras[0].fov_x, 1e-6f);
        for (uint32_t l = 0; l < old->n_lights; ++l)
            kit_assert_rgb(old->lights[l].radiance, k->scene->lights[l].radiance, 1e-3f);
        sheen_scene_destroy(&old);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        KIT_TEST(all_load_with_their_triangles_and_lights),
        KIT_TEST(versions_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
