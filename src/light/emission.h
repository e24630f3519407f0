// SPDX-License-Identifier: Apache-2.0
// What a surface emits: the same everywhere, or by a texture.
#ifndef SHEEN_LIGHT_EMISSION_H
#define SHEEN_LIGHT_EMISSION_H

#include "light/light.h"

/** @return radiance of an area light at a point of its surface; W m^-2 sr^-1. Pure, thread-safe. */
static inline Rgb sheen_emission(const SheenScene *scene, const SheenLight *light, const SurfacePoint *s)
{
    if (!light->texture) return light->radiance;
    Rgb c = sheen_surface_texture(scene, light->texture, s); // of a picture, which may hold anything
    return rgb(maxf(c.r, 0.0f), maxf(c.g, 0.0f), maxf(c.b, 0.0f));
}

/**
 * The same at a point on the light's shape.
 * @param triangle  of a mesh the one that holds q; SHEEN_NONE to look for it, in a mesh whose triangles lie in a plane
 */
Rgb sheen_emission_at(const SheenScene *scene, const SheenLight *light, uint32_t triangle, Vec3 q);

/**
 * @return the mean over the light's surface of the mean of the channels: what a choice among lights goes by. Of a
 *         texture it is an estimate, at a thousand points or more, and above zero wherever some of the texture is.
 */
float sheen_emission_mean(const SheenScene *scene, const SheenLight *light);

#endif
