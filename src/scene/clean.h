// SPDX-License-Identifier: Apache-2.0
// Takes out of shapes what cannot be hit or shaded, so that no later stage has to look for it.
#ifndef SHEEN_SCENE_CLEAN_H
#define SHEEN_SCENE_CLEAN_H

#include "base/arena.h"
#include "scene/scene.h"

/** Coordinates beyond this are taken for infinite: their squares must fit a float. */
#define SHEEN_COORDINATE_MAX 1e18f

/** @return true when all coordinates are numbers within SHEEN_COORDINATE_MAX. */
bool sheen_position_ok(Vec3 p);

/**
 * Drops triangles with non-finite vertices or without area and makes unusable shading normals face normals. Arrays
 * that change are replaced by new ones from the arena.
 * @param mesh     indices must be in range
 * @param dropped  number of triangles taken out
 * @return false when out of memory
 */
bool sheen_mesh_clean(SheenArena *arena, SheenMesh *mesh, uint32_t *dropped);

/** @return the box of a shape; empty for a mesh without triangles. */
Bounds sheen_shape_bounds(const SheenShape *shape);

#endif
