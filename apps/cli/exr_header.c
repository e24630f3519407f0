// SPDX-License-Identifier: Apache-2.0
// Source: OpenEXR, "OpenEXR File Layout": magic number, version, then attributes (name, type, size, value) up to an
// empty name. A file of several parts has a header for each, and an empty one after the last. All numbers are
// little-endian.
#include "exr_header.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HEADER_MAX = 1 << 20, MAGIC = 20000630, MULTI_PART = 1 << 12, CHANNEL_FIXED = 16, NAME_MAX_BYTES = 256 };

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

/** One attribute of a header. */
typedef struct Attribute {
    const char *name, *type;
    Bytes value;
} Attribute;

/** @return false at the end of the header, and where the bytes end before; *b is then behind it, or NULL. */
static bool next_attribute(Bytes *b, Attribute *out)
{
    uint32_t size;
    out->name = read_name(b);
    if (out->name && !*out->name) return false;
    out->type = out->name ? read_name(b) : NULL;
    if (!out->type || !read_u32(b, &size) || size > (size_t)(b->end - b->at)) {
        b->at = NULL;
        return false;
    }
    out->value = (Bytes){b->at, b->at + size};
    b->at += size;
    return true;
}

/** Writes "PART." for the header that starts here; "" when it has no name. */
static void find_prefix(Bytes header, char prefix[NAME_MAX_BYTES])
{
    prefix[0] = '\0';
    for (Attribute a; next_attribute(&header, &a);)
        if (strcmp(a.name, "name") == 0 && strcmp(a.type, "string") == 0)
            snprintf(prefix, NAME_MAX_BYTES, "%.*s.", (int)(a.value.end - a.value.at), (const char *)a.value.at);
}

static void list_channels(Bytes value, const char *prefix, json_t *channels)
{
    for (;;) {
        const char *name = read_name(&value);
        if (!name || !*name || value.end - value.at < CHANNEL_FIXED) return;
        json_array_append_new(channels, json_sprintf("%s%s", prefix, name));
        value.at += CHANNEL_FIXED; // pixel type, linearity, sampling
    }
}

static void add_text(const Attribute *a, const char *prefix, json_t *attributes)
{
    json_t *key = json_sprintf("%s%s", prefix, a->name);
    if (!key) return; // no UTF-8
    size_t size = (size_t)(a->value.end - a->value.at);
    json_object_set_new(attributes, json_string_value(key), json_stringn((const char *)a->value.at, size));
    json_decref(key);
}

static void read_headers(Bytes b, json_t *channels, json_t *attributes)
{
    uint32_t magic, version;
    if (!read_u32(&b, &magic) || magic != MAGIC || !read_u32(&b, &version)) return;
    bool several = version & MULTI_PART;
    do {
        char prefix[NAME_MAX_BYTES] = "";
        if (several) find_prefix(b, prefix);
        for (Attribute a; next_attribute(&b, &a);) {
            if (strcmp(a.type, "chlist") == 0) list_channels(a.value, prefix, channels);
            if (strcmp(a.type, "string") == 0) add_text(&a, prefix, attributes);
        }
    } while (several && b.at && b.at < b.end && *b.at != 0);
}

void exr_header_read(const char *path, json_t *channels, json_t *attributes)
{
    unsigned char *data = malloc(HEADER_MAX);
    FILE *file = data ? fopen(path, "rb") : NULL;
    if (file) {
        size_t n = fread(data, 1, HEADER_MAX, file);
        fclose(file);
        read_headers((Bytes){data, data + n}, channels, attributes);
    }
    free(data);
}
