// SPDX-License-Identifier: Apache-2.0
#include "frame_outputs.h"

#include "frame_name.h"
#include "output.h"

#include "image/image.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// The name that a frame with the most digits has. From malloc, NULL when out of memory.
static char *last_name(const char *path)
{
    return video_has_ending(path) ? strdup(path) : frame_name_make(path, FRAME_MAX);
}

// Two patterns may differ in their number of '#' alone; frames with more digits then have one name.
static bool can_collide(const char *a, const char *b)
{
    char *of_a = last_name(a), *of_b = last_name(b);
    bool same = of_a && of_b && strcmp(of_a, of_b) == 0;
    free(of_a);
    free(of_b);
    return same;
}

static bool check_name(const Command *command, const char *path)
{
    if (video_has_ending(path)) {
        if (video_is_available()) return true;
        cli_usage_error(command, "--output: '%s': this program was built without a writer of videos", path);
    } else if (!sheen_image_writable_format(path)) {
        cli_usage_error(command, "--output: '%s' does not end in .exr, .hdr, .pfm, .png, .mp4, .mkv or .webm", path);
    } else if (!frame_name_is_pattern(path)) {
        cli_usage_error(command, "--output: '%s' has no # in its name, or several runs: name.####.exr", path);
    } else {
        return true;
    }
    return false;
}

bool frame_outputs_check_names(const Command *command, const TextList *outputs)
{
    if (outputs->n == 0) {
        cli_usage_error(command, "--output: at least one pattern of frames or video is required");
        return false;
    }
    for (size_t i = 0; i < outputs->n; ++i) {
        const char *path = outputs->items[i];
        if (!check_name(command, path)) return false;
        for (size_t k = 0; k < i; ++k) {
            if (!can_collide(path, outputs->items[k])) continue;
            cli_usage_error(command, "--output: '%s' and '%s' may be the same file", outputs->items[k], path);
            return false;
        }
    }
    return true;
}

bool frame_outputs_check_files(const TextList *outputs, long first, long last)
{
    bool ok = true;
    for (size_t i = 0; ok && i < outputs->n; ++i) {
        if (video_has_ending(outputs->items[i])) {
            ok = output_check(outputs->items[i], false);
            continue;
        }
        for (long frame = first; ok && frame <= last; ++frame) {
            char *path = frame_name_make(outputs->items[i], frame);
            ok = path && output_check(path, false);
            if (!path) cli_error("%s: out of memory", outputs->items[i]);
            free(path);
        }
    }
    return ok;
}

size_t frame_outputs_patterns(const TextList *outputs)
{
    size_t n = 0;
    for (size_t i = 0; i < outputs->n; ++i) n += !video_has_ending(outputs->items[i]);
    return n;
}

bool frame_outputs_have(const TextList *outputs, long frame)
{
    bool all = true;
    for (size_t i = 0; all && i < outputs->n; ++i) {
        if (video_has_ending(outputs->items[i])) continue;
        char *path = frame_name_make(outputs->items[i], frame);
        struct stat s;
        all = path && stat(path, &s) == 0 && S_ISREG(s.st_mode);
        free(path);
    }
    return all;
}

SheenStatus frame_outputs_open(const Run *run, double fps, FrameOutputs *out)
{
    const RenderValues *v = run->values;
    *out = (FrameOutputs){.run = run};
    SheenStatus status = picture_notes_make(run, &out->notes) ? SHEEN_OK : SHEEN_ERR_NOMEM;
    for (size_t i = 0; status == SHEEN_OK && i < v->outputs.n; ++i) {
        VideoDesc desc = {.path = v->outputs.items[i],
                          .width = v->size.width,
                          .height = v->size.height,
                          .fps = fps,
                          .exposure = (float)v->exposure};
        if (video_has_ending(desc.path)) status = video_create(&desc, &run->log, &out->videos[i]);
    }
    return status;
}

SheenStatus frame_outputs_write(FrameOutputs *outputs, long frame, const SheenFilm *film)
{
    const TextList *paths = &outputs->run->values->outputs;
    SheenStatus status = SHEEN_OK;
    snprintf(outputs->notes.frame, sizeof outputs->notes.frame, "%ld", frame);
    for (size_t i = 0; status == SHEEN_OK && i < paths->n; ++i) {
        if (outputs->videos[i]) {
            status = video_add(outputs->videos[i], film->color);
            continue;
        }
        char *path = frame_name_make(paths->items[i], frame);
        status = path ? picture_file_write(outputs->run, path, film, &outputs->notes) : SHEEN_ERR_NOMEM;
        free(path);
    }
    return status;
}

SheenStatus frame_outputs_finish(FrameOutputs *outputs)
{
    SheenStatus status = SHEEN_OK;
    for (size_t i = 0; status == SHEEN_OK && i < TEXT_LIST_MAX; ++i)
        if (outputs->videos[i]) status = video_finish(outputs->videos[i]);
    return status;
}

void frame_outputs_close(FrameOutputs *outputs)
{
    for (size_t i = 0; i < TEXT_LIST_MAX; ++i) video_destroy(&outputs->videos[i]);
    picture_notes_free(&outputs->notes);
}
