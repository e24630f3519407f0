// SPDX-License-Identifier: Apache-2.0
#include "animate_options.h"

#include "frame_name.h"
#include "frame_outputs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const Choice temporals[] = {
    {"none", TEMPORAL_NONE},
    {"extrapolated", CHOICE_LATER},
    {"interpolated", CHOICE_LATER},
    {0},
};

static const Option output_options[] = {
    {.kind = OPTION_TEXTS,
     .letter = 'o',
     .name = "output",
     .argument = "FILES",
     .meaning =
         "The frames to write, as a name with # for the digits of their number, which may have more: "
         "walk/box.####.exr. The ending tells the format, as of sheen render. Or a video: .mp4 and .mkv (H.264), "
         ".webm (VP9), of 8 bit in the colours of sRGB. The folder must be there. May be given several times. A "
         "file appears whole or not at all.",
     .standard = "none; at least one is required",
     .example = "-o walk/box.####.exr -o walk.mp4",
     .offset = offsetof(AnimateValues, render.outputs)},
    {.kind = OPTION_TEXT,
     .name = "frames",
     .argument = "A-B",
     .meaning = "The first and the last frame, or one alone. They are numbers of the camera path.",
     .standard = "from the first to the last key of --camera-path, else 0",
     .example = "--frames 0-59",
     .offset = offsetof(AnimateValues, frames)},
    {.kind = OPTION_NUMBER,
     .name = "fps",
     .argument = "N",
     .meaning = "Frames a second of videos.",
     .standard = "30",
     .example = "--fps 25",
     .min = 0.1,
     .max = 1000.0,
     .offset = offsetof(AnimateValues, fps)},
    {.kind = OPTION_TEXT,
     .name = "camera-path",
     .argument = "FILE",
     .meaning = "The way of the camera, in place of the scene's: JSON, {\"keys\": [{\"frame\": 0, \"origin\": [x, y, "
                "z], \"target\": [x, y, z], \"up\": [x, y, z], \"fov\": 40}, ...]}, in ascending order. The camera "
                "goes through the keys and moves smoothly between them; two keys are a straight line, and between "
                "equal keys it stands still. fov is the horizontal angle in degrees. up and fov may be left out, and "
                "what keys do not tell is the scene's camera's: size, filter, lens.",
     .standard = "none; the scene's camera stands still",
     .example = "--camera-path walk.json",
     .recorded = true,
     .offset = offsetof(AnimateValues, camera_path)},
    {.kind = OPTION_CHOICE,
     .name = "temporal",
     .argument = "none",
     .meaning = "How records of moving scenes are used in several frames. none: not at all.",
     .standard = "none",
     .example = "--temporal none",
     .choices = temporals,
     .recorded = true,
     .offset = offsetof(AnimateValues, temporal)},
    {.kind = OPTION_SWITCH,
     .name = "static-records",
     .argument = "[on|off]",
     .meaning =
         "Keep every record of the cache for the whole walkthrough: for scenes that stand still while the camera "
         "moves. off: a new cache for each frame.",
     .standard = "on: nothing moves; off with --integrator path, which has no records",
     .example = "--static-records off",
     .choices = cli_on_off,
     .recorded = true,
     .offset = offsetof(AnimateValues, static_records)},
    {.kind = OPTION_SWITCH,
     .name = "prefill",
     .argument = "[on|off]",
     .meaning =
         "Fill the cache for all frames before the first is shaded, so that nothing pops, and so that each frame "
         "is the same whichever others are rendered. off: each frame fills what it sees, and later ones see "
         "what it left.",
     .standard = "on where records are kept",
     .example = "--prefill off",
     .choices = cli_on_off,
     .recorded = true,
     .offset = offsetof(AnimateValues, prefill)},
    {.kind = OPTION_TEXT,
     .name = "prefill-frames",
     .argument = "A-B",
     .meaning = "Fill the cache for these frames, not those of --frames: parts of a walkthrough that are rendered by "
                "several runs then are the same as those of one.",
     .standard = "those of --frames",
     .example = "--frames 30-59 --prefill-frames 0-59",
     .recorded = true,
     .offset = offsetof(AnimateValues, prefill_frames)},
    {.kind = OPTION_FLAG,
     .name = "resume",
     .meaning =
         "Go on after the last whole frame of an earlier run with the same options. What that was is in a file "
         "beside the frames, walk/box.####.exr.json. If any option, the scene, or the camera path differ, "
         "nothing is done and the difference is told. Without an earlier run the first frame is the first. A video "
         "cannot be gone on with.",
     .example = "--resume",
     .offset = offsetof(AnimateValues, resume)},
    {0},
};

static const Option later_options[] = {
    {.kind = OPTION_LATER, .name = "temporal-accuracy"},
    {.kind = OPTION_LATER, .name = "max-lifespan"},
    {0},
};

const OptionTable animate_tables[] = {
    {output_options, 0},
    RENDER_TABLES(offsetof(AnimateValues, render)),
    {cache_options, offsetof(AnimateValues, render.cache)},
    {later_options, 0},
    {0},
};

AnimateValues animate_values_default(void)
{
    return (AnimateValues){.render = render_values_default(),
                           .fps = 30.0,
                           .temporal = TEMPORAL_NONE,
                           .static_records = SWITCH_UNSET,
                           .prefill = SWITCH_UNSET};
}

/** Reads digits up to `end`. @return false when there are none, or too many */
static bool read_frame(const char *text, size_t length, long *out)
{
    char digits[16];
    if (length == 0 || length >= sizeof digits || strspn(text, "0123456789") < length) return false;
    memcpy(digits, text, length);
    digits[length] = '\0';
    long long frame = strtoll(digits, NULL, 10);
    *out = (long)frame;
    return frame <= FRAME_MAX;
}

static bool read_frames(const char *text, long *first, long *last)
{
    size_t n = strcspn(text, "-");
    if (!read_frame(text, n, first)) return false;
    *last = *first;
    return !text[n] || (read_frame(text + n + 1, strlen(text + n + 1), last) && *first <= *last);
}

// Options that only make sense with each other.
static bool check_records(const Command *command, const AnimateValues *v)
{
    bool path = v->render.integrator == SHEEN_INTEGRATOR_PATH;
    if (path && (v->static_records == SWITCH_ON || v->prefill == SWITCH_ON)) {
        cli_usage_error(command, "--%s: the path integrator has no records",
                        v->static_records == SWITCH_ON ? "static-records" : "prefill");
    } else if (v->prefill == SWITCH_ON && v->static_records == SWITCH_OFF) {
        cli_usage_error(command, "--prefill: goes with --static-records on only");
    } else if (v->static_records == SWITCH_OFF && (v->render.cache.in.n > 0 || v->render.cache.out)) {
        cli_usage_error(command, "--cache-%s: goes with --static-records on only", v->render.cache.out ? "out" : "in");
    } else if (v->prefill_frames && (path || v->prefill == SWITCH_OFF || v->static_records == SWITCH_OFF)) {
        cli_usage_error(command, "--prefill-frames: nothing is filled before the frames here");
    } else {
        return cache_values_check(command, &v->render.cache, !path);
    }
    return false;
}

static bool check_range(const Command *command, const char *option, const char *text, long *first, long *last)
{
    if (!text || read_frames(text, first, last)) return true;
    cli_usage_error(command, "--%s: '%s' is not A-B with frames from 0 to %d, the first not after the last", option,
                    text, FRAME_MAX);
    return false;
}

bool animate_values_check(const Command *command, AnimateValues *values)
{
    AnimateValues *v = values;
    if (!frame_outputs_check_names(command, &v->render.outputs)) return false;
    if (v->resume && frame_outputs_patterns(&v->render.outputs) < v->render.outputs.n) {
        cli_usage_error(command, "--resume: a video cannot be gone on with; write frames");
        return false;
    }
    return check_range(command, "frames", v->frames, &v->first, &v->last) &&
           check_range(command, "prefill-frames", v->prefill_frames, &v->records_first, &v->records_last) &&
           check_records(command, v) && render_values_check(command, &v->render);
}

void animate_values_resolve(AnimateValues *v, FrameRange *range)
{
    bool has_records = v->render.integrator != SHEEN_INTEGRATOR_PATH;
    if (v->static_records == SWITCH_UNSET) v->static_records = has_records ? SWITCH_ON : SWITCH_OFF;
    if (v->prefill == SWITCH_UNSET) v->prefill = v->static_records;
    if (v->static_records == SWITCH_OFF) return;
    if (!v->prefill_frames) v->records_first = v->first, v->records_last = v->last;
    snprintf(range->text, sizeof range->text, "%ld-%ld", v->records_first, v->records_last);
    v->prefill_frames = range->text;
}
