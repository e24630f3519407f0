// SPDX-License-Identifier: Apache-2.0
#include "text_buffer.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/** Makes room for `more` characters and the zero. @return where they go, or NULL */
static char *reserve(TextBuffer *b, size_t more)
{
    if (b->failed) return NULL;
    if (b->capacity - b->size <= more) {
        size_t capacity = (b->size + more) * 2 + 1024;
        char *grown = realloc(b->text, capacity);
        if (!grown) {
            b->failed = true;
            return NULL;
        }
        b->text = grown;
        b->capacity = capacity;
    }
    return b->text + b->size;
}

static void add_bytes(TextBuffer *b, const char *text, size_t size)
{
    char *to = reserve(b, size);
    if (!to) return;
    memcpy(to, text, size);
    to[size] = 0;
    b->size += size;
}

void text_add(TextBuffer *buffer, const char *text)
{
    add_bytes(buffer, text, strlen(text));
}

void text_add_format(TextBuffer *buffer, const char *format, ...)
{
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    int n = vsnprintf(NULL, 0, format, args);
    va_end(args);
    char *to = n >= 0 ? reserve(buffer, (size_t)n) : NULL;
    if (to) {
        vsnprintf(to, (size_t)n + 1, format, again);
        buffer->size += (size_t)n;
    }
    va_end(again);
}

void text_add_escaped(TextBuffer *buffer, const char *text)
{
    for (const char *c = text; *c; ++c) {
        switch (*c) {
        case '&':
            text_add(buffer, "&amp;");
            break;
        case '<':
            text_add(buffer, "&lt;");
            break;
        case '>':
            text_add(buffer, "&gt;");
            break;
        case '"':
            text_add(buffer, "&quot;");
            break;
        default:
            add_bytes(buffer, (unsigned char)*c < ' ' ? "?" : c, 1);
        }
    }
}

void text_add_base64(TextBuffer *buffer, const uint8_t *data, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *to = reserve(buffer, (size + 2) / 3 * 4);
    if (!to) return;
    for (size_t i = 0; i < size; i += 3) {
        uint32_t three = (uint32_t)data[i] << 16 | (uint32_t)(i + 1 < size ? data[i + 1] : 0) << 8 |
                         (uint32_t)(i + 2 < size ? data[i + 2] : 0);
        *to++ = digits[three >> 18];
        *to++ = digits[three >> 12 & 63];
        *to++ = i + 1 < size ? digits[three >> 6 & 63] : '=';
        *to++ = i + 2 < size ? digits[three & 63] : '=';
    }
    *to = 0;
    buffer->size = (size_t)(to - buffer->text);
}

void text_free(TextBuffer *buffer)
{
    free(buffer->text);
    *buffer = (TextBuffer){0};
}
