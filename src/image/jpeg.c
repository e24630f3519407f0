// SPDX-License-Identifier: Apache-2.0
// JPEG through libjpeg: gray and colour, baseline and progressive.
#include "image/format.h"

#include <setjmp.h>
#include <stdio.h> // before jpeglib.h, which uses FILE and size_t
#include <stdlib.h>
#include <string.h>

#include <jerror.h>
#include <jpeglib.h>

/** Everything allocated hangs here, so that a longjmp loses nothing. */
typedef struct JpegJob {
    struct jpeg_error_mgr errors; // first: libjpeg hands a pointer to it back
    struct jpeg_progress_mgr progress;
    struct jpeg_decompress_struct jpeg;
    jmp_buf back;
    const ImageSource *source;
    ImageBytes *out;
    SheenStatus status;
} JpegJob;

// A progressive file of some bytes a scan can keep a decoder busy for hours; encoders make about ten scans.
enum { max_scans = 256 };

static bool jpeg_recognize(const uint8_t *data, size_t size)
{
    return size >= 3 && data[0] == 0xff && data[1] == 0xd8 && data[2] == 0xff;
}

static void stop(JpegJob *job, SheenStatus status, const char *text)
{
    job->status = sheen_fail(job->source->log, status, "%s: %s", job->source->name, text);
    longjmp(job->back, 1);
}

static void on_error(j_common_ptr common)
{
    JpegJob *job = (JpegJob *)common->err;
    char text[JMSG_LENGTH_MAX];
    common->err->format_message(common, text);
    stop(job, common->err->msg_code == JERR_OUT_OF_MEMORY ? SHEEN_ERR_NOMEM : SHEEN_ERR_PARSE, text);
}

/** Called with level -1 for damage that libjpeg papers over with gray: half a picture is no picture. */
static void on_message(j_common_ptr common, int level)
{
    if (level >= 0) return;
    int code = common->err->msg_code;
    if (code == JWRN_EXTRANEOUS_DATA || code == JWRN_JFIF_MAJOR || code == JWRN_ADOBE_XFORM) return;
    on_error(common);
}

static void on_progress(j_common_ptr common)
{
    JpegJob *job = (JpegJob *)common->err;
    if (job->jpeg.input_scan_number > max_scans) stop(job, SHEEN_ERR_UNSUPPORTED, "more scans than any encoder makes");
}

static void decode(JpegJob *job)
{
    j_decompress_ptr jpeg = &job->jpeg;
    jpeg_create_decompress(jpeg);
    jpeg->progress = &job->progress;
    jpeg_mem_src(jpeg, job->source->data, (unsigned long)job->source->size);
    jpeg_read_header(jpeg, TRUE);
    job->status = sheen_image_alloc_bytes(job->source, jpeg->image_width, jpeg->image_height, job->out);
    if (job->status) return;
    if (jpeg->jpeg_color_space == JCS_CMYK || jpeg->jpeg_color_space == JCS_YCCK)
        stop(job, SHEEN_ERR_UNSUPPORTED, "JPEG in CMYK is not supported; convert it to RGB");
    jpeg->out_color_space = JCS_RGB;
    jpeg->dct_method = JDCT_ISLOW; // the exact one, the same on all machines
    jpeg_start_decompress(jpeg);
    while (jpeg->output_scanline < jpeg->output_height) {
        JSAMPROW row = job->out->pixels + (size_t)jpeg->output_scanline * job->out->width * 3;
        jpeg_read_scanlines(jpeg, &row, 1);
    }
    jpeg_finish_decompress(jpeg);
}

static SheenStatus jpeg_decode_bytes(const ImageSource *source, ImageChannels channels, ImageBytes *out)
{
    if (channels == IMAGE_ALPHA) return SHEEN_OK; // it has none
    JpegJob job = {.source = source, .out = out};
    job.jpeg.err = jpeg_std_error(&job.errors);
    job.errors.error_exit = on_error;
    job.errors.emit_message = on_message;
    job.progress.progress_monitor = on_progress;
    if (!setjmp(job.back)) decode(&job);
    jpeg_destroy_decompress(&job.jpeg);
    return job.status;
}

const ImageFormat sheen_format_jpeg = {
    .endings = {".jpg", ".jpeg"}, .recognize = jpeg_recognize, .decode_bytes = jpeg_decode_bytes};
