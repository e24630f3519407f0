// SPDX-License-Identifier: Apache-2.0
// Pictures of both integrators through sheen_render, and their means, for the tests of the irradiance integrator.
// Include after cmocka.h.
#ifndef SHEEN_TESTS_IRRADIANCE_KIT_H
#define SHEEN_TESTS_IRRADIANCE_KIT_H

#include "analytic/path_kit.h"
#include "render/render.h"

#include <stdlib.h>

/** Prints a measurement when SHEEN_SHOW is set: for choosing bounds. */
#define show(...) (getenv("SHEEN_SHOW") ? (void)fprintf(stderr, __VA_ARGS__) : (void)0)

/** Small settings: 32 x 32 pixels, 4 samples, 128 rays a gather. */
static inline SheenRenderSettings small_settings(uint32_t bounces)
{
    SheenRenderSettings s = {.integrator = SHEEN_INTEGRATOR_IRRADIANCE, .width = 32, .height = 32};
    s.options = sheen_options_default();
    s.options.spp = 4;
    s.options.gather_rays = 128;
    s.options.bounces = bounces;
    return s;
}

/** A scene and threads. */
typedef struct Stage {
    SheenScene *scene;
    SheenPool *pool;
} Stage;

static inline Stage stage_end(SheenBuilder *b, unsigned threads)
{
    Stage stage = {0};
    assert_int_equal(sheen_builder_commit(&b, &stage.scene), SHEEN_OK);
    assert_int_equal(sheen_pool_create(threads, &stage.pool), SHEEN_OK);
    return stage;
}

static inline void stage_free(Stage *stage)
{
    sheen_pool_destroy(&stage->pool);
    sheen_scene_destroy(&stage->scene);
}

/** @param stats  may be NULL; free the film with sheen_film_destroy. */
static inline SheenFilm *stage_render(const Stage *stage, const SheenRenderSettings *settings, SheenStats *stats)
{
    SheenFilm *film = NULL;
    SheenStats local;
    SheenRenderTimes times;
    SheenStatus status = sheen_render(stage->scene, settings, stage->pool, NULL, NULL, &kit_log_sink, &film,
                                      stats ? stats : &local, &times);
    assert_int_equal(status, SHEEN_OK);
    assert_int_equal((stats ? stats : &local)->nonfinite_samples, 0);
    return film;
}

/** The picture of a scene in the making, on two threads. */
static inline SheenFilm *stage_picture(SheenBuilder *b, const SheenRenderSettings *settings)
{
    Stage stage = stage_end(b, 2);
    SheenFilm *film = stage_render(&stage, settings, NULL);
    stage_free(&stage);
    return film;
}

/** The reference: the same picture by paths. */
static inline SheenFilm *stage_reference(const Stage *stage, const SheenRenderSettings *settings, uint32_t spp,
                                         uint32_t seed)
{
    SheenRenderSettings s = *settings;
    s.integrator = SHEEN_INTEGRATOR_PATH;
    s.options.spp = spp;
    s.options.seed = seed;
    return stage_render(stage, &s, NULL);
}

/** Mean luminance of the rectangle [x0, x1) x [y0, y1). */
static inline double film_mean_of(const SheenFilm *film, uint32_t x0, uint32_t y0, uint32_t x1, uint32_t y1)
{
    double sum = 0.0;
    for (uint32_t y = y0; y < y1; ++y)
        for (uint32_t x = x0; x < x1; ++x) sum += (double)rgb_luminance(film->color[y * film->width + x]);
    return sum / ((double)(x1 - x0) * (y1 - y0));
}
static inline double film_mean(const SheenFilm *film)
{
    return film_mean_of(film, 0, 0, film->width, film->height);
}

/** Largest and root mean square relative difference of block means, over blocks of 8 x 8 pixels. */
typedef struct BlockDifference {
    double worst, rms;
} BlockDifference;

static inline BlockDifference film_blocks(const SheenFilm *a, const SheenFilm *b)
{
    enum { SIDE = 8 };
    BlockDifference d = {0};
    double sum = 0.0;
    size_t n = 0;
    for (uint32_t y = 0; y + SIDE <= a->height; y += SIDE)
        for (uint32_t x = 0; x + SIDE <= a->width; x += SIDE) {
            double u = film_mean_of(a, x, y, x + SIDE, y + SIDE), v = film_mean_of(b, x, y, x + SIDE, y + SIDE);
            double relative = fabs(u - v) / fmax(v, 1e-30);
            if (!(relative <= d.worst)) d.worst = relative;
            sum += relative * relative;
            ++n;
        }
    d.rms = sqrt(sum / (double)n);
    return d;
}

/**
 * Asserts that the cached picture agrees with paths: the mean within `mean` (relative), and each block within 4.5
 * standard errors of the reference and `block`. The standard error of a block is taken from two references.
 */
static inline void assert_agrees_with_paths(const Stage *stage, const SheenRenderSettings *settings, uint32_t spp,
                                            double mean, double block, const char *what)
{
    SheenFilm *film = stage_render(stage, settings, NULL);
    SheenFilm *a = stage_reference(stage, settings, spp / 2, 1), *b = stage_reference(stage, settings, spp / 2, 2);
    double noise = 0.5 * film_blocks(a, b).rms;
    for (size_t i = 0; i < (size_t)a->width * a->height; ++i)
        a->color[i] = rgb_scale(rgb_add(a->color[i], b->color[i]), 0.5f);
    double off = film_mean(film) / film_mean(a) - 1.0;
    BlockDifference d = film_blocks(film, a);
    bool ok = fabs(off) <= mean && d.worst <= 4.5 * noise + block && noise < block;
    if (!ok || getenv("SHEEN_SHOW"))
        fprintf(stderr, "%s: mean off by %.2g, worst block by %.2g, noise of a block %.2g\n", what, off, d.worst,
                noise);
    assert_true(ok);
    sheen_film_destroy(&film);
    sheen_film_destroy(&a);
    sheen_film_destroy(&b);
}

/** A sphere as a mesh of `rings` x 2 `rings` cells with the sphere's normals at the vertices. */
static inline uint32_t kit_smooth_sphere(SheenBuilder *b, Vec3 center, float radius, uint32_t rings, uint32_t material)
{
    SheenArena *arena = sheen_builder_arena(b);
    uint32_t sectors = 2 * rings, n = (rings + 1) * sectors, m = 2 * rings * sectors;
    Vec3 *p = SHEEN_ARENA_NEW(arena, Vec3, n + 1), *normals = SHEEN_ARENA_NEW(arena, Vec3, n);
    uint32_t(*triangles)[3] = sheen_arena_alloc(arena, m, sizeof *triangles);
    assert_true(p && normals && triangles);
    p[n] = v3(0, 0, 0);
    uint32_t t = 0;
    for (uint32_t i = 0; i <= rings; ++i)
        for (uint32_t j = 0; j < sectors; ++j) {
            float theta = SHEEN_PI * (float)i / (float)rings, phi = 2.0f * SHEEN_PI * (float)j / (float)sectors;
            Vec3 d = v3(sinf(theta) * cosf(phi), sinf(theta) * sinf(phi), cosf(theta));
            uint32_t at = i * sectors + j, right = i * sectors + (j + 1) % sectors;
            normals[at] = d;
            p[at] = v3_mad(center, radius, d);
            if (i == rings) continue;
            memcpy(triangles[t++], (uint32_t[3]){at, at + sectors, right + sectors}, sizeof *triangles);
            memcpy(triangles[t++], (uint32_t[3]){at, right + sectors, right}, sizeof *triangles);
        }
    SheenShape s = {.kind = SHEEN_SHAPE_MESH, .material = material, .light = SHEEN_NONE, .name = "smooth sphere"};
    s.mesh = (SheenMesh){n, m, p, normals, NULL, (const uint32_t(*)[3])triangles, NULL, NULL};
    return sheen_builder_add_shape(b, &s);
}

/** The box [-s, s]^3 with a ball and a slanted board, seen from inside; `lit` by a lamp under its ceiling. */
static inline SheenBuilder *kit_room(float s, float albedo, SheenMaterialKind ball, bool lit)
{
    SheenBuilder *b = kit_begin();
    uint32_t walls = kit_diffuse(b, albedo);
    static const Vec3 axis[3] = {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
    Vec3 corner = v3_scale(v3(-1, -1, -1), s);
    for (int a = 0; a < 3; ++a) {
        Vec3 e1 = v3_scale(axis[(a + 1) % 3], s), e2 = v3_scale(axis[(a + 2) % 3], s);
        kit_quad(b, corner, e1, e2, walls);
        kit_quad(b, v3_mad(corner, s, axis[a]), e2, e1, walls);
    }
    if (lit) {
        uint32_t lamp = kit_quad(b, v3_scale(v3(-0.4f, -0.4f, 0.98f), s), v3_scale(v3(0, 0.8f, 0), s),
                                 v3_scale(v3(0.8f, 0, 0), s), kit_diffuse(b, 0.0f));
        sheen_builder_add_area_light(b, lamp, rgb(4.0f, 5.0f, 3.0f));
    }
    kit_sphere(b, v3_scale(v3(-0.4f, 0.4f, -0.55f), s), 0.4f * s, false, kit_material(b, ball, 0.5f, 1.5f));
    kit_quad(b, v3_scale(v3(0.1f, 0.0f, -0.4f), s), v3_scale(v3(0.6f, 0, 0), s), v3_scale(v3(0, 0.6f, 0.2f), s),
             kit_material(b, SHEEN_MATERIAL_DIFFUSE, 0.3f, 1.0f));
    kit_camera(b, v3_scale(v3(0, -0.95f, 0), s), v3_scale(v3(0, 0, -0.1f), s), v3(0, 0, 1), 1.5f);
    return b;
}

#endif
