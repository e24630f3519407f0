// SPDX-License-Identifier: Apache-2.0
// Sky, sun and both of Mitsuba scenes: an environment image of the sky and a directional light for the sun.
#include "io/mitsuba.h"
#include "io/sky.h"

#include <string.h>

// Pixels of a degree and less: the model's own features are wider. An odd number of rows has one on the horizon.
enum { SKY_WIDTH = 512, SKY_HEIGHT = 257 };

/** What the three plugins have in common. */
typedef struct Heaven {
    double turbidity, theta_sun;
    Vec3 to_sun;        // in the world
    Vec3 sun;           // in the image's space, +y up
    Transform to_world; // of the image
} Heaven;

static Vec3 sun_by_time(Mitsuba *m, const SheenXml *e)
{
    // Mitsuba's default is an afternoon in Tokyo.
    SheenSkyTime t = {.latitude = sheen_mi_float(m, e, "latitude", 35.6894),
                      .longitude = sheen_mi_float(m, e, "longitude", 139.6917),
                      .timezone = sheen_mi_float(m, e, "timezone", 9.0)};
    int64_t year = sheen_mi_integer(m, e, "year", 2010), month = sheen_mi_integer(m, e, "month", 7);
    int64_t day = sheen_mi_integer(m, e, "day", 10);
    t.hour = sheen_mi_float(m, e, "hour", 15.0) + sheen_mi_float(m, e, "minute", 0.0) / 60.0 +
             sheen_mi_float(m, e, "second", 0.0) / 3600.0;
    bool date = year >= 0 && year <= 9999 && month >= 1 && month <= 12 && day >= 1 && day <= 31;
    bool place = fabs(t.latitude) <= 90.0 && fabs(t.longitude) <= 180.0 && fabs(t.timezone) <= 24.0;
    if (!m->status && !(date && place && t.hour >= 0.0 && t.hour <= 24.0))
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the sun's place or time is not on the map or in the calendar");
    if (m->status) return v3(0, 1, 0);
    t.year = (int)year, t.month = (int)month, t.day = (int)day;
    return sheen_sun_direction(&t);
}

/**
 * Version 3 has +z up, those before +y. Both agree that `sun_direction` is the world's. A sun that is given by its time
 * stands where Mitsuba 3 was seen to put it, with +x south and +y west; before, with +x east and +z south.
 */
static bool read_heaven(Mitsuba *m, const SheenXml *e, Heaven *out)
{
    static const char *const clock = "latitude longitude timezone year month day hour minute second";
    const Transform z_up = {{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}};
    *out = (Heaven){.to_world = sheen_mi_transform(m, e, "to_world")};
    if (m->version >= 3) out->to_world = transform_mul(out->to_world, z_up);
    Transform inverse;
    if (!m->status && !transform_invert(&out->to_world, &inverse))
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the transform of the sky is singular");
    if (m->status) return false;
    if (sheen_mi_child(e, "sun_direction")) {
        out->to_sun = v3_normalize(sheen_mi_vector(m, e, "sun_direction", v3(0, 1, 0)));
        out->sun = v3_normalize(transform_vector(&inverse, out->to_sun));
        sheen_mi_ignore(e, clock); // the direction overrides them
    } else {
        Vec3 sun = sun_by_time(m, e);
        out->sun = m->version >= 3 ? v3(sun.z, sun.y, sun.x) : sun;
        out->to_sun = v3_normalize(transform_vector(&out->to_world, out->sun));
    }
    if (!m->status && !(v3_finite(out->sun) && v3_length2(out->sun) > 0.5f))
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the sun has no direction");
    out->theta_sun = acos((double)clampf(out->sun.y, 0.0f, 1.0f));
    double turbidity = sheen_mi_float(m, e, "turbidity", 3.0);
    out->turbidity = fmin(fmax(turbidity, SHEEN_TURBIDITY_MIN), SHEEN_TURBIDITY_MAX);
    if (!m->status && out->turbidity != turbidity)
        sheen_xml_warn(m->log, sheen_mi_child(e, "turbidity"),
                       "the turbidity %g is outside [%g, %g], for which the sky's model holds: taken as %g", turbidity,
                       SHEEN_TURBIDITY_MIN, SHEEN_TURBIDITY_MAX, out->turbidity);
    return !m->status;
}

static void add_sky(Mitsuba *m, const SheenXml *e, const Heaven *h, double scale)
{
    if (m->has_sky) { // a scene has one environment: a file with a million skies is not to bake them all
        sheen_xml_warn(m->log, e, "a second sky is left out");
        return;
    }
    m->has_sky = true;
    Rgb *pixels = SHEEN_ARENA_NEW(m->arena, Rgb, (size_t)SKY_WIDTH * SKY_HEIGHT);
    if (!pixels) {
        sheen_mi_fail(m, SHEEN_ERR_NOMEM, e, "out of memory for the sky");
        return;
    }
    SheenSky sky = sheen_sky_make(h->turbidity, h->theta_sun);
    for (int j = 0; j < SKY_HEIGHT; ++j) {
        float theta = SHEEN_PI * (float)j / (SKY_HEIGHT - 1);
        // Rounding must not take the row on the horizon below it.
        double up = 2 * j < SKY_HEIGHT ? fmax((double)cosf(theta), 0.0) : -1.0;
        for (int i = 0; i < SKY_WIDTH; ++i) {
            float phi = 2.0f * SHEEN_PI * ((float)i + 0.5f) / SKY_WIDTH;
            Vec3 d = v3(sinf(theta) * sinf(phi), cosf(theta), -sinf(theta) * cosf(phi));
            pixels[j * SKY_WIDTH + i] = sheen_sky_radiance(&sky, up, (double)v3_dot(d, h->sun));
        }
    }
    SheenLight l = {.kind = SHEEN_LIGHT_ENVIRONMENT,
                    .radiance = rgb_gray((float)scale),
                    .environment = {.width = SKY_WIDTH, .height = SKY_HEIGHT, .floats = pixels},
                    .to_world = h->to_world};
    sheen_builder_add_light(m->builder, &l);
}

/** @return the angular radius of the disk, radians: Mitsuba 3 asks for the width, those before for a factor on it. */
static double sun_disk(Mitsuba *m, const SheenXml *e)
{
    const double widest = 90.0;
    double scale = sheen_mi_float(m, e, "sun_radius_scale", 1.0);
    double width = sheen_mi_float(m, e, "sun_aperture", SHEEN_SUN_WIDTH) * scale;
    if (width >= 0.0 && width <= widest) return 0.5 * width * (double)SHEEN_PI / 180.0;
    if (!m->status)
        sheen_xml_warn(m->log, e, "the sun's width of %g degrees is outside [0, %g]: taken as %g", width, widest,
                       SHEEN_SUN_WIDTH);
    return 0.5 * SHEEN_SUN_WIDTH * (double)SHEEN_PI / 180.0;
}

void sheen_mi_sky(Mitsuba *m, SheenXml *e)
{
    const char *type = sheen_mi_type(e);
    bool has_sky = !sheen_mi_same(type, "sun"), has_sun = !sheen_mi_same(type, "sky");
    double scale = sheen_mi_float(m, e, "scale", 1.0);
    double sky = sheen_mi_float(m, e, "sky_scale", scale), sun = sheen_mi_float(m, e, "sun_scale", scale);
    Heaven h;
    if (!read_heaven(m, e, &h)) return;
    // The model has no ground; the sun's disk is even; how Mitsuba stores it.
    sheen_mi_ignore(e, "albedo complex_sun resolution samples_per_pixel");
    double disk = sun_disk(m, e);
    if (h.sun.y < 0.0f) {
        sheen_xml_warn(m->log, e, "the sun of '%s' is below the horizon: the light is left out", type);
        return;
    }
    if (has_sky && sky != 0.0) add_sky(m, e, &h, sky);
    SheenLight l = {.kind = SHEEN_LIGHT_DIRECTIONAL, .direction = v3_neg(h.to_sun), .disk = (float)disk};
    l.radiance = rgb_scale(sheen_sun_irradiance(h.turbidity, h.theta_sun), (float)sun);
    if (has_sun && sun != 0.0) sheen_builder_add_light(m->builder, &l);
}
