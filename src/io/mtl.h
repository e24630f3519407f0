// SPDX-License-Identifier: Apache-2.0
// Material libraries of Wavefront OBJ files.
#ifndef SHEEN_IO_MTL_H
#define SHEEN_IO_MTL_H

#include "base/arena.h"
#include "base/log.h"
#include "math/vec.h"

#include <stdbool.h>
#include <stdint.h>

/** A picture of a material: map_Kd and the like. */
typedef struct MtlMap {
    const char *file; // as written, with slashes; NULL when there is none
    Vec2 offset, scale;
    bool clamp;
} MtlMap;

/** What a library says of a material, in its own terms. */
typedef struct MtlMaterial {
    const char *name;
    const char *library;                                     // file name, for messages
    uint32_t line;                                           // of newmtl
    Rgb diffuse;                                             // Kd
    Rgb specular;                                            // Ks
    Rgb ambient;                                             // Ka
    Rgb emission;                                            // Ke
    Rgb filter;                                              // Tf, what a body lets through
    float shininess;                                         // Ns
    float ior;                                               // Ni
    float opacity;                                           // d, or 1 - Tr
    float roughness;                                         // Pr, negative when not given
    float metallic;                                          // Pm, negative when not given
    float sheen, clearcoat, clearcoat_roughness, anisotropy; // Ps, Pc, Pcr, aniso
    int illum;                                               // 2 when not given
    bool has_opacity;                                        // by d, which counts more than Tr
    bool has_filter;
    bool of_blender; // the library says that Blender wrote it
    MtlMap diffuse_map, opacity_map;
    MtlMap roughness_map, metallic_map; // map_Pr, map_Pm
    MtlMap normal_map;                  // norm; of Blender map_Bump, which is its name for normals
} MtlMaterial;

typedef struct MtlLibrary {
    MtlMaterial *materials; // in the arena
    uint32_t n;
} MtlLibrary;

/** A material of which nothing but the name is said, or that is defined nowhere: diffuse 0.5. `name` is borrowed. */
MtlMaterial sheen_mtl_default(const char *name);

/**
 * Reads a library. What it holds beyond the fields above is skipped, with a warning for what a picture would show.
 * @param name  stands for the file in messages
 * Errors: SHEEN_ERR_PARSE (`FILE:LINE: ...`: a number missing or not finite), SHEEN_ERR_NOMEM.
 */
SHEEN_NODISCARD SheenStatus sheen_mtl_parse(const char *text, size_t size, const char *name, SheenArena *arena,
                                            const SheenLog *log, MtlLibrary *out);

#endif
