// SPDX-License-Identifier: Apache-2.0
// Source of the picture's form: krivanek2005-radiance-caching fig. 2
#include "brdf_order.h"

#include "cli.h"
#include "json_text.h"

#include "image/image.h"
#include "material/lobe_table.h"

#include <stdlib.h>

enum { SIDE = 129, GAP = 8, PANELS = 3, ROWS_MAX = 64 };
enum { WIDTH = PANELS * SIDE + (PANELS + 1) * GAP };

/** What is known for one outgoing direction. */
typedef struct Sample {
    unsigned order;
    float error, share; // of the glossy lobes
} Sample;

typedef struct Plot {
    const SheenLobeTables *tables;
    unsigned order; // n_max
    float error;    // allowed
    Rgb *pixels;    // [height][WIDTH]
    uint32_t height;
} Plot;

// ---- samples ----------------------------------------------------------------------------------------------------

/** A material on a flat disk, its textures in their middle. */
static Bsdf bsdf_of(const SheenScene *scene, uint32_t material)
{
    SheenShape shape = {.kind = SHEEN_SHAPE_DISK,
                        .disk = {.du = {1, 0, 0}, .dv = {0, 1, 0}, .n = {0, 0, 1}},
                        .material = material,
                        .light = SHEEN_NONE,
                        .name = "disk"};
    SheenScene stage = *scene;
    stage.shapes = &shape;
    stage.n_shapes = 1;
    SurfacePoint point = {
        .ns = {0, 0, 1}, .ng = {0, 0, 1}, .p = {0.25f, 0, 0}, .uv = {0.5f, 0.5f}, .instance = SHEEN_NONE};
    return sheen_bsdf_at(&stage, &point);
}

/** @param p  parabolic coordinates within the unit disk */
static Sample sample_at(const Plot *plot, const Bsdf *bsdf, Vec2 p)
{
    Rgb c[SHEEN_BASIS_MAX];
    LobeReading reading;
    float scale = 2.0f / (1.0f + p.x * p.x + p.y * p.y);
    sheen_lobe_table_read(plot->tables, SHEEN_BASIS_HSH, bsdf, v3_normalize(v3(scale * p.x, scale * p.y, scale - 1.0f)),
                          c, &reading);
    Sample s = {.order = reading.order, .error = reading.error};
    for (uint32_t i = 0; i < bsdf->n_lobes; ++i) s.share = maxf(s.share, reading.share[i]);
    return s;
}

// ---- the picture ------------------------------------------------------------------------------------------------

/** From blue by green to red. */
static Rgb ramp(float t)
{
    t = unit_or_zero(t);
    return rgb(unit_or_zero(2.0f * t - 1.0f), 1.0f - fabsf(2.0f * t - 1.0f), unit_or_zero(1.0f - 2.0f * t));
}

static Rgb faded(Rgb c, float share)
{
    const Rgb sampled = {0.05f, 0.05f, 0.05f};
    return rgb_mad(rgb_scale(sampled, 1.0f - share), share, c);
}

static Rgb *pixel(const Plot *plot, unsigned row, unsigned panel, unsigned x, unsigned y)
{
    size_t top = GAP + (size_t)row * (SIDE + GAP), left = GAP + (size_t)panel * (SIDE + GAP);
    return &plot->pixels[(top + y) * WIDTH + left + x];
}

/** A column of the graph: the order as a bar, the error as a point, each against its largest. */
static void draw_column(const Plot *plot, unsigned row, unsigned x, Sample s)
{
    unsigned bar = s.order * (SIDE - 1) / plot->order;
    unsigned at = (unsigned)(unit_or_zero(s.error / plot->error) * (float)(SIDE - 1));
    for (unsigned y = 0; y < SIDE; ++y)
        *pixel(plot, row, 2, x, SIDE - 1 - y) = y < bar ? faded(rgb(0.2f, 0.3f, 0.5f), s.share) : rgb_gray(0.9f);
    if (s.order > 0) *pixel(plot, row, 2, x, SIDE - 1 - at) = rgb(0.9f, 0.1f, 0.0f);
}

// ---- figures ----------------------------------------------------------------------------------------------------

static json_t *draw_row(const Plot *plot, const SheenMaterial *m, const Bsdf *bsdf, unsigned row)
{
    unsigned least = 0, most = 0, n = 0;
    double share = 0.0, error = 0.0;
    for (unsigned y = 0; y < SIDE; ++y)
        for (unsigned x = 0; x < SIDE; ++x) {
            Vec2 p = v2(2.0f * ((float)x + 0.5f) / SIDE - 1.0f, 1.0f - 2.0f * ((float)y + 0.5f) / SIDE);
            if (p.x * p.x + p.y * p.y >= 1.0f) continue;
            Sample s = sample_at(plot, bsdf, p);
            if (s.order > 0 && (least == 0 || s.order < least)) least = s.order;
            if (s.order > most) most = s.order;
            share += (double)s.share, error += (double)(s.share * s.error), ++n;
            if (row >= ROWS_MAX) continue;
            *pixel(plot, row, 0, x, y) = faded(ramp(s.error / plot->error), s.share);
            *pixel(plot, row, 1, x, y) = faded(ramp((float)s.order / (float)plot->order), s.share);
            if (y == SIDE / 2) draw_column(plot, row, x, s);
        }
    return json_pack("{s:o, s:[I, I], s:f, s:f}", "material", json_text(m->name), "orders", (json_int_t)least,
                     (json_int_t)most, "error", share > 0.0 ? error / share : 0.0, "cached", share / n);
}

static unsigned count_glossy(const SheenScene *scene, bool glossy[])
{
    unsigned n = 0;
    for (uint32_t i = 0; i < scene->n_shapes; ++i) glossy[scene->shapes[i].material] = true;
    for (uint32_t i = 0; i < scene->n_materials; ++i) {
        if (!glossy[i]) continue;
        Bsdf bsdf = bsdf_of(scene, i);
        glossy[i] = sheen_bsdf_classes(&bsdf) & SHEEN_BSDF_GLOSSY;
        n += glossy[i];
    }
    return n;
}

static SheenStatus draw(Plot *plot, const SheenScene *scene, const char *picture, const SheenLog *log, json_t *rows)
{
    bool *glossy = calloc((size_t)scene->n_materials + 1, sizeof *glossy);
    if (!glossy) return SHEEN_ERR_NOMEM;
    unsigned n = count_glossy(scene, glossy), row = 0;
    SheenStatus status = SHEEN_OK;
    plot->height = GAP + (n > ROWS_MAX ? ROWS_MAX : n > 0 ? n : 1) * (SIDE + GAP);
    plot->pixels = malloc((size_t)plot->height * WIDTH * sizeof *plot->pixels);
    if (!plot->pixels) status = SHEEN_ERR_NOMEM;
    for (size_t i = 0; !status && i < (size_t)plot->height * WIDTH; ++i) plot->pixels[i] = rgb_gray(0.9f);
    for (uint32_t i = 0; !status && i < scene->n_materials; ++i) {
        if (!glossy[i]) continue;
        Bsdf bsdf = bsdf_of(scene, i);
        json_array_append_new(rows, draw_row(plot, &scene->materials[i], &bsdf, row++));
    }
    if (!status)
        status = sheen_image_write(
            picture, &(SheenImageView){.width = WIDTH, .height = plot->height, .pixels = plot->pixels}, 0, log);
    free(plot->pixels);
    free(glossy);
    return status;
}

int brdf_order_report(const SheenScene *scene, const char *picture, const LobeValues *lobes, Report *report,
                      json_t *info)
{
    const SheenLog log = report_log(report);
    const SheenLobeTableDesc desc = {.order = lobes->order, .error = (float)lobes->brdf_error};
    SheenPool *pool = NULL;
    SheenLobeTables *tables = NULL;
    json_t *rows = json_array();
    SheenStatus status = rows ? sheen_pool_create(0, &pool) : SHEEN_ERR_NOMEM;
    if (!status) status = sheen_lobe_tables_create(&log, scene, &desc, pool, NULL, &tables);
    if (!status) {
        Plot plot = {.tables = tables, .order = lobes->order, .error = (float)lobes->brdf_error};
        status = draw(&plot, scene, picture, &log, rows);
    }
    sheen_lobe_tables_destroy(&tables);
    sheen_pool_destroy(&pool);
    json_object_set_new(info, "harmonics", rows);
    return report_exit_code(report, status, picture);
}
