// SPDX-License-Identifier: Apache-2.0
#include "ray/quadric.h"

// Intersections are computed in double: a float discriminant loses the edge of a small or distant sphere.
typedef struct RayD {
    double o[3], d[3];
    double t_near, t_far;
} RayD;

// Nearest root of the sphere's quadratic within the segment. Source: haines2019-precision, sec. 7.2.
static bool intersect_sphere(const SheenSphere *s, const RayD *r, double *t)
{
    double f[3] = {r->o[0] - s->center.x, r->o[1] - s->center.y, r->o[2] - s->center.z};
    double a = r->d[0] * r->d[0] + r->d[1] * r->d[1] + r->d[2] * r->d[2];
    double b = -(f[0] * r->d[0] + f[1] * r->d[1] + f[2] * r->d[2]);
    double radius = s->radius;
    double g[3] = {f[0] + b / a * r->d[0], f[1] + b / a * r->d[1], f[2] + b / a * r->d[2]};
    double disc = radius * radius - (g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    if (!(disc >= 0.0)) return false;
    double c = f[0] * f[0] + f[1] * f[1] + f[2] * f[2] - radius * radius;
    double q = b + copysign(sqrt(a * disc), b);
    double t0 = q != 0.0 ? c / q : 0.0, t1 = q / a;
    double lo = fmin(t0, t1), hi = fmax(t0, t1);
    *t = lo >= r->t_near ? lo : hi;
    return *t >= r->t_near && *t <= r->t_far;
}

static bool intersect_disk(const SheenDisk *k, const RayD *r, double *t)
{
    double nd = k->n.x * r->d[0] + k->n.y * r->d[1] + k->n.z * r->d[2];
    double f[3] = {k->center.x - r->o[0], k->center.y - r->o[1], k->center.z - r->o[2]};
    double nf = k->n.x * f[0] + k->n.y * f[1] + k->n.z * f[2];
    if (nd == 0.0) return false;
    *t = nf / nd;
    if (!(*t >= r->t_near && *t <= r->t_far)) return false;
    double q[3] = {*t * r->d[0] - f[0], *t * r->d[1] - f[1], *t * r->d[2] - f[2]};
    // Coordinates in the basis (du, dv), which need not be orthogonal: solve the 2 x 2 normal equations.
    double uu = v3_dot(k->du, k->du), uv = v3_dot(k->du, k->dv), vv = v3_dot(k->dv, k->dv);
    double qu = q[0] * k->du.x + q[1] * k->du.y + q[2] * k->du.z;
    double qv = q[0] * k->dv.x + q[1] * k->dv.y + q[2] * k->dv.z;
    double det = uu * vv - uv * uv;
    double x = (qu * vv - qv * uv) / det, y = (qv * uu - qu * uv) / det;
    return x * x + y * y <= 1.0;
}

static bool intersect_shape(const SheenShape *shape, const RayD *r, double *t)
{
    return shape->kind == SHEEN_SHAPE_SPHERE ? intersect_sphere(&shape->sphere, r, t)
                                             : intersect_disk(&shape->disk, r, t);
}

static RayD ray_of_packet(void *packet, unsigned n, unsigned i)
{
    Vec3 o = packet_origin(packet, n, i), d = packet_direction(packet, n, i);
    return (RayD){
        {o.x, o.y, o.z}, {d.x, d.y, d.z}, packet_field(packet, n, T_NEAR, i)->f, packet_field(packet, n, T_FAR, i)->f};
}

static PiercedHit pierced_hit(const RayD *r, double t, unsigned geometry, unsigned instance)
{
    Vec3 d = v3((float)r->d[0], (float)r->d[1], (float)r->d[2]);
    Vec3 p = v3_mad(v3((float)r->o[0], (float)r->o[1], (float)r->o[2]), (float)t, d);
    return (PiercedHit){.p = p, .d = d, .t = (float)t, .geometry = geometry, .instance = instance};
}

static void quadric_intersect(const struct RTCIntersectFunctionNArguments *args)
{
    unsigned n = args->N;
    void *packet = args->rayhit;
    const TracedShape *traced = args->geometryUserPtr;
    for (unsigned i = 0; i < n; ++i) {
        if (!args->valid[i]) continue;
        RayD r = ray_of_packet(packet, n, i);
        double t;
        bool found = intersect_shape(traced->shape, &r, &t);
        while (found && traced->pierced) { // past holes, to the sphere's other side
            PiercedHit hit = pierced_hit(&r, t, args->geomID, args->context->instID[0]);
            if (!sheen_hole_at(traced, &hit)) break;
            r.t_near = nextafter(t, INFINITY);
            found = intersect_shape(traced->shape, &r, &t);
        }
        if (!found) continue;
        packet_field(packet, n, T_FAR, i)->f = (float)t;
        packet_field(packet, n, HIT_U, i)->f = 0.0f;
        packet_field(packet, n, HIT_V, i)->f = 0.0f;
        packet_field(packet, n, PRIMITIVE, i)->u = args->primID;
        packet_field(packet, n, GEOMETRY, i)->u = args->geomID;
        packet_field(packet, n, INSTANCE, i)->u = args->context->instID[0];
    }
}

static void quadric_occluded(const struct RTCOccludedFunctionNArguments *args)
{
    unsigned n = args->N;
    const TracedShape *traced = args->geometryUserPtr;
    for (unsigned i = 0; i < n; ++i) {
        if (!args->valid[i]) continue;
        RayD r = ray_of_packet(args->ray, n, i);
        double t;
        bool found = intersect_shape(traced->shape, &r, &t);
        while (found && traced->pierced) {
            PiercedHit hit = pierced_hit(&r, t, args->geomID, args->context->instID[0]);
            ShadowContext *context = (ShadowContext *)args->context;
            if (sheen_shadow_meet(traced, &hit, &context->shadows[packet_field(args->ray, n, ID, i)->u])) break;
            r.t_near = nextafter(t, INFINITY);
            found = intersect_shape(traced->shape, &r, &t);
        }
        if (found) packet_field(args->ray, n, T_FAR, i)->f = -INFINITY;
    }
}

static void quadric_bounds(const struct RTCBoundsFunctionArguments *args)
{
    const TracedShape *traced = args->geometryUserPtr;
    const SheenShape *shape = traced->shape;
    Vec3 c, h;
    if (shape->kind == SHEEN_SHAPE_SPHERE) {
        c = shape->sphere.center;
        h = v3(shape->sphere.radius, shape->sphere.radius, shape->sphere.radius);
    } else {
        const SheenDisk *k = &shape->disk;
        c = k->center;
        h = v3(hypotf(k->du.x, k->dv.x), hypotf(k->du.y, k->dv.y), hypotf(k->du.z, k->dv.z));
    }
    // One part in a million more, so that rounding leaves nothing outside.
    float pad = 1e-6f * (v3_length(c) + v3_length(h));
    *args->bounds_o = (struct RTCBounds){.lower_x = c.x - h.x - pad,
                                         .lower_y = c.y - h.y - pad,
                                         .lower_z = c.z - h.z - pad,
                                         .upper_x = c.x + h.x + pad,
                                         .upper_y = c.y + h.y + pad,
                                         .upper_z = c.z + h.z + pad};
}

RTCGeometry sheen_quadric_geometry(RTCDevice device, TracedShape *shape)
{
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    if (!g) return NULL;
    rtcSetGeometryUserPrimitiveCount(g, 1);
    rtcSetGeometryUserData(g, shape);
    rtcSetGeometryBoundsFunction(g, quadric_bounds, NULL);
    rtcSetGeometryIntersectFunction(g, quadric_intersect);
    rtcSetGeometryOccludedFunction(g, quadric_occluded);
    rtcCommitGeometry(g);
    return g;
}
