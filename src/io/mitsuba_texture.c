// SPDX-License-Identifier: Apache-2.0
// Textures of Mitsuba scenes.
#include "image/image.h"
#include "io/mitsuba.h"

#include <stdlib.h>
#include <string.h>

// ---- pictures ---------------------------------------------------------------------------------------------------

/** From byte to linear value. @param gamma  0: the sRGB curve, else the exponent */
static const float *decode_table(SheenArena *arena, double gamma)
{
    float *table = SHEEN_ARENA_NEW(arena, float, 256);
    for (int i = 0; table && i < 256; ++i) {
        float x = (float)i / 255.0f;
        table[i] = gamma == 0.0 ? sheen_srgb_decode(x) : gamma == 1.0 ? x : (float)pow((double)x, gamma);
    }
    return table;
}

static SheenStatus read_bytes(Mitsuba *m, const char *path, double gamma, SheenBitmap *out)
{
    uint8_t *pixels = NULL;
    SheenStatus s = sheen_image_read_bytes(path, m->log, &out->width, &out->height, &pixels);
    if (s) return s;
    size_t size = 3 * (size_t)out->width * out->height;
    uint8_t *copy = sheen_arena_alloc(m->arena, size, 1);
    out->decode = decode_table(m->arena, gamma);
    if (copy) memcpy(copy, pixels, size);
    out->bytes = copy;
    free(pixels);
    return copy && out->decode ? SHEEN_OK : SHEEN_ERR_NOMEM;
}

static SheenStatus read_floats(Mitsuba *m, const char *path, SheenBitmap *out)
{
    SheenImage image;
    SheenStatus s = sheen_image_read(path, m->log, &image);
    if (s) return s;
    size_t n = (size_t)image.width * image.height;
    Rgb *copy = SHEEN_ARENA_NEW(m->arena, Rgb, n);
    if (copy) memcpy(copy, image.pixels, n * sizeof *copy);
    *out = (SheenBitmap){.width = image.width, .height = image.height, .floats = copy};
    sheen_image_free(&image);
    return copy ? SHEEN_OK : SHEEN_ERR_NOMEM;
}

bool sheen_mi_bitmap(Mitsuba *m, const SheenXml *e, bool floats, double gamma, SheenBitmap *out)
{
    *out = (SheenBitmap){0};
    const char *path = sheen_mi_path(m, e, "filename", "picture");
    if (!path) return false;
    floats = floats || !sheen_image_is_8bit(path);
    for (const MitsubaBitmap *b = m->bitmaps; b; b = b->next)
        if (b->floats == floats && b->gamma == gamma && strcmp(b->path, path) == 0) {
            *out = b->bitmap;
            return true;
        }
    MitsubaBitmap *b = SHEEN_ARENA_NEW(m->scratch, MitsubaBitmap, 1);
    SheenStatus s = SHEEN_ERR_NOMEM;
    if (b) {
        *b = (MitsubaBitmap){.path = path, .floats = floats, .gamma = gamma, .next = m->bitmaps};
        s = floats ? read_floats(m, path, &b->bitmap) : read_bytes(m, path, gamma, &b->bitmap);
    }
    if (s == SHEEN_ERR_NOMEM)
        sheen_mi_fail(m, s, e, "out of memory for the picture '%s'", path);
    else if (s && !m->status)
        m->status = s; // the reader has reported the file
    if (m->status) return false;
    m->bitmaps = b;
    *out = b->bitmap;
    return true;
}

// ---- textures ---------------------------------------------------------------------------------------------------

/**
 * Scale, offset and to_uv. Mitsuba's v runs downward in a picture and Sheen's upward, v = 1 - v_mitsuba, so that the
 * map is conjugated with that reflection.
 */
static void read_uv_map(Mitsuba *m, const SheenXml *e, SheenTexture *out)
{
    Transform t = sheen_mi_transform(m, e, "to_uv");
    double scale = sheen_mi_float(m, e, "uvscale", 1.0);
    double su = sheen_mi_float(m, e, "uscale", scale), sv = sheen_mi_float(m, e, "vscale", scale);
    t = transform_mul(transform_scale(su, sv, 1.0), t);
    t = transform_mul(
        transform_translate(sheen_mi_float(m, e, "uoffset", 0.0), sheen_mi_float(m, e, "voffset", 0.0), 0), t);
    const Transform flip = {{{1, 0, 0, 0}, {0, -1, 0, 1}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    t = transform_mul(transform_mul(flip, t), flip);
    for (int i = 0; i < 2; ++i) {
        out->uv[i][0] = (float)t.m[i][0];
        out->uv[i][1] = (float)t.m[i][1];
        out->uv[i][2] = (float)t.m[i][3];
    }
}

static SheenWrap wrap_of(Mitsuba *m, const SheenXml *e, const char *name)
{
    if (sheen_mi_same(name, "mirror")) return SHEEN_WRAP_MIRROR;
    if (sheen_mi_same(name, "clamp")) return SHEEN_WRAP_CLAMP;
    if (!sheen_mi_same(name, "repeat") && !e->warned)
        sheen_xml_warn(m->log, e, "the wrap mode '%s' is not supported: 'repeat' stands in", name);
    return SHEEN_WRAP_REPEAT;
}

/** Makes a picture one of its channels, gray, as version 0.6 may ask. @return false when out of memory */
static bool take_channel(Mitsuba *m, const SheenXml *e, const char *name, SheenBitmap *b)
{
    static const char *const names[] = {"r", "g", "b"};
    int c = 0;
    while (c < 3 && !sheen_mi_same(name, names[c])) ++c;
    if (c == 3) {
        sheen_xml_warn(m->log, e, "the channel '%s' of a picture is not supported: its colours stand in", name);
        return true;
    }
    size_t n = (size_t)b->width * b->height;
    uint8_t *bytes = b->bytes ? sheen_arena_alloc(m->arena, n, 3) : NULL;
    Rgb *floats = b->floats ? SHEEN_ARENA_NEW(m->arena, Rgb, n) : NULL;
    if (!bytes && !floats) {
        sheen_mi_fail(m, SHEEN_ERR_NOMEM, e, "out of memory");
        return false;
    }
    for (size_t i = 0; bytes && i < n; ++i) memset(bytes + 3 * i, b->bytes[3 * i + (size_t)c], 3);
    for (size_t i = 0; floats && i < n; ++i)
        floats[i] = rgb_gray(c == 0 ? b->floats[i].r : c == 1 ? b->floats[i].g : b->floats[i].b);
    b->bytes = bytes, b->floats = floats;
    return true;
}

static SheenTexture read_bitmap(Mitsuba *m, const SheenXml *e)
{
    SheenTexture t = sheen_texture_constant(rgb_gray(0.5f));
    // Version 0.6 has a gamma, -1 for sRGB; 2 and 3 have a flag for data that is not colour.
    double gamma = sheen_mi_float(m, e, "gamma", -1.0);
    if (sheen_mi_bool(m, e, "raw", false)) gamma = 1.0;
    if (!sheen_mi_bitmap(m, e, false, gamma > 0.0 ? gamma : 0.0, &t.bitmap)) return t;
    t.kind = SHEEN_TEXTURE_BITMAP;
    const char *channel = sheen_mi_string(m, e, "channel", NULL);
    if (channel && !take_channel(m, e, channel, &t.bitmap)) return t;
    const char *filter = sheen_mi_string(m, e, "filter_type", "bilinear");
    t.nearest = sheen_mi_same(filter, "nearest");
    // Version 0.6 may give a mode for each coordinate.
    const char *wrap = sheen_mi_string(m, e, "wrap_mode", "repeat");
    t.wrap_u = wrap_of(m, e, sheen_mi_string(m, e, "wrap_mode_u", wrap));
    t.wrap_v = wrap_of(m, e, sheen_mi_string(m, e, "wrap_mode_v", wrap));
    read_uv_map(m, e, &t);
    sheen_mi_ignore(e, "max_anisotropy cache format accel"); // how Mitsuba filters and stores
    return t;
}

/** Turning v round swaps the fields, so that Mitsuba's second colour is our first. */
static SheenTexture read_checkerboard(Mitsuba *m, const SheenXml *e)
{
    SheenTexture t = sheen_texture_constant(sheen_mi_color(m, e, "color1", MITSUBA_REFLECTANCE, rgb_gray(0.2f)));
    t.kind = SHEEN_TEXTURE_CHECKERBOARD;
    t.value2 = sheen_mi_color(m, e, "color0", MITSUBA_REFLECTANCE, rgb_gray(0.4f));
    read_uv_map(m, e, &t);
    return t;
}

/** Version 0.6's lines along the borders of the unit squares of uv; they lie the same with v turned round. */
static SheenTexture read_grid(Mitsuba *m, const SheenXml *e)
{
    SheenTexture t = sheen_texture_constant(sheen_mi_color(m, e, "color0", MITSUBA_REFLECTANCE, rgb_gray(0.2f)));
    t.kind = SHEEN_TEXTURE_GRID;
    t.value2 = sheen_mi_color(m, e, "color1", MITSUBA_REFLECTANCE, rgb_gray(0.4f));
    double width = sheen_mi_float(m, e, "line_width", 0.01);
    if (!(width >= 0.0 && width <= 0.5))
        sheen_mi_fail(m, SHEEN_ERR_PARSE, sheen_mi_child(e, "line_width"),
                      "the lines of a grid must be 0 to 0.5 wide to each side, not %g", width);
    t.line_width = (float)width;
    read_uv_map(m, e, &t);
    return t;
}

/** Colours of the mesh: gray where a mesh has none, as Mitsuba has no answer to that. */
static SheenTexture read_mesh_attribute(Mitsuba *m, const SheenXml *e)
{
    SheenTexture t = sheen_texture_constant(rgb_gray(0.5f));
    const char *name = sheen_mi_string(m, e, "name", "vertex_color");
    if (sheen_mi_same(name, "vertex_color"))
        t.kind = SHEEN_TEXTURE_VERTEX_COLOR;
    else if (sheen_mi_same(name, "face_color"))
        t.kind = SHEEN_TEXTURE_FACE_COLOR;
    else if (!e->warned)
        sheen_xml_warn(m->log, e, "the mesh attribute '%s' is not supported: gray 0.5 stands in", name);
    float scale = (float)sheen_mi_float(m, e, "scale", 1.0);
    sheen_texture_scale(&t, rgb_gray(scale));
    return t;
}

static SheenTexture read_texture(Mitsuba *m, SheenXml *e);

/** Another texture times a factor. */
static SheenTexture read_scale(Mitsuba *m, SheenXml *e)
{
    SheenXml *nested = sheen_mi_nested(m, e, "texture");
    Rgb factor = sheen_mi_color(m, e, "scale", MITSUBA_REFLECTANCE, rgb_gray(1.0f));
    SheenTexture t = sheen_texture_constant(rgb_gray(0.5f));
    if (!nested && sheen_mi_child(e, "value")) {
        t.value = sheen_mi_color(m, e, "value", MITSUBA_INDEX, t.value);
    } else if (!nested) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the texture 'scale' holds no texture");
    } else if (nested->busy) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the texture refers to itself");
    } else {
        nested->busy = true;
        t = read_texture(m, nested);
        nested->busy = false;
    }
    sheen_texture_scale(&t, factor);
    return t;
}

/** In version 3 spectra are textures without a pattern, and a wire frame is mostly what lies between its wires. */
static bool read_constant(Mitsuba *m, SheenXml *e, SheenTexture *out)
{
    static const char *const spectra[] = {"uniform",   "d65",     "rgb",       "srgb",
                                          "blackbody", "regular", "irregular", "rawconstant"};
    for (size_t i = 0; i < sizeof spectra / sizeof *spectra; ++i)
        if (sheen_mi_same(sheen_mi_type(e), spectra[i])) {
            bool busy = e->busy; // the caller's mark, not a circle
            e->busy = false;
            *out = sheen_texture_constant(sheen_mi_color_of(m, e, MITSUBA_REFLECTANCE));
            e->busy = busy;
            return true;
        }
    if (!sheen_mi_same(sheen_mi_type(e), "wireframe")) return false;
    *out = sheen_texture_constant(sheen_mi_color(m, e, "interior_color", MITSUBA_REFLECTANCE, rgb_gray(0.5f)));
    if (!e->warned) sheen_xml_warn(m->log, e, "the texture 'wireframe' is not supported: its inner colour stands in");
    e->warned = true;
    sheen_mi_ignore(e, "edge_color line_width step_width");
    return true;
}

static SheenTexture read_texture(Mitsuba *m, SheenXml *e)
{
    const char *type = sheen_mi_type(e);
    SheenTexture t;
    if (sheen_mi_same(type, "bitmap")) {
        t = read_bitmap(m, e);
    } else if (sheen_mi_same(type, "checkerboard")) {
        t = read_checkerboard(m, e);
    } else if (sheen_mi_same(type, "gridtexture")) {
        t = read_grid(m, e);
    } else if (sheen_mi_same(type, "mesh_attribute")) {
        t = read_mesh_attribute(m, e);
    } else if (sheen_mi_same(type, "vertexcolors")) { // version 0.5
        t = sheen_texture_constant(rgb_gray(0.5f));
        t.kind = SHEEN_TEXTURE_VERTEX_COLOR;
    } else if (sheen_mi_same(type, "scale")) {
        t = read_scale(m, e);
    } else if (read_constant(m, e, &t)) {
        return t;
    } else {
        SheenXml *nested = sheen_mi_nested(m, e, "texture");
        if (!e->warned)
            sheen_xml_warn(m->log, e, "the texture '%s' is not supported: %s stands in", type,
                           nested ? "the texture in it" : "gray 0.5");
        e->warned = true;
        if (!nested || nested->busy) {
            if (nested) sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the texture refers to itself");
            return sheen_texture_constant(rgb_gray(0.5f));
        }
        nested->busy = true;
        t = read_texture(m, nested);
        nested->busy = false;
        return t;
    }
    sheen_mi_report_unused(m, e);
    return t;
}

static Rgb clamped(Mitsuba *m, const SheenXml *at, Rgb c)
{
    Rgb r = rgb(clampf(c.r, 0.0f, 1.0f), clampf(c.g, 0.0f, 1.0f), clampf(c.b, 0.0f, 1.0f));
    if (r.r != c.r || r.g != c.g || r.b != c.b)
        sheen_xml_warn(m->log, at, "the reflectance %g %g %g is outside [0, 1] and is clamped", (double)c.r,
                       (double)c.g, (double)c.b);
    return r;
}

SheenTexture sheen_mi_texture_of(Mitsuba *m, SheenXml *value, MitsubaColor kind, Rgb otherwise)
{
    value->used = true;
    bool clamps = kind == MITSUBA_REFLECTANCE;
    if (strcmp(value->tag, "texture") != 0) {
        Rgb c = sheen_mi_color_of(m, value, kind);
        return sheen_texture_constant(clamps ? clamped(m, value, c) : c);
    }
    if (value->busy) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, value, "the texture refers to itself");
        return sheen_texture_constant(otherwise);
    }
    value->busy = true;
    SheenTexture t = read_texture(m, value);
    value->busy = false;
    if (clamps && t.kind != SHEEN_TEXTURE_BITMAP) t.value = clamped(m, value, t.value);
    if (clamps && sheen_texture_has_two_values(&t)) t.value2 = clamped(m, value, t.value2);
    return t;
}

SheenTexture sheen_mi_texture(Mitsuba *m, const SheenXml *e, const char *name, Rgb otherwise)
{
    SheenXml *c = sheen_mi_child(e, name);
    SheenXml *value = c ? sheen_mi_resolve(m, c) : NULL;
    return value ? sheen_mi_texture_of(m, value, MITSUBA_REFLECTANCE, otherwise) : sheen_texture_constant(otherwise);
}

SheenTexture sheen_mi_factor(Mitsuba *m, const SheenXml *e, const char *name, float otherwise, float lo, float hi)
{
    SheenXml *c = sheen_mi_child(e, name);
    SheenXml *value = c ? sheen_mi_resolve(m, c) : NULL;
    if (!value) return sheen_texture_constant(rgb_gray(otherwise));
    if (strcmp(value->tag, "float") != 0 && strcmp(value->tag, "integer") != 0)
        return sheen_mi_texture_of(m, value, hi > 1.0f ? MITSUBA_INDEX : MITSUBA_REFLECTANCE, rgb_gray(otherwise));
    value->used = true;
    float x = (float)sheen_mi_float(m, e, name, (double)otherwise), good = clampf(x, lo, hi);
    if (good != x)
        sheen_xml_warn(m->log, c, "'%s' is %g, outside [%g, %g]: taken as %g", name, (double)x, (double)lo, (double)hi,
                       (double)good);
    return sheen_texture_constant(rgb_gray(good));
}
