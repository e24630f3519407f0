// SPDX-License-Identifier: Apache-2.0
// Triangle meshes on their way from a file into the scene.
#ifndef SHEEN_IO_MESH_H
#define SHEEN_IO_MESH_H

#include "base/arena.h"
#include "base/log.h"
#include "scene/scene.h"

/** A mesh whose arrays may still be changed; all from the scene's arena. Shapes as in SheenMesh. */
typedef struct MeshData {
    uint32_t n_vertices, n_triangles;
    Vec3 *p;
    Vec3 *n;                  // NULL when there are none
    Vec2 *uv;                 // NULL when there are none; v grows upward
    uint32_t (*triangles)[3]; // indices are in range
    Rgb *color, *face_color;  // of vertices, of triangles; NULL when there are none
} MeshData;

/** Allocates positions and triangles, and normals and uv as asked. @return false when out of memory. */
bool sheen_mesh_alloc(SheenArena *arena, MeshData *m, bool normals, bool uv);

/**
 * Moves the mesh: positions and, with the inverse transpose, normals.
 * @return false, and positions moved only, when the transform is singular: the normals are then dropped
 */
bool sheen_mesh_place(MeshData *m, const Transform *to_world);

/** Gives the mesh vertex normals: the faces' normals weighted by their angles. @return false when out of memory.
 *  Source: thuermer1998-normals. */
bool sheen_mesh_smooth(SheenArena *arena, MeshData *m);

/** Orders the vertices of each triangle so that its front is the side to which its shading normals point. */
void sheen_mesh_face_normals_side(MeshData *m);

/** Turns the mesh inside out: vertex order and normals. */
void sheen_mesh_flip(MeshData *m);

/** The mesh as the scene takes it. */
SheenMesh sheen_mesh_finish(const MeshData *m);

/** Makes room for `needed` items in an array from malloc, doubling it. @return false when out of memory. */
bool sheen_reserve(void **array, uint32_t *capacity, uint64_t needed, size_t item_size);

// ---- readers ----------------------------------------------------------------------------------------------------

/**
 * Reads Wavefront OBJ: v (with a colour where six numbers stand), vt, vn and f; everything else is skipped. Polygons
 * are cut (io/polygon.h).
 * @param name  stands for the file in messages
 * Errors: SHEEN_ERR_PARSE (`FILE:LINE: ...`: a missing number, a vertex index out of range), SHEEN_ERR_NOMEM. Normals
 * and texture coordinates that are not there are a warning.
 */
SHEEN_NODISCARD SheenStatus sheen_obj_parse(const char *text, size_t size, const char *name, SheenArena *arena,
                                            const SheenLog *log, MeshData *out);

/**
 * Reads PLY, ASCII or binary of either byte order: x y z, nx ny nz, (u v | s t | texture_u texture_v | texture_s
 * texture_t) of `vertex`, vertex_indices or vertex_index of `face` and `tristrips`, and (r g b | red green blue) of
 * vertices and faces, integers over their type's largest value; everything else is skipped.
 * Polygons are cut (io/polygon.h). Errors: SHEEN_ERR_PARSE (`FILE: ...`, with a line where there is one),
 * SHEEN_ERR_NOMEM.
 */
SHEEN_NODISCARD SheenStatus sheen_ply_parse(const char *data, size_t size, const char *name, SheenArena *arena,
                                            const SheenLog *log, MeshData *out);

/**
 * Reads one mesh of a file of Mitsuba's serialized meshes, version 3 or 4.
 * @param index         which of the file's meshes, from 0
 * @param face_normals  whether the mesh is to be shaded flat
 * Errors: SHEEN_ERR_PARSE and SHEEN_ERR_UNSUPPORTED (`FILE: ...`), SHEEN_ERR_NOMEM.
 */
SHEEN_NODISCARD SheenStatus sheen_serialized_parse(const char *data, size_t size, const char *name, uint32_t index,
                                                   SheenArena *arena, const SheenLog *log, MeshData *out,
                                                   bool *face_normals);

#endif
