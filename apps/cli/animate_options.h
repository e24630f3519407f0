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
    const char *camera_path; // file, NULL for the scene's camera
    int temporal;            // Temporal
    bool resume;
    long first, last; // of `frames`
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

#endif
