// SPDX-License-Identifier: Apache-2.0
#include "compare_layers.h"

#include "picture_base64.h"

#include <stdlib.h>
#include <string.h>

/** What a layer of this program is, for its legend. Those of others go without. */
typedef struct LayerNote {
    const char *name, *unit, *note;
} LayerNote;

static const LayerNote notes[] = {
    {"depth", "m", "distance of the first surface"},
    {"position", "m", "of the first surface"},
    {"normal", "", "of the first surface"},
    {"uv", "", "of the first surface"},
    {"primitive", "", "X shape, Y triangle, Z instance"},
    {"albedo", "", "of the first surface"},
    {"direct", "", "emitted, specular and direct light"},
    {"indirect", "", "light from the cache, or of longer paths"},
    {"records", "", "white: irradiance records, orange: radiance records"},
    {"accuracy", "", "a of the records, smaller is finer"},
    {"coverage", "records", "that contribute, in the mean"},
    {"error", "", "expected of the records' light, relative"},
    {"transport", "", "red: radiance records, green: irradiance records, blue: rays along mirrors, glass, gloss"},
};
enum { n_notes = sizeof notes / sizeof notes[0] };

static const LayerNote *note_of(const char *layer)
{
    static const LayerNote none = {"", "", ""};
    for (int i = 0; i < n_notes; ++i)
        if (strcmp(notes[i].name, layer) == 0) return &notes[i];
    return &none;
}

/** What the elements of one file have in common. */
typedef struct LayerPage {
    const char *role, *page;
    const SheenLog *log;
    uint32_t width, height;
    Rgb *pixels; // [height][width], scratch
    TextBuffer *out;
} LayerPage;

static void add_attribute(TextBuffer *out, const char *name, const char *value)
{
    text_add_format(out, " data-%s=\"", name);
    text_add_escaped(out, value);
    text_add(out, "\"");
}

static SheenStatus add_pixels(const LayerPage *p, const char *format)
{
    return picture_base64_add(format, p->width, p->height, p->pixels, p->page, p->log, p->out);
}

static SheenStatus add_color(const LayerPage *p, const SheenImageLayer *layer)
{
    memcpy(p->pixels, layer->data, (size_t)p->width * p->height * sizeof *p->pixels);
    text_add_format(p->out, "<script type=\"text/plain\" class=\"%s-layer\" data-kind=\"color\"", p->role);
    add_attribute(p->out, "name", layer->name);
    text_add(p->out, " data-label=\"");
    text_add_escaped(p->out, layer->name);
    text_add(p->out, " (RGB)\"");
    add_attribute(p->out, "note", note_of(layer->name)->note);
    text_add(p->out, ">");
    SheenStatus status = add_pixels(p, "layer.hdr");
    text_add(p->out, "</script>\n");
    return status;
}

/** Finds the least and the largest finite value of a channel; both 0 where there is none. */
static void find_range(const float *first, size_t stride, size_t n, float *min, float *max)
{
    bool any = false;
    *min = *max = 0.0f;
    for (size_t i = 0; i < n; ++i) {
        float x = first[i * stride];
        if (!isfinite(x)) continue;
        *min = any ? minf(*min, x) : x;
        *max = any ? maxf(*max, x) : x;
        any = true;
    }
}

/** @return the byte for a value: its place in [min, max], in double, as the range of floats may not be one. */
static unsigned quantize(float x, float min, float max)
{
    if (!isfinite(x)) return 0;
    double width = (double)max - (double)min;
    return width > 0.0 ? 1 + (unsigned)(254.0 * (((double)x - (double)min) / width) + 0.5) : 1;
}

static SheenStatus add_channel(const LayerPage *p, const SheenImageLayer *layer, unsigned channel)
{
    const LayerNote *note = note_of(layer->name);
    const char *name = layer->channels[channel], *dot = strrchr(name, '.');
    const float *first = layer->data + channel;
    size_t n = (size_t)p->width * p->height;
    float min, max, byte[256];
    find_range(first, layer->n_channels, n, &min, &max);
    for (int i = 0; i < 256; ++i) byte[i] = sheen_srgb_decode((float)i / 255.0f); // the PNG's curve turns it back
    for (size_t i = 0; i < n; ++i) p->pixels[i] = rgb_gray(byte[quantize(first[i * layer->n_channels], min, max)]);
    text_add_format(p->out, "<img hidden alt=\"\" class=\"%s-layer\" data-kind=\"data\"", p->role);
    add_attribute(p->out, "name", name);
    text_add(p->out, " data-label=\"");
    if (layer->n_channels == 1 && dot) { // "depth (Z)" reads better than "depth.Z"
        text_add_escaped(p->out, layer->name);
        text_add(p->out, " (");
        text_add_escaped(p->out, dot + 1);
        text_add(p->out, ")");
    } else {
        text_add_escaped(p->out, name);
    }
    text_add_format(p->out, "\" data-min=\"%.9g\" data-max=\"%.9g\"", (double)min, (double)max);
    add_attribute(p->out, "unit", note->unit);
    add_attribute(p->out, "note", note->note);
    text_add(p->out, " src=\"data:image/png;base64,");
    SheenStatus status = add_pixels(p, "layer.png");
    text_add(p->out, "\">\n");
    return status;
}

SheenStatus compare_layers_add(const char *path, const char *role, const char *page, const SheenLog *log,
                               TextBuffer *out)
{
    SheenImageLayers layers;
    SheenStatus status = sheen_image_read_layers(path, log, &layers);
    if (status || layers.n == 0) return status;
    LayerPage p = {role, page, log, layers.width, layers.height, NULL, out};
    p.pixels = malloc((size_t)p.width * p.height * sizeof *p.pixels);
    if (!p.pixels) status = sheen_fail(log, SHEEN_ERR_NOMEM, "%s: out of memory", page);
    for (size_t i = 0; i < layers.n && !status; ++i) {
        const SheenImageLayer *layer = &layers.layers[i];
        if (layer->color) status = add_color(&p, layer);
        for (unsigned c = 0; c < layer->n_channels && !layer->color && !status; ++c) status = add_channel(&p, layer, c);
    }
    free(p.pixels);
    sheen_image_layers_free(&layers);
    return status;
}
