// SPDX-License-Identifier: Apache-2.0
// TGA and BMP through stb_image.
#include "image/format.h"

#include <stdlib.h>
#include <string.h>

#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_NO_FAILURE_STRINGS                          // they would be kept in a global
#define stbi__g_failure_reason sheen_stbi_failure_reason // the one symbol that stb does not make static
#define STBI_MAX_DIMENSIONS SHEEN_IMAGE_MAX_SIDE
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
// Not restored below: GCC looks at the end of the file for functions that are declared static and never defined.
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb_image.h>
#pragma GCC diagnostic pop

/** stb reads zeros after the end of a file; we look whether it wanted any. */
typedef struct Feed {
    const ImageSource *source;
    size_t at;
    const char *ahead; // stb's own small buffer, which it fills first of all and may fill in part at the end
    bool starved;
} Feed;

static int feed_read(void *user, char *out, int size)
{
    Feed *feed = user;
    size_t left = feed->source->size - feed->at, n = size > 0 ? (size_t)size : 0;
    if (n > left) n = left;
    if (!feed->ahead) feed->ahead = out;
    if (out == feed->ahead ? n == 0 : n < (size_t)size) feed->starved = true;
    memcpy(out, feed->source->data + feed->at, n);
    feed->at += n;
    return (int)n;
}

static void feed_skip(void *user, int n)
{
    Feed *feed = user;
    size_t left = feed->source->size - feed->at;
    if (n < 0) { // back to what was looked at; never before the start
        size_t back = (size_t) - (long)n;
        feed->at -= back < feed->at ? back : feed->at;
    } else if ((size_t)n > left) {
        feed->starved = true;
        feed->at = feed->source->size;
    } else {
        feed->at += (size_t)n;
    }
}

static int feed_eof(void *user)
{
    const Feed *feed = user;
    return feed->at >= feed->source->size;
}

static const stbi_io_callbacks feed_callbacks = {feed_read, feed_skip, feed_eof};

static SheenStatus stb_decode_bytes(const ImageSource *source, ImageChannels wanted, ImageBytes *out)
{
    int width = 0, height = 0, channels;
    Feed feed = {.source = source};
    if (!stbi_info_from_callbacks(&feed_callbacks, &feed, &width, &height, &channels) || width < 0 || height < 0)
        return sheen_fail(source->log, SHEEN_ERR_PARSE, "%s: a broken or unsupported header", source->name);
    SheenStatus status = sheen_image_check_size(source, (uint64_t)width, (uint64_t)height);
    if (status) return status;
    // A run of 128 pixels takes two bytes at least, and stb fills what is missing, patiently, with black.
    if ((uint64_t)width * (uint64_t)height / 64 > source->size)
        return sheen_fail(source->log, SHEEN_ERR_PARSE, "%s: the file ends before the picture does", source->name);
    bool alpha = wanted == IMAGE_ALPHA;
    if (alpha && channels != 2 && channels != 4) return SHEEN_OK;
    feed = (Feed){.source = source};
    uint8_t *pixels = stbi_load_from_callbacks(&feed_callbacks, &feed, &width, &height, &channels, alpha ? 4 : 3);
    if (pixels && !feed.starved) {
        if (alpha) sheen_image_spread_alpha(pixels, (size_t)width * (size_t)height);
        *out = (ImageBytes){(uint32_t)width, (uint32_t)height, pixels}; // stb's allocator is malloc
        return SHEEN_OK;
    }
    stbi_image_free(pixels);
    return sheen_fail(source->log, SHEEN_ERR_PARSE, "%s: %s", source->name,
                      feed.starved ? "the file ends before the picture does" : "the pixels are broken");
}

static bool bmp_recognize(const uint8_t *data, size_t size)
{
    return size >= 26 && data[0] == 'B' && data[1] == 'M';
}

/** There is no magic number: all fields of the header must make sense. */
static bool tga_recognize(const uint8_t *data, size_t size)
{
    if (size < 18) return false;
    unsigned palette = data[1], kind = data[2] & ~8u, bits = data[16];
    bool known = palette == 1
                     ? kind == 1 && (bits == 8 || bits == 16)
                     : palette == 0 && ((kind == 2 && (bits == 15 || bits == 16 || bits == 24 || bits == 32)) ||
                                        (kind == 3 && (bits == 8 || bits == 16)));
    return known && (data[2] & ~15u) == 0 && (data[12] | data[13]) != 0 && (data[14] | data[15]) != 0;
}

const ImageFormat sheen_format_bmp = {
    .endings = {".bmp"}, .recognize = bmp_recognize, .decode_bytes = stb_decode_bytes};
const ImageFormat sheen_format_tga = {
    .endings = {".tga"}, .recognize = tga_recognize, .decode_bytes = stb_decode_bytes};
