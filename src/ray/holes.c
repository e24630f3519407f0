// SPDX-License-Identifier: Apache-2.0
#include "ray/holes.h"

#include "ray/surface.h"
#include "scene/passage.h"

#define ABSORBED_UNIT 0x1p-40
// Less than 2^-32 of the light is none, so that a ray through thick foliage ends.
#define ABSORBED_ALL ((uint64_t)32 << 40)

TracedShape sheen_traced_shape(const SheenScene *scene, const SheenShape *shape)
{
    return (TracedShape){scene, shape, sheen_material_is_pierced(scene->materials, shape->material)};
}

static float passage_at(const TracedShape *s, const PiercedHit *hit)
{
    Vec2 uv = sheen_surface_uv(s->shape, hit->triangle, hit->u, hit->v, hit->p);
    bool front = v3_dot(sheen_surface_front(s->shape, hit->triangle, hit->p), hit->d) <= 0.0f;
    return sheen_material_passage(s->scene->materials, s->shape->material, uv, front);
}

bool sheen_hole_at(const TracedShape *s, const PiercedHit *hit)
{
    return s->shape->light == SHEEN_NONE && passage_at(s, hit) >= 1.0f;
}

static bool is_seen(const PiercedHit *hit, const Shadow *shadow)
{
    const float same = 1e-5f; // of the distance, far above the rounding of its two computations
    uint32_t n = shadow->n < SHADOW_SEEN ? shadow->n : SHADOW_SEEN;
    for (uint32_t i = 0; i < n; ++i)
        if (shadow->seen[i].geometry == hit->geometry && shadow->seen[i].instance == hit->instance &&
            fabsf(shadow->seen[i].t - hit->t) <= same * hit->t)
            return true;
    return false;
}

bool sheen_shadow_meet(const TracedShape *s, const PiercedHit *hit, Shadow *shadow)
{
    float passage = passage_at(s, hit);
    if (!(passage > 0.0f)) return true;
    if (passage >= 1.0f || is_seen(hit, shadow)) return false;
    uint32_t slot = shadow->n++ % SHADOW_SEEN;
    shadow->seen[slot].geometry = hit->geometry;
    shadow->seen[slot].instance = hit->instance;
    shadow->seen[slot].t = hit->t;
    shadow->absorbed += (uint64_t)(-log2((double)passage) / ABSORBED_UNIT + 0.5);
    return shadow->absorbed >= ABSORBED_ALL;
}

float sheen_shadow_transmittance(const Shadow *shadow)
{
    return shadow->absorbed == 0 ? 1.0f : (float)exp2(-(double)shadow->absorbed * ABSORBED_UNIT);
}

// ---- Embree's filters of meshes ---------------------------------------------------------------------------------

static PiercedHit hit_of_packet(const struct RTCFilterFunctionNArguments *args, unsigned i)
{
    unsigned n = args->N;
    return (PiercedHit){.d = packet_direction(args->ray, n, i),
                        .t = packet_field(args->ray, n, T_FAR, i)->f,
                        .u = packet_hit_field(args->hit, n, HIT_U, i)->f,
                        .v = packet_hit_field(args->hit, n, HIT_V, i)->f,
                        .triangle = packet_hit_field(args->hit, n, PRIMITIVE, i)->u,
                        .geometry = packet_hit_field(args->hit, n, GEOMETRY, i)->u,
                        .instance = packet_hit_field(args->hit, n, INSTANCE, i)->u};
}

static void filter_intersection(const struct RTCFilterFunctionNArguments *args)
{
    for (unsigned i = 0; i < args->N; ++i) {
        if (!args->valid[i]) continue;
        PiercedHit hit = hit_of_packet(args, i);
        if (sheen_hole_at(args->geometryUserPtr, &hit)) args->valid[i] = 0;
    }
}

// All shadow rays have a ShadowContext. Rays keep their ids when Embree traces a packet in parts.
static void filter_occlusion(const struct RTCFilterFunctionNArguments *args)
{
    ShadowContext *context = (ShadowContext *)args->context;
    for (unsigned i = 0; i < args->N; ++i) {
        if (!args->valid[i]) continue;
        PiercedHit hit = hit_of_packet(args, i);
        Shadow *shadow = &context->shadows[packet_field(args->ray, args->N, ID, i)->u];
        if (!sheen_shadow_meet(args->geometryUserPtr, &hit, shadow)) args->valid[i] = 0;
    }
}

void sheen_holes_filter(RTCGeometry geometry)
{
    rtcSetGeometryIntersectFilterFunction(geometry, filter_intersection);
    rtcSetGeometryOccludedFilterFunction(geometry, filter_occlusion);
}
