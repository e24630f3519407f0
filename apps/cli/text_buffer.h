// SPDX-License-Identifier: Apache-2.0
// A text that grows. Running out of memory is remembered, so that one look at the end is enough.
#ifndef SHEEN_CLI_TEXT_BUFFER_H
#define SHEEN_CLI_TEXT_BUFFER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct TextBuffer {
    char *text; // ends with a zero; from malloc; NULL while nothing was added
    size_t size, capacity;
    bool failed;
} TextBuffer;

void text_add(TextBuffer *buffer, const char *text);
void text_add_format(TextBuffer *buffer, const char *format, ...) __attribute__((format(printf, 2, 3)));

/** Adds a text that HTML shows as it is. */
void text_add_escaped(TextBuffer *buffer, const char *text);

/** Adds bytes in base 64. Source: rfc4648, section 4. */
void text_add_base64(TextBuffer *buffer, const uint8_t *data, size_t size);

void text_free(TextBuffer *buffer);

#endif
