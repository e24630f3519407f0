// SPDX-License-Identifier: Apache-2.0
#include "light/spot.h"

float sheen_spot_falloff(const SheenLight *light, float cos_angle)
{
    if (cos_angle >= light->cos_inner) return 1.0f;
    if (!(cos_angle > light->cos_outer)) return 0.0f;
    float outer = acosf(light->cos_outer);
    return (outer - acosf(cos_angle)) / (outer - acosf(light->cos_inner));
}

// What the picture has in a direction of the light's own space, and nothing beyond its window.
static Rgb picture_of(const SheenLight *light, Vec3 local)
{
    if (!(local.z > 0.0f)) return rgb_gray(0.0f);
    float x = local.x / (local.z * light->tan_x), y = local.y / (local.z * light->tan_y);
    if (!(fabsf(x) <= 1.0f && fabsf(y) <= 1.0f)) return rgb_gray(0.0f);
    Rgb c = sheen_texture_eval(light->texture, v2(0.5f + 0.5f * x, 0.5f - 0.5f * y));
    return rgb(maxf(c.r, 0.0f), maxf(c.g, 0.0f), maxf(c.b, 0.0f));
}

Rgb sheen_spot_intensity(const SheenLight *light, Vec3 w)
{
    if (light->kind == SHEEN_LIGHT_POINT) return light->radiance;
    if (light->kind == SHEEN_LIGHT_SPOT) {
        float falloff = sheen_spot_falloff(light, v3_dot(w, light->direction));
        Rgb all = rgb_scale(light->radiance, falloff);
        if (!light->texture || falloff == 0.0f) return all;
        return rgb_mul(all, picture_of(light, transform_vector(&light->to_light, w)));
    }
    // On a plane across the axis the picture keeps its brightness up to the borders.
    Vec3 local = transform_vector(&light->to_light, w);
    float cosine = local.z / v3_length(local);
    if (!(cosine > 0.0f)) return rgb_gray(0.0f);
    return rgb_scale(rgb_mul(light->radiance, picture_of(light, local)), 1.0f / (cosine * cosine * cosine));
}
