// SPDX-License-Identifier: Apache-2.0
// The OBJ reader and the numbers under it.
#include "base/clock.h"
#include "io/number.h"
#include "io/obj.h"
#include "io_kit.h"

static SheenStatus parse(Kit *k, const char *text, MeshData *m)
{
    k->n_errors = k->n_warnings = 0;
    return sheen_obj_parse(text, strlen(text), "mesh.obj", k->arena, &k->log, m);
}

static void refused(Kit *k, const char *text, const char *line)
{
    MeshData m;
    assert_int_equal(parse(k, text, &m), SHEEN_ERR_PARSE);
    assert_int_equal(k->n_errors, 1);
    assert_int_equal(m.n_triangles, 0);
    if (strncmp(k->error, line, strlen(line)) != 0) fail_msg("'%s' does not begin '%s'", k->error, line);
}

static const char square[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

static char *joined(Kit *k, const char *a, const char *b)
{
    char *text = sheen_arena_alloc(k->arena, strlen(a) + strlen(b) + 1, 1);
    strcpy(text, a);
    return strcat(text, b);
}

static void polygons_become_fans(void **state)
{
    Kit *k = *state;
    MeshData m;
    assert_int_equal(parse(k, joined(k, square, "f 1 2 3 4\n"), &m), SHEEN_OK);
    assert_int_equal(m.n_vertices, 4);
    assert_int_equal(m.n_triangles, 2);
    const uint32_t want[2][3] = {{0, 1, 2}, {0, 2, 3}};
    assert_memory_equal(m.triangles, want, sizeof want);
    assert_null(m.n);
    assert_null(m.uv);
    kit_assert_v3(m.p[2], v3(1, 1, 0), 0.0f);
}

static void all_index_forms_are_read(void **state)
{
    Kit *k = *state;
    MeshData m;
    const char *more = "vt 0.5 0.25 0\nvt 1\nvn 0 0 2\nvn 0 3 0\n"
                       "f 1/1/1 2/2/1 3//2\nf -4/-2 -3/-1 -1/1\nf 1/1/1 2/2/1 4\n";
    assert_int_equal(parse(k, joined(k, square, more), &m), SHEEN_OK);
    assert_int_equal(m.n_triangles, 3);
    assert_int_equal(m.n_vertices, 7); // 1/1/1 and 2/2/1 are shared by two faces, the rest differ
    kit_assert_v3(m.n[0], v3(0, 0, 1), 0.0f);
    kit_assert_v3(m.n[2], v3(0, 1, 0), 0.0f);
    assert_float_equal(m.uv[0].x, 0.5f, 0.0f);
    assert_float_equal(m.uv[0].y, 0.25f, 0.0f);
    assert_float_equal(m.uv[1].x, 1.0f, 0.0f);
    assert_float_equal(m.uv[1].y, 0.0f, 0.0f);
    kit_assert_v3(m.p[m.triangles[1][2]], v3(0, 1, 0), 0.0f);
    assert_int_equal(m.triangles[0][0], m.triangles[2][0]);
}

/** Corners that share all but one index must stay apart in the hash table, collisions included. */
static void equal_corners_are_shared_and_no_others(void **state)
{
    Kit *k = *state;
    enum { N = 3000 };
    char *text = malloc(N * 64), *at = text;
    assert_non_null(text);
    at += sprintf(at, "%svn 0 0 1\nvn 0 1 0\n", square);
    for (int i = 0; i < N; ++i) at += sprintf(at, "vt %d 0\n", i);
    for (int i = 1; i <= N; ++i) at += sprintf(at, "f 1/%d/1 2/%d/1 1/%d/2\n", i, i, i);
    MeshData m;
    SheenStatus s = parse(k, text, &m);
    free(text);
    assert_int_equal(s, SHEEN_OK);
    assert_int_equal(m.n_vertices, 3 * N);
    for (uint32_t i = 0; i < N; ++i)
        for (int j = 0; j < 3; ++j) {
            uint32_t v = m.triangles[i][j];
            assert_true(m.uv[v].x == (float)i && m.p[v].x == (float)(j == 1) && m.n[v].y == (float)(j == 2));
        }
}

static void line_ends_comments_and_groups_do_not_matter(void **state)
{
    Kit *k = *state;
    MeshData m;
    const char *text = "# a comment\r\nmtllib a b.mtl\r\no thing\r\n  v 0 0 0\r\nv\t1 0 \\\r\n 0\r\nv 1 1 0 1.0\r\n\r\n"
                       "g a b\r\ns off\r\nusemtl x\r\nf 1 2 \\\n 3 # a face";
    assert_int_equal(parse(k, text, &m), SHEEN_OK);
    assert_int_equal(m.n_triangles, 1);
    assert_int_equal(k->n_warnings, 0);
    kit_assert_v3(m.p[1], v3(1, 0, 0), 0.0f);
    assert_int_equal(parse(k, "curv 0 1 2\nblob\n", &m), SHEEN_OK);
    assert_int_equal(k->n_warnings, 1); // once a file
    assert_int_equal(parse(k, "", &m), SHEEN_OK);
    assert_int_equal(m.n_triangles, 0);
}

static void bad_lines_are_refused_with_their_number(void **state)
{
    Kit *k = *state;
    refused(k, "v 0 0\n", "mesh.obj:1: expected 3 numbers");
    refused(k, "v 0 0 0\nv 1 x 0\n", "mesh.obj:2: ");
    refused(k, "\n\\\n\nvn 1 2\n", "mesh.obj:4: ");
    refused(k, "vt\n", "mesh.obj:1: ");
    refused(k, joined(k, square, "f 1 2 5\n"), "mesh.obj:5: vertex index 5 is out of range: there are 4");
    refused(k, joined(k, square, "f 1 2 0\n"), "mesh.obj:5: vertex index 0");
    refused(k, joined(k, square, "f -5 2 1\n"), "mesh.obj:5: vertex index -5");
    refused(k, joined(k, square, "f 1 2 x\n"), "mesh.obj:5: expected a vertex index");
    refused(k, joined(k, square, "f 1 2 99999999999999999999\n"), "mesh.obj:5: expected a vertex index");
}

/** They show nothing: a file with some among its faces is read. */
static void faces_of_two_vertices_are_left_out(void **state)
{
    Kit *k = *state;
    MeshData m;
    const char *text = joined(k, square, "f 1 2\nf 1\nf 1 2 3\nf\n");
    assert_int_equal(parse(k, text, &m), SHEEN_OK);
    assert_int_equal(m.n_triangles, 1);
    assert_int_equal(k->n_warnings, 1);
    assert_non_null(strstr(k->warnings, "mesh.obj:5: a face of 2 vertices is left out, as others may be"));
}

static void faces_do_without_normals_and_uv_that_are_not_there(void **state)
{
    Kit *k = *state;
    MeshData m;
    assert_int_equal(parse(k, joined(k, square, "f 1/1 2/1 3/1\nf 1/1 3/1 4/1\n"), &m), SHEEN_OK);
    assert_int_equal(k->n_warnings, 1); // once a file
    assert_non_null(strstr(k->warnings, "mesh.obj:5: texture index 1 is out of range"));
    assert_null(m.uv);
    assert_int_equal(m.n_vertices, 4);
    assert_int_equal(parse(k, joined(k, square, "vn 0 0 1\nf 1//1 2//0 3//-2\n"), &m), SHEEN_OK);
    kit_assert_v3(m.n[0], v3(0, 0, 1), 0.0f);
    kit_assert_v3(m.n[1], v3(0, 0, 0), 0.0f); // left to the builder
}

static void parts_are_told(void **state)
{
    Kit *k = *state;
    ObjFile f;
    const char *more = "mtllib a b.mtl \nf 1 2 3\nusemtl red paint\r\ng one\nf 1 2 3 4\nusemtl blue\n"
                       "usemtl red paint\ns 7\nf 1 2 3\ns off\ng\nf 1 2 3\n";
    const char *text = joined(k, square, more);
    assert_int_equal(sheen_obj_parse_parts(text, strlen(text), "mesh.obj", k->arena, &k->log, &f), SHEEN_OK);
    assert_int_equal(f.n_libraries, 1);
    assert_string_equal(f.libraries[0].names, "a b.mtl");
    assert_int_equal(f.libraries[0].line, 5);
    assert_int_equal(f.n_materials, 2);
    assert_string_equal(f.materials[0], "red paint");
    const ObjRun want[4] = {{0, 1, SHEEN_NONE, 0, 0}, {1, 2, 0, 0, 1}, {3, 1, 0, 7, 1}, {4, 1, 0, 0, 2}};
    assert_int_equal(f.n_runs, 4);
    assert_memory_equal(f.runs, want, sizeof want);
    // Many names, collisions of their hashes included.
    char *names = malloc(3000 * 40), *at = names;
    assert_non_null(names);
    at += sprintf(at, "%s", square);
    for (int i = 0; i < 3000; ++i) at += sprintf(at, "usemtl m%d\nf 1 2 3\n", i % 1000);
    assert_int_equal(sheen_obj_parse_parts(names, strlen(names), "mesh.obj", k->arena, &k->log, &f), SHEEN_OK);
    free(names);
    assert_int_equal(f.n_materials, 1000);
    assert_int_equal(f.n_runs, 3000);
    for (uint32_t i = 0; i < 3000; ++i) assert_int_equal(f.runs[i].material, i % 1000);
}

static void non_finite_vertices_are_read_as_such(void **state)
{
    Kit *k = *state;
    MeshData m;
    assert_int_equal(parse(k, "v nan -inf 1e999\nv 0 0 0\nv 1 0 0\nf 1 2 3\n", &m), SHEEN_OK);
    assert_true(isnan(m.p[0].x) && isinf(m.p[0].y) && m.p[0].y < 0.0f && isinf(m.p[0].z));
}

/** Numbers as printed by printf("%.*g") must come back as strtof reads them. */
static void numbers_agree_with_the_library(void **state)
{
    (void)state;
    uint32_t seed = 1;
    for (int i = 0; i < 200000; ++i) {
        seed = seed * 1664525u + 1013904223u;
        union {
            uint32_t u;
            float f;
        } bits = {.u = seed};
        if (!isfinite(bits.f)) continue;
        char text[64];
        snprintf(text, sizeof text, "%.*g", 1 + (int)(seed >> 8) % 20, (double)bits.f);
        const char *p = text;
        double got;
        assert_true(sheen_number_parse(&p, text + strlen(text), &got));
        assert_int_equal(p - text, strlen(text));
        assert_true((float)got == strtof(text, NULL));
    }
}

static void odd_spellings_of_numbers(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double value;
        int length; // -1: not a number
    } cases[] = {{"1", 1, 1},
                 {"+.5", 0.5, 3},
                 {"7.", 7, 2},
                 {"-0", 0, 2},
                 {"1e3", 1000, 3},
                 {"1E-2", 0.01, 4},
                 {"1e", 1, 1},
                 {"1e+", 1, 1},
                 {"2em", 2, 1},
                 {"1e99999999", INFINITY, 10},
                 {"1e-99999999", 0, 11},
                 {".", 0, -1},
                 {"-", 0, -1},
                 {"", 0, -1},
                 {"e5", 0, -1},
                 {"0x10", 0, 1},
                 {"infinity", INFINITY, 8},
                 {"-Inf", -INFINITY, 4},
                 {"00000000000000000000000000001.5", 1.5, 31},
                 {"123456789012345678901234567890", 123456789012345678901234567890.0, 30},
                 {"0.000000000000000000000000000012345", 1.2345e-29, 35}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const char *p = cases[i].text;
        double got = -1.0;
        bool ok = sheen_number_parse(&p, cases[i].text + strlen(cases[i].text), &got);
        assert_int_equal(ok, cases[i].length >= 0);
        assert_int_equal(p - cases[i].text, ok ? cases[i].length : 0);
        // One rounding to double after one in a 64-bit mantissa.
        if (ok) assert_true(got == cases[i].value || fabs(got / cases[i].value - 1.0) < 3e-16);
    }
    int64_t n;
    const char *p = "9223372036854775807", *q = "9223372036854775808";
    assert_true(sheen_integer_parse(&p, p + 19, &n) && n == INT64_MAX);
    assert_false(sheen_integer_parse(&q, q + 19, &n));
}

/** A grid of 180,000 triangles with normals and uv: the million must load in 2 s, so this in 0.36 s. */
static void large_meshes_are_read_fast(void **state)
{
    Kit *k = *state;
    enum { SIDE = 300 };
    const size_t capacity = (size_t)(SIDE + 1) * (SIDE + 1) * 100 + (size_t)SIDE * SIDE * 100;
    char *text = malloc(capacity);
    assert_non_null(text);
    size_t n = 0;
    for (int y = 0; y <= SIDE; ++y)
        for (int x = 0; x <= SIDE; ++x)
            n += (size_t)snprintf(text + n, capacity - n, "v %.6f %.6f 0.123456\nvt %.6f %.6f\n", x / 7.0, y / 7.0,
                                  (double)x / SIDE, (double)y / SIDE);
    n += (size_t)snprintf(text + n, capacity - n, "vn 0 0 1\n");
    for (int y = 0; y < SIDE; ++y)
        for (int x = 0; x < SIDE; ++x) {
            int a = y * (SIDE + 1) + x + 1, b = a + SIDE + 1;
            n += (size_t)snprintf(text + n, capacity - n, "f %d/%d/1 %d/%d/1 %d/%d/1 %d/%d/1\n", a, a, a + 1, a + 1,
                                  b + 1, b + 1, b, b);
        }
    MeshData m;
    double start = sheen_clock_seconds();
    assert_int_equal(sheen_obj_parse(text, n, "grid.obj", k->arena, &k->log, &m), SHEEN_OK);
    double seconds = sheen_clock_seconds() - start;
    free(text);
    assert_int_equal(m.n_triangles, 2 * SIDE * SIDE);
    assert_int_equal(m.n_vertices, (SIDE + 1) * (SIDE + 1));
    print_message("%u triangles in %.3f s\n", m.n_triangles, seconds);
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    assert_true(seconds < 1.0); // with room for a busy machine
#endif
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        KIT_TEST(polygons_become_fans),
        KIT_TEST(all_index_forms_are_read),
        KIT_TEST(equal_corners_are_shared_and_no_others),
        KIT_TEST(line_ends_comments_and_groups_do_not_matter),
        KIT_TEST(bad_lines_are_refused_with_their_number),
        KIT_TEST(faces_of_two_vertices_are_left_out),
        KIT_TEST(faces_do_without_normals_and_uv_that_are_not_there),
        KIT_TEST(parts_are_told),
        KIT_TEST(non_finite_vertices_are_read_as_such),
        KIT_TEST(numbers_agree_with_the_library),
        KIT_TEST(odd_spellings_of_numbers),
        KIT_TEST(large_meshes_are_read_fast),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
