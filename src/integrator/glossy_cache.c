// SPDX-License-Identifier: Apache-2.0
#include "integrator/glossy_cache.h"

#include "material/lobe_table.h"

#include <stdlib.h>

struct SheenGlossyCache {
    SheenLobeTables *tables;
    SheenRotation *to_world; // spherical coefficients from a local frame
    SheenBasis *basis;       // [shapes]
};

// A mesh is flat when its shading normals are those of its faces, and these are few: a room, a box, a pane. What has
// more is a curved thing made of flat pieces.
enum { FLAT_NORMALS_MAX = 32 };

static Vec3 corner(const SheenMesh *m, uint32_t triangle, int k)
{
    return m->p[m->triangles[triangle][k]];
}

// Whether the triangle's vertices have its own normal, or none.
static bool shaded_flat(const SheenMesh *m, uint32_t triangle, Vec3 n)
{
    for (int k = 0; k < 3 && m->n; ++k)
        if (!(fabsf(v3_dot(m->n[m->triangles[triangle][k]], n)) > SHEEN_SAME_COS)) return false;
    return true;
}

static bool mesh_is_flat(const SheenMesh *m)
{
    Vec3 found[FLAT_NORMALS_MAX];
    unsigned n_found = 0;
    for (uint32_t i = 0; i < m->n_triangles; ++i) {
        Vec3 a = corner(m, i, 0);
        Vec3 n = v3_normalize(v3_cross(v3_sub(corner(m, i, 1), a), v3_sub(corner(m, i, 2), a)));
        if (!(v3_length2(n) > 0.0f)) continue;
        if (!shaded_flat(m, i, n)) return false;
        unsigned k = 0;
        while (k < n_found && !(v3_dot(found[k], n) > SHEEN_SAME_COS)) ++k;
        if (k < n_found) continue;
        if (n_found == FLAT_NORMALS_MAX) return false;
        found[n_found++] = n;
    }
    return true;
}

static SheenBasis basis_of(const SheenShape *shape, SheenBasisChoice choice)
{
    if (choice != SHEEN_BASIS_AUTO) return choice == SHEEN_BASIS_ALL_SH ? SHEEN_BASIS_SH : SHEEN_BASIS_HSH;
    bool flat = shape->kind == SHEEN_SHAPE_DISK || (shape->kind == SHEEN_SHAPE_MESH && mesh_is_flat(&shape->mesh));
    return flat ? SHEEN_BASIS_HSH : SHEEN_BASIS_SH;
}

SheenStatus sheen_glossy_cache_create(const SheenWork *work, SheenGlossyCache **out)
{
    *out = NULL;
    SheenGlossyCache *g = calloc(1, sizeof *g);
    if (!g) return SHEEN_ERR_NOMEM;
    SheenLobeTableDesc desc = {.order = work->options.order, .error = work->options.brdf_error};
    SheenStatus status = sheen_lobe_tables_create(work->log, work->scene, &desc, work->pool, work->cancel, &g->tables);
    unsigned order = sheen_lobe_tables_order(g->tables);
    if (status == SHEEN_OK && order == 0) {
        sheen_glossy_cache_destroy(&g);
        return SHEEN_OK;
    }
    const SheenScene *scene = work->scene;
    if (status == SHEEN_OK) status = sheen_rotation_create(SHEEN_BASIS_SH, order, 0.0f, &g->to_world);
    g->basis = calloc(scene->n_shapes + 1, sizeof *g->basis);
    if (!g->basis) status = SHEEN_ERR_NOMEM;
    for (uint32_t i = 0; i < scene->n_shapes && status == SHEEN_OK; ++i)
        if (sheen_lobe_tables_has(g->tables, scene->shapes[i].material))
            g->basis[i] = basis_of(&scene->shapes[i], work->options.basis);
    if (status != SHEEN_OK) sheen_glossy_cache_destroy(&g);
    *out = g;
    return status;
}

void sheen_glossy_cache_destroy(SheenGlossyCache **glossy)
{
    SheenGlossyCache *g = glossy ? *glossy : NULL;
    if (!g) return;
    sheen_lobe_tables_destroy(&g->tables);
    sheen_rotation_destroy(&g->to_world);
    free(g->basis);
    free(g);
    *glossy = NULL;
}

unsigned sheen_glossy_cache_order(const SheenGlossyCache *g)
{
    return sheen_lobe_tables_order(g->tables);
}

// From the mirrored hemisphere behind a surface to the frame about the normal there. With the frame (t, b, n) in front
// the mirror image has the axes (t, b, -n), which are no rotation of any frame: (t, -b, -n) are, and turn the sign of y
// and with it of all functions with m < 0.
static void turn_behind(const Frame *front, unsigned n, Rgb c[])
{
    for (unsigned l = 1; l < n; ++l)
        for (int m = -(int)l; m < 0; ++m) c[basis_index(l, m)] = rgb_scale(c[basis_index(l, m)], -1.0f);
    Frame mirrored = {front->t, v3_neg(front->b), v3_neg(front->n)}, behind = frame_from_normal(v3_neg(front->n));
    SheenEuler e = sheen_euler_between(&mirrored, &behind); // about z alone
    Vec2 turn = v2(e.alpha.x * e.gamma.x - e.alpha.y * e.gamma.y, e.alpha.x * e.gamma.y + e.alpha.y * e.gamma.x);
    sheen_rotate_z(n, turn, 3, &c[0].r, &c[0].r);
}

void sheen_glossy_cache_read(const SheenGlossyCache *g, SeenSurface *v, GlossyLobe *out)
{
    LobeReading reading;
    out->basis = g->basis[v->s.shape];
    sheen_lobe_table_read(g->tables, out->basis, &v->bsdf, v->wo_l, out->coefficients, &reading);
    out->order = reading.order;
    if (reading.order == 0) return;
    v->cached = true;
    v->rest = v->bsdf;
    sheen_bsdf_leave_rest(&v->rest, &reading);
}

// Whether all coefficients are multiples of one colour, as those of a lobe without Fresnel's colours are.
// @param largest  channel of the colour; @param share  out: the colour over that channel
static bool of_one_color(size_t n, const Rgb c[], unsigned *largest, Rgb *share)
{
    const float rounding = 1e-5f;
    const float *mean = &c[0].r; // of the lobe: not 0
    *largest = mean[1] > mean[0] ? 1 : 0;
    if (mean[2] > mean[*largest]) *largest = 2;
    if (!(mean[*largest] > 0.0f)) return false;
    *share = rgb_scale(c[0], 1.0f / mean[*largest]);
    float most = rounding * mean[*largest];
    for (size_t i = 1; i < n; ++i) {
        Rgb off = rgb_sub(c[i], rgb_scale(*share, (&c[i].r)[*largest]));
        if (fabsf(off.r) > most || fabsf(off.g) > most || fabsf(off.b) > most) return false;
    }
    return true;
}

// Of a lobe of one colour one channel is turned: a third of the time.
static void turn_to_world(const SheenGlossyCache *g, const Frame *frame, Rgb c[])
{
    size_t n = basis_size(sheen_glossy_cache_order(g));
    unsigned channel;
    Rgb share;
    if (!of_one_color(n, c, &channel, &share)) {
        sheen_rotation_to_world(g->to_world, frame, 3, &c[0].r, &c[0].r);
        return;
    }
    float one[SHEEN_BASIS_MAX];
    for (size_t i = 0; i < n; ++i) one[i] = (&c[i].r)[channel];
    sheen_rotation_to_world(g->to_world, frame, 1, one, one);
    for (size_t i = 0; i < n; ++i) c[i] = rgb_scale(share, one[i]);
}

void sheen_glossy_cache_orient(const SheenGlossyCache *g, const SeenSurface *v, GlossyLobe *lobe)
{
    if (lobe->basis == SHEEN_BASIS_SH)
        turn_to_world(g, &v->frame, lobe->coefficients);
    else if (v->wo_l.z < 0.0f)
        turn_behind(&v->frame, lobe->order, lobe->coefficients);
}
