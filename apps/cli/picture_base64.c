// SPDX-License-Identifier: Apache-2.0
#include "picture_base64.h"

#include <stdlib.h>

SheenStatus picture_base64_add(const char *format, uint32_t width, uint32_t height, const Rgb *pixels, const char *page,
                               const SheenLog *log, TextBuffer *out)
{
    SheenImageView view = {.width = width, .height = height, .pixels = pixels};
    uint8_t *data;
    size_t size;
    SheenStatus status = sheen_image_encode(format, &view, 0.0f, log, &data, &size);
    if (status) return status;
    text_add_base64(out, data, size);
    free(data);
    return out->failed ? sheen_fail(log, SHEEN_ERR_NOMEM, "%s: out of memory", page) : SHEEN_OK;
}
