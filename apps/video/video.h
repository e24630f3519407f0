// SPDX-License-Identifier: Apache-2.0
// Videos, through FFmpeg's libraries where they were there when the program was built. They stand apart from the rest
// because their encoders may be under other licences.
#ifndef SHEEN_VIDEO_VIDEO_H
#define SHEEN_VIDEO_VIDEO_H

#include "base/log.h"
#include "math/vec.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct Video Video;

typedef struct VideoDesc {
    const char *path;       // .mp4, .mkv: H.264; .webm: VP9; borrowed
    uint32_t width, height; // pixels of the pictures; odd sides are padded
    double fps;
    float exposure; // stops
} VideoDesc;

/** @return whether this program can write videos. */
bool video_is_available(void);

/** @return whether a path has the ending of a video. */
bool video_has_ending(const char *path);

/**
 * Begins a video, in a file beside its path.
 * @param out  owned by the caller, NULL on failure
 * Errors: SHEEN_ERR_UNSUPPORTED, SHEEN_ERR_IO, SHEEN_ERR_NOMEM, each with one line in the log.
 */
SHEEN_NODISCARD SheenStatus video_create(const VideoDesc *desc, const SheenLog *log, Video **out);

/** Appends a picture. @param pixels  [height][width], linear sRGB primaries */
SHEEN_NODISCARD SheenStatus video_add(Video *video, const Rgb *pixels);

/** Ends the video and gives the file its name. The video still is to be destroyed. */
SHEEN_NODISCARD SheenStatus video_finish(Video *video);

/** Frees it, and drops the file of one that is not finished. NULL-safe; sets *video to NULL. */
void video_destroy(Video **video);

#endif
