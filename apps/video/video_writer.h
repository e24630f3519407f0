// SPDX-License-Identifier: Apache-2.0
// What the module that writes videos gives to the program, which loads it when a video is asked for: with FFmpeg's
// libraries every start would take ten times as long.
#ifndef SHEEN_VIDEO_VIDEO_WRITER_H
#define SHEEN_VIDEO_VIDEO_WRITER_H

#include "video.h"

/** A video in the module. */
typedef struct VideoStream VideoStream;

/** As the functions of video.h. */
typedef struct VideoWriter {
    SheenStatus (*create)(const VideoDesc *desc, const SheenLog *log, VideoStream **out);
    SheenStatus (*add)(VideoStream *stream, const Rgb *pixels);
    SheenStatus (*finish)(VideoStream *stream);
    void (*destroy)(VideoStream **stream);
} VideoWriter;

/** File of the module, from the program's folder, and its one symbol, a VideoWriter. */
#define SHEEN_VIDEO_MODULE "../lib/sheen/sheen-video.so"
#define SHEEN_VIDEO_SYMBOL "sheen_video_writer"

#endif
