// SPDX-License-Identifier: Apache-2.0
// The simplest relative of a BSDF, for integrators that know diffuse surfaces and delta lobes only.
#include "material/bsdf_ops.h"

static BsdfLobe simple_principled(const BsdfLobe *b)
{
    BsdfLobe s = *b;
    if (b->principled.metallic > 0.5f) {
        s.ops = &sheen_lobe_conductor; // its index is none: a perfect mirror, tinted
    } else if (b->principled.spec_trans > 0.5f) {
        s.ops = &sheen_lobe_dielectric;
        s.transmittance = b->reflectance;
        s.reflectance = rgb_gray(1.0f);
    } else {
        s.ops = &sheen_lobe_lambert;
    }
    return s;
}

static BsdfLobe simple(const BsdfLobe *b)
{
    BsdfLobe s = *b;
    if (b->ops == &sheen_lobe_rough_conductor) s.ops = &sheen_lobe_conductor;
    if (b->ops == &sheen_lobe_rough_dielectric) s.ops = &sheen_lobe_dielectric;
    if (b->ops == &sheen_lobe_coated_lambert) s.ops = &sheen_lobe_lambert;
    if (b->ops == &sheen_lobe_principled_diffuse || b->ops == &sheen_lobe_principled_specular) s = simple_principled(b);
    s.weight = 1.0f;
    return s;
}

// What only lies upon something else: left out.
static bool is_accessory(const BsdfLobe *b)
{
    return b->ops == &sheen_lobe_coat || b->ops == &sheen_lobe_rough_coat || b->ops == &sheen_lobe_phong ||
           b->ops == &sheen_lobe_ward || b->ops == &sheen_lobe_principled_clearcoat ||
           b->ops == &sheen_lobe_diffuse_transmit;
}

void sheen_bsdf_simplify(Bsdf *bsdf)
{
    if (bsdf->n_lobes == 1 && (bsdf->lobes[0].ops->lobes || bsdf->lobes[0].ops == &sheen_lobe_lambert)) return;
    uint32_t best = SHEEN_NONE;
    for (uint32_t i = 0; i < bsdf->n_lobes; ++i) {
        const BsdfLobe *lobe = &bsdf->lobes[i];
        if (is_accessory(lobe)) continue;
        if (best == SHEEN_NONE || lobe->weight > bsdf->lobes[best].weight) best = i;
    }
    bool none = best == SHEEN_NONE;
    BsdfLobe s = simple(&bsdf->lobes[none ? 0 : best]);
    if (none) { // accessories alone: black
        s.ops = &sheen_lobe_lambert;
        s.reflectance = rgb_gray(0.0f);
    }
    // Perturbed frames and coatings stay as wrappers that do nothing; the sides are kept.
    for (uint32_t i = s.wrap; i != 0; i = bsdf->wraps[i - 1].outer) {
        BsdfWrap *wrap = &bsdf->wraps[i - 1];
        if (wrap->kind != SHEEN_WRAP_FRAME && wrap->kind != SHEEN_WRAP_COAT) continue;
        wrap->kind = SHEEN_WRAP_FRAME;
        wrap->material = NULL;
        wrap->frame = (Frame){v3(1, 0, 0), v3(0, 1, 0), v3(0, 0, 1)};
    }
    bsdf->lobes[0] = s;
    bsdf->n_lobes = 1;
}

bool sheen_material_may_be_delta(const SheenScene *scene, uint32_t material)
{
    const SheenMaterial *m = &scene->materials[material];
    switch (m->kind) {
    case SHEEN_MATERIAL_DIFFUSE:
    case SHEEN_MATERIAL_PLASTIC:
    case SHEEN_MATERIAL_ROUGH_PLASTIC:
    case SHEEN_MATERIAL_DIFFUSE_TRANSMIT:
    case SHEEN_MATERIAL_PHONG:
    case SHEEN_MATERIAL_WARD:
        return false;
    case SHEEN_MATERIAL_BLEND:
    case SHEEN_MATERIAL_SIDES:
        return sheen_material_may_be_delta(scene, m->nested[0]) || sheen_material_may_be_delta(scene, m->nested[1]);
    case SHEEN_MATERIAL_BUMP:
    case SHEEN_MATERIAL_NORMAL:
    case SHEEN_MATERIAL_COATING:
    case SHEEN_MATERIAL_ROUGH_COATING:
        return sheen_material_may_be_delta(scene, m->nested[0]);
    default:
        return true;
    }
}
