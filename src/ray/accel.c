// SPDX-License-Identifier: Apache-2.0
#include "ray/accel.h"

#include "ray/holes.h"
#include "ray/quadric.h"

#include <stdio.h>
#include <stdlib.h>

struct SheenAccel {
    RTCDevice device;
    RTCScene world;
    RTCScene *groups; // [n_groups]; groups[0] is NULL, the world is `world`
    uint32_t n_groups;
    uint32_t n_shapes;   // Embree's geometry number of instance i is n_shapes + i
    TracedShape *shapes; // [n_shapes] user data of the geometries
    bool pierced;        // some of them lets light pass
};

// Only meshes that need filters have them: the others cost nothing.
static RTCGeometry mesh_geometry(RTCDevice device, TracedShape *shape)
{
    const SheenMesh *mesh = &shape->shape->mesh;
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (!g) return NULL;
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh->p, 0, sizeof(Vec3),
                               mesh->n_vertices);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->triangles, 0, 3 * sizeof(uint32_t),
                               mesh->n_triangles);
    rtcSetGeometryUserData(g, shape);
    if (shape->pierced) sheen_holes_filter(g);
    rtcCommitGeometry(g);
    return g;
}

static void attach(RTCScene rtc, RTCGeometry g, uint32_t id)
{
    rtcAttachGeometryByID(rtc, g, id);
    rtcReleaseGeometry(g);
}

// Without spatial splits, which RTC_BUILD_QUALITY_HIGH would make: a primitive is then in one leaf, and its filter is
// called once for a ray.
static RTCScene group_create(const SheenAccel *a, const SheenGroup *group)
{
    RTCScene rtc = rtcNewScene(a->device);
    if (!rtc) return NULL;
    rtcSetSceneFlags(rtc, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(rtc, RTC_BUILD_QUALITY_MEDIUM);
    for (uint32_t i = group->first_shape; i < group->first_shape + group->n_shapes; ++i) {
        TracedShape *shape = &a->shapes[i];
        RTCGeometry g = shape->shape->kind == SHEEN_SHAPE_MESH ? mesh_geometry(a->device, shape)
                                                               : sheen_quadric_geometry(a->device, shape);
        if (g) attach(rtc, g, i);
    }
    return rtc;
}

static void attach_instance(SheenAccel *a, const SheenInstance *instance, uint32_t id)
{
    RTCGeometry g = rtcNewGeometry(a->device, RTC_GEOMETRY_TYPE_INSTANCE);
    if (!g) return;
    float m[12]; // column-major 3 x 4
    for (int col = 0; col < 4; ++col)
        for (int row = 0; row < 3; ++row) m[3 * col + row] = (float)instance->to_world.m[row][col];
    rtcSetGeometryInstancedScene(g, a->groups[instance->group]);
    rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, m);
    rtcCommitGeometry(g);
    attach(a->world, g, id);
}

SheenStatus sheen_accel_create(const SheenScene *scene, SheenPool *pool, const SheenLog *log, SheenAccel **out)
{
    *out = NULL;
    SheenAccel *a = calloc(1, sizeof *a);
    if (!a) return SHEEN_ERR_NOMEM;
    char config[64];
    snprintf(config, sizeof config, "threads=%u,set_affinity=0", sheen_pool_size(pool));
    a->device = rtcNewDevice(config);
    a->groups = calloc(scene->n_groups, sizeof(RTCScene));
    a->shapes = calloc((size_t)scene->n_shapes + 1, sizeof *a->shapes);
    if (!a->device || !a->groups || !a->shapes) {
        sheen_accel_destroy(&a);
        return sheen_fail(log, SHEEN_ERR_NOMEM, "%s: the ray tracing library does not start", scene->name);
    }
    a->n_groups = scene->n_groups;
    a->n_shapes = scene->n_shapes;
    for (uint32_t i = 0; i < scene->n_shapes; ++i) {
        a->shapes[i] = sheen_traced_shape(scene, &scene->shapes[i]);
        a->pierced = a->pierced || a->shapes[i].pierced;
    }
    for (uint32_t i = 1; i < scene->n_groups; ++i) {
        a->groups[i] = group_create(a, &scene->groups[i]);
        if (a->groups[i]) rtcCommitScene(a->groups[i]);
    }
    a->world = group_create(a, &scene->groups[0]);
    if (a->world) {
        for (uint32_t i = 0; i < scene->n_instances; ++i) attach_instance(a, &scene->instances[i], scene->n_shapes + i);
        rtcCommitScene(a->world);
    }
    if (rtcGetDeviceError(a->device) != RTC_ERROR_NONE) {
        sheen_accel_destroy(&a);
        return sheen_fail(log, SHEEN_ERR_NOMEM, "%s: the acceleration structure cannot be built", scene->name);
    }
    *out = a;
    return SHEEN_OK;
}

void sheen_accel_destroy(SheenAccel **accel)
{
    SheenAccel *a = accel ? *accel : NULL;
    if (!a) return;
    if (a->world) rtcReleaseScene(a->world);
    for (uint32_t i = 0; i < a->n_groups; ++i)
        if (a->groups[i]) rtcReleaseScene(a->groups[i]);
    if (a->device) rtcReleaseDevice(a->device);
    free(a->groups);
    free(a->shapes);
    free(a);
    *accel = NULL;
}

static Hit hit_of(const SheenAccel *a, float t, float u, float v, uint32_t geometry, uint32_t primitive,
                  uint32_t instance)
{
    if (geometry == RTC_INVALID_GEOMETRY_ID) return (Hit){.shape = SHEEN_NONE, .instance = SHEEN_NONE};
    return (Hit){t,        u,         v,
                 geometry, primitive, instance == RTC_INVALID_GEOMETRY_ID ? SHEEN_NONE : instance - a->n_shapes};
}

static struct RTCRay single_ray(const Ray *ray)
{
    return (struct RTCRay){.org_x = ray->o.x,
                           .org_y = ray->o.y,
                           .org_z = ray->o.z,
                           .dir_x = ray->d.x,
                           .dir_y = ray->d.y,
                           .dir_z = ray->d.z,
                           .tnear = 0.0f,
                           .tfar = ray->t_max,
                           .mask = ~0u};
}

void sheen_accel_intersect(const SheenAccel *a, const Ray *ray, Hit *hit)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    struct RTCRayHit rh = {.ray = single_ray(ray)};
    rh.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rh.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(a->world, &context, &rh);
    *hit = hit_of(a, rh.ray.tfar, rh.hit.u, rh.hit.v, rh.hit.geomID, rh.hit.primID, rh.hit.instID[0]);
}

float sheen_accel_transmittance(const SheenAccel *a, const Ray *ray)
{
    Shadow shadow;
    shadow.absorbed = shadow.n = 0;
    ShadowContext context = {.shadows = &shadow};
    rtcInitIntersectContext(&context.rtc);
    struct RTCRay r = single_ray(ray);
    rtcOccluded1(a->world, &context.rtc, &r);
    return r.tfar < 0.0f ? 0.0f : sheen_shadow_transmittance(&shadow);
}

enum { PACKET = 16 };

static struct RTCIntersectContext batch_context(SheenCoherence coherence)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags =
        coherence == SHEEN_COHERENT ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}

// What all packets have in common; Embree leaves it as it is.
static void init_packet(struct RTCRay16 *p)
{
    for (int i = 0; i < PACKET; ++i) {
        p->tnear[i] = 0.0f;
        p->mask[i] = ~0u;
        p->time[i] = 0.0f;
        p->flags[i] = 0;
        p->id[i] = (unsigned)i; // of its shadow
    }
}

// Fills lane i of a packet.
static void fill_lane(struct RTCRay16 *p, int i, const Ray *r)
{
    p->org_x[i] = r->o.x;
    p->org_y[i] = r->o.y;
    p->org_z[i] = r->o.z;
    p->dir_x[i] = r->d.x;
    p->dir_y[i] = r->d.y;
    p->dir_z[i] = r->d.z;
    p->tfar[i] = r->t_max;
}

// Fills a packet from the front of n rays and returns how many it took. Skipped rays are invalid, and so are lanes
// beyond the last ray, which repeat it so that none is uninitialised.
static int fill_packet(struct RTCRay16 *p, int valid[PACKET], size_t n, const Ray rays[])
{
    int count = n < PACKET ? (int)n : PACKET;
    for (int i = 0; i < count; ++i) fill_lane(p, i, &rays[i]);
    for (int i = count; i < PACKET; ++i) fill_lane(p, i, &rays[count - 1]);
    for (int i = 0; i < PACKET; ++i) valid[i] = p->tfar[i] >= 0.0f ? -1 : 0;
    for (int i = count; i < PACKET; ++i) valid[i] = 0;
    return count;
}

void sheen_accel_intersect_many(const SheenAccel *a, SheenCoherence coherence, size_t n, const Ray rays[], Hit hits[])
{
    struct RTCIntersectContext context = batch_context(coherence);
    _Alignas(64) struct RTCRayHit16 p;
    _Alignas(64) int valid[PACKET];
    init_packet(&p.ray);
    for (size_t first = 0; first < n; first += PACKET) {
        int count = fill_packet(&p.ray, valid, n - first, rays + first);
        for (int i = 0; i < PACKET; ++i) {
            p.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
            p.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        }
        rtcIntersect16(valid, a->world, &context, &p);
        for (int i = 0; i < count; ++i)
            hits[first + (size_t)i] =
                hit_of(a, p.ray.tfar[i], p.hit.u[i], p.hit.v[i], p.hit.geomID[i], p.hit.primID[i], p.hit.instID[0][i]);
    }
}

void sheen_accel_transmittance_many(const SheenAccel *a, size_t n, const Ray rays[], float transmittance[])
{
    Shadow shadows[PACKET];
    ShadowContext context = {batch_context(SHEEN_INCOHERENT), shadows};
    _Alignas(64) struct RTCRay16 p;
    _Alignas(64) int valid[PACKET];
    init_packet(&p);
    for (size_t first = 0; first < n; first += PACKET) {
        int count = fill_packet(&p, valid, n - first, rays + first);
        for (int i = 0; a->pierced && i < count; ++i) shadows[i].absorbed = shadows[i].n = 0;
        rtcOccluded16(valid, a->world, &context.rtc, &p);
        // Embree marks an occluded ray by tfar = -inf; a skipped one has had a negative tfar from the start.
        for (int i = 0; i < count; ++i) {
            float through = a->pierced ? sheen_shadow_transmittance(&shadows[i]) : 1.0f;
            transmittance[first + (size_t)i] = p.tfar[i] < 0.0f ? 0.0f : through;
        }
    }
}
