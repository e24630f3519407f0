// SPDX-License-Identifier: Apache-2.0
// Materials of Wavefront libraries become materials of the scene.
#ifndef SHEEN_IO_MTL_MATERIAL_H
#define SHEEN_IO_MTL_MATERIAL_H

#include "io/mtl.h"
#include "scene/scene.h"

/** A picture that is in memory already. */
typedef struct MtlPicture {
    const char *path;
    Rgb factor; // its values are multiplied by this
    SheenBitmap bitmap;
    struct MtlPicture *next;
} MtlPicture;

typedef struct MtlReader {
    const SheenLog *log;
    SheenArena *arena;   // of the scene
    SheenArena *scratch; // lives as long as the reader
    const char *scene;   // the OBJ file: pictures are looked for beside the library and beside it
    MtlPicture *pictures;
    uint32_t n_highlights; // materials whose highlight is left out
} MtlReader;

/** What stands in for a material that is defined nowhere: diffuse 0.5. `name` is borrowed. */
MtlMaterial sheen_mtl_default(const char *name);

/**
 * @param out  a material for the builder; its name is in the arena of the scene
 * The format's models of light are mapped like this, in this order:
 * - a body that lets light through (illum 6 or 7; or 4, 9 or d below 0.05, with Ni above 1) is smooth glass of the
 *   index Ni; the hue of Tf tints light that went in and out again. Without Ni above 1 it is a pane that does not bend
 *   light;
 * - a mirror (illum 3 or 5 with Ks above Kd) is a metal that reflects Ks;
 * - anything else is diffuse: Kd, or map_Kd times Kd unless that is black. Both sides look alike.
 * Errors: SHEEN_ERR_NOMEM. A picture that cannot be read is a warning, and Kd stands in.
 */
SHEEN_NODISCARD SheenStatus sheen_mtl_convert(MtlReader *r, const MtlMaterial *m, SheenMaterial *out);

#endif
