// SPDX-License-Identifier: Apache-2.0
// Portable float map: a text header, then floats, the bottom row first. Source: debevec-pfm.
#include "image/format.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool pfm_recognize(const uint8_t *data, size_t size)
{
    return size >= 3 && data[0] == 'P' && (data[1] == 'F' || data[1] == 'f') && isspace(data[2]);
}

/** Copies the next word of the header and steps over the one white space after it. @return false at a broken header. */
static bool next_word(const ImageSource *source, size_t *at, char word[static 32])
{
    while (*at < source->size && isspace(source->data[*at])) ++*at;
    size_t n = 0;
    while (*at < source->size && !isspace(source->data[*at]) && n < 31) word[n++] = (char)source->data[(*at)++];
    word[n] = 0;
    if (n == 0 || *at >= source->size || !isspace(source->data[*at])) return false;
    ++*at;
    return true;
}

static bool next_size(const ImageSource *source, size_t *at, uint32_t *value)
{
    char word[32];
    if (!next_word(source, at, word) || !isdigit((unsigned char)word[0]) || strlen(word) > 9) return false;
    char *end;
    *value = (uint32_t)strtoul(word, &end, 10);
    return *end == 0;
}

static float load_float(const uint8_t *p, bool little)
{
    uint32_t bits = little ? (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24
                           : (uint32_t)p[3] | (uint32_t)p[2] << 8 | (uint32_t)p[1] << 16 | (uint32_t)p[0] << 24;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static SheenStatus pfm_decode(const ImageSource *source, SheenImage *out)
{
    char word[32], *end = word;
    size_t at = 0;
    uint32_t width = 0, height = 0;
    float scale = 0.0f;
    bool good = next_word(source, &at, word) && (!strcmp(word, "PF") || !strcmp(word, "Pf"));
    unsigned channels = word[1] == 'F' ? 3 : 1;
    good = good && next_size(source, &at, &width) && next_size(source, &at, &height) && next_word(source, &at, word);
    if (good) scale = strtof(word, &end);
    if (!good || *end || !isfinite(scale) || scale == 0.0f)
        return sheen_fail(source->log, SHEEN_ERR_PARSE, "%s: the header is not that of a PFM file", source->name);
    SheenStatus status = sheen_image_check_size(source, width, height);
    if (status) return status;
    if (source->size - at < (size_t)width * height * channels * 4)
        return sheen_fail(source->log, SHEEN_ERR_PARSE, "%s: the file ends before the picture does", source->name);
    status = sheen_image_alloc(source, width, height, out);
    if (status) return status;

    // The sign of the scale is the byte order, its size a factor to the unit.
    bool little = scale < 0.0f;
    float unit = fabsf(scale);
    const uint8_t *p = source->data + at;
    for (uint32_t y = height; y-- > 0;) {
        Rgb *row = out->pixels + (size_t)y * width;
        for (uint32_t x = 0; x < width; ++x, p += 4 * channels) {
            float r = unit * load_float(p, little);
            row[x] = channels == 1 ? (Rgb){r, r, r}
                                   : (Rgb){r, unit * load_float(p + 4, little), unit * load_float(p + 8, little)};
        }
    }
    return SHEEN_OK;
}

static SheenStatus pfm_encode(const ImageTarget *target, ImageBuffer *out)
{
    const SheenImageView *view = target->view;
    char header[64];
    int n = snprintf(header, sizeof header, "PF\n%u %u\n-1.0\n", view->width, view->height);
    bool good = buffer_append(out, header, (size_t)n);
    size_t row_size = (size_t)view->width * sizeof(Rgb);
    uint8_t *row = malloc(row_size);
    for (uint32_t y = view->height; good && row && y-- > 0;) {
        const Rgb *pixels = view->pixels + (size_t)y * view->width;
        for (size_t i = 0; i < (size_t)view->width * 3; ++i) {
            uint32_t bits;
            memcpy(&bits, (const uint8_t *)pixels + 4 * i, 4);
            for (int k = 0; k < 4; ++k) row[4 * i + (size_t)k] = (uint8_t)(bits >> 8 * k);
        }
        good = buffer_append(out, row, row_size);
    }
    good = good && row;
    free(row);
    return good ? SHEEN_OK : sheen_image_no_memory(target->name, target->log);
}

const ImageFormat sheen_format_pfm = {
    .endings = {".pfm"}, .recognize = pfm_recognize, .decode = pfm_decode, .encode = pfm_encode};
