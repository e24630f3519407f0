// SPDX-License-Identifier: Apache-2.0
// The PLY reader: formats, types, skipping, refusals.
#include "io/mesh.h"
#include "io_kit.h"

static SheenStatus parse(Kit *k, const void *data, size_t size, MeshData *m)
{
    k->n_errors = k->n_warnings = 0;
    return sheen_ply_parse(data, size, "mesh.ply", k->arena, &k->log, m);
}

static const char ascii[] = "ply\nformat ascii 1.0\ncomment by hand\nobj_info x\n"
                            "element vertex 4\nproperty float x\nproperty float y\nproperty double z\n"
                            "property float nx\nproperty float ny\nproperty float nz\n"
                            "property uchar red\nproperty float s\nproperty float t\n"
                            "element edge 1\nproperty int a\nproperty list uchar int b\n"
                            "element face 2\nproperty list uchar int vertex_indices\nproperty uchar flags\n"
                            "end_header\n"
                            "0 0 0 0 0 2 255 0 0\n1 0 0 0 0 2 255 1 0\n1 1 0 0 0 2 255 1 1\n0 1 0 0 0 2 255 0 1\n"
                            "7 2 5 6\n"
                            "4 0 1 2 3 9\n3 2 1 0 9\n";

static void ascii_with_other_elements(void **state)
{
    Kit *k = *state;
    MeshData m;
    assert_int_equal(parse(k, ascii, sizeof ascii - 1, &m), SHEEN_OK);
    assert_int_equal(m.n_vertices, 4);
    assert_int_equal(m.n_triangles, 3);
    const uint32_t want[3][3] = {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}};
    assert_memory_equal(m.triangles, want, sizeof want);
    kit_assert_v3(m.p[2], v3(1, 1, 0), 0.0f);
    kit_assert_v3(m.n[1], v3(0, 0, 1), 0.0f);
    assert_float_equal(m.uv[3].y, 1.0f, 0.0f);
}

/** Each further vertex is a triangle, every second turned; -1 begins another strip, a repeated vertex joins two. */
static void strips_of_triangles(void **state)
{
    Kit *k = *state;
    MeshData m;
    static const char strips[] = "ply\r\nformat ascii 1.0\r\nelement vertex 5\r\nproperty float x\r\nproperty float "
                                 "y\r\nproperty float z\r\nelement tristrips 1\r\nproperty list int int "
                                 "vertex_indices\r\nend_header\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n1 1 0\r\n0 2 0\r\n"
                                 "14 0 1 2 3 4 -1 2 3 4 4 0 0 1 2\r\n";
    assert_int_equal(parse(k, strips, sizeof strips - 1, &m), SHEEN_OK);
    const uint32_t want[][3] = {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {2, 3, 4}, {1, 0, 2}};
    assert_int_equal(m.n_triangles, 5);
    assert_memory_equal(m.triangles, want, sizeof want);
    char bad[sizeof strips];
    memcpy(bad, strips, sizeof bad);
    strcpy(strstr(bad, "14 0"), "3 0 1 5\n");
    assert_int_equal(parse(k, bad, strlen(bad), &m), SHEEN_ERR_PARSE);
    assert_non_null(strstr(k->error, "vertex index 5 is out of range"));
}

/** Appends the low `size` bytes of a value in either order. */
static void put(unsigned char *buffer, size_t *n, uint64_t bits, unsigned size, bool big)
{
    for (unsigned i = 0; i < size; ++i) buffer[(*n)++] = (unsigned char)(bits >> (8 * (big ? size - 1 - i : i)));
}

static uint64_t float_bits(float f)
{
    uint32_t u;
    memcpy(&u, &f, sizeof u);
    return u;
}

static uint64_t double_bits(double d)
{
    uint64_t u;
    memcpy(&u, &d, sizeof u);
    return u;
}

/** Three vertices of every type and one triangle. */
static size_t binary_mesh(unsigned char *buffer, bool big)
{
    size_t n = (size_t)sprintf((char *)buffer,
                               "ply\nformat binary_%s_endian 1.0\nelement vertex 3\nproperty double x\n"
                               "property short y\nproperty char z\nproperty ushort skipped\n"
                               "property list uchar float skipped_list\nproperty float texture_u\n"
                               "property float texture_v\nelement face 1\n"
                               "property list uint ushort vertex_index\nend_header\n",
                               big ? "big" : "little");
    for (int i = 0; i < 3; ++i) {
        put(buffer, &n, double_bits(i + 0.5), 8, big);
        put(buffer, &n, (uint64_t)(int64_t)(-300 * i), 2, big);
        put(buffer, &n, (uint64_t)(int64_t)(-i), 1, big);
        put(buffer, &n, 65535, 2, big);
        put(buffer, &n, 2, 1, big);
        put(buffer, &n, float_bits(9.0f), 4, big);
        put(buffer, &n, float_bits(9.0f), 4, big);
        put(buffer, &n, float_bits(0.25f * (float)i), 4, big);
        put(buffer, &n, float_bits(0.75f), 4, big);
    }
    put(buffer, &n, 3, 4, big);
    for (unsigned i = 0; i < 3; ++i) put(buffer, &n, 2 - i, 2, big);
    return n;
}

static void binary_of_both_orders_and_all_types(void **state)
{
    Kit *k = *state;
    for (int big = 0; big < 2; ++big) {
        unsigned char buffer[1024];
        MeshData m;
        size_t n = binary_mesh(buffer, big);
        assert_int_equal(parse(k, buffer, n, &m), SHEEN_OK);
        kit_assert_v3(m.p[2], v3(2.5f, -600.0f, -2.0f), 0.0f);
        assert_float_equal(m.uv[2].x, 0.5f, 0.0f);
        assert_null(m.n);
        const uint32_t want[3] = {2, 1, 0};
        assert_memory_equal(m.triangles[0], want, sizeof want);
        for (size_t cut = 0; cut < n; ++cut) { // every truncation is refused with one line
            assert_int_equal(parse(k, buffer, cut, &m), SHEEN_ERR_PARSE);
            assert_int_equal(k->n_errors, 1);
            assert_null(m.triangles);
        }
    }
}

static void refused(Kit *k, const char *text, const char *what)
{
    MeshData m;
    assert_int_equal(parse(k, text, strlen(text), &m), SHEEN_ERR_PARSE);
    assert_int_equal(k->n_errors, 1);
    if (!strstr(k->error, what) || strncmp(k->error, "mesh.ply:", 9) != 0)
        fail_msg("'%s' does not say '%s'", k->error, what);
}

static void broken_files_are_refused(void **state)
{
    Kit *k = *state;
#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define FACES "property list uchar int vertex_indices\nend_header\n"
    refused(k, "", "not a PLY");
    refused(k, "plx\n", "mesh.ply:1: not a PLY");
    refused(k, "ply\nformat ascii 1.0\n", "does not end");
    refused(k, "ply\nend_header\n", "no format");
    refused(k, "ply\nformat middle_endian 1.0\n", "mesh.ply:2: unknown format");
    refused(k, "ply\nformat ascii 1.0\nelement vertex -1\n", "mesh.ply:3: bad number");
    refused(k, "ply\nformat ascii 1.0\nelement vertex\n", "expected 'element");
    refused(k, "ply\nformat ascii 1.0\nproperty float x\n", "bad property");
    refused(k, "ply\nformat ascii 1.0\nelement vertex 0\nproperty complex x\n", "unknown property type");
    refused(k, "ply\nformat ascii 1.0\nelement vertex 0\nproperty list float int x\n", "must be an integer");
    refused(k, "ply\nformat ascii 1.0\nnonsense\n", "mesh.ply:3: unknown word");
    refused(k, "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n", "no vertex positions");
    // Counts far beyond the file are refused before any memory is asked for.
    refused(k, "ply\nformat ascii 1.0\nelement vertex 4000000000\n" XYZ "end_header\n0 0 0\n", "promises more");
    refused(k, "ply\nformat binary_little_endian 1.0\nelement vertex 9223372036854775807\n" XYZ "end_header\n",
            "promises more");
    refused(k, "ply\nformat ascii 1.0\nelement vertex 3\nend_header\n", "promises more");
    refused(k, "ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "element face 1\n" FACES "0 0 0\n3 0 0 1\n",
            "vertex index 1 is out of range: there are 1");
    refused(k, "ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "element face 1\n" FACES "0 0 0\n3 0 0 -1\n",
            "vertex index -1 is out of range");
    refused(k, "ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "element face 1\n" FACES "0 0 0\n-3 0 0 0\n",
            "mesh.ply:11: bad length");
    refused(k, "ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "element face 1\n" FACES "0 0 0\n200 0 0 0\n",
            "ends in the middle");
    refused(k, "ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "end_header\n0 zero 0\n", "expected a number");
    refused(k, "ply\nformat ascii 1.0\nelement vertex 0\n" XYZ "element vertex 0\n" XYZ "end_header\n",
            "more than one");
}

static void an_empty_mesh_is_no_error(void **state)
{
    Kit *k = *state;
    MeshData m;
    const char *text = "ply\r\nformat ascii 1.0\r\nelement vertex 0\r\n" XYZ "element face 0\r\n" FACES;
    assert_int_equal(parse(k, text, strlen(text), &m), SHEEN_OK);
    assert_int_equal(m.n_vertices + m.n_triangles, 0);
}

/** Two faces that meet at a right angle: Mitsuba 3 gives these normals for the same file. */
static void smooth_normals_are_weighted_by_angle(void **state)
{
    Kit *k = *state;
    MeshData m;
    const char *text = "ply\nformat ascii 1.0\nelement vertex 5\n" XYZ "element face 2\n" FACES
                       "0 0 0\n1 0 0\n0 1 0\n0 0 1\n4 4 4\n3 0 1 2\n3 0 2 3\n";
    assert_int_equal(parse(k, text, strlen(text), &m), SHEEN_OK);
    assert_true(sheen_mesh_smooth(k->arena, &m));
    kit_assert_v3(m.n[0], v3(0.7071068f, 0, 0.7071068f), 1e-6f); // right angles in both faces
    kit_assert_v3(m.n[1], v3(0, 0, 1), 1e-6f);
    kit_assert_v3(m.n[3], v3(1, 0, 0), 1e-6f);
    kit_assert_v3(m.n[4], v3(0, 0, 0), 0.0f); // of no face: left to the builder
    // The angles count, not areas or edges: with a longer first face, vertex 0 has the same normal.
    m.p[1] = v3(10, 0, 0);
    assert_true(sheen_mesh_smooth(k->arena, &m));
    kit_assert_v3(m.n[0], v3(0.7071068f, 0, 0.7071068f), 1e-6f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        KIT_TEST(ascii_with_other_elements),           KIT_TEST(strips_of_triangles),
        KIT_TEST(binary_of_both_orders_and_all_types), KIT_TEST(broken_files_are_refused),
        KIT_TEST(an_empty_mesh_is_no_error),           KIT_TEST(smooth_normals_are_weighted_by_angle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
