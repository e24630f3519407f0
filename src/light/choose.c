// SPDX-License-Identifier: Apache-2.0
// The inner loop of the renderer: at every point, an estimate for every light. The lights lie in arrays by kind, and
// each loop over them is without branches, so that the compiler turns it into vector instructions.
#include "light/choose.h"

// Weights on the stack.
#define WEIGHTS_MAX 1024u

// Flat convex lights with four vertices; a triangle has its last one twice, a disk has its bounding rectangle's.
typedef struct Polygons {
    uint32_t n;
    float *x[4], *y[4], *z[4];
    float *nx, *ny, *nz; // unit normal of the front
    float *area;         // of the polygon, m^2
    float *power;        // radiance times the share of the polygon that shines
} Polygons;

typedef struct Spheres {
    uint32_t n;
    float *x, *y, *z, *r2;
    float *outside, *inside; // radiance on either side
} Spheres;

// Anything in a sphere, with normals in a cone.
typedef struct Bodies {
    uint32_t n;
    float *x, *y, *z, *r2;
    float *nx, *ny, *nz;        // axis of the cone
    float *cos_cone, *sin_cone; // its half-angle
    float *power;               // radiance times mean area seen, W/sr
} Bodies;

typedef struct Points {
    uint32_t n;
    float *x, *y, *z;
    float *intensity;
} Points;

struct ChooseTable {
    const Source *sources;
    uint32_t n;
    Polygons polygons;
    Spheres spheres;
    Bodies meshes;
    Points points;
    uint32_t n_rest; // spots, directional lights and the environment: the last of the sources
};

// ---- estimates --------------------------------------------------------------------------------------------------

// Mean cosine to the horizon over a sphere whose centre has cosine c and whose radius over distance is s, the part
// below the horizon counting as zero: exact where all is above or all below, a parabola between. It is positive as soon
// as the sphere's rim is above, which makes every estimate built on it conservative.
static inline float horizon(float c, float s)
{
    float t = maxf(c + s, 0.0f);
    float across = t * t / (4.0f * s);
    return c >= s ? c : across;
}

// theta / (2 pi sin theta) for x = cos theta, a rational fit. Source: heitz2016-ltc-real-time, sec. "Polygons".
static inline float edge_factor(float x)
{
    float y = fabsf(x);
    float v = (0.8543985f + (0.4965155f + 0.0145206f * y) * y) / (3.4175940f + (4.1616724f + y) * y);
    float obtuse = 0.5f / sqrtf(maxf(1.0f - x * x, 1e-7f)) - v;
    return x > 0.0f ? v : obtuse;
}

// The irradiance of a uniform polygon on a surface that faces it is pi L times the length of the vector form factor, a
// sum over its edges (Lambert's formula). A surface that is turned away sees it as it would the sphere with the same
// form factor. Where the edges would cancel to nothing in float, the polygon is a point. The share by the highest
// vertex keeps the estimate above zero wherever a part of the polygon is above the horizon.
static void weigh_polygons(const Polygons *g, Vec3 p, Vec3 n, float *restrict w)
{
    for (uint32_t i = 0; i < g->n; ++i) {
        Vec3 v[4], sum = v3(0, 0, 0), f = v3(0, 0, 0);
        float top = -1.0f;
        float front = (p.x - g->x[0][i]) * g->nx[i] + (p.y - g->y[0][i]) * g->ny[i] + (p.z - g->z[0][i]) * g->nz[i];
        for (int k = 0; k < 4; ++k) {
            Vec3 d = v3_sub(v3(g->x[k][i], g->y[k][i], g->z[k][i]), p);
            sum = v3_add(sum, d);
            v[k] = v3_scale(d, 1.0f / sqrtf(v3_length2(d) + 1e-30f));
            top = maxf(top, v3_dot(v[k], n));
        }
        for (int k = 0; k < 4; ++k) {
            Vec3 a = v[k], b = v[(k + 1) & 3];
            f = v3_mad(f, edge_factor(v3_dot(a, b)), v3_cross(b, a)); // toward the light, seen from its front
        }
        float d2 = 0.0625f * v3_length2(sum) + 1e-30f, d = sqrtf(d2);
        float length = sqrtf(v3_length2(f)) + 1e-20f;
        float cos_far = 0.25f * v3_dot(sum, n) / d, cos_near = v3_dot(f, n) / length;
        float size = g->area[i] / d2, factor_far = minf(SHEEN_INV_PI * size * front / d, 1.0f);
        bool far = size < 1e-3f;
        float factor = far ? factor_far : maxf(length, 0.1f * factor_far);
        float c = far ? cos_far : cos_near;
        float seen = horizon(c, sqrtf(factor) + 1e-20f) + 0.02f * maxf(top, 0.0f);
        float e = SHEEN_PI * g->power[i] * factor * seen;
        w[i] = front > 0.0f && top > 0.0f ? e : 0.0f;
    }
}

static void weigh_spheres(const Spheres *g, Vec3 p, Vec3 n, float *restrict w)
{
    for (uint32_t i = 0; i < g->n; ++i) {
        Vec3 d = v3_sub(v3(g->x[i], g->y[i], g->z[i]), p);
        float d2 = maxf(v3_length2(d), 1e-30f), size = minf(g->r2[i] / d2, 1.0f);
        float from_outside = g->outside[i] * size * horizon(v3_dot(d, n) / sqrtf(d2), sqrtf(size));
        w[i] = SHEEN_PI * (d2 > g->r2[i] ? from_outside : g->inside[i]);
    }
}

// Power over squared distance, with both cosines bounded over the body's sphere and cone of normals.
// Source: estevez2018-many-lights, sec. 4.
static void weigh_bodies(const Bodies *g, Vec3 p, Vec3 n, float *restrict w)
{
    for (uint32_t i = 0; i < g->n; ++i) {
        Vec3 d = v3_sub(v3(g->x[i], g->y[i], g->z[i]), p);
        float d2 = maxf(maxf(v3_length2(d), g->r2[i]), 1e-30f);
        float inverse = 1.0f / sqrtf(maxf(v3_length2(d), 1e-30f)), size = sqrtf(g->r2[i] / d2) + 1e-20f;
        // Angle to the axis less the cone's; 1 inside the cone.
        float c = -(d.x * g->nx[i] + d.y * g->ny[i] + d.z * g->nz[i]) * inverse;
        float turned = c * g->cos_cone[i] + sqrtf(maxf(1.0f - c * c, 0.0f)) * g->sin_cone[i];
        float cos_l = c >= g->cos_cone[i] ? 1.0f : turned;
        float cos_s = v3_dot(d, n) * inverse;
        w[i] = g->power[i] / d2 * horizon(cos_l, size) * horizon(cos_s, size);
    }
}

static void weigh_points(const Points *g, Vec3 p, Vec3 n, float *restrict w)
{
    for (uint32_t i = 0; i < g->n; ++i) {
        Vec3 d = v3_sub(v3(g->x[i], g->y[i], g->z[i]), p);
        float d2 = maxf(v3_length2(d), 1e-20f);
        w[i] = g->intensity[i] * maxf(v3_dot(d, n), 0.0f) / (d2 * sqrtf(d2));
    }
}

static float weigh_spot(const SheenLight *l, Vec3 p, Vec3 n)
{
    Vec3 d = v3_sub(l->position, p);
    float d2 = maxf(v3_length2(d), 1e-20f), inverse = 1.0f / sqrtf(d2);
    float cosine = maxf(v3_dot(d, n) * inverse, 0.0f);
    if (cosine == 0.0f) return 0.0f;
    return rgb_mean(l->radiance) * sheen_spot_falloff(l, -v3_dot(d, l->direction) * inverse) * cosine / d2;
}

// Light from one direction reaches a surface by its cosine, even light by a quarter of the flux; an environment is
// taken for a mixture of both, by how much its directions cancel. A little is left for surfaces that face away.
static float weigh_environment(const EnvironmentSampler *e, Vec3 n)
{
    float even = e->flux - v3_length(e->flux_vector);
    return 0.25f * maxf(even, 0.1f * e->flux) + maxf(v3_dot(e->flux_vector, n), 0.0f);
}

static float weigh_rest(const Source *s, Vec3 p, Vec3 n)
{
    switch (s->kind) {
    case SOURCE_SPOT:
        return weigh_spot(s->light, p, n);
    case SOURCE_DIRECTIONAL:
        return rgb_mean(s->light->radiance) * maxf(-v3_dot(s->light->direction, n), 0.0f);
    default:
        return weigh_environment(&s->environment, n);
    }
}

// ---- choice -----------------------------------------------------------------------------------------------------

// Weights of all lights. @return their sum, 0 when it is not finite.
static float weigh_all(const ChooseTable *t, Vec3 p, Vec3 n, float w[WEIGHTS_MAX])
{
    float *at = w;
    weigh_polygons(&t->polygons, p, n, at);
    at += t->polygons.n;
    weigh_spheres(&t->spheres, p, n, at);
    at += t->spheres.n;
    weigh_bodies(&t->meshes, p, n, at);
    at += t->meshes.n;
    weigh_points(&t->points, p, n, at);
    at += t->points.n;
    for (uint32_t i = t->n - t->n_rest; i < t->n; ++i) *at++ = weigh_rest(&t->sources[i], p, n);
    float sum = 0.0f;
    for (uint32_t i = 0; i < t->n; ++i) sum += w[i];
    return isfinite(sum) ? sum : 0.0f;
}

float sheen_choose_table_pick(const ChooseTable *t, Vec3 p, Vec3 n, float *u, uint32_t *light)
{
    *light = 0;
    if (t->n <= 1) return t->n == 1 ? 1.0f : 0.0f; // nothing to compare
    float w[WEIGHTS_MAX];
    float sum = weigh_all(t, p, n, w);
    if (!(sum > 0.0f)) return 0.0f;
    float target = *u * sum, before = 0.0f;
    uint32_t pick = SHEEN_NONE;
    for (uint32_t i = 0; i < t->n; ++i) {
        if (!(w[i] > 0.0f)) continue;
        if (pick != SHEEN_NONE && before + w[pick] > target) break;
        if (pick != SHEEN_NONE) before += w[pick];
        pick = i;
    }
    *u = clampf((target - before) / w[pick], 0.0f, 0x1.fffffep-1f);
    *light = pick;
    return w[pick] / sum;
}

float sheen_choose_table_probability(const ChooseTable *t, Vec3 p, Vec3 n, uint32_t light)
{
    if (t->n == 1) return 1.0f;
    float w[WEIGHTS_MAX];
    float sum = weigh_all(t, p, n, w);
    return sum > 0.0f ? w[light] / sum : 0.0f;
}

// ---- tables -----------------------------------------------------------------------------------------------------

static bool allocate(SheenArena *arena, uint32_t n, float **arrays[], size_t n_arrays)
{
    for (size_t k = 0; k < n_arrays; ++k) {
        *arrays[k] = SHEEN_ARENA_NEW(arena, float, n);
        if (!*arrays[k]) return false;
    }
    return true;
}
#define ALLOCATE(arena, n, ...)                                                                                        \
    allocate(arena, n, (float **[]){__VA_ARGS__}, sizeof((float **[]){__VA_ARGS__}) / sizeof(float **))

static void set_polygon(Polygons *g, uint32_t i, const Source *s)
{
    Vec3 v[4], n;
    double area;
    if (s->kind == SOURCE_TRIANGLE) {
        const SheenMesh *m = &s->shape->mesh;
        for (int k = 0; k < 3; ++k) v[k] = m->p[m->triangles[0][k]];
        v[3] = v[2];
        n = v3_normalize(v3_cross(v3_sub(v[1], v[0]), v3_sub(v[2], v[0])));
        area = s->area;
    } else {
        const SheenRectangle *r = &s->rectangle;
        bool forward = v3_dot(v3_cross(r->ex, r->ey), r->n) > 0.0f; // counter-clockwise as seen from the front
        v[0] = r->corner;
        v[1] = v3_add(r->corner, forward ? r->ex : r->ey);
        v[2] = v3_add(v3_add(r->corner, r->ex), r->ey);
        v[3] = v3_add(r->corner, forward ? r->ey : r->ex);
        n = r->n;
        area = r->lx * r->ly;
    }
    for (int k = 0; k < 4; ++k) g->x[k][i] = v[k].x, g->y[k][i] = v[k].y, g->z[k][i] = v[k].z;
    g->nx[i] = n.x, g->ny[i] = n.y, g->nz[i] = n.z;
    g->area[i] = (float)area;
    g->power[i] = rgb_mean(s->light->radiance) * (float)(s->area / area);
}

static void set_sphere(Spheres *g, uint32_t i, const Source *s)
{
    const SheenSphere *sphere = &s->shape->sphere;
    float l = rgb_mean(s->light->radiance);
    g->x[i] = sphere->center.x, g->y[i] = sphere->center.y, g->z[i] = sphere->center.z;
    g->r2[i] = sqrf(sphere->radius);
    g->outside[i] = sphere->flip ? 0.0f : l;
    g->inside[i] = sphere->flip ? l : 0.0f;
}

static Vec3 mesh_normal(const SheenMesh *m, uint32_t i)
{
    const uint32_t *t = m->triangles[i];
    return v3_normalize(v3_cross(v3_sub(m->p[t[1]], m->p[t[0]]), v3_sub(m->p[t[2]], m->p[t[0]])));
}

static void set_mesh(Bodies *g, uint32_t i, const Source *s)
{
    const SheenMesh *m = &s->shape->mesh;
    Bounds box = bounds_empty();
    D3 sum = d3(0, 0, 0); // normals by share of the area
    for (uint32_t k = 0; k < m->n_triangles; ++k) {
        for (int j = 0; j < 3; ++j) box = bounds_add(box, m->p[m->triangles[k][j]]);
        sum = d3_mad(sum, s->triangle_cdf[k + 1] - s->triangle_cdf[k], d3_sub(mesh_normal(m, k), v3(0, 0, 0)));
    }
    float flat = (float)d3_length(sum); // 1 for a flat mesh, 0 for a closed one
    Vec3 axis = v3_normalize(v3((float)sum.x, (float)sum.y, (float)sum.z));
    float cos_cone = 1.0f;
    for (uint32_t k = 0; k < m->n_triangles; ++k) cos_cone = minf(cos_cone, v3_dot(axis, mesh_normal(m, k)));
    cos_cone = flat > 1e-3f ? maxf(cos_cone - 1e-4f, -1.0f) : -1.0f;
    Vec3 c = bounds_center(&box);
    g->x[i] = c.x, g->y[i] = c.y, g->z[i] = c.z;
    g->r2[i] = sqrf(bounds_radius(&box) * 1.0001f);
    g->nx[i] = axis.x, g->ny[i] = axis.y, g->nz[i] = axis.z;
    g->cos_cone[i] = cos_cone;
    g->sin_cone[i] = safe_sqrtf(1.0f - cos_cone * cos_cone);
    // A flat light shows all its area at most, a convex closed one a quarter on average.
    g->power[i] = rgb_mean(s->light->radiance) * (float)s->area * lerpf(0.25f, 1.0f, minf(flat, 1.0f));
}

static void set_point(Points *g, uint32_t i, const Source *s)
{
    Vec3 p = s->light->position;
    g->x[i] = p.x, g->y[i] = p.y, g->z[i] = p.z;
    g->intensity[i] = rgb_mean(s->light->radiance);
}

static bool allocate_all(ChooseTable *t, SheenArena *a)
{
    Polygons *g = &t->polygons;
    Spheres *s = &t->spheres;
    Bodies *b = &t->meshes;
    Points *p = &t->points;
    return ALLOCATE(a, g->n, &g->x[0], &g->x[1], &g->x[2], &g->x[3], &g->y[0], &g->y[1], &g->y[2], &g->y[3], &g->z[0],
                    &g->z[1], &g->z[2], &g->z[3], &g->nx, &g->ny, &g->nz, &g->area, &g->power) &&
           ALLOCATE(a, s->n, &s->x, &s->y, &s->z, &s->r2, &s->outside, &s->inside) &&
           ALLOCATE(a, b->n, &b->x, &b->y, &b->z, &b->r2, &b->nx, &b->ny, &b->nz, &b->cos_cone, &b->sin_cone,
                    &b->power) &&
           ALLOCATE(a, p->n, &p->x, &p->y, &p->z, &p->intensity);
}

SheenStatus sheen_choose_table_init(const Source sources[], uint32_t n, SheenArena *arena, ChooseTable **out)
{
    ChooseTable *t = SHEEN_ARENA_NEW(arena, ChooseTable, 1);
    if (!t) return SHEEN_ERR_NOMEM;
    t->sources = sources;
    t->n = n;
    for (uint32_t i = 0; i < n; ++i) {
        SourceKind kind = sources[i].kind;
        if (kind <= SOURCE_DISK)
            t->polygons.n++;
        else if (kind == SOURCE_SPHERE)
            t->spheres.n++;
        else if (kind == SOURCE_MESH)
            t->meshes.n++;
        else if (kind == SOURCE_POINT)
            t->points.n++;
        else
            t->n_rest++;
    }
    if (!allocate_all(t, arena)) return SHEEN_ERR_NOMEM;
    const Source *s = sources;
    for (uint32_t i = 0; i < t->polygons.n; ++i) set_polygon(&t->polygons, i, s++);
    for (uint32_t i = 0; i < t->spheres.n; ++i) set_sphere(&t->spheres, i, s++);
    for (uint32_t i = 0; i < t->meshes.n; ++i) set_mesh(&t->meshes, i, s++);
    for (uint32_t i = 0; i < t->points.n; ++i) set_point(&t->points, i, s++);
    *out = t;
    return SHEEN_OK;
}
