// SPDX-License-Identifier: Apache-2.0
#include "scene/clean.h"

#include <string.h>

bool sheen_position_ok(Vec3 p)
{
    // Written so that a NaN fails.
    return fabsf(p.x) <= SHEEN_COORDINATE_MAX && fabsf(p.y) <= SHEEN_COORDINATE_MAX &&
           fabsf(p.z) <= SHEEN_COORDINATE_MAX;
}

/** Twice the area times the unit normal. */
static Vec3 area_vector(const SheenMesh *m, const uint32_t t[3])
{
    return v3_cross(v3_sub(m->p[t[1]], m->p[t[0]]), v3_sub(m->p[t[2]], m->p[t[0]]));
}

static bool triangle_ok(const SheenMesh *m, const uint32_t t[3])
{
    if (!sheen_position_ok(m->p[t[0]]) || !sheen_position_ok(m->p[t[1]]) || !sheen_position_ok(m->p[t[2]]))
        return false;
    // Below the smallest normal number the normal's direction is lost, so such an area counts as none.
    return isnormal(v3_length2(area_vector(m, t)));
}

static bool drop_bad_triangles(SheenArena *arena, SheenMesh *m, uint32_t *dropped)
{
    uint32_t n_good = 0;
    for (uint32_t i = 0; i < m->n_triangles; ++i) n_good += triangle_ok(m, m->triangles[i]);
    *dropped = m->n_triangles - n_good;
    if (*dropped == 0) return true;
    uint32_t(*good)[3] = sheen_arena_alloc(arena, n_good, sizeof *good);
    if (!good) return false;
    Rgb *color = m->face_color ? SHEEN_ARENA_NEW(arena, Rgb, n_good) : NULL;
    if (m->face_color && !color) return false;
    uint32_t n = 0;
    for (uint32_t i = 0; i < m->n_triangles; ++i) {
        if (!triangle_ok(m, m->triangles[i])) continue;
        if (color) color[n] = m->face_color[i];
        memcpy(good[n++], m->triangles[i], sizeof *good);
    }
    m->face_color = color;
    m->triangles = (const uint32_t(*)[3])good;
    m->n_triangles = n_good;
    return true;
}

static bool normal_ok(Vec3 n)
{
    return isnormal(v3_length2(n));
}

/** A bad normal becomes the mean of the face normals at its vertex: the face normal where there is one face. */
static bool replace_bad_normals(SheenArena *arena, SheenMesh *m)
{
    uint32_t bad = 0;
    for (uint32_t i = 0; i < m->n_vertices; ++i) bad += !normal_ok(m->n[i]);
    if (bad == 0) return true;
    Vec3 *n = SHEEN_ARENA_NEW(arena, Vec3, m->n_vertices);
    if (!n) return false;
    for (uint32_t i = 0; i < m->n_triangles; ++i)
        for (int j = 0; j < 3; ++j) {
            uint32_t v = m->triangles[i][j];
            if (!normal_ok(m->n[v])) n[v] = v3_add(n[v], v3_normalize(area_vector(m, m->triangles[i])));
        }
    for (uint32_t i = 0; i < m->n_vertices; ++i) {
        if (normal_ok(m->n[i]))
            n[i] = m->n[i];
        else if (normal_ok(n[i]))
            n[i] = v3_normalize(n[i]);
        else
            n[i] = v3(0, 0, 1); // of no triangle, or of triangles back to back: replaced below
    }
    for (uint32_t i = 0; i < m->n_triangles; ++i)
        for (int j = 0; j < 3; ++j) {
            uint32_t v = m->triangles[i][j];
            Vec3 face = v3_normalize(area_vector(m, m->triangles[i]));
            if (!normal_ok(m->n[v]) && v3_dot(n[v], face) <= 0.0f) n[v] = face;
        }
    m->n = n;
    return true;
}

bool sheen_mesh_clean(SheenArena *arena, SheenMesh *mesh, uint32_t *dropped)
{
    if (!drop_bad_triangles(arena, mesh, dropped)) return false;
    return !mesh->n || replace_bad_normals(arena, mesh);
}

static Bounds mesh_bounds(const SheenMesh *m)
{
    Bounds b = bounds_empty();
    for (uint32_t i = 0; i < m->n_triangles; ++i)
        for (int j = 0; j < 3; ++j) b = bounds_add(b, m->p[m->triangles[i][j]]);
    return b;
}

Bounds sheen_shape_bounds(const SheenShape *shape)
{
    Vec3 c, e;
    if (shape->kind == SHEEN_SHAPE_MESH) return mesh_bounds(&shape->mesh);
    if (shape->kind == SHEEN_SHAPE_SPHERE) {
        float r = shape->sphere.radius;
        c = shape->sphere.center, e = v3(r, r, r);
    } else {
        Vec3 u = shape->disk.du, v = shape->disk.dv;
        c = shape->disk.center;
        e = v3(sqrtf(u.x * u.x + v.x * v.x), sqrtf(u.y * u.y + v.y * v.y), sqrtf(u.z * u.z + v.z * v.z));
    }
    return (Bounds){v3_sub(c, e), v3_add(c, e)};
}
