// SPDX-License-Identifier: Apache-2.0
// The way of light between the surface and a lobe, through wrappers.
#include "material/bsdf_ops.h"
#include "scene/coat.h"

// Refracts a direction on either side of an interface into the layer below (`inward`) or out of it; both sides look
// alike, as the layer lies on the side of the viewer. @return false at total reflection
static bool refract(float ior, bool inward, Vec3 *w)
{
    float cos_t, ratio = inward ? 1.0f / ior : ior, c = fabsf(w->z);
    if (!(c > 0.0f)) return false;
    float f = sheen_fresnel_dielectric(inward ? c : -c, ior, &cos_t);
    if (!(f < 1.0f) || cos_t == 0.0f) return false;
    *w = v3(ratio * w->x, ratio * w->y, copysignf(fabsf(cos_t), w->z));
    return true;
}

// What a coating leaves of light that crosses it once: w outside, w_in inside.
static Rgb coat_transmittance(const BsdfWrap *wrap, Vec3 w, Vec3 w_in)
{
    const SheenMaterial *m = wrap->material;
    float cos_t;
    float t = m->coat ? sheen_coat_transmittance(m->coat, wrap->alpha, w.z)
                      : 1.0f - sheen_fresnel_dielectric(fabsf(w.z), m->ior, &cos_t);
    float way = 1.0f / maxf(fabsf(w_in.z), 1e-6f);
    return rgb(t * expf(-m->absorption.r * way), t * expf(-m->absorption.g * way), t * expf(-m->absorption.b * way));
}

// Whether a mapped normal faces away from wo, so that the normal on the other side of the surface's takes its place:
// the frame is turned half round z. Source: schuessler2017-normals
static bool is_turned(const BsdfWrap *wrap, Vec3 wo)
{
    return wrap->material && wrap->material->turn_normals && wo.z * v3_dot(wo, wrap->frame.n) <= 0.0f;
}

static Vec3 turn(bool turned, Vec3 w)
{
    return turned ? v3(-w.x, -w.y, w.z) : w;
}

static float tan2(Vec3 w)
{
    return (w.x * w.x + w.y * w.y) / (w.z * w.z);
}

// The squared roughness that reaches a mapped normal.
static float terminator_alpha2(const BsdfWrap *wrap)
{
    return minf(0.125f * tan2(wrap->frame.n), 1.0f);
}

static bool fades_out(const BsdfWrap *wrap)
{
    return wrap->kind == SHEEN_WRAP_FRAME && wrap->material && wrap->material->shadow_normals;
}

// Between the terminator of the mapped normal and that of the surface, light would end abruptly: it is shadowed as by
// microfacets of a roughness that reaches the mapped normal. Source: conty2019-terminator
static float terminator(const BsdfWrap *wrap, Vec3 wi)
{
    if (!fades_out(wrap)) return 1.0f;
    float f = 2.0f / (1.0f + sqrtf(1.0f + terminator_alpha2(wrap) * tan2(wi)));
    return f > 0.0f ? f : 0.0f;
}

// A direction from outside a wrapper to inside it. @param wo  outside it: which side is seen
static bool enter(const BsdfWrap *wrap, Vec3 wo, Vec3 *w, Rgb *factor, float *density)
{
    Vec3 outside = *w;
    switch (wrap->kind) {
    case SHEEN_WRAP_TWO_SIDED:
        if (wo.z < 0.0f) w->z = -w->z;
        return true;
    case SHEEN_WRAP_FRONT:
        return wo.z > 0.0f;
    case SHEEN_WRAP_BACK:
        w->z = -w->z;
        return wo.z < 0.0f;
    case SHEEN_WRAP_FRAME:
        *w = frame_to_local(&wrap->frame, turn(is_turned(wrap, wo), outside));
        return outside.z * w->z > 0.0f; // else light would come through the surface
    case SHEEN_WRAP_COAT:
        break;
    }
    if (!refract(wrap->material->ior, true, w)) return false;
    *factor = rgb_mul(*factor, coat_transmittance(wrap, outside, *w));
    // sin = ior sin_in, so that d omega_in cos_in ior^2 = d omega cos.
    *density *= fabsf(outside.z / w->z) / sqrf(wrap->material->ior);
    return true;
}

static bool leave(const BsdfWrap *wrap, Vec3 wo, Vec3 *w, Rgb *factor, float *density)
{
    Vec3 inside = *w;
    switch (wrap->kind) {
    case SHEEN_WRAP_TWO_SIDED:
        if (wo.z < 0.0f) w->z = -w->z;
        return true;
    case SHEEN_WRAP_FRONT:
        return true;
    case SHEEN_WRAP_BACK:
        w->z = -w->z;
        return true;
    case SHEEN_WRAP_FRAME:
        *w = turn(is_turned(wrap, wo), frame_to_world(&wrap->frame, inside));
        return inside.z * w->z > 0.0f;
    case SHEEN_WRAP_COAT:
        break;
    }
    if (!refract(wrap->material->ior, false, w)) return false;
    *factor = rgb_mul(*factor, coat_transmittance(wrap, *w, inside));
    *density *= fabsf(w->z / inside.z) / sqrf(wrap->material->ior);
    return true;
}

bool sheen_bsdf_way(const Bsdf *bsdf, const BsdfLobe *lobe, Vec3 wo, BsdfWay *way)
{
    way->n = 0;
    way->factor = rgb_gray(1.0f);
    way->wo[0] = wo;
    if (lobe->wrap == 0) return true;
    for (uint32_t i = lobe->wrap; i != 0; i = bsdf->wraps[i - 1].outer) ++way->n;
    int at = way->n;
    for (uint32_t i = lobe->wrap; i != 0; i = bsdf->wraps[i - 1].outer) way->wraps[--at] = &bsdf->wraps[i - 1];
    float density = 1.0f;
    for (int i = 0; i < way->n; ++i) {
        Vec3 w = way->wo[i];
        if (!enter(way->wraps[i], w, &w, &way->factor, &density)) return false;
        way->wo[i + 1] = w;
    }
    return true;
}

bool sheen_bsdf_way_in(const BsdfWay *way, Vec3 *wi, Rgb *factor, float *density)
{
    *factor = way->factor;
    *density = 1.0f;
    for (int i = 0; i < way->n; ++i) {
        *factor = rgb_scale(*factor, terminator(way->wraps[i], *wi));
        if (!enter(way->wraps[i], way->wo[i], wi, factor, density)) return false;
    }
    return true;
}

bool sheen_bsdf_way_out(const BsdfWay *way, BsdfSample *sample)
{
    Rgb factor = way->factor;
    float density = 1.0f;
    for (int i = way->n - 1; i >= 0; --i) {
        if (!leave(way->wraps[i], way->wo[i], &sample->wi_l, &factor, &density)) return false;
        factor = rgb_scale(factor, terminator(way->wraps[i], sample->wi_l));
    }
    if (way->n > 0) sample->weight = rgb_mul(sample->weight, factor);
    if (!sample->delta) sample->pdf *= density;
    return true;
}

// Fitted to a quadrature over the hemisphere: good to 0.003 for normals bent by up to 0.8 rad, to 0.04 up to 1.2.
float sheen_bsdf_way_terminator(const BsdfWay *way)
{
    float f = 1.0f;
    for (int i = 0; i < way->n; ++i)
        if (fades_out(way->wraps[i])) f /= 1.0f + 0.74f * powf(terminator_alpha2(way->wraps[i]), 0.775f);
    return f;
}

Vec3 sheen_bsdf_way_normal(const BsdfWay *way)
{
    Vec3 n = v3(0.0f, 0.0f, 1.0f);
    for (int i = way->n - 1; i >= 0; --i) {
        const BsdfWrap *wrap = way->wraps[i];
        bool back = wrap->kind == SHEEN_WRAP_BACK || (wrap->kind == SHEEN_WRAP_TWO_SIDED && way->wo[i].z < 0.0f);
        if (wrap->kind == SHEEN_WRAP_FRAME) n = turn(is_turned(wrap, way->wo[i]), frame_to_world(&wrap->frame, n));
        if (back) n.z = -n.z;
    }
    return n;
}
