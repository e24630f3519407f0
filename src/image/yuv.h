// SPDX-License-Identifier: Apache-2.0
// Pictures as video has them: brightness for each pixel, colour for every second both ways.
#ifndef SHEEN_IMAGE_YUV_H
#define SHEEN_IMAGE_YUV_H

#include "base/status.h"
#include "math/vec.h"

#include <stddef.h>
#include <stdint.h>

/** Planes of 8 bits, limited range: [0] brightness, [1] blue and [2] red difference, of half the size. Borrowed. */
typedef struct SheenYuv {
    uint8_t *plane[3];
    size_t stride[3]; // bytes from row to row
} SheenYuv;

/** @return the side of a picture with room for whole pairs of pixels. */
static inline uint32_t sheen_yuv_side(uint32_t side)
{
    return side + (side & 1u);
}

/**
 * Encodes linear light by the sRGB curve and the matrix of BT.709. Colour is filtered and stands at the left of each
 * pair of columns and between its rows, as in H.264 and VP9. A row or column that is missing repeats the last.
 * @param pixels    [height][width], linear sRGB primaries; what is not finite or out of range is clamped, NaN black
 * @param exposure  stops
 * @param out       planes of sheen_yuv_side(width) x sheen_yuv_side(height) and half of it
 * Errors: SHEEN_ERR_NOMEM. Source: itu2015-bt709.
 */
SHEEN_NODISCARD SheenStatus sheen_yuv_encode(const Rgb *pixels, uint32_t width, uint32_t height, float exposure,
                                             const SheenYuv *out);

#endif
