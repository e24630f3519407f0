// SPDX-License-Identifier: Apache-2.0
// PNG through libpng: all kinds are read, 8-bit RGB is written. A gAMA chunk is not obeyed: pixels are taken as sRGB.
#include "image/format.h"

#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

/** What libpng's callbacks need. Everything allocated hangs here, so that a longjmp loses nothing. */
typedef struct PngJob {
    png_structp png;
    png_infop info;
    const ImageSource *source;
    size_t at; // next byte of the source
    ImageBuffer *target;
    uint8_t *pixels; // [height][width][n_channels], 8 or 16 bits each
    png_bytep *rows;
    uint32_t width, height;
    int depth;  // bits of a sample as delivered, 8 or 16
    bool alpha; // keep it; n_channels is then 4 where there is one
    size_t n_channels;
    SheenStatus status;
    char message[128];
} PngJob;

static bool png_recognize(const uint8_t *data, size_t size)
{
    return size >= 8 && !memcmp(data, "\x89PNG\r\n\x1a\n", 8);
}

static PNG_NORETURN void on_error(png_structp png, png_const_charp text)
{
    PngJob *job = png_get_error_ptr(png);
    if (!job->message[0]) {
        strncpy(job->message, text, sizeof job->message - 1);
        job->message[sizeof job->message - 1] = 0;
    }
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp text)
{
    (void)png; // chunks that we do not use may be as odd as they like
    (void)text;
}

static void read_source(png_structp png, png_bytep out, size_t size)
{
    PngJob *job = png_get_io_ptr(png);
    if (size > job->source->size - job->at) png_error(png, "the file ends before the picture does");
    memcpy(out, job->source->data + job->at, size);
    job->at += size;
}

/** Reads the header and asks libpng for RGB, with alpha where that is wanted and there is one. */
static void read_header(PngJob *job)
{
    png_structp png = job->png;
    png_set_read_fn(png, job, read_source);
    png_set_user_limits(png, SHEEN_IMAGE_MAX_SIDE, SHEEN_IMAGE_MAX_SIDE);
    png_read_info(png, job->info);
    job->width = png_get_image_width(png, job->info);
    job->height = png_get_image_height(png, job->info);
    job->status = sheen_image_check_size(job->source, job->width, job->height);
    if (job->status) png_longjmp(png, 1);
    png_set_expand(png); // palette to RGB, 1, 2 and 4 bits to 8
    png_set_gray_to_rgb(png);
    if (!job->alpha) png_set_strip_alpha(png);
    png_set_interlace_handling(png);
    if (job->depth == 8) png_set_scale_16(png);
    png_read_update_info(png, job->info);
    job->depth = png_get_bit_depth(png, job->info);
    job->n_channels = png_get_channels(png, job->info);
    bool known = job->n_channels == 3 || (job->n_channels == 4 && job->alpha);
    if (!known || (job->depth != 8 && job->depth != 16)) png_error(png, "this kind of pixel is not known");
}

static void read_pixels(PngJob *job)
{
    size_t row_size = (size_t)job->width * job->n_channels * (size_t)job->depth / 8;
    job->pixels = calloc(job->height, row_size);
    job->rows = malloc(job->height * sizeof *job->rows);
    if (!job->pixels || !job->rows) {
        job->status = sheen_image_no_memory(job->source->name, job->source->log);
        png_longjmp(job->png, 1);
    }
    for (uint32_t y = 0; y < job->height; ++y) job->rows[y] = job->pixels + y * row_size;
    png_read_image(job->png, job->rows);
    png_read_end(job->png, NULL);
}

/** The only function that libpng jumps back to; it has no locals that could be lost. */
static void run(PngJob *job, void (*work)(PngJob *))
{
    if (setjmp(png_jmpbuf(job->png))) {
        if (!job->status) job->status = SHEEN_ERR_PARSE;
        return;
    }
    work(job);
}

/** Decodes to job->pixels, which the caller frees. @param depth  8, or 16 for the depth that the file has */
static SheenStatus decode_to_depth(const ImageSource *source, int depth, bool alpha, PngJob *job)
{
    *job = (PngJob){.source = source, .depth = depth, .alpha = alpha};
    job->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, job, on_error, on_warning);
    if (job->png) job->info = png_create_info_struct(job->png);
    if (!job->png || !job->info) {
        png_destroy_read_struct(&job->png, NULL, NULL);
        return sheen_image_no_memory(source->name, source->log);
    }
    run(job, read_header);
    if (!job->status) run(job, read_pixels);
    png_destroy_read_struct(&job->png, &job->info, NULL);
    free(job->rows);
    if (job->status && job->message[0]) sheen_fail(source->log, job->status, "%s: %s", source->name, job->message);
    return job->status;
}

static SheenStatus png_decode_bytes(const ImageSource *source, ImageChannels channels, ImageBytes *out)
{
    PngJob job;
    SheenStatus status = decode_to_depth(source, 8, channels == IMAGE_ALPHA, &job);
    *out = (ImageBytes){job.width, job.height, job.pixels};
    if (status || channels == IMAGE_RGB) return status;
    if (job.n_channels == 4) {
        sheen_image_spread_alpha(job.pixels, (size_t)job.width * job.height);
    } else {
        free(job.pixels);
        out->pixels = NULL;
    }
    return SHEEN_OK;
}

static SheenStatus png_decode(const ImageSource *source, SheenImage *out)
{
    PngJob job;
    SheenStatus status = decode_to_depth(source, 16, false, &job);
    if (!status) status = sheen_image_alloc(source, job.width, job.height, out);
    float largest = job.depth == 16 ? 65535.0f : 255.0f;
    float *linear = malloc(65536 * sizeof *linear);
    if (!status && !linear) status = sheen_image_no_memory(source->name, source->log);
    if (!status) {
        for (int i = 0; i <= (int)largest; ++i) linear[i] = sheen_srgb_decode((float)i / largest);
        float *to = &out->pixels[0].r;
        size_t n = (size_t)job.width * job.height * 3;
        const uint8_t *p = job.pixels;
        for (size_t i = 0; i < n; ++i) to[i] = linear[job.depth == 16 ? p[2 * i] << 8 | p[2 * i + 1] : p[i]];
    }
    free(linear);
    free(job.pixels);
    return status;
}

static void write_target(png_structp png, png_bytep data, size_t size)
{
    PngJob *job = png_get_io_ptr(png);
    if (!buffer_append(job->target, data, size)) png_error(png, "out of memory");
}

static void flush_target(png_structp png)
{
    (void)png;
}

static void write_pixels(PngJob *job)
{
    png_structp png = job->png;
    png_set_write_fn(png, job, write_target, flush_target);
    png_set_IHDR(png, job->info, job->width, job->height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, job->info, PNG_sRGB_INTENT_RELATIVE);
    png_write_info(png, job->info);
    for (uint32_t y = 0; y < job->height; ++y) png_write_row(png, job->pixels + (size_t)y * job->width * 3);
    png_write_end(png, NULL);
}

static SheenStatus png_encode(const ImageTarget *target, ImageBuffer *out)
{
    const SheenImageView *view = target->view;
    size_t n = (size_t)view->width * view->height * 3;
    PngJob job = {.target = out, .width = view->width, .height = view->height, .pixels = malloc(n)};
    job.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &job, on_error, on_warning);
    if (job.png) job.info = png_create_info_struct(job.png);
    if (job.info && job.pixels) {
        // In that order, so that an infinite exposure makes no NaN of black.
        float scale = clampf(exp2f(target->exposure), 0.0f, 0x1p126f);
        const float *from = &view->pixels[0].r;
        for (size_t i = 0; i < n; ++i) job.pixels[i] = (uint8_t)rintf(255.0f * sheen_srgb_encode(scale * from[i]));
        run(&job, write_pixels);
    } else {
        job.status = SHEEN_ERR_NOMEM;
    }
    png_destroy_write_struct(&job.png, &job.info);
    free(job.pixels);
    return job.status ? sheen_image_no_memory(target->name, target->log) : SHEEN_OK;
}

const ImageFormat sheen_format_png = {.endings = {".png"},
                                      .recognize = png_recognize,
                                      .decode = png_decode,
                                      .decode_bytes = png_decode_bytes,
                                      .encode = png_encode};
