// SPDX-License-Identifier: Apache-2.0
#include "image/exr.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/** A part of an EXR file, and which of its channels are the colour. */
typedef struct ExrPart {
    exr_context_t context;
    int index;
    exr_storage_t storage;
    exr_attr_box2i_t data, display; // inclusive corners
    const char *channels[3];        // R, G, B; all the same for gray; NULL where missing
    bool gray;
} ExrPart;

/** Where decoded pixels go: one chunk's, then the picture. */
typedef struct ExrChunk {
    exr_decode_pipeline_t pipeline;
    bool ready;  // pipeline is initialized
    Rgb *pixels; // [height][width] of the largest chunk
    size_t capacity;
} ExrChunk;

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
        bool used =
            e->name.str == part->channels[0] || e->name.str == part->channels[1] || e->name.str == part->channels[2];
        if (e->x_sampling != 1 || e->y_sampling != 1 || (part->gray && !strcasecmp(e->name.str, "RY")))
            return sheen_fail(source->log, SHEEN_ERR_UNSUPPORTED, "%s: channel '%s': %s", source->name, e->name.str,
                              used ? "subsampled colour is not supported" : "luminance and chroma are not supported");
    }
    return SHEEN_OK;
}

/** Grows the chunk's pixels and prepares the pipeline for it. */
static exr_result_t prepare_chunk(const ExrPart *part, ExrChunk *chunk, const exr_chunk_info_t *info)
{
    size_t n = (size_t)info->width * (size_t)info->height;
    if (n > chunk->capacity) {
        free(chunk->pixels);
        chunk->capacity = 0;
        chunk->pixels = n <= SHEEN_IMAGE_MAX_PIXELS ? malloc(n * sizeof *chunk->pixels) : NULL;
        if (!chunk->pixels) return EXR_ERR_OUT_OF_MEMORY;
        chunk->capacity = n;
    }
    memset(chunk->pixels, 0, n * sizeof *chunk->pixels); // a missing channel is zero
    exr_decode_pipeline_t *pipeline = &chunk->pipeline;
    bool first = !chunk->ready;
    exr_result_t result = first ? exr_decoding_initialize(part->context, part->index, info, pipeline)
                                : exr_decoding_update(part->context, part->index, info, pipeline);
    if (result) return result;
    chunk->ready = true;
    for (int i = 0; i < pipeline->channel_count; ++i) {
        exr_coding_channel_info_t *channel = &pipeline->channels[i];
        channel->decode_to_ptr = NULL;
        for (int c = 0; c < 3; ++c) {
            if (!part->channels[c] || strcmp(part->channels[c], channel->channel_name) != 0) continue;
            channel->decode_to_ptr = (uint8_t *)(&chunk->pixels->r + c);
            channel->user_bytes_per_element = sizeof(float);
            channel->user_data_type = EXR_PIXEL_FLOAT;
            channel->user_pixel_stride = (int32_t)sizeof(Rgb);
            channel->user_line_stride = (int32_t)((size_t)info->width * sizeof(Rgb));
        }
    }
    return first ? exr_decoding_choose_default_routines(part->context, part->index, pipeline) : EXR_ERR_SUCCESS;
}

/** Copies a chunk whose first pixel is (x0, y0) of the data window into the display window. */
static void place_chunk(const ExrPart *part, const ExrChunk *chunk, const exr_chunk_info_t *info, int64_t x0,
                        int64_t y0, SheenImage *out)
{
    int64_t left = (int64_t)part->data.min.x + x0 - part->display.min.x;
    int64_t top = (int64_t)part->data.min.y + y0 - part->display.min.y;
    for (int64_t y = 0; y < info->height; ++y) {
        if (top + y < 0 || top + y >= out->height) continue;
        const Rgb *from = chunk->pixels + y * info->width;
        Rgb *row = out->pixels + (size_t)(top + y) * out->width;
        for (int64_t x = 0; x < info->width; ++x) {
            if (left + x < 0 || left + x >= out->width) continue;
            row[left + x] = part->gray ? (Rgb){from[x].r, from[x].r, from[x].r} : from[x];
        }
    }
}

static exr_result_t decode_chunk(const ExrPart *part, ExrChunk *chunk, const exr_chunk_info_t *info, int64_t x0,
                                 int64_t y0, SheenImage *out)
{
    exr_result_t result = prepare_chunk(part, chunk, info);
    if (!result) result = exr_decoding_run(part->context, part->index, &chunk->pipeline);
    if (!result) place_chunk(part, chunk, info, x0, y0, out);
    return result;
}

static exr_result_t decode_scanlines(const ExrPart *part, ExrChunk *chunk, SheenImage *out)
{
    int32_t lines = 0;
    exr_result_t result = exr_get_scanlines_per_chunk(part->context, part->index, &lines);
    for (int64_t y = 0; !result && y < box_height(part->data); y += lines) {
        exr_chunk_info_t info;
        result = exr_read_scanline_chunk_info(part->context, part->index, (int)(part->data.min.y + y), &info);
        if (!result) result = decode_chunk(part, chunk, &info, 0, y, out);
    }
    return result;
}

static exr_result_t decode_tiles(const ExrPart *part, ExrChunk *chunk, SheenImage *out)
{
    int32_t tile_w = 0, tile_h = 0;
    exr_result_t result = exr_get_tile_sizes(part->context, part->index, 0, 0, &tile_w, &tile_h);
    if (!result && (tile_w <= 0 || tile_h <= 0)) result = EXR_ERR_INVALID_ATTR;
    for (int y = 0; !result && (int64_t)y * tile_h < box_height(part->data); ++y) {
        for (int x = 0; !result && (int64_t)x * tile_w < box_width(part->data); ++x) {
            exr_chunk_info_t info;
            result = exr_read_tile_chunk_info(part->context, part->index, x, y, 0, 0, &info);
            if (!result) result = decode_chunk(part, chunk, &info, (int64_t)x * tile_w, (int64_t)y * tile_h, out);
        }
    }
    return result;
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

/** Reads windows and channels of the first part that is not deep. */
static SheenStatus read_header(const ImageSource *source, const ExrStream *stream, ExrPart *part)
{
    int count = 0;
    exr_result_t result = exr_get_count(part->context, &count);
    for (part->index = 0; !result && part->index < count; ++part->index) {
        result = exr_get_storage(part->context, part->index, &part->storage);
        if (!result && (part->storage == EXR_STORAGE_SCANLINE || part->storage == EXR_STORAGE_TILED)) break;
    }
    if (!result && part->index == count)
        return sheen_fail(source->log, SHEEN_ERR_UNSUPPORTED, "%s: deep pictures are not supported", source->name);
    const exr_attr_chlist_t *list = NULL;
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    if (!result) result = exr_get_data_window(part->context, part->index, &part->data);
    if (!result) result = exr_get_display_window(part->context, part->index, &part->display);
    if (!result) result = exr_get_channels(part->context, part->index, &list);
    if (!result) result = exr_get_compression(part->context, part->index, &compression);
    if (result) return sheen_exr_fail(stream, result, source->name, source->log);
    if (box_width(part->data) <= 0 || box_height(part->data) <= 0 || box_width(part->display) <= 0 ||
        box_height(part->display) <= 0)
        return sheen_fail(source->log, SHEEN_ERR_PARSE, "%s: the picture is empty", source->name);
    SheenStatus status =
        sheen_image_check_size(source, (uint64_t)box_width(part->data), (uint64_t)box_height(part->data));
    if (!status) status = check_compression(source, list, compression);
    return status ? status : choose_channels(source, list, part);
}

SheenStatus sheen_exr_decode(const ImageSource *source, SheenImage *out)
{
    ExrStream stream = {.data = source->data, .size = source->size};
    exr_context_initializer_t init = sheen_exr_initializer(&stream);
    ExrPart part = {0};
    exr_result_t result = exr_start_read(&part.context, source->name, &init);
    if (result) return sheen_exr_fail(&stream, result, source->name, source->log);
    SheenStatus status = read_header(source, &stream, &part);
    // The picture is the display window: what lies outside of the data window is black.
    if (!status)
        status = sheen_image_alloc(source, (uint64_t)box_width(part.display), (uint64_t)box_height(part.display), out);
    if (!status) {
        ExrChunk chunk = {0};
        result =
            part.storage == EXR_STORAGE_TILED ? decode_tiles(&part, &chunk, out) : decode_scanlines(&part, &chunk, out);
        if (result) status = sheen_exr_fail(&stream, result, source->name, source->log);
        if (chunk.ready) exr_decoding_destroy(part.context, &chunk.pipeline);
        free(chunk.pixels);
    }
    exr_finish(&part.context);
    return status;
}
