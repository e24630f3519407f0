// SPDX-License-Identifier: Apache-2.0
// Exact spheres and disks as Embree user geometry.
#ifndef SHEEN_RAY_QUADRIC_H
#define SHEEN_RAY_QUADRIC_H

#include "ray/holes.h"

/**
 * Makes the geometry of a sphere or disk.
 * @param shape  borrowed as the geometry's user pointer; must outlive it
 * @return a new, committed geometry owned by the caller, or NULL when Embree failed
 */
RTCGeometry sheen_quadric_geometry(RTCDevice device, TracedShape *shape);

#endif
