// SPDX-License-Identifier: Apache-2.0
#include "compare_page.h"

#include "cli.h"
#include "compare_layers.h"
#include "compare_script.h"
#include "output.h"
#include "picture_base64.h"
#include "text_buffer.h"

#include "image/flip.h"

#include <stdlib.h>
#include <string.h>

enum { max_entries = 4096 }; // more is not a page to look at

/** One picture beside its reference, encoded for the page: an operand, its worst frame, or one of its pictures. */
typedef struct PageEntry {
    const char *name; // of the operand
    char *picture;    // NULL where the operand is one picture or an animation
    char *figures;    // "mse 0.1, ..." as table cells, once finished
    long frame;
    double flip;
    uint32_t width, height;
    TextBuffer reference_png, image_png, error_png; // base 64
    TextBuffer reference_hdr, image_hdr;            // base 64
    TextBuffer reference_layers, image_layers;      // elements
} PageEntry;

struct ComparePage {
    const char *path, *reference;
    SheenLog log;
    PageEntry *entries; // the last is not finished while `open`
    size_t n;
    bool open;
};

ComparePage *compare_page_create(const char *path, const char *reference, SheenLog log)
{
    ComparePage *page = calloc(1, sizeof *page);
    if (page) *page = (ComparePage){.path = path, .reference = reference, .log = log};
    return page;
}

static void entry_clear_pictures(PageEntry *e)
{
    text_free(&e->reference_png);
    text_free(&e->image_png);
    text_free(&e->error_png);
    text_free(&e->reference_hdr);
    text_free(&e->image_hdr);
    text_free(&e->reference_layers);
    text_free(&e->image_layers);
}

void compare_page_destroy(ComparePage **page)
{
    if (!*page) return;
    for (size_t i = 0; i < (*page)->n; ++i) {
        entry_clear_pictures(&(*page)->entries[i]);
        free((*page)->entries[i].picture);
        free((*page)->entries[i].figures);
    }
    free((*page)->entries);
    free(*page);
    *page = NULL;
}

static SheenStatus encode(const ComparePage *page, const char *format, const SheenImage *image, TextBuffer *out)
{
    return picture_base64_add(format, image->width, image->height, image->pixels, page->path, &page->log, out);
}

/** Black over purple and orange to a pale yellow: its lightness rises evenly with the error. */
static Rgb error_color(float error)
{
    static const float keys[5][3] = {{0, 0, 4}, {81, 18, 124}, {183, 55, 121}, {252, 137, 97}, {252, 253, 191}};
    float at = 4.0f * clampf(error, 0.0f, 1.0f);
    int i = at < 3.0f ? (int)at : 3;
    float t = at - (float)i, c[3];
    for (int k = 0; k < 3; ++k) c[k] = sheen_srgb_decode(lerpf(keys[i][k], keys[i + 1][k], t) / 255.0f);
    return (Rgb){c[0], c[1], c[2]};
}

/** A copy in which what is not finite is black, as the figures see it. */
static Rgb *finite_pixels(const SheenImage *image)
{
    size_t n = (size_t)image->width * image->height;
    Rgb *pixels = calloc(n, sizeof *pixels);
    for (size_t i = 0; pixels && i < n; ++i) {
        Rgb c = image->pixels[i];
        if (isfinite(c.r) && isfinite(c.g) && isfinite(c.b)) pixels[i] = c;
    }
    return pixels;
}

/** Encodes the map of HDR-FLIP. */
static SheenStatus encode_error(const ComparePage *page, const SheenImage *reference, const SheenImage *image,
                                TextBuffer *out)
{
    size_t n = (size_t)image->width * image->height;
    float *map = malloc(n * sizeof *map);
    SheenImage r = {reference->width, reference->height, finite_pixels(reference)};
    SheenImage x = {image->width, image->height, finite_pixels(image)};
    SheenStatus status = SHEEN_OK;
    if (!map || !r.pixels || !x.pixels)
        status = sheen_fail(&page->log, SHEEN_ERR_NOMEM, "%s: out of memory", page->path);
    SheenFlipExposures exposures;
    if (!status) status = sheen_flip_exposures(&r, &page->log, &exposures);
    if (!status) status = sheen_flip_compute(&r, &x, &exposures, &page->log, map);
    for (size_t i = 0; !status && i < n; ++i) x.pixels[i] = error_color(map[i]);
    if (!status) status = encode(page, "picture.png", &x, out);
    free(map);
    sheen_image_free(&r);
    sheen_image_free(&x);
    return status;
}

/** @return the entry that is not finished, a new one if there is none; NULL when there is no room. */
static PageEntry *open_entry(ComparePage *page)
{
    if (page->open) return &page->entries[page->n - 1];
    PageEntry *grown = page->n < max_entries ? realloc(page->entries, (page->n + 1) * sizeof *grown) : NULL;
    if (!grown) return NULL;
    page->entries = grown;
    page->open = true;
    grown[page->n] = (PageEntry){.flip = -1.0};
    return &grown[page->n++];
}

SheenStatus compare_page_offer(ComparePage *page, const char *name, const SequenceFrame *frame,
                               const char *reference_path, const SheenImage *reference, const SheenImage *image,
                               const SheenMetrics *figures)
{
    PageEntry *e = open_entry(page);
    if (!e) return sheen_fail(&page->log, SHEEN_ERR_NOMEM, "%s: out of memory", page->path);
    double flip = isfinite(figures->flip) ? figures->flip : 0.0;
    if (flip <= e->flip) return SHEEN_OK;
    entry_clear_pictures(e);
    e->name = name;
    e->frame = frame->number;
    e->flip = flip;
    e->width = image->width;
    e->height = image->height;
    SheenStatus status = encode(page, "picture.png", reference, &e->reference_png);
    if (!status) status = encode(page, "picture.png", image, &e->image_png);
    if (!status) status = encode(page, "picture.hdr", reference, &e->reference_hdr);
    if (!status) status = encode(page, "picture.hdr", image, &e->image_hdr);
    if (!status) status = compare_layers_add(reference_path, "reference", page->path, &page->log, &e->reference_layers);
    if (!status) status = compare_layers_add(frame->path, "image", page->path, &page->log, &e->image_layers);
    return status ? status : encode_error(page, reference, image, &e->error_png);
}

static const char *const figure_names[] = {"mse",  "rmse", "relmse", "mae",       "psnr",
                                           "flip", "ssim", "bias",   "nonfinite", "flicker"};
enum { n_figures = sizeof figure_names / sizeof figure_names[0] };

void compare_page_finish(ComparePage *page, const char *picture, json_t *result)
{
    page->open = false;
    PageEntry *e = &page->entries[page->n - 1];
    e->picture = picture ? strdup(picture) : NULL; // NULL when out of memory: shown by the operand's name alone
    TextBuffer cells = {0};
    for (int i = 0; i < n_figures; ++i) {
        const json_t *value = json_object_get(result, figure_names[i]);
        if (json_is_number(value))
            text_add_format(&cells, "<td>%.5g</td>", json_number_value(value));
        else
            text_add(&cells, "<td>-</td>");
    }
    e->figures = cells.text; // NULL when out of memory: an empty row
}

static void add_lines(TextBuffer *out, const char *const lines[])
{
    for (; *lines; ++lines) {
        text_add(out, *lines);
        text_add(out, "\n");
    }
}

/** @return true when the page shows several operands, so that a picture's name alone does not say which it is. */
static bool several_operands(const ComparePage *page)
{
    return strcmp(page->entries[0].name, page->entries[page->n - 1].name) != 0;
}

static void add_image_name(TextBuffer *out, const PageEntry *e)
{
    text_add_escaped(out, e->name);
    if (!e->picture && e->frame >= 0) text_add_format(out, ", frame %ld", e->frame);
}

static void add_name(TextBuffer *out, const ComparePage *page, const PageEntry *e)
{
    if (e->picture) text_add_escaped(out, e->picture);
    if (e->picture && several_operands(page)) text_add(out, ", ");
    if (!e->picture || several_operands(page)) add_image_name(out, e);
}

/** @return the first entry that shows the same reference. */
static const PageEntry *first_with_reference(const ComparePage *page, const PageEntry *e)
{
    const PageEntry *first = page->entries;
    while (strcmp(first->reference_hdr.text, e->reference_hdr.text) != 0) ++first;
    return first;
}

static void add_picture(TextBuffer *out, const char *role, const char *caption, const TextBuffer *png)
{
    text_add_format(out, "<figure><img class=\"%s\" alt=\"%s\" src=\"data:image/png;base64,", role, caption);
    text_add(out, png->text);
    text_add_format(out, "\"><figcaption>%s</figcaption></figure>\n", caption);
}

static void add_entry(TextBuffer *out, const ComparePage *page, const PageEntry *e)
{
    const PageEntry *first = first_with_reference(page, e);
    text_add_format(out, "<section data-width=\"%u\" data-height=\"%u\" data-reference=\"%zu\" data-picture=\"",
                    e->width, e->height, (size_t)(first - page->entries));
    text_add_escaped(out, e->picture ? e->picture : "");
    text_add(out, "\" data-image=\"");
    add_image_name(out, e);
    text_add(out, "\">\n<h2>");
    add_name(out, page, e);
    text_add(out, "</h2>\n<div class=\"row\">\n");
    add_picture(out, "reference", "reference", &e->reference_png);
    add_picture(out, "image", "image", &e->image_png);
    add_picture(out, "error", "error (FLIP, 0 black to 1 yellow)", &e->error_png);
    text_add(out, "</div>\n<script type=\"text/plain\" class=\"reference-hdr\">");
    text_add(out, e == first ? e->reference_hdr.text : ""); // the script finds it there
    text_add(out, "</script>\n<script type=\"text/plain\" class=\"image-hdr\">");
    text_add(out, e->image_hdr.text);
    text_add(out, "</script>\n");
    if (e == first && e->reference_layers.text) text_add(out, e->reference_layers.text);
    if (e->image_layers.text) text_add(out, e->image_layers.text);
    text_add(out, "</section>\n");
}

static void add_table(TextBuffer *out, const ComparePage *page)
{
    text_add(out, "<div class=\"wide\">\n<table>\n<tr><th>image</th>");
    for (int i = 0; i < n_figures; ++i) text_add_format(out, "<th>%s</th>", figure_names[i]);
    text_add(out, "</tr>\n");
    for (size_t i = 0; i < page->n; ++i) {
        text_add(out, "<tr><th>");
        add_name(out, page, &page->entries[i]);
        text_add(out, "</th>");
        text_add(out, page->entries[i].figures ? page->entries[i].figures : "");
        text_add(out, "</tr>\n");
    }
    text_add(out, "</table>\n</div>\n");
}

bool compare_page_write(ComparePage *page)
{
    TextBuffer out = {0};
    text_add(&out, "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                   "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>");
    text_add_escaped(&out, page->reference);
    text_add(&out, "</title>\n<style>\n");
    add_lines(&out, compare_style);
    text_add(&out, "</style>\n</head>\n<body>\n<h1>Compared with ");
    text_add_escaped(&out, page->reference);
    text_add(&out, "</h1>\n");
    bool long_table = page->n > 4; // it would hide the stage
    if (!long_table) add_table(&out, page);
    add_lines(&out, compare_controls);
    if (long_table) add_table(&out, page);
    for (size_t i = 0; i < page->n; ++i) add_entry(&out, page, &page->entries[i]);
    text_add(&out, "<script>\n");
    add_lines(&out, compare_script);
    text_add(&out, "</script>\n</body>\n</html>");
    bool ok = false;
    if (out.failed)
        cli_error("%s: out of memory", page->path);
    else
        ok = output_write_text(page->path, out.text);
    text_free(&out);
    return ok;
}
