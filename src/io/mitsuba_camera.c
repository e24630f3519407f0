// SPDX-License-Identifier: Apache-2.0
// Cameras of Mitsuba scenes.
#include "image/image.h"
#include "io/mitsuba.h"
#include "io/number.h"

#include <string.h>

#define DEGREE (3.14159265358979323846 / 180.0)

/** Full horizontal angle of a picture `aspect` times as wide as high, radians; 0 after an error. */
static double read_fov(Mitsuba *m, const SheenXml *e, double aspect)
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

static void read_film(Mitsuba *m, const SheenXml *e, SheenCamera *c)
{
    c->width = 768, c->height = 576; // Mitsuba's default
    const SheenXml *film = sheen_mi_nested(m, e, "film");
    if (!film || m->status) return;
    c->width = read_side(m, film, "width", c->width);
    c->height = read_side(m, film, "height", c->height);
    if (!m->status && (uint64_t)c->width * c->height > SHEEN_IMAGE_MAX_PIXELS)
        sheen_mi_fail(m, SHEEN_ERR_PARSE, film, "a picture of %u x %u pixels is too large", c->width, c->height);
    for (SheenXml *p = film->first; p; p = p->next) {
        const char *name = sheen_xml_attribute(p, "name");
        if (name && strncmp(name, "crop", 4) == 0)
            sheen_xml_warn(m->log, p, "'%s' is not supported: the whole picture is rendered", name);
    }
}

void sheen_mi_sensor(Mitsuba *m, SheenXml *e)
{
    const char *type = sheen_mi_type(e), *id = sheen_xml_attribute(e, "id");
    SheenCamera c = {.to_world = sheen_mi_transform(m, e, "to_world")};
    if (!sheen_mi_same(type, "perspective"))
        sheen_xml_warn(m->log, e, "the camera '%s' is not supported: a perspective camera stands in", type);
    read_film(m, e, &c);
    const SheenXml *sampler = sheen_mi_nested(m, e, "sampler");
    int64_t spp = sampler ? sheen_mi_integer(m, sampler, "sample_count", 0) : 0;
    c.spp = spp > 0 && spp <= UINT32_MAX ? (uint32_t)spp : 0;
    if (m->status) return;
    c.fov_x = (float)read_fov(m, e, (double)c.width / c.height);
    Transform inverse;
    if (!m->status && !transform_invert(&c.to_world, &inverse))
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the camera's transform is singular");
    sheen_mi_ignore(e, "near_clip far_clip focus_distance aperture_radius shutter_open shutter_close");
    sheen_mi_report_unused(m, e);
    c.name = sheen_arena_strdup(m->arena, id ? id : "camera");
    if (!m->status) sheen_builder_add_camera(m->builder, &c);
}
