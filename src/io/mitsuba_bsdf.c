// SPDX-License-Identifier: Apache-2.0
// Materials of Mitsuba scenes. What Sheen does not have is replaced by its nearest relative, with a warning.
#include "io/mitsuba.h"
#include "scene/metal.h"

#include <stdio.h>
#include <string.h>

typedef void ReadFn(Mitsuba *m, SheenXml *e, SheenMaterial *out);

typedef struct Plugin {
    const char *name;
    ReadFn *read;
    const char *stand_in; // what is used instead; NULL when the plugin is supported
} Plugin;

static void read_material(Mitsuba *m, SheenXml *e, SheenMaterial *out);

static SheenMaterial diffuse(Rgb reflectance)
{
    return (SheenMaterial){.kind = SHEEN_MATERIAL_DIFFUSE,
                           .reflectance = sheen_texture_constant(reflectance),
                           .specular_reflectance = sheen_texture_constant(rgb_gray(1.0f)),
                           .specular_transmittance = sheen_texture_constant(rgb_gray(1.0f)),
                           .ior = 1.0f};
}

static void read_diffuse(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    out->reflectance = sheen_mi_texture(m, e, "reflectance", rgb_gray(0.5f));
}

/** plastic, phong, ward: their diffuse part. */
static void read_diffuse_part(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    out->reflectance = sheen_mi_texture(m, e, "diffuse_reflectance", rgb_gray(0.5f));
}

static void read_gray(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    (void)m, (void)e, (void)out; // as it was made
}

// ---- refractive indices -----------------------------------------------------------------------------------------

typedef struct Medium {
    const char *name;
    double ior;
} Medium;

// At room temperature and about 589 nm, as Mitsuba's manual lists them.
static const Medium media[] = {
    {"vacuum", 1.0},      {"helium", 1.000036},        {"hydrogen", 1.000132},
    {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.3330},
    {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
    {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
    {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
    {"pyrex", 1.470},     {"acrylic glass", 1.49},     {"polypropylene", 1.49},
    {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
    {"pet", 1.5750},      {"diamond", 2.419},
};

/** A number, or the name of a medium. */
static double read_ior(Mitsuba *m, const SheenXml *e, const char *property, double otherwise)
{
    const SheenXml *c = sheen_mi_child(e, property);
    const char *text = c ? sheen_xml_attribute(c, "value") : NULL;
    double ior = otherwise;
    for (size_t i = 0; text && i < sizeof media / sizeof *media; ++i)
        if (sheen_mi_same(media[i].name, text)) return media[i].ior;
    if (c && (!text || sheen_mi_numbers(text, 1, &ior) != 1 || !(ior > 0.0 && ior < 1e6))) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, c, "'%s' is neither a positive number nor the name of a medium: '%.60s'",
                      property, text ? text : "");
        return otherwise;
    }
    return ior;
}

static void read_dielectric(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    out->kind = SHEEN_MATERIAL_DIELECTRIC;
    out->ior = (float)(read_ior(m, e, "int_ior", 1.5046) / read_ior(m, e, "ext_ior", 1.000277));
    out->specular_reflectance = sheen_mi_texture(m, e, "specular_reflectance", rgb_gray(1.0f));
    out->specular_transmittance = sheen_mi_texture(m, e, "specular_transmittance", rgb_gray(1.0f));
}

static void read_thin_dielectric(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    read_dielectric(m, e, out);
    out->kind = SHEEN_MATERIAL_THIN_DIELECTRIC;
}

static void read_null(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    (void)m, (void)e;
    out->kind = SHEEN_MATERIAL_THIN_DIELECTRIC;
    out->ior = 1.0f;
}

/** eta and k, or a material's name; without either Mitsuba 3 has a perfect mirror and 0.5 and 0.6 have copper. */
static void read_conductor(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    out->kind = SHEEN_MATERIAL_CONDUCTOR;
    const char *name = sheen_mi_string(m, e, "material", NULL);
    bool has_eta = sheen_mi_child(e, "eta") != NULL;
    if (!name) name = m->version == 0 && !has_eta ? "Cu" : "none";
    if (!sheen_metal_find(name, &out->eta, &out->k)) {
        sheen_xml_warn(m->log, e, "the metal '%s' is not known: copper stands in", name);
        (void)sheen_metal_find("Cu", &out->eta, &out->k);
    }
    out->eta = sheen_mi_color(m, e, "eta", MITSUBA_INDEX, out->eta);
    out->k = sheen_mi_color(m, e, "k", MITSUBA_INDEX, out->k);
    float outside = (float)read_ior(m, e, "ext_eta", m->version == 0 ? 1.000277 : 1.0);
    out->eta = rgb_scale(out->eta, 1.0f / outside);
    out->k = rgb_scale(out->k, 1.0f / outside);
    out->specular_reflectance = sheen_mi_texture(m, e, "specular_reflectance", rgb_gray(1.0f));
}

/** The mean of a property that is a number or a texture. */
static float read_mean(Mitsuba *m, SheenXml *e, const char *property, float otherwise)
{
    SheenTexture t = sheen_mi_texture(m, e, property, rgb_gray(otherwise));
    return rgb_luminance(sheen_texture_mean(&t));
}

static void read_principled(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    SheenTexture color = sheen_mi_texture(m, e, "base_color", rgb_gray(0.5f));
    if (read_mean(m, e, "metallic", 0.0f) > 0.5f) {
        out->kind = SHEEN_MATERIAL_CONDUCTOR;
        (void)sheen_metal_find("none", &out->eta, &out->k);
        out->specular_reflectance = color;
    } else if (read_mean(m, e, "spec_trans", 0.0f) > 0.5f) {
        out->kind = SHEEN_MATERIAL_DIELECTRIC;
        out->ior = (float)read_ior(m, e, "eta", 1.5);
        out->specular_transmittance = color;
    } else {
        out->reflectance = color;
    }
}

// ---- plugins that hold others -----------------------------------------------------------------------------------

static void read_nested(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    SheenXml *nested = sheen_mi_nested(m, e, "bsdf");
    if (nested)
        read_material(m, nested, out);
    else if (!m->status)
        sheen_xml_warn(m->log, e, "no material inside '%s': diffuse 0.5 stands in", sheen_mi_type(e));
}

static void read_two_sided(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    read_nested(m, e, out);
    if (out->kind == SHEEN_MATERIAL_DIELECTRIC || out->kind == SHEEN_MATERIAL_THIN_DIELECTRIC) {
        if (!e->warned)
            sheen_xml_warn(m->log, e, "a material that transmits has two sides already: 'twosided' ignored");
    } else {
        out->two_sided = true;
    }
}

static const Plugin plugins[] = {
    {"diffuse", read_diffuse, NULL},
    {"conductor", read_conductor, NULL},
    {"dielectric", read_dielectric, NULL},
    {"thindielectric", read_thin_dielectric, NULL},
    {"twosided", read_two_sided, NULL},
    {"roughdiffuse", read_diffuse, "a smooth diffuse surface"},
    {"roughconductor", read_conductor, "a smooth conductor"},
    {"roughdielectric", read_dielectric, "a smooth dielectric"},
    {"plastic", read_diffuse_part, "its diffuse part"},
    {"roughplastic", read_diffuse_part, "its diffuse part"},
    {"phong", read_diffuse_part, "its diffuse part"},
    {"ward", read_diffuse_part, "its diffuse part"},
    {"principled", read_principled, "a diffuse surface, a mirror or glass of its base colour"},
    {"principledthin", read_principled, "a diffuse surface of its base colour"},
    {"mask", read_nested, "the opaque material in it"},
    {"bumpmap", read_nested, "the smooth material in it"},
    {"bump", read_nested, "the smooth material in it"},
    {"normalmap", read_nested, "the smooth material in it"},
    {"coating", read_nested, "the material under the coating"},
    {"roughcoating", read_nested, "the material under the coating"},
    {"blendbsdf", read_nested, "the first material in it"},
    {"mixturebsdf", read_nested, "the first material in it"},
    {"null", read_null, "a pane of refractive index 1"},
};

static void read_material(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    static const Plugin unknown = {"", read_gray, "diffuse 0.5"};
    if (e->busy) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the material refers to itself");
        return;
    }
    e->busy = true;
    const char *type = sheen_mi_type(e);
    const Plugin *plugin = &unknown;
    for (size_t i = 0; i < sizeof plugins / sizeof *plugins; ++i)
        if (sheen_mi_same(plugins[i].name, type)) plugin = &plugins[i];
    plugin->read(m, e, out);
    if (plugin->stand_in && !e->warned)
        sheen_xml_warn(m->log, e, "the material '%s' is not supported: %s stands in", type, plugin->stand_in);
    if (!plugin->stand_in) sheen_mi_report_unused(m, e); // of a stand-in, much is unused
    e->warned = true;
    e->busy = false;
}

uint32_t sheen_mi_material(Mitsuba *m, SheenXml *bsdf)
{
    SheenMaterial material = diffuse(rgb_gray(0.5f));
    if (!bsdf) {
        // The default has no element; the root, never a material, remembers it.
        if (m->root->index == SHEEN_NONE) {
            material.name = "default";
            m->root->index = sheen_builder_add_material(m->builder, &material);
        }
        return m->root->index;
    }
    if (bsdf->index != SHEEN_NONE) return bsdf->index;
    read_material(m, bsdf, &material);
    const char *id = sheen_xml_attribute(bsdf, "id");
    material.name = sheen_arena_strdup(m->arena, id ? id : sheen_mi_type(bsdf));
    bsdf->index = sheen_builder_add_material(m->builder, &material);
    return bsdf->index;
}
