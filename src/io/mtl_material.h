// SPDX-License-Identifier: Apache-2.0
// Materials of Wavefront libraries become materials of the scene.
#ifndef SHEEN_IO_MTL_MATERIAL_H
#define SHEEN_IO_MTL_MATERIAL_H

#include "io/mtl.h"
#include "scene/builder.h"

/** What is taken from a picture. */
typedef enum MtlUse {
    MTL_COLOR,
    MTL_NUMBERS, // bytes are linear
    MTL_ALPHA,   // its alpha channel, which a picture may lack
    MTL_OPACITY, // that, else its numbers
} MtlUse;

/** A picture that is in memory already. */
typedef struct MtlPicture {
    const char *path;
    Rgb factor; // its values are multiplied by this
    MtlUse use;
    SheenBitmap bitmap; // without pixels where there is no alpha
    struct MtlPicture *next;
} MtlPicture;

typedef struct MtlReader {
    const SheenLog *log;
    SheenBuilder *builder;
    SheenArena *arena;   // of the scene
    SheenArena *scratch; // lives as long as the reader
    const char *scene;   // the OBJ file: pictures are looked for beside the library and beside it
    MtlPicture *pictures;
} MtlReader;

/**
 * Adds what a library's material means (docs/obj-scenes.md) to the builder.
 * @param index  of the scene's material
 * Errors: SHEEN_ERR_NOMEM, and those of pictures that are broken. One that is not there is a warning.
 */
SHEEN_NODISCARD SheenStatus sheen_mtl_add(MtlReader *r, const MtlMaterial *m, uint32_t *index);

#endif
