// SPDX-License-Identifier: Apache-2.0
// Small scenes through the builder and their pictures, for the tests of the path integrator. Include after cmocka.h.
#ifndef SHEEN_TESTS_PATH_KIT_H
#define SHEEN_TESTS_PATH_KIT_H

#include "base/clock.h"
#include "integrator/work.h"
#include "scene/builder.h"

#include <stdio.h>
#include <string.h>

static void kit_log(void *user, SheenLogLevel level, const char *text)
{
    (void)user;
    if (level == SHEEN_LOG_ERROR) fprintf(stderr, "%s\n", text);
}
static const SheenLog kit_log_sink = {kit_log, NULL};

static inline SheenBuilder *kit_begin(void)
{
    SheenBuilder *b = NULL;
    assert_int_equal(sheen_builder_create(&kit_log_sink, "kit", &b), SHEEN_OK);
    return b;
}

static inline uint32_t kit_material(SheenBuilder *b, SheenMaterialKind kind, float albedo, float ior)
{
    SheenMaterial m = {.kind = kind,
                       .reflectance = sheen_texture_constant(rgb_gray(albedo)),
                       .specular_reflectance = sheen_texture_constant(rgb_gray(1.0f)),
                       .specular_transmittance = sheen_texture_constant(rgb_gray(1.0f)),
                       .eta = rgb_gray(0.0f),
                       .k = rgb_gray(1.0f),
                       .ior = ior,
                       .name = "kit"};
    return sheen_builder_add_material(b, &m);
}
static inline uint32_t kit_diffuse(SheenBuilder *b, float albedo)
{
    return kit_material(b, SHEEN_MATERIAL_DIFFUSE, albedo, 1.0f);
}
/** A mirror that reflects all. */
static inline uint32_t kit_mirror(SheenBuilder *b)
{
    return kit_material(b, SHEEN_MATERIAL_CONDUCTOR, 0.0f, 1.0f);
}

static inline uint32_t kit_sphere(SheenBuilder *b, Vec3 center, float radius, bool flip, uint32_t material)
{
    SheenShape s = {.kind = SHEEN_SHAPE_SPHERE, .material = material, .light = SHEEN_NONE, .name = "sphere"};
    s.sphere = (SheenSphere){center, radius, flip, frame_from_normal(v3(0, 0, 1))};
    return sheen_builder_add_shape(b, &s);
}

/** A disk about `center` with unit normal n, the front side. */
static inline uint32_t kit_disk(SheenBuilder *b, Vec3 center, float radius, Vec3 n, uint32_t material)
{
    Frame f = frame_from_normal(n);
    SheenShape s = {.kind = SHEEN_SHAPE_DISK, .material = material, .light = SHEEN_NONE, .name = "disk"};
    s.disk = (SheenDisk){center, v3_scale(f.t, radius), v3_scale(f.b, radius), n};
    return sheen_builder_add_shape(b, &s);
}

/** The parallelogram p + u e1 + v e2 as two triangles; e1 x e2 is the front side. */
static inline uint32_t kit_quad(SheenBuilder *b, Vec3 p, Vec3 e1, Vec3 e2, uint32_t material)
{
    SheenArena *arena = sheen_builder_arena(b);
    Vec3 *points = SHEEN_ARENA_NEW(arena, Vec3, 5);
    Vec2 *uv = SHEEN_ARENA_NEW(arena, Vec2, 4);
    uint32_t(*triangles)[3] = sheen_arena_alloc(arena, 2, sizeof *triangles);
    assert_true(points && uv && triangles);
    memcpy(points, (Vec3[]){p, v3_add(p, e1), v3_add(v3_add(p, e1), e2), v3_add(p, e2)}, 4 * sizeof *points);
    memcpy(uv, (Vec2[]){{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 4 * sizeof *uv);
    memcpy(triangles, (uint32_t[2][3]){{0, 1, 2}, {0, 2, 3}}, 2 * sizeof *triangles);
    SheenShape s = {.kind = SHEEN_SHAPE_MESH, .material = material, .light = SHEEN_NONE, .name = "quad"};
    s.mesh = (SheenMesh){4, 2, points, NULL, uv, (const uint32_t(*)[3])triangles, NULL, NULL};
    return sheen_builder_add_shape(b, &s);
}

/** The six inner walls of the cube [-1, 1]^3, each emitting `radiance` when it is not 0. */
static inline void kit_box(SheenBuilder *b, uint32_t material, float radiance)
{
    static const Vec3 axis[3] = {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
    for (int a = 0; a < 3; ++a) {
        Vec3 e1 = axis[(a + 1) % 3], e2 = axis[(a + 2) % 3];
        uint32_t lower = kit_quad(b, v3(-1, -1, -1), e1, e2, material);
        uint32_t upper = kit_quad(b, v3_add(v3(-1, -1, -1), axis[a]), e2, e1, material);
        if (radiance == 0.0f) continue;
        sheen_builder_add_area_light(b, lower, rgb_gray(radiance));
        sheen_builder_add_area_light(b, upper, rgb_gray(radiance));
    }
}

static inline void kit_constant_environment(SheenBuilder *b, Rgb radiance)
{
    SheenLight light = {.kind = SHEEN_LIGHT_ENVIRONMENT,
                        .radiance = radiance,
                        .shape = SHEEN_NONE,
                        .to_world = transform_identity(),
                        .to_light = transform_identity()};
    sheen_builder_add_light(b, &light);
}

static inline void kit_camera(SheenBuilder *b, Vec3 origin, Vec3 target, Vec3 up, float fov_x)
{
    SheenCamera c = {
        .name = "camera", .to_world = transform_look_at(origin, target, up), .fov_x = fov_x, .width = 32, .height = 32};
    sheen_builder_add_camera(b, &c);
}

/** What a picture is made from; renders any number of them. */
typedef struct Kit {
    SheenScene *scene;
    SheenPool *pool;
    SheenAccel *accel;
    SheenLights *lights;
    SheenWork work; // width, height and options may be changed before each render
} Kit;

static inline void kit_end(SheenBuilder *b, unsigned threads, Kit *kit)
{
    *kit = (Kit){0};
    assert_int_equal(sheen_builder_commit(&b, &kit->scene), SHEEN_OK);
    assert_int_equal(sheen_pool_create(threads, &kit->pool), SHEEN_OK);
    assert_int_equal(sheen_accel_create(kit->scene, kit->pool, &kit_log_sink, &kit->accel), SHEEN_OK);
    assert_int_equal(sheen_lights_create(kit->scene, SHEEN_ENVIRONMENT_WHOLE, &kit_log_sink, &kit->lights), SHEEN_OK);
    kit->work = (SheenWork){.scene = kit->scene,
                            .accel = kit->accel,
                            .lights = kit->lights,
                            .camera = &kit->scene->cameras[0],
                            .width = kit->scene->cameras[0].width,
                            .height = kit->scene->cameras[0].height,
                            .options = sheen_options_default(),
                            .pool = kit->pool,
                            .log = &kit_log_sink};
}

static inline void kit_free(Kit *kit)
{
    sheen_lights_destroy(&kit->lights);
    sheen_accel_destroy(&kit->accel);
    sheen_pool_destroy(&kit->pool);
    sheen_scene_destroy(&kit->scene);
}

/** @param aovs  as for sheen_film_create; free the film with sheen_film_destroy. */
static inline SheenFilm *kit_render(const Kit *kit, unsigned aovs, SheenStats *stats)
{
    SheenFilm *film = NULL;
    SheenStats local = {0};
    assert_int_equal(sheen_film_create(kit->work.width, kit->work.height, aovs, &film), SHEEN_OK);
    assert_int_equal(sheen_path_render(&kit->work, film, stats ? stats : &local), SHEEN_OK);
    assert_int_equal((stats ? stats : &local)->nonfinite_samples, 0);
    return film;
}

/** Mean and standard error of the green channel over a picture whose pixels all have the same expectation. */
typedef struct KitMean {
    double mean, error, worst; // worst: largest deviation of a pixel from `expected`
} KitMean;

static inline KitMean kit_mean(const SheenFilm *film, double expected)
{
    size_t n = (size_t)film->width * film->height;
    double sum = 0.0, sum2 = 0.0, worst = 0.0;
    for (size_t i = 0; i < n; ++i) {
        double v = (double)film->color[i].g, deviation = fabs(v - expected);
        sum += v;
        sum2 += v * v;
        if (!(deviation <= worst)) worst = deviation;
    }
    double mean = sum / (double)n, variance = sum2 / (double)n - mean * mean;
    return (KitMean){mean, sqrt((variance > 0.0 ? variance : 0.0) / (double)n), worst};
}

/**
 * Asserts that the mean of the picture is `expected`: within 4.5 standard errors, which a right estimator misses once
 * in 150,000 seeds, and a relative slack for rounding and for the extent of the picture. The standard error itself must
 * stay below `sharp` x expected, so that a noisy picture does not pass for a right one.
 */
static inline void kit_assert_mean(const SheenFilm *film, double expected, double slack, double sharp, const char *what)
{
    KitMean m = kit_mean(film, expected);
    bool ok = fabs(m.mean - expected) <= 4.5 * m.error + slack * expected && m.error <= sharp * expected;
    if (!ok) fprintf(stderr, "%s: mean %.7g, expected %.7g, standard error %.2g\n", what, m.mean, expected, m.error);
    assert_true(ok);
}

#endif
