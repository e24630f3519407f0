// SPDX-License-Identifier: Apache-2.0
#include "material/lobe_shape.h"

#include "material/principled_lobe.h"

#include <string.h>

// ---- ranges of textures -----------------------------------------------------------------------------------------

typedef struct Range {
    float lo, hi;
} Range;

static bool is_constant(const SheenTexture *t)
{
    return t->kind == SHEEN_TEXTURE_CONSTANT;
}

/** Of the texture's luminance. @param most  of one whose values are not known */
static Range range_of(const SheenTexture *t, float least, float most)
{
    if (t->kind == SHEEN_TEXTURE_BITMAP || sheen_texture_is_of_mesh(t)) return (Range){least, most};
    float a = clampf(rgb_luminance(t->value), least, SHEEN_ALPHA_MAX), b = a;
    if (sheen_texture_has_two_values(t)) b = clampf(rgb_luminance(t->value2), least, SHEEN_ALPHA_MAX);
    return (Range){minf(a, b), maxf(a, b)};
}

static bool is_always(const SheenTexture *t, float value)
{
    return is_constant(t) && rgb_luminance(t->value) == value;
}

/** The roughness of a microfacet lobe. @return false when both axes vary by themselves */
static bool set_alpha(LobeKey *key, const SheenMaterial *m)
{
    Range u = range_of(&m->alpha_u, SHEEN_ALPHA_MIN, 1.0f), v = range_of(&m->alpha_v, SHEEN_ALPHA_MIN, 1.0f);
    if (!m->anisotropic) v = u;
    key->anisotropic = m->anisotropic;
    key->varies = u.lo != u.hi || v.lo != v.hi;
    key->alpha_lo[0] = u.lo, key->alpha_hi[0] = u.hi;
    key->alpha_lo[1] = v.lo, key->alpha_hi[1] = v.hi;
    key->distribution = m->distribution;
    return !(key->varies && key->anisotropic);
}

// ---- the lobes of a principled material -------------------------------------------------------------------------

/** As the look-up has it: the square of the roughness, stretched. */
static bool set_principled_alpha(LobeKey *key, const SheenMaterial *m)
{
    const SheenPrincipled *p = m->principled;
    Range r = range_of(&m->alpha_u, 0.0f, 1.0f);
    float aspect = 1.0f;
    if (m->anisotropic) {
        if (!is_constant(&p->anisotropic)) return false;
        aspect = sqrtf(1.0f - 0.9f * unit_or_zero(rgb_luminance(p->anisotropic.value)));
    }
    key->anisotropic = aspect != 1.0f;
    key->varies = r.lo != r.hi;
    key->alpha_lo[0] = maxf(sqrf(r.lo) / aspect, 0.001f), key->alpha_hi[0] = maxf(sqrf(r.hi) / aspect, 0.001f);
    key->alpha_lo[1] = maxf(sqrf(r.lo) * aspect, 0.001f), key->alpha_hi[1] = maxf(sqrf(r.hi) * aspect, 0.001f);
    key->distribution = SHEEN_DISTRIBUTION_GGX;
    key->ior = m->ior;
    // Schlick's form has the shapes without Fresnel and with his weight; a plain dielectric the exact Fresnel term.
    bool metal = !is_always(&p->metallic, 0.0f), dielectric = !is_always(&p->metallic, 1.0f);
    bool tinted = !is_always(&p->spec_tint, 0.0f), plain = !is_always(&p->spec_tint, 1.0f);
    if (dielectric && plain) key->shapes |= 1u << SHEEN_FRESNEL_EXACT;
    if (metal || tinted) key->shapes |= 1u << SHEEN_FRESNEL_ONE | 1u << SHEEN_FRESNEL_SCHLICK;
    return !(key->varies && key->anisotropic);
}

static bool set_principled(LobeFamily *f, const SheenMaterial *m, unsigned slot)
{
    const SheenPrincipled *p = m->principled;
    bool sheet = m->kind == SHEEN_MATERIAL_PRINCIPLED_THIN;
    if (slot == 1) {
        Range gloss = range_of(&p->clearcoat_gloss, 0.0f, 1.0f);
        f->key.ops = &sheen_lobe_principled_clearcoat;
        f->key.varies = gloss.lo != gloss.hi;
        for (int i = 0; i < 2; ++i) {
            f->key.alpha_lo[i] = lerpf(0.1f, 0.001f, gloss.hi);
            f->key.alpha_hi[i] = lerpf(0.1f, 0.001f, gloss.lo);
        }
        f->key.ior = m->ior;
        return !is_always(&p->clearcoat, 0.0f);
    }
    f->key.ops = sheet ? &sheen_lobe_thin_reflection : &sheen_lobe_principled_specular;
    bool opaque = is_always(&p->spec_trans, 0.0f) || is_always(&p->metallic, 1.0f);
    bool there = sheet ? !is_always(&p->spec_trans, 0.0f) : opaque;
    if (!there || !set_principled_alpha(&f->key, m)) return false;
    f->n_shapes = 0;
    for (uint32_t bits = f->key.shapes; bits != 0; bits &= bits - 1) ++f->n_shapes;
    return true;
}

// ---- all lobes --------------------------------------------------------------------------------------------------

static void copy3(float out[3], Rgb c)
{
    out[0] = c.r, out[1] = c.g, out[2] = c.b;
}

static bool set_conductor(LobeFamily *f, const SheenMaterial *m)
{
    f->key.ops = &sheen_lobe_rough_conductor;
    copy3(f->key.eta, m->eta);
    copy3(f->key.k, m->k);
    bool gray = m->eta.r == m->eta.g && m->eta.g == m->eta.b && m->k.r == m->k.g && m->k.g == m->k.b;
    f->n_shapes = gray ? 1 : 3; // else one a channel
    return set_alpha(&f->key, m);
}

static void set_lafortune(LobeFamily *f, const SheenLafortune *lobe)
{
    f->key.ops = &sheen_lobe_lafortune;
    f->lafortune = *lobe;
    f->lafortune.weight = rgb_gray(1.0f);
    f->key.exponent = lobe->exponent;
    f->key.c[0] = lobe->c.x, f->key.c[1] = lobe->c.y, f->key.c[2] = lobe->c.z;
    f->key.anisotropic = lobe->c.x != lobe->c.y;
}

unsigned sheen_lobe_slots(const SheenMaterial *m)
{
    switch (m->kind) {
    case SHEEN_MATERIAL_ROUGH_CONDUCTOR:
    case SHEEN_MATERIAL_ROUGH_PLASTIC:
    case SHEEN_MATERIAL_ROUGH_COATING:
    case SHEEN_MATERIAL_PHONG:
    case SHEEN_MATERIAL_WARD:
    case SHEEN_MATERIAL_PRINCIPLED_THIN:
        return 1;
    case SHEEN_MATERIAL_PRINCIPLED:
        return 2;
    case SHEEN_MATERIAL_LAFORTUNE:
        return m->n_lafortune;
    default:
        return 0;
    }
}

bool sheen_lobe_family(const SheenMaterial *m, unsigned slot, LobeFamily *out)
{
    memset(out, 0, sizeof *out); // paddings too, for comparison
    out->material = m;
    out->n_shapes = 1;
    switch (m->kind) {
    case SHEEN_MATERIAL_ROUGH_CONDUCTOR:
        return set_conductor(out, m);
    case SHEEN_MATERIAL_ROUGH_PLASTIC:
    case SHEEN_MATERIAL_ROUGH_COATING:
        out->key.ops = &sheen_lobe_rough_coat;
        out->key.ior = m->ior;
        return set_alpha(&out->key, m);
    case SHEEN_MATERIAL_WARD:
        out->key.ops = &sheen_lobe_ward;
        out->key.ward = m->ward;
        return set_alpha(&out->key, m);
    case SHEEN_MATERIAL_PHONG:
        out->key.ops = &sheen_lobe_phong;
        out->key.exponent = m->exponent;
        return true;
    case SHEEN_MATERIAL_LAFORTUNE:
        set_lafortune(out, &m->lafortune[slot]);
        return true;
    case SHEEN_MATERIAL_PRINCIPLED:
    case SHEEN_MATERIAL_PRINCIPLED_THIN:
        return set_principled(out, m, slot);
    default:
        return false;
    }
}

unsigned sheen_lobe_slot(const BsdfLobe *lobe)
{
    const BsdfOps *ops = lobe->ops;
    if (ops == &sheen_lobe_principled_clearcoat) return 1;
    if (ops == &sheen_lobe_lafortune) return (unsigned)(lobe->lafortune - lobe->material->lafortune);
    bool first = ops == &sheen_lobe_rough_conductor || ops == &sheen_lobe_rough_coat || ops == &sheen_lobe_phong ||
                 ops == &sheen_lobe_ward || ops == &sheen_lobe_principled_specular ||
                 ops == &sheen_lobe_thin_reflection;
    return first ? 0 : LOBE_SLOTS_MAX;
}

BsdfLobe sheen_lobe_prototype(const LobeFamily *family, const float alpha[2])
{
    BsdfLobe lobe;
    memset(&lobe, 0, sizeof lobe);
    lobe.ops = family->key.ops;
    lobe.material = family->material;
    lobe.lafortune = &family->lafortune;
    lobe.weight = 1.0f;
    lobe.reflectance = rgb_gray(1.0f);
    lobe.microfacet = (Microfacet){(SheenDistribution)family->key.distribution, alpha[0], alpha[1]};
    lobe.principled.metallic = lobe.principled.clearcoat = 1.0f; // of a white metal: no Fresnel term
    return lobe;
}

static bool is_principled(const LobeFamily *family)
{
    return family->key.shapes != 0;
}

void sheen_lobe_shapes(const LobeFamily *family, const BsdfLobe *prototype, Vec3 wo, Vec3 wi, float s[])
{
    Rgb f = prototype->ops->eval(prototype, wo, wi);
    if (!rgb_finite(f)) f = rgb_gray(0.0f);
    if (is_principled(family)) {
        float terms[SHEEN_FRESNEL_TERMS];
        unsigned n = 0;
        sheen_principled_fresnel_terms(family->key.ior, v3_dot(wo, bsdf_half(wo, wi)), terms);
        for (unsigned i = 0; i < SHEEN_FRESNEL_TERMS; ++i)
            if (family->key.shapes >> i & 1u) s[n++] = f.r * terms[i];
        return;
    }
    const float channels[3] = {f.r, f.g, f.b};
    for (unsigned i = 0; i < family->n_shapes; ++i) s[i] = channels[i];
}

void sheen_lobe_factors(const LobeFamily *family, const BsdfLobe *lobe, Rgb a[])
{
    Rgb c = lobe->reflectance;
    if (is_principled(family)) {
        Rgb factors[SHEEN_FRESNEL_TERMS];
        unsigned n = 0;
        sheen_principled_fresnel_factors(lobe, factors);
        for (unsigned i = 0; i < SHEEN_FRESNEL_TERMS; ++i)
            if (family->key.shapes >> i & 1u) a[n++] = factors[i];
    } else if (family->key.ops == &sheen_lobe_principled_clearcoat) {
        a[0] = rgb_gray(lobe->principled.clearcoat);
    } else if (family->n_shapes == 3) {
        a[0] = rgb(c.r, 0.0f, 0.0f), a[1] = rgb(0.0f, c.g, 0.0f), a[2] = rgb(0.0f, 0.0f, c.b);
    } else if (lobe->lafortune) {
        a[0] = rgb_mul(c, lobe->lafortune->weight);
    } else {
        a[0] = c;
    }
}
