// SPDX-License-Identifier: Apache-2.0
#include "image/image.h"

#include "image/format.h"
#include "image/whole_file.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

// TGA stands last: it has no magic number, so that its test is the weakest.
static const ImageFormat *const formats[] = {
    &sheen_format_exr,  &sheen_format_hdr, &sheen_format_pfm, &sheen_format_png,
    &sheen_format_jpeg, &sheen_format_bmp, &sheen_format_pnm, &sheen_format_tga,
};
enum { n_formats = sizeof formats / sizeof formats[0] };

// The best compression of an honest picture: a black 1-bit PNG, 8 pixels a byte deflated 1032 times.
static const uint64_t max_pixels_per_byte = 16384;

static const ImageFormat *format_of_ending(const char *path)
{
    size_t n = strlen(path);
    for (int i = 0; i < n_formats; ++i) {
        for (const char *const *e = formats[i]->endings; *e; ++e) {
            size_t m = strlen(*e);
            if (n > m && strcasecmp(path + n - m, *e) == 0) return formats[i];
        }
    }
    return NULL;
}

static const ImageFormat *format_of_content(const uint8_t *data, size_t size)
{
    for (int i = 0; i < n_formats; ++i) {
        if (formats[i]->recognize(data, size)) return formats[i];
    }
    return NULL;
}

bool sheen_image_writable_format(const char *path)
{
    const ImageFormat *format = format_of_ending(path);
    return format && format->encode;
}

bool sheen_image_readable_format(const char *path)
{
    return format_of_ending(path) != NULL;
}

bool sheen_image_is_8bit(const char *path)
{
    const ImageFormat *format = format_of_ending(path);
    return format && format->decode_bytes;
}

SheenStatus sheen_image_no_memory(const char *name, const SheenLog *log)
{
    return sheen_fail(log, SHEEN_ERR_NOMEM, "%s: out of memory", name);
}

SheenStatus sheen_image_check_size(const ImageSource *source, uint64_t width, uint64_t height)
{
    unsigned long long w = width, h = height;
    if (w == 0 || h == 0) return sheen_fail(source->log, SHEEN_ERR_PARSE, "%s: the picture is empty", source->name);
    if (w > SHEEN_IMAGE_MAX_SIDE || h > SHEEN_IMAGE_MAX_SIDE || w * h > SHEEN_IMAGE_MAX_PIXELS)
        return sheen_fail(source->log, SHEEN_ERR_UNSUPPORTED,
                          "%s: %llu x %llu pixels are more than are allowed (%d a side, %llu in all)", source->name, w,
                          h, SHEEN_IMAGE_MAX_SIDE, (unsigned long long)SHEEN_IMAGE_MAX_PIXELS);
    if (w * h / max_pixels_per_byte > source->size)
        return sheen_fail(source->log, SHEEN_ERR_PARSE, "%s: %llu x %llu pixels cannot be in a file of %zu bytes",
                          source->name, w, h, source->size);
    return SHEEN_OK;
}

SheenStatus sheen_image_alloc(const ImageSource *source, uint64_t width, uint64_t height, SheenImage *out)
{
    SheenStatus status = sheen_image_check_size(source, width, height);
    if (status) return status;
    out->pixels = calloc((size_t)(width * height), sizeof *out->pixels);
    if (!out->pixels) return sheen_image_no_memory(source->name, source->log);
    out->width = (uint32_t)width;
    out->height = (uint32_t)height;
    return SHEEN_OK;
}

SheenStatus sheen_image_alloc_bytes(const ImageSource *source, uint64_t width, uint64_t height, ImageBytes *out)
{
    SheenStatus status = sheen_image_check_size(source, width, height);
    if (status) return status;
    out->pixels = calloc((size_t)(width * height), 3);
    if (!out->pixels) return sheen_image_no_memory(source->name, source->log);
    out->width = (uint32_t)width;
    out->height = (uint32_t)height;
    return SHEEN_OK;
}

bool sheen_buffer_write(ImageBuffer *buffer, size_t offset, const void *data, size_t size)
{
    if (size > SIZE_MAX / 4 || offset > SIZE_MAX / 4) return false;
    size_t end = offset + size;
    if (end > buffer->capacity) {
        size_t capacity = end + end / 2 + 4096;
        uint8_t *grown = realloc(buffer->data, capacity);
        if (!grown) return false;
        buffer->data = grown;
        buffer->capacity = capacity;
    }
    if (offset > buffer->size) memset(buffer->data + buffer->size, 0, offset - buffer->size);
    if (size > 0) memcpy(buffer->data + offset, data, size);
    if (end > buffer->size) buffer->size = end;
    return true;
}

/** Decodes through the bytes, by the sRGB curve. */
static SheenStatus decode_through_bytes(const ImageFormat *format, const ImageSource *source, SheenImage *out)
{
    ImageBytes bytes = {0};
    SheenStatus status = format->decode_bytes(source, IMAGE_RGB, &bytes);
    if (!status) status = sheen_image_alloc(source, bytes.width, bytes.height, out);
    if (!status) {
        float linear[256];
        for (int i = 0; i < 256; ++i) linear[i] = sheen_srgb_decode((float)i / 255.0f);
        size_t n = (size_t)bytes.width * bytes.height;
        for (size_t i = 0; i < n; ++i) {
            const uint8_t *p = bytes.pixels + 3 * i;
            out->pixels[i] = (Rgb){linear[p[0]], linear[p[1]], linear[p[2]]};
        }
    }
    free(bytes.pixels);
    return status;
}

SheenStatus sheen_image_decode(const void *data, size_t size, const char *name, const SheenLog *log, SheenImage *out)
{
    *out = (SheenImage){0};
    const ImageFormat *format = format_of_content(data, size);
    if (!format) return sheen_fail(log, SHEEN_ERR_UNSUPPORTED, "%s: not a picture of a known format", name);
    ImageSource source = {data, size, name, log};
    SheenStatus status = format->decode ? format->decode(&source, out) : decode_through_bytes(format, &source, out);
    if (status) sheen_image_free(out);
    return status;
}

SheenStatus sheen_image_read(const char *path, const SheenLog *log, SheenImage *out)
{
    *out = (SheenImage){0};
    uint8_t *data = NULL;
    size_t size = 0;
    SheenStatus status = sheen_file_read(path, log, &data, &size);
    if (!status) status = sheen_image_decode(data, size, path, log, out);
    free(data);
    return status;
}

SheenStatus sheen_image_decode_layers(const void *data, size_t size, const char *name, const SheenLog *log,
                                      SheenImageLayers *out)
{
    *out = (SheenImageLayers){0};
    if (!sheen_format_exr.recognize(data, size)) return SHEEN_OK;
    SheenStatus status = sheen_exr_decode_layers(&(ImageSource){data, size, name, log}, out);
    if (status) sheen_image_layers_free(out);
    return status;
}

SheenStatus sheen_image_read_layers(const char *path, const SheenLog *log, SheenImageLayers *out)
{
    *out = (SheenImageLayers){0};
    uint8_t *data = NULL;
    size_t size = 0;
    SheenStatus status = sheen_file_read(path, log, &data, &size);
    if (!status) status = sheen_image_decode_layers(data, size, path, log, out);
    free(data);
    return status;
}

void sheen_image_layers_free(SheenImageLayers *layers)
{
    for (size_t i = 0; i < layers->n; ++i) {
        SheenImageLayer *layer = &layers->layers[i];
        free(layer->name);
        for (unsigned c = 0; c < layer->n_channels; ++c) free(layer->channels[c]);
        free(layer->data);
    }
    free(layers->layers);
    *layers = (SheenImageLayers){0};
}

void sheen_image_spread_alpha(uint8_t *pixels, size_t n)
{
    for (size_t i = 0; i < n; ++i) {
        uint8_t alpha = pixels[4 * i + 3];
        for (size_t c = 0; c < 3; ++c) pixels[3 * i + c] = alpha;
    }
}

static SheenStatus read_channels(const char *path, ImageChannels channels, const SheenLog *log, uint32_t *width,
                                 uint32_t *height, uint8_t **pixels)
{
    *width = *height = 0;
    *pixels = NULL;
    uint8_t *data = NULL;
    size_t size = 0;
    SheenStatus status = sheen_file_read(path, log, &data, &size);
    if (status) return status;
    ImageBytes bytes = {0};
    const ImageFormat *format = format_of_content(data, size);
    if (format && format->decode_bytes)
        status = format->decode_bytes(&(ImageSource){data, size, path, log}, channels, &bytes);
    else
        status = sheen_fail(log, SHEEN_ERR_UNSUPPORTED, "%s: not a picture of 8 bits (PNG, JPEG, TGA, BMP)", path);
    free(data);
    if (status) {
        free(bytes.pixels);
        return status;
    }
    *width = bytes.width;
    *height = bytes.height;
    *pixels = bytes.pixels;
    return SHEEN_OK;
}

SheenStatus sheen_image_read_bytes(const char *path, const SheenLog *log, uint32_t *width, uint32_t *height,
                                   uint8_t **pixels)
{
    return read_channels(path, IMAGE_RGB, log, width, height, pixels);
}

SheenStatus sheen_image_read_alpha(const char *path, const SheenLog *log, uint32_t *width, uint32_t *height,
                                   uint8_t **pixels)
{
    SheenStatus status = read_channels(path, IMAGE_ALPHA, log, width, height, pixels);
    size_t n = 3 * (size_t)*width * *height, opaque = 0;
    while (!status && *pixels && opaque < n && (*pixels)[opaque] == 255) ++opaque;
    if (opaque < n) return status;
    free(*pixels);
    *pixels = NULL;
    return status;
}

SheenStatus sheen_image_encode(const char *name, const SheenImageView *view, float exposure, const SheenLog *log,
                               uint8_t **data, size_t *size)
{
    *data = NULL;
    *size = 0;
    const ImageFormat *format = format_of_ending(name);
    if (!format || !format->encode)
        return sheen_fail(log, SHEEN_ERR_UNSUPPORTED,
                          "%s: a picture is written as .exr, .hdr, .pfm or .png, by the ending of its name", name);
    if (view->width == 0 || view->height == 0 || view->width > SHEEN_IMAGE_MAX_SIDE ||
        view->height > SHEEN_IMAGE_MAX_SIDE || (uint64_t)view->width * view->height > SHEEN_IMAGE_MAX_PIXELS)
        return sheen_fail(log, SHEEN_ERR_INVALID, "%s: a picture of %u x %u pixels cannot be written", name,
                          view->width, view->height);
    ImageTarget target = {view, exposure, name, log};
    ImageBuffer buffer = {0};
    SheenStatus status = format->encode(&target, &buffer);
    if (status) {
        free(buffer.data);
        return status;
    }
    *data = buffer.data;
    *size = buffer.size;
    return SHEEN_OK;
}

SheenStatus sheen_image_write(const char *path, const SheenImageView *view, float exposure, const SheenLog *log)
{
    uint8_t *data;
    size_t size;
    SheenStatus status = sheen_image_encode(path, view, exposure, log, &data, &size);
    if (!status) status = sheen_file_write(path, data, size, log);
    free(data);
    return status;
}

void sheen_image_free(SheenImage *image)
{
    free(image->pixels);
    *image = (SheenImage){0};
}
