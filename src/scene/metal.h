// SPDX-License-Identifier: Apache-2.0
// Refractive indices of named metals.
#ifndef SHEEN_SCENE_METAL_H
#define SHEEN_SCENE_METAL_H

#include "math/vec.h"

/**
 * Named conductors as Mitsuba spells them ("Au", "Cu", "Al", "Na_palik", ...; "_palik" may be left out); "none" is a
 * perfect mirror (eta 0, k 1).
 * @param eta, k  complex refractive index in linear sRGB; set only when the name is known
 * @return false for an unknown name
 */
bool sheen_metal_find(const char *name, Rgb *eta, Rgb *k);

#endif
