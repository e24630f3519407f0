// SPDX-License-Identifier: Apache-2.0
// Lights of Mitsuba scenes that are not on a shape.
#include "io/mitsuba.h"

#include <string.h>

typedef void ReadFn(Mitsuba *m, SheenXml *e);

typedef struct Plugin {
    const char *name;
    ReadFn *read;
} Plugin;

/** The way that +z goes. */
static Vec3 axis_of(const Transform *t)
{
    return transform_vector(t, v3(0, 0, 1));
}

static void read_point(Mitsuba *m, SheenXml *e)
{
    Transform t = sheen_mi_transform(m, e, "to_world");
    SheenLight l = {.kind = SHEEN_LIGHT_POINT};
    l.radiance = sheen_mi_color(m, e, "intensity", MITSUBA_EMISSION, rgb_gray(1.0f));
    l.position = transform_point(&t, sheen_mi_vector(m, e, "position", v3(0, 0, 0)));
    sheen_builder_add_light(m->builder, &l);
}

static void read_spot(Mitsuba *m, SheenXml *e)
{
    Transform t = sheen_mi_transform(m, e, "to_world");
    SheenLight l = {.kind = SHEEN_LIGHT_SPOT};
    l.radiance = sheen_mi_color(m, e, "intensity", MITSUBA_EMISSION, rgb_gray(1.0f));
    l.position = transform_point(&t, v3(0, 0, 0));
    l.direction = axis_of(&t);
    double cutoff = sheen_mi_float(m, e, "cutoff_angle", 20.0);
    double beam = sheen_mi_float(m, e, "beam_width", 0.75 * cutoff);
    if (!(cutoff > 0.0 && cutoff <= 180.0 && beam >= 0.0 && beam <= cutoff)) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "a spot needs 0 <= beamWidth <= cutoffAngle <= 180, not %g and %g", beam,
                      cutoff);
        return;
    }
    l.cos_inner = (float)cos(beam * (3.14159265358979323846 / 180.0));
    l.cos_outer = (float)cos(cutoff * (3.14159265358979323846 / 180.0));
    sheen_builder_add_light(m->builder, &l);
}

static void read_directional(Mitsuba *m, SheenXml *e)
{
    Transform t = sheen_mi_transform(m, e, "to_world");
    SheenLight l = {.kind = SHEEN_LIGHT_DIRECTIONAL};
    l.radiance = sheen_mi_color(m, e, "irradiance", MITSUBA_EMISSION, rgb_gray(1.0f));
    l.direction = transform_vector(&t, sheen_mi_vector(m, e, "direction", v3(0, 0, 1)));
    sheen_builder_add_light(m->builder, &l);
}

static void read_constant(Mitsuba *m, SheenXml *e)
{
    SheenLight l = {.kind = SHEEN_LIGHT_ENVIRONMENT};
    l.radiance = sheen_mi_color(m, e, "radiance", MITSUBA_EMISSION, rgb_gray(1.0f));
    sheen_builder_add_light(m->builder, &l);
}

/**
 * Mitsuba's latitude-longitude pictures have their seam at -z and run over +x to +z, up is +y: the convention of
 * SheenLight, checked by asking Mitsuba 3 for the radiance along known directions. (Its rows have their centres on the
 * poles, Sheen's half a row off; no picture shows it.)
 */
static void read_envmap(Mitsuba *m, SheenXml *e)
{
    SheenLight l = {.kind = SHEEN_LIGHT_ENVIRONMENT};
    l.radiance = rgb_gray((float)sheen_mi_float(m, e, "scale", 1.0));
    l.to_world = sheen_mi_transform(m, e, "to_world");
    sheen_mi_ignore(e, "cache gamma format");
    if (sheen_mi_bitmap(m, e, true, 0.0, &l.environment)) sheen_builder_add_light(m->builder, &l);
}

static const Plugin plugins[] = {
    {"point", read_point},   {"spot", read_spot},   {"directional", read_directional}, {"constant", read_constant},
    {"envmap", read_envmap}, {"sky", sheen_mi_sky}, {"sunsky", sheen_mi_sky},          {"sun", sheen_mi_sky},
};

void sheen_mi_emitter(Mitsuba *m, SheenXml *e)
{
    const char *type = sheen_mi_type(e);
    for (size_t i = 0; i < sizeof plugins / sizeof *plugins; ++i)
        if (sheen_mi_same(plugins[i].name, type)) {
            plugins[i].read(m, e);
            sheen_mi_ignore(e, "sampling_weight");
            if (!m->status) sheen_mi_report_unused(m, e);
            return;
        }
    bool area = sheen_mi_same(type, "area");
    if (area && sheen_xml_attribute(e, "id")) return; // for shapes to refer to
    sheen_xml_warn(m->log, e, "the light '%s' is %s and is left out", type, area ? "on no shape" : "not supported");
}
