// SPDX-License-Identifier: Apache-2.0
// Normals that are smooth where a surface bends and sharp where it has an edge.
#ifndef SHEEN_IO_MESH_SMOOTH_H
#define SHEEN_IO_MESH_SMOOTH_H

#include "io/mesh.h"

/**
 * Gives the mesh new normals: at each corner of a triangle the normals, weighted by their angles, of those triangles at
 * the same place that belong with it. Vertices are split where normals differ; uv go along.
 * @param groups     [n_triangles] triangles of the same group belong together, those of group 0 with none; NULL: all
 *                   belong together
 * @param max_angle  largest angle between two triangles that belong together, radians
 * @return false when out of memory; the mesh is then as it was
 * Source: thuermer1998-normals, for the weights.
 */
bool sheen_mesh_smooth_edges(SheenArena *arena, MeshData *m, const uint32_t *groups, float max_angle);

#endif
