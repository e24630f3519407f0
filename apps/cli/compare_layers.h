// SPDX-License-Identifier: Apache-2.0
// The layers of pictures on the page of `sheen compare --html`.
#ifndef SHEEN_CLI_COMPARE_LAYERS_H
#define SHEEN_CLI_COMPARE_LAYERS_H

#include "text_buffer.h"

#include "image/image.h"

/**
 * Adds an element of class ROLE-layer for each layer that a file holds beside its colour, with attributes that say what
 * it is: data-name, data-label, data-note. Colours (R, G, B) are Radiance files in base 64, as the pictures' own are.
 * All else is data: each channel a hidden PNG of one byte a pixel, 1 to 255 from data-min to data-max, in data-unit; 0
 * is what is not finite.
 * @param role  "reference" or "image"
 * @param page  the file that they are for, for messages
 * Errors: those of sheen_image_read_layers.
 */
SHEEN_NODISCARD SheenStatus compare_layers_add(const char *path, const char *role, const char *page,
                                               const SheenLog *log, TextBuffer *out);

#endif
