// SPDX-License-Identifier: Apache-2.0
// The builder: what it keeps, drops, repairs and completes.
#include "scene/builder.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

typedef struct Messages {
    int n_errors, n_warnings;
    char last[256];
} Messages;

static void collect(void *user, SheenLogLevel level, const char *text)
{
    Messages *m = user;
    m->n_errors += level == SHEEN_LOG_ERROR;
    m->n_warnings += level == SHEEN_LOG_WARNING;
    strncpy(m->last, text, sizeof m->last - 1);
}

typedef struct Fixture {
    Messages messages;
    SheenLog log;
    SheenBuilder *builder;
    SheenScene *scene;
} Fixture;

static int set_up(void **state)
{
    static Fixture f;
    f = (Fixture){.log = {collect, &f.messages}};
    *state = &f;
    return sheen_builder_create(&f.log, "test", &f.builder);
}

static int tear_down(void **state)
{
    Fixture *f = *state;
    sheen_builder_destroy(&f->builder);
    sheen_scene_destroy(&f->scene);
    return 0;
}

static const Vec3 square_p[5] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 0}};
static const uint32_t square_t[2][3] = {{0, 1, 2}, {0, 2, 3}};

static SheenShape square(const char *name)
{
    return (SheenShape){
        .kind = SHEEN_SHAPE_MESH,
        .mesh = {.n_vertices = 4, .n_triangles = 2, .p = square_p, .triangles = square_t},
        .name = name,
    };
}

static void add_camera(SheenBuilder *b)
{
    sheen_builder_add_camera(
        b, &(SheenCamera){.name = "c", .to_world = transform_identity(), .fov_x = 1, .width = 8, .height = 8});
}

static uint32_t add_gray(SheenBuilder *b)
{
    return sheen_builder_add_material(b, &(SheenMaterial){.reflectance = sheen_texture_constant(rgb_gray(0.5f))});
}

static void shapes_are_laid_out_by_group_and_lights_follow(void **state)
{
    Fixture *f = *state;
    SheenBuilder *b = f->builder;
    add_gray(b);
    add_camera(b);
    uint32_t group = sheen_builder_begin_group(b);
    SheenShape s = square("in group");
    sheen_builder_add_shape(b, &s);
    sheen_builder_end_group(b);
    s = square("lamp");
    uint32_t lamp = sheen_builder_add_shape(b, &s);
    assert_int_equal(sheen_builder_add_area_light(b, lamp, rgb_gray(1)), 0);
    assert_int_equal(sheen_builder_add_area_light(b, lamp, rgb_gray(2)), 0); // the second replaces the first
    Transform far = transform_translate(10, 0, 0);
    sheen_builder_add_instance(b, group, &far);
    assert_int_equal(sheen_builder_commit(&f->builder, &f->scene), SHEEN_OK);
    assert_null(f->builder);
    const SheenScene *scene = f->scene;
    assert_string_equal(scene->name, "test");
    assert_int_equal(scene->n_shapes, 2);
    assert_string_equal(scene->shapes[0].name, "lamp");
    assert_int_equal(scene->shapes[0].light, 0);
    assert_int_equal(scene->shapes[1].light, SHEEN_NONE);
    assert_int_equal(scene->lights[0].shape, 0);
    assert_float_equal(scene->lights[0].radiance.r, 2.0f, 0.0f);
    assert_int_equal(scene->n_groups, 2);
    assert_int_equal(scene->groups[1].first_shape, 1);
    assert_int_equal(scene->groups[1].n_shapes, 1);
    assert_int_equal(scene->n_triangles, 4);
    assert_int_equal(scene->environment, SHEEN_NONE);
    assert_float_equal(scene->bounds.hi.x, 11.0f, 0.0f);
    assert_float_equal(scene->bounds.lo.x, -1.0f, 0.0f);
    assert_float_equal(transform_point(&scene->instances[0].to_group, v3(10, 0, 0)).x, 0.0f, 1e-6f);
    assert_int_equal(f->messages.n_warnings, 0);
}

static void bad_triangles_are_dropped_with_one_warning(void **state)
{
    Fixture *f = *state;
    static const Vec3 p[10] = {{0, 0, 0}, {1, 0, 0},     {0, 1, 0},     {NAN, 0, 0},   {INFINITY, 0, 0},
                               {2, 0, 0}, {1e25f, 0, 0}, {0, 5e18f, 0}, {0, 0, -5e18f}};
    static const uint32_t t[8][3] = {{0, 1, 2}, {0, 1, 3}, {0, 4, 2}, {0, 1, 5},
                                     {1, 1, 2}, {0, 6, 2}, {0, 1, 7}, {0, 1, 8}};
    SheenShape s = {.mesh = {.n_vertices = 9, .n_triangles = 8, .p = p, .triangles = t}, .name = "bad"};
    add_gray(f->builder);
    sheen_builder_add_shape(f->builder, &s);
    add_camera(f->builder);
    sheen_builder_add_light(f->builder, &(SheenLight){.kind = SHEEN_LIGHT_ENVIRONMENT, .radiance = rgb_gray(1)});
    assert_int_equal(sheen_builder_commit(&f->builder, &f->scene), SHEEN_OK);
    assert_int_equal(f->messages.n_warnings, 1);
    assert_non_null(strstr(f->messages.last, "7 of 8 triangles"));
    assert_int_equal(f->scene->shapes[0].mesh.n_triangles, 1);
    assert_int_equal(f->scene->shapes[0].mesh.triangles[0][2], 2);
    assert_float_equal(f->scene->bounds.hi.x, 1.0f, 0.0f);
    assert_int_equal(f->scene->environment, 0);
}

static void unusable_normals_become_face_normals(void **state)
{
    Fixture *f = *state;
    static const Vec3 n[4] = {{0, 0, 0}, {NAN, 0, 0}, {0, 0.6f, 0.8f}, {0, 0, INFINITY}};
    SheenShape s = square("normals");
    s.mesh.n = n;
    add_gray(f->builder);
    sheen_builder_add_shape(f->builder, &s);
    assert_int_equal(sheen_builder_commit(&f->builder, &f->scene), SHEEN_OK);
    const Vec3 *got = f->scene->shapes[0].mesh.n;
    assert_float_equal(got[0].z, 1.0f, 0.0f);
    assert_float_equal(got[1].z, 1.0f, 0.0f);
    assert_float_equal(got[2].y, 0.6f, 0.0f);
    assert_float_equal(got[3].z, 1.0f, 0.0f);
}

static void empty_shapes_and_their_lights_go(void **state)
{
    Fixture *f = *state;
    add_gray(f->builder);
    SheenShape s = {.kind = SHEEN_SHAPE_SPHERE, .sphere = {.radius = 0.0f}, .name = "point"};
    uint32_t shape = sheen_builder_add_shape(f->builder, &s);
    sheen_builder_add_area_light(f->builder, shape, rgb_gray(1));
    s = (SheenShape){.kind = SHEEN_SHAPE_DISK, .disk = {.du = {1, 0, 0}, .dv = {2, 0, 0}, .n = {0, 0, 1}}};
    sheen_builder_add_shape(f->builder, &s);
    s = square("stays");
    shape = sheen_builder_add_shape(f->builder, &s);
    sheen_builder_add_area_light(f->builder, shape, rgb(-1, NAN, 0)); // cleaned to black, so no light
    assert_int_equal(sheen_builder_commit(&f->builder, &f->scene), SHEEN_OK);
    assert_int_equal(f->scene->n_shapes, 1);
    assert_int_equal(f->scene->n_lights, 0);
    assert_int_equal(f->scene->shapes[0].light, SHEEN_NONE);
    assert_int_equal(f->messages.n_warnings, 5); // two shapes, one radiance, no light, no camera
}

static void default_camera_sees_the_whole_scene(void **state)
{
    Fixture *f = *state;
    add_gray(f->builder);
    SheenShape s = {.kind = SHEEN_SHAPE_SPHERE, .sphere = {.center = {5, 6, 7}, .radius = 2.0f}, .name = "ball"};
    sheen_builder_add_shape(f->builder, &s);
    assert_int_equal(sheen_builder_commit(&f->builder, &f->scene), SHEEN_OK);
    assert_int_equal(f->scene->n_cameras, 1);
    const SheenCamera *c = &f->scene->cameras[0];
    Transform to_camera;
    assert_true(transform_invert(&c->to_world, &to_camera));
    Vec3 p = transform_point(&to_camera, v3(5, 6, 7));
    assert_float_equal(p.x, 0.0f, 1e-5f);
    assert_float_equal(p.y, 0.0f, 1e-5f);
    assert_true(asinf(2.0f / p.z) < 0.5f * c->fov_x);
}

static void lights_are_checked(void **state)
{
    Fixture *f = *state;
    SheenBuilder *b = f->builder;
    add_camera(b);
    SheenLight l = {.kind = SHEEN_LIGHT_DIRECTIONAL, .radiance = rgb_gray(1), .direction = {0, 0, 0}};
    assert_int_equal(sheen_builder_add_light(b, &l), SHEEN_NONE);
    l = (SheenLight){.kind = SHEEN_LIGHT_POINT, .radiance = rgb_gray(1), .position = {NAN, 0, 0}};
    assert_int_equal(sheen_builder_add_light(b, &l), SHEEN_NONE);
    l = (SheenLight){.kind = SHEEN_LIGHT_SPOT, .radiance = rgb_gray(1), .direction = {0, 0, 3}};
    assert_int_equal(sheen_builder_add_light(b, &l), 0);
    l = (SheenLight){.kind = SHEEN_LIGHT_ENVIRONMENT, .radiance = rgb_gray(1)};
    assert_int_equal(sheen_builder_add_light(b, &l), 1);
    l.radiance = rgb_gray(2);
    assert_int_equal(sheen_builder_add_light(b, &l), 1);
    assert_int_equal(f->messages.n_warnings, 3);
    assert_int_equal(sheen_builder_commit(&f->builder, &f->scene), SHEEN_OK);
    assert_float_equal(f->scene->lights[0].direction.z, 1.0f, 0.0f);
    assert_int_equal(f->scene->environment, 1);
    assert_float_equal(f->scene->lights[1].radiance.r, 2.0f, 0.0f);
}

static void indices_out_of_range_are_refused(void **state)
{
    Fixture *f = *state;
    SheenShape s = square("no material");
    sheen_builder_add_shape(f->builder, &s);
    assert_int_equal(sheen_builder_commit(&f->builder, &f->scene), SHEEN_ERR_INVALID);
    assert_null(f->builder);
    assert_null(f->scene);
    assert_int_equal(f->messages.n_errors, 1);

    assert_int_equal(sheen_builder_create(&f->log, "test", &f->builder), SHEEN_OK);
    add_gray(f->builder);
    s = square("index");
    s.mesh.n_vertices = 3;
    sheen_builder_add_shape(f->builder, &s);
    assert_int_equal(sheen_builder_commit(&f->builder, &f->scene), SHEEN_ERR_INVALID);

    assert_int_equal(sheen_builder_create(&f->log, "test", &f->builder), SHEEN_OK);
    Transform t = transform_identity();
    sheen_builder_add_instance(f->builder, 1, &t);
    assert_int_equal(sheen_builder_commit(&f->builder, &f->scene), SHEEN_ERR_INVALID);

    assert_int_equal(sheen_builder_create(&f->log, "test", &f->builder), SHEEN_OK);
    sheen_builder_add_area_light(f->builder, 3, rgb_gray(1));
    assert_int_equal(sheen_builder_commit(&f->builder, &f->scene), SHEEN_ERR_INVALID);
}

static void singular_instances_and_cameras_are_left_out(void **state)
{
    Fixture *f = *state;
    add_gray(f->builder);
    uint32_t group = sheen_builder_begin_group(f->builder);
    SheenShape s = square("g");
    sheen_builder_add_shape(f->builder, &s);
    sheen_builder_end_group(f->builder);
    Transform t = transform_scale(1, 1, 0);
    assert_int_equal(sheen_builder_add_instance(f->builder, group, &t), SHEEN_NONE);
    t = transform_translate(1e30, 0, 0); // regular, but nowhere
    assert_int_equal(sheen_builder_add_instance(f->builder, group, &t), 0);
    SheenCamera c = {.to_world = transform_scale(0, 1, 1), .fov_x = 1, .width = 1, .height = 1};
    assert_int_equal(sheen_builder_add_camera(f->builder, &c), SHEEN_NONE);
    assert_int_equal(sheen_builder_commit(&f->builder, &f->scene), SHEEN_OK);
    assert_int_equal(f->scene->n_instances, 0);
    assert_int_equal(f->scene->n_cameras, 1);
    assert_true(bounds_is_empty(&f->scene->bounds));
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(shapes_are_laid_out_by_group_and_lights_follow),
        TEST(bad_triangles_are_dropped_with_one_warning),
        TEST(unusable_normals_become_face_normals),
        TEST(empty_shapes_and_their_lights_go),
        TEST(default_camera_sees_the_whole_scene),
        TEST(lights_are_checked),
        TEST(indices_out_of_range_are_refused),
        TEST(singular_instances_and_cameras_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
