// SPDX-License-Identifier: Apache-2.0
// The disk of a sun: an even cone of light from beyond the scene.
#ifndef SHEEN_LIGHT_SUN_H
#define SHEEN_LIGHT_SUN_H

#include "scene/scene.h"

typedef struct SunDisk {
    Frame frame;  // about the way to its middle
    float height; // 1 - cos of its angular radius
    float sin2;   // of it
    Rgb radiance; // W m^-2 sr^-1
    float pdf;    // 1/sr
} SunDisk;

/** @param light  directional with a disk; the radiance is such that the irradiance of a facing surface is as it says */
SunDisk sheen_sun_disk(const SheenLight *light);

/** @return a unit direction to the disk, uniform over its solid angle. */
Vec3 sheen_sun_disk_sample(const SunDisk *disk, Vec2 u);

/** @return whether wi (unit) points to the disk. */
static inline bool sun_disk_covers(const SunDisk *disk, Vec3 wi)
{
    return v3_in_cone(wi, disk->frame.n, disk->sin2);
}

#endif
