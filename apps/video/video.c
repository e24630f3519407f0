// SPDX-License-Identifier: Apache-2.0
#include "video_writer.h"

#include "io/file_path.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct Video {
    const VideoWriter *writer;
    VideoStream *stream;
};

// The module stands beside the program, wherever that is: a search path in the program would be passed over by
// sanitizers. It stays for as long as the program runs: its libraries keep things of their own.
static const VideoWriter *load(void)
{
    char path[4096];
    ssize_t n = readlink("/proc/self/exe", path, sizeof path - sizeof SHEEN_VIDEO_MODULE);
    if (n <= 0) return NULL;
    while (n > 0 && path[n - 1] != '/') --n;
    memcpy(path + n, SHEEN_VIDEO_MODULE, sizeof SHEEN_VIDEO_MODULE);
    void *module = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    return module ? dlsym(module, SHEEN_VIDEO_SYMBOL) : NULL;
}

bool video_is_available(void)
{
    return load() != NULL;
}

bool video_has_ending(const char *path)
{
    static const char *const endings[] = {".mp4", ".mkv", ".webm"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; ++i)
        if (sheen_path_has_ending(path, endings[i])) return true;
    return false;
}

SheenStatus video_create(const VideoDesc *desc, const SheenLog *log, Video **out)
{
    *out = NULL;
    const VideoWriter *writer = load();
    if (!writer)
        return sheen_fail(log, SHEEN_ERR_UNSUPPORTED, "%s: this program was built without a writer of videos",
                          desc->path);
    Video *v = calloc(1, sizeof *v);
    if (!v) return sheen_fail(log, SHEEN_ERR_NOMEM, "%s: out of memory", desc->path);
    v->writer = writer;
    SheenStatus status = writer->create(desc, log, &v->stream);
    if (status != SHEEN_OK) video_destroy(&v);
    *out = v;
    return status;
}

SheenStatus video_add(Video *video, const Rgb *pixels)
{
    return video->writer->add(video->stream, pixels);
}

SheenStatus video_finish(Video *video)
{
    return video->writer->finish(video->stream);
}

void video_destroy(Video **video)
{
    if (!*video) return;
    (*video)->writer->destroy(&(*video)->stream);
    free(*video);
    *video = NULL;
}
