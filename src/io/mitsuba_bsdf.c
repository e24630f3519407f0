// SPDX-License-Identifier: Apache-2.0
// Materials of Mitsuba scenes. What Sheen does not have is replaced by its nearest relative, with a warning.
#include "io/mitsuba.h"
#include "scene/metal.h"

#include <stdio.h>
#include <string.h>

enum { MAX_DEPTH = 32 }; // of materials inside each other

typedef struct Plugin {
    const char *name;
    SheenMitsubaMaterialFn *read;
    const char *stand_in; // what is used instead; NULL when the plugin is supported
} Plugin;

SheenMaterial sheen_mi_default_material(void)
{
    return (SheenMaterial){.kind = SHEEN_MATERIAL_DIFFUSE,
                           .reflectance = sheen_texture_constant(rgb_gray(0.5f)),
                           .specular_reflectance = sheen_texture_constant(rgb_gray(1.0f)),
                           .specular_transmittance = sheen_texture_constant(rgb_gray(1.0f)),
                           .alpha_u = sheen_texture_constant(rgb_gray(0.1f)),
                           .alpha_v = sheen_texture_constant(rgb_gray(0.1f)),
                           .ior = 1.0f};
}

static void read_diffuse(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    out->reflectance = sheen_mi_texture(m, e, "reflectance", rgb_gray(0.5f));
}

static void read_rough_diffuse(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    out->kind = SHEEN_MATERIAL_ROUGH_DIFFUSE;
    bool named = sheen_mi_child(e, "reflectance") != NULL; // the manual's name; it takes the plastics' too
    out->reflectance = sheen_mi_texture(m, e, named ? "reflectance" : "diffuse_reflectance", rgb_gray(0.5f));
    out->alpha_u = sheen_mi_factor(m, e, "alpha", 0.2f, 0.0f, 10.0f);
    out->fast = sheen_mi_bool(m, e, "use_fast_approx", false);
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

float sheen_mi_relative_ior(Mitsuba *m, const SheenXml *e, double inside)
{
    return (float)(read_ior(m, e, "int_ior", inside) / read_ior(m, e, "ext_ior", 1.000277));
}

// ---- microfacets ------------------------------------------------------------------------------------------------

/** Distribution and roughness; alpha_u and alpha_v stand before alpha. */
void sheen_mi_roughness(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    const char *name = sheen_mi_string(m, e, "distribution", "beckmann");
    if (sheen_mi_same(name, "ggx"))
        out->distribution = SHEEN_DISTRIBUTION_GGX;
    else if (!sheen_mi_same(name, "beckmann") && !e->warned)
        sheen_xml_warn(m->log, e, "the distribution '%s' is not supported: 'beckmann' stands in", name);
    out->alpha_u = out->alpha_v = sheen_mi_factor(m, e, "alpha", 0.1f, SHEEN_ALPHA_MIN, SHEEN_ALPHA_MAX);
    if (sheen_mi_child(e, "alpha_u"))
        out->alpha_u = sheen_mi_factor(m, e, "alpha_u", 0.1f, SHEEN_ALPHA_MIN, SHEEN_ALPHA_MAX);
    if (sheen_mi_child(e, "alpha_v"))
        out->alpha_v = sheen_mi_factor(m, e, "alpha_v", 0.1f, SHEEN_ALPHA_MIN, SHEEN_ALPHA_MAX);
    sheen_mi_ignore(e, "sample_visible specular_sampling_weight"); // how Mitsuba draws samples
}

// ---- interfaces -------------------------------------------------------------------------------------------------

static void read_dielectric(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    out->kind = SHEEN_MATERIAL_DIELECTRIC;
    out->ior = sheen_mi_relative_ior(m, e, 1.5046);
    out->specular_reflectance = sheen_mi_texture(m, e, "specular_reflectance", rgb_gray(1.0f));
    out->specular_transmittance = sheen_mi_texture(m, e, "specular_transmittance", rgb_gray(1.0f));
}

static void read_rough_dielectric(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    read_dielectric(m, e, out);
    sheen_mi_roughness(m, e, out);
    out->kind = SHEEN_MATERIAL_ROUGH_DIELECTRIC;
}

static void read_thin_dielectric(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    read_dielectric(m, e, out);
    out->kind = SHEEN_MATERIAL_THIN_DIELECTRIC;
}

/** Passage without any change: a mask that is all hole. */
static void read_null(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    (void)e;
    out->kind = SHEEN_MATERIAL_MASK;
    out->weight = sheen_texture_constant(rgb_gray(0.0f));
    out->nested[0] = sheen_mi_material(m, NULL);
}

/** What polarization leaves of light that is not polarized: half goes through a polarizer, all through a retarder; each
 *  is a pane of the index of its surroundings. */
static void read_passage(Mitsuba *m, SheenXml *e, SheenMaterial *out, float share)
{
    out->kind = SHEEN_MATERIAL_THIN_DIELECTRIC;
    out->ior = 1.0f;
    out->specular_transmittance = sheen_mi_texture(m, e, "transmittance", rgb_gray(1.0f));
    sheen_texture_scale(&out->specular_transmittance, rgb_gray(share));
}

static void read_polarizer(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    read_passage(m, e, out, 0.5f);
}

static void read_retarder(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    read_passage(m, e, out, 1.0f);
}

static void read_difftrans(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    out->kind = SHEEN_MATERIAL_DIFFUSE_TRANSMIT;
    out->specular_transmittance = sheen_mi_texture(m, e, "transmittance", rgb_gray(0.5f));
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

static void read_rough_conductor(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    read_conductor(m, e, out);
    sheen_mi_roughness(m, e, out);
    out->kind = SHEEN_MATERIAL_ROUGH_CONDUCTOR;
}

static void read_plastic(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    out->kind = SHEEN_MATERIAL_PLASTIC;
    out->ior = sheen_mi_relative_ior(m, e, 1.49);
    out->reflectance = sheen_mi_texture(m, e, "diffuse_reflectance", rgb_gray(0.5f));
    out->specular_reflectance = sheen_mi_texture(m, e, "specular_reflectance", rgb_gray(1.0f));
    out->nonlinear = sheen_mi_bool(m, e, "nonlinear", false);
    sheen_mi_ignore(e, "specular_sampling_weight");
}

static void read_rough_plastic(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    read_plastic(m, e, out);
    sheen_mi_roughness(m, e, out);
    out->kind = SHEEN_MATERIAL_ROUGH_PLASTIC;
}

// ---- empirical models -------------------------------------------------------------------------------------------

/** Both parts together reflect no more than all, as far as that is known from constants. */
static void conserve_energy(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    SheenTexture *d = &out->reflectance, *s = &out->specular_reflectance;
    if (d->kind != SHEEN_TEXTURE_CONSTANT || s->kind != SHEEN_TEXTURE_CONSTANT) return;
    float sum = rgb_max(rgb_add(d->value, s->value));
    if (!(sum > 1.0f)) return;
    if (!e->warned)
        sheen_xml_warn(m->log, e, "the material reflects %g times the light: both parts are scaled down", (double)sum);
    d->value = rgb_scale(d->value, 0.99f / sum);
    s->value = rgb_scale(s->value, 0.99f / sum);
}

static void read_phong(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    out->kind = SHEEN_MATERIAL_PHONG;
    out->reflectance = sheen_mi_texture(m, e, "diffuse_reflectance", rgb_gray(0.5f));
    out->specular_reflectance = sheen_mi_texture(m, e, "specular_reflectance", rgb_gray(0.2f));
    const SheenTexture exponent = sheen_mi_factor(m, e, "exponent", 30.0f, 0.0f, 1e6f);
    if (exponent.kind == SHEEN_TEXTURE_BITMAP)
        sheen_xml_warn(m->log, e, "a textured exponent is not supported: its mean stands in");
    out->exponent = rgb_luminance(sheen_texture_mean(&exponent));
    conserve_energy(m, e, out);
}

static void read_ward(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    static const char *const names[] = {"balanced", "ward-duer", "ward"};
    out->kind = SHEEN_MATERIAL_WARD;
    out->reflectance = sheen_mi_texture(m, e, "diffuse_reflectance", rgb_gray(0.5f));
    out->specular_reflectance = sheen_mi_texture(m, e, "specular_reflectance", rgb_gray(0.2f));
    const char *variant = sheen_mi_string(m, e, "variant", "balanced");
    bool known = false;
    for (int i = 0; i < 3; ++i)
        if (sheen_mi_same(variant, names[i])) out->ward = (SheenWard)i, known = true;
    if (!known && !e->warned) sheen_xml_warn(m->log, e, "the variant '%s' is not known: 'balanced' stands in", variant);
    sheen_mi_roughness(m, e, out);
    conserve_energy(m, e, out);
}

// ---- principled -------------------------------------------------------------------------------------------------

/** The index from `eta`, or from `specular`, the reflectance at normal incidence over 0.08. */
static float principled_ior(Mitsuba *m, SheenXml *e, bool glass)
{
    bool has_eta = sheen_mi_child(e, "eta") != NULL;
    SheenXml *specular_child = sheen_mi_child(e, "specular");
    if (has_eta && specular_child && !e->warned)
        sheen_xml_warn(m->log, specular_child, "'specular' is ignored beside 'eta'");
    SheenTexture specular = sheen_mi_factor(m, e, "specular", 0.5f, 0.0f, 1.0f);
    float s = maxf(rgb_luminance(sheen_texture_mean(&specular)), glass ? 1e-3f : 0.0f);
    float eta = 2.0f / (1.0f - sqrtf(0.08f * s)) - 1.0f;
    if (has_eta) eta = (float)read_ior(m, e, "eta", 1.5);
    return glass && fabsf(eta - 1.0f) < 1e-3f ? 1.001f : eta;
}

/** A number, an index by name, or the mean of a texture. */
static float principled_thin_ior(Mitsuba *m, SheenXml *e)
{
    SheenXml *c = sheen_mi_child(e, "eta");
    SheenXml *value = c ? sheen_mi_resolve(m, c) : NULL;
    if (!value || strcmp(value->tag, "texture") != 0) return (float)read_ior(m, e, "eta", 1.5);
    SheenTexture t = sheen_mi_texture_of(m, value, MITSUBA_INDEX, rgb_gray(1.5f));
    return rgb_luminance(sheen_texture_mean(&t));
}

static void read_base(Mitsuba *m, SheenXml *e, SheenMaterial *out, bool thin)
{
    SheenPrincipled *p = SHEEN_ARENA_NEW(m->arena, SheenPrincipled, 1);
    if (!p) {
        sheen_mi_fail(m, SHEEN_ERR_NOMEM, e, "out of memory");
        return;
    }
    out->kind = thin ? SHEEN_MATERIAL_PRINCIPLED_THIN : SHEEN_MATERIAL_PRINCIPLED;
    out->principled = p;
    out->reflectance = sheen_mi_texture(m, e, "base_color", rgb_gray(0.5f));
    out->alpha_u = sheen_mi_factor(m, e, "roughness", 0.5f, 0.0f, 1.0f);
    const struct {
        const char *name;
        SheenTexture *texture;
    } numbers[] = {{"anisotropic", &p->anisotropic},
                   {"spec_trans", &p->spec_trans},
                   {"spec_tint", &p->spec_tint},
                   {"sheen", &p->sheen},
                   {"sheen_tint", &p->sheen_tint},
                   {"flatness", &p->flatness},
                   {"metallic", &p->metallic},
                   {"clearcoat", &p->clearcoat},
                   {"clearcoat_gloss", &p->clearcoat_gloss}};
    size_t n = sizeof numbers / sizeof *numbers, n_thin = 6;
    for (size_t i = 0; i < n; ++i)
        *numbers[i].texture = i < n_thin || !thin ? sheen_mi_factor(m, e, numbers[i].name, 0.0f, 0.0f, 1.0f)
                                                  : sheen_texture_constant(rgb_gray(0.0f));
    p->diff_trans = sheen_texture_constant(rgb_gray(0.0f));
    if (thin) p->diff_trans = sheen_mi_factor(m, e, "diff_trans", 0.0f, 0.0f, 2.0f);
    sheen_mi_ignore(e, "diffuse_reflectance_sampling_rate");
}

static void read_principled(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    read_base(m, e, out, false);
    out->ior = principled_ior(m, e, sheen_mi_child(e, "spec_trans") != NULL);
    sheen_mi_ignore(e, "main_specular_sampling_rate clearcoat_sampling_rate");
}

static void read_principled_thin(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    read_base(m, e, out, true);
    out->ior = principled_thin_ior(m, e);
    sheen_mi_ignore(e, "specular_reflectance_sampling_rate specular_transmittance_sampling_rate "
                       "diffuse_transmittance_sampling_rate");
}

// ---- what stands in for others ----------------------------------------------------------------------------------

/** Light that is scattered in a layer or below the surface: what part of it is not absorbed at each time. */
static void read_hk(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    Rgb one = rgb_gray(1.0f), s = rgb_gray(1.0f), a = rgb_gray(1.0f);
    if (sheen_mi_child(e, "albedo")) {
        out->reflectance = sheen_mi_texture(m, e, "albedo", one);
        return;
    }
    if (!sheen_mi_child(e, "sigma_s") || !sheen_mi_child(e, "sigma_a")) return;
    s = sheen_mi_color(m, e, "sigma_s", MITSUBA_INDEX, s);
    a = sheen_mi_color(m, e, "sigma_a", MITSUBA_INDEX, a);
    Rgb c = rgb(s.r / (s.r + a.r), s.g / (s.g + a.g), s.b / (s.b + a.b));
    out->reflectance = sheen_texture_constant(rgb_unit(c));
}

static void read_irawan(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    out->reflectance = sheen_mi_texture(m, e, "weft_kd", rgb_gray(0.5f));
}

static void read_hair(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    (void)m, (void)e;
    out->kind = SHEEN_MATERIAL_ROUGH_PLASTIC;
    out->ior = 1.55f; // of keratin
    out->reflectance = sheen_texture_constant(rgb(0.08f, 0.045f, 0.025f));
    out->alpha_u = out->alpha_v = sheen_texture_constant(rgb_gray(0.3f));
}

/** Smooth chrome, as the upgrade to version 0.4 made of it. */
static void read_mirror(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    out->kind = SHEEN_MATERIAL_CONDUCTOR;
    (void)sheen_metal_find("Cr", &out->eta, &out->k);
    out->specular_reflectance = sheen_mi_texture(m, e, "specular_reflectance", rgb_gray(1.0f));
}

// ---- all materials ----------------------------------------------------------------------------------------------

static const Plugin plugins[] = {
    {"diffuse", read_diffuse, NULL},
    {"conductor", read_conductor, NULL},
    {"dielectric", read_dielectric, NULL},
    {"thindielectric", read_thin_dielectric, NULL},
    {"roughconductor", read_rough_conductor, NULL},
    {"roughdielectric", read_rough_dielectric, NULL},
    {"plastic", read_plastic, NULL},
    {"roughplastic", read_rough_plastic, NULL},
    {"phong", read_phong, NULL},
    {"ward", read_ward, NULL},
    {"lafortune", sheen_mi_lafortune, NULL},
    {"principled", read_principled, NULL},
    {"difftrans", read_difftrans, NULL},
    {"null", read_null, NULL},
    {"twosided", sheen_mi_twosided, NULL},
    {"blendbsdf", sheen_mi_blend, NULL},
    {"mixturebsdf", sheen_mi_mixture, NULL},
    {"mask", sheen_mi_mask, NULL},
    {"bumpmap", sheen_mi_bumpmap, NULL},
    {"bump", sheen_mi_bumpmap, NULL},
    {"normalmap", sheen_mi_normalmap, NULL},
    {"coating", sheen_mi_coating, NULL},
    {"roughcoating", sheen_mi_roughcoating, NULL},
    {"roughdiffuse", read_rough_diffuse, NULL},
    {"principledthin", read_principled_thin, NULL},
    // What only has to do with polarization, or with more than a surface.
    {"pplastic", read_rough_plastic, "a 'roughplastic'"},
    {"polarizer", read_polarizer, "a grey filter"},
    {"circular", read_polarizer, "a grey filter"},
    {"retarder", read_retarder, "a clear filter"},
    {"hk", read_hk, "a diffuse surface of its albedo"},
    {"dipolebrdf", read_hk, "a diffuse surface of its albedo"},
    {"sssbrdf", read_hk, "a diffuse surface of its albedo"},
    {"irawan", read_irawan, "a diffuse surface of its yarns' colour"},
    {"hair", read_hair, "a rough dark plastic"},
    {"measured", read_gray, "diffuse 0.5"},
    {"measured_polarized", read_gray, "diffuse 0.5"},
    // What earlier versions called them, up to 0.3.
    {"lambertian", read_diffuse, NULL},
    {"mirror", read_mirror, NULL},
    {"roughmetal", read_rough_conductor, NULL},
    {"roughglass", read_rough_dielectric, NULL},
    {"microfacet", read_rough_plastic, NULL},
    {"composite", sheen_mi_mixture, NULL},
    {"mixture", sheen_mi_mixture, NULL},
    {"disney", read_principled, NULL},
    {"disneythin", read_principled_thin, NULL},
};

void sheen_mi_read_material(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    static const Plugin unknown = {"", read_gray, "diffuse 0.5"};
    if (e->busy) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the material refers to itself");
        return;
    }
    if (m->material_depth >= MAX_DEPTH) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "more than %d materials lie inside each other", MAX_DEPTH);
        return;
    }
    e->busy = true;
    ++m->material_depth;
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
    --m->material_depth;
}

uint32_t sheen_mi_material(Mitsuba *m, SheenXml *bsdf)
{
    SheenMaterial material = sheen_mi_default_material();
    if (!bsdf) {
        // The default has no element; the root, never a material, remembers it.
        if (m->root->index == SHEEN_NONE) {
            material.name = "default";
            m->root->index = sheen_builder_add_material(m->builder, &material);
        }
        return m->root->index;
    }
    if (bsdf->index != SHEEN_NONE) return bsdf->index;
    sheen_mi_read_material(m, bsdf, &material);
    if (m->status) return SHEEN_NONE;
    const char *id = sheen_xml_attribute(bsdf, "id");
    material.name = sheen_arena_strdup(m->arena, id ? id : sheen_mi_type(bsdf));
    bsdf->index = sheen_builder_add_material(m->builder, &material);
    return bsdf->index;
}

/** Adds a material once. @param kept  its index, counted from 1 */
static uint32_t add_once(Mitsuba *m, const SheenMaterial *material, uint32_t *kept)
{
    if (*kept == 0) {
        uint32_t index = sheen_builder_add_material(m->builder, material);
        if (index == SHEEN_NONE) return index;
        *kept = index + 1;
    }
    return *kept - 1;
}

uint32_t sheen_mi_lamp_material(Mitsuba *m)
{
    SheenMaterial material = sheen_mi_default_material();
    material.reflectance = sheen_texture_constant(rgb_gray(0.0f));
    material.name = "lamp";
    return add_once(m, &material, &m->lamp_material);
}

uint32_t sheen_mi_clear_material(Mitsuba *m)
{
    SheenMaterial material = sheen_mi_default_material();
    read_null(m, m->root, &material);
    material.name = "clear";
    return add_once(m, &material, &m->clear_material);
}
