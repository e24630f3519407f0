// SPDX-License-Identifier: Apache-2.0
// How surfaces move with their texture coordinates.
#include "ray/surface.h"

// By the derivatives of barycentric coordinates. @return false where texture coordinates say nothing
static bool tangents_of_mesh(const SheenMesh *mesh, uint32_t triangle, Vec3 *dpdu, Vec3 *dpdv)
{
    if (!mesh->uv) return false;
    const uint32_t *t = mesh->triangles[triangle];
    Vec3 e1 = v3_sub(mesh->p[t[1]], mesh->p[t[0]]), e2 = v3_sub(mesh->p[t[2]], mesh->p[t[0]]);
    Vec2 a = mesh->uv[t[0]], b = mesh->uv[t[1]], c = mesh->uv[t[2]];
    float u1 = b.x - a.x, v1 = b.y - a.y, u2 = c.x - a.x, v2 = c.y - a.y;
    float det = u1 * v2 - v1 * u2;
    if (!isnormal(det)) return false;
    *dpdu = v3_scale(v3_mad(v3_scale(e1, v2), -v1, e2), 1.0f / det);
    *dpdv = v3_scale(v3_mad(v3_scale(e2, u1), -u2, e1), 1.0f / det);
    return true;
}

// u runs once around the axis, v from the upper pole to the lower one. At the poles the surface stands still with u.
static bool tangents_of_sphere(const SheenSphere *sphere, Vec3 p, Vec3 *dpdu, Vec3 *dpdv)
{
    Vec3 d = frame_to_local(&sphere->frame, v3_sub(p, sphere->center));
    float r = sqrtf(d.x * d.x + d.y * d.y);
    if (!(r > 1e-6f * sphere->radius)) return false;
    *dpdu = frame_to_world(&sphere->frame, v3_scale(v3(-d.y, d.x, 0.0f), 2.0f * SHEEN_PI));
    *dpdv = frame_to_world(&sphere->frame, v3_scale(v3(d.z * d.x / r, d.z * d.y / r, -r), SHEEN_PI));
    return true;
}

// u is the distance to the centre, v the azimuth.
static bool tangents_of_disk(const SheenDisk *disk, Vec2 uv, Vec3 *dpdu, Vec3 *dpdv)
{
    if (!(uv.x > 1e-6f)) return false;
    float c = cosf(2.0f * SHEEN_PI * uv.y), s = sinf(2.0f * SHEEN_PI * uv.y);
    *dpdu = v3_mad(v3_scale(disk->du, c), s, disk->dv);
    *dpdv = v3_scale(v3_mad(v3_scale(disk->dv, c), -s, disk->du), 2.0f * SHEEN_PI * uv.x);
    return true;
}

void sheen_surface_tangents(const SheenScene *scene, const SurfacePoint *s, Vec3 *dpdu, Vec3 *dpdv)
{
    const SheenShape *shape = &scene->shapes[s->shape];
    const SheenInstance *instance = s->instance == SHEEN_NONE ? NULL : &scene->instances[s->instance];
    bool known = false;
    if (shape->kind == SHEEN_SHAPE_MESH)
        known = tangents_of_mesh(&shape->mesh, s->triangle, dpdu, dpdv);
    else if (shape->kind == SHEEN_SHAPE_SPHERE)
        known = tangents_of_sphere(&shape->sphere, instance ? transform_point(&instance->to_group, s->p) : s->p, dpdu,
                                   dpdv);
    else
        known = tangents_of_disk(&shape->disk, s->uv, dpdu, dpdv);
    if (known && instance) {
        *dpdu = transform_vector(&instance->to_world, *dpdu);
        *dpdv = transform_vector(&instance->to_world, *dpdv);
    }
    if (known && v3_finite(*dpdu) && v3_finite(*dpdv)) return;
    Frame f = frame_from_normal(s->ng);
    *dpdu = f.t;
    *dpdv = f.b;
}
