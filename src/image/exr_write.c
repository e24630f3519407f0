// SPDX-License-Identifier: Apache-2.0
#include "image/exr.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/** A channel of the file and where its values lie. */
typedef struct ExrChannel {
    char name[256];
    const float *first;
    int32_t pixel_stride; // bytes
} ExrChannel;

typedef struct ExrJob {
    const ImageTarget *target;
    exr_context_t context;
    int part;
    exr_result_t (*compress)(exr_encode_pipeline_t *pipeline); // the library's
    ExrChannel *channels;                                      // sorted by name, as the format wants them
    size_t n_channels;
} ExrJob;

static int by_name(const void *a, const void *b)
{
    return strcmp(((const ExrChannel *)a)->name, ((const ExrChannel *)b)->name);
}

/** Lists colour and layers as channels: R, G, B, depth.Z, normal.X ... */
static SheenStatus list_channels(ExrJob *job)
{
    const SheenImageView *view = job->target->view;
    size_t n = 3;
    for (size_t i = 0; i < view->n_layers; ++i) n += view->layers[i].n_channels;
    job->channels = calloc(n, sizeof *job->channels);
    if (!job->channels) return sheen_image_no_memory(job->target->name, job->target->log);
    for (size_t c = 0; c < 3; ++c) {
        ExrChannel *to = &job->channels[job->n_channels++];
        to->name[0] = "RGB"[c];
        to->first = &view->pixels->r + c;
        to->pixel_stride = (int32_t)sizeof(Rgb);
    }
    for (size_t i = 0; i < view->n_layers; ++i) {
        const SheenLayer *layer = &view->layers[i];
        for (size_t c = 0; c < layer->n_channels; ++c) {
            ExrChannel *to = &job->channels[job->n_channels++];
            int length = snprintf(to->name, sizeof to->name, "%s.%c", layer->name, layer->suffixes[c]);
            to->first = layer->data + c;
            to->pixel_stride = (int32_t)(layer->n_channels * sizeof(float));
            if (length < 0 || (size_t)length >= sizeof to->name)
                return sheen_fail(job->target->log, SHEEN_ERR_INVALID, "%s: the name of layer %zu is too long",
                                  job->target->name, i);
        }
    }
    qsort(job->channels, n, sizeof *job->channels, by_name);
    return SHEEN_OK;
}

static exr_result_t write_header(ExrJob *job)
{
    const SheenImageView *view = job->target->view;
    exr_result_t result = exr_set_longname_support(job->context, 1);
    if (!result) result = exr_add_part(job->context, NULL, EXR_STORAGE_SCANLINE, &job->part);
    if (!result)
        result = exr_initialize_required_attr_simple(job->context, job->part, (int32_t)view->width,
                                                     (int32_t)view->height, EXR_COMPRESSION_ZIP);
    for (size_t i = 0; !result && i < job->n_channels; ++i)
        result = exr_add_channel(job->context, job->part, job->channels[i].name, EXR_PIXEL_FLOAT,
                                 EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    for (size_t i = 0; !result && i < view->n_attributes; ++i)
        result = exr_attr_set_string(job->context, job->part, view->attributes[i].name, view->attributes[i].value);
    return result ? result : exr_write_header(job->context);
}

static void connect_channels(const ExrJob *job, const exr_chunk_info_t *info, exr_encode_pipeline_t *pipeline)
{
    size_t skipped = (size_t)info->start_y * job->target->view->width;
    for (int i = 0; i < pipeline->channel_count; ++i) {
        exr_coding_channel_info_t *to = &pipeline->channels[i];
        const ExrChannel *from = &job->channels[i];
        to->user_bytes_per_element = sizeof(float);
        to->user_data_type = EXR_PIXEL_FLOAT;
        to->user_pixel_stride = from->pixel_stride;
        to->user_line_stride = from->pixel_stride * info->width;
        to->encode_from_ptr = (const uint8_t *)from->first + skipped * (size_t)from->pixel_stride;
    }
}

/**
 * Bytes as many as the chunk's own are read as not compressed, but OpenEXRCore 3.1 writes what it compressed to exactly
 * so many: the chunk would be read as noise.
 */
static exr_result_t compress(exr_encode_pipeline_t *pipeline)
{
    const ExrJob *job = pipeline->encoding_user_data;
    exr_result_t result = job->compress(pipeline);
    if (!result && pipeline->compressed_buffer && pipeline->compressed_bytes == pipeline->packed_bytes)
        memcpy(pipeline->compressed_buffer, pipeline->packed_buffer, pipeline->packed_bytes);
    return result;
}

static exr_result_t write_chunks(ExrJob *job)
{
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    int32_t lines = 0, height = (int32_t)job->target->view->height;
    exr_result_t result = exr_get_scanlines_per_chunk(job->context, job->part, &lines);
    for (int32_t y = 0; !result && y < height; y += lines) {
        exr_chunk_info_t info;
        result = exr_write_scanline_chunk_info(job->context, job->part, y, &info);
        if (result) break;
        result = y == 0 ? exr_encoding_initialize(job->context, job->part, &info, &pipeline)
                        : exr_encoding_update(job->context, job->part, &info, &pipeline);
        if (result) break;
        connect_channels(job, &info, &pipeline);
        if (y == 0) {
            result = exr_encoding_choose_default_routines(job->context, job->part, &pipeline);
            job->compress = pipeline.compress_fn;
            pipeline.encoding_user_data = job;
            if (job->compress) pipeline.compress_fn = compress;
        }
        if (!result) result = exr_encoding_run(job->context, job->part, &pipeline);
    }
    exr_encoding_destroy(job->context, &pipeline);
    return result;
}

SheenStatus sheen_exr_encode(const ImageTarget *target, ImageBuffer *out)
{
    ExrStream stream = {.buffer = out};
    exr_context_initializer_t init = sheen_exr_initializer(&stream);
    ExrJob job = {.target = target};
    SheenStatus status = list_channels(&job);
    exr_result_t result = EXR_ERR_SUCCESS;
    if (!status) {
        result = exr_start_write(&job.context, target->name, EXR_WRITE_FILE_DIRECTLY, &init);
        if (!result) result = write_header(&job);
        if (!result) result = write_chunks(&job);
        // The table of chunks is written last, by exr_finish; after a failure it must not be asked for.
        if (job.context) {
            exr_result_t finished = exr_finish(&job.context);
            if (!result) result = finished;
        }
    }
    free(job.channels);
    if (result == EXR_ERR_OUT_OF_MEMORY || stream.no_memory) return sheen_image_no_memory(target->name, target->log);
    if (result) { // nothing of the world takes part: the layers or attributes are impossible
        sheen_exr_fail(&stream, result, target->name, target->log);
        return SHEEN_ERR_INVALID;
    }
    return status;
}
