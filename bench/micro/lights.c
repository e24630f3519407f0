// SPDX-License-Identifier: Apache-2.0
// Nanoseconds of a choice among lights and of a sample of each kind.
#include "base/hash.h"
#include "light/light.h"
#include "scene/builder.h"
#include "timing.h"

#include <stdio.h>
#include <stdlib.h>

#define N_POINTS 1000000u

static float uniform(uint32_t i, uint32_t dim)
{
    return hash_to_unit(hash_combine(i, dim));
}

static Vec3 point(uint32_t i)
{
    return v3(4 * uniform(i, 0) - 2, 4 * uniform(i, 1) - 2, uniform(i, 2));
}

// A ceiling of n lamps, 0.2 m each way, over a room of 4 by 4 by 3 metres.
static void add_lamps(SheenBuilder *b, SheenShapeKind kind, uint32_t n)
{
    static const uint32_t t[2][3] = {{0, 1, 2}, {0, 2, 3}};
    for (uint32_t i = 0; i < n; ++i) {
        Vec3 c = v3(4 * uniform(i, 3) - 2, 4 * uniform(i, 4) - 2, 3);
        SheenShape shape = {.kind = kind, .name = "lamp"};
        if (kind == SHEEN_SHAPE_MESH) {
            Vec3 *p = SHEEN_ARENA_NEW(sheen_builder_arena(b), Vec3, 5);
            if (!p) exit(1);
            p[0] = v3(c.x - 0.1f, c.y - 0.1f, c.z), p[1] = v3(c.x - 0.1f, c.y + 0.1f, c.z);
            p[2] = v3(c.x + 0.1f, c.y + 0.1f, c.z), p[3] = v3(c.x + 0.1f, c.y - 0.1f, c.z);
            shape.mesh = (SheenMesh){.n_vertices = 4, .n_triangles = 2, .p = p, .triangles = t};
        } else if (kind == SHEEN_SHAPE_SPHERE) {
            shape.sphere = (SheenSphere){.center = c, .radius = 0.1f, .frame = frame_from_normal(v3(0, 0, 1))};
        } else {
            shape.disk = (SheenDisk){c, v3(0.1f, 0, 0), v3(0, -0.1f, 0), v3(0, 0, -1)};
        }
        sheen_builder_add_area_light(b, sheen_builder_add_shape(b, &shape), rgb_gray(1));
    }
}

static void run(const char *name, SheenShapeKind kind, uint32_t n)
{
    SheenBuilder *builder;
    SheenScene *scene = NULL;
    SheenLights *lights = NULL;
    if (sheen_builder_create(NULL, "bench", &builder)) exit(1);
    SheenMaterial material = {.name = "m"};
    sheen_builder_add_material(builder, &material);
    add_lamps(builder, kind, n);
    if (sheen_builder_commit(&builder, &scene)) exit(1);
    if (sheen_lights_create(scene, SHEEN_ENVIRONMENT_WHOLE, NULL, &lights)) exit(1);
    double sum = 0.0, start = processor_seconds();
    for (uint32_t i = 0; i < N_POINTS; ++i) {
        float u = uniform(i, 5);
        uint32_t light;
        sum += (double)sheen_lights_choose(lights, point(i), v3(0, 0, 1), &u, &light);
    }
    double middle = processor_seconds();
    for (uint32_t i = 0; i < N_POINTS; ++i) {
        LightSample s;
        if (sheen_light_sample(lights, i % n, point(i), v2(uniform(i, 5), uniform(i, 6)), &s)) sum += (double)s.pdf;
    }
    double end = processor_seconds(), scale = 1e9 / N_POINTS;
    printf("%-10s %6u lights: choose %7.1f ns, sample %6.1f ns (%g)\n", name, n, (middle - start) * scale,
           (end - middle) * scale, sum);
    sheen_lights_destroy(&lights);
    sheen_scene_destroy(&scene);
}

int main(void)
{
    const uint32_t n[] = {1, 2, 13, 100, 1000, 10000};
    for (size_t i = 0; i < sizeof n / sizeof *n; ++i) {
        run("rectangles", SHEEN_SHAPE_MESH, n[i]);
        run("spheres", SHEEN_SHAPE_SPHERE, n[i]);
        run("disks", SHEEN_SHAPE_DISK, n[i]);
    }
    return 0;
}
