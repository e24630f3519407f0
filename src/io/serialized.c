// SPDX-License-Identifier: Apache-2.0
// Mitsuba's own mesh files. Format: jakob2010-mitsuba, plugin "serialized". A file is a row of meshes, each a short
// header and a zlib stream, and a dictionary of their places at the end. All numbers are little-endian.
#include "io/mesh.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { MAGIC = 0x041C, HEADER_SIZE = 4, MAX_NAME = 4096, MAX_RATIO = 1032 }; // zlib packs at most 1032 : 1
enum { HAS_NORMALS = 0x1, HAS_UV = 0x2, HAS_COLORS = 0x8, FACE_NORMALS = 0x10, DOUBLES = 0x2000 };

typedef struct Reader {
    z_stream z;
    const char *name;
    uint32_t index; // of the mesh in the file
    const SheenLog *log;
} Reader;

static SheenStatus fail_at(const Reader *r, const char *what)
{
    return sheen_fail(r->log, SHEEN_ERR_PARSE, "%s: mesh %u: %s", r->name, r->index, what);
}

static SheenStatus no_memory(const Reader *r)
{
    return sheen_fail(r->log, SHEEN_ERR_NOMEM, "%s: out of memory", r->name);
}

static uint64_t little_endian(const unsigned char *bytes, unsigned size)
{
    uint64_t bits = 0;
    for (unsigned i = 0; i < size; ++i) bits |= (uint64_t)bytes[i] << 8 * i;
    return bits;
}

// ---- the file ---------------------------------------------------------------------------------------------------

/** Finds mesh r->index: its zlib stream goes from *begin to the end of the file at most. */
static SheenStatus find_mesh(const Reader *r, const unsigned char *data, size_t size, uint16_t *version, size_t *begin)
{
    if (size < HEADER_SIZE || little_endian(data, 2) != MAGIC) return fail_at(r, "not a serialized mesh of Mitsuba");
    *version = (uint16_t)little_endian(data + 2, 2);
    if (*version != 3 && *version != 4)
        return sheen_fail(r->log, SHEEN_ERR_UNSUPPORTED,
                          "%s: version %u of serialized meshes cannot be read, 3 and 4 can", r->name, *version);
    uint64_t offset = 0;
    if (r->index > 0) { // the first is at the beginning, even in a file without a dictionary
        unsigned entry = *version == 4 ? 8 : 4;
        uint64_t count = little_endian(data + size - 4, 4);
        if (r->index >= count || count * entry > size - 4)
            return sheen_fail(r->log, SHEEN_ERR_PARSE, "%s: mesh %u is asked for, and the file holds %llu", r->name,
                              r->index, (unsigned long long)(count * entry > size - 4 ? 0 : count));
        offset = little_endian(data + size - 4 - (count - r->index) * entry, entry);
    }
    if (offset > size - HEADER_SIZE) return fail_at(r, "its place is beyond the file's end");
    if (little_endian(data + offset, 2) != MAGIC) return fail_at(r, "no mesh stands at its place in the file");
    *begin = (size_t)offset + HEADER_SIZE;
    return SHEEN_OK;
}

/** The next `size` bytes of the mesh. */
static SheenStatus read_bytes(Reader *r, unsigned char *out, size_t size)
{
    r->z.next_out = out;
    r->z.avail_out = (uInt)size; // a few kilobytes
    while (r->z.avail_out > 0) {
        int code = inflate(&r->z, Z_NO_FLUSH);
        if (code == Z_MEM_ERROR) return no_memory(r);
        if (code == Z_BUF_ERROR || (code == Z_STREAM_END && r->z.avail_out > 0))
            return fail_at(r, "the file ends in the middle of its data");
        if (code != Z_OK && code != Z_STREAM_END) return fail_at(r, "its compressed data is damaged");
    }
    return SHEEN_OK;
}

static SheenStatus read_integer(Reader *r, unsigned size, uint64_t *out)
{
    unsigned char bytes[8];
    SheenStatus s = read_bytes(r, bytes, size);
    *out = s ? 0 : little_endian(bytes, size);
    return s;
}

static float float_of(const unsigned char *bytes, bool is_double)
{
    union {
        uint64_t u;
        double d;
    } u64 = {.u = is_double ? little_endian(bytes, 8) : 0};
    union {
        uint32_t u;
        float f;
    } u32 = {.u = (uint32_t)little_endian(bytes, 4)};
    return is_double ? (float)u64.d : u32.f;
}

static SheenStatus read_floats(Reader *r, bool doubles, uint64_t n, float *out)
{
    enum { CHUNK = 4096 };
    unsigned char bytes[8 * CHUNK];
    unsigned size = doubles ? 8 : 4;
    for (uint64_t i = 0; i < n;) {
        unsigned some = n - i < CHUNK ? (unsigned)(n - i) : CHUNK;
        SheenStatus s = read_bytes(r, bytes, (size_t)some * size);
        if (s) return s;
        for (unsigned j = 0; j < some; ++j) out[i + j] = float_of(bytes + (size_t)j * size, doubles);
        i += some;
    }
    return SHEEN_OK;
}

static SheenStatus read_triangles(Reader *r, MeshData *m)
{
    enum { CHUNK = 1024 };
    unsigned char bytes[12 * CHUNK];
    for (uint32_t i = 0; i < m->n_triangles;) {
        unsigned some = m->n_triangles - i < CHUNK ? m->n_triangles - i : CHUNK;
        SheenStatus s = read_bytes(r, bytes, (size_t)12 * some);
        if (s) return s;
        for (unsigned j = 0; j < 3 * some; ++j) {
            uint32_t index = (uint32_t)little_endian(bytes + (size_t)4 * j, 4);
            if (index >= m->n_vertices)
                return sheen_fail(r->log, SHEEN_ERR_PARSE,
                                  "%s: mesh %u: vertex index %u is out of range: there are %u vertices", r->name,
                                  r->index, index, m->n_vertices);
            m->triangles[i + j / 3][j % 3] = index;
        }
        i += some;
    }
    return SHEEN_OK;
}

static SheenStatus skip_name(Reader *r)
{
    uint64_t c = 1;
    SheenStatus s = SHEEN_OK;
    for (int n = 0; !s && c != 0; ++n) {
        if (n == MAX_NAME) return fail_at(r, "its name does not end");
        s = read_integer(r, 1, &c);
    }
    return s;
}

/** Counts that the rest of the file cannot hold are refused before memory is asked for. */
static SheenStatus check_counts(const Reader *r, uint64_t flags, uint64_t n_vertices, uint64_t n_triangles)
{
    uint64_t most = ((uint64_t)r->z.avail_in + 32768) * MAX_RATIO; // and what zlib holds in its window
    uint64_t numbers =
        3u + (flags & HAS_NORMALS ? 3u : 0u) + (flags & HAS_UV ? 2u : 0u) + (flags & HAS_COLORS ? 3u : 0u);
    uint64_t vertex = numbers * (flags & DOUBLES ? 8 : 4);
    if (n_vertices >= SHEEN_NONE || n_triangles >= SHEEN_NONE || n_vertices * vertex > most ||
        n_triangles * 12 > most - n_vertices * vertex)
        return fail_at(r, "it promises more than the file can hold");
    return SHEEN_OK;
}

static SheenStatus read_mesh(Reader *r, uint16_t version, SheenArena *arena, MeshData *out, bool *face_normals)
{
    uint64_t flags, n_vertices = 0, n_triangles = 0;
    SheenStatus s = read_integer(r, 4, &flags);
    if (!s && version == 4) s = skip_name(r);
    if (!s) s = read_integer(r, 8, &n_vertices);
    if (!s) s = read_integer(r, 8, &n_triangles);
    if (!s) s = check_counts(r, flags, n_vertices, n_triangles);
    if (s) return s;
    MeshData m = {.n_vertices = (uint32_t)n_vertices, .n_triangles = (uint32_t)n_triangles};
    if (!sheen_mesh_alloc(arena, &m, flags & HAS_NORMALS, flags & HAS_UV)) return no_memory(r);
    if (flags & HAS_COLORS) {
        m.color = SHEEN_ARENA_NEW(arena, Rgb, m.n_vertices);
        if (!m.color) return no_memory(r);
    }
    bool doubles = flags & DOUBLES;
    s = read_floats(r, doubles, 3 * n_vertices, &m.p->x);
    if (!s && m.n) s = read_floats(r, doubles, 3 * n_vertices, &m.n->x);
    if (!s && m.uv) s = read_floats(r, doubles, 2 * n_vertices, &m.uv->x);
    if (!s && m.color) s = read_floats(r, doubles, 3 * n_vertices, &m.color->r);
    if (!s) s = read_triangles(r, &m);
    if (s) return s;
    for (uint32_t i = 0; m.n && i < m.n_vertices; ++i) m.n[i] = v3_normalize(m.n[i]);
    *face_normals = flags & FACE_NORMALS; // as the format says; Mitsuba 3.7 overlooks it
    *out = m;
    return SHEEN_OK;
}

SheenStatus sheen_serialized_parse(const char *data, size_t size, const char *name, uint32_t index, SheenArena *arena,
                                   const SheenLog *log, MeshData *out, bool *face_normals)
{
    *out = (MeshData){0};
    *face_normals = false;
    Reader r = {.name = name, .index = index, .log = log};
    uint16_t version = 0;
    size_t begin = 0;
    SheenStatus s = find_mesh(&r, (const unsigned char *)data, size, &version, &begin);
    if (s) return s;
    if (size - begin > UINT32_MAX) size = begin + UINT32_MAX; // files end at 4 GiB
    r.z.next_in = (z_const Bytef *)(uintptr_t)(data + begin);
    r.z.avail_in = (uInt)(size - begin);
    int code = inflateInit(&r.z);
    if (code != Z_OK) return no_memory(&r);
    s = read_mesh(&r, version, arena, out, face_normals);
    inflateEnd(&r.z);
    return s;
}
