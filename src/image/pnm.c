// SPDX-License-Identifier: Apache-2.0
// Binary portable graymaps and pixmaps, P5 and P6, of 8 or 16 bits.
// Source: Netpbm, "PGM format specification" and "PPM format specification".
#include "image/format.h"

/** What stands before the pixels. */
typedef struct PnmHeader {
    unsigned channels;
    uint32_t numbers[3]; // width, height, the value of white
    size_t size;
} PnmHeader;

static bool is_space(uint8_t c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

static bool is_digit(uint8_t c)
{
    return c >= '0' && c <= '9';
}

/** @return where the space and the comments that begin at `at` end. */
static size_t skip_space(const ImageSource *source, size_t at)
{
    bool comment = false;
    for (; at < source->size; ++at) {
        uint8_t c = source->data[at];
        if (comment)
            comment = c != '\n' && c != '\r';
        else if (c == '#')
            comment = true;
        else if (!is_space(c))
            break;
    }
    return at;
}

/** @return false where a number is missing or has more than nine digits, or nothing follows the last. */
static bool read_header(const ImageSource *source, PnmHeader *out)
{
    enum { DIGITS_MAX = 9 };
    size_t at = 2;
    out->channels = source->data[1] == '5' ? 1 : 3;
    for (int i = 0; i < 3; ++i) {
        size_t first = at = skip_space(source, at);
        uint32_t value = 0;
        for (; at < source->size && is_digit(source->data[at]) && at - first < DIGITS_MAX; ++at)
            value = 10 * value + (uint32_t)(source->data[at] - '0');
        if (at == first || at == source->size || !is_space(source->data[at])) return false;
        out->numbers[i] = value;
    }
    out->size = at + 1;
    return out->numbers[2] > 0 && out->numbers[2] < 65536;
}

static bool pnm_recognize(const uint8_t *data, size_t size)
{
    return size >= 3 && data[0] == 'P' && (data[1] == '5' || data[1] == '6') && is_space(data[2]);
}

/** The value at `sample`, of two bytes where white needs them, as a share of 255. */
static uint8_t load_byte(const uint8_t *pixels, size_t sample, uint32_t white)
{
    uint32_t value = white < 256 ? pixels[sample] : (uint32_t)pixels[2 * sample] << 8 | pixels[2 * sample + 1];
    return (uint8_t)(value >= white ? 255 : (255 * value + white / 2) / white);
}

static SheenStatus pnm_decode_bytes(const ImageSource *source, ImageChannels wanted, ImageBytes *out)
{
    PnmHeader header;
    if (!read_header(source, &header))
        return sheen_fail(source->log, SHEEN_ERR_PARSE, "%s: a broken or unsupported header", source->name);
    uint32_t width = header.numbers[0], height = header.numbers[1], white = header.numbers[2];
    SheenStatus status = sheen_image_check_size(source, width, height);
    if (status) return status;
    size_t n = (size_t)width * height, bytes = n * header.channels * (white < 256 ? 1 : 2);
    if (source->size - header.size < bytes)
        return sheen_fail(source->log, SHEEN_ERR_PARSE, "%s: the file ends before the picture does", source->name);
    if (wanted == IMAGE_ALPHA) return SHEEN_OK;
    status = sheen_image_alloc_bytes(source, width, height, out);
    const uint8_t *pixels = source->data + header.size;
    for (size_t i = 0; i < n && !status; ++i)
        for (size_t c = 0; c < 3; ++c)
            out->pixels[3 * i + c] = load_byte(pixels, header.channels == 3 ? 3 * i + c : i, white);
    return status;
}

const ImageFormat sheen_format_pnm = {
    .endings = {".ppm", ".pgm"}, .recognize = pnm_recognize, .decode_bytes = pnm_decode_bytes};
