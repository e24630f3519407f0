// SPDX-License-Identifier: Apache-2.0
// From a material to the lobes and wrappers of a point: textures are looked up, maps become frames.
#include "material/bsdf_ops.h"
#include "scene/coat.h"

#include <string.h>

// Where lobes are being added: the point, and what all of them are inside of.
typedef struct Place {
    const SheenScene *scene;
    const SurfacePoint *s;
    Bsdf *bsdf;
} Place;

// What surrounds a node of the material.
typedef struct Inside {
    uint32_t wrap; // the innermost wrapper, counted from 1
    float weight;
    Frame frame; // of the innermost wrapper, world space
} Inside;

static Rgb color_at(const Place *p, const SheenTexture *t)
{
    return rgb_unit(sheen_surface_texture(p->scene, t, p->s));
}

static float number_at(const Place *p, const SheenTexture *t)
{
    return rgb_luminance(sheen_surface_texture(p->scene, t, p->s));
}

static float unit_at(const Place *p, const SheenTexture *t)
{
    return unit_or_zero(number_at(p, t));
}

static float alpha_at(const Place *p, const SheenTexture *t)
{
    float a = number_at(p, t);
    return a > SHEEN_ALPHA_MIN ? minf(a, SHEEN_ALPHA_MAX) : SHEEN_ALPHA_MIN;
}

static BsdfLobe *add_lobe(Place *p, const Inside *in, const BsdfOps *ops, const SheenMaterial *m)
{
    BsdfLobe *lobe = &p->bsdf->lobes[p->bsdf->n_lobes++];
    lobe->ops = ops;
    lobe->material = m;
    lobe->weight = in->weight;
    lobe->wrap = in->wrap;
    lobe->lafortune = NULL;
    lobe->reflectance = lobe->transmittance = rgb_gray(0.0f);
    lobe->microfacet = (Microfacet){.distribution = m->distribution, .alpha_u = 1.0f, .alpha_v = 1.0f};
    return lobe;
}

static BsdfWrap *add_wrap(Place *p, Inside *in, BsdfWrapKind kind, const SheenMaterial *m)
{
    BsdfWrap *wrap = &p->bsdf->wraps[p->bsdf->n_wraps++];
    wrap->kind = kind;
    wrap->outer = in->wrap;
    wrap->material = m;
    wrap->alpha = 0.0f;
    in->wrap = p->bsdf->n_wraps;
    return wrap;
}

// ---- frames -----------------------------------------------------------------------------------------------------

// A frame about n whose t is as near to dp/du as possible.
static Frame aligned_frame(Vec3 n, Vec3 dpdu)
{
    Vec3 t = v3_mad(dpdu, -v3_dot(n, dpdu), n);
    if (!(v3_length2(t) > 1e-12f * v3_length2(dpdu))) return frame_from_normal(n);
    t = v3_normalize(t);
    return (Frame){t, v3_cross(n, t), n};
}

static void turn_to(Place *p, Inside *in, const Frame *to, const SheenMaterial *map)
{
    BsdfWrap *wrap = add_wrap(p, in, SHEEN_WRAP_FRAME, map);
    const Frame *from = &in->frame;
    wrap->frame = (Frame){frame_to_local(from, to->t), frame_to_local(from, to->b), frame_to_local(from, to->n)};
    in->frame = *to;
}

// The normal of the surface raised by the map: both tangents lean by its slope along the normal. Source: blinn1978
static Vec3 bumped_normal(const Place *p, const SheenMaterial *m, Vec3 n, Vec3 dpdu, Vec3 dpdv)
{
    Vec2 slope = sheen_texture_gradient(&m->map, p->s->uv);
    Vec3 u = v3_mad(dpdu, m->map_scale * slope.x - v3_dot(n, dpdu), n);
    Vec3 v = v3_mad(dpdv, m->map_scale * slope.y - v3_dot(n, dpdv), n);
    Vec3 bumped = v3_normalize(v3_cross(u, v));
    if (v3_dot(bumped, n) < 0.0f) bumped = v3_neg(bumped); // texture coordinates may be mirrored
    return v3_finite(bumped) && v3_length2(bumped) > 0.5f ? bumped : n;
}

// The map's normal, given in the frame of the shading normal and dp/du.
static Vec3 mapped_normal(const Place *p, const SheenMaterial *m, const Frame *aligned)
{
    Rgb c = sheen_texture_eval(&m->map, p->s->uv);
    Vec3 n = v3_normalize(v3(2.0f * c.r - 1.0f, 2.0f * c.g - 1.0f, 2.0f * c.b - 1.0f));
    if (!v3_finite(n) || !(n.z > 0.0f)) return aligned->n; // a normal must not look below the surface
    return v3_normalize(frame_to_world(aligned, n));
}

static void perturb(Place *p, Inside *in, const SheenMaterial *m)
{
    Vec3 dpdu, dpdv, n = in->frame.n;
    sheen_surface_tangents(p->scene, p->s, &dpdu, &dpdv);
    if (m->kind == SHEEN_MATERIAL_BUMP) {
        n = bumped_normal(p, m, n, dpdu, dpdv);
    } else {
        Frame aligned = aligned_frame(n, dpdu);
        n = mapped_normal(p, m, &aligned);
    }
    Frame to = aligned_frame(n, dpdu);
    turn_to(p, in, &to, m);
}

static void align(Place *p, Inside *in)
{
    Vec3 dpdu, dpdv;
    sheen_surface_tangents(p->scene, p->s, &dpdu, &dpdv);
    Frame to = aligned_frame(in->frame.n, dpdu);
    turn_to(p, in, &to, NULL);
}

// ---- lobes ------------------------------------------------------------------------------------------------------

static void set_microfacet(const Place *p, BsdfLobe *lobe, const SheenMaterial *m)
{
    lobe->microfacet.alpha_u = alpha_at(p, &m->alpha_u);
    lobe->microfacet.alpha_v = m->anisotropic ? alpha_at(p, &m->alpha_v) : lobe->microfacet.alpha_u;
}

static void add_lambert(Place *p, const Inside *in, const SheenMaterial *m)
{
    add_lobe(p, in, &sheen_lobe_lambert, m)->reflectance = color_at(p, &m->reflectance);
}

static void add_rough_diffuse(Place *p, const Inside *in, const SheenMaterial *m)
{
    BsdfLobe *lobe = add_lobe(p, in, &sheen_lobe_rough_diffuse, m);
    lobe->reflectance = color_at(p, &m->reflectance);
    lobe->microfacet.alpha_u = lobe->microfacet.alpha_v = clampf(number_at(p, &m->alpha_u), 0.0f, 10.0f);
}

// A lobe of an interface, metal or dielectric, smooth or rough.
static void add_interface(Place *p, const Inside *in, const SheenMaterial *m, const BsdfOps *ops, bool rough)
{
    BsdfLobe *lobe = add_lobe(p, in, ops, m);
    lobe->reflectance = color_at(p, &m->specular_reflectance);
    lobe->transmittance = color_at(p, &m->specular_transmittance);
    if (rough) set_microfacet(p, lobe, m);
}

static void add_plastic(Place *p, const Inside *in, const SheenMaterial *m)
{
    bool rough = m->kind == SHEEN_MATERIAL_ROUGH_PLASTIC;
    add_interface(p, in, m, rough ? &sheen_lobe_rough_coat : &sheen_lobe_coat, rough);
    BsdfLobe *base = add_lobe(p, in, &sheen_lobe_coated_lambert, m);
    base->reflectance = color_at(p, &m->reflectance);
    if (rough) set_microfacet(p, base, m);
    float inside = rough ? sheen_coat_inside(m->coat, base->microfacet.alpha_u) : m->inside, i2 = sqrf(m->ior);
    Rgb back = m->nonlinear ? rgb_scale(base->reflectance, inside) : rgb_gray(inside);
    base->transmittance =
        rgb(1.0f / (i2 * (1.0f - back.r)), 1.0f / (i2 * (1.0f - back.g)), 1.0f / (i2 * (1.0f - back.b)));
}

// A Beckmann lobe of this roughness is as wide as cos^n. Source: walter2007
static float alpha_of_exponent(float n)
{
    return clampf(sqrtf(2.0f / (n + 2.0f)), SHEEN_ALPHA_MIN, 1.0f);
}

static void add_glossy_on_diffuse(Place *p, const Inside *in, const SheenMaterial *m)
{
    add_lambert(p, in, m);
    BsdfLobe *lobe = add_lobe(p, in, m->kind == SHEEN_MATERIAL_PHONG ? &sheen_lobe_phong : &sheen_lobe_ward, m);
    lobe->reflectance = color_at(p, &m->specular_reflectance);
    if (m->kind == SHEEN_MATERIAL_WARD) {
        set_microfacet(p, lobe, m);
    } else {
        lobe->microfacet.alpha_u = lobe->microfacet.alpha_v = alpha_of_exponent(m->exponent);
    }
}

static void add_lafortune(Place *p, const Inside *in, const SheenMaterial *m)
{
    add_lambert(p, in, m);
    for (uint32_t i = 0; i < m->n_lafortune; ++i) {
        BsdfLobe *lobe = add_lobe(p, in, &sheen_lobe_lafortune, m);
        lobe->lafortune = &m->lafortune[i];
        lobe->reflectance = color_at(p, &m->specular_reflectance);
        lobe->microfacet.alpha_u = lobe->microfacet.alpha_v = alpha_of_exponent(lobe->lafortune->exponent);
    }
}

static Microfacet principled_microfacet(const Place *p, const SheenMaterial *m, float roughness)
{
    float alpha = sqrf(roughness);
    float aspect = m->anisotropic ? sqrtf(1.0f - 0.9f * unit_at(p, &m->principled->anisotropic)) : 1.0f;
    return (Microfacet){SHEEN_DISTRIBUTION_GGX, maxf(alpha / aspect, 0.001f), maxf(alpha * aspect, 0.001f)};
}

static void add_principled(Place *p, const Inside *in, const SheenMaterial *m)
{
    const SheenPrincipled *t = m->principled;
    BsdfLobe *diffuse = add_lobe(p, in, &sheen_lobe_principled_diffuse, m);
    diffuse->reflectance = color_at(p, &m->reflectance);
    diffuse->principled.roughness = unit_at(p, &m->alpha_u);
    diffuse->principled.metallic = unit_at(p, &t->metallic);
    diffuse->principled.spec_trans = unit_at(p, &t->spec_trans);
    diffuse->principled.spec_tint = unit_at(p, &t->spec_tint);
    diffuse->principled.sheen = unit_at(p, &t->sheen);
    diffuse->principled.sheen_tint = unit_at(p, &t->sheen_tint);
    diffuse->principled.flatness = unit_at(p, &t->flatness);
    diffuse->principled.clearcoat = unit_at(p, &t->clearcoat);
    diffuse->principled.clearcoat_gloss = unit_at(p, &t->clearcoat_gloss);

    BsdfLobe *specular = &p->bsdf->lobes[p->bsdf->n_lobes++];
    *specular = *diffuse;
    specular->ops = &sheen_lobe_principled_specular;
    specular->microfacet = principled_microfacet(p, m, diffuse->principled.roughness);
    float gloss = diffuse->principled.clearcoat_gloss;
    if (diffuse->principled.clearcoat > 0.0f) {
        BsdfLobe *coat = &p->bsdf->lobes[p->bsdf->n_lobes++];
        *coat = *diffuse;
        coat->ops = &sheen_lobe_principled_clearcoat;
        coat->microfacet.alpha_u = coat->microfacet.alpha_v = lerpf(0.1f, 0.001f, gloss);
    }
}

// What is not diffuse is reflected and let through, by microfacets that look smoother from a denser sheet.
static void add_principled_thin(Place *p, const Inside *in, const SheenMaterial *m)
{
    const SheenPrincipled *t = m->principled;
    float specular = unit_at(p, &t->spec_trans), behind = clampf(0.5f * number_at(p, &t->diff_trans), 0.0f, 1.0f);
    Inside diffuse = *in, part = *in;
    diffuse.weight *= (1.0f - specular) * (1.0f - behind);
    BsdfLobe *reflect = add_lobe(p, &diffuse, &sheen_lobe_principled_diffuse, m);
    memset(&reflect->principled, 0, sizeof reflect->principled);
    reflect->reflectance = reflect->transmittance = color_at(p, &m->reflectance);
    reflect->principled.roughness = unit_at(p, &m->alpha_u);
    reflect->principled.spec_tint = unit_at(p, &t->spec_tint);
    reflect->principled.sheen = unit_at(p, &t->sheen);
    reflect->principled.sheen_tint = unit_at(p, &t->sheen_tint);
    reflect->principled.flatness = unit_at(p, &t->flatness);
    if (behind > 0.0f) {
        part.weight = in->weight * (1.0f - specular) * behind;
        add_lobe(p, &part, &sheen_lobe_diffuse_transmit, m)->transmittance = reflect->reflectance;
    }
    if (!(specular > 0.0f)) return;
    part.weight = in->weight * specular;
    const float scale[2] = {1.0f, 0.65f * m->ior - 0.35f};
    for (int i = 0; i < 2; ++i) {
        BsdfLobe *lobe = &p->bsdf->lobes[p->bsdf->n_lobes++];
        *lobe = *reflect;
        lobe->ops = i == 0 ? &sheen_lobe_thin_reflection : &sheen_lobe_thin_transmission;
        lobe->weight = part.weight;
        lobe->microfacet = principled_microfacet(p, m, maxf(scale[i], 0.0f) * reflect->principled.roughness);
    }
}

// ---- the tree ---------------------------------------------------------------------------------------------------

static void add_material(Place *p, Inside in, const SheenMaterial *m);

static void add_nested(Place *p, const Inside *in, const SheenMaterial *m, int which, float share)
{
    Inside inner = *in;
    inner.weight *= share;
    if (inner.weight > 0.0f) add_material(p, inner, &p->scene->materials[m->nested[which]]);
}

static void add_sides(Place *p, const Inside *in, const SheenMaterial *m)
{
    Inside front = *in, back = *in;
    add_wrap(p, &front, SHEEN_WRAP_FRONT, m);
    add_nested(p, &front, m, 0, 1.0f);
    add_wrap(p, &back, SHEEN_WRAP_BACK, m);
    add_nested(p, &back, m, 1, 1.0f);
}

static void add_mask(Place *p, const Inside *in, const SheenMaterial *m)
{
    float opacity = unit_at(p, &m->weight);
    add_nested(p, in, m, 0, opacity);
    if (opacity == 1.0f) return;
    add_lobe(p, in, &sheen_lobe_passage, m)->weight *= 1.0f - opacity;
}

static void add_coating(Place *p, const Inside *in, const SheenMaterial *m)
{
    bool rough = m->kind == SHEEN_MATERIAL_ROUGH_COATING;
    add_interface(p, in, m, rough ? &sheen_lobe_rough_coat : &sheen_lobe_coat, rough);
    Inside below = *in;
    add_wrap(p, &below, SHEEN_WRAP_COAT, m)->alpha = rough ? alpha_at(p, &m->alpha_u) : 0.0f;
    add_nested(p, &below, m, 0, 1.0f);
}

static void add_leaf(Place *p, const Inside *in, const SheenMaterial *m)
{
    switch (m->kind) {
    case SHEEN_MATERIAL_DIFFUSE:
        add_lambert(p, in, m);
        break;
    case SHEEN_MATERIAL_CONDUCTOR:
        add_interface(p, in, m, &sheen_lobe_conductor, false);
        break;
    case SHEEN_MATERIAL_DIELECTRIC:
        add_interface(p, in, m, &sheen_lobe_dielectric, false);
        break;
    case SHEEN_MATERIAL_THIN_DIELECTRIC:
        add_interface(p, in, m, &sheen_lobe_thin_dielectric, false);
        break;
    case SHEEN_MATERIAL_ROUGH_CONDUCTOR:
        add_interface(p, in, m, &sheen_lobe_rough_conductor, true);
        break;
    case SHEEN_MATERIAL_ROUGH_DIELECTRIC: // without a step of the index no microfacet can be found between directions
        add_interface(p, in, m, fabsf(m->ior - 1.0f) < 1e-3f ? &sheen_lobe_dielectric : &sheen_lobe_rough_dielectric,
                      true);
        break;
    case SHEEN_MATERIAL_PLASTIC:
    case SHEEN_MATERIAL_ROUGH_PLASTIC:
        add_plastic(p, in, m);
        break;
    case SHEEN_MATERIAL_ROUGH_DIFFUSE:
        add_rough_diffuse(p, in, m);
        break;
    case SHEEN_MATERIAL_PRINCIPLED_THIN:
        add_principled_thin(p, in, m);
        break;
    case SHEEN_MATERIAL_DIFFUSE_TRANSMIT:
        add_interface(p, in, m, &sheen_lobe_diffuse_transmit, false);
        break;
    case SHEEN_MATERIAL_LAFORTUNE:
        add_lafortune(p, in, m);
        break;
    case SHEEN_MATERIAL_PHONG:
    case SHEEN_MATERIAL_WARD:
        add_glossy_on_diffuse(p, in, m);
        break;
    default:
        add_principled(p, in, m);
        break;
    }
}

static void add_material(Place *p, Inside in, const SheenMaterial *m)
{
    if (m->two_sided) add_wrap(p, &in, SHEEN_WRAP_TWO_SIDED, m);
    switch (m->kind) {
    case SHEEN_MATERIAL_BLEND: {
        float weight = unit_at(p, &m->weight);
        add_nested(p, &in, m, 0, 1.0f - weight);
        add_nested(p, &in, m, 1, weight);
        return;
    }
    case SHEEN_MATERIAL_SIDES:
        add_sides(p, &in, m);
        return;
    case SHEEN_MATERIAL_MASK:
        add_mask(p, &in, m);
        return;
    case SHEEN_MATERIAL_BUMP:
    case SHEEN_MATERIAL_NORMAL:
        perturb(p, &in, m);
        add_nested(p, &in, m, 0, 1.0f);
        return;
    case SHEEN_MATERIAL_COATING:
    case SHEEN_MATERIAL_ROUGH_COATING:
        add_coating(p, &in, m);
        return;
    default:
        if (m->anisotropic) align(p, &in);
        add_leaf(p, &in, m);
    }
}

// What is not used of *out stays as it is: this is called for every hit.
void sheen_bsdf_look_up(const SheenScene *scene, const SurfacePoint *s, Bsdf *out)
{
    const SheenMaterial *m = &scene->materials[scene->shapes[s->shape].material];
    Place p = {scene, s, out};
    out->n_lobes = out->n_wraps = 0;
    Inside in = {.weight = 1.0f};
    if (m->n_wraps > (m->two_sided ? 1u : 0u))
        in.frame = frame_from_normal(s->ns); // none but maps and grain ask for it
    add_material(&p, in, m);
}

Bsdf sheen_bsdf_at(const SheenScene *scene, const SurfacePoint *s)
{
    Bsdf bsdf;
    sheen_bsdf_look_up(scene, s, &bsdf);
    return bsdf;
}
