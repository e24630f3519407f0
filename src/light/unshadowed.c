// SPDX-License-Identifier: Apache-2.0
#include "light/unshadowed.h"

// ---- estimates --------------------------------------------------------------------------------------------------

// GCC vectorizes these loops only if it does not inline them, and if what they load does not depend on a condition.
#define VECTOR_LOOP __attribute__((noinline)) static void

// A whole number of vectors: what is left over would run one by one.
static inline uint32_t whole_vectors(uint32_t count)
{
    return (count + ESTIMATE_PADDING - 1) & ~(ESTIMATE_PADDING - 1);
}

// Mean cosine to the horizon over a sphere whose centre has cosine c and whose radius over distance is s, the part
// below the horizon counting as zero: exact where all is above or all below, a parabola between. It is positive as soon
// as the sphere's rim is above, which makes every estimate built on it conservative.
static inline float horizon(float c, float s)
{
    float t = maxf(c + s, 0.0f);
    float across = t * t / (4.0f * s);
    return c >= s ? c : across;
}

// theta / (2 pi sin theta) for x = cos theta: the arc cosine is the square root of 1 - x times a smooth function, here
// a polynomial with a relative error of 0.003 for x > -0.9 and 0.07 beyond.
static inline float edge_factor(float x)
{
    float smooth = 0.25034262f + x * (-0.0311225f + x * (0.00938617f + x * (-0.01856491f + x * 0.01567876f)));
    return smooth / sqrtf(maxf(1.0f + x, 1e-6f));
}

// The irradiance of a uniform polygon on a surface that faces it is pi L times the length of the vector form factor, a
// sum over its edges (Lambert's formula). A surface that is turned away sees it as it would the sphere with the same
// form factor. Where the edges would cancel to nothing in float, the polygon is a point. The share by the highest
// vertex keeps the estimate above zero wherever a part of the polygon is above the horizon.
static inline float weigh_polygon(const Polygons *g, uint32_t i, Vec3 p, Vec3 n)
{
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
    float seen = horizon(c, sqrtf(maxf(factor, 0.0f)) + 1e-20f) + 0.02f * maxf(top, 0.0f);
    float is_seen = (front > 0.0f ? 1.0f : 0.0f) * (top > 0.0f ? 1.0f : 0.0f);
    return SHEEN_PI * g->power[i] * factor * seen * is_seen;
}

VECTOR_LOOP weigh_polygon_vectors(const Polygons *g, uint32_t first, uint32_t count, Vec3 p, Vec3 n, float *restrict w)
{
    uint32_t end = first + whole_vectors(count);
    for (uint32_t i = first; i < end; ++i) w[i - first] = weigh_polygon(g, i, p, n);
}

static bool is_in_front(const Polygons *g, uint32_t i, Vec3 p)
{
    return (p.x - g->x[0][i]) * g->nx[i] + (p.y - g->y[0][i]) * g->ny[i] + (p.z - g->z[0][i]) * g->nz[i] > 0.0f;
}

// A single one needs no vectors, and nothing at all where it is seen from behind.
static void weigh_polygons(const Polygons *g, uint32_t first, uint32_t count, Vec3 p, Vec3 n, float *restrict w)
{
    if (count > 1)
        weigh_polygon_vectors(g, first, count, p, n, w);
    else
        w[0] = is_in_front(g, first, p) ? weigh_polygon(g, first, p, n) : 0.0f;
}

VECTOR_LOOP weigh_spheres(const Spheres *g, uint32_t first, uint32_t count, Vec3 p, Vec3 n, float *restrict w)
{
    uint32_t end = first + whole_vectors(count);
    for (uint32_t i = first; i < end; ++i) {
        Vec3 d = v3_sub(v3(g->x[i], g->y[i], g->z[i]), p);
        float d2 = maxf(v3_length2(d), 1e-30f), size = minf(g->r2[i] / d2, 1.0f);
        float seen = size * horizon(v3_dot(d, n) / sqrtf(d2), sqrtf(size) + 1e-20f);
        float is_outside = d2 > g->r2[i] ? 1.0f : 0.0f;
        w[i - first] = SHEEN_PI * (is_outside * seen * g->outside[i] + (1.0f - is_outside) * g->inside[i]);
    }
}

// Power over squared distance, with both cosines bounded over the body's sphere and its cone of normals.
// Source: estevez2018-many-lights.
void sheen_bodies_weigh(const Bodies *g, uint32_t first, uint32_t count, Vec3 p, Vec3 n, float *restrict w)
{
    uint32_t end = first + whole_vectors(count);
    for (uint32_t i = first; i < end; ++i) {
        Vec3 d = v3_sub(v3(g->x[i], g->y[i], g->z[i]), p);
        float to_center = maxf(v3_length2(d), 1e-30f), d2 = maxf(to_center, g->r2[i]);
        float inverse = 1.0f / sqrtf(to_center), size = sqrtf(g->r2[i] / d2) + 1e-20f;
        // Cosine of the angle to the axis less the cone's; 1 inside the cone.
        float c = -(d.x * g->nx[i] + d.y * g->ny[i] + d.z * g->nz[i]) * inverse;
        float turned = c * g->cos_cone[i] + sqrtf(maxf(1.0f - c * c, 0.0f)) * g->sin_cone[i];
        float cos_l = c >= g->cos_cone[i] ? 1.0f : turned;
        float cos_s = v3_dot(d, n) * inverse;
        w[i - first] = g->power[i] / d2 * horizon(cos_l, size) * horizon(cos_s, size);
    }
}

VECTOR_LOOP weigh_points(const Points *g, uint32_t first, uint32_t count, Vec3 p, Vec3 n, float *restrict w)
{
    uint32_t end = first + whole_vectors(count);
    for (uint32_t i = first; i < end; ++i) {
        Vec3 d = v3_sub(v3(g->x[i], g->y[i], g->z[i]), p);
        float d2 = maxf(v3_length2(d), 1e-20f);
        w[i - first] = g->intensity[i] * maxf(v3_dot(d, n), 0.0f) / (d2 * sqrtf(d2));
    }
}

static float weigh_spot(const SheenLight *l, Vec3 p, Vec3 n)
{
    Vec3 d = v3_sub(l->position, p);
    float d2 = maxf(v3_length2(d), 1e-20f), inverse = 1.0f / sqrtf(d2);
    float cosine = maxf(v3_dot(d, n) * inverse, 0.0f);
    if (cosine == 0.0f) return 0.0f;
    return rgb_mean(sheen_spot_intensity(l, v3_scale(d, -inverse))) * cosine / d2;
}

// Light from one direction reaches a surface by its cosine, even light by a quarter of the flux; an environment is
// taken for a mixture of both, by how much its directions cancel. A little is left for surfaces that face away.
static float weigh_environment(const EnvironmentSampler *e, Vec3 n)
{
    float even = e->flux - v3_length(e->flux_vector);
    return 0.25f * maxf(even, 0.1f * e->flux) + maxf(v3_dot(e->flux_vector, n), 0.0f);
}

// By the cosine, and never zero where a part of the disk is above the horizon.
static float weigh_sun(const Source *s, Vec3 n)
{
    return rgb_mean(s->light->radiance) * horizon(-v3_dot(s->light->direction, n), sqrtf(s->sun.sin2));
}

static void weigh_rest(const Source sources[], uint32_t first, uint32_t count, Vec3 p, Vec3 n, float *restrict w)
{
    for (uint32_t i = 0; i < count; ++i) {
        const Source *s = &sources[first + i];
        if (s->kind == SOURCE_SPOT)
            w[i] = weigh_spot(s->light, p, n);
        else if (s->kind == SOURCE_ENVIRONMENT)
            w[i] = weigh_environment(&s->environment, n);
        else if (s->kind == SOURCE_SUN)
            w[i] = weigh_sun(s, n);
        else
            w[i] = s->brightness * maxf(-v3_dot(s->light->direction, n), 0.0f);
    }
}

// A kind's overrun is overwritten by the kind after it.
void sheen_estimate_table_weigh(const EstimateTable *t, uint32_t first, uint32_t count, Vec3 p, Vec3 n,
                                float *restrict w)
{
    uint32_t start = 0, last = first + count;
    for (int k = 0; k < 5; start = t->end[k++]) {
        uint32_t lo = first > start ? first : start, hi = last < t->end[k] ? last : t->end[k];
        if (lo >= hi) continue;
        float *at = w + (lo - first);
        uint32_t i = lo - start;
        if (k == 0)
            weigh_polygons(&t->polygons, i, hi - lo, p, n, at);
        else if (k == 1)
            weigh_spheres(&t->spheres, i, hi - lo, p, n, at);
        else if (k == 2)
            sheen_bodies_weigh(&t->meshes, i, hi - lo, p, n, at);
        else if (k == 3)
            weigh_points(&t->points, i, hi - lo, p, n, at);
        else
            weigh_rest(t->sources, lo, hi - lo, p, n, at);
    }
}

// ---- tables -----------------------------------------------------------------------------------------------------

static bool allocate(SheenArena *arena, uint32_t n, float **arrays[], size_t n_arrays)
{
    for (size_t k = 0; k < n_arrays; ++k) {
        *arrays[k] = SHEEN_ARENA_NEW(arena, float, (size_t)n + ESTIMATE_PADDING);
        if (!*arrays[k]) return false;
    }
    return true;
}
#define ALLOCATE(arena, n, ...)                                                                                        \
    allocate(arena, n, (float **[]){__VA_ARGS__}, sizeof((float **[]){__VA_ARGS__}) / sizeof(float **))

bool sheen_bodies_init(uint32_t n, SheenArena *arena, Bodies *b)
{
    return ALLOCATE(arena, n, &b->x, &b->y, &b->z, &b->r2, &b->nx, &b->ny, &b->nz, &b->cos_cone, &b->sin_cone,
                    &b->power);
}

static bool polygons_init(uint32_t n, SheenArena *arena, Polygons *g)
{
    for (int k = 0; k < 4; ++k)
        if (!ALLOCATE(arena, n, &g->x[k], &g->y[k], &g->z[k])) return false;
    return ALLOCATE(arena, n, &g->nx, &g->ny, &g->nz, &g->area, &g->power);
}

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
        v[0] = r->corner;
        v[1] = v3_add(r->corner, r->ex);
        v[2] = v3_add(v[1], r->ey);
        v[3] = v3_add(r->corner, r->ey);
        n = r->n;
        area = r->lx * r->ly;
    }
    for (int k = 0; k < 4; ++k) g->x[k][i] = v[k].x, g->y[k][i] = v[k].y, g->z[k][i] = v[k].z;
    g->nx[i] = n.x, g->ny[i] = n.y, g->nz[i] = n.z;
    g->area[i] = (float)area;
    g->power[i] = s->brightness * (float)(s->area / area);
}

static void set_sphere(Spheres *g, uint32_t i, const Source *s)
{
    const SheenSphere *sphere = &s->shape->sphere;
    float l = s->brightness;
    g->x[i] = sphere->center.x, g->y[i] = sphere->center.y, g->z[i] = sphere->center.z;
    g->r2[i] = sqrf(sphere->radius);
    g->outside[i] = sphere->flip ? 0.0f : l;
    g->inside[i] = sphere->flip ? l : 0.0f;
}

static void set_mesh(Bodies *g, uint32_t i, const Source *s)
{
    g->x[i] = s->center.x, g->y[i] = s->center.y, g->z[i] = s->center.z;
    g->r2[i] = sqrf(s->radius);
    g->nx[i] = s->axis.x, g->ny[i] = s->axis.y, g->nz[i] = s->axis.z;
    g->cos_cone[i] = s->cos_cone;
    g->sin_cone[i] = safe_sqrtf(1.0f - s->cos_cone * s->cos_cone);
    g->power[i] = s->power;
}

static void set_point(Points *g, uint32_t i, const Source *s)
{
    Vec3 p = s->light->position;
    g->x[i] = p.x, g->y[i] = p.y, g->z[i] = p.z;
    g->intensity[i] = s->brightness;
}

static int table_of_kind(SourceKind kind)
{
    if (kind <= SOURCE_DISK) return 0;
    if (kind == SOURCE_SPHERE) return 1;
    if (kind == SOURCE_MESH) return 2;
    return kind == SOURCE_POINT ? 3 : 4;
}

bool sheen_estimate_table_init(const Source sources[], uint32_t n, SheenArena *arena, EstimateTable *t)
{
    *t = (EstimateTable){.sources = sources};
    uint32_t count[5] = {0};
    for (uint32_t i = 0; i < n; ++i) ++count[table_of_kind(sources[i].kind)];
    for (uint32_t k = 0, sum = 0; k < 5; ++k) t->end[k] = sum += count[k];
    Spheres *s = &t->spheres;
    Points *p = &t->points;
    if (!polygons_init(count[0], arena, &t->polygons) ||
        !ALLOCATE(arena, count[1], &s->x, &s->y, &s->z, &s->r2, &s->outside, &s->inside) ||
        !sheen_bodies_init(count[2], arena, &t->meshes) ||
        !ALLOCATE(arena, count[3], &p->x, &p->y, &p->z, &p->intensity))
        return false;
    const Source *at = sources;
    for (uint32_t i = 0; i < count[0]; ++i) set_polygon(&t->polygons, i, at++);
    for (uint32_t i = 0; i < count[1]; ++i) set_sphere(s, i, at++);
    for (uint32_t i = 0; i < count[2]; ++i) set_mesh(&t->meshes, i, at++);
    for (uint32_t i = 0; i < count[3]; ++i) set_point(p, i, at++);
    return true;
}
