// SPDX-License-Identifier: Apache-2.0
#include "io/primitive.h"

#include <string.h>

/** Two triangles over four vertices that run counter-clockwise. */
static void put_quad(uint32_t t[2][3], uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    const uint32_t quad[2][3] = {{a, b, c}, {d, a, c}};
    memcpy(t, quad, sizeof quad);
}

bool sheen_primitive_rectangle(SheenArena *arena, MeshData *out)
{
    *out = (MeshData){.n_vertices = 4, .n_triangles = 2};
    if (!sheen_mesh_alloc(arena, out, true, true)) return false;
    // Mitsuba's uv is (0, 0) at (-1, -1), and its v runs downward in a picture.
    static const float corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int i = 0; i < 4; ++i) {
        float u = corners[i][0], v = corners[i][1];
        out->p[i] = v3(2.0f * u - 1.0f, 2.0f * v - 1.0f, 0.0f);
        out->n[i] = v3(0, 0, 1);
        out->uv[i] = v2(u, 1.0f - v);
    }
    put_quad(out->triangles, 0, 1, 2, 3);
    return true;
}

bool sheen_primitive_cube(SheenArena *arena, MeshData *out)
{
    *out = (MeshData){.n_vertices = 24, .n_triangles = 12};
    if (!sheen_mesh_alloc(arena, out, true, true)) return false;
    // Six faces of four corners each, in the order and with the uv of Mitsuba's own cube.
    static const signed char corners[6][4][3] = {
        {{1, -1, -1}, {1, -1, 1}, {-1, -1, 1}, {-1, -1, -1}}, {{1, 1, -1}, {-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}},
        {{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}},     {{1, -1, 1}, {1, 1, 1}, {-1, 1, 1}, {-1, -1, 1}},
        {{-1, -1, 1}, {-1, 1, 1}, {-1, 1, -1}, {-1, -1, -1}}, {{1, 1, -1}, {1, -1, -1}, {-1, -1, -1}, {-1, 1, -1}}};
    static const signed char normals[6][3] = {{0, -1, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, -1}};
    static const float uv[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}; // Mitsuba's, with v turned upward
    for (uint32_t f = 0; f < 6; ++f) {
        for (uint32_t i = 0; i < 4; ++i) {
            const signed char *c = corners[f][i];
            out->p[4 * f + i] = v3(c[0], c[1], c[2]);
            out->n[4 * f + i] = v3(normals[f][0], normals[f][1], normals[f][2]);
            out->uv[4 * f + i] = v2(uv[i][0], uv[i][1]);
        }
        put_quad(&out->triangles[2 * f], 4 * f, 4 * f + 1, 4 * f + 2, 4 * f + 3);
    }
    return true;
}

bool sheen_primitive_sphere(SheenArena *arena, MeshData *out)
{
    enum { AROUND = 128, DOWN = 64 };
    *out = (MeshData){.n_vertices = (AROUND + 1) * (DOWN + 1), .n_triangles = 2 * AROUND * (DOWN - 1)};
    if (!sheen_mesh_alloc(arena, out, true, true)) return false;
    for (uint32_t j = 0, i = 0; j <= DOWN; ++j)
        for (uint32_t k = 0; k <= AROUND; ++k, ++i) {
            float u = (float)k / AROUND, v = (float)j / DOWN;
            float s = j == DOWN ? 0.0f : sinf(SHEEN_PI * v); // both poles are points
            out->p[i] = v3(s * cosf(2.0f * SHEEN_PI * u), s * sinf(2.0f * SHEEN_PI * u), cosf(SHEEN_PI * v));
            out->n[i] = out->p[i];
            out->uv[i] = v2(u, 1.0f - v);
        }
    uint32_t n = 0;
    for (uint32_t j = 0; j < DOWN; ++j)
        for (uint32_t k = 0; k < AROUND; ++k) {
            uint32_t a = j * (AROUND + 1) + k, b = a + AROUND + 1; // b below a
            const uint32_t upper[3] = {a, b, a + 1}, lower[3] = {a + 1, b, b + 1};
            if (j > 0) memcpy(out->triangles[n++], upper, sizeof upper); // no area at the poles
            if (j < DOWN - 1) memcpy(out->triangles[n++], lower, sizeof lower);
        }
    return true;
}

bool sheen_primitive_tube(SheenArena *arena, MeshData *out)
{
    enum { AROUND = 256 };
    *out = (MeshData){.n_vertices = 2 * (AROUND + 1), .n_triangles = 2 * AROUND};
    if (!sheen_mesh_alloc(arena, out, true, true)) return false;
    for (uint32_t i = 0; i < out->n_vertices; ++i) {
        float u = (float)(i / 2) / AROUND, v = (float)(i % 2);
        out->n[i] = v3(cosf(2.0f * SHEEN_PI * u), sinf(2.0f * SHEEN_PI * u), 0.0f);
        out->p[i] = v3(out->n[i].x, out->n[i].y, v);
        out->uv[i] = v2(u, 1.0f - v);
    }
    for (uint32_t i = 0; i < AROUND; ++i) put_quad(&out->triangles[2 * i], 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1);
    return true;
}
