// SPDX-License-Identifier: Apache-2.0
// The options of `sheen animate` beside those that all commands share that render.
#ifndef SHEEN_CLI_ANIMATE_OPTIONS_H
#define SHEEN_CLI_ANIMATE_OPTIONS_H

#include "render_options.h"

typedef enum Temporal { TEMPORAL_NONE } Temporal;

typedef struct AnimateValues {
    RenderValues render;
    const char *frames; // "A-B", NULL for the camera path's
    double fps;
    const char *camera_path;     // file, NULL for the scene's camera
    int temporal;                // Temporal
    int static_records, prefill; // Switch
    const char *prefill_frames;  // "A-B", NULL for the frames themselves
    bool resume;
    long first, last;                 // of `frames`
    long records_first, records_last; // the frames by which records are placed
} AnimateValues;

/** Of an AnimateValues. */
extern const OptionTable animate_tables[];

/** The values without any option. */
AnimateValues animate_values_default(void);

/**
 * Checks what one option alone cannot show, and reads --frames.
 * @return true, or false after a message about the command line
 */
bool animate_values_check(const Command *command, AnimateValues *values);

/** The text of a range of frames, as statistics have it. */
typedef struct FrameRange {
    char text[32];
} FrameRange;

/** Takes what depends on each other, when the frames are known: *range gets what values->prefill_frames points to. */
void animate_values_resolve(AnimateValues *values, FrameRange *range);

#endif
