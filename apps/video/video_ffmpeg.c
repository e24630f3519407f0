// SPDX-License-Identifier: Apache-2.0
#include "video_writer.h"

#include "image/yuv.h"
#include "io/file_path.h"

#include <errno.h>
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct VideoStream {
    const SheenLog *log;
    char *path, *beside; // the name, and that of the file in work
    uint32_t width, height;
    float exposure;
    AVFormatContext *format;
    AVCodecContext *codec;
    AVStream *stream;
    AVFrame *frame;
    AVPacket *packet;
    bool finished;
};

/** An encoder and its settings: near to what the eye cannot tell from the frames. */
typedef struct Encoder {
    const char *ending, *name;
    const char *options[8]; // names and values, NULL at the end
} Encoder;

static const Encoder encoders[] = {
    {".webm", "libvpx-vp9", {"crf", "20", "b", "0", "cpu-used", "2", NULL}},
    {"", "libx264", {"crf", "16", "preset", "medium", NULL}},
};

static const Encoder *encoder_of(const char *path)
{
    const Encoder *e = encoders;
    while (!sheen_path_has_ending(path, e->ending)) ++e; // the last ending is empty
    return e;
}

/** Fails with what FFmpeg says. */
static SheenStatus fail(const VideoStream *v, int error)
{
    char text[AV_ERROR_MAX_STRING_SIZE];
    av_strerror(error, text, sizeof text);
    return sheen_fail(v->log, error == AVERROR(ENOMEM) ? SHEEN_ERR_NOMEM : SHEEN_ERR_IO, "%s: %s", v->path, text);
}

static SheenStatus open_codec(VideoStream *v, const VideoDesc *desc)
{
    const Encoder *encoder = encoder_of(desc->path);
    const AVCodec *codec = avcodec_find_encoder_by_name(encoder->name);
    if (!codec)
        return sheen_fail(v->log, SHEEN_ERR_UNSUPPORTED, "%s: libavcodec has no encoder '%s' here", v->path,
                          encoder->name);
    AVCodecContext *c = v->codec = avcodec_alloc_context3(codec);
    if (!c) return fail(v, AVERROR(ENOMEM));
    c->width = (int)sheen_yuv_side(desc->width);
    c->height = (int)sheen_yuv_side(desc->height);
    c->pix_fmt = AV_PIX_FMT_YUV420P;
    c->framerate = av_d2q(desc->fps, 1001000);
    c->time_base = av_inv_q(c->framerate);
    c->sample_aspect_ratio = (AVRational){1, 1};
    // What sheen_yuv_encode makes.
    c->color_primaries = AVCOL_PRI_BT709;
    c->color_trc = AVCOL_TRC_IEC61966_2_1;
    c->colorspace = AVCOL_SPC_BT709;
    c->color_range = AVCOL_RANGE_MPEG;
    c->chroma_sample_location = AVCHROMA_LOC_LEFT;
    // One thread: with several the bits depend on their number.
    c->thread_count = 1;
    c->flags |= AV_CODEC_FLAG_BITEXACT;
    if (v->format->oformat->flags & AVFMT_GLOBALHEADER) c->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    for (const char *const *o = encoder->options; *o; o += 2)
        if (av_opt_set(c, o[0], o[1], AV_OPT_SEARCH_CHILDREN) < 0)
            return sheen_fail(v->log, SHEEN_ERR_UNSUPPORTED, "%s: the encoder '%s' has no option '%s' here", v->path,
                              encoder->name, o[0]);
    int error = avcodec_open2(c, codec, NULL);
    return error < 0 ? fail(v, error) : SHEEN_OK;
}

static SheenStatus open_file(VideoStream *v)
{
    v->stream = avformat_new_stream(v->format, NULL);
    if (!v->stream) return fail(v, AVERROR(ENOMEM));
    v->stream->time_base = v->codec->time_base;
    v->stream->avg_frame_rate = v->codec->framerate;
    int error = avcodec_parameters_from_context(v->stream->codecpar, v->codec);
    if (error >= 0) error = avio_open(&v->format->pb, v->beside, AVIO_FLAG_WRITE);
    if (error >= 0) error = avformat_write_header(v->format, NULL);
    return error < 0 ? fail(v, error) : SHEEN_OK;
}

static SheenStatus open_frame(VideoStream *v)
{
    v->frame = av_frame_alloc();
    v->packet = av_packet_alloc();
    if (!v->frame || !v->packet) return fail(v, AVERROR(ENOMEM));
    const AVCodecContext *c = v->codec;
    v->frame->format = c->pix_fmt;
    v->frame->pts = 0;
    v->frame->width = c->width, v->frame->height = c->height;
    v->frame->color_primaries = c->color_primaries, v->frame->color_trc = c->color_trc;
    v->frame->colorspace = c->colorspace, v->frame->color_range = c->color_range;
    v->frame->chroma_location = c->chroma_sample_location;
    int error = av_frame_get_buffer(v->frame, 0);
    return error < 0 ? fail(v, error) : SHEEN_OK;
}

static void destroy(VideoStream **video)
{
    VideoStream *v = *video;
    if (!v) return;
    if (v->format) avio_closep(&v->format->pb);
    if (!v->finished && v->beside) unlink(v->beside);
    av_packet_free(&v->packet);
    av_frame_free(&v->frame);
    avcodec_free_context(&v->codec);
    avformat_free_context(v->format);
    free(v->beside);
    free(v->path);
    free(v);
    *video = NULL;
}

static SheenStatus create(const VideoDesc *desc, const SheenLog *log, VideoStream **out)
{
    *out = NULL;
    av_log_set_level(AV_LOG_QUIET); // what is wrong goes through our log
    VideoStream *v = calloc(1, sizeof *v);
    size_t size = strlen(desc->path) + 32;
    if (v) v->path = strdup(desc->path);
    if (v) v->beside = malloc(size);
    if (!v || !v->path || !v->beside) {
        destroy(&v);
        return sheen_fail(log, SHEEN_ERR_NOMEM, "%s: out of memory", desc->path);
    }
    v->log = log, v->width = desc->width, v->height = desc->height, v->exposure = desc->exposure;
    snprintf(v->beside, size, "%s.tmp%ld", desc->path, (long)getpid());
    int error = avformat_alloc_output_context2(&v->format, av_guess_format(NULL, desc->path, NULL), NULL, v->beside);
    SheenStatus status = error < 0 ? fail(v, error) : SHEEN_OK;
    if (status == SHEEN_OK) {
        v->format->flags |= AVFMT_FLAG_BITEXACT;
        status = open_codec(v, desc);
    }
    if (status == SHEEN_OK) status = open_frame(v);
    if (status == SHEEN_OK) status = open_file(v);
    if (status == SHEEN_OK)
        *out = v;
    else
        destroy(&v);
    return status;
}

/** Sends a frame, or NULL for the end, and writes the packets that come out. */
static SheenStatus encode(VideoStream *v, const AVFrame *frame)
{
    int error = avcodec_send_frame(v->codec, frame);
    while (error >= 0) {
        error = avcodec_receive_packet(v->codec, v->packet);
        if (error == AVERROR(EAGAIN) || error == AVERROR_EOF) return SHEEN_OK;
        if (error < 0) break;
        v->packet->duration = 1;
        av_packet_rescale_ts(v->packet, v->codec->time_base, v->stream->time_base);
        v->packet->stream_index = v->stream->index;
        error = av_interleaved_write_frame(v->format, v->packet);
        // A full disk is remembered there, and told at the end only.
        if (error >= 0 && v->format->pb->error < 0) error = v->format->pb->error;
    }
    return fail(v, error);
}

static SheenStatus add(VideoStream *v, const Rgb *pixels)
{
    int error = av_frame_make_writable(v->frame);
    if (error < 0) return fail(v, error);
    SheenYuv yuv = {.plane = {v->frame->data[0], v->frame->data[1], v->frame->data[2]}};
    for (int i = 0; i < 3; ++i) yuv.stride[i] = (size_t)v->frame->linesize[i];
    SheenStatus status = sheen_yuv_encode(pixels, v->width, v->height, v->exposure, &yuv);
    if (status != SHEEN_OK) return fail(v, AVERROR(ENOMEM));
    status = encode(v, v->frame);
    ++v->frame->pts;
    return status;
}

static SheenStatus finish(VideoStream *v)
{
    SheenStatus status = encode(v, NULL);
    if (status != SHEEN_OK) return status;
    int error = av_write_trailer(v->format);
    int closed = avio_closep(&v->format->pb);
    if (error >= 0) error = closed;
    if (error >= 0 && rename(v->beside, v->path) != 0) error = AVERROR(errno);
    if (error < 0) return fail(v, error);
    v->finished = true;
    return SHEEN_OK;
}

extern const VideoWriter sheen_video_writer __attribute__((visibility("default")));
const VideoWriter sheen_video_writer = {create, add, finish, destroy};
