// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ. Format: wavefront1995-obj (appendix B of the Advanced Visualizer's manual).
#include "io/obj.h"

#include "base/hash.h"
#include "io/number.h"
#include "io/polygon.h"

#include <stdlib.h>
#include <string.h>

/** A growing array of 32-bit based items from malloc. */
typedef struct Array {
    void *data;
    uint32_t n, capacity;
} Array;

/** A corner of a face: indices into positions, uv, normals; SHEEN_NONE when not given. */
typedef struct Corner {
    uint32_t p, uv, n;
} Corner;

typedef struct Reader {
    const char *at, *end;
    const char *name;
    const SheenLog *log;
    uint32_t line;
    Array p, uv, n;  // Vec3, Vec2, Vec3 as in the file
    Array colors;    // Rgb of the positions, none as long as no position has one
    Array vertices;  // Corner: one for each combination that occurs
    Array triangles; // uint32_t[3]
    Array face;      // uint32_t: vertices of the polygon that is being read
    Array corners;   // Vec3: their positions
    uint32_t *table; // hash of corners: index of a vertex, or SHEEN_NONE
    uint32_t table_size;
    bool has_uv, has_n, warned, warned_range, warned_face;
    SheenArena *arena;
    bool parts;      // wanted: the following is kept
    ObjRun run;      // in the making: its material, smoothing and object count
    Array runs;      // ObjRun
    Array names;     // const char *: materials
    Array libraries; // ObjLibrary
    uint32_t *name_table, name_table_size;
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

static bool is_word(const char *word, size_t length, const char *expected)
{
    return strlen(expected) == length && memcmp(word, expected, length) == 0;
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

/** A position, and after it perhaps a colour; positions without are white in a file that has some. */
static SheenStatus read_position(Reader *r)
{
    float c[6] = {0, 0, 0, -1, -1, -1};
    SheenStatus s = read_floats(r, 3, 6, c);
    if (s) return s;
    Vec3 p = v3(c[0], c[1], c[2]);
    const Rgb white = rgb_gray(1.0f);
    bool colored = c[5] >= 0.0f;
    Rgb color = colored ? rgb(c[3], c[4], c[5]) : white;
    while (colored && r->colors.n < r->p.n)
        if (!push(&r->colors, &white, sizeof white)) return no_memory(r);
    if ((colored || r->colors.n) && !push(&r->colors, &color, sizeof color)) return no_memory(r);
    return push(&r->p, &p, sizeof p) ? SHEEN_OK : no_memory(r);
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
static SheenStatus resolve(const Reader *r, int64_t index, uint32_t n, uint32_t *out)
{
    int64_t i = index > 0 ? index - 1 : (int64_t)n + index;
    if (index == 0 || i < 0 || i >= (int64_t)n)
        return sheen_fail(r->log, SHEEN_ERR_PARSE, "%s:%u: vertex index %lld is out of range: there are %u so far",
                          r->name, r->line, (long long)index, n);
    *out = (uint32_t)i;
    return SHEEN_OK;
}

/** The same for what a face can do without: an index out of range is taken as not given. */
static uint32_t resolve_optional(Reader *r, int64_t index, uint32_t n, const char *what)
{
    int64_t i = index > 0 ? index - 1 : (int64_t)n + index;
    if (index != 0 && i >= 0 && i < (int64_t)n) return (uint32_t)i;
    if (!r->warned_range)
        sheen_warn(r->log, "%s:%u: %s index %lld is out of range and is ignored, as others may be: there are %u so far",
                   r->name, r->line, what, (long long)index, n);
    r->warned_range = true;
    return SHEEN_NONE;
}

/** p, p/uv, p//n or p/uv/n. @return SHEEN_ERR_CANCELLED at the end of the face. */
static SheenStatus read_corner(Reader *r, Corner *out)
{
    int64_t index;
    skip_blanks(r);
    if (r->at == r->end || *r->at == '\n' || *r->at == '#') return SHEEN_ERR_CANCELLED;
    if (!sheen_integer_parse(&r->at, r->end, &index))
        return sheen_fail(r->log, SHEEN_ERR_PARSE, "%s:%u: expected a vertex index", r->name, r->line);
    *out = (Corner){SHEEN_NONE, SHEEN_NONE, SHEEN_NONE};
    SheenStatus s = resolve(r, index, r->p.n, &out->p);
    if (s || r->at == r->end || *r->at != '/') return s;
    r->at++;
    if (sheen_integer_parse(&r->at, r->end, &index)) out->uv = resolve_optional(r, index, r->uv.n, "texture");
    r->has_uv = r->has_uv || out->uv != SHEEN_NONE;
    if (r->at == r->end || *r->at != '/') return SHEEN_OK;
    r->at++;
    if (sheen_integer_parse(&r->at, r->end, &index)) out->n = resolve_optional(r, index, r->n.n, "normal");
    r->has_n = r->has_n || out->n != SHEEN_NONE;
    return SHEEN_OK;
}

static uint32_t corner_hash(const Corner *c)
{
    return hash_combine(hash_combine(hash_u32(c->p), c->uv), c->n);
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

/** Adds the polygon in r->face to the triangles. */
static SheenStatus add_polygon(Reader *r)
{
    typedef uint32_t Triangle[3];
    uint32_t n = r->face.n;
    if (!sheen_reserve(&r->triangles.data, &r->triangles.capacity, (uint64_t)r->triangles.n + n - 2, sizeof(Triangle)))
        return no_memory(r);
    Triangle *t = (Triangle *)r->triangles.data + r->triangles.n;
    if (!sheen_polygon_cut(r->corners.data, n, t)) return no_memory(r);
    for (uint32_t i = 0; i < n - 2; ++i)
        for (int j = 0; j < 3; ++j) t[i][j] = ((const uint32_t *)r->face.data)[t[i][j]];
    r->triangles.n += n - 2;
    return SHEEN_OK;
}

static SheenStatus read_face(Reader *r)
{
    r->face.n = r->corners.n = 0;
    for (;;) {
        Corner c;
        SheenStatus s = read_corner(r, &c);
        if (s == SHEEN_ERR_CANCELLED) break;
        if (s) return s;
        uint32_t vertex = vertex_of(r, &c);
        if (vertex == SHEEN_NONE || !push(&r->face, &vertex, sizeof vertex) ||
            !push(&r->corners, &((const Vec3 *)r->p.data)[c.p], sizeof(Vec3)))
            return no_memory(r);
    }
    if (r->face.n >= 3) return add_polygon(r);
    if (!r->warned_face)
        sheen_warn(r->log, "%s:%u: a face of %u vertices is left out, as others may be", r->name, r->line, r->face.n);
    r->warned_face = true;
    return SHEEN_OK;
}

// ---- parts ------------------------------------------------------------------------------------------------------

/** The rest of the line without blanks at its ends and without a comment; names may hold blanks. */
static const char *read_rest(Reader *r, size_t *length)
{
    skip_blanks(r);
    const char *begin = r->at;
    while (r->at < r->end && *r->at != '\n') ++r->at;
    const char *end = r->at;
    while (end > begin && (unsigned char)end[-1] <= ' ') --end;
    *length = (size_t)(end - begin);
    return begin;
}

static const char *copy_text(Reader *r, const char *text, size_t length)
{
    char *copy = sheen_arena_alloc(r->arena, length + 1, 1);
    if (copy) memcpy(copy, text, length);
    return copy;
}

static uint32_t hash_name(const char *text, size_t length)
{
    uint32_t h = 0;
    for (size_t i = 0; i < length; ++i) h = hash_combine(h, (unsigned char)text[i]);
    return h;
}

static bool grow_names(Reader *r)
{
    uint64_t size = r->name_table_size ? 2 * (uint64_t)r->name_table_size : 64;
    uint32_t *table = size > UINT32_MAX ? NULL : malloc((size_t)size * sizeof *table);
    if (!table) return false;
    memset(table, 0xff, (size_t)size * sizeof *table);
    for (uint32_t i = 0; i < r->names.n; ++i) {
        const char *name = ((const char **)r->names.data)[i];
        uint32_t slot = hash_name(name, strlen(name)) & ((uint32_t)size - 1);
        while (table[slot] != SHEEN_NONE) slot = (slot + 1) & ((uint32_t)size - 1);
        table[slot] = i;
    }
    free(r->name_table);
    r->name_table = table;
    r->name_table_size = (uint32_t)size;
    return true;
}

/** usemtl: the material's index, made when its name is new. */
static SheenStatus use_material(Reader *r)
{
    size_t length;
    const char *text = read_rest(r, &length);
    if (r->names.n >= r->name_table_size / 2 && !grow_names(r)) return no_memory(r);
    uint32_t slot = hash_name(text, length) & (r->name_table_size - 1);
    for (; r->name_table[slot] != SHEEN_NONE; slot = (slot + 1) & (r->name_table_size - 1)) {
        const char *name = ((const char **)r->names.data)[r->name_table[slot]];
        if (strlen(name) == length && memcmp(name, text, length) == 0) break;
    }
    if (r->name_table[slot] == SHEEN_NONE) {
        const char *name = copy_text(r, text, length);
        if (!name || !push(&r->names, &name, sizeof name)) return no_memory(r);
        r->name_table[slot] = r->names.n - 1;
    }
    r->run.material = r->name_table[slot];
    return SHEEN_OK;
}

static SheenStatus add_library(Reader *r)
{
    size_t length;
    const char *text = read_rest(r, &length);
    ObjLibrary library = {copy_text(r, text, length), r->line};
    return library.names && push(&r->libraries, &library, sizeof library) ? SHEEN_OK : no_memory(r);
}

/** "s 1", "s off": the group, 0 for none. */
static void set_smoothing(Reader *r)
{
    int64_t group;
    skip_blanks(r);
    r->run.smoothing = sheen_integer_parse(&r->at, r->end, &group) && group > 0 ? (uint32_t)group : 0;
}

/** Closes the run of triangles that came since the last call. */
static SheenStatus end_run(Reader *r)
{
    r->run.n = r->triangles.n - r->run.first;
    if (r->run.n > 0 && !push(&r->runs, &r->run, sizeof r->run)) return no_memory(r);
    r->run.first = r->triangles.n;
    return SHEEN_OK;
}

/** @return SHEEN_ERR_CANCELLED when the word is none of these. */
static SheenStatus read_part(Reader *r, const char *word, size_t length)
{
    if (is_word(word, length, "mtllib")) return add_library(r);
    bool material = is_word(word, length, "usemtl"), smoothing = is_word(word, length, "s");
    if (!material && !smoothing && !is_word(word, length, "g") && !is_word(word, length, "o"))
        return SHEEN_ERR_CANCELLED;
    SheenStatus s = end_run(r);
    if (s) return s;
    if (material) return use_material(r);
    if (smoothing)
        set_smoothing(r);
    else
        r->run.object++;
    return SHEEN_OK;
}

// ---- the file ---------------------------------------------------------------------------------------------------

static SheenStatus read_statement(Reader *r)
{
    static const char *const skipped[] = {"vp",  "g",          "o",      "s",      "usemtl",   "mtllib",
                                          "l",   "p",          "mg",     "bevel",  "c_interp", "d_interp",
                                          "lod", "shadow_obj", "usemap", "maplib", "trace_obj"};
    const char *word = r->at;
    while (r->at < r->end && (unsigned char)*r->at > ' ') ++r->at;
    size_t length = (size_t)(r->at - word);
    if (length == 0 || *word == '#') return SHEEN_OK;
    if (is_word(word, length, "v")) return read_position(r);
    if (is_word(word, length, "vn")) return read_vec3(r, &r->n);
    if (is_word(word, length, "vt")) return read_uv(r);
    if (is_word(word, length, "f") || is_word(word, length, "fo")) return read_face(r);
    SheenStatus s = r->parts ? read_part(r, word, length) : SHEEN_ERR_CANCELLED;
    if (s != SHEEN_ERR_CANCELLED) return s;
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

static SheenStatus collect(const Reader *r, MeshData *out)
{
    *out = (MeshData){.n_vertices = r->vertices.n, .n_triangles = r->triangles.n};
    if (!sheen_mesh_alloc(r->arena, out, r->has_n, r->has_uv)) return no_memory(r);
    if (r->colors.n && !(out->color = SHEEN_ARENA_NEW(r->arena, Rgb, r->vertices.n))) return no_memory(r);
    const Corner *c = r->vertices.data;
    for (uint32_t i = 0; i < r->vertices.n; ++i, ++c) {
        out->p[i] = ((const Vec3 *)r->p.data)[c->p];
        if (out->color) out->color[i] = ((const Rgb *)r->colors.data)[c->p];
        if (c->uv != SHEEN_NONE) out->uv[i] = ((const Vec2 *)r->uv.data)[c->uv];
        if (c->n != SHEEN_NONE) out->n[i] = v3_normalize(((const Vec3 *)r->n.data)[c->n]);
    }
    if (r->triangles.n) memcpy(out->triangles, r->triangles.data, (size_t)r->triangles.n * sizeof *out->triangles);
    return SHEEN_OK;
}

/** @return a copy of an array in the arena; NULL when out of memory. */
static void *kept(const Reader *r, const Array *a, size_t item_size)
{
    void *copy = sheen_arena_alloc(r->arena, a->n, item_size);
    if (copy && a->n) memcpy(copy, a->data, a->n * item_size);
    return copy;
}

static SheenStatus collect_parts(const Reader *r, ObjFile *out)
{
    out->runs = kept(r, &r->runs, sizeof(ObjRun));
    out->materials = kept(r, &r->names, sizeof(const char *));
    out->libraries = kept(r, &r->libraries, sizeof(ObjLibrary));
    out->n_runs = r->runs.n, out->n_materials = r->names.n, out->n_libraries = r->libraries.n;
    return out->runs && out->materials && out->libraries ? SHEEN_OK : no_memory(r);
}

static SheenStatus read_file(Reader *r, ObjFile *out)
{
    *out = (ObjFile){0};
    SheenStatus s = read_statements(r);
    if (!s) s = end_run(r);
    if (!s) s = collect(r, &out->mesh);
    if (!s && r->parts) s = collect_parts(r, out);
    free(r->p.data);
    free(r->colors.data);
    free(r->uv.data);
    free(r->n.data);
    free(r->vertices.data);
    free(r->triangles.data);
    free(r->face.data);
    free(r->corners.data);
    free(r->runs.data);
    free(r->names.data);
    free(r->libraries.data);
    free(r->table);
    free(r->name_table);
    if (s) *out = (ObjFile){0};
    return s;
}

SheenStatus sheen_obj_parse(const char *text, size_t size, const char *name, SheenArena *arena, const SheenLog *log,
                            MeshData *out)
{
    Reader r = {.at = text, .end = text + size, .name = name, .log = log, .line = 1, .arena = arena};
    ObjFile file;
    SheenStatus s = read_file(&r, &file);
    *out = file.mesh;
    return s;
}

SheenStatus sheen_obj_parse_parts(const char *text, size_t size, const char *name, SheenArena *arena,
                                  const SheenLog *log, ObjFile *out)
{
    Reader r = {.at = text, .end = text + size, .name = name, .log = log, .line = 1, .arena = arena, .parts = true};
    r.run.material = SHEEN_NONE;
    return read_file(&r, out);
}
