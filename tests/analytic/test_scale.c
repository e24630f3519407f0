// SPDX-License-Identifier: Apache-2.0
// A scene looks the same in millimetres and in kilometres, and wherever it stands.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "analytic/irradiance_kit.h"
#include "io/load.h"

static Vec3 moved(Vec3 p, float scale, Vec3 shift)
{
    return v3_mad(shift, scale, p);
}

static void copy_mesh(SheenBuilder *b, const SheenMesh *mesh, float scale, Vec3 shift, SheenShape *out)
{
    SheenArena *arena = sheen_builder_arena(b);
    Vec3 *p = SHEEN_ARENA_NEW(arena, Vec3, mesh->n_vertices + 1);
    uint32_t(*triangles)[3] = sheen_arena_alloc(arena, mesh->n_triangles, sizeof *triangles);
    assert_true(p && triangles && !mesh->n);
    for (uint32_t i = 0; i < mesh->n_vertices; ++i) p[i] = moved(mesh->p[i], scale, shift);
    p[mesh->n_vertices] = v3(0, 0, 0);
    memcpy(triangles, mesh->triangles, mesh->n_triangles * sizeof *triangles);
    out->mesh.p = p;
    out->mesh.uv = NULL;
    out->mesh.triangles = (const uint32_t(*)[3])triangles;
}

/** The bundled Cornell box at another size and place. */
static Stage box(float scale, Vec3 shift)
{
    SheenScene *scene = NULL;
    assert_int_equal(sheen_scene_load(SHEEN_TEST_SOURCE_DIR "/scenes/cornell-box.xml", &kit_log_sink, &scene),
                     SHEEN_OK);
    SheenBuilder *b = kit_begin();
    for (uint32_t i = 0; i < scene->n_materials; ++i) {
        SheenMaterial m = scene->materials[i];
        m.name = "paint";
        sheen_builder_add_material(b, &m);
    }
    for (uint32_t i = 0; i < scene->n_shapes; ++i) {
        SheenShape s = scene->shapes[i];
        assert_int_equal(s.kind, SHEEN_SHAPE_MESH);
        copy_mesh(b, &scene->shapes[i].mesh, scale, shift, &s);
        uint32_t light = s.light;
        s.name = "wall";
        s.light = SHEEN_NONE;
        uint32_t shape = sheen_builder_add_shape(b, &s);
        if (light != SHEEN_NONE) sheen_builder_add_area_light(b, shape, scene->lights[light].radiance);
    }
    SheenCamera c = scene->cameras[0];
    const double s[3] = {(double)shift.x, (double)shift.y, (double)shift.z};
    for (int i = 0; i < 3; ++i) c.to_world.m[i][3] = s[i] + (double)scale * c.to_world.m[i][3];
    c.name = "front";
    sheen_builder_add_camera(b, &c);
    sheen_scene_destroy(&scene);
    return stage_end(b, 1);
}

static SheenFilm *picture(float scale, Vec3 shift, SheenIntegrator integrator)
{
    Stage stage = box(scale, shift);
    SheenRenderSettings settings = small_settings(3);
    settings.integrator = integrator;
    settings.width = settings.height = 64;
    if (integrator == SHEEN_INTEGRATOR_PATH) settings.options.spp = 16;
    SheenFilm *film = stage_render(&stage, &settings, NULL);
    stage_free(&stage);
    return film;
}

/** How far a picture may be from the one at its own size and place: the mean, and blocks, root mean square. */
typedef struct Slack {
    double mean, blocks;
} Slack;

static void compare(float scale, Vec3 shift, Slack path, Slack irradiance)
{
    for (int integrator = 0; integrator < 2; ++integrator) {
        SheenIntegrator which = integrator ? SHEEN_INTEGRATOR_PATH : SHEEN_INTEGRATOR_IRRADIANCE;
        SheenFilm *a = picture(1.0f, v3(0, 0, 0), which), *b = picture(scale, shift, which);
        Slack slack = integrator ? path : irradiance;
        double off = film_mean(b) / film_mean(a) - 1.0;
        BlockDifference d = film_blocks(b, a);
        show("%s x %g: mean off by %.2g, blocks by %.2g rms, %.2g worst\n", integrator ? "path" : "irradiance",
             (double)scale, off, d.rms, d.worst);
        assert_true(fabs(off) <= slack.mean);
        assert_true(d.rms <= slack.blocks);
        sheen_film_destroy(&a);
        sheen_film_destroy(&b);
    }
}

// Every length is multiplied by a power of two, which rounds nothing: all that the renderer computes is multiplied
// too, and the picture keeps its bits, unless a length is compared with one that does not belong to the scene.
static const Slack nothing = {0.0, 0.0};

static void test_powers_of_two(void **state)
{
    (void)state;
    compare(0x1p-13f, v3(0, 0, 0), nothing, nothing);
    compare(0x1p10f, v3(0, 0, 0), nothing, nothing);
}

// Records that stand elsewhere, since a point was just covered or just not, make blocks differ by 0.01 to 0.016 and the
// mean by up to 0.0008, as another seed does: twice that.
static const Slack other_records = {2e-3, 0.03};

// Rounding alone: 1e-7 in the mean and in blocks where no path changes, a hundred times as much where some do.
static void test_any_scale(void **state)
{
    (void)state;
    const Slack rounding = {1e-5, 1e-5};
    compare(1e-4f, v3(0, 0, 0), rounding, other_records);
    compare(1e-3f, v3(0, 0, 0), rounding, other_records);
    compare(1e3f, v3(0, 0, 0), rounding, other_records);
}

// A kilometre away coordinates are known to 0.06 mm, so that many paths meet another surface: the mean then differs by
// 3e-4 and blocks by 0.002, which is noise. The old fixed distance would do ten times that.
static void test_anywhere(void **state)
{
    (void)state;
    const Slack noise = {1e-3, 5e-3};
    compare(1.0f, v3(100, -50, 20), noise, other_records);
    compare(1.0f, v3(1000, 0, -700), noise, other_records);
    compare(1e-3f, v3(1, -0.7f, 0.2f), noise, other_records);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_powers_of_two), cmocka_unit_test(test_any_scale),
                                       cmocka_unit_test(test_anywhere)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
