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

/** A texture of a property, for a light that shows it: radiances may be over 1. @return NULL when there is none */
static SheenTexture *read_picture(Mitsuba *m, const SheenXml *e, const char *name)
{
    SheenXml *c = sheen_mi_child(e, name);
    SheenXml *value = c ? sheen_mi_resolve(m, c) : NULL;
    SheenTexture *t = value ? SHEEN_ARENA_NEW(m->arena, SheenTexture, 1) : NULL;
    if (t) *t = sheen_mi_texture_of(m, value, MITSUBA_EMISSION, rgb_gray(1.0f));
    if (value && !t) sheen_mi_fail(m, SHEEN_ERR_NOMEM, e, "out of memory");
    return t;
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
    l.texture = read_picture(m, e, "texture");
    if (l.texture && cutoff >= 90.0) {
        sheen_xml_warn(m->log, e, "a spot's texture needs a cutoffAngle below 90 degrees and is ignored");
        l.texture = NULL;
    }
    if (l.texture) { // as wide as the cone; Mitsuba's v runs along y
        l.to_world = t;
        l.tan_x = l.tan_y = (float)tan(cutoff * (3.14159265358979323846 / 180.0));
    }
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
    sheen_mi_ignore(e, "cache gamma format mis_compensation");
    if (sheen_mi_bitmap(m, e, true, 0.0, &l.environment)) sheen_builder_add_light(m->builder, &l);
}

/** A camera the other way: its picture goes out into the scene, left along +x and up along +y. */
static void read_projector(Mitsuba *m, SheenXml *e)
{
    Transform t = sheen_mi_transform(m, e, "to_world");
    SheenLight l = {.kind = SHEEN_LIGHT_PROJECTOR, .position = transform_point(&t, v3(0, 0, 0))};
    SheenTexture *picture = read_picture(m, e, "irradiance");
    static const SheenTexture white = {
        .kind = SHEEN_TEXTURE_CONSTANT, .value = {1, 1, 1}, .scale = {1, 1, 1}, .uv = {{1, 0, 0}, {0, 1, 0}}};
    l.texture = picture ? picture : &white;
    // Mitsuba's irradiance at distance 1 has this factor pi.
    l.radiance = rgb_gray((float)sheen_mi_float(m, e, "scale", 1.0) * SHEEN_PI);
    bool bitmap = l.texture->kind == SHEEN_TEXTURE_BITMAP;
    double aspect = bitmap ? (double)l.texture->bitmap.width / l.texture->bitmap.height : 1.0;
    double fov = m->status ? 0.0 : sheen_mi_fov(m, e, aspect);
    if (m->status) return;
    l.tan_x = (float)tan(0.5 * fov);
    l.tan_y = (float)(tan(0.5 * fov) / aspect);
    l.to_world = transform_mul(t, transform_scale(-1.0, -1.0, 1.0));
    sheen_builder_add_light(m->builder, &l);
}

/** The mean over a span of time: that of one hour stands in. */
static void read_timed_sky(Mitsuba *m, SheenXml *e)
{
    sheen_xml_warn(m->log, e, "the light '%s' is not supported: 'sunsky' in the afternoon stands in", sheen_mi_type(e));
    sheen_mi_ignore(e, "start_year start_month start_day start_hour start_minute start_second end_year end_month "
                       "end_day end_hour end_minute end_second window_start_time window_end_time shutter_open "
                       "shutter_close");
    sheen_mi_sky(m, e);
}

static const Plugin plugins[] = {
    {"point", read_point},
    {"spot", read_spot},
    {"directional", read_directional},
    {"constant", read_constant},
    {"envmap", read_envmap},
    {"sky", sheen_mi_sky},
    {"sunsky", sheen_mi_sky},
    {"sun", sheen_mi_sky},
    {"projector", read_projector},
    {"timed_sunsky", read_timed_sky},
    {"avg_sunsky", read_timed_sky},
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
