// SPDX-License-Identifier: Apache-2.0
// Textures: a constant, a bitmap, a checkerboard or a grid over uv.
#ifndef SHEEN_SCENE_TEXTURE_H
#define SHEEN_SCENE_TEXTURE_H

#include "math/vec.h"

#include <stdint.h>

/** Pixels of a bitmap texture: 8-bit with a table that maps each byte to a linear value, or float. */
typedef struct SheenBitmap {
    uint32_t width, height;
    const uint8_t *bytes; // [height][width][3], NULL when float; row 0 is the top of the picture
    const Rgb *floats;    // [height][width], NULL when bytes
    const float *decode;  // [256], byte to linear value (sRGB curve, or x/255 for raw data)
} SheenBitmap;

typedef enum SheenTextureKind {
    SHEEN_TEXTURE_CONSTANT,
    SHEEN_TEXTURE_BITMAP,
    SHEEN_TEXTURE_CHECKERBOARD,
    SHEEN_TEXTURE_GRID,         // lines along the borders of the unit squares
    SHEEN_TEXTURE_VERTEX_COLOR, // of the mesh, between its vertices; see sheen_surface_texture
    SHEEN_TEXTURE_FACE_COLOR    // of the mesh's triangle
} SheenTextureKind;
typedef enum SheenWrap { SHEEN_WRAP_REPEAT, SHEEN_WRAP_MIRROR, SHEEN_WRAP_CLAMP } SheenWrap;

typedef struct SheenTexture {
    SheenTextureKind kind;
    Rgb value; // constant; first colour of the checkerboard; between the lines of the grid; where a mesh has no colours
    Rgb value2; // second colour of the checkerboard; of the grid's lines
    Rgb scale;  // factor on the colours of a bitmap or a mesh
    SheenBitmap bitmap;
    SheenWrap wrap_u, wrap_v;
    bool nearest;     // nearest texel instead of bilinear
    float line_width; // grid: half the width of a line, in [0, 0.5]
    float uv[2][3];   // uv' = uv[.][0..1] (u, v) + uv[.][2]
} SheenTexture;

/** A constant texture. */
SheenTexture sheen_texture_constant(Rgb value);

/** @return true for textures of two colours, `value` and `value2`. */
static inline bool sheen_texture_has_two_values(const SheenTexture *t)
{
    return t->kind == SHEEN_TEXTURE_CHECKERBOARD || t->kind == SHEEN_TEXTURE_GRID;
}

/** @return true for the colours of a mesh, which do not follow from uv. */
static inline bool sheen_texture_is_of_mesh(const SheenTexture *t)
{
    return t->kind == SHEEN_TEXTURE_VERTEX_COLOR || t->kind == SHEEN_TEXTURE_FACE_COLOR;
}

/** Multiplies all that the texture gives. */
void sheen_texture_scale(SheenTexture *t, Rgb factor);

/**
 * @param uv  surface coordinates; v grows upward, so that (0, 0) is the lower left corner of a bitmap
 * @return the texture's linear value; bilinear unless `nearest`; `value` for the colours of a mesh. Pure, thread-safe.
 */
Rgb sheen_texture_eval(const SheenTexture *t, Vec2 uv);

/**
 * @return how the texture's luminance changes with u and v: the exact derivative of the bilinear interpolation; zero
 * for constants, checkerboards, grids and `nearest`. Pure, thread-safe.
 */
Vec2 sheen_texture_gradient(const SheenTexture *t, Vec2 uv);

/** @return the mean of the texture over the unit square of uv'. */
Rgb sheen_texture_mean(const SheenTexture *t);

#endif
