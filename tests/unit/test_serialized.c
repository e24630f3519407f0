// SPDX-License-Identifier: Apache-2.0
// Mitsuba's serialized meshes: versions, precisions, several in a file, and every way in which a file can be cut short.
#include "io/mesh.h"
#include "io_kit.h"

#include <zlib.h>

enum { NORMALS = 0x1, UV = 0x2, COLORS = 0x8, FLAT = 0x10, SINGLE = 0x1000, DOUBLES = 0x2000 };

/** A file in the making. */
typedef struct Bytes {
    unsigned char data[8192];
    size_t n;
} Bytes;

static void put(Bytes *b, uint64_t value, unsigned size)
{
    for (unsigned i = 0; i < size; ++i) b->data[b->n++] = (unsigned char)(value >> 8 * i);
}

static void put_float(Bytes *b, unsigned flags, float f)
{
    double d = (double)f;
    uint64_t u64;
    uint32_t u32;
    memcpy(&u64, &d, sizeof u64);
    memcpy(&u32, &f, sizeof u32);
    if (flags & DOUBLES)
        put(b, u64, 8);
    else
        put(b, u32, 4);
}

/** A mesh of three vertices, the second at (x, 0, 0), and `n` triangles. */
static void put_mesh(Bytes *b, unsigned version, unsigned flags, float x, uint64_t n, uint32_t last)
{
    const float p[9] = {0, 0, 0, x, 0, 0, 0, 1, 0}, normals[9] = {0, 0, 2, 0, 3, 0, 1, 0, 0};
    const float uv[6] = {0, 0, 1, 0, 0.25f, 0.75f};
    Bytes *raw = calloc(1, sizeof *raw);
    assert_non_null(raw);
    put(raw, flags, 4);
    if (version == 4) put(raw, 0x656d616e, 5); // "name" and its end
    put(raw, 3, 8);
    put(raw, n, 8);
    for (int i = 0; i < 9; ++i) put_float(raw, flags, p[i]);
    for (int i = 0; flags & NORMALS && i < 9; ++i) put_float(raw, flags, normals[i]);
    for (int i = 0; flags & UV && i < 6; ++i) put_float(raw, flags, uv[i]);
    for (int i = 0; flags & COLORS && i < 9; ++i) put_float(raw, flags, 0.5f);
    for (uint32_t i = 0; i < n && i < 4; ++i)
        for (uint32_t j = 0; j < 3; ++j) put(raw, j < 2 ? j : last, 4);
    put(b, 0x041C, 2);
    put(b, version, 2);
    uLongf size = sizeof b->data - b->n;
    assert_int_equal(compress(b->data + b->n, &size, raw->data, raw->n), Z_OK);
    b->n += size;
    free(raw);
}

/** Three meshes whose second vertices are at x = 1, 2, 3, and the dictionary. */
static void put_file(Bytes *b, unsigned version, unsigned flags)
{
    size_t at[3];
    b->n = 0;
    for (int i = 0; i < 3; ++i) {
        at[i] = b->n;
        put_mesh(b, version, i == 1 ? flags : SINGLE, (float)(i + 1), 2, 2);
    }
    for (int i = 0; i < 3; ++i) put(b, at[i], version == 4 ? 8 : 4);
    put(b, 3, 4);
}

static SheenStatus parse(Kit *k, const void *data, size_t n, uint32_t index, MeshData *m, bool *flat)
{
    k->n_errors = 0;
    return sheen_serialized_parse(data, n, "m.serialized", index, k->arena, &k->log, m, flat);
}

static void all_versions_and_precisions(void **state)
{
    Kit *k = *state;
    static const unsigned flags[] = {SINGLE, DOUBLES, SINGLE | NORMALS | FLAT, DOUBLES | UV | COLORS,
                                     SINGLE | NORMALS | UV | COLORS};
    for (unsigned version = 3; version <= 4; ++version)
        for (size_t f = 0; f < sizeof flags / sizeof *flags; ++f) {
            static Bytes b;
            MeshData m;
            bool flat;
            put_file(&b, version, flags[f]);
            for (uint32_t i = 0; i < 3; ++i) {
                assert_int_equal(parse(k, b.data, b.n, i, &m, &flat), SHEEN_OK);
                assert_int_equal(m.n_vertices, 3);
                assert_int_equal(m.n_triangles, 2);
                kit_assert_v3(m.p[1], v3((float)(i + 1), 0, 0), 0.0f);
                assert_int_equal(m.triangles[1][2], 2);
            }
            assert_int_equal(parse(k, b.data, b.n, 1, &m, &flat), SHEEN_OK);
            assert_int_equal(flat, (flags[f] & FLAT) != 0);
            assert_int_equal(m.n != NULL, (flags[f] & NORMALS) != 0);
            assert_int_equal(m.uv != NULL, (flags[f] & UV) != 0);
            if (m.n) kit_assert_v3(m.n[1], v3(0, 1, 0), 0.0f);
            if (m.uv) assert_true(m.uv[2].x == 0.25f && m.uv[2].y == 0.75f);
            assert_int_equal(parse(k, b.data, b.n, 3, &m, &flat), SHEEN_ERR_PARSE);
            assert_non_null(strstr(k->error, "mesh 3 is asked for, and the file holds 3"));
        }
}

static void every_truncation_is_refused_with_one_line(void **state)
{
    Kit *k = *state;
    static Bytes b;
    MeshData m;
    bool flat;
    put_file(&b, 4, SINGLE | NORMALS | UV);
    for (size_t n = 0; n < b.n; ++n) {
        assert_int_equal(parse(k, b.data, n, 2, &m, &flat), SHEEN_ERR_PARSE);
        assert_int_equal(k->n_errors, 1);
        assert_memory_equal(k->error, "m.serialized: ", 14);
        assert_null(m.p);
    }
    // A file of one mesh needs no dictionary, but all of its data. The last four bytes are zlib's check sum.
    b.n = 0;
    put_mesh(&b, 4, DOUBLES | NORMALS, 1, 2, 2);
    assert_int_equal(parse(k, b.data, b.n, 0, &m, &flat), SHEEN_OK);
    for (size_t n = 0; n < b.n - 8; ++n) assert_int_equal(parse(k, b.data, n, 0, &m, &flat), SHEEN_ERR_PARSE);
    assert_non_null(strstr(k->error, "ends in the middle"));
}

static void refused(Kit *k, const Bytes *b, uint32_t index, SheenStatus status, const char *what)
{
    MeshData m;
    bool flat;
    assert_int_equal(parse(k, b->data, b->n, index, &m, &flat), status);
    assert_int_equal(k->n_errors, 1);
    if (!strstr(k->error, what)) fail_msg("'%s' does not say '%s'", k->error, what);
}

static void damaged_files_are_refused(void **state)
{
    Kit *k = *state;
    static Bytes b;
    put_file(&b, 4, SINGLE);
    b.data[0] ^= 1;
    refused(k, &b, 0, SHEEN_ERR_PARSE, "m.serialized: mesh 0: not a serialized mesh");
    put_file(&b, 4, SINGLE);
    b.data[2] = 5;
    refused(k, &b, 0, SHEEN_ERR_UNSUPPORTED, "version 5");
    put_file(&b, 4, SINGLE);
    b.data[12] ^= 0xff;
    refused(k, &b, 0, SHEEN_ERR_PARSE, "mesh 0: its compressed data is damaged");
    put_file(&b, 4, SINGLE);
    b.data[b.n - 4 - 8] += 1; // place of the last mesh
    refused(k, &b, 2, SHEEN_ERR_PARSE, "mesh 2: no mesh stands at its place");
    b.data[b.n - 4 - 1] = 0xff;
    refused(k, &b, 2, SHEEN_ERR_PARSE, "mesh 2: its place is beyond");
    b.data[b.n - 1] = 0xff; // number of meshes
    refused(k, &b, 2, SHEEN_ERR_PARSE, "mesh 2 is asked for, and the file holds 0");
    b.n = 0;
    put_mesh(&b, 3, SINGLE, 1, 1, 3);
    refused(k, &b, 0, SHEEN_ERR_PARSE, "vertex index 3 is out of range: there are 3");
    // Counts are refused before memory is asked for.
    b.n = 0;
    put_mesh(&b, 3, SINGLE, 1, 4000000000u, 2);
    refused(k, &b, 0, SHEEN_ERR_PARSE, "promises more");
    b.n = 0;
    put_mesh(&b, 3, SINGLE, 1, UINT64_MAX / 12 + 2, 2);
    refused(k, &b, 0, SHEEN_ERR_PARSE, "promises more");
    const uint64_t counts[] = {200000000, 4294967294, 4294967296, UINT64_MAX};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; ++i) {
        Bytes raw = {.n = 0};
        put(&raw, SINGLE, 4);
        put(&raw, counts[i], 8);
        put(&raw, 0, 8);
        b.n = 0;
        put(&b, 0x041C, 2);
        put(&b, 3, 2);
        uLongf size = sizeof b.data - b.n;
        assert_int_equal(compress(b.data + b.n, &size, raw.data, raw.n), Z_OK);
        b.n += size;
        refused(k, &b, 0, SHEEN_ERR_PARSE, "promises more");
    }
}

static void scenes_name_the_mesh_by_its_index(void **state)
{
    Kit *k = *state;
    static Bytes b;
    put_file(&b, 4, SINGLE | NORMALS | FLAT);
    kit_write_bytes(k, "m.serialized", b.data, b.n);
#define SHAPE(more) "<shape type=\"serialized\"><string name=\"filename\" value=\"m.serialized\"/>" more "</shape>"
    const SheenScene *s = kit_scene(k, SHAPE("<integer name=\"shapeIndex\" value=\"1\"/>"));
    kit_assert_v3(s->bounds.hi, v3(2, 1, 0), 0.0f);
    assert_null(s->shapes[0].mesh.n); // the file asks for flat faces
    s = kit_scene(k, SHAPE("<integer name=\"shape_index\" value=\"2\"/><transform name=\"to_world\">"
                           "<scale value=\"2\"/></transform>"));
    kit_assert_v3(s->bounds.hi, v3(6, 2, 0), 0.0f);
    assert_non_null(s->shapes[0].mesh.n); // made as for other files without normals
    s = kit_scene(k, SHAPE("<boolean name=\"faceNormals\" value=\"true\"/>"));
    assert_null(s->shapes[0].mesh.n);
    kit_refused(k, SHAPE("<integer name=\"shape_index\" value=\"-1\"/>"), SHEEN_ERR_PARSE, "scene.xml:2:1",
                "'shape_index' is out of range");
    kit_refused(k, SHAPE("<integer name=\"shape_index\" value=\"7\"/>"), SHEEN_ERR_PARSE, "m.serialized",
                "mesh 7 is asked for, and the file holds 3");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        KIT_TEST(all_versions_and_precisions),
        KIT_TEST(every_truncation_is_refused_with_one_line),
        KIT_TEST(damaged_files_are_refused),
        KIT_TEST(scenes_name_the_mesh_by_its_index),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
