// SPDX-License-Identifier: Apache-2.0
#include "ray/surface.h"

// What the rounding of a point and of rays from it is in proportion to, axis by axis.
typedef struct Magnitude {
    Vec3 position; // coordinates that were added up
    Vec3 extent;   // of the primitive: how far its vertices are from the point
} Magnitude;

static Vec3 v3_abs(Vec3 a)
{
    return v3(fabsf(a.x), fabsf(a.y), fabsf(a.z));
}

// Distance off the surface that covers the rounding of a point on it, and of the ray's test against it: both rise with
// the coordinates and with the primitive's size, but only by what the normal sees of them. A wall that is parallel to
// an axis has no such errors; a share of its size too small for any other effect keeps the ray off it. As
// waechter2019-offset, ch. 6, in units of rounding, but without an absolute length, and with the primitive's part. Both
// factors are twice and more of where rays first hit the surface again in tests/unit/test_surface_offset.c.
static float clearance(const Magnitude *m, Vec3 n)
{
    const float unit = 0x1p-24f, position = 4.0f, extent = 4.0f, least = 0.25f;
    Vec3 e = v3_mad(v3_scale(m->position, position), extent, m->extent);
    float largest = maxf(m->extent.x, maxf(m->extent.y, m->extent.z));
    return unit * (v3_dot(v3_abs(n), e) + least * largest);
}

float sheen_surface_clearance(Vec3 p, Vec3 n, float extent)
{
    Magnitude m = {v3_abs(p), v3(extent, extent, extent)};
    return clearance(&m, n);
}

// ---- texture coordinates ----------------------------------------------------------------------------------------

static Vec2 mesh_uv(const SheenMesh *mesh, uint32_t triangle, float u, float v)
{
    if (!mesh->uv) return v2(u, v);
    const uint32_t *tri = mesh->triangles[triangle];
    const Vec2 *t = mesh->uv;
    float w = 1.0f - u - v;
    return v2(w * t[tri[0]].x + u * t[tri[1]].x + v * t[tri[2]].x, w * t[tri[0]].y + u * t[tri[1]].y + v * t[tri[2]].y);
}

// @param d  unit, from the centre
static Vec2 sphere_uv(const SheenSphere *sphere, Vec3 d)
{
    Vec3 l = frame_to_local(&sphere->frame, d);
    float azimuth = atan2f(l.y, l.x);
    if (azimuth < 0.0f) azimuth += 2.0f * SHEEN_PI;
    return v2(azimuth * (0.5f * SHEEN_INV_PI), acosf(clampf(l.z, -1.0f, 1.0f)) * SHEEN_INV_PI);
}

// @param q  from the centre, in the plane
static Vec2 disk_uv(const SheenDisk *disk, Vec3 q)
{
    float uu = v3_length2(disk->du), vv = v3_length2(disk->dv), uv = v3_dot(disk->du, disk->dv);
    float qu = v3_dot(q, disk->du), qv = v3_dot(q, disk->dv), det = uu * vv - uv * uv;
    float x = (qu * vv - qv * uv) / det, y = (qv * uu - qu * uv) / det;
    float azimuth = atan2f(y, x);
    if (azimuth < 0.0f) azimuth += 2.0f * SHEEN_PI;
    return v2(sqrtf(x * x + y * y), azimuth * (0.5f * SHEEN_INV_PI));
}

// From a disk's centre to a point near its plane, in the plane.
static Vec3 onto_disk(const SheenDisk *disk, Vec3 p)
{
    Vec3 q = v3_sub(p, disk->center);
    return v3_mad(q, -v3_dot(q, disk->n), disk->n);
}

Vec2 sheen_surface_uv(const SheenShape *shape, uint32_t triangle, float u, float v, Vec3 p)
{
    switch (shape->kind) {
    case SHEEN_SHAPE_SPHERE:
        return sphere_uv(&shape->sphere, v3_normalize(v3_sub(p, shape->sphere.center)));
    case SHEEN_SHAPE_DISK:
        return disk_uv(&shape->disk, onto_disk(&shape->disk, p));
    case SHEEN_SHAPE_MESH:
        break;
    }
    return mesh_uv(&shape->mesh, triangle, u, v);
}

Vec3 sheen_surface_front(const SheenShape *shape, uint32_t triangle, Vec3 p)
{
    const SheenMesh *mesh = &shape->mesh;
    switch (shape->kind) {
    case SHEEN_SHAPE_SPHERE:
        return v3_scale(v3_sub(p, shape->sphere.center), shape->sphere.flip ? -1.0f : 1.0f);
    case SHEEN_SHAPE_DISK:
        return shape->disk.n;
    case SHEEN_SHAPE_MESH:
        break;
    }
    const uint32_t *tri = mesh->triangles[triangle];
    Vec3 p0 = mesh->p[tri[0]];
    return v3_cross(v3_sub(mesh->p[tri[1]], p0), v3_sub(mesh->p[tri[2]], p0));
}

// ---- points -----------------------------------------------------------------------------------------------------

static Magnitude surface_of_mesh(const SheenMesh *mesh, const Hit *hit, SurfacePoint *s)
{
    const uint32_t *tri = mesh->triangles[hit->triangle];
    Vec3 p0 = mesh->p[tri[0]], e1 = v3_sub(mesh->p[tri[1]], p0), e2 = v3_sub(mesh->p[tri[2]], p0);
    Vec3 cross = v3_cross(e1, e2);
    float u = hit->u, v = hit->v, w = 1.0f - u - v;
    float length = v3_length(cross), inverse = length > 0.0f ? 1.0f / length : 1.0f;
    s->p = v3_mad(v3_mad(p0, u, e1), v, e2);
    s->ng = s->ns = v3_scale(cross, inverse);
    if (mesh->n) {
        Vec3 n = v3_mad(v3_mad(v3_scale(mesh->n[tri[0]], w), u, mesh->n[tri[1]]), v, mesh->n[tri[2]]);
        if (v3_length2(n) > 1e-12f) s->ns = v3_normalize(n);
    }
    s->uv = mesh_uv(mesh, hit->triangle, u, v);
    // The normal of a sliver is a difference of products that nearly cancel.
    float cancelled = minf(v3_length(e1) * inverse * v3_length(e2), 1024.0f);
    return (Magnitude){v3_abs(s->p), v3_scale(v3_add(v3_abs(e1), v3_abs(e2)), cancelled)};
}

static Magnitude surface_of_sphere(const SheenSphere *sphere, Vec3 hit_point, SurfacePoint *s)
{
    Vec3 d = v3_normalize(v3_sub(hit_point, sphere->center));
    s->p = v3_mad(sphere->center, sphere->radius, d);
    s->ng = sphere->flip ? v3_neg(d) : d;
    s->ns = s->ng;
    s->uv = sphere_uv(sphere, d);
    float r = sphere->radius;
    return (Magnitude){v3_abs(s->p), v3(r, r, r)};
}

static Magnitude surface_of_disk(const SheenDisk *disk, Vec3 hit_point, SurfacePoint *s)
{
    Vec3 q = onto_disk(disk, hit_point);
    s->p = v3_add(disk->center, q);
    s->ng = disk->n;
    s->ns = disk->n;
    s->uv = disk_uv(disk, q);
    return (Magnitude){v3_abs(s->p), v3_add(v3_abs(disk->du), v3_abs(disk->dv))};
}

static Vec3 transform_magnitude(const Transform *t, Vec3 a, bool is_point)
{
    float r[3], v[3] = {a.x, a.y, a.z};
    for (int i = 0; i < 3; ++i) {
        r[i] = is_point ? (float)fabs(t->m[i][3]) : 0.0f;
        for (int j = 0; j < 3; ++j) r[i] += (float)fabs(t->m[i][j]) * v[j];
    }
    return v3(r[0], r[1], r[2]);
}

// Rays are taken into the group's space and points out of it again.
static Magnitude magnitude_of_instance(const SheenInstance *instance, const Magnitude *m, Vec3 p)
{
    Vec3 in_group = transform_magnitude(&instance->to_group, v3_abs(p), true);
    return (Magnitude){transform_magnitude(&instance->to_world, v3_add(in_group, m->position), true),
                       transform_magnitude(&instance->to_world, m->extent, false)};
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
    Magnitude magnitude = {0};
    switch (shape->kind) {
    case SHEEN_SHAPE_MESH:
        magnitude = surface_of_mesh(&shape->mesh, hit, out);
        break;
    case SHEEN_SHAPE_SPHERE:
        magnitude = surface_of_sphere(&shape->sphere, p, out);
        break;
    case SHEEN_SHAPE_DISK:
        magnitude = surface_of_disk(&shape->disk, p, out);
        break;
    }
    if (instance) {
        out->p = transform_point(&instance->to_world, out->p);
        out->ng = transform_normal(&instance->to_group, out->ng);
        out->ns = transform_normal(&instance->to_group, out->ns);
        magnitude = magnitude_of_instance(instance, &magnitude, out->p);
    }
    out->clearance = clearance(&magnitude, out->ng);
    // Far from its vertices an interpolated normal may turn away: light would then come from the wrong side.
    if (v3_dot(out->ng, out->ns) < 0.0f) out->ns = out->ng;
}

Vec2 sheen_surface_barycentric(const SheenMesh *mesh, uint32_t triangle, Vec3 p)
{
    const uint32_t *v = mesh->triangles[triangle];
    Vec3 a = mesh->p[v[0]], e1 = v3_sub(mesh->p[v[1]], a), e2 = v3_sub(mesh->p[v[2]], a), d = v3_sub(p, a);
    Vec3 n = v3_cross(e1, e2);
    float n2 = v3_length2(n);
    if (!(n2 > 0.0f)) return v2(0.0f, 0.0f);
    return v2(v3_dot(v3_cross(d, e2), n) / n2, v3_dot(v3_cross(e1, d), n) / n2);
}

static Rgb color_of_mesh(const SheenScene *scene, const SheenTexture *t, const SurfacePoint *s)
{
    const SheenShape *shape = &scene->shapes[s->shape];
    const SheenMesh *mesh = &shape->mesh;
    if (shape->kind != SHEEN_SHAPE_MESH) return t->value;
    if (t->kind == SHEEN_TEXTURE_FACE_COLOR)
        return mesh->face_color ? rgb_mul(t->scale, mesh->face_color[s->triangle]) : t->value;
    if (!mesh->color) return t->value;
    Vec3 p = s->instance == SHEEN_NONE ? s->p : transform_point(&scene->instances[s->instance].to_group, s->p);
    Vec2 b = sheen_surface_barycentric(mesh, s->triangle, p);
    float u = clampf(b.x, 0.0f, 1.0f), v = clampf(b.y, 0.0f, 1.0f - u);
    const uint32_t *i = mesh->triangles[s->triangle];
    Rgb c = rgb_mad(rgb_scale(mesh->color[i[0]], 1.0f - u - v), u, mesh->color[i[1]]);
    return rgb_mul(t->scale, rgb_mad(c, v, mesh->color[i[2]]));
}

Rgb sheen_surface_texture(const SheenScene *scene, const SheenTexture *t, const SurfacePoint *s)
{
    return sheen_texture_is_of_mesh(t) ? color_of_mesh(scene, t, s) : sheen_texture_eval(t, s->uv);
}
