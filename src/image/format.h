// SPDX-License-Identifier: Apache-2.0
// What a picture format is to image.c: one constant table of functions for each, chosen once. Inner header.
#ifndef SHEEN_IMAGE_FORMAT_H
#define SHEEN_IMAGE_FORMAT_H

#include "image/image.h"

/** An encoded picture in memory; borrowed. */
typedef struct ImageSource {
    const uint8_t *data;
    size_t size;
    const char *name; // for messages
    const SheenLog *log;
} ImageSource;

/** 8-bit pixels as stored: [height][width][3], gamma-encoded, row 0 on top; from malloc. */
typedef struct ImageBytes {
    uint32_t width, height;
    uint8_t *pixels;
} ImageBytes;

/** An encoded picture that grows; `data` is from malloc. All zero is empty. */
typedef struct ImageBuffer {
    uint8_t *data;
    size_t size, capacity;
} ImageBuffer;

/** What is encoded, and whom to tell. */
typedef struct ImageTarget {
    const SheenImageView *view;
    float exposure;   // stops
    const char *name; // for messages
    const SheenLog *log;
} ImageTarget;

/** Reads the layers of an EXR file, which `out`'s owner frees in failure too. Warnings are left to reading its colour.
 */
SHEEN_NODISCARD SheenStatus sheen_exr_decode_layers(const ImageSource *source, SheenImageLayers *out);

/** Which channels of a picture are wanted. */
typedef enum ImageChannels { IMAGE_RGB, IMAGE_ALPHA } ImageChannels;

/**
 * A format. A decoder leaves `out` for its caller to free in failure too, so that it may stop anywhere.
 * Exactly one of `decode` and `decode_bytes` may be NULL; `encode` is NULL where the format is only read.
 */
typedef struct ImageFormat {
    const char *endings[4]; // lower case with the dot, NULL at the end
    bool (*recognize)(const uint8_t *data, size_t size);
    SheenStatus (*decode)(const ImageSource *source, SheenImage *out);
    /** For alpha, spread to three channels, the pixels stay NULL where there is none. */
    SheenStatus (*decode_bytes)(const ImageSource *source, ImageChannels channels, ImageBytes *out);
    SheenStatus (*encode)(const ImageTarget *target, ImageBuffer *out);
} ImageFormat;

extern const ImageFormat sheen_format_exr, sheen_format_hdr, sheen_format_pfm, sheen_format_png, sheen_format_jpeg,
    sheen_format_bmp, sheen_format_tga, sheen_format_pnm;

/**
 * Checks a size that a file claims against the limits of image.h and against the length of the file, so that some bytes
 * cannot claim gigabytes. To be called before anything is allocated.
 */
SHEEN_NODISCARD SheenStatus sheen_image_check_size(const ImageSource *source, uint64_t width, uint64_t height);

/** Checks the size and allocates black pixels, owned by `out`. */
SHEEN_NODISCARD SheenStatus sheen_image_alloc(const ImageSource *source, uint64_t width, uint64_t height,
                                              SheenImage *out);
SHEEN_NODISCARD SheenStatus sheen_image_alloc_bytes(const ImageSource *source, uint64_t width, uint64_t height,
                                                    ImageBytes *out);

/** Writes `size` bytes at `offset`, growing the buffer; a gap is filled with zeros. @return false: out of memory. */
bool sheen_buffer_write(ImageBuffer *buffer, size_t offset, const void *data, size_t size);

/** Appends. @return false when out of memory. */
static inline bool buffer_append(ImageBuffer *buffer, const void *data, size_t size)
{
    return sheen_buffer_write(buffer, buffer->size, data, size);
}

/** Turns [n][4] pixels into [n][3], each channel the fourth of before, in place. */
void sheen_image_spread_alpha(uint8_t *pixels, size_t n);

/** Fails with "NAME: out of memory". */
SheenStatus sheen_image_no_memory(const char *name, const SheenLog *log);

#endif
