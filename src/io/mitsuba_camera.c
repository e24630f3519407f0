// SPDX-License-Identifier: Apache-2.0
// Cameras of Mitsuba scenes.
#include "image/image.h"
#include "io/mitsuba.h"
#include "io/number.h"

#include <string.h>

#define DEGREE (3.14159265358979323846 / 180.0)

double sheen_mi_fov(Mitsuba *m, const SheenXml *e, double aspect)
{
    double fov = sheen_mi_float(m, e, "fov", 0.0) * DEGREE;
    const char *axis = sheen_mi_string(m, e, "fov_axis", "x");
    if (!sheen_mi_child(e, "fov")) {
        // The focal length is that of a film of 36 x 24 mm, its angle the diagonal's: "50mm" unless given.
        const char *focal = sheen_mi_string(m, e, "focal_length", "50mm");
        const char *unit = focal;
        double length;
        if (!sheen_number_parse(&unit, focal + strlen(focal), &length) || !(length > 0.0 && length < 1e6) ||
            (*unit && strcmp(unit, "mm") != 0)) {
            sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "focalLength is not a positive length: '%.60s'", focal);
            return 0.0;
        }
        fov = 2.0 * atan(sqrt(36.0 * 36.0 + 24.0 * 24.0) / (2.0 * length));
        axis = "diagonal";
    }
    sheen_mi_ignore(e, "focal_length");
    if (!(fov > 0.0 && fov < 179.9 * DEGREE)) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the field of view must lie between 0 and 180 degrees, not %g",
                      fov / DEGREE);
        return 0.0;
    }
    if (sheen_mi_same(axis, "smaller")) axis = aspect > 1.0 ? "y" : "x";
    if (sheen_mi_same(axis, "larger")) axis = aspect > 1.0 ? "x" : "y";
    double half = tan(0.5 * fov);
    if (sheen_mi_same(axis, "x")) return fov;
    if (sheen_mi_same(axis, "y")) return 2.0 * atan(half * aspect);
    if (sheen_mi_same(axis, "diagonal")) return 2.0 * atan(half * aspect / sqrt(1.0 + aspect * aspect));
    sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the axis '%.60s' of the field of view is not known", axis);
    return 0.0;
}

static uint32_t read_side(Mitsuba *m, const SheenXml *film, const char *name, uint32_t otherwise)
{
    int64_t side = sheen_mi_integer(m, film, name, otherwise);
    if (side > 0 && side <= SHEEN_IMAGE_MAX_SIDE) return (uint32_t)side;
    sheen_mi_fail(m, SHEEN_ERR_PARSE, sheen_mi_child(film, name), "the picture's %s must be 1 to %d pixels, not %lld",
                  name, SHEEN_IMAGE_MAX_SIDE, (long long)side);
    return otherwise;
}

/** The window of the film that is rendered: it becomes the picture. */
static void read_crop(Mitsuba *m, const SheenXml *film, SheenCamera *c)
{
    int64_t film_w = c->width, film_h = c->height;
    int64_t x = sheen_mi_integer(m, film, "crop_offset_x", 0), y = sheen_mi_integer(m, film, "crop_offset_y", 0);
    if (m->status) return;
    bool inside = x >= 0 && x < film_w && y >= 0 && y < film_h;
    int64_t w = sheen_mi_integer(m, film, "crop_width", inside ? film_w - x : 0);
    int64_t h = sheen_mi_integer(m, film, "crop_height", inside ? film_h - y : 0);
    if (m->status) return;
    if (!inside || w < 1 || h < 1 || w > film_w - x || h > film_h - y) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, film, "the crop window does not lie in the film of %u x %u pixels", c->width,
                      c->height);
        return;
    }
    c->width = (uint32_t)w, c->height = (uint32_t)h;
    c->cut_lo = v2((float)((double)x / (double)film_w), (float)((double)y / (double)film_h));
    c->cut_hi =
        v2((float)((double)(film_w - x - w) / (double)film_w), (float)((double)(film_h - y - h) / (double)film_h));
}

/** A parameter of a filter; 0 after an error. */
static float read_filter_number(Mitsuba *m, const SheenXml *e, const char *name, float otherwise, double lo, double hi)
{
    double x = sheen_mi_float(m, e, name, (double)otherwise);
    if (m->status) return 0.0f;
    if (x >= lo && x <= hi) return (float)x;
    sheen_mi_fail(m, SHEEN_ERR_PARSE, sheen_mi_child(e, name),
                  "'%s' of a reconstruction filter must be %g to %g, not %g", name, lo, hi, x);
    return 0.0f;
}

/** The film's reconstruction filter; Mitsuba's is gaussian where none is named. */
static SheenFilter read_filter(Mitsuba *m, const SheenXml *film)
{
    static const struct {
        const char *name;
        SheenFilterKind kind;
    } plugins[] = {
        {"box", SHEEN_FILTER_BOX},           {"tent", SHEEN_FILTER_TENT},
        {"gaussian", SHEEN_FILTER_GAUSSIAN}, {"mitchell", SHEEN_FILTER_MITCHELL},
        {"lanczos", SHEEN_FILTER_LANCZOS},   {"catmullrom", SHEEN_FILTER_CATMULL_ROM},
    };
    // Wider ones would take a pixel's samples from all over the picture.
    const double radius_max = 16.0, radius_min = 1e-3;
    const SheenXml *e = sheen_mi_nested(m, film, "rfilter");
    const char *type = e ? sheen_mi_type(e) : "gaussian";
    SheenFilter f = sheen_filter_standard(SHEEN_FILTER_UNSET);
    for (size_t i = 0; i < sizeof plugins / sizeof *plugins; ++i)
        if (sheen_mi_same(type, plugins[i].name)) f = sheen_filter_standard(plugins[i].kind);
    if (f.kind == SHEEN_FILTER_UNSET) {
        sheen_xml_warn(m->log, e, "the reconstruction filter '%s' is not supported: 'gaussian' stands in", type);
        return sheen_filter_standard(SHEEN_FILTER_GAUSSIAN);
    }
    if (!e) return f;
    if (f.kind == SHEEN_FILTER_TENT) f.radius = read_filter_number(m, e, "radius", f.radius, radius_min, radius_max);
    if (f.kind == SHEEN_FILTER_GAUSSIAN)
        f = sheen_filter_gaussian(read_filter_number(m, e, "stddev", f.stddev, 0.25 * radius_min, 0.25 * radius_max));
    if (f.kind == SHEEN_FILTER_MITCHELL) {
        f.b = read_filter_number(m, e, "B", f.b, -2.0, 2.0);
        f.c = read_filter_number(m, e, "C", f.c, -2.0, 2.0);
    }
    if (f.kind == SHEEN_FILTER_LANCZOS) f.radius = read_filter_number(m, e, "lobes", f.radius, 1.0, radius_max);
    if (!m->status) sheen_mi_report_unused(m, e);
    return f;
}

static void read_film(Mitsuba *m, const SheenXml *e, SheenCamera *c)
{
    c->width = 768, c->height = 576; // Mitsuba's default
    c->filter = sheen_filter_standard(SHEEN_FILTER_GAUSSIAN);
    const SheenXml *film = sheen_mi_nested(m, e, "film");
    if (!film || m->status) return;
    c->width = read_side(m, film, "width", c->width);
    c->height = read_side(m, film, "height", c->height);
    if (!m->status && (uint64_t)c->width * c->height > SHEEN_IMAGE_MAX_PIXELS)
        sheen_mi_fail(m, SHEEN_ERR_PARSE, film, "a picture of %u x %u pixels is too large", c->width, c->height);
    if (!m->status) read_crop(m, film, c);
    if (!m->status) c->filter = read_filter(m, film);
}

/** The principal point: the film is shifted, fractions of its width and height, right and down. */
static void read_shift(Mitsuba *m, const SheenXml *e, SheenCamera *c)
{
    float x = (float)sheen_mi_float(m, e, "principal_point_offset_x", 0.0);
    float y = (float)sheen_mi_float(m, e, "principal_point_offset_y", 0.0);
    c->cut_lo = v2(c->cut_lo.x + x, c->cut_lo.y + y);
    c->cut_hi = v2(c->cut_hi.x - x, c->cut_hi.y - y);
}

static void read_lens(Mitsuba *m, const SheenXml *e, SheenCamera *c)
{
    double aperture = sheen_mi_float(m, e, "aperture_radius", 0.0);
    double focus = sheen_mi_float(m, e, "focus_distance", 1.0);
    if (!m->status && !(aperture >= 0.0 && aperture < 1e15 && focus > 0.0 && focus < 1e15))
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "a lens needs apertureRadius >= 0 and focusDistance > 0, not %g and %g",
                      aperture, focus);
    c->aperture = (float)aperture, c->focus = (float)focus;
}

/** Sensors that make no picture, or several. @return true when that is all */
static bool read_other_sensor(Mitsuba *m, SheenXml *e)
{
    static const char *const meters[] = {"radiancemeter", "irradiancemeter", "fluencemeter", "distant"};
    const char *type = sheen_mi_type(e);
    for (size_t i = 0; i < sizeof meters / sizeof *meters; ++i)
        if (sheen_mi_same(type, meters[i])) {
            sheen_xml_warn(m->log, e, "the sensor '%s' takes no picture and is left out", type);
            return true;
        }
    if (!sheen_mi_same(type, "batch")) return false;
    sheen_xml_warn(m->log, e, "the sensor 'batch' is not supported: the cameras in it stand for themselves");
    for (SheenXml *c = e->first; c && !m->status; c = c->next) {
        SheenXml *sensor = sheen_mi_resolve(m, c);
        if (sensor && strcmp(sensor->tag, "sensor") == 0 && !sheen_mi_same(sheen_mi_type(sensor), "batch"))
            sheen_mi_sensor(m, sensor);
    }
    return true;
}

void sheen_mi_sensor(Mitsuba *m, SheenXml *e)
{
    if (read_other_sensor(m, e)) return;
    const char *type = sheen_mi_type(e), *id = sheen_xml_attribute(e, "id");
    SheenCamera c = {.to_world = sheen_mi_transform(m, e, "to_world")};
    bool lens = sheen_mi_same(type, "thinlens"), telecentric = sheen_mi_same(type, "telecentric");
    c.orthographic = telecentric || sheen_mi_same(type, "orthographic");
    if (telecentric)
        sheen_xml_warn(m->log, e, "the camera 'telecentric' is not supported: 'orthographic' stands in");
    else if (!lens && !c.orthographic && !sheen_mi_same(type, "perspective"))
        sheen_xml_warn(m->log, e, "the camera '%s' is not supported: a perspective camera stands in", type);
    read_film(m, e, &c);
    double aspect = (double)c.width / c.height; // of the whole film
    if (!m->status) aspect *= (double)(1.0f - c.cut_lo.y - c.cut_hi.y) / (double)(1.0f - c.cut_lo.x - c.cut_hi.x);
    const SheenXml *sampler = sheen_mi_nested(m, e, "sampler");
    int64_t spp = sampler ? sheen_mi_integer(m, sampler, "sample_count", 0) : 0;
    c.spp = spp > 0 && spp <= UINT32_MAX ? (uint32_t)spp : 0;
    if (m->status) return;
    if (!c.orthographic) c.fov_x = (float)sheen_mi_fov(m, e, aspect);
    if (!m->status) read_shift(m, e, &c);
    if (lens && !m->status) read_lens(m, e, &c);
    Transform inverse;
    if (!m->status && !transform_invert(&c.to_world, &inverse))
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the camera's transform is singular");
    // Nothing between the camera and the scene is to be cut away, and nothing moves; a pinhole has no focus.
    sheen_mi_ignore(e, "near_clip far_clip focus_distance aperture_radius shutter_open shutter_close");
    sheen_mi_report_unused(m, e);
    c.name = sheen_arena_strdup(m->arena, id ? id : "camera");
    if (!m->status) sheen_builder_add_camera(m->builder, &c);
}
