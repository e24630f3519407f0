// SPDX-License-Identifier: Apache-2.0
#include "light/source.h"

#include "light/emission.h"
#include "math/warp.h"

// How far a quadrilateral may be from a rectangle, as a share of its edges.
#define RECTANGLE_TOLERANCE 1e-4f

// Looks from p at the point that was chosen. @return the cosine at the light, above 0 in front of it
static inline float look(Vec3 p, SourcePoint *out)
{
    Vec3 d = v3_sub(out->q, p);
    out->distance = v3_length(d);
    out->wi = v3_scale(d, 1.0f / out->distance);
    return -v3_dot(out->wi, out->n);
}

// ---- meshes -----------------------------------------------------------------------------------------------------

static void triangle_vertices(const SheenMesh *mesh, uint32_t i, Vec3 v[3])
{
    for (int k = 0; k < 3; ++k) v[k] = mesh->p[mesh->triangles[i][k]];
}

static bool same(Vec3 a, Vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

// The vertex of triangle a that triangle b does not share, when b has the two others; else 3.
static int lone_vertex(const Vec3 a[3], const Vec3 b[3])
{
    int lone = 3, n_lone = 0;
    for (int i = 0; i < 3; ++i) {
        if (same(a[i], b[0]) || same(a[i], b[1]) || same(a[i], b[2])) continue;
        lone = i;
        ++n_lone;
    }
    return n_lone == 1 ? lone : 3;
}

static bool mesh_is_rectangle(const SheenMesh *mesh, SheenRectangle *out)
{
    if (mesh->n_triangles != 2) return false;
    Vec3 a[3], b[3];
    triangle_vertices(mesh, 0, a);
    triangle_vertices(mesh, 1, b);
    int i = lone_vertex(a, b), j = lone_vertex(b, a);
    if (i == 3 || j == 3) return false;
    Vec3 ex = v3_sub(a[(i + 1) % 3], a[i]), ey = v3_sub(a[(i + 2) % 3], a[i]);
    float lx = v3_length(ex), ly = v3_length(ey);
    Vec3 gap = v3_sub(v3_sub(v3_sub(b[j], a[i]), ex), ey);
    if (!(v3_length(gap) <= RECTANGLE_TOLERANCE * minf(lx, ly))) return false;
    if (!(fabsf(v3_dot(ex, ey)) <= RECTANGLE_TOLERANCE * lx * ly)) return false;
    Vec3 n_b = v3_cross(v3_sub(b[1], b[0]), v3_sub(b[2], b[0]));
    if (!(v3_dot(v3_cross(ex, ey), n_b) > 0.0f)) return false; // the second triangle faces the other way
    *out = sheen_rectangle_make(a[i], ex, ey);
    return true;
}

static Vec3 triangle_normal(const SheenMesh *mesh, uint32_t i)
{
    Vec3 v[3];
    triangle_vertices(mesh, i, v);
    return v3_normalize(v3_cross(v3_sub(v[1], v[0]), v3_sub(v[2], v[0])));
}

// The sphere about a mesh and the cone of its normals, widened against rounding.
static void mesh_bounds(Source *s)
{
    const SheenMesh *mesh = &s->shape->mesh;
    Bounds box = bounds_empty();
    D3 sum = d3(0, 0, 0); // of normals, by share of the area
    for (uint32_t i = 0; i < mesh->n_triangles; ++i) {
        for (int k = 0; k < 3; ++k) box = bounds_add(box, mesh->p[mesh->triangles[i][k]]);
        double share = s->triangle_cdf[i + 1] - s->triangle_cdf[i];
        sum = d3_mad(sum, share, d3_sub(triangle_normal(mesh, i), v3(0, 0, 0)));
    }
    s->center = bounds_center(&box);
    s->radius = bounds_radius(&box) * 1.0001f;
    s->axis = v3_normalize(v3((float)sum.x, (float)sum.y, (float)sum.z));
    float flat = minf((float)d3_length(sum), 1.0f); // 1 for a flat mesh, 0 for a closed one
    s->cos_cone = flat > 1e-3f ? 1.0f : -1.0f;
    for (uint32_t i = 0; i < mesh->n_triangles; ++i)
        s->cos_cone = minf(s->cos_cone, v3_dot(s->axis, triangle_normal(mesh, i)));
    s->cos_cone = maxf(s->cos_cone - 1e-4f, -1.0f);
    // From its axis a flat light shows all its area, a convex closed one from anywhere a quarter on average.
    s->power = s->brightness * (float)s->area * lerpf(0.25f, 1.0f, flat);
}

static SheenStatus mesh_init(Source *s, SheenArena *arena)
{
    const SheenMesh *mesh = &s->shape->mesh;
    double *cdf = SHEEN_ARENA_NEW(arena, double, (size_t)mesh->n_triangles + 1);
    if (!cdf) return SHEEN_ERR_NOMEM;
    for (uint32_t i = 0; i < mesh->n_triangles; ++i) {
        Vec3 v[3];
        triangle_vertices(mesh, i, v);
        D3 n = d3_cross(d3_sub(v[1], v[0]), d3_sub(v[2], v[0]));
        cdf[i + 1] = cdf[i] + 0.5 * d3_length(n);
    }
    s->triangle_cdf = cdf;
    s->area = cdf[mesh->n_triangles];
    if (s->area > 0.0)
        for (uint32_t i = 1; i <= mesh->n_triangles; ++i) cdf[i] /= s->area;
    s->kind = mesh->n_triangles == 1 ? SOURCE_TRIANGLE : SOURCE_MESH;
    if (mesh_is_rectangle(mesh, &s->rectangle)) s->kind = SOURCE_RECTANGLE;
    mesh_bounds(s);
    return SHEEN_OK;
}

static uint32_t choose_triangle(const Source *s, float *u)
{
    uint32_t lo = 0, hi = s->shape->mesh.n_triangles;
    double x = (double)*u;
    while (hi - lo > 1) {
        uint32_t mid = lo + (hi - lo) / 2;
        if (s->triangle_cdf[mid] <= x)
            lo = mid;
        else
            hi = mid;
    }
    double width = s->triangle_cdf[lo + 1] - s->triangle_cdf[lo];
    *u = minf((float)((x - s->triangle_cdf[lo]) / width), 0x1.fffffep-1f);
    return lo;
}

static bool mesh_sample(const Source *s, Vec3 p, Vec2 u, SourcePoint *out)
{
    uint32_t i = choose_triangle(s, &u.x);
    Vec3 v[3];
    triangle_vertices(&s->shape->mesh, i, v);
    Vec2 b;
    float pdf;
    if (!sheen_triangle_sample(v, p, u, &b, &pdf)) return false;
    Vec3 e1 = v3_sub(v[1], v[0]), e2 = v3_sub(v[2], v[0]);
    out->q = v3_mad(v3_mad(v[0], b.x, e1), b.y, e2);
    out->n = v3_normalize(v3_cross(e1, e2));
    out->triangle = i;
    out->solid_angle = 1.0f / (pdf * (float)(s->triangle_cdf[i + 1] - s->triangle_cdf[i]));
    return look(p, out) > 0.0f;
}

static float mesh_pdf(const Source *s, Vec3 p, Vec3 q, uint32_t triangle)
{
    Vec3 v[3];
    triangle_vertices(&s->shape->mesh, triangle, v);
    double share = s->triangle_cdf[triangle + 1] - s->triangle_cdf[triangle];
    return sheen_triangle_pdf(v, p, q) * (float)share;
}

// ---- rectangle and disk -----------------------------------------------------------------------------------------

// Inline in both callers: vectors that are passed by value go through memory, and wait for it.
// @param st  coordinates of the point, [0, 1]^2
static inline __attribute__((always_inline)) bool rectangle_point(const SheenRectangle *r, Vec3 p, Vec2 u, Vec2 *st,
                                                                  SourcePoint *out)
{
    bool far = sheen_rectangle_is_far(r, p);
    *st = u;
    if (v3_dot(v3_sub(p, r->center), r->n) <= 0.0f) return false;
    if (!far && !sheen_rectangle_sample(r, p, u, st, &out->solid_angle)) return false;
    out->q = v3_mad(v3_mad(r->corner, st->x, r->ex), st->y, r->ey);
    out->n = r->n;
    float cosine = look(p, out);
    if (far) out->solid_angle = r->area * cosine / sqrf(out->distance);
    return cosine > 0.0f;
}

static bool rectangle_sample(const Source *s, Vec3 p, Vec2 u, SourcePoint *out)
{
    Vec2 st;
    out->triangle = SHEEN_NONE;
    return rectangle_point(&s->rectangle, p, u, &st, out);
}

// Half the bounding rectangle's edges lie along du and across it.
static void disk_init(Source *s)
{
    const SheenDisk *disk = &s->shape->disk;
    Vec3 t = v3_normalize(disk->du), b = v3_cross(disk->n, t);
    float a = v3_length(disk->du), c = v3_dot(disk->dv, t), d = v3_dot(disk->dv, b);
    s->kind = SOURCE_DISK;
    s->center = disk->center;
    s->area = (double)SHEEN_PI * (double)a * (double)fabsf(d);
    if (!(s->area > 0.0)) return;
    float hx = sqrtf(a * a + c * c), hy = fabsf(d);
    Vec3 corner = v3_mad(v3_mad(disk->center, -hx, t), -hy, b);
    s->rectangle = sheen_rectangle_make(corner, v3_scale(t, 2.0f * hx), v3_scale(b, 2.0f * hy));
    s->radius = sqrtf(hx * hx + hy * hy);
    s->power = s->brightness * (float)s->area;
    s->unit_x = 1.0f / a;
    s->unit_y = 1.0f / d;
    s->skew = c / d;
}

// The solid angle of a disk has no simple sampler: a point of its bounding rectangle that misses it brings nothing,
// which costs about a fifth of the samples but leaves the estimate bounded, as an area sampler would not.
static bool disk_sample(const Source *s, Vec3 p, Vec2 u, SourcePoint *out)
{
    Vec2 st;
    if (!rectangle_point(&s->rectangle, p, u, &st, out)) return false;
    float x = (st.x - 0.5f) * (float)s->rectangle.lx, y = (st.y - 0.5f) * (float)s->rectangle.ly;
    return sqrf((x - s->skew * y) * s->unit_x) + sqrf(y * s->unit_y) <= 1.0f;
}

// ---- sphere -----------------------------------------------------------------------------------------------------

// The cone of directions to a sphere: 1 - cos of its half-angle, without cancellation for small spheres.
static float cone_height(float sin2, float *cos_max)
{
    *cos_max = safe_sqrtf(1.0f - sin2);
    return sin2 / (1.0f + *cos_max);
}

// From outside: uniform in the cone; the point is the near one where the direction meets the sphere, found by the
// angle at the centre so that it is exact for small and far spheres. From inside of a sphere that shines inward: any
// direction.
static bool sphere_sample(const Source *s, Vec3 p, Vec2 u, SourcePoint *out)
{
    const SheenSphere *sphere = &s->shape->sphere;
    Vec3 to_p = v3_sub(p, sphere->center);
    float d2 = v3_length2(to_p), r2 = sqrf(sphere->radius);
    if ((d2 > r2) == sphere->flip) return false;
    Vec3 n; // outward
    if (sphere->flip) {
        Vec3 w = warp_sphere(u);
        float b = v3_dot(to_p, w), t = -b + safe_sqrtf(b * b + r2 - d2);
        n = v3_normalize(v3_mad(to_p, t, w));
        out->solid_angle = 4.0f * SHEEN_PI;
    } else {
        float sin2_max = r2 / d2, cos_max, height = cone_height(sin2_max, &cos_max);
        float z = u.x * height, share = u.x * (2.0f - z) / (1.0f + cos_max); // share = sin^2 / sin^2_max
        float cos_a = share * sqrtf(sin2_max) + (1.0f - z) * safe_sqrtf(1.0f - share);
        float sin_a = safe_sqrtf(1.0f - cos_a * cos_a), phi = 2.0f * SHEEN_PI * u.y;
        Frame f = frame_from_normal(v3_scale(to_p, 1.0f / sqrtf(d2)));
        n = v3_normalize(frame_to_world(&f, v3(sin_a * cosf(phi), sin_a * sinf(phi), cos_a)));
        out->solid_angle = 2.0f * SHEEN_PI * height;
    }
    out->q = v3_mad(sphere->center, sphere->radius, n);
    out->n = sphere->flip ? v3_neg(n) : n;
    return look(p, out) > 0.0f;
}

static float sphere_pdf(const Source *s, Vec3 p)
{
    const SheenSphere *sphere = &s->shape->sphere;
    float d2 = v3_length2(v3_sub(p, sphere->center)), r2 = sqrf(sphere->radius);
    if ((d2 > r2) == sphere->flip) return 0.0f;
    float cos_max;
    return sphere->flip ? 0.25f * SHEEN_INV_PI : 0.5f * SHEEN_INV_PI / cone_height(r2 / d2, &cos_max);
}

static void sphere_init(Source *s)
{
    const SheenSphere *sphere = &s->shape->sphere;
    s->kind = SOURCE_SPHERE;
    s->center = sphere->center;
    s->radius = sphere->radius;
    s->area = 4.0 * (double)SHEEN_PI * (double)sqrf(sphere->radius);
    s->power = s->brightness * 0.25f * (float)s->area;
}

// ---- all --------------------------------------------------------------------------------------------------------

static SheenStatus area_init(const SheenScene *scene, SheenArena *arena, Source *s)
{
    s->shape = &scene->shapes[s->light->shape];
    switch (s->shape->kind) {
    case SHEEN_SHAPE_MESH:
        return mesh_init(s, arena);
    case SHEEN_SHAPE_SPHERE:
        sphere_init(s);
        break;
    case SHEEN_SHAPE_DISK:
        disk_init(s);
        break;
    }
    return SHEEN_OK;
}

SheenStatus sheen_source_init(const SheenScene *scene, const SheenLight *light, SheenEnvironmentSplit split,
                              SheenArena *arena, Source *out)
{
    *out = (Source){.light = light, .brightness = rgb_mean(light->radiance)};
    out->power = out->brightness;
    switch (light->kind) {
    case SHEEN_LIGHT_AREA:
        out->brightness = sheen_emission_mean(scene, light);
        return area_init(scene, arena, out);
    case SHEEN_LIGHT_POINT:
    case SHEEN_LIGHT_SPOT:
    case SHEEN_LIGHT_PROJECTOR:
        out->kind = light->kind == SHEEN_LIGHT_POINT ? SOURCE_POINT : SOURCE_SPOT;
        out->center = light->position;
        break;
    case SHEEN_LIGHT_DIRECTIONAL:
        out->kind = light->disk > 0.0f ? SOURCE_SUN : SOURCE_DIRECTIONAL;
        out->radius = INFINITY;
        if (out->kind == SOURCE_SUN) out->sun = sheen_sun_disk(light);
        break;
    case SHEEN_LIGHT_ENVIRONMENT:
        out->kind = SOURCE_ENVIRONMENT;
        out->radius = INFINITY;
        return sheen_environment_sampler_init(light, split, arena, &out->environment);
    case SHEEN_LIGHT_KINDS:
        break;
    }
    return SHEEN_OK;
}

bool sheen_source_sample_area(const Source *s, Vec3 p, Vec2 u, SourcePoint *out)
{
    switch (s->kind) {
    case SOURCE_RECTANGLE:
        return rectangle_sample(s, p, u, out);
    case SOURCE_DISK:
        return disk_sample(s, p, u, out);
    case SOURCE_SPHERE:
        return sphere_sample(s, p, u, out);
    default:
        return mesh_sample(s, p, u, out);
    }
}

float sheen_source_pdf_area(const Source *s, Vec3 p, Vec3 q, uint32_t triangle)
{
    switch (s->kind) {
    case SOURCE_RECTANGLE:
    case SOURCE_DISK:
        return sheen_rectangle_pdf(&s->rectangle, p, q);
    case SOURCE_SPHERE:
        return sphere_pdf(s, p);
    default:
        return mesh_pdf(s, p, q, triangle);
    }
}
