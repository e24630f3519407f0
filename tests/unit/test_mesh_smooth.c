// SPDX-License-Identifier: Apache-2.0
// Normals with edges: by angle, by group, across seams of uv.
#include "io/mesh_smooth.h"

#include "io_kit.h"

/** Two unit squares that meet at the edge x = 0 under `fold` radians from flat, with separate vertices as at a seam. */
static MeshData folded(Kit *k, float fold)
{
    MeshData m = {.n_vertices = 8, .n_triangles = 4};
    assert_true(sheen_mesh_alloc(k->arena, &m, false, true));
    for (int side = 0; side < 2; ++side)
        for (int i = 0; i < 4; ++i) {
            float along = (float)(i & 1), out = (float)(i / 2);
            m.p[4 * side + i] = side ? v3(out * cosf(fold), along, -out * sinf(fold)) : v3(-out, along, 0.0f);
            m.uv[4 * side + i] = v2((float)side, along);
        }
    const uint32_t t[4][3] = {{0, 1, 3}, {0, 3, 2}, {4, 7, 5}, {4, 6, 7}};
    memcpy(m.triangles, t, sizeof t);
    return m;
}

static Vec3 normal_at(const MeshData *m, uint32_t triangle, Vec3 p)
{
    for (int j = 0; j < 3; ++j) {
        uint32_t v = m->triangles[triangle][j];
        if (v3_length(v3_sub(m->p[v], p)) < 1e-6f) return m->n[v];
    }
    fail_msg("no such corner");
    return v3(0, 0, 0);
}

static void edges_by_angle(void **state)
{
    Kit *k = *state;
    const float fold = 0.5f;
    MeshData m = folded(k, fold);
    assert_true(sheen_mesh_smooth_edges(k->arena, &m, NULL, fold + 0.01f));
    // Right angles in both squares: the mean, on both sides of the seam, which stays.
    for (uint32_t t = 0; t < 4; t += 2)
        kit_assert_v3(normal_at(&m, t, v3(0, 0, 0)), v3(sinf(fold / 2), 0, cosf(fold / 2)), 1e-6f);
    kit_assert_v3(normal_at(&m, 0, v3(-1, 1, 0)), v3(0, 0, 1), 1e-6f);
    assert_int_equal(m.n_vertices, 8);
    for (uint32_t t = 0; t < 4; ++t)
        for (int j = 0; j < 3; ++j) assert_true(m.uv[m.triangles[t][j]].x == (float)(t / 2));
    m = folded(k, fold);
    assert_true(sheen_mesh_smooth_edges(k->arena, &m, NULL, fold - 0.01f));
    kit_assert_v3(normal_at(&m, 0, v3(0, 0, 0)), v3(0, 0, 1), 1e-6f);
    kit_assert_v3(normal_at(&m, 2, v3(0, 0, 0)), v3(sinf(fold), 0, cosf(fold)), 1e-6f);
}

static void edges_by_group(void **state)
{
    Kit *k = *state;
    const uint32_t same[4] = {3, 3, 3, 3}, two[4] = {3, 3, 4, 4}, none[4] = {0, 0, 0, 0};
    MeshData m = folded(k, 1.0f);
    assert_true(sheen_mesh_smooth_edges(k->arena, &m, same, SHEEN_PI));
    kit_assert_v3(normal_at(&m, 0, v3(0, 1, 0)), v3(sinf(0.5f), 0, cosf(0.5f)), 1e-6f);
    for (int i = 0; i < 2; ++i) {
        m = folded(k, 1.0f);
        assert_true(sheen_mesh_smooth_edges(k->arena, &m, i ? none : two, SHEEN_PI));
        kit_assert_v3(normal_at(&m, 0, v3(0, 1, 0)), v3(0, 0, 1), 1e-6f);
        kit_assert_v3(normal_at(&m, 2, v3(0, 1, 0)), v3(sinf(1.0f), 0, cosf(1.0f)), 1e-6f);
    }
}

/** A shared vertex is split where the faces at it do not belong together. */
static void shared_vertices_are_split(void **state)
{
    Kit *k = *state;
    MeshData m = folded(k, 1.0f);
    const uint32_t t[4][3] = {{0, 1, 3}, {0, 3, 2}, {0, 7, 1}, {0, 6, 7}};
    memcpy(m.triangles, t, sizeof t);
    assert_true(sheen_mesh_smooth_edges(k->arena, &m, NULL, 0.5f));
    assert_int_equal(m.n_vertices, 8);
    kit_assert_v3(normal_at(&m, 2, v3(0, 1, 0)), v3(sinf(1.0f), 0, cosf(1.0f)), 1e-6f);
    for (uint32_t i = 0; i < 4; ++i)
        for (int j = 0; j < 3; ++j) assert_true(m.triangles[i][j] < m.n_vertices);
}

/** Thousands of triangles at one place take no more than a moment; without area they have no normal. */
static void crowded_places_and_flat_triangles(void **state)
{
    Kit *k = *state;
    enum { N = 100000 };
    MeshData m = {.n_vertices = N + 1, .n_triangles = N};
    assert_true(sheen_mesh_alloc(k->arena, &m, false, false));
    for (uint32_t i = 0; i < N; ++i) {
        float a = 2.0f * SHEEN_PI * (float)i / N;
        m.p[i + 1] = v3(cosf(a), sinf(a), -0.1f);
        const uint32_t t[3] = {0, i + 1, i + 1 < N ? i + 2 : 1};
        memcpy(m.triangles[i], t, sizeof t);
    }
    assert_true(sheen_mesh_smooth_edges(k->arena, &m, NULL, 0.001f));
    kit_assert_v3(m.n[m.triangles[7][0]], v3(0, 0, 1), 1e-3f); // sums of float angles of 6e-5 each
    m = folded(k, 0.0f);
    m.p[1] = v3(NAN, 0, 0);
    assert_true(sheen_mesh_smooth_edges(k->arena, &m, NULL, 1.0f));
    kit_assert_v3(normal_at(&m, 1, v3(-1, 0, 0)), v3(0, 0, 1), 1e-6f);
    MeshData empty = {0};
    assert_true(sheen_mesh_smooth_edges(k->arena, &empty, NULL, 1.0f));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        KIT_TEST(edges_by_angle),
        KIT_TEST(edges_by_group),
        KIT_TEST(shared_vertices_are_split),
        KIT_TEST(crowded_places_and_flat_triangles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
