// SPDX-License-Identifier: Apache-2.0
// The program without FFmpeg's libraries: it says so before any work.
#include "video.h"

#include <stddef.h>

bool video_is_available(void)
{
    return false;
}

SheenStatus video_create(const VideoDesc *desc, const SheenLog *log, Video **out)
{
    *out = NULL;
    return sheen_fail(log, SHEEN_ERR_UNSUPPORTED, "%s: this program was built without a writer of videos", desc->path);
}

SheenStatus video_add(Video *video, const Rgb *pixels)
{
    (void)video, (void)pixels;
    return SHEEN_ERR_UNSUPPORTED;
}

SheenStatus video_finish(Video *video)
{
    (void)video;
    return SHEEN_ERR_UNSUPPORTED;
}

void video_destroy(Video **video)
{
    *video = NULL;
}
