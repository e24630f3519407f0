// SPDX-License-Identifier: Apache-2.0
// Materials of Mitsuba scenes that hold other materials.
#include "io/mitsuba.h"

#include <string.h>

enum { MAX_NESTED = 8 };

/** The materials inside e, by element or reference, at most `max` of them; more than that are named in a warning. */
static int nested_materials(Mitsuba *m, const SheenXml *e, SheenXml *out[], int max)
{
    int n = 0;
    for (SheenXml *c = e->first; c && !m->status; c = c->next) {
        SheenXml *target = sheen_mi_resolve(m, c);
        if (!target || strcmp(target->tag, "bsdf") != 0) continue;
        c->used = true;
        if (n < max)
            out[n++] = target;
        else if (!e->warned)
            sheen_xml_warn(m->log, c, "a further material inside '%s' is left out", sheen_mi_type(e));
    }
    return n;
}

static void warn_of_none(Mitsuba *m, const SheenXml *e)
{
    if (!m->status && !e->warned)
        sheen_xml_warn(m->log, e, "no material inside '%s': diffuse 0.5 stands in", sheen_mi_type(e));
}

/** Makes the only material inside e the first nested one of *out; the default stands in for none. */
static void read_nested(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    SheenXml *inside[1] = {NULL};
    if (nested_materials(m, e, inside, 1) == 0) warn_of_none(m, e);
    if (!m->status) out->nested[0] = sheen_mi_material(m, inside[0]);
}

// ---- sides ------------------------------------------------------------------------------------------------------

static bool has_two_sides(const SheenMaterial *material)
{
    return !material || material->has_two_sides || material->kind == SHEEN_MATERIAL_THIN_DIELECTRIC;
}

/** One material is copied and seen from both sides; two are the front and the back. */
void sheen_mi_twosided(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    SheenXml *inside[2];
    int n = nested_materials(m, e, inside, 2);
    if (n == 0) {
        warn_of_none(m, e);
        out->two_sided = true;
        return;
    }
    if (n == 2) {
        out->kind = SHEEN_MATERIAL_SIDES;
        out->nested[0] = sheen_mi_material(m, inside[0]);
        if (!m->status) out->nested[1] = sheen_mi_material(m, inside[1]);
        return;
    }
    sheen_mi_read_material(m, inside[0], out);
    if (m->status) return;
    const SheenMaterial *held =
        out->kind < SHEEN_MATERIAL_BLEND ? NULL : sheen_builder_material(m->builder, out->nested[0]);
    bool transmits = out->kind == SHEEN_MATERIAL_DIELECTRIC || out->kind == SHEEN_MATERIAL_THIN_DIELECTRIC ||
                     out->kind == SHEEN_MATERIAL_ROUGH_DIELECTRIC || (held && has_two_sides(held));
    if (!transmits)
        out->two_sided = true;
    else if (!e->warned)
        sheen_xml_warn(m->log, e, "a material that transmits has two sides already: 'twosided' ignored");
}

// ---- mixtures ---------------------------------------------------------------------------------------------------

void sheen_mi_blend(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    SheenXml *inside[2] = {NULL, NULL};
    int n = nested_materials(m, e, inside, 2);
    if (n < 2 && !m->status && !e->warned)
        sheen_xml_warn(m->log, e, "'%s' needs two materials: diffuse 0.5 stands in", sheen_mi_type(e));
    out->kind = SHEEN_MATERIAL_BLEND;
    out->weight = sheen_mi_factor(m, e, "weight", 0.5f, 0.0f, 1.0f);
    for (int i = 0; i < 2 && !m->status; ++i) out->nested[i] = sheen_mi_material(m, inside[i]);
}

/** Adds the blend of all before and one more. */
static uint32_t blend_with(Mitsuba *m, uint32_t all, uint32_t next, double share)
{
    SheenMaterial blend = sheen_mi_default_material();
    blend.kind = SHEEN_MATERIAL_BLEND;
    blend.nested[0] = all;
    blend.nested[1] = next;
    blend.weight = sheen_texture_constant(rgb_gray((float)share));
    blend.name = "mixturebsdf";
    return sheen_builder_add_material(m->builder, &blend);
}

/** A mixture of n is one of the first n - 1 and the last; what its weights lack to 1 is black. */
void sheen_mi_mixture(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    SheenXml *inside[MAX_NESTED];
    double weights[MAX_NESTED], sum = 0.0;
    int n = nested_materials(m, e, inside, MAX_NESTED);
    const char *text = sheen_mi_string(m, e, "weights", "");
    if (n == 0) {
        warn_of_none(m, e);
        return;
    }
    if (sheen_mi_numbers(text, MAX_NESTED, weights) != n) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "'weights' needs one number for each of %d materials, not '%.60s'", n,
                      text);
        return;
    }
    uint32_t all = SHEEN_NONE;
    for (int i = 0; i < n && !m->status; ++i) {
        double w = weights[i];
        if (!(w >= 0.0 && w <= 1e6)) {
            sheen_xml_warn(m->log, e, "the weight %g is not positive: taken as 0", w);
            w = 0.0;
        }
        uint32_t next = sheen_mi_material(m, inside[i]);
        if (m->status) return;
        sum += w;
        all = all == SHEEN_NONE ? next : blend_with(m, all, next, sum > 0.0 ? w / sum : 0.0);
    }
    if (sum > 1.0001 && !e->warned) sheen_xml_warn(m->log, e, "the weights sum to %g: scaled to 1", sum);
    if (sum >= 0.9999) {
        const SheenMaterial *whole = sheen_builder_material(m->builder, all);
        if (whole) *out = *whole;
        return;
    }
    SheenMaterial black = sheen_mi_default_material();
    black.reflectance = sheen_texture_constant(rgb_gray(0.0f));
    black.name = "black";
    out->kind = SHEEN_MATERIAL_BLEND;
    out->weight = sheen_texture_constant(rgb_gray((float)(1.0 - sum)));
    out->nested[0] = all;
    out->nested[1] = sheen_builder_add_material(m->builder, &black);
}

void sheen_mi_mask(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    out->kind = SHEEN_MATERIAL_MASK;
    out->weight = sheen_mi_factor(m, e, "opacity", 0.5f, 0.0f, 1.0f);
    if (sheen_texture_is_of_mesh(&out->weight)) { // shadow rays know the uv of what they pass, and no more
        sheen_xml_warn(m->log, e, "an opacity from a mesh's colours is not supported: 0.5 stands in");
        out->weight = sheen_texture_constant(out->weight.value);
    }
    read_nested(m, e, out);
}

// ---- maps -------------------------------------------------------------------------------------------------------

/** The texture of a map, whatever its name. @return false when there is none */
static bool read_map(Mitsuba *m, SheenXml *e, SheenTexture *out)
{
    SheenXml *texture = sheen_mi_nested(m, e, "texture");
    if (!texture) {
        if (!m->status && !e->warned) sheen_xml_warn(m->log, e, "'%s' has no texture and is ignored", sheen_mi_type(e));
        return false;
    }
    *out = sheen_mi_texture_of(m, texture, MITSUBA_INDEX, rgb_gray(0.0f));
    return true;
}

static void read_mapped(Mitsuba *m, SheenXml *e, SheenMaterialKind kind, SheenMaterial *out)
{
    SheenTexture map;
    float scale = (float)sheen_mi_float(m, e, "scale", 1.0);
    if (read_map(m, e, &map)) {
        out->kind = kind;
        out->map = map;
        out->map_scale = scale;
        // Since version 3; before, there was nothing of the kind.
        out->turn_normals = sheen_mi_bool(m, e, "flip_invalid_normals", m->version >= 3);
        out->shadow_normals = sheen_mi_bool(m, e, "use_shadowing_function", m->version >= 3);
        read_nested(m, e, out);
    } else if (!m->status) { // as if it were not there
        SheenXml *inside[1];
        if (nested_materials(m, e, inside, 1))
            sheen_mi_read_material(m, inside[0], out);
        else
            warn_of_none(m, e);
    }
}

void sheen_mi_bumpmap(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    read_mapped(m, e, SHEEN_MATERIAL_BUMP, out);
}

void sheen_mi_normalmap(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    read_mapped(m, e, SHEEN_MATERIAL_NORMAL, out);
}

// ---- coatings ---------------------------------------------------------------------------------------------------

void sheen_mi_coating(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    out->kind = SHEEN_MATERIAL_COATING;
    out->ior = sheen_mi_relative_ior(m, e, 1.5046);
    float thickness = (float)sheen_mi_float(m, e, "thickness", 1.0);
    out->absorption = rgb_scale(sheen_mi_color(m, e, "sigma_a", MITSUBA_INDEX, rgb_gray(0.0f)), thickness);
    out->specular_reflectance = sheen_mi_texture(m, e, "specular_reflectance", rgb_gray(1.0f));
    read_nested(m, e, out);
}

void sheen_mi_roughcoating(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    sheen_mi_coating(m, e, out);
    sheen_mi_roughness(m, e, out);
    out->kind = SHEEN_MATERIAL_ROUGH_COATING;
}
