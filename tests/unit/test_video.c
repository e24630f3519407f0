// SPDX-License-Identifier: Apache-2.0
// Videos: what a decoder finds in them is what was put in, with the tags of its colours; they appear whole or not.
#include "video.h"

#include "image/yuv.h"
#include "io_kit.h"

#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>

enum { width = 33, height = 18, n_frames = 9 };

/** Every frame is even, of another gray; the right half is redder. */
static void paint(int frame, Rgb *pixels)
{
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            float gray = 0.1f + 0.08f * (float)frame;
            pixels[y * width + x] = rgb(gray, x < width / 2 ? gray : 0.3f * gray, x < width / 2 ? gray : 0.3f * gray);
        }
}

static void write_video(Kit *k, const char *name, bool finish)
{
    char path[256];
    Rgb pixels[width * height];
    kit_path(k, name, path);
    VideoDesc desc = {.path = path, .width = width, .height = height, .fps = 24000.0 / 1001.0};
    Video *video;
    SheenStatus status = video_create(&desc, &k->log, &video);
    if (status) print_error("%s\n", k->error);
    assert_int_equal(status, SHEEN_OK);
    for (int i = 0; i < n_frames; ++i) {
        paint(i, pixels);
        assert_int_equal(video_add(video, pixels), SHEEN_OK);
    }
    if (finish) assert_int_equal(video_finish(video), SHEEN_OK);
    video_destroy(&video);
    assert_null(video);
}

/** Compares a decoded frame with what was painted, near the middles of the halves; the codecs lose a few steps. */
static void check_frame(const AVFrame *f, int index)
{
    static uint8_t y[20][34], u[10][17], v[10][17];
    Rgb pixels[width * height];
    SheenYuv want = {.plane = {y[0], u[0], v[0]}, .stride = {34, 17, 17}};
    paint(index, pixels);
    assert_int_equal(sheen_yuv_encode(pixels, width, height, 0.0f, &want), SHEEN_OK);
    const int columns[] = {6, 26};
    for (int i = 0; i < 2; ++i) {
        int x = columns[i];
        assert_in_range(f->data[0][10 * f->linesize[0] + x] + 3, y[10][x], y[10][x] + 6);
        assert_in_range(f->data[1][5 * f->linesize[1] + x / 2] + 4, u[5][x / 2], u[5][x / 2] + 8);
        assert_in_range(f->data[2][5 * f->linesize[2] + x / 2] + 4, v[5][x / 2], v[5][x / 2] + 8);
    }
}

static int take_frames(AVCodecContext *codec, const AVPacket *packet, AVFrame *frame, int index)
{
    assert_int_equal(avcodec_send_packet(codec, packet), 0);
    while (avcodec_receive_frame(codec, frame) == 0) check_frame(frame, index++);
    return index;
}

static void check_video(Kit *k, const char *name, enum AVCodecID id)
{
    char path[256];
    kit_path(k, name, path);
    AVFormatContext *format = NULL;
    assert_int_equal(avformat_open_input(&format, path, NULL, NULL), 0);
    assert_true(avformat_find_stream_info(format, NULL) >= 0);
    assert_int_equal(format->nb_streams, 1);
    const AVStream *stream = format->streams[0];
    const AVCodecParameters *p = stream->codecpar;
    assert_int_equal(p->codec_id, id);
    assert_int_equal(p->format, AV_PIX_FMT_YUV420P);
    assert_int_equal(p->width, width + 1);
    assert_int_equal(p->height, height);
    assert_int_equal(p->color_primaries, AVCOL_PRI_BT709);
    assert_int_equal(p->color_trc, AVCOL_TRC_IEC61966_2_1);
    assert_int_equal(p->color_space, AVCOL_SPC_BT709);
    assert_int_equal(p->color_range, AVCOL_RANGE_MPEG);
    assert_true(fabs(av_q2d(stream->avg_frame_rate) - 24000.0 / 1001.0) < 0.05); // .webm counts milliseconds

    AVCodecContext *codec = avcodec_alloc_context3(avcodec_find_decoder(id));
    AVPacket *packet = av_packet_alloc();
    AVFrame *frame = av_frame_alloc();
    assert_true(codec && packet && frame);
    assert_true(avcodec_parameters_to_context(codec, p) >= 0);
    codec->thread_count = 1;
    assert_int_equal(avcodec_open2(codec, avcodec_find_decoder(id), NULL), 0);
    int n = 0;
    while (av_read_frame(format, packet) == 0) {
        n = take_frames(codec, packet, frame, n);
        av_packet_unref(packet);
    }
    n = take_frames(codec, NULL, frame, n);
    assert_int_equal(n, n_frames);
    av_frame_free(&frame);
    av_packet_free(&packet);
    avcodec_free_context(&codec);
    avformat_close_input(&format);
}

static void test_what_a_decoder_finds(void **state)
{
    Kit *k = *state;
    write_video(k, "a.mp4", true);
    check_video(k, "a.mp4", AV_CODEC_ID_H264);
    write_video(k, "a.mkv", true);
    check_video(k, "a.mkv", AV_CODEC_ID_H264);
    write_video(k, "a.webm", true);
    check_video(k, "a.webm", AV_CODEC_ID_VP9);
}

static void test_whole_or_not_at_all(void **state)
{
    Kit *k = *state;
    kit_write(k, "old.mp4", "old");
    write_video(k, "old.mp4", false);
    char path[256], text[8] = "";
    kit_path(k, "old.mp4", path);
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    assert_non_null(fgets(text, sizeof text, f));
    fclose(f);
    assert_string_equal(text, "old");
    char command[512];
    snprintf(command, sizeof command, "test \"$(ls %s)\" = old.mp4", k->folder);
    assert_int_equal(system(command), 0); // nothing lies beside it
}

static void test_faults(void **state)
{
    Kit *k = *state;
    char path[256];
    Video *video;
    kit_path(k, "nosuch/a.mp4", path);
    VideoDesc desc = {.path = path, .width = 8, .height = 8, .fps = 30.0};
    assert_int_equal(video_create(&desc, &k->log, &video), SHEEN_ERR_IO);
    assert_null(video);
    assert_int_equal(k->n_errors, 1);
    assert_non_null(strstr(k->error, "nosuch/a.mp4: No such file"));
    assert_true(video_is_available());
    assert_true(video_has_ending("a.mp4") && video_has_ending("x/b.MKV") && video_has_ending("c.webm"));
    assert_false(video_has_ending("mp4") || video_has_ending("a.exr") || video_has_ending("a.mp4.png"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        KIT_TEST(test_what_a_decoder_finds),
        KIT_TEST(test_whole_or_not_at_all),
        KIT_TEST(test_faults),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
