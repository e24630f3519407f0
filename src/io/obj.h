// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ files with their parts: what a scene needs beyond the triangles (io/mesh.h: sheen_obj_parse).
#ifndef SHEEN_IO_OBJ_H
#define SHEEN_IO_OBJ_H

#include "io/mesh.h"

/** Triangles in a row that share what the statements before them set. */
typedef struct ObjRun {
    uint32_t first, n;  // triangles
    uint32_t material;  // index into the names, SHEEN_NONE before the first usemtl
    uint32_t smoothing; // group of s, 0 for none
    uint32_t object;    // counts the statements g and o
} ObjRun;

/** A statement mtllib. */
typedef struct ObjLibrary {
    const char *names; // the rest of the line: one file, or several with blanks between them
    uint32_t line;
} ObjLibrary;

/** All arrays are in the arena. */
typedef struct ObjFile {
    MeshData mesh;
    const ObjRun *runs;
    const char *const *materials; // names of usemtl, each once
    const ObjLibrary *libraries;
    uint32_t n_runs, n_materials, n_libraries;
} ObjFile;

/** Reads a file with its parts. Errors as in sheen_obj_parse. */
SHEEN_NODISCARD SheenStatus sheen_obj_parse_parts(const char *text, size_t size, const char *name, SheenArena *arena,
                                                  const SheenLog *log, ObjFile *out);

#endif
