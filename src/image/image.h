// SPDX-License-Identifier: Apache-2.0
// Pictures as arrays of float, and their files.
#ifndef SHEEN_IMAGE_IMAGE_H
#define SHEEN_IMAGE_IMAGE_H

#include "base/log.h"
#include "math/vec.h"

#include <stddef.h>
#include <stdint.h>

/** Largest width or height of a picture, and the most pixels it may have. */
enum { SHEEN_IMAGE_MAX_SIDE = 65536 };
#define SHEEN_IMAGE_MAX_PIXELS ((uint64_t)1 << 28)

/** A named set of channels beside the colour: an AOV. */
typedef struct SheenLayer {
    const char *name;     // "depth", "normal", ...
    unsigned n_channels;  // 1 or 3
    const char *suffixes; // channel letters: "Z", "XYZ", "RGB", "UV"+... ; n_channels of them
    const float *data;    // [height][width][n_channels]
} SheenLayer;

/** A string attribute of an EXR file. */
typedef struct SheenAttribute {
    const char *name, *value;
} SheenAttribute;

/** What is written: borrowed pointers. */
typedef struct SheenImageView {
    uint32_t width, height;
    const Rgb *pixels; // [height][width], linear sRGB primaries, row 0 on top
    const SheenLayer *layers;
    size_t n_layers;
    const SheenAttribute *attributes;
    size_t n_attributes;
} SheenImageView;

/** What is read: owned pixels. */
typedef struct SheenImage {
    uint32_t width, height;
    Rgb *pixels; // [height][width], linear, row 0 on top; from malloc
} SheenImage;

/** A layer of an EXR file beside the colour, as read. */
typedef struct SheenImageLayer {
    char *name;          // "depth"; that of the channel where it has no layer
    char *channels[3];   // full names: "depth.Z"
    unsigned n_channels; // 1 to 3; of more, the first three
    bool color;          // they are R, G and B
    float *data;         // [height][width][n_channels]
} SheenImageLayer;

/** Owned; free with sheen_image_layers_free. */
typedef struct SheenImageLayers {
    uint32_t width, height;
    SheenImageLayer *layers; // in the order of the file
    size_t n;
} SheenImageLayers;

/**
 * Writes a picture; the format follows the ending: .exr (float, all layers and attributes), .hdr, .pfm (colour only),
 * .png (8-bit sRGB after `exposure`). The file appears whole or not at all: it is written beside and renamed.
 * @param exposure  stops, for .png only: colours are scaled by 2^exposure
 * Errors: SHEEN_ERR_UNSUPPORTED for another ending, SHEEN_ERR_IO with the file's name and the reason, SHEEN_ERR_NOMEM.
 */
SHEEN_NODISCARD SheenStatus sheen_image_write(const char *path, const SheenImageView *view, float exposure,
                                              const SheenLog *log);

/**
 * The same into memory.
 * @param name  its ending chooses the format; for messages too
 * @param data  from malloc, owned by the caller; NULL on failure
 */
SHEEN_NODISCARD SheenStatus sheen_image_encode(const char *name, const SheenImageView *view, float exposure,
                                               const SheenLog *log, uint8_t **data, size_t *size);

/** @return true when sheen_image_write knows the ending of the path. */
bool sheen_image_writable_format(const char *path);

/** @return true when the path has the ending of a format that sheen_image_read knows. */
bool sheen_image_readable_format(const char *path);

/**
 * Reads .exr, .hdr, .pfm (linear) or .png, .jpg, .tga, .bmp, .ppm, .pgm (8-bit, decoded from sRGB to linear); gray is
 * spread to three channels, alpha is dropped. Of an EXR, the layer without a name.
 * @param out  zero on failure; free with sheen_image_free
 * Errors: SHEEN_ERR_IO, SHEEN_ERR_PARSE, SHEEN_ERR_UNSUPPORTED, SHEEN_ERR_NOMEM, each with one line that names the
 * file.
 */
SHEEN_NODISCARD SheenStatus sheen_image_read(const char *path, const SheenLog *log, SheenImage *out);

/** The same from memory, the format found by its first bytes; `name` is for messages. */
SHEEN_NODISCARD SheenStatus sheen_image_decode(const void *data, size_t size, const char *name, const SheenLog *log,
                                               SheenImage *out);

/**
 * Reads what an EXR file holds beside the colour that sheen_image_read takes; other formats hold nothing. Warnings are
 * left to that.
 * @param out  zero on failure
 * Errors: as sheen_image_read.
 */
SHEEN_NODISCARD SheenStatus sheen_image_read_layers(const char *path, const SheenLog *log, SheenImageLayers *out);

/** The same from memory. */
SHEEN_NODISCARD SheenStatus sheen_image_decode_layers(const void *data, size_t size, const char *name,
                                                      const SheenLog *log, SheenImageLayers *out);

void sheen_image_layers_free(SheenImageLayers *layers);

/**
 * Reads an 8-bit picture (.png, .jpg, .tga, .bmp) as bytes, not decoded, for textures.
 * @param pixels  [height][width][3] from malloc, owned by the caller
 */
SHEEN_NODISCARD SheenStatus sheen_image_read_bytes(const char *path, const SheenLog *log, uint32_t *width,
                                                   uint32_t *height, uint8_t **pixels);

/**
 * The same for the alpha channel of such a picture, spread to three channels.
 * @param pixels  NULL where it has none, or one that is opaque everywhere
 */
SHEEN_NODISCARD SheenStatus sheen_image_read_alpha(const char *path, const SheenLog *log, uint32_t *width,
                                                   uint32_t *height, uint8_t **pixels);

/** @return true when the file's ending is of an 8-bit format. */
bool sheen_image_is_8bit(const char *path);

void sheen_image_free(SheenImage *image);

/** sRGB transfer curve, [0, 1] to [0, 1]. Source: IEC 61966-2-1. */
float sheen_srgb_encode(float linear);
float sheen_srgb_decode(float encoded);

#endif
