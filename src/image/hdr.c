// SPDX-License-Identifier: Apache-2.0
// Radiance RGBE: three mantissas of 8 bits and a shared exponent. Source: ward1991-rgbe; the run-length form of a
// scanline: ward-radiance-filefmts.
//
// Ward's own programs truncate when they write and add half a step when they read. Nearly all others read without the
// half step, so that a black or white pixel stays exact; so do we, and round to the nearest when we write.
#include "image/format.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct HdrHeader {
    uint32_t width, height;
    bool flip_x, flip_y;
    float exposure; // product of all EXPOSURE lines: pixels are stored multiplied by it
    size_t end;     // offset of the first scanline
} HdrHeader;

static bool hdr_recognize(const uint8_t *data, size_t size)
{
    return size >= 10 && data[0] == '#' && data[1] == '?' &&
           (!memcmp(data + 2, "RADIANCE", 8) || !memcmp(data + 2, "RGBE", 4));
}

/** Copies one line without its newline, cut at 255 characters. @return false at the end of the file. */
static bool next_line(const ImageSource *source, size_t *at, char line[static 256])
{
    const uint8_t *newline = memchr(source->data + *at, '\n', source->size - *at);
    if (!newline) return false;
    size_t n = (size_t)(newline - (source->data + *at));
    size_t kept = n < 255 ? n : 255;
    memcpy(line, source->data + *at, kept);
    if (kept > 0 && line[kept - 1] == '\r') --kept;
    line[kept] = 0;
    *at += n + 1;
    return true;
}

static SheenStatus parse_header(const ImageSource *source, HdrHeader *h)
{
    char line[256];
    double exposure = 1.0;
    size_t at = 0;
    for (;;) {
        if (!next_line(source, &at, line))
            return sheen_fail(source->log, SHEEN_ERR_PARSE, "%s: the header has no end", source->name);
        if (line[0] == 0) break;
        if (!strncmp(line, "FORMAT=", 7) && strcmp(line + 7, "32-bit_rle_rgbe") != 0)
            return sheen_fail(source->log, SHEEN_ERR_UNSUPPORTED, "%s: pixels of format '%s' are not supported",
                              source->name, line + 7);
        if (!strncmp(line, "EXPOSURE=", 9)) exposure *= strtod(line + 9, NULL);
    }
    char sign_y, sign_x;
    unsigned width, height;
    if (!next_line(source, &at, line) || strlen(line) > 30)
        return sheen_fail(source->log, SHEEN_ERR_PARSE, "%s: the line with the size is missing", source->name);
    if (line[0] && line[1] == 'X')
        return sheen_fail(source->log, SHEEN_ERR_UNSUPPORTED, "%s: pictures stored by columns are not supported",
                          source->name);
    if (sscanf(line, "%cY %9u %cX %9u", &sign_y, &height, &sign_x, &width) != 4 || !strchr("+-", sign_y) ||
        !strchr("+-", sign_x))
        return sheen_fail(source->log, SHEEN_ERR_PARSE, "%s: '%s' is not the size of a picture", source->name, line);
    if (!(exposure > 0.0) || !isfinite(exposure) || !((float)(1.0 / exposure) > 0.0f) ||
        !isfinite((float)(1.0 / exposure)))
        return sheen_fail(source->log, SHEEN_ERR_PARSE, "%s: the exposure is not a positive number", source->name);
    *h = (HdrHeader){width, height, sign_x == '-', sign_y == '+', (float)exposure, at};
    return SHEEN_OK;
}

/** Four runs, one a component. @return bytes used, 0 when broken. */
static size_t decode_runs(const uint8_t *p, size_t size, uint32_t width, uint8_t (*row)[4])
{
    size_t at = 0;
    for (int c = 0; c < 4; ++c) {
        for (uint32_t x = 0; x < width;) {
            if (at + 2 > size) return 0;
            unsigned count = p[at++];
            bool run = count > 128;
            if (run) count -= 128;
            if (count == 0 || count > width - x || (!run && count > size - at)) return 0;
            for (unsigned i = 0; i < count; ++i) row[x++][c] = p[run ? at : at + i];
            at += run ? 1 : count;
        }
    }
    return at;
}

/**
 * Plain pixels, in which (1, 1, 1, n) repeats the last one n times, a following one n << 8 times.
 * @return bytes used, 0 when broken
 */
static size_t decode_plain(const uint8_t *p, size_t size, uint32_t width, uint8_t (*row)[4])
{
    size_t at = 0;
    unsigned shift = 0;
    for (uint32_t x = 0; x < width; at += 4) {
        if (size - at < 4) return 0;
        const uint8_t *q = p + at;
        if (q[0] == 1 && q[1] == 1 && q[2] == 1) {
            uint32_t count = shift < 32 ? (uint32_t)q[3] << shift : 0;
            if (x == 0 || shift >= 32 || count > width - x) return 0;
            for (uint32_t i = 0; i < count; ++i, ++x) memcpy(row[x], row[x - 1], 4);
            shift += 8;
        } else {
            memcpy(row[x++], q, 4);
            shift = 0;
        }
    }
    return at;
}

static size_t decode_row(const uint8_t *p, size_t size, uint32_t width, uint8_t (*row)[4])
{
    bool runs = width >= 8 && width < 32768 && size >= 4 && p[0] == 2 && p[1] == 2 && p[2] < 128;
    if (!runs) return decode_plain(p, size, width, row);
    if (((uint32_t)p[2] << 8 | p[3]) != width) return 0;
    size_t used = decode_runs(p + 4, size - 4, width, row);
    return used ? used + 4 : 0;
}

static SheenStatus hdr_decode(const ImageSource *source, SheenImage *out)
{
    HdrHeader h;
    SheenStatus status = parse_header(source, &h);
    if (!status) status = sheen_image_alloc(source, h.width, h.height, out);
    if (status) return status;
    uint8_t(*row)[4] = malloc((size_t)h.width * 4);
    if (!row) return sheen_image_no_memory(source->name, source->log);
    size_t at = h.end;
    for (uint32_t y = 0; y < h.height && !status; ++y) {
        size_t used = decode_row(source->data + at, source->size - at, h.width, row);
        if (!used)
            status = sheen_fail(source->log, SHEEN_ERR_PARSE, "%s: scanline %u is broken or cut off", source->name, y);
        at += used;
        Rgb *pixels = out->pixels + (size_t)(h.flip_y ? h.height - 1 - y : y) * h.width;
        for (uint32_t x = 0; x < h.width && !status; ++x) {
            const uint8_t *q = row[h.flip_x ? h.width - 1 - x : x];
            float unit = q[3] ? ldexpf(1.0f, q[3] - 136) / h.exposure : 0.0f;
            pixels[x] = (Rgb){unit * (float)q[0], unit * (float)q[1], unit * (float)q[2]};
        }
    }
    free(row);
    return status;
}

static float storable(float x)
{
    const float largest = 0x1.fep126f;         // mantissa 255, exponent 255
    return x > 0.0f ? minf(x, largest) : 0.0f; // negative and NaN become 0
}

static void encode_pixel(Rgb color, uint8_t out[4])
{
    float r = storable(color.r), g = storable(color.g), b = storable(color.b);
    int exponent;
    float largest = maxf(r, maxf(g, b));
    frexpf(largest, &exponent);
    if (rintf(ldexpf(largest, 8 - exponent)) > 255.0f) ++exponent; // rounds up to the next power of two
    if (largest == 0.0f || exponent < -127) {
        memset(out, 0, 4);
        return;
    }
    out[0] = (uint8_t)rintf(ldexpf(r, 8 - exponent));
    out[1] = (uint8_t)rintf(ldexpf(g, 8 - exponent));
    out[2] = (uint8_t)rintf(ldexpf(b, 8 - exponent));
    out[3] = (uint8_t)(exponent + 128);
}

/** Length of the run of equal bytes of component c that starts at x, at most 127. */
static uint32_t run_length(const uint8_t (*row)[4], uint32_t width, uint32_t x, int c)
{
    uint32_t n = 1;
    while (n < 127 && x + n < width && row[x + n][c] == row[x][c]) ++n;
    return n;
}

/** One component: runs of four and more as such, the rest as they are. `out` holds at least 2 * width bytes. */
static size_t encode_runs(const uint8_t (*row)[4], uint32_t width, int c, uint8_t *out)
{
    size_t n = 0;
    for (uint32_t x = 0; x < width;) {
        uint32_t run = run_length(row, width, x, c);
        if (run >= 4) {
            out[n++] = (uint8_t)(128 + run);
            out[n++] = row[x][c];
            x += run;
            continue;
        }
        size_t count_at = n++;
        uint32_t count = 0;
        while (count < 128 && x < width && run_length(row, width, x, c) < 4) {
            out[n++] = row[x++][c];
            ++count;
        }
        out[count_at] = (uint8_t)count;
    }
    return n;
}

static SheenStatus hdr_encode(const ImageTarget *target, ImageBuffer *out)
{
    const SheenImageView *view = target->view;
    uint32_t width = view->width;
    char header[96];
    int n = snprintf(header, sizeof header, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %u +X %u\n", view->height, width);
    bool runs = width >= 8 && width < 32768; // what the run-length form can express
    uint8_t(*row)[4] = malloc((size_t)width * 4);
    uint8_t *coded = malloc((size_t)width * 8 + 4);
    bool good = row && coded && buffer_append(out, header, (size_t)n);
    for (uint32_t y = 0; good && y < view->height; ++y) {
        for (uint32_t x = 0; x < width; ++x) encode_pixel(view->pixels[(size_t)y * width + x], row[x]);
        if (!runs) {
            good = buffer_append(out, row, (size_t)width * 4);
            continue;
        }
        uint8_t *end = coded;
        *end++ = 2;
        *end++ = 2;
        *end++ = (uint8_t)(width >> 8);
        *end++ = (uint8_t)width;
        for (int c = 0; c < 4; ++c) end += encode_runs((const uint8_t(*)[4])row, width, c, end);
        good = buffer_append(out, coded, (size_t)(end - coded));
    }
    free(row);
    free(coded);
    return good ? SHEEN_OK : sheen_image_no_memory(target->name, target->log);
}

const ImageFormat sheen_format_hdr = {
    .endings = {".hdr"}, .recognize = hdr_recognize, .decode = hdr_decode, .encode = hdr_encode};
