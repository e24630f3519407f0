// SPDX-License-Identifier: Apache-2.0
// The channels of an EXR file beside its colour, put together to layers. Inner header.
#ifndef SHEEN_IMAGE_EXR_LAYERS_H
#define SHEEN_IMAGE_EXR_LAYERS_H

#include "image/exr.h"

/** A channel of a part, and where its values go: those of pixel i to first[i * stride]. */
typedef struct ExrPlane {
    const char *channel; // full name; borrowed
    float *first;        // NULL where nobody wants it
    size_t stride;
} ExrPlane;

/** The most channels of a part that are looked through for layers. */
enum { SHEEN_EXR_CHANNELS_MAX = 1024 };

/**
 * Lists the layers of a part, all values 0, and where its channels go.
 * @param color   [3] channels of the colour, which are left out; NULL where missing
 * @param out     its size is set; gains the layers, which its owner frees in failure too
 * @param planes  [n] of the part's channels
 * Errors: SHEEN_ERR_UNSUPPORTED for too many channels, or more values than the largest picture has, SHEEN_ERR_NOMEM.
 */
SHEEN_NODISCARD SheenStatus sheen_exr_list_layers(const ImageSource *source, int n, const char *const color[3],
                                                  SheenImageLayers *out, ExrPlane planes[]);

#endif
