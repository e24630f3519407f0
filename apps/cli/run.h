// SPDX-License-Identifier: Apache-2.0
// What every command that renders does around its pictures: messages, Ctrl-C, the scene, the camera, the threads.
#ifndef SHEEN_CLI_RUN_H
#define SHEEN_CLI_RUN_H

#include "interrupt.h"
#include "render_options.h"
#include "report.h"

typedef struct Run {
    const Command *command;
    const void *all_values;     // of the command's tables
    const RenderValues *values; // those that all share, within all_values
    const char *scene_path;
    const atomic_bool *interrupted; // NULL until the scene is loaded
    ProgressShow show;
    Report report;
    SheenLog log;
    SheenScene *scene;
    SheenPool *pool;
    double start, load; // clock, seconds
} Run;

/**
 * Sets a run up for its messages, which keep pointers into it: it must not move.
 * @param run  with command, values and start
 */
void run_begin(Run *run, const char *scene_path);

/** Frees what the run made. */
void run_end(Run *run);

/** Loads the scene; then Ctrl-C asks instead of ending. @return the exit code */
int run_load(Run *run);

/** Finds --camera by name, then by index. @return false after a message about the command line. */
bool run_find_camera(const Run *run, const SheenCamera **camera);

/** Starts the threads. @return the exit code */
int run_start_threads(Run *run);

/** @return whether Ctrl-C asks to stop. */
bool run_is_interrupted(const Run *run);

/** @return the exit code of a status of the library; CLI_INTERRUPTED, without a line, when it was cancelled. */
int run_exit_code(Run *run, SheenStatus status, const char *what);

/** Says what was dropped; one line. @return CLI_INTERRUPTED */
int run_tell_interrupted(Run *run, const char *what);

/** Warns that samples were left out, if any were. */
void run_warn_nonfinite(const Run *run, uint64_t samples);

/** Warns about layers that would be black. @param exr  some output has layers */
void run_warn_about_layers(const Run *run, bool exr);

/** @return whether --cache-out and --stats, if given, can be written, or false after a message. */
bool run_check_files(const RenderValues *values);

#endif
