// SPDX-License-Identifier: Apache-2.0
// Curves of Mitsuba scenes (linearcurve, bsplinecurve, and hair of version 0.6) as tubes of triangles. As in Mitsuba 3,
// seen by asking it: the transform places the control points and leaves the radii, u goes round and v along all curves,
// straight curves have round ends and splines open ones.
#include "image/whole_file.h"
#include "io/mesh.h"
#include "io/mitsuba.h"
#include "io/number.h"

#include <stdlib.h>
#include <string.h>

typedef struct Node {
    Vec3 p;
    float radius;
    bool first; // of a curve
} Node;

typedef struct Nodes {
    Node *items; // from malloc
    uint32_t n, capacity;
} Nodes;

/** Rings of a tube: more where there are few. */
enum { ROUND_END = 3, SPLINE_STEPS = 6, MAX_NODES = 1 << 24 };

static bool add_node(Nodes *nodes, Node node)
{
    if (nodes->n >= MAX_NODES ||
        !sheen_reserve((void **)&nodes->items, &nodes->capacity, (uint64_t)nodes->n + 1, sizeof node))
        return false;
    nodes->items[nodes->n++] = node;
    return true;
}

// ---- files ------------------------------------------------------------------------------------------------------

/** Lines of x y z and, unless it is given, a radius; an empty line begins a curve. @param radius  0: in the file */
static bool parse_text(const char *text, const char *end, float radius, Nodes *out)
{
    const int wanted = radius > 0.0f ? 3 : 4;
    bool first = true;
    while (text < end) {
        double v[4] = {0, 0, 0, (double)radius};
        int n = 0;
        const char *line_end = memchr(text, '\n', (size_t)(end - text));
        if (!line_end) line_end = end;
        for (;; ++n) {
            while (text < line_end && (unsigned char)*text <= ' ') ++text;
            if (text == line_end || *text == '#') break;
            if (n == 4 || !sheen_number_parse(&text, line_end, &v[n]) || !(fabs(v[n]) < 1e30)) return false;
        }
        text = line_end + (line_end < end);
        if (n == 0) {
            first = true;
            continue;
        }
        if (n < wanted) return false;
        if (radius > 0.0f) v[3] = (double)radius;
        Node node = {v3((float)v[0], (float)v[1], (float)v[2]), fabsf((float)v[3]), first};
        if (!add_node(out, node)) return false;
        first = false;
    }
    return true;
}

static const char binary_mark[] = "BINARY_HAIR";

/** Version 0.6: a count, then points of three floats; an infinite one before a point begins a curve. */
static bool parse_binary(const char *data, size_t size, float radius, Nodes *out)
{
    uint32_t count;
    size_t at = sizeof binary_mark - 1;
    if (size - at < sizeof count) return false;
    memcpy(&count, data + at, sizeof count);
    at += sizeof count;
    bool first = true;
    for (uint32_t i = 0; i < count; ++i) {
        float v[3], mark;
        if (size - at < sizeof mark) return false;
        memcpy(&mark, data + at, sizeof mark);
        if (isinf(mark)) first = true, at += sizeof mark;
        if (size - at < sizeof v) return false;
        memcpy(v, data + at, sizeof v);
        at += sizeof v;
        for (int j = 0; j < 3; ++j)
            if (!(fabsf(v[j]) < 1e30f)) return false;
        if (!add_node(out, (Node){v3(v[0], v[1], v[2]), radius, first})) return false;
        first = false;
    }
    return true;
}

// ---- splines ----------------------------------------------------------------------------------------------------

static Node blend(const Node c[4], const float w[4], bool first)
{
    Node n = {{0, 0, 0}, 0.0f, first};
    for (int i = 0; i < 4; ++i) {
        n.p = v3_mad(n.p, w[i], c[i].p);
        n.radius += w[i] * c[i].radius;
    }
    return n;
}

/** Puts points of the uniform cubic B-splines of a file's control points in their place. @return false: no memory */
static bool evaluate_splines(Nodes *nodes)
{
    Nodes out = {0};
    bool ok = true;
    for (uint32_t i = 3; ok && i < nodes->n; ++i) {
        const Node *c = &nodes->items[i - 3];
        if (c[1].first || c[2].first || c[3].first) continue;
        bool begins = c[0].first;
        for (int s = begins ? 0 : 1; ok && s <= SPLINE_STEPS; ++s) {
            float t = (float)s / SPLINE_STEPS, u = 1.0f - t;
            const float w[4] = {u * u * u / 6.0f, (4.0f - 6.0f * t * t + 3.0f * t * t * t) / 6.0f,
                                (4.0f - 6.0f * u * u + 3.0f * u * u * u) / 6.0f, t * t * t / 6.0f};
            ok = add_node(&out, blend(c, w, begins && s == 0));
        }
    }
    free(nodes->items);
    *nodes = out;
    return ok;
}

// ---- tubes ------------------------------------------------------------------------------------------------------

typedef struct Tube {
    MeshData *mesh;
    uint32_t sides;
    float v;        // along all curves
    bool after_tip; // the last ring was the point of a round end
} Tube;

/** @param lean  of the normals along the axis: 0 on a cylinder, -1 and 1 at round ends */
static void add_ring(Tube *t, const Frame *f, Vec3 center, float radius, float lean, bool joined)
{
    MeshData *m = t->mesh;
    const uint32_t row = t->sides + 1; // the seam has two uv
    float across = safe_sqrtf(1.0f - lean * lean);
    bool tip = across < 1e-3f;
    for (uint32_t k = 0; k < row; ++k) {
        float phi = 2.0f * SHEEN_PI * (float)(k % t->sides) / (float)t->sides;
        Vec3 out = v3_add(v3_scale(f->t, cosf(phi)), v3_scale(f->b, sinf(phi)));
        uint32_t i = m->n_vertices++;
        m->p[i] = v3_mad(v3_mad(center, radius * across, out), radius * lean, f->n);
        m->n[i] = v3_mad(v3_scale(out, across), lean, f->n);
        m->uv[i] = v2((float)k / (float)t->sides, 1.0f - t->v);
        if (!joined || k == t->sides) continue;
        uint32_t(*to)[3] = &m->triangles[m->n_triangles];
        uint32_t n = 0;
        if (!t->after_tip) to[n][0] = i - row, to[n][1] = i - row + 1, to[n][2] = i + 1, ++n;
        if (!tip) to[n][0] = i - row, to[n][1] = i + 1, to[n][2] = i, ++n;
        m->n_triangles += n;
    }
    t->after_tip = tip;
}

/** The frame turned as little as possible about a new axis. */
static Frame turned(const Frame *f, Vec3 axis)
{
    Vec3 t = v3_mad(f->t, -v3_dot(f->t, axis), axis);
    if (!(v3_length2(t) > 1e-6f)) return frame_from_normal(axis);
    t = v3_normalize(t);
    return (Frame){t, v3_cross(axis, t), axis};
}

static void add_end(Tube *t, const Frame *f, const Node *node, float side)
{
    for (int i = 0; i < ROUND_END; ++i) {
        int step = side < 0.0f ? ROUND_END - i : i + 1; // from the pole, or to it
        add_ring(t, f, node->p, node->radius, side * sinf(0.5f * SHEEN_PI * (float)step / ROUND_END),
                 side > 0.0f || i > 0);
    }
}

static void add_tube(Tube *t, const Node nodes[], uint32_t n, float v_step, bool round)
{
    Frame f = {0};
    bool has_frame = false;
    for (uint32_t i = 0; i < n; ++i) {
        Vec3 axis = v3_normalize(v3_sub(nodes[i + 1 < n ? i + 1 : i].p, nodes[i > 0 ? i - 1 : 0].p));
        if (v3_finite(axis) && v3_length2(axis) > 0.5f) {
            f = has_frame ? turned(&f, axis) : frame_from_normal(axis);
            has_frame = true;
        } else if (!has_frame) {
            f = frame_from_normal(v3(0, 0, 1));
        }
        if (i == 0 && round) add_end(t, &f, &nodes[i], -1.0f);
        if (i > 0) t->v += v_step;
        add_ring(t, &f, nodes[i].p, nodes[i].radius, 0.0f, i > 0 || round);
        if (i + 1 == n && round) add_end(t, &f, &nodes[i], 1.0f);
    }
}

static bool make_tubes(SheenArena *arena, const Nodes *nodes, bool round, MeshData *mesh)
{
    uint32_t n_curves = 0;
    for (uint32_t i = 0; i < nodes->n; ++i) n_curves += nodes->items[i].first;
    Tube t = {.mesh = mesh, .sides = nodes->n < 20000 ? 12 : nodes->n < 400000 ? 6 : 3};
    uint64_t rings = (uint64_t)nodes->n + (round ? 2u * ROUND_END * (uint64_t)n_curves : 0);
    uint64_t n_vertices = rings * (t.sides + 1), n_triangles = rings * t.sides * 2;
    if (n_triangles >= SHEEN_NONE) return false;
    *mesh = (MeshData){.n_vertices = (uint32_t)n_vertices, .n_triangles = (uint32_t)n_triangles};
    if (!sheen_mesh_alloc(arena, mesh, true, true)) return false;
    mesh->n_vertices = mesh->n_triangles = 0; // counted as they come
    uint32_t n_segments = nodes->n - n_curves;
    for (uint32_t i = 0, end; i < nodes->n; i = end) {
        for (end = i + 1; end < nodes->n && !nodes->items[end].first;) ++end;
        if (end - i > 1) add_tube(&t, &nodes->items[i], end - i, 1.0f / (float)n_segments, round);
    }
    return true;
}

bool sheen_mi_curves(Mitsuba *m, SheenXml *e, MitsubaCurve kind, MeshData *mesh)
{
    const char *path = sheen_mi_path(m, e, "filename", "curves");
    bool hair = kind == MITSUBA_CURVE_HAIR;
    float radius = hair ? (float)sheen_mi_float(m, e, "radius", 0.025) : 0.0f;
    Transform to_world = sheen_mi_transform(m, e, "to_world");
    sheen_mi_ignore(e, "angle_threshold reduction"); // what the other leaves out
    if (hair && !m->status && !(radius > 0.0f && radius < 1e15f))
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the radius of hair must be positive, not %g", (double)radius);
    if (m->status) return false;
    uint8_t *data;
    size_t size;
    SheenStatus s = sheen_file_read(path, m->log, &data, &size);
    if (s) {
        m->status = s;
        return false;
    }
    const char *text = (const char *)data;
    Nodes nodes = {0};
    bool binary = hair && size >= sizeof binary_mark - 1 && memcmp(text, binary_mark, sizeof binary_mark - 1) == 0;
    bool ok = binary ? parse_binary(text, size, radius, &nodes) : parse_text(text, text + size, radius, &nodes);
    free(data);
    if (!ok) sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "'%s' is not a list of the points of curves", path);
    for (uint32_t i = 0; i < nodes.n; ++i) nodes.items[i].p = transform_point(&to_world, nodes.items[i].p);
    if (ok && !((kind != MITSUBA_CURVE_SPLINE || evaluate_splines(&nodes)) &&
                make_tubes(m->arena, &nodes, kind == MITSUBA_CURVE_LINEAR, mesh))) {
        sheen_mi_fail(m, SHEEN_ERR_NOMEM, e, "too many curves for the memory");
        ok = false;
    }
    free(nodes.items);
    return ok;
}
