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

MtlMaterial sheen_mtl_default(const char *name)
{
    return (MtlMaterial){.name = name,
                         .library = "",
                         .diffuse = rgb_gray(0.5f),
                         .filter = rgb_gray(1.0f),
                         .ior = 1.0f,
                         .opacity = 1.0f,
                         .illum = 2};
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
static SheenStatus read_bytes(const MtlReader *r, const char *path, Rgb factor, SheenBitmap *out)
{
    uint8_t *pixels;
    SheenStatus s = sheen_image_read_bytes(path, r->log, &out->width, &out->height, &pixels);
    if (s) return s;
    size_t size = 3 * (size_t)out->width * out->height;
    uint8_t *copy = sheen_arena_alloc(r->arena, size, 1);
    float *table = SHEEN_ARENA_NEW(r->arena, float, 256);
    if (copy) memcpy(copy, pixels, size);
    free(pixels);
    if (!copy || !table) return SHEEN_ERR_NOMEM;
    for (int i = 0; i < 256; ++i) table[i] = factor.r * sheen_srgb_decode((float)i / 255.0f);
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

/** Reads a picture, once for all materials that show it alike. `out` is NULL when there is none to be read. */
static SheenStatus read_picture(MtlReader *r, const MtlMaterial *m, const char *file, Rgb factor,
                                const SheenBitmap **out)
{
    *out = NULL;
    const char *path = find_picture(r, m, file);
    if (!path) {
        sheen_warn(r->log, "%s:%u: cannot open the picture '%s': the material's colour stands in", m->library, m->line,
                   file);
        return SHEEN_OK;
    }
    for (const MtlPicture *p = r->pictures; p; p = p->next)
        if (strcmp(p->path, path) == 0 && p->factor.r == factor.r && p->factor.g == factor.g &&
            p->factor.b == factor.b) {
            *out = &p->bitmap;
            return SHEEN_OK;
        }
    MtlPicture *p = SHEEN_ARENA_NEW(r->scratch, MtlPicture, 1);
    if (!p) return no_memory(r);
    *p = (MtlPicture){.path = path, .factor = factor, .next = r->pictures};
    bool bytes = sheen_image_is_8bit(path) && factor.r == factor.g && factor.g == factor.b;
    SheenStatus s = bytes ? read_bytes(r, path, factor, &p->bitmap) : read_floats(r, path, factor, &p->bitmap);
    if (s == SHEEN_ERR_NOMEM) return no_memory(r);
    if (s) return s; // the reader has reported the file
    r->pictures = p;
    *out = &p->bitmap;
    return SHEEN_OK;
}

// ---- materials --------------------------------------------------------------------------------------------------

static Rgb clamp_color(Rgb c)
{
    return rgb(clampf(c.r, 0.0f, 1.0f), clampf(c.g, 0.0f, 1.0f), clampf(c.b, 0.0f, 1.0f));
}

static SheenStatus read_diffuse(MtlReader *r, const MtlMaterial *m, SheenTexture *out)
{
    Rgb color = clamp_color(m->diffuse);
    *out = sheen_texture_constant(color);
    const MtlMap *map = &m->diffuse_map;
    if (!map->file) return SHEEN_OK;
    const SheenBitmap *bitmap;
    // Some exporters leave Kd black where a map gives the colour.
    SheenStatus s = read_picture(r, m, map->file, rgb_is_black(color) ? rgb_gray(1.0f) : color, &bitmap);
    if (s || !bitmap) return s;
    out->kind = SHEEN_TEXTURE_BITMAP;
    out->bitmap = *bitmap;
    out->wrap = map->clamp ? SHEEN_WRAP_CLAMP : SHEEN_WRAP_REPEAT;
    const float uv[2][3] = {{map->scale.x, 0.0f, map->offset.x}, {0.0f, map->scale.y, map->offset.y}};
    memcpy(out->uv, uv, sizeof uv);
    return SHEEN_OK;
}

/** Maya writes illum 4 for everything and 3ds Max an index for everything: each alone means nothing. */
static bool lets_light_through(const MtlMaterial *m)
{
    bool clear = m->opacity < 0.05f && !m->opacity_map.file;
    return clear || m->illum == 6 || m->illum == 7 ||
           ((m->illum == 4 || m->illum == 9) && m->ior > 1.0f && m->opacity < 1.0f);
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

static void make_mirror(const MtlMaterial *m, SheenMaterial *out)
{
    out->kind = SHEEN_MATERIAL_CONDUCTOR;
    out->two_sided = true;
    (void)sheen_metal_find("none", &out->eta, &out->k);
    out->specular_reflectance = sheen_texture_constant(clamp_color(m->specular));
}

SheenStatus sheen_mtl_convert(MtlReader *r, const MtlMaterial *m, SheenMaterial *out)
{
    *out = (SheenMaterial){.kind = SHEEN_MATERIAL_DIFFUSE,
                           .reflectance = sheen_texture_constant(clamp_color(m->diffuse)),
                           .specular_reflectance = sheen_texture_constant(rgb_gray(1.0f)),
                           .specular_transmittance = sheen_texture_constant(rgb_gray(1.0f)),
                           .ior = 1.0f,
                           .name = sheen_arena_strdup(r->arena, m->name)};
    if (!out->name) return no_memory(r);
    if (lets_light_through(m)) {
        make_glass(m, out);
        return SHEEN_OK;
    }
    if ((m->illum == 3 || m->illum == 5) && rgb_max(m->specular) > rgb_max(m->diffuse)) {
        make_mirror(m, out);
        return SHEEN_OK;
    }
    out->two_sided = true;
    if (m->opacity < 1.0f || m->opacity_map.file)
        sheen_warn(r->log, "%s:%u: the material '%s' is partly transparent: an opaque one stands in", m->library,
                   m->line, m->name);
    r->n_highlights += !rgb_is_black(m->specular);
    return read_diffuse(r, m, &out->reflectance);
}
