// SPDX-License-Identifier: Apache-2.0
#include "video.h"

#include <string.h>
#include <strings.h>

bool video_has_ending(const char *path)
{
    static const char *const endings[] = {".mp4", ".mkv", ".webm"};
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof endings / sizeof *endings; ++i)
        if (strcasecmp(dot, endings[i]) == 0) return true;
    return false;
}
