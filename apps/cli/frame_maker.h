// SPDX-License-Identifier: Apache-2.0
// The frames of a walkthrough, with the records that they share.
#ifndef SHEEN_CLI_FRAME_MAKER_H
#define SHEEN_CLI_FRAME_MAKER_H

#include "animate_options.h"
#include "run.h"
#include "stats.h"

#include "integrator/caches.h"
#include "render/session.h"
#include "scene/camera_path.h"

typedef struct FrameMaker {
    Run *run;
    const AnimateValues *values;
    const SheenCameraPath *path; // NULL: the camera stands still
    const SheenCamera *camera;   // then
    SheenRenderSettings settings;
    RunStats *stats; // what is made is added here
    // Of the frames that share something; the session is NULL when every frame is made by itself.
    SheenProgress progress;
    SheenSession *session;
    RecordCounts kept;
    uint64_t deep; // records that are in the statistics
    bool written;  // the records are in --cache-out
} FrameMaker;

/** @return the camera of a frame, or why there is none. */
SheenCameraFault frame_maker_camera(const FrameMaker *maker, long frame, SheenCamera *out);

/**
 * Makes what frames share beside what --cache-in has: for all at once with --prefill, which --cache-out gets then, else
 * for those before `begin`, the first that is to be rendered.
 * @param maker  with the fields before `progress` set; must not move then
 * @return the exit code; frame_maker_end frees in either case
 */
int frame_maker_begin(FrameMaker *maker, long begin);

/**
 * Renders a frame; the next after the one before, or after those that frame_maker_begin was told of.
 * @param film   owned by the caller, NULL on failure
 * @param frame  gets its figures but for the time, which are added to the run's
 */
SheenStatus frame_maker_render(FrameMaker *maker, long number, SheenFilm **film, FrameStats *frame);

/** Writes the records made so far to --cache-out, if it is given and has them not. @return the exit code */
int frame_maker_keep(FrameMaker *maker);

void frame_maker_end(FrameMaker *maker);

#endif
