// SPDX-License-Identifier: Apache-2.0
// Lights at a point that shine into a cone or a window, evenly or with a picture.
#ifndef SHEEN_LIGHT_SPOT_H
#define SHEEN_LIGHT_SPOT_H

#include "scene/scene.h"

/** @return the factor on a spot light's intensity at an angle from its axis with this cosine, [0, 1]. */
float sheen_spot_falloff(const SheenLight *light, float cos_angle);

/**
 * @param light  point, spot or projector
 * @param w      unit, the way the light travels
 * @return intensity, W/sr. Pure, thread-safe. Source: jakob2022-mitsuba3, plugins spot and projector.
 */
Rgb sheen_spot_intensity(const SheenLight *light, Vec3 w);

#endif
