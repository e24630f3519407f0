// SPDX-License-Identifier: Apache-2.0
#include "frame_outputs.h"

#include "frame_name.h"
#include "output.h"

#include "image/image.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// Two patterns may differ in their number of '#' alone; frames with more digits then have one name.
static bool can_collide(const char *a, const char *b)
{
    char *of_a = frame_name_make(a, FRAME_MAX), *of_b = frame_name_make(b, FRAME_MAX);
    bool same = of_a && of_b && strcmp(of_a, of_b) == 0;
    free(of_a);
    free(of_b);
    return same;
}

bool frame_outputs_check_names(const Command *command, const TextList *outputs)
{
    if (outputs->n == 0) {
        cli_usage_error(command, "--output: at least one pattern of frames is required");
        return false;
    }
    for (size_t i = 0; i < outputs->n; ++i) {
        const char *path = outputs->items[i];
        if (!sheen_image_writable_format(path)) {
            cli_usage_error(command, "--output: '%s' does not end in .exr, .hdr, .pfm or .png", path);
            return false;
        }
        if (!frame_name_is_pattern(path)) {
            cli_usage_error(command, "--output: '%s' has no # in its name, or several runs: name.####.exr", path);
            return false;
        }
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
    for (size_t i = 0; ok && i < outputs->n; ++i)
        for (long frame = first; ok && frame <= last; ++frame) {
            char *path = frame_name_make(outputs->items[i], frame);
            ok = path && output_check(path, false);
            if (!path) cli_error("%s: out of memory", outputs->items[i]);
            free(path);
        }
    return ok;
}

bool frame_outputs_have(const TextList *outputs, long frame)
{
    bool all = true;
    for (size_t i = 0; all && i < outputs->n; ++i) {
        char *path = frame_name_make(outputs->items[i], frame);
        struct stat s;
        all = path && stat(path, &s) == 0 && S_ISREG(s.st_mode);
        free(path);
    }
    return all;
}

SheenStatus frame_outputs_write(const Run *run, long frame, const SheenFilm *film, PictureNotes *notes)
{
    const TextList *outputs = &run->values->outputs;
    SheenStatus status = SHEEN_OK;
    snprintf(notes->frame, sizeof notes->frame, "%ld", frame);
    for (size_t i = 0; status == SHEEN_OK && i < outputs->n; ++i) {
        char *path = frame_name_make(outputs->items[i], frame);
        status = path ? picture_file_write(run, path, film, notes) : SHEEN_ERR_NOMEM;
        free(path);
    }
    return status;
}
