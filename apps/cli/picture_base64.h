// SPDX-License-Identifier: Apache-2.0
// Pictures as text inside a page.
#ifndef SHEEN_CLI_PICTURE_BASE64_H
#define SHEEN_CLI_PICTURE_BASE64_H

#include "text_buffer.h"

#include "image/image.h"

/**
 * Adds pixels in base 64.
 * @param format  a name with the ending of the format
 * @param page    the file that they are for, for messages
 * Errors: SHEEN_ERR_NOMEM, reported.
 */
SHEEN_NODISCARD SheenStatus picture_base64_add(const char *format, uint32_t width, uint32_t height, const Rgb *pixels,
                                               const char *page, const SheenLog *log, TextBuffer *out);

#endif
