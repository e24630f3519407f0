// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ. Format: wavefront1995-obj (appendix B of the Advanced Visualizer's manual).
#include "base/hash.h"
#include "io/mesh.h"
#include "io/number.h"

#include <stdlib.h>
#include <string.h>

/** A growing array of 32-bit based items from malloc. */
typedef struct Array {
    void *data;
    uint32_t n, capacity;
} Array;

/** A corner of a face: indices into positions, uv, normals; -1 when not given. */
typedef struct Corner {
    int64_t p, uv, n;
} Corner;

typedef struct Reader {
    const char *at, *end;
    const char *name;
    const SheenLog *log;
    uint32_t line;
    Array p, uv, n;  // Vec3, Vec2, Vec3 as in the file
    Array vertices;  // Corner: one for each combination that occurs
    Array triangles; // uint32_t[3]
    uint32_t *table; // hash of corners: index of a vertex, or SHEEN_NONE
    uint32_t table_size;
    bool has_uv, has_n, warned;
} Reader;

static SheenStatus no_memory(const Reader *r)
{
    return sheen_fail(r->log, SHEEN_ERR_NOMEM, "%s:%u: out of memory", r->name, r->line);
}

static bool push(Array *a, const void *item, size_t size)
{
    if (!sheen_reserve(&a->data, &a->capacity, (uint64_t)a->n + 1, size)) return false;
    memcpy((char *)a->data + (size_t)a->n++ * size, item, size);
    return true;
}

/** Skips blanks and continued line ends. */
static void skip_blanks(Reader *r)
{
    for (; r->at < r->end; ++r->at) {
        char c = *r->at;
        if (c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f') continue;
        if (c != '\\') return;
        const char *q = r->at + 1;
        if (q < r->end && *q == '\r') ++q;
        if (q == r->end || *q != '\n') return;
        r->at = q;
        r->line++;
    }
}

/** Skips the rest of the line, continuations and the line end included. */
static void skip_line(Reader *r)
{
    while (r->at < r->end && *r->at != '\n') {
        const char *newline = memchr(r->at, '\n', (size_t)(r->end - r->at));
        if (!newline) {
            r->at = r->end;
            return;
        }
        const char *last = newline;
        if (last > r->at && last[-1] == '\r') --last;
        bool continued = last > r->at && last[-1] == '\\';
        r->at = newline;
        if (!continued) break;
        r->line++;
        ++r->at;
    }
    if (r->at < r->end) ++r->at;
    r->line++;
}

/** Reads up to n numbers, at least `needed`. */
static SheenStatus read_floats(Reader *r, int needed, int n, float out[])
{
    for (int i = 0; i < n; ++i) {
        double value;
        skip_blanks(r);
        if (!sheen_number_parse(&r->at, r->end, &value)) {
            if (i >= needed) return SHEEN_OK;
            return sheen_fail(r->log, SHEEN_ERR_PARSE, "%s:%u: expected %d numbers", r->name, r->line, needed);
        }
        out[i] = (float)value;
    }
    return SHEEN_OK;
}

static SheenStatus read_vec3(Reader *r, Array *to)
{
    float c[3];
    SheenStatus s = read_floats(r, 3, 3, c);
    if (s) return s;
    Vec3 v = v3(c[0], c[1], c[2]);
    return push(to, &v, sizeof v) ? SHEEN_OK : no_memory(r);
}

static SheenStatus read_uv(Reader *r)
{
    float c[2] = {0.0f, 0.0f};
    SheenStatus s = read_floats(r, 1, 2, c);
    if (s) return s;
    Vec2 v = v2(c[0], c[1]);
    return push(&r->uv, &v, sizeof v) ? SHEEN_OK : no_memory(r);
}

// ---- faces ------------------------------------------------------------------------------------------------------

/** Turns an index of the file (1-based, negative from the end) into one of the array. */
static SheenStatus resolve(Reader *r, int64_t index, uint32_t n, const char *what, int64_t *out)
{
    *out = index > 0 ? index - 1 : (int64_t)n + index;
    if (index == 0 || *out < 0 || *out >= (int64_t)n)
        return sheen_fail(r->log, SHEEN_ERR_PARSE, "%s:%u: %s index %lld is out of range: there are %u so far", r->name,
                          r->line, what, (long long)index, n);
    return SHEEN_OK;
}

/** p, p/uv, p//n or p/uv/n. @return SHEEN_ERR_CANCELLED at the end of the face. */
static SheenStatus read_corner(Reader *r, Corner *out)
{
    int64_t index;
    skip_blanks(r);
    if (r->at == r->end || *r->at == '\n' || *r->at == '#') return SHEEN_ERR_CANCELLED;
    if (!sheen_integer_parse(&r->at, r->end, &index))
        return sheen_fail(r->log, SHEEN_ERR_PARSE, "%s:%u: expected a vertex index", r->name, r->line);
    *out = (Corner){-1, -1, -1};
    SheenStatus s = resolve(r, index, r->p.n, "vertex", &out->p);
    if (s || r->at == r->end || *r->at != '/') return s;
    r->at++;
    if (sheen_integer_parse(&r->at, r->end, &index)) {
        s = resolve(r, index, r->uv.n, "texture", &out->uv);
        r->has_uv = true;
    }
    if (s || r->at == r->end || *r->at != '/') return s;
    r->at++;
    if (!sheen_integer_parse(&r->at, r->end, &index)) return SHEEN_OK;
    r->has_n = true;
    return resolve(r, index, r->n.n, "normal", &out->n);
}

static uint32_t corner_hash(const Corner *c)
{
    return hash_combine(hash_combine(hash_u32((uint32_t)c->p), (uint32_t)c->uv), (uint32_t)c->n);
}

static bool grow_table(Reader *r)
{
    uint64_t size = r->table_size ? 2 * (uint64_t)r->table_size : 1024;
    if (size > UINT32_MAX) return false;
    uint32_t *table = malloc((size_t)size * sizeof *table);
    if (!table) return false;
    memset(table, 0xff, (size_t)size * sizeof *table);
    for (uint32_t i = 0; i < r->vertices.n; ++i) {
        uint32_t slot = corner_hash(&((Corner *)r->vertices.data)[i]) & ((uint32_t)size - 1);
        while (table[slot] != SHEEN_NONE) slot = (slot + 1) & ((uint32_t)size - 1);
        table[slot] = i;
    }
    free(r->table);
    r->table = table;
    r->table_size = (uint32_t)size;
    return true;
}

/** @return the vertex of a corner, made when it is new; SHEEN_NONE when out of memory. */
static uint32_t vertex_of(Reader *r, const Corner *c)
{
    if (r->vertices.n >= r->table_size / 2 && !grow_table(r)) return SHEEN_NONE;
    uint32_t slot = corner_hash(c) & (r->table_size - 1);
    for (; r->table[slot] != SHEEN_NONE; slot = (slot + 1) & (r->table_size - 1)) {
        const Corner *v = &((Corner *)r->vertices.data)[r->table[slot]];
        if (v->p == c->p && v->uv == c->uv && v->n == c->n) return r->table[slot];
    }
    if (!push(&r->vertices, c, sizeof *c)) return SHEEN_NONE;
    return r->table[slot] = r->vertices.n - 1;
}

static SheenStatus read_face(Reader *r)
{
    uint32_t fan[3] = {0, 0, 0};
    for (uint32_t n = 0;; ++n) {
        Corner c;
        SheenStatus s = read_corner(r, &c);
        if (s == SHEEN_ERR_CANCELLED && n >= 3) return SHEEN_OK;
        if (s == SHEEN_ERR_CANCELLED)
            return sheen_fail(r->log, SHEEN_ERR_PARSE, "%s:%u: a face needs three vertices", r->name, r->line);
        if (s) return s;
        uint32_t vertex = vertex_of(r, &c);
        if (vertex == SHEEN_NONE) return no_memory(r);
        if (n < 2) {
            fan[n] = vertex;
            continue;
        }
        fan[2] = vertex;
        if (!push(&r->triangles, fan, sizeof fan)) return no_memory(r);
        fan[1] = vertex;
    }
}

// ---- the file ---------------------------------------------------------------------------------------------------

static bool is_word(const char *word, size_t length, const char *expected)
{
    return strlen(expected) == length && memcmp(word, expected, length) == 0;
}

static SheenStatus read_statement(Reader *r)
{
    static const char *const skipped[] = {"vp",  "g",          "o",      "s",      "usemtl",   "mtllib",
                                          "l",   "p",          "mg",     "bevel",  "c_interp", "d_interp",
                                          "lod", "shadow_obj", "usemap", "maplib", "trace_obj"};
    const char *word = r->at;
    while (r->at < r->end && (unsigned char)*r->at > ' ') ++r->at;
    size_t length = (size_t)(r->at - word);
    if (length == 0 || *word == '#') return SHEEN_OK;
    if (is_word(word, length, "v")) return read_vec3(r, &r->p);
    if (is_word(word, length, "vn")) return read_vec3(r, &r->n);
    if (is_word(word, length, "vt")) return read_uv(r);
    if (is_word(word, length, "f") || is_word(word, length, "fo")) return read_face(r);
    for (size_t i = 0; i < sizeof skipped / sizeof *skipped; ++i)
        if (is_word(word, length, skipped[i])) return SHEEN_OK;
    if (!r->warned)
        sheen_warn(r->log, "%s:%u: '%.*s' is not known and is skipped, as others may be", r->name, r->line,
                   length < 40 ? (int)length : 40, word);
    r->warned = true;
    return SHEEN_OK;
}

static SheenStatus read_statements(Reader *r)
{
    while (r->at < r->end) {
        skip_blanks(r);
        SheenStatus s = read_statement(r);
        if (s) return s;
        skip_line(r);
    }
    return SHEEN_OK;
}

static SheenStatus collect(const Reader *r, SheenArena *arena, MeshData *out)
{
    *out = (MeshData){.n_vertices = r->vertices.n, .n_triangles = r->triangles.n};
    if (!sheen_mesh_alloc(arena, out, r->has_n, r->has_uv)) return no_memory(r);
    const Corner *c = r->vertices.data;
    for (uint32_t i = 0; i < r->vertices.n; ++i, ++c) {
        out->p[i] = ((const Vec3 *)r->p.data)[c->p];
        if (r->has_uv && c->uv >= 0) out->uv[i] = ((const Vec2 *)r->uv.data)[c->uv];
        if (r->has_n && c->n >= 0) out->n[i] = v3_normalize(((const Vec3 *)r->n.data)[c->n]);
    }
    if (r->triangles.n) memcpy(out->triangles, r->triangles.data, (size_t)r->triangles.n * sizeof *out->triangles);
    return SHEEN_OK;
}

SheenStatus sheen_obj_parse(const char *text, size_t size, const char *name, SheenArena *arena, const SheenLog *log,
                            MeshData *out)
{
    *out = (MeshData){0};
    Reader r = {.at = text, .end = text + size, .name = name, .log = log, .line = 1};
    SheenStatus s = read_statements(&r);
    if (!s) s = collect(&r, arena, out);
    free(r.p.data);
    free(r.uv.data);
    free(r.n.data);
    free(r.vertices.data);
    free(r.triangles.data);
    free(r.table);
    return s;
}
