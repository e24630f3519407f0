// SPDX-License-Identifier: Apache-2.0
// Mitsuba's basic shapes as triangles, in their own space, with normals and uv (v upward). false: out of memory.
#ifndef SHEEN_IO_PRIMITIVE_H
#define SHEEN_IO_PRIMITIVE_H

#include "io/mesh.h"

/** The square [-1, 1]^2 at z = 0, facing +z. */
bool sheen_primitive_rectangle(SheenArena *arena, MeshData *out);
/** The cube [-1, 1]^3, facing outward. */
bool sheen_primitive_cube(SheenArena *arena, MeshData *out);
/** The unit sphere, facing outward, finely tessellated. */
bool sheen_primitive_sphere(SheenArena *arena, MeshData *out);
/** The tube x^2 + y^2 = 1, 0 <= z <= 1, without lids, facing outward, finely tessellated. */
bool sheen_primitive_tube(SheenArena *arena, MeshData *out);

#endif
