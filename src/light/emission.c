// SPDX-License-Identifier: Apache-2.0
#include "light/emission.h"

#include "math/sampler.h"
#include "math/warp.h"

static float least(Vec2 b)
{
    return minf(minf(b.x, b.y), 1.0f - b.x - b.y);
}

// The triangle that q is in, or least outside of.
static uint32_t triangle_at(const SheenMesh *mesh, Vec3 q)
{
    uint32_t best = 0;
    float inside = -INFINITY;
    for (uint32_t i = 0; i < mesh->n_triangles; ++i) {
        float depth = least(sheen_surface_barycentric(mesh, i, q));
        if (!(depth > inside)) continue;
        inside = depth;
        best = i;
    }
    return best;
}

static Rgb emission_of_hit(const SheenScene *scene, const SheenLight *light, const Hit *hit, Vec3 q)
{
    const Ray ray = {.o = q, .d = {0, 0, 1}}; // which has arrived
    SurfacePoint s;
    sheen_surface_from_hit(scene, &ray, hit, &s);
    return sheen_emission(scene, light, &s);
}

Rgb sheen_emission_at(const SheenScene *scene, const SheenLight *light, uint32_t triangle, Vec3 q)
{
    if (!light->texture) return light->radiance;
    const SheenShape *shape = &scene->shapes[light->shape];
    Hit hit = {.shape = light->shape, .instance = SHEEN_NONE};
    if (shape->kind == SHEEN_SHAPE_MESH) {
        hit.triangle = triangle == SHEEN_NONE ? triangle_at(&shape->mesh, q) : triangle;
        Vec2 b = sheen_surface_barycentric(&shape->mesh, hit.triangle, q);
        hit.u = clampf(b.x, 0.0f, 1.0f);
        hit.v = clampf(b.y, 0.0f, 1.0f - hit.u);
    }
    return emission_of_hit(scene, light, &hit, q);
}

static double mean(Rgb c)
{
    return ((double)c.r + (double)c.g + (double)c.b) / 3.0;
}

// A point of a sphere or a disk, uniform for u in the unit square.
static Vec3 point_of(const SheenShape *shape, Vec2 u)
{
    if (shape->kind == SHEEN_SHAPE_SPHERE) return v3_mad(shape->sphere.center, shape->sphere.radius, warp_sphere(u));
    Vec2 x = warp_disk(u);
    return v3_mad(v3_mad(shape->disk.center, x.x, shape->disk.du), x.y, shape->disk.dv);
}

float sheen_emission_mean(const SheenScene *scene, const SheenLight *light)
{
    if (!light->texture) return (float)mean(light->radiance);
    enum { POINTS = 1024 };
    const SheenShape *shape = &scene->shapes[light->shape];
    bool is_mesh = shape->kind == SHEEN_SHAPE_MESH;
    uint32_t n_parts = is_mesh ? shape->mesh.n_triangles : 1, each = n_parts < POINTS ? POINTS / n_parts : 1;
    double sum = 0.0, area = 0.0;
    for (uint32_t i = 0; i < n_parts; ++i) {
        double part = 1.0, of_part = 0.0;
        if (is_mesh) {
            const uint32_t *v = shape->mesh.triangles[i];
            Vec3 a = shape->mesh.p[v[0]];
            part = (double)v3_length(v3_cross(v3_sub(shape->mesh.p[v[1]], a), v3_sub(shape->mesh.p[v[2]], a)));
        }
        for (uint32_t k = 0; k < each; ++k) {
            SheenSampler sampler = sampler_make(hash_u32(i), k);
            Vec2 u = sampler_2d(&sampler);
            Hit hit = {.shape = light->shape, .triangle = i, .instance = SHEEN_NONE};
            float root = sqrtf(u.x);
            hit.u = 1.0f - root, hit.v = u.y * root;
            Vec3 q = is_mesh ? v3(0, 0, 0) : point_of(shape, u);
            of_part += mean(emission_of_hit(scene, light, &hit, q)) / each;
        }
        sum += part * of_part;
        area += part;
    }
    // A small bright spot that all points missed still gets its share of the texture's own mean.
    double whole = mean(light->radiance), found = area > 0.0 ? sum / area : 0.0;
    return (float)(isfinite(found) ? fmax(found, 0.1 * whole) : whole);
}
