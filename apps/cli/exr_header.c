// SPDX-License-Identifier: Apache-2.0
// Source: OpenEXR, "OpenEXR File Layout": magic number, version, then attributes (name, type, size, value) up to an
// empty name. All numbers are little-endian.
#include "exr_header.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HEADER_MAX = 1 << 20, MAGIC = 20000630, CHANNEL_FIXED = 16 };

/** Bytes of the file's start that are still to be read. */
typedef struct Bytes {
    const unsigned char *at, *end;
} Bytes;

static bool read_u32(Bytes *b, uint32_t *out)
{
    if (b->end - b->at < 4) return false;
    *out = b->at[0] | (uint32_t)b->at[1] << 8 | (uint32_t)b->at[2] << 16 | (uint32_t)b->at[3] << 24;
    b->at += 4;
    return true;
}

/** @return a text that ends in a zero byte, or NULL when the bytes end before. */
static const char *read_name(Bytes *b)
{
    const unsigned char *zero = memchr(b->at, 0, (size_t)(b->end - b->at));
    if (!zero) return NULL;
    const char *name = (const char *)b->at;
    b->at = zero + 1;
    return name;
}

static void list_channels(Bytes value, json_t *channels)
{
    for (;;) {
        const char *name = read_name(&value);
        if (!name || !*name || value.end - value.at < CHANNEL_FIXED) return;
        json_array_append_new(channels, json_string(name));
        value.at += CHANNEL_FIXED; // pixel type, linearity, sampling
    }
}

static void read_attributes(Bytes b, json_t *channels, json_t *attributes)
{
    uint32_t magic, version, size;
    if (!read_u32(&b, &magic) || magic != MAGIC || !read_u32(&b, &version)) return;
    for (;;) {
        const char *name = read_name(&b);
        if (!name || !*name) return;
        const char *type = read_name(&b);
        if (!type || !read_u32(&b, &size) || size > (size_t)(b.end - b.at)) return;
        Bytes value = {b.at, b.at + size};
        b.at += size;
        if (strcmp(type, "chlist") == 0) list_channels(value, channels);
        if (strcmp(type, "string") == 0)
            json_object_set_new(attributes, name, json_stringn((const char *)value.at, size));
    }
}

void exr_header_read(const char *path, json_t *channels, json_t *attributes)
{
    unsigned char *data = malloc(HEADER_MAX);
    FILE *file = data ? fopen(path, "rb") : NULL;
    if (file) {
        size_t n = fread(data, 1, HEADER_MAX, file);
        fclose(file);
        read_attributes((Bytes){data, data + n}, channels, attributes);
    }
    free(data);
}
