// SPDX-License-Identifier: Apache-2.0
// PLY meshes. Format: turk1994-ply.
#include "io/mesh.h"
#include "io/number.h"
#include "io/polygon.h"

#include <stdlib.h>
#include <string.h>

enum { MAX_ELEMENTS = 64, MAX_PROPERTIES = 256, MAX_WORDS = 8 };

typedef enum Type { INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64, N_TYPES } Type;
typedef enum Format { ASCII, LITTLE_ENDIAN_BYTES, BIG_ENDIAN_BYTES } Format;

static const unsigned type_sizes[N_TYPES] = {1, 1, 2, 2, 4, 4, 4, 8};

/** What a property of a vertex or face means to us. */
typedef enum Role {
    SKIP,
    POSITION,
    NORMAL = POSITION + 3,
    TEXTURE = NORMAL + 3,
    COLOR = TEXTURE + 2,
    FACE_COLOR = COLOR + 3,
    INDICES = FACE_COLOR + 3,
    STRIPS
} Role;

typedef struct Property {
    Type type, count_type;
    bool list;
    int role; // Role, plus the axis
} Property;

typedef struct Element {
    uint64_t count;
    bool vertex, face, strips;
    uint32_t first, n; // properties
} Element;

typedef struct Reader {
    const char *at, *end;
    const char *name;
    const SheenLog *log;
    uint32_t line; // counted in the header and in ASCII
    Format format;
    Element elements[MAX_ELEMENTS];
    Property properties[MAX_PROPERTIES];
    uint32_t n_elements, n_properties;
    uint32_t (*triangles)[3]; // from malloc
    uint32_t n_triangles, triangle_capacity;
    Rgb *face_colors; // from malloc, of the triangles; unused unless the file has them
    uint32_t face_color_capacity;
    bool has_face_colors;
    uint32_t *face; // from malloc: the polygon that is being read, and its corners' places
    Vec3 *corners;
    uint32_t face_capacity, corner_capacity;
} Reader;

static SheenStatus fail_at(const Reader *r, const char *what)
{
    return sheen_fail(r->log, SHEEN_ERR_PARSE, "%s:%u: %s", r->name, r->line, what);
}

static SheenStatus no_memory(const Reader *r)
{
    return sheen_fail(r->log, SHEEN_ERR_NOMEM, "%s: out of memory", r->name);
}

// ---- header -----------------------------------------------------------------------------------------------------

typedef struct Word {
    const char *text;
    size_t length;
} Word;

static bool is(Word w, const char *text)
{
    return strlen(text) == w.length && memcmp(w.text, text, w.length) == 0;
}

/** Splits the next line of the header into words. @return false at the end of the file. */
static bool next_line(Reader *r, Word words[MAX_WORDS], int *n)
{
    *n = 0;
    if (r->at == r->end) return false;
    r->line++;
    while (r->at < r->end && *r->at != '\n') {
        if ((unsigned char)*r->at <= ' ') {
            ++r->at;
            continue;
        }
        const char *start = r->at;
        while (r->at < r->end && (unsigned char)*r->at > ' ') ++r->at;
        if (*n < MAX_WORDS) words[(*n)++] = (Word){start, (size_t)(r->at - start)};
    }
    if (r->at < r->end) ++r->at;
    return true;
}

static Type type_of(Word w)
{
    static const char *const names[N_TYPES][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                                  {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                                  {"float", "float32"}, {"double", "float64"}};
    int t = 0;
    while (t < N_TYPES && !is(w, names[t][0]) && !is(w, names[t][1])) ++t;
    return (Type)t;
}

static int role_of(const Element *e, Word name, bool list)
{
    static const struct {
        const char *name;
        int role;
    } roles[] = {{"x", POSITION},        {"y", POSITION + 1},       {"z", POSITION + 2},    {"nx", NORMAL},
                 {"ny", NORMAL + 1},     {"nz", NORMAL + 2},        {"u", TEXTURE},         {"v", TEXTURE + 1},
                 {"s", TEXTURE},         {"t", TEXTURE + 1},        {"texture_u", TEXTURE}, {"texture_v", TEXTURE + 1},
                 {"texture_s", TEXTURE}, {"texture_t", TEXTURE + 1}};
    if (list && (is(name, "vertex_indices") || is(name, "vertex_index")))
        return e->face ? INDICES : e->strips ? STRIPS : SKIP;
    static const char *const colors[] = {"r", "g", "b", "red", "green", "blue"};
    for (int i = 0; (e->vertex || e->face) && !list && i < 6; ++i)
        if (is(name, colors[i])) return (e->vertex ? COLOR : FACE_COLOR) + i % 3;
    for (size_t i = 0; e->vertex && !list && i < sizeof roles / sizeof *roles; ++i)
        if (is(name, roles[i].name)) return roles[i].role;
    return SKIP;
}

static SheenStatus read_element(Reader *r, const Word w[], int n)
{
    int64_t count;
    if (n != 3) return fail_at(r, "expected 'element NAME COUNT'");
    const char *p = w[2].text;
    if (!sheen_integer_parse(&p, p + w[2].length, &count) || count < 0) return fail_at(r, "bad number of elements");
    if (r->n_elements == MAX_ELEMENTS) return fail_at(r, "too many elements");
    r->elements[r->n_elements++] = (Element){.count = (uint64_t)count,
                                             .vertex = is(w[1], "vertex"),
                                             .face = is(w[1], "face"),
                                             .strips = is(w[1], "tristrips"),
                                             .first = r->n_properties};
    return SHEEN_OK;
}

static SheenStatus read_property(Reader *r, const Word w[], int n)
{
    bool list = n > 1 && is(w[1], "list");
    if (n != (list ? 5 : 3) || r->n_elements == 0) return fail_at(r, "bad property");
    if (r->n_properties == MAX_PROPERTIES) return fail_at(r, "too many properties");
    Element *e = &r->elements[r->n_elements - 1];
    Property p = {.type = type_of(w[n - 2]), .count_type = list ? type_of(w[2]) : UINT8, .list = list};
    if (p.type == N_TYPES || p.count_type == N_TYPES) return fail_at(r, "unknown property type");
    if (list && p.count_type >= FLOAT32) return fail_at(r, "the count of a list must be an integer");
    p.role = role_of(e, w[n - 1], list);
    r->properties[r->n_properties++] = p;
    e->n++;
    return SHEEN_OK;
}

static SheenStatus read_format(Reader *r, const Word w[], int n)
{
    if (n < 2) return fail_at(r, "bad format");
    if (is(w[1], "ascii"))
        r->format = ASCII;
    else if (is(w[1], "binary_little_endian"))
        r->format = LITTLE_ENDIAN_BYTES;
    else if (is(w[1], "binary_big_endian"))
        r->format = BIG_ENDIAN_BYTES;
    else
        return fail_at(r, "unknown format");
    return SHEEN_OK;
}

static SheenStatus read_header(Reader *r)
{
    Word w[MAX_WORDS];
    int n;
    bool has_format = false;
    if (!next_line(r, w, &n) || n != 1 || !is(w[0], "ply")) return fail_at(r, "not a PLY file");
    while (next_line(r, w, &n)) {
        SheenStatus s = SHEEN_OK;
        if (n == 0 || is(w[0], "comment") || is(w[0], "obj_info")) continue;
        if (is(w[0], "end_header")) return has_format ? SHEEN_OK : fail_at(r, "no format given");
        if (is(w[0], "format"))
            s = read_format(r, w, n), has_format = true;
        else if (is(w[0], "element"))
            s = read_element(r, w, n);
        else if (is(w[0], "property"))
            s = read_property(r, w, n);
        else
            s = fail_at(r, "unknown word in the header");
        if (s) return s;
    }
    return fail_at(r, "the header does not end");
}

/** Counts that the file cannot hold are refused before memory is asked for. */
static SheenStatus check_counts(const Reader *r)
{
    uint64_t left = (uint64_t)(r->end - r->at), vertices = 0;
    for (uint32_t i = 0; i < r->n_elements; ++i) {
        const Element *e = &r->elements[i];
        uint64_t least = 0; // bytes of one element; in ASCII a digit each, and a space but for the last
        for (uint32_t j = 0; j < e->n; ++j) {
            const Property *p = &r->properties[e->first + j];
            least += r->format == ASCII ? 2 : type_sizes[p->list ? p->count_type : p->type];
        }
        if (e->vertex && vertices++) return fail_at(r, "more than one element 'vertex'");
        if (least == 0 && e->count == 0) continue;
        if (least == 0 || e->count > (left + 1) / least || e->count >= SHEEN_NONE)
            return sheen_fail(r->log, SHEEN_ERR_PARSE, "%s: the header promises more than the file's %llu bytes hold",
                              r->name, (unsigned long long)left);
        uint64_t bytes = e->count * least;
        left -= bytes < left ? bytes : left;
    }
    return SHEEN_OK;
}

// ---- values -----------------------------------------------------------------------------------------------------

static bool read_ascii(Reader *r, double *out)
{
    for (; r->at < r->end && (unsigned char)*r->at <= ' '; ++r->at) r->line += *r->at == '\n';
    return sheen_number_parse(&r->at, r->end, out);
}

static bool read_binary(Reader *r, Type type, double *out)
{
    unsigned size = type_sizes[type];
    if ((size_t)(r->end - r->at) < size) return false;
    uint64_t bits = 0;
    for (unsigned i = 0; i < size; ++i) {
        unsigned shift = 8 * (r->format == LITTLE_ENDIAN_BYTES ? i : size - 1 - i);
        bits |= (uint64_t)(unsigned char)r->at[i] << shift;
    }
    r->at += size;
    union {
        uint64_t u;
        double d;
    } u64 = {.u = bits};
    union {
        uint32_t u;
        float f;
    } u32 = {.u = (uint32_t)bits};
    switch (type) {
    case INT8:
        *out = (int8_t)bits;
        break;
    case INT16:
        *out = (int16_t)bits;
        break;
    case INT32:
        *out = (int32_t)bits;
        break;
    case FLOAT32:
        *out = (double)u32.f;
        break;
    case FLOAT64:
        *out = u64.d;
        break;
    default: // unsigned
        *out = (double)bits;
    }
    return true;
}

static SheenStatus read_value(Reader *r, Type type, double *out)
{
    if (r->format == ASCII ? read_ascii(r, out) : read_binary(r, type, out)) return SHEEN_OK;
    if (r->format == ASCII && r->at < r->end) return fail_at(r, "expected a number");
    return sheen_fail(r->log, SHEEN_ERR_PARSE, "%s: the file ends in the middle of its data", r->name);
}

/** @return the length of a list, or an error for one that the rest of the file cannot hold. */
static SheenStatus read_count(Reader *r, const Property *p, uint32_t *out)
{
    double count;
    SheenStatus s = read_value(r, p->count_type, &count);
    if (s) return s;
    double left = (double)(r->end - r->at);
    if (!(count >= 0.0 && count == floor(count))) return fail_at(r, "bad length of a list");
    if (count * (r->format == ASCII ? 2.0 : (double)type_sizes[p->type]) > left + 1.0 || count >= (double)SHEEN_NONE)
        return sheen_fail(r->log, SHEEN_ERR_PARSE, "%s: the file ends in the middle of its data", r->name);
    *out = (uint32_t)count;
    return SHEEN_OK;
}

static SheenStatus skip_list(Reader *r, const Property *p)
{
    uint32_t n;
    SheenStatus s = read_count(r, p, &n);
    double ignored;
    for (uint32_t i = 0; !s && i < n; ++i) s = read_value(r, p->type, &ignored);
    return s;
}

// ---- elements ---------------------------------------------------------------------------------------------------

/** Adds the polygon in r->face to the triangles. */
static SheenStatus add_polygon(Reader *r, uint32_t n, const Vec3 p[])
{
    if (n < 3) return SHEEN_OK; // points and edges
    if (!sheen_reserve((void **)&r->triangles, &r->triangle_capacity, (uint64_t)r->n_triangles + n - 2,
                       sizeof *r->triangles))
        return no_memory(r);
    uint32_t(*t)[3] = r->triangles + r->n_triangles;
    r->n_triangles += n - 2;
    if (n == 3) {
        memcpy(t, r->face, sizeof *t);
        return SHEEN_OK;
    }
    if (!sheen_reserve((void **)&r->corners, &r->corner_capacity, n, sizeof *r->corners)) return no_memory(r);
    for (uint32_t i = 0; i < n; ++i) r->corners[i] = p[r->face[i]];
    if (!sheen_polygon_cut(r->corners, n, t)) return no_memory(r);
    for (uint32_t i = 0; i < n - 2; ++i)
        for (int j = 0; j < 3; ++j) t[i][j] = r->face[t[i][j]];
    return SHEEN_OK;
}

static SheenStatus check_index(const Reader *r, double index, const MeshData *mesh)
{
    if (index >= 0.0 && index < (double)mesh->n_vertices && index == floor(index)) return SHEEN_OK;
    return sheen_fail(r->log, SHEEN_ERR_PARSE, "%s: vertex index %g is out of range: there are %u vertices", r->name,
                      index, mesh->n_vertices);
}

static SheenStatus read_face(Reader *r, const Property *p, const MeshData *mesh)
{
    uint32_t n = 0;
    SheenStatus s = read_count(r, p, &n);
    if (!s && !sheen_reserve((void **)&r->face, &r->face_capacity, n, sizeof *r->face)) s = no_memory(r);
    for (uint32_t i = 0; !s && i < n; ++i) {
        double index;
        s = read_value(r, p->type, &index);
        if (!s) s = check_index(r, index, mesh);
        if (!s) r->face[i] = (uint32_t)index;
    }
    return s ? s : add_polygon(r, n, mesh->p);
}

/** What the largest value of a colour's type stands for 1. */
static double color_scale(Type type)
{
    static const double largest[N_TYPES] = {127.0, 255.0, 32767.0, 65535.0, 2147483647.0, 4294967295.0, 1.0, 1.0};
    return 1.0 / largest[type];
}

static bool is_color(int role)
{
    return role >= COLOR && role < FACE_COLOR + 3;
}

/** One value of a vertex or face into value[role]. */
static SheenStatus read_role(Reader *r, const Property *p, float value[INDICES])
{
    double v = 0.0;
    SheenStatus s = p->list ? skip_list(r, p) : read_value(r, p->type, &v);
    if (!s) value[p->role] = (float)(is_color(p->role) ? v * color_scale(p->type) : v);
    return s;
}

/** Gives the triangles from `first` on a colour, in files whose faces have some. */
static SheenStatus color_triangles(Reader *r, uint32_t first, Rgb color)
{
    if (!r->has_face_colors) return SHEEN_OK;
    if (!sheen_reserve((void **)&r->face_colors, &r->face_color_capacity, r->n_triangles, sizeof *r->face_colors))
        return no_memory(r);
    for (uint32_t i = first; i < r->n_triangles; ++i) r->face_colors[i] = color;
    return SHEEN_OK;
}

/** A face and the colour of all triangles that it is cut into. */
static SheenStatus read_whole_face(Reader *r, const Element *e, const MeshData *mesh)
{
    uint32_t first = r->n_triangles;
    float value[INDICES] = {0};
    for (uint32_t j = 0; j < e->n; ++j) {
        const Property *p = &r->properties[e->first + j];
        SheenStatus s = p->role == INDICES ? read_face(r, p, mesh) : read_role(r, p, value);
        if (s) return s;
    }
    return color_triangles(r, first, rgb(value[FACE_COLOR], value[FACE_COLOR + 1], value[FACE_COLOR + 2]));
}

/** Strips of triangles, each vertex one more triangle with the two before it; -1 begins another strip. */
static SheenStatus read_strips(Reader *r, const Property *p, const MeshData *mesh)
{
    const uint32_t first = r->n_triangles;
    uint32_t n = 0, length = 0, before[2] = {0, 0};
    SheenStatus s = read_count(r, p, &n);
    for (uint32_t i = 0; !s && i < n; ++i) {
        double index;
        s = read_value(r, p->type, &index);
        if (!s && index == -1.0) {
            length = 0;
            continue;
        }
        if (!s) s = check_index(r, index, mesh);
        if (s) return s;
        const uint32_t v = (uint32_t)index, odd = length & 1, a = before[0], b = before[1];
        before[0] = b, before[1] = v;
        if (++length < 3 || a == b || b == v || a == v) continue; // joints of strips
        if (!sheen_reserve((void **)&r->triangles, &r->triangle_capacity, (uint64_t)r->n_triangles + 1,
                           sizeof *r->triangles))
            return no_memory(r);
        const uint32_t t[3] = {odd ? b : a, odd ? a : b, v};
        memcpy(r->triangles[r->n_triangles++], t, sizeof t);
    }
    return s ? s : color_triangles(r, first, rgb_gray(0.0f));
}

static SheenStatus read_vertex(Reader *r, const Element *e, MeshData *out, uint32_t index)
{
    float value[INDICES] = {0};
    for (uint32_t j = 0; j < e->n; ++j) {
        SheenStatus s = read_role(r, &r->properties[e->first + j], value);
        if (s) return s;
    }
    out->p[index] = v3(value[POSITION], value[POSITION + 1], value[POSITION + 2]);
    if (out->n) out->n[index] = v3_normalize(v3(value[NORMAL], value[NORMAL + 1], value[NORMAL + 2]));
    if (out->uv) out->uv[index] = v2(value[TEXTURE], value[TEXTURE + 1]);
    if (out->color) out->color[index] = rgb(value[COLOR], value[COLOR + 1], value[COLOR + 2]);
    return SHEEN_OK;
}

static SheenStatus read_elements(Reader *r, MeshData *out)
{
    SheenStatus s = SHEEN_OK;
    for (uint32_t i = 0; !s && i < r->n_elements; ++i) {
        const Element *e = &r->elements[i];
        for (uint32_t k = 0; !s && k < e->count; ++k) {
            if (e->vertex) {
                s = read_vertex(r, e, out, k);
                continue;
            }
            if (e->face) {
                s = read_whole_face(r, e, out);
                continue;
            }
            for (uint32_t j = 0; !s && j < e->n; ++j) {
                const Property *p = &r->properties[e->first + j];
                double ignored;
                s = p->role == STRIPS ? read_strips(r, p, out)
                    : p->list         ? skip_list(r, p)
                                      : read_value(r, p->type, &ignored);
            }
        }
    }
    return s;
}

static bool has_roles(const Reader *r, int first, int n)
{
    int found = 0;
    for (uint32_t i = 0; i < r->n_properties; ++i)
        for (int j = 0; j < n; ++j)
            if (r->properties[i].role == first + j) found |= 1 << j;
    return found == (1 << n) - 1;
}

static SheenStatus read_mesh(Reader *r, SheenArena *arena, MeshData *out)
{
    SheenStatus s = read_header(r);
    if (!s) s = check_counts(r);
    if (s) return s;
    r->line++; // the first of the data
    if (!has_roles(r, POSITION, 3)) return sheen_fail(r->log, SHEEN_ERR_PARSE, "%s: no vertex positions", r->name);
    MeshData m = {0};
    for (uint32_t i = 0; i < r->n_elements; ++i)
        if (r->elements[i].vertex) m.n_vertices = (uint32_t)r->elements[i].count;
    if (!sheen_mesh_alloc(arena, &m, has_roles(r, NORMAL, 3), has_roles(r, TEXTURE, 2))) return no_memory(r);
    if (has_roles(r, COLOR, 3) && !(m.color = SHEEN_ARENA_NEW(arena, Rgb, m.n_vertices))) return no_memory(r);
    r->has_face_colors = has_roles(r, FACE_COLOR, 3);
    s = read_elements(r, &m);
    if (s) return s;
    m.n_triangles = r->n_triangles;
    m.triangles = sheen_arena_alloc(arena, r->n_triangles, sizeof *m.triangles);
    if (!m.triangles) return no_memory(r);
    if (r->n_triangles) memcpy(m.triangles, r->triangles, (size_t)r->n_triangles * sizeof *m.triangles);
    if (r->has_face_colors) {
        m.face_color = SHEEN_ARENA_NEW(arena, Rgb, r->n_triangles);
        if (!m.face_color) return no_memory(r);
        if (r->n_triangles) memcpy(m.face_color, r->face_colors, r->n_triangles * sizeof *m.face_color);
    }
    *out = m;
    return SHEEN_OK;
}

SheenStatus sheen_ply_parse(const char *data, size_t size, const char *name, SheenArena *arena, const SheenLog *log,
                            MeshData *out)
{
    *out = (MeshData){0};
    Reader *r = calloc(1, sizeof *r);
    if (!r) return sheen_fail(log, SHEEN_ERR_NOMEM, "%s: out of memory", name);
    r->at = data, r->end = data + size, r->name = name, r->log = log;
    SheenStatus s = read_mesh(r, arena, out);
    free(r->triangles);
    free(r->face_colors);
    free(r->face);
    free(r->corners);
    free(r);
    return s;
}
