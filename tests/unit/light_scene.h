// SPDX-License-Identifier: Apache-2.0
// Scenes of a few lights for tests, and statistics of their samples.
#ifndef SHEEN_TESTS_UNIT_LIGHT_SCENE_H
#define SHEEN_TESTS_UNIT_LIGHT_SCENE_H

#include "base/hash.h"
#include "light/light.h"
#include "math/warp.h"
#include "scene/builder.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

/** A scene under construction; then the scene and its lights. */
typedef struct LightScene {
    SheenBuilder *builder;
    SheenScene *scene;
    SheenLights *lights;
} LightScene;

static inline LightScene light_scene_begin(void)
{
    LightScene s = {0};
    assert_int_equal(sheen_builder_create(NULL, "test", &s.builder), SHEEN_OK);
    SheenMaterial m = {.kind = SHEEN_MATERIAL_DIFFUSE, .name = "m"};
    sheen_builder_add_material(s.builder, &m);
    return s;
}

static inline void light_scene_end(LightScene *s, SheenEnvironmentSplit split)
{
    assert_int_equal(sheen_builder_commit(&s->builder, &s->scene), SHEEN_OK);
    assert_int_equal(sheen_lights_create(s->scene, split, NULL, &s->lights), SHEEN_OK);
}

static inline void light_scene_destroy(LightScene *s)
{
    sheen_lights_destroy(&s->lights);
    sheen_scene_destroy(&s->scene);
}

static inline void add_shape(LightScene *s, const SheenShape *shape, Rgb radiance)
{
    sheen_builder_add_area_light(s->builder, sheen_builder_add_shape(s->builder, shape), radiance);
}

/** A mesh light; the arrays are copied. */
static inline void add_mesh(LightScene *s, uint32_t n_vertices, const Vec3 p[], uint32_t n_triangles,
                            const uint32_t t[][3], Rgb radiance)
{
    SheenArena *arena = sheen_builder_arena(s->builder);
    Vec3 *vertices = SHEEN_ARENA_NEW(arena, Vec3, n_vertices + 1);
    uint32_t(*triangles)[3] = sheen_arena_alloc(arena, n_triangles, sizeof *triangles);
    memcpy(vertices, p, n_vertices * sizeof *p);
    memcpy(triangles, t, n_triangles * sizeof *t);
    SheenShape shape = {.kind = SHEEN_SHAPE_MESH,
                        .mesh = {.n_vertices = n_vertices,
                                 .n_triangles = n_triangles,
                                 .p = vertices,
                                 .triangles = (const uint32_t(*)[3])triangles},
                        .name = "mesh"};
    add_shape(s, &shape, radiance);
}

/** Two triangles; the front is where the corners run counter-clockwise. */
static inline void add_quad(LightScene *s, const Vec3 corners[4], Rgb radiance)
{
    static const uint32_t t[2][3] = {{0, 1, 2}, {0, 2, 3}};
    add_mesh(s, 4, corners, 2, t, radiance);
}

static inline void add_triangle(LightScene *s, Vec3 a, Vec3 b, Vec3 c, Rgb radiance)
{
    static const uint32_t t[1][3] = {{0, 1, 2}};
    add_mesh(s, 3, (Vec3[]){a, b, c}, 1, t, radiance);
}

static inline void add_sphere(LightScene *s, Vec3 center, float radius, bool flip, Rgb radiance)
{
    SheenShape shape = {
        .kind = SHEEN_SHAPE_SPHERE,
        .sphere = {.center = center, .radius = radius, .flip = flip, .frame = frame_from_normal(v3(0, 0, 1))},
        .name = "sphere"};
    add_shape(s, &shape, radiance);
}

static inline void add_disk(LightScene *s, Vec3 center, Vec3 du, Vec3 dv, Rgb radiance)
{
    SheenShape shape = {.kind = SHEEN_SHAPE_DISK,
                        .disk = {.center = center, .du = du, .dv = dv, .n = v3_normalize(v3_cross(du, dv))},
                        .name = "disk"};
    add_shape(s, &shape, radiance);
}

/** A box whose sides shine outward, [lo, hi]. */
static inline void add_box(LightScene *s, Vec3 lo, Vec3 hi, Rgb radiance)
{
    Vec3 p[8];
    for (int i = 0; i < 8; ++i) p[i] = v3(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
    static const uint32_t t[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    add_mesh(s, 8, p, 12, t, radiance);
}

/** An environment image; the pixels are copied. */
static inline void add_environment(LightScene *s, uint32_t width, uint32_t height, const Rgb *pixels,
                                   Transform to_world)
{
    Rgb *copy = SHEEN_ARENA_NEW(sheen_builder_arena(s->builder), Rgb, (size_t)width * height);
    memcpy(copy, pixels, sizeof *copy * width * height);
    SheenLight light = {.kind = SHEEN_LIGHT_ENVIRONMENT,
                        .radiance = rgb(1, 1, 1),
                        .environment = {.width = width, .height = height, .floats = copy},
                        .to_world = to_world};
    assert_true(transform_invert(&to_world, &light.to_light));
    sheen_builder_add_light(s->builder, &light);
}

/** Uniform numbers of a fixed seed. */
typedef struct Random {
    uint32_t seed, i;
} Random;

static inline float random_1d(Random *r)
{
    return hash_to_unit(hash_combine(r->seed, r->i++));
}
static inline Vec2 random_2d(Random *r)
{
    float x = random_1d(r);
    return v2(x, random_1d(r));
}
static inline float random_in(Random *r, float lo, float hi)
{
    return lerpf(lo, hi, random_1d(r));
}

/** Mean and standard error of a sample. */
typedef struct Moments {
    double n, sum, sum2;
} Moments;

static inline void moments_add(Moments *m, double x)
{
    m->n += 1.0;
    m->sum += x;
    m->sum2 += x * x;
}
static inline double moments_mean(const Moments *m)
{
    return m->sum / m->n;
}
static inline double moments_error(const Moments *m)
{
    double mean = moments_mean(m);
    return sqrt(fmax(m->sum2 / m->n - mean * mean, 0.0) / m->n);
}

#endif
