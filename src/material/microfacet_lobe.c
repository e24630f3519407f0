// SPDX-License-Identifier: Apache-2.0
// The geometry of a rough interface of two media. Source: walter2007
#include "material/microfacet_lobe.h"

bool sheen_facet_pair(float ior, Vec3 wo, Vec3 wi, Facet *t)
{
    if (wo.z == 0.0f || wi.z == 0.0f) return false;
    t->reflect = wo.z * wi.z > 0.0f;
    t->eta = wo.z > 0.0f ? ior : 1.0f / ior;
    Vec3 m = v3_mad(wo, t->reflect ? 1.0f : t->eta, wi);
    float length = v3_length(m), cos_t;
    if (!(length > 0.0f)) return false;
    t->m = v3_scale(m, m.z < 0.0f ? -1.0f / length : 1.0f / length);
    t->o = v3_dot(wo, t->m);
    t->i = v3_dot(wi, t->m);
    if (!(t->o * wo.z > 0.0f && t->i * wi.z > 0.0f)) return false;
    t->f = sheen_fresnel_dielectric(t->o, ior, &cos_t);
    t->normals_per_direction =
        t->reflect ? 1.0f / (4.0f * fabsf(t->i)) : sqrf(t->eta) * fabsf(t->i) / sqrf(t->o + t->eta * t->i);
    return true;
}

Vec3 sheen_facet_seen(const Microfacet *s, float ior, Vec3 wo, Vec2 u, float *f)
{
    float side = wo.z > 0.0f ? 1.0f : -1.0f, cos_t;
    Vec3 m = v3_scale(sheen_microfacet_sample(s, v3_scale(wo, side), u), side);
    *f = sheen_fresnel_dielectric(side * v3_dot(wo, m), ior, &cos_t);
    return m;
}

bool sheen_facet_send(float ior, Vec3 wo, Vec3 m, bool reflect, Vec3 *wi)
{
    float side = wo.z > 0.0f ? 1.0f : -1.0f, ratio = wo.z > 0.0f ? 1.0f / ior : ior, o = v3_dot(wo, m), cos_t;
    if (!(o > 0.0f)) return false;
    sheen_fresnel_dielectric(side * o, ior, &cos_t);
    *wi = reflect ? v3_reflect(wo, m) : v3_mad(v3_scale(wo, -ratio), ratio * o - fabsf(cos_t), m);
    *wi = v3_normalize(*wi);
    return reflect == (wi->z * wo.z > 0.0f);
}
