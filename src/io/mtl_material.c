// SPDX-License-Identifier: Apache-2.0
#include "io/mtl_material.h"

#include "image/image.h"
#include "io/file_path.h"
#include "scene/metal.h"

#include <stdlib.h>
#include <string.h>

static SheenStatus no_memory(const MtlReader *r)
{
    return sheen_fail(r->log, SHEEN_ERR_NOMEM, "%s: out of memory", r->scene);
}

// ---- pictures ---------------------------------------------------------------------------------------------------

/** Beside the library, then beside the scene, as named and by the base name. @return NULL when it is nowhere. */
static const char *find_picture(const MtlReader *r, const MtlMaterial *m, const char *file)
{
    const char *slash = strrchr(file, '/');
    const char *names[2] = {file, slash ? slash + 1 : file}, *beside[2] = {m->library, r->scene};
    for (int i = 0; i < 4; ++i) {
        const char *path = sheen_path_beside(r->scratch, beside[i % 2], names[i / 2]);
        if (path && sheen_path_readable(path)) return path;
    }
    return NULL;
}

/** Bytes stay bytes when the factor is the same for all channels: it goes into the table. */
static SheenStatus read_bytes(const MtlReader *r, const char *path, Rgb factor, MtlUse use, SheenBitmap *out)
{
    uint8_t *pixels = NULL;
    SheenStatus s = SHEEN_OK;
    if (use == MTL_ALPHA || use == MTL_OPACITY)
        s = sheen_image_read_alpha(path, r->log, &out->width, &out->height, &pixels);
    if (!s && !pixels && use != MTL_ALPHA) s = sheen_image_read_bytes(path, r->log, &out->width, &out->height, &pixels);
    if (s || !pixels) return s;
    size_t size = 3 * (size_t)out->width * out->height;
    uint8_t *copy = sheen_arena_alloc(r->arena, size, 1);
    float *table = SHEEN_ARENA_NEW(r->arena, float, 256);
    if (copy) memcpy(copy, pixels, size);
    free(pixels);
    if (!copy || !table) return SHEEN_ERR_NOMEM;
    for (int i = 0; i < 256; ++i) {
        float x = (float)i / 255.0f;
        table[i] = factor.r * (use == MTL_COLOR ? sheen_srgb_decode(x) : x);
    }
    out->bytes = copy;
    out->decode = table;
    return SHEEN_OK;
}

static SheenStatus read_floats(const MtlReader *r, const char *path, Rgb factor, SheenBitmap *out)
{
    SheenImage image;
    SheenStatus s = sheen_image_read(path, r->log, &image);
    if (s) return s;
    size_t n = (size_t)image.width * image.height;
    Rgb *copy = SHEEN_ARENA_NEW(r->arena, Rgb, n);
    for (size_t i = 0; copy && i < n; ++i) copy[i] = rgb_mul(image.pixels[i], factor);
    *out = (SheenBitmap){.width = image.width, .height = image.height, .floats = copy};
    sheen_image_free(&image);
    return copy ? SHEEN_OK : SHEEN_ERR_NOMEM;
}

/** Formats of floats have no alpha that is read. */
static SheenStatus read_bitmap(const MtlReader *r, const char *path, Rgb factor, MtlUse use, SheenBitmap *out)
{
    if (sheen_image_is_8bit(path) && factor.r == factor.g && factor.g == factor.b)
        return read_bytes(r, path, factor, use, out);
    return use == MTL_ALPHA ? SHEEN_OK : read_floats(r, path, factor, out);
}

/** Reads a picture, once for all materials that use it alike. `out` is NULL when there is nothing to be read. */
static SheenStatus read_picture(MtlReader *r, const MtlMaterial *m, const char *file, Rgb factor, MtlUse use,
                                const SheenBitmap **out)
{
    *out = NULL;
    const char *path = find_picture(r, m, file);
    if (!path) {
        sheen_warn(r->log, "%s:%u: cannot open the picture '%s': the material does without", m->library, m->line, file);
        return SHEEN_OK;
    }
    for (const MtlPicture *p = r->pictures; p; p = p->next)
        if (strcmp(p->path, path) == 0 && p->use == use && memcmp(&p->factor, &factor, sizeof factor) == 0) {
            if (p->bitmap.bytes || p->bitmap.floats) *out = &p->bitmap;
            return SHEEN_OK;
        }
    MtlPicture *p = SHEEN_ARENA_NEW(r->scratch, MtlPicture, 1);
    if (!p) return no_memory(r);
    *p = (MtlPicture){.path = path, .factor = factor, .use = use, .next = r->pictures};
    SheenStatus s = read_bitmap(r, path, factor, use, &p->bitmap);
    if (s == SHEEN_ERR_NOMEM) return no_memory(r);
    if (s) return s; // the reader has reported the file
    r->pictures = p;
    if (p->bitmap.bytes || p->bitmap.floats) *out = &p->bitmap;
    return SHEEN_OK;
}

/** A picture times a factor, the factor alone where there is none. */
static SheenStatus read_texture(MtlReader *r, const MtlMaterial *m, const MtlMap *map, Rgb factor, MtlUse use,
                                SheenTexture *out)
{
    *out = sheen_texture_constant(factor);
    if (!map->file) return SHEEN_OK;
    const SheenBitmap *bitmap;
    SheenStatus s = read_picture(r, m, map->file, factor, use, &bitmap);
    if (s || !bitmap) return s;
    out->kind = SHEEN_TEXTURE_BITMAP;
    out->bitmap = *bitmap;
    out->wrap_u = out->wrap_v = map->clamp ? SHEEN_WRAP_CLAMP : SHEEN_WRAP_REPEAT;
    const float uv[2][3] = {{map->scale.x, 0.0f, map->offset.x}, {0.0f, map->scale.y, map->offset.y}};
    memcpy(out->uv, uv, sizeof uv);
    return SHEEN_OK;
}

// ---- materials --------------------------------------------------------------------------------------------------

static Rgb clamp_color(Rgb c)
{
    return rgb(clampf(c.r, 0.0f, 1.0f), clampf(c.g, 0.0f, 1.0f), clampf(c.b, 0.0f, 1.0f));
}

/** Kd times `scale`. Some exporters leave it black where a map gives the colour. */
static SheenStatus read_diffuse(MtlReader *r, const MtlMaterial *m, float scale, SheenTexture *out)
{
    Rgb color = clamp_color(m->diffuse);
    if (m->diffuse_map.file && rgb_is_black(color)) {
        SheenStatus s = read_texture(r, m, &m->diffuse_map, rgb_gray(scale), MTL_COLOR, out);
        if (out->kind == SHEEN_TEXTURE_CONSTANT) out->value = color;
        return s;
    }
    return read_texture(r, m, &m->diffuse_map, rgb_scale(color, scale), MTL_COLOR, out);
}

/**
 * Maya writes illum 4 for everything and 3ds Max an index for everything: each alone means nothing. Blender writes 9
 * for what is cut out by its alpha, and Tf for what refracts.
 */
static bool is_glass(const MtlMaterial *m)
{
    if (m->of_blender) return m->has_filter && rgb_max(m->filter) > 0.5f;
    bool clear = m->opacity < 0.05f && !m->opacity_map.file;
    bool index = (m->illum == 4 || m->illum == 9) && m->ior > 1.0f && m->opacity < 0.5f;
    return clear || index || m->illum == 6 || m->illum == 7;
}

/** Only the hue of Tf is taken: its strength is a weight beside Ks and Kd of models without Fresnel's reflection. */
static Rgb tint_of(const MtlMaterial *m)
{
    float strength = rgb_max(m->filter);
    return strength > 0.0f ? clamp_color(rgb_scale(m->filter, 1.0f / strength)) : rgb_gray(1.0f);
}

static void make_glass(const MtlMaterial *m, SheenMaterial *out)
{
    bool bends = m->ior > 1.0f;
    Rgb tint = tint_of(m);
    out->kind = bends ? SHEEN_MATERIAL_DIELECTRIC : SHEEN_MATERIAL_THIN_DIELECTRIC;
    out->ior = bends ? m->ior : 1.0f;
    // Light that crosses a body passes two surfaces, a pane only one.
    out->specular_transmittance =
        sheen_texture_constant(bends ? rgb(sqrtf(tint.r), sqrtf(tint.g), sqrtf(tint.b)) : tint);
}

static bool is_mirror(const MtlMaterial *m)
{
    return (m->illum == 3 || m->illum == 5) && rgb_max(m->specular) > rgb_max(m->diffuse);
}

static void make_mirror(const MtlMaterial *m, SheenMaterial *out)
{
    out->kind = SHEEN_MATERIAL_CONDUCTOR;
    (void)sheen_metal_find("none", &out->eta, &out->k);
    out->specular_reflectance = sheen_texture_constant(clamp_color(m->specular));
}

/** A number in [0, 1], or the picture in its place. */
static SheenStatus read_number(MtlReader *r, const MtlMaterial *m, const MtlMap *map, float value, SheenTexture *out)
{
    SheenStatus s = read_texture(r, m, map, rgb_gray(1.0f), MTL_NUMBERS, out);
    if (out->kind == SHEEN_TEXTURE_CONSTANT) out->value = rgb_gray(clampf(value, 0.0f, 1.0f));
    return s;
}

/** Pr and Pm, or what Blender hides in Ns and, for metal, in Ka: roughness 1 - sqrt(Ns / 1000), metallic share Ka. */
static SheenStatus make_principled(MtlReader *r, const MtlMaterial *m, SheenMaterial *out)
{
    SheenPrincipled *p = SHEEN_ARENA_NEW(r->arena, SheenPrincipled, 1);
    if (!p) return no_memory(r);
    const struct {
        SheenTexture *to;
        float value;
    } numbers[] = {{&p->anisotropic, m->anisotropy},
                   {&p->spec_trans, 0.0f},
                   {&p->spec_tint, 0.0f},
                   {&p->sheen, m->sheen},
                   {&p->sheen_tint, 0.0f},
                   {&p->flatness, 0.0f},
                   {&p->clearcoat, m->clearcoat},
                   {&p->clearcoat_gloss, 1.0f - m->clearcoat_roughness},
                   {&p->diff_trans, 0.0f}};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i)
        *numbers[i].to = sheen_texture_constant(rgb_gray(clampf(numbers[i].value, 0.0f, 1.0f)));
    bool metal = m->of_blender && (m->illum == 3 || m->illum == 6);
    float metallic = m->metallic >= 0.0f ? m->metallic : metal ? m->ambient.r : 0.0f;
    float roughness = m->roughness >= 0.0f ? m->roughness : 1.0f - sqrtf(clampf(m->shininess / 1000.0f, 0.0f, 1.0f));
    out->kind = SHEEN_MATERIAL_PRINCIPLED;
    out->principled = p;
    out->ior = 1.5f; // what Blender's specular level of 0.5 stands for
    // A map gives all of a number: what stands beside it is an exporter's default.
    SheenStatus s = read_number(r, m, &m->metallic_map, metallic, &p->metallic);
    if (!s) s = read_number(r, m, &m->roughness_map, roughness, &out->alpha_u);
    return s ? s : read_diffuse(r, m, 1.0f, &out->reflectance);
}

/** Both parts together reflect no more than all. */
static SheenStatus make_phong(MtlReader *r, const MtlMaterial *m, SheenMaterial *out)
{
    Rgb specular = clamp_color(m->specular);
    float sum = rgb_max(rgb_add(clamp_color(m->diffuse), specular)), scale = sum > 1.0f ? 0.99f / sum : 1.0f;
    out->kind = SHEEN_MATERIAL_PHONG;
    out->exponent = clampf(m->shininess, 0.0f, 1e5f);
    out->specular_reflectance = sheen_texture_constant(rgb_scale(specular, scale));
    return read_diffuse(r, m, scale, &out->reflectance);
}

/** The material without its opacity. */
static SheenStatus make_opaque(MtlReader *r, const MtlMaterial *m, SheenMaterial *out)
{
    if (is_glass(m)) {
        make_glass(m, out);
        return SHEEN_OK;
    }
    out->two_sided = true;
    bool physical = m->roughness >= 0.0f || m->metallic >= 0.0f || m->roughness_map.file || m->metallic_map.file;
    if (m->of_blender || physical) return make_principled(r, m, out);
    if (is_mirror(m)) {
        make_mirror(m, out);
        return SHEEN_OK;
    }
    if (m->illum >= 2 && m->shininess > 0.0f && !rgb_is_black(m->specular)) return make_phong(r, m, out);
    return read_diffuse(r, m, 1.0f, &out->reflectance);
}

static bool is_cut_out(const MtlMaterial *m)
{
    return (m->opacity < 1.0f || m->opacity_map.file) && !is_glass(m);
}

/** A map_d that is the colours' picture means its alpha alone. */
static MtlUse use_of_opacity(const MtlMaterial *m)
{
    const char *opacity = m->opacity_map.file, *colors = m->diffuse_map.file;
    return opacity && colors && strcmp(opacity, colors) == 0 ? MTL_ALPHA : MTL_OPACITY;
}

/** Puts the material *index under its opacity. */
static SheenStatus add_mask(MtlReader *r, const MtlMaterial *m, SheenMaterial *mask, uint32_t *index)
{
    if (*index == SHEEN_NONE) return SHEEN_OK; // the builder remembers the failure
    mask->kind = SHEEN_MATERIAL_MASK;
    mask->nested[0] = *index;
    SheenStatus s = read_texture(r, m, &m->opacity_map, rgb_gray(m->opacity), use_of_opacity(m), &mask->weight);
    bool opaque = mask->weight.kind == SHEEN_TEXTURE_CONSTANT && m->opacity >= 1.0f;
    if (!s && !opaque) *index = sheen_builder_add_material(r->builder, mask);
    return s;
}

/** Gives the material *index the normals of a picture. */
static SheenStatus add_normals(MtlReader *r, const MtlMaterial *m, SheenMaterial *normals, uint32_t *index)
{
    normals->kind = SHEEN_MATERIAL_NORMAL;
    normals->nested[0] = *index;
    normals->turn_normals = normals->shadow_normals = true;
    SheenStatus s = read_texture(r, m, &m->normal_map, rgb_gray(1.0f), MTL_NUMBERS, &normals->map);
    if (s || normals->map.kind == SHEEN_TEXTURE_CONSTANT || *index == SHEEN_NONE) return s;
    *index = sheen_builder_add_material(r->builder, normals);
    return SHEEN_OK;
}

SheenStatus sheen_mtl_add(MtlReader *r, const MtlMaterial *m, uint32_t *index)
{
    SheenMaterial material = {.kind = SHEEN_MATERIAL_DIFFUSE,
                              .reflectance = sheen_texture_constant(rgb_gray(0.5f)),
                              .specular_reflectance = sheen_texture_constant(rgb_gray(1.0f)),
                              .specular_transmittance = sheen_texture_constant(rgb_gray(1.0f)),
                              .ior = 1.0f,
                              .name = sheen_arena_strdup(r->arena, m->name)};
    if (!material.name) return no_memory(r);
    SheenMaterial normals = material, mask = material;
    SheenStatus s = make_opaque(r, m, &material);
    if (s) return s;
    *index = sheen_builder_add_material(r->builder, &material);
    if (m->normal_map.file && !is_glass(m)) s = add_normals(r, m, &normals, index);
    if (!s && is_cut_out(m)) s = add_mask(r, m, &mask, index);
    return s;
}
