// SPDX-License-Identifier: Apache-2.0
#include "io/mesh_smooth.h"

#include "base/hash.h"

#include <stdlib.h>
#include <string.h>

/** More triangles than this at one place are smoothed together whatever their angles: time grows with the square. */
enum { MAX_VALENCE = 512 };

/** All from malloc. Corner c of triangle t has the number 3 t + c. */
typedef struct Work {
    const MeshData *m;
    const uint32_t *groups;
    float cos_max;
    uint32_t *place;   // [n_vertices] of each vertex
    uint32_t n_places; // vertices in the same place share one
    uint32_t *first;   // [n_places + 1] into corners
    uint32_t *corners; // [3 n_triangles] by place
    Vec3 *face;        // [n_triangles] unit normals, zero for a triangle without area
    float *angle;      // [3 n_triangles]
    Vec3 *normal;      // [3 n_triangles]
} Work;

static uint32_t hash_position(Vec3 p)
{
    uint32_t bits[3];
    memcpy(bits, &p, sizeof bits);
    return hash_combine(hash_combine(hash_u32(bits[0]), bits[1]), bits[2]);
}

/** Compares bits, so that NaN equals itself. */
static bool same(Vec3 a, Vec3 b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/** A vertex's place, with -0 as 0. */
static Vec3 place_of(const MeshData *m, uint32_t vertex)
{
    return v3_add(m->p[vertex], v3(0, 0, 0));
}

static bool find_places(Work *w)
{
    uint64_t size = 16;
    while (size / 2 < w->m->n_vertices) size *= 2;
    uint32_t *table = malloc((size_t)size * sizeof *table);
    if (!table) return false;
    memset(table, 0xff, (size_t)size * sizeof *table);
    for (uint32_t i = 0; i < w->m->n_vertices; ++i) {
        uint64_t slot = hash_position(place_of(w->m, i)) & (size - 1);
        while (table[slot] != SHEEN_NONE && !same(place_of(w->m, table[slot]), place_of(w->m, i)))
            slot = (slot + 1) & (size - 1);
        if (table[slot] == SHEEN_NONE) {
            table[slot] = i;
            w->place[i] = w->n_places++;
        } else {
            w->place[i] = w->place[table[slot]];
        }
    }
    free(table);
    return true;
}

/** Sorts the corners by place; their order within a place is that of the triangles. */
static void sort_corners(Work *w)
{
    uint32_t n = 3 * w->m->n_triangles;
    const uint32_t *vertex = &w->m->triangles[0][0];
    for (uint32_t c = 0; c < n; ++c) w->first[w->place[vertex[c]] + 1]++;
    for (uint32_t i = 0; i < w->n_places; ++i) w->first[i + 1] += w->first[i];
    for (uint32_t c = n; c-- > 0;) w->corners[--w->first[w->place[vertex[c]] + 1]] = c;
    // first[i + 1] is now where place i begins.
    memmove(w->first, w->first + 1, (size_t)w->n_places * sizeof *w->first);
    w->first[w->n_places] = n;
}

static void measure_triangle(Work *w, uint32_t i)
{
    const uint32_t *t = w->m->triangles[i];
    Vec3 e[3];
    for (int j = 0; j < 3; ++j) e[j] = v3_sub(w->m->p[t[(j + 1) % 3]], w->m->p[t[j]]);
    Vec3 face = v3_normalize(v3_cross(e[0], e[1]));
    if (!v3_finite(face)) return; // the builder drops the triangle
    w->face[i] = face;
    for (int j = 0; j < 3; ++j) {
        Vec3 a = e[j], b = v3_neg(e[(j + 2) % 3]);
        w->angle[3 * i + (uint32_t)j] = atan2f(v3_length(v3_cross(a, b)), v3_dot(a, b));
    }
}

static bool belong_together(const Work *w, uint32_t a, uint32_t b)
{
    if (a == b) return true;
    if (w->groups && (w->groups[a] != w->groups[b] || w->groups[a] == 0)) return false;
    return v3_dot(w->face[a], w->face[b]) >= w->cos_max;
}

static void sum_normals(Work *w, uint32_t place)
{
    uint32_t begin = w->first[place], end = w->first[place + 1];
    bool crowded = end - begin > MAX_VALENCE;
    Vec3 all = v3(0, 0, 0);
    for (uint32_t i = begin; crowded && i < end; ++i)
        all = v3_mad(all, w->angle[w->corners[i]], w->face[w->corners[i] / 3]);
    for (uint32_t i = begin; i < end; ++i) {
        Vec3 sum = all;
        for (uint32_t j = begin; !crowded && j < end; ++j) {
            uint32_t c = w->corners[j];
            if (belong_together(w, w->corners[i] / 3, c / 3)) sum = v3_mad(sum, w->angle[c], w->face[c / 3]);
        }
        w->normal[w->corners[i]] = v3_normalize(sum);
    }
}

/**
 * Makes a vertex for each normal that occurs at an old one. @param chain  [3 n_triangles] vertices made of the same old
 * one, from head[old]
 */
static bool split_vertices(const Work *w, SheenArena *arena, MeshData *out, uint32_t *head, uint32_t *chain,
                           uint32_t *source)
{
    uint32_t n = 0, n_corners = 3 * w->m->n_triangles;
    const uint32_t *vertex = &w->m->triangles[0][0];
    Vec3 *normal = malloc((size_t)n_corners * sizeof *normal + 1);
    uint32_t *made = malloc((size_t)n_corners * sizeof *made + 1);
    memset(head, 0xff, (size_t)w->m->n_vertices * sizeof *head);
    for (uint32_t c = 0; normal && made && c < n_corners; ++c) {
        uint32_t v = head[vertex[c]];
        while (v != SHEEN_NONE && !same(normal[v], w->normal[c])) v = chain[v];
        if (v == SHEEN_NONE) {
            v = n++;
            normal[v] = w->normal[c];
            source[v] = vertex[c];
            chain[v] = head[vertex[c]];
            head[vertex[c]] = v;
        }
        made[c] = v;
    }
    *out = (MeshData){.n_vertices = n, .n_triangles = w->m->n_triangles, .face_color = w->m->face_color};
    bool ok = normal && made && sheen_mesh_alloc(arena, out, true, w->m->uv != NULL);
    if (ok && w->m->color) ok = (out->color = SHEEN_ARENA_NEW(arena, Rgb, n)) != NULL;
    for (uint32_t i = 0; ok && i < n; ++i) {
        out->p[i] = w->m->p[source[i]];
        out->n[i] = normal[i];
        if (out->uv) out->uv[i] = w->m->uv[source[i]];
        if (out->color) out->color[i] = w->m->color[source[i]];
    }
    if (ok) memcpy(out->triangles, made, (size_t)n_corners * sizeof *made);
    free(normal);
    free(made);
    return ok;
}

bool sheen_mesh_smooth_edges(SheenArena *arena, MeshData *m, const uint32_t *groups, float max_angle)
{
    if (m->n_triangles == 0) return true;
    if (m->n_triangles > UINT32_MAX / 3 - 1) return false;
    size_t v = (size_t)m->n_vertices + 1, c = 3 * (size_t)m->n_triangles;
    Work w = {.m = m, .groups = groups, .cos_max = cosf(clampf(max_angle, 0.0f, SHEEN_PI)) - 1e-6f}; // for rounding
    w.place = malloc(v * sizeof *w.place);
    w.first = calloc(v + 1, sizeof *w.first);
    w.corners = malloc(c * sizeof *w.corners);
    w.face = calloc(m->n_triangles, sizeof *w.face);
    w.angle = calloc(c, sizeof *w.angle);
    w.normal = malloc(c * sizeof *w.normal);
    uint32_t *source = malloc(c * sizeof *source);
    MeshData out;
    bool ok = w.place && w.first && w.corners && w.face && w.angle && w.normal && source && find_places(&w);
    if (ok) {
        sort_corners(&w);
        for (uint32_t i = 0; i < m->n_triangles; ++i) measure_triangle(&w, i);
        for (uint32_t i = 0; i < w.n_places; ++i) sum_normals(&w, i);
        // The places have served: their arrays hold the chains.
        ok = split_vertices(&w, arena, &out, w.place, w.corners, source);
    }
    if (ok) *m = out;
    free(w.place);
    free(w.first);
    free(w.corners);
    free(w.face);
    free(w.angle);
    free(w.normal);
    free(source);
    return ok;
}
