// SPDX-License-Identifier: Apache-2.0
#include "ray/surface.h"

#include <string.h>

static void surface_of_mesh(const SheenMesh *mesh, const Hit *hit, SurfacePoint *s)
{
    const uint32_t *tri = mesh->triangles[hit->triangle];
    Vec3 p0 = mesh->p[tri[0]], e1 = v3_sub(mesh->p[tri[1]], p0), e2 = v3_sub(mesh->p[tri[2]], p0);
    float u = hit->u, v = hit->v, w = 1.0f - u - v;
    s->p = v3_mad(v3_mad(p0, u, e1), v, e2);
    s->ng = v3_normalize(v3_cross(e1, e2));
    s->ns = s->ng;
    if (mesh->n) {
        Vec3 n = v3_mad(v3_mad(v3_scale(mesh->n[tri[0]], w), u, mesh->n[tri[1]]), v, mesh->n[tri[2]]);
        if (v3_length2(n) > 1e-12f) s->ns = v3_normalize(n);
    }
    s->uv = v2(u, v);
    if (mesh->uv) {
        const Vec2 *t = mesh->uv;
        s->uv = v2(w * t[tri[0]].x + u * t[tri[1]].x + v * t[tri[2]].x,
                   w * t[tri[0]].y + u * t[tri[1]].y + v * t[tri[2]].y);
    }
}

static void surface_of_sphere(const SheenSphere *sphere, Vec3 hit_point, SurfacePoint *s)
{
    Vec3 d = v3_normalize(v3_sub(hit_point, sphere->center));
    s->p = v3_mad(sphere->center, sphere->radius, d);
    s->ng = sphere->flip ? v3_neg(d) : d;
    s->ns = s->ng;
    Vec3 l = frame_to_local(&sphere->frame, d);
    float azimuth = atan2f(l.y, l.x);
    if (azimuth < 0.0f) azimuth += 2.0f * SHEEN_PI;
    s->uv = v2(azimuth * (0.5f * SHEEN_INV_PI), acosf(clampf(l.z, -1.0f, 1.0f)) * SHEEN_INV_PI);
}

static void surface_of_disk(const SheenDisk *disk, Vec3 hit_point, SurfacePoint *s)
{
    Vec3 q = v3_sub(hit_point, disk->center);
    q = v3_mad(q, -v3_dot(q, disk->n), disk->n); // onto the plane
    s->p = v3_add(disk->center, q);
    s->ng = disk->n;
    s->ns = disk->n;
    float uu = v3_length2(disk->du), vv = v3_length2(disk->dv), uv = v3_dot(disk->du, disk->dv);
    float qu = v3_dot(q, disk->du), qv = v3_dot(q, disk->dv), det = uu * vv - uv * uv;
    float x = (qu * vv - qv * uv) / det, y = (qv * uu - qu * uv) / det;
    float azimuth = atan2f(y, x);
    if (azimuth < 0.0f) azimuth += 2.0f * SHEEN_PI;
    s->uv = v2(sqrtf(x * x + y * y), azimuth * (0.5f * SHEEN_INV_PI));
}

void sheen_surface_from_hit(const SheenScene *scene, const Ray *ray, const Hit *hit, SurfacePoint *out)
{
    const SheenShape *shape = &scene->shapes[hit->shape];
    const SheenInstance *instance = hit->instance == SHEEN_NONE ? NULL : &scene->instances[hit->instance];
    Vec3 p = v3_mad(ray->o, hit->t, ray->d);
    if (instance) p = transform_point(&instance->to_group, p);
    out->shape = hit->shape;
    out->triangle = hit->triangle;
    out->instance = hit->instance;
    switch (shape->kind) {
    case SHEEN_SHAPE_MESH:
        surface_of_mesh(&shape->mesh, hit, out);
        break;
    case SHEEN_SHAPE_SPHERE:
        surface_of_sphere(&shape->sphere, p, out);
        break;
    case SHEEN_SHAPE_DISK:
        surface_of_disk(&shape->disk, p, out);
        break;
    }
    if (instance) {
        out->p = transform_point(&instance->to_world, out->p);
        out->ng = transform_normal(&instance->to_group, out->ng);
        out->ns = transform_normal(&instance->to_group, out->ns);
    }
    // Far from its vertices an interpolated normal may turn away: light would then come from the wrong side.
    if (v3_dot(out->ng, out->ns) < 0.0f) out->ns = out->ng;
}

// Moves x by k units in the last place, away from zero when k and x have one sign.
static float move_ulps(float x, int k)
{
    int32_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits += x < 0.0f ? -k : k;
    memcpy(&x, &bits, sizeof bits);
    return x;
}

static float offset_axis(float p, float n)
{
    // Near zero units in the last place shrink to nothing: an absolute step takes over there.
    const float near_zero = 1.0f / 32.0f, absolute = 1.0f / 65536.0f, ulps = 256.0f;
    if (fabsf(p) < near_zero) return p + absolute * n;
    return move_ulps(p, (int)(ulps * n));
}

Vec3 sheen_surface_offset(Vec3 p, Vec3 n)
{
    return v3(offset_axis(p.x, n.x), offset_axis(p.y, n.y), offset_axis(p.z, n.z));
}
