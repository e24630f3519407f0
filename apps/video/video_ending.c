// SPDX-License-Identifier: Apache-2.0
#include "video.h"

#include "io/file_path.h"

bool video_has_ending(const char *path)
{
    static const char *const endings[] = {".mp4", ".mkv", ".webm"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; ++i)
        if (sheen_path_has_ending(path, endings[i])) return true;
    return false;
}
