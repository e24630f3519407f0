// SPDX-License-Identifier: Apache-2.0
#include "io/mesh.h"

#include <stdlib.h>

bool sheen_mesh_alloc(SheenArena *arena, MeshData *m, bool normals, bool uv)
{
    m->p = SHEEN_ARENA_NEW(arena, Vec3, (size_t)m->n_vertices + 1);
    m->n = normals ? SHEEN_ARENA_NEW(arena, Vec3, m->n_vertices) : NULL;
    m->uv = uv ? SHEEN_ARENA_NEW(arena, Vec2, m->n_vertices) : NULL;
    m->triangles = sheen_arena_alloc(arena, m->n_triangles, sizeof *m->triangles);
    return m->p && m->triangles && (m->n || !normals) && (m->uv || !uv);
}

bool sheen_mesh_place(MeshData *m, const Transform *to_world)
{
    for (uint32_t i = 0; i < m->n_vertices; ++i) m->p[i] = transform_point(to_world, m->p[i]);
    Transform inverse;
    if (!transform_invert(to_world, &inverse)) {
        m->n = NULL;
        return false;
    }
    if (m->n)
        for (uint32_t i = 0; i < m->n_vertices; ++i) m->n[i] = transform_normal(&inverse, m->n[i]);
    return true;
}

/** Angle between two vectors, safe for short and for parallel ones. */
static float angle_between(Vec3 a, Vec3 b)
{
    return atan2f(v3_length(v3_cross(a, b)), v3_dot(a, b));
}

bool sheen_mesh_smooth(SheenArena *arena, MeshData *m)
{
    m->n = SHEEN_ARENA_NEW(arena, Vec3, m->n_vertices);
    if (!m->n) return false;
    for (uint32_t i = 0; i < m->n_triangles; ++i) {
        const uint32_t *t = m->triangles[i];
        Vec3 e[3]; // e[j] leads from vertex j to the next
        for (int j = 0; j < 3; ++j) e[j] = v3_sub(m->p[t[(j + 1) % 3]], m->p[t[j]]);
        Vec3 face = v3_normalize(v3_cross(e[0], e[1]));
        if (!v3_finite(face)) continue; // the builder drops the triangle
        for (int j = 0; j < 3; ++j) m->n[t[j]] = v3_mad(m->n[t[j]], angle_between(e[j], v3_neg(e[(j + 2) % 3])), face);
    }
    // Zero where the faces cancel: the builder puts a face normal there.
    for (uint32_t i = 0; i < m->n_vertices; ++i) m->n[i] = v3_normalize(m->n[i]);
    return true;
}

static void swap_vertices(uint32_t t[3])
{
    uint32_t keep = t[1];
    t[1] = t[2];
    t[2] = keep;
}

void sheen_mesh_face_normals_side(MeshData *m)
{
    if (!m->n) return;
    for (uint32_t i = 0; i < m->n_triangles; ++i) {
        uint32_t *t = m->triangles[i];
        Vec3 face = v3_cross(v3_sub(m->p[t[1]], m->p[t[0]]), v3_sub(m->p[t[2]], m->p[t[0]]));
        Vec3 shading = v3_add(m->n[t[0]], v3_add(m->n[t[1]], m->n[t[2]]));
        if (v3_dot(face, shading) < 0.0f) swap_vertices(t);
    }
}

void sheen_mesh_flip(MeshData *m)
{
    for (uint32_t i = 0; i < m->n_triangles; ++i) swap_vertices(m->triangles[i]);
    if (m->n)
        for (uint32_t i = 0; i < m->n_vertices; ++i) m->n[i] = v3_neg(m->n[i]);
}

SheenMesh sheen_mesh_finish(const MeshData *m)
{
    return (SheenMesh){.n_vertices = m->n_vertices,
                       .n_triangles = m->n_triangles,
                       .p = m->p,
                       .n = m->n,
                       .uv = m->uv,
                       .triangles = (const uint32_t(*)[3])m->triangles,
                       .color = m->color,
                       .face_color = m->face_color};
}

bool sheen_reserve(void **array, uint32_t *capacity, uint64_t needed, size_t item_size)
{
    if (needed <= *capacity) return true;
    if (needed >= SHEEN_NONE) return false;
    uint64_t n = *capacity ? 2 * (uint64_t)*capacity : 256;
    if (n < needed) n = needed;
    if (n >= SHEEN_NONE) n = SHEEN_NONE - 1;
    if (n > SIZE_MAX / item_size) return false;
    void *grown = realloc(*array, (size_t)n * item_size);
    if (!grown) return false;
    *array = grown;
    *capacity = (uint32_t)n;
    return true;
}
