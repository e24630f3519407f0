// SPDX-License-Identifier: Apache-2.0
#include "image/exr.h"
#include "image/exr_layers.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/** A part of an EXR file, and which of its channels are the colour. */
typedef struct ExrPart {
    exr_context_t context;
    int index;
    exr_storage_t storage;
    exr_attr_box2i_t data, display; // inclusive corners
    const char *channels[3];        // R, G, B, or one for gray; NULL where missing
    bool gray;
} ExrPart;

/** What the pipeline's last stage needs: where channels go, and where the chunk's first pixel is in the data window. */
typedef struct ExrTarget {
    const ExrPart *part;
    const ExrPlane *planes; // of the part's channels, in their order
    int n_planes;
    int64_t x, y;
} ExrTarget;

static int64_t box_width(exr_attr_box2i_t b)
{
    return (int64_t)b.max.x - b.min.x + 1;
}

static int64_t box_height(exr_attr_box2i_t b)
{
    return (int64_t)b.max.y - b.min.y + 1;
}

/** @return the channel LAYER.NAME, without regard to case in NAME; NULL if there is none. */
static const char *find_channel(const exr_attr_chlist_t *list, const char *layer, size_t layer_size, const char *name)
{
    for (int i = 0; i < list->num_channels; ++i) {
        const char *c = list->entries[i].name.str;
        if (!strncmp(c, layer, layer_size) && !strcasecmp(c + layer_size, name)) return c;
    }
    return NULL;
}

/** Takes R, G, B, or Y, behind the prefix `layer`. @return false when there is none of them. */
static bool take_color(const exr_attr_chlist_t *list, const char *layer, size_t layer_size, ExrPart *part)
{
    static const char *const names[] = {"R", "G", "B"};
    bool any = false;
    for (int c = 0; c < 3; ++c) {
        part->channels[c] = find_channel(list, layer, layer_size, names[c]);
        any = any || part->channels[c];
    }
    if (any) return true;
    part->channels[0] = find_channel(list, layer, layer_size, "Y");
    part->gray = part->channels[0] != NULL;
    return part->gray;
}

/**
 * Finds the colour: R, G, B or Y without a layer; else those of the first layer that has them, with a warning; else the
 * only channel of the part.
 */
static SheenStatus choose_channels(const ImageSource *source, const exr_attr_chlist_t *list, ExrPart *part)
{
    bool found = take_color(list, "", 0, part);
    for (int i = 0; i < list->num_channels && !found; ++i) {
        const char *name = list->entries[i].name.str, *dot = strrchr(name, '.');
        if (!dot || !take_color(list, name, (size_t)(dot - name) + 1, part)) continue;
        sheen_warn(source->log, "%s: there is no colour without a layer; layer '%.*s' is taken", source->name,
                   (int)(dot - name), name);
        found = true;
    }
    if (!found && list->num_channels == 1) {
        part->channels[0] = list->entries[0].name.str;
        part->gray = found = true;
    }
    if (!found)
        return sheen_fail(source->log, SHEEN_ERR_UNSUPPORTED, "%s: no channels R, G, B or Y among '%s' and %d more",
                          source->name, list->num_channels > 0 ? list->entries[0].name.str : "",
                          list->num_channels - 1);
    for (int i = 0; i < list->num_channels; ++i) {
        const exr_attr_chlist_entry_t *e = &list->entries[i];
        if (e->x_sampling != 1 || e->y_sampling != 1 || (part->gray && !strcasecmp(e->name.str, "RY")))
            return sheen_fail(source->log, SHEEN_ERR_UNSUPPORTED,
                              "%s: channel '%s': subsampled colour and chroma are not supported", source->name,
                              e->name.str);
    }
    return SHEEN_OK;
}

/** @return the value of a half; exact. Source: ieee754-2019, binary16. */
static float half_to_float(uint16_t h)
{
    int exponent = h >> 10 & 31;
    float mantissa = (float)(h & 1023), sign = h & 0x8000 ? -1.0f : 1.0f;
    if (exponent == 31) return mantissa > 0.0f ? NAN : sign * INFINITY;
    return exponent == 0 ? sign * mantissa * 0x1p-24f : sign * ldexpf(mantissa + 1024.0f, exponent - 25);
}

static float load_value(const uint8_t *p, uint16_t type)
{
    if (type == EXR_PIXEL_HALF) return half_to_float((uint16_t)(p[0] | p[1] << 8));
    uint32_t bits = (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
    if (type == EXR_PIXEL_UINT) return (float)bits;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/** Takes one channel of one line of a chunk, whose first pixel goes to place `left` of a row of `width` pixels. */
static void place_line(const uint8_t *line, const exr_coding_channel_info_t *channel, int64_t left, float *row,
                       size_t stride, int64_t width)
{
    for (int64_t x = left < 0 ? -left : 0; x < channel->width && left + x < width; ++x)
        row[(size_t)(left + x) * stride] = load_value(line + x * channel->bytes_per_element, channel->data_type);
}

/**
 * The last stage of the pipeline. The library has its own, whose fast ways write through the null pointers of channels
 * that nobody asked for.
 */
static exr_result_t unpack(exr_decode_pipeline_t *pipeline)
{
    const ExrTarget *target = pipeline->decoding_user_data;
    const ExrPart *part = target->part;
    int64_t width = box_width(part->display), height = box_height(part->display);
    int64_t left = (int64_t)part->data.min.x + target->x - part->display.min.x;
    int64_t top = (int64_t)part->data.min.y + target->y - part->display.min.y;
    // Line by line, in each the channels one after another.
    const uint8_t *line = pipeline->unpacked_buffer;
    uint64_t size_left = pipeline->chunk.unpacked_size;
    for (int64_t y = top; y < top + pipeline->chunk.height; ++y) {
        for (int i = 0; i < pipeline->channel_count; ++i) {
            const exr_coding_channel_info_t *channel = &pipeline->channels[i];
            uint64_t size = (uint64_t)channel->width * (uint64_t)channel->bytes_per_element;
            if (!line || size > size_left) return EXR_ERR_CORRUPT_CHUNK;
            const ExrPlane *plane = i < target->n_planes ? &target->planes[i] : NULL;
            if (!plane || strcmp(plane->channel, channel->channel_name) != 0) return EXR_ERR_CORRUPT_CHUNK;
            if (plane->first && y >= 0 && y < height)
                place_line(line, channel, left, plane->first + (size_t)(y * width) * plane->stride, plane->stride,
                           width);
            line += size;
            size_left -= size;
        }
    }
    return EXR_ERR_SUCCESS;
}

static exr_result_t decode_chunk(exr_decode_pipeline_t *pipeline, ExrTarget *target, const exr_chunk_info_t *info)
{
    const ExrPart *part = target->part;
    exr_result_t result;
    if (pipeline->channels) {
        result = exr_decoding_update(part->context, part->index, info, pipeline);
    } else {
        result = exr_decoding_initialize(part->context, part->index, info, pipeline);
        if (!result) result = exr_decoding_choose_default_routines(part->context, part->index, pipeline);
    }
    if (result) return result;
    pipeline->decoding_user_data = target;
    pipeline->unpack_and_convert_fn = unpack;
    return exr_decoding_run(part->context, part->index, pipeline);
}

static exr_result_t decode_scanlines(exr_decode_pipeline_t *pipeline, ExrTarget *target)
{
    const ExrPart *part = target->part;
    int32_t lines = 0;
    exr_result_t result = exr_get_scanlines_per_chunk(part->context, part->index, &lines);
    for (; !result && target->y < box_height(part->data); target->y += lines) {
        exr_chunk_info_t info;
        int y = (int)(part->data.min.y + target->y);
        result = exr_read_scanline_chunk_info(part->context, part->index, y, &info);
        if (!result) result = decode_chunk(pipeline, target, &info);
    }
    return result;
}

/** Reads the largest level. */
static exr_result_t decode_tiles(exr_decode_pipeline_t *pipeline, ExrTarget *target)
{
    const ExrPart *part = target->part;
    int32_t tile_w = 0, tile_h = 0;
    exr_result_t result = exr_get_tile_sizes(part->context, part->index, 0, 0, &tile_w, &tile_h);
    if (!result && (tile_w <= 0 || tile_h <= 0)) result = EXR_ERR_INVALID_ATTR;
    for (int v = 0; !result && (int64_t)v * tile_h < box_height(part->data); ++v) {
        for (int u = 0; !result && (int64_t)u * tile_w < box_width(part->data); ++u) {
            exr_chunk_info_t info;
            target->x = (int64_t)u * tile_w;
            target->y = (int64_t)v * tile_h;
            result = exr_read_tile_chunk_info(part->context, part->index, u, v, 0, 0, &info);
            if (!result) result = decode_chunk(pipeline, target, &info);
        }
    }
    return result;
}

static void spread_gray(SheenImage *image)
{
    for (size_t i = 0; i < (size_t)image->width * image->height; ++i)
        image->pixels[i].g = image->pixels[i].b = image->pixels[i].r;
}

/** OpenEXRCore 3.1 cannot decompress DWA, and puts the channels of B44 in the wrong order unless all are half. */
static SheenStatus check_compression(const ImageSource *source, const exr_attr_chlist_t *list, exr_compression_t kind)
{
    const char *what =
        kind == EXR_COMPRESSION_DWAA || kind == EXR_COMPRESSION_DWAB ? "DWAA and DWAB compression" : NULL;
    for (int i = 0; i < list->num_channels && (kind == EXR_COMPRESSION_B44 || kind == EXR_COMPRESSION_B44A); ++i) {
        if (list->entries[i].pixel_type != EXR_PIXEL_HALF) what = "B44 compression of channels that are not half";
    }
    if (!what) return SHEEN_OK;
    return sheen_fail(source->log, SHEEN_ERR_UNSUPPORTED, "%s: %s is not supported; convert the file to ZIP or PIZ",
                      source->name, what);
}

/** Takes the first part with a colour that needs no layer, else the first, of those that are not deep. */
static SheenStatus choose_part(const ImageSource *source, const ExrStream *stream, ExrPart *part)
{
    int count = 0, chosen = -1;
    exr_result_t result = exr_get_count(part->context, &count);
    bool found = false;
    for (int i = 0; !result && i < count && !found; ++i) {
        exr_storage_t storage;
        const exr_attr_chlist_t *list = NULL;
        result = exr_get_storage(part->context, i, &storage);
        if (result || (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)) continue;
        result = exr_get_channels(part->context, i, &list);
        ExrPart tried = {0};
        found = !result && take_color(list, "", 0, &tried);
        if (found || chosen < 0) {
            chosen = i;
            part->storage = storage;
        }
    }
    if (result) return sheen_exr_fail(stream, result, source->name, source->log);
    if (chosen < 0)
        return sheen_fail(source->log, SHEEN_ERR_UNSUPPORTED, "%s: deep pictures are not supported", source->name);
    part->index = chosen;
    const char *name = NULL;
    if (count > 1 && exr_get_name(part->context, chosen, &name) == EXR_ERR_SUCCESS)
        sheen_warn(source->log, "%s: of %d parts, part '%s' is taken", source->name, count, name);
    return SHEEN_OK;
}

/** Reads windows and channels of the part that is taken. */
static SheenStatus read_header(const ImageSource *source, const ExrStream *stream, ExrPart *part)
{
    SheenStatus status = choose_part(source, stream, part);
    if (status) return status;
    exr_result_t result;
    const exr_attr_chlist_t *list = NULL;
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    result = exr_get_data_window(part->context, part->index, &part->data);
    if (!result) result = exr_get_display_window(part->context, part->index, &part->display);
    if (!result) result = exr_get_channels(part->context, part->index, &list);
    if (!result) result = exr_get_compression(part->context, part->index, &compression);
    if (result) return sheen_exr_fail(stream, result, source->name, source->log);
    if (box_width(part->data) <= 0 || box_height(part->data) <= 0 || box_width(part->display) <= 0 ||
        box_height(part->display) <= 0)
        return sheen_fail(source->log, SHEEN_ERR_PARSE, "%s: the picture is empty", source->name);
    status = sheen_image_check_size(source, (uint64_t)box_width(part->data), (uint64_t)box_height(part->data));
    if (!status) status = check_compression(source, list, compression);
    return status ? status : choose_channels(source, list, part);
}

/** Makes a place for each channel of the part, all unwanted. */
static SheenStatus planes_create(const ImageSource *source, ExrStream *stream, const ExrPart *part,
                                 const exr_attr_chlist_t **list, ExrPlane **planes)
{
    exr_result_t result = exr_get_channels(part->context, part->index, list);
    if (result) return sheen_exr_fail(stream, result, source->name, source->log);
    *planes = calloc((size_t)(*list)->num_channels, sizeof **planes);
    if (!*planes) return sheen_image_no_memory(source->name, source->log);
    for (int i = 0; i < (*list)->num_channels; ++i) (*planes)[i].channel = (*list)->entries[i].name.str;
    return SHEEN_OK;
}

/** Decodes all chunks into the planes. */
static SheenStatus decode_planes(const ImageSource *source, ExrStream *stream, const ExrPart *part,
                                 const ExrPlane planes[], int n)
{
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    ExrTarget target = {.part = part, .planes = planes, .n_planes = n};
    exr_result_t result =
        part->storage == EXR_STORAGE_TILED ? decode_tiles(&pipeline, &target) : decode_scanlines(&pipeline, &target);
    exr_decoding_destroy(part->context, &pipeline);
    return result ? sheen_exr_fail(stream, result, source->name, source->log) : SHEEN_OK;
}

/** Reads the colour. The picture is the display window: what lies outside of the data window is black. */
static SheenStatus decode_color(const ImageSource *source, ExrStream *stream, const ExrPart *part, SheenImage *out)
{
    const exr_attr_chlist_t *list = NULL;
    ExrPlane *planes = NULL;
    SheenStatus status =
        sheen_image_alloc(source, (uint64_t)box_width(part->display), (uint64_t)box_height(part->display), out);
    if (!status) status = planes_create(source, stream, part, &list, &planes);
    for (int i = 0; !status && i < list->num_channels; ++i)
        for (int c = 0; c < 3; ++c)
            if (part->channels[c] && strcmp(part->channels[c], planes[i].channel) == 0)
                planes[i].first = &out->pixels[0].r + c, planes[i].stride = 3;
    if (!status) status = decode_planes(source, stream, part, planes, list->num_channels);
    if (!status && part->gray) spread_gray(out);
    free(planes);
    return status;
}

SheenStatus sheen_exr_decode(const ImageSource *source, SheenImage *out)
{
    ExrStream stream = {.data = source->data, .size = source->size};
    exr_context_initializer_t init = sheen_exr_initializer(&stream);
    ExrPart part = {0};
    exr_result_t result = exr_start_read(&part.context, source->name, &init);
    if (result) return sheen_exr_fail(&stream, result, source->name, source->log);
    SheenStatus status = read_header(source, &stream, &part);
    if (!status) status = decode_color(source, &stream, &part, out);
    exr_finish(&part.context);
    return status;
}

/** Reads the channels of a part beside its colour. */
static SheenStatus decode_layers_of(const ImageSource *source, ExrStream *stream, const ExrPart *part,
                                    SheenImageLayers *out)
{
    uint64_t width = (uint64_t)box_width(part->display), height = (uint64_t)box_height(part->display);
    const exr_attr_chlist_t *list = NULL;
    ExrPlane *planes = NULL;
    SheenStatus status = sheen_image_check_size(source, width, height);
    if (!status) status = planes_create(source, stream, part, &list, &planes);
    out->width = (uint32_t)width;
    out->height = (uint32_t)height;
    if (!status) status = sheen_exr_list_layers(source, list->num_channels, part->channels, out, planes);
    if (!status && out->n > 0) status = decode_planes(source, stream, part, planes, list->num_channels);
    free(planes);
    return status;
}

static void forward_errors(void *user, SheenLogLevel level, const char *text)
{
    const SheenLog *log = user;
    if (level == SHEEN_LOG_ERROR && log->fn) log->fn(log->user, level, text);
}

SheenStatus sheen_exr_decode_layers(const ImageSource *source, SheenImageLayers *out)
{
    SheenLog outer = source->log ? *source->log : (SheenLog){0}, errors = {forward_errors, &outer};
    ImageSource quiet = {source->data, source->size, source->name, &errors}; // reading the colour warns
    ExrStream stream = {.data = source->data, .size = source->size};
    exr_context_initializer_t init = sheen_exr_initializer(&stream);
    ExrPart part = {0};
    exr_result_t result = exr_start_read(&part.context, source->name, &init);
    if (result) return sheen_exr_fail(&stream, result, source->name, source->log);
    SheenStatus status = read_header(&quiet, &stream, &part);
    if (!status) status = decode_layers_of(&quiet, &stream, &part, out);
    exr_finish(&part.context);
    return status;
}
