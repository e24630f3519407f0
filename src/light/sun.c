// SPDX-License-Identifier: Apache-2.0
#include "light/sun.h"

#include "math/warp.h"

// The integral of the cosine over a cone of half-angle r about the normal is pi sin^2 r, its solid angle
// 2 pi (1 - cos r).
SunDisk sheen_sun_disk(const SheenLight *light)
{
    double s = sin((double)light->disk), sin2 = s * s, height = sin2 / (1.0 + cos((double)light->disk));
    return (SunDisk){.frame = frame_from_normal(v3_neg(light->direction)),
                     .height = (float)height,
                     .sin2 = (float)sin2,
                     .radiance = rgb_scale(light->radiance, (float)(1.0 / (3.14159265358979324 * sin2))),
                     .pdf = (float)(1.0 / (2.0 * 3.14159265358979324 * height))};
}

Vec3 sheen_sun_disk_sample(const SunDisk *disk, Vec2 u)
{
    return v3_normalize(frame_to_world(&disk->frame, warp_cone(u, disk->height)));
}
