// SPDX-License-Identifier: Apache-2.0
#include "animate_options.h"

#include "frame_name.h"
#include "frame_outputs.h"

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
    {.kind = OPTION_LATER, .name = "static-records"},
    {.kind = OPTION_LATER, .name = "prefill"},
    {0},
};

const OptionTable animate_tables[] = {
    {output_options, 0},
    RENDER_TABLES(offsetof(AnimateValues, render)),
    {later_options, 0},
    {0},
};

AnimateValues animate_values_default(void)
{
    return (AnimateValues){.render = render_values_default(), .fps = 30.0, .temporal = TEMPORAL_NONE};
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

bool animate_values_check(const Command *command, AnimateValues *values)
{
    if (!frame_outputs_check_names(command, &values->render.outputs)) return false;
    if (values->resume && frame_outputs_patterns(&values->render.outputs) < values->render.outputs.n) {
        cli_usage_error(command, "--resume: a video cannot be gone on with; write frames");
        return false;
    }
    if (values->frames && !read_frames(values->frames, &values->first, &values->last)) {
        cli_usage_error(command, "--frames: '%s' is not A-B with frames from 0 to %d, the first not after the last",
                        values->frames, FRAME_MAX);
        return false;
    }
    return render_values_check(command, &values->render);
}
