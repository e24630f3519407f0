// SPDX-License-Identifier: Apache-2.0
// What an animation's frames were made with and how far it got: a small file beside them, by which a later run goes on.
#ifndef SHEEN_CLI_MANIFEST_H
#define SHEEN_CLI_MANIFEST_H

#include "animate_options.h"
#include "run.h"

#include <jansson.h>

typedef struct Manifest {
    json_t *made_with; // version, scene, camera, camera path, options
    long first, next;  // frames from the first to the one before next are whole
} Manifest;

/**
 * What this run makes frames with.
 * @param camera_path  the file as given, or NULL
 * @param camera       the scene's that is meant
 * @return the exit code, after a message when files cannot be read
 */
int manifest_make(const Run *run, const char *camera_path, const SheenCamera *camera, long first, Manifest *out);
void manifest_free(Manifest *manifest);

/** Writes it beside the frames of every pattern. @return false after one line on stderr */
bool manifest_write(const Manifest *manifest, const TextList *outputs);

/**
 * Reads what an earlier run with the same patterns left and finds where this one goes on: manifest->first and next,
 * which stay where there was no earlier run.
 * @return the exit code: not CLI_DONE after one line that tells what differs
 */
int manifest_resume(const Command *command, const TextList *outputs, long last, Manifest *manifest);

#endif
