// SPDX-License-Identifier: Apache-2.0
// Progress on stderr: one live line on a terminal, a line every few seconds elsewhere.
#ifndef SHEEN_CLI_PROGRESS_H
#define SHEEN_CLI_PROGRESS_H

#include "base/progress.h"

#include <stdbool.h>

typedef enum ProgressMode { PROGRESS_AUTO, PROGRESS_PLAIN, PROGRESS_NONE } ProgressMode;

typedef struct ProgressShow {
    bool on, live;
    bool on_screen;    // the live line stands on the terminal
    const char *stage; // the last one reported
    double stage_start, last_shown;
    // Of work in parts, such as frames: what they are, NULL for none, which one it is, and how many.
    const char *parts;
    size_t part, n_parts;
    double parts_start;
} ProgressShow;

/** `auto` is live on a terminal and plain elsewhere. */
ProgressShow progress_show_make(ProgressMode mode);

/** What the library reports to. @param show  borrowed */
SheenProgress progress_show_sink(ProgressShow *show);

/** From now on the work is part `part` of `n` that are alike, from 0; `what` is a literal: "frame". */
void progress_show_part(ProgressShow *show, const char *what, size_t part, size_t n);

/** Takes the live line off the screen, before something else is printed or at the end. */
void progress_show_clear(ProgressShow *show);

#endif
