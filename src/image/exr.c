// SPDX-License-Identifier: Apache-2.0
// OpenEXR through its C library, in memory.
#include "image/exr.h"

#include <stdlib.h>
#include <string.h>

// A chunk of the largest picture with a few channels; more is a damaged header.
static const size_t max_allocation = (size_t)1 << 31;

static void *limited_malloc(size_t size)
{
    return size <= max_allocation ? malloc(size) : NULL;
}

static int64_t read_memory(exr_const_context_t context, void *user, void *out, uint64_t size, uint64_t offset,
                           exr_stream_error_func_ptr_t fail)
{
    (void)context;
    (void)fail;
    const ExrStream *stream = user;
    if (offset >= stream->size) return 0;
    uint64_t left = stream->size - offset, n = size < left ? size : left;
    memcpy(out, stream->data + offset, n);
    return (int64_t)n;
}

static int64_t memory_size(exr_const_context_t context, void *user)
{
    (void)context;
    return (int64_t)((const ExrStream *)user)->size;
}

static int64_t write_memory(exr_const_context_t context, void *user, const void *data, uint64_t size, uint64_t offset,
                            exr_stream_error_func_ptr_t fail)
{
    ExrStream *stream = user;
    if (sheen_buffer_write(stream->buffer, offset, data, size)) return (int64_t)size;
    stream->no_memory = true;
    fail(context, EXR_ERR_OUT_OF_MEMORY, "out of memory");
    return -1;
}

/**
 * Keeps the first message: the following ones are about its consequences. For reading only: a context for writing calls
 * this with its lock held, which exr_get_user_data would wait for.
 */
static void keep_message(exr_const_context_t context, exr_result_t code, const char *text)
{
    (void)code;
    void *user = NULL;
    if (!context || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user) return;
    ExrStream *stream = user;
    if (stream->message[0]) return;
    strncpy(stream->message, text, sizeof stream->message - 1);
    for (char *c = stream->message; *c; ++c) {
        if (*c == '\n' || *c == '\r') *c = ' ';
    }
}

static void drop_message(exr_const_context_t context, exr_result_t code, const char *text)
{
    (void)context; // the result code says enough
    (void)code;
    (void)text;
}

exr_context_initializer_t sheen_exr_initializer(ExrStream *stream)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = stream->buffer ? drop_message : keep_message;
    init.alloc_fn = limited_malloc;
    init.free_fn = free;
    init.user_data = stream;
    init.read_fn = read_memory;
    init.size_fn = memory_size;
    init.write_fn = write_memory;
    init.max_image_width = init.max_image_height = SHEEN_IMAGE_MAX_SIDE;
    init.max_tile_width = init.max_tile_height = SHEEN_IMAGE_MAX_SIDE;
    init.zip_level = 4; // in 60 % of the time of the library's 6, for 2 % more bytes
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION; // half a picture is no picture
    return init;
}

SheenStatus sheen_exr_fail(const ExrStream *stream, exr_result_t result, const char *name, const SheenLog *log)
{
    SheenStatus status = result == EXR_ERR_OUT_OF_MEMORY             ? SHEEN_ERR_NOMEM
                         : result == EXR_ERR_FEATURE_NOT_IMPLEMENTED ? SHEEN_ERR_UNSUPPORTED
                                                                     : SHEEN_ERR_PARSE;
    const char *text = stream->message[0] ? stream->message : exr_get_default_error_message(result);
    return sheen_fail(log, status, "%s: OpenEXR: %s", name, text);
}

static bool exr_recognize(const uint8_t *data, size_t size)
{
    return size >= 4 && !memcmp(data, "\x76\x2f\x31\x01", 4);
}

const ImageFormat sheen_format_exr = {
    .endings = {".exr"}, .recognize = exr_recognize, .decode = sheen_exr_decode, .encode = sheen_exr_encode};
