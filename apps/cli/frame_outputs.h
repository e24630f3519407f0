// SPDX-License-Identifier: Apache-2.0
// Where the frames of an animation go: patterns of picture files.
#ifndef SHEEN_CLI_FRAME_OUTPUTS_H
#define SHEEN_CLI_FRAME_OUTPUTS_H

#include "picture_file.h"

/** Checks that names are patterns with endings that can be written. @return false after a message */
bool frame_outputs_check_names(const Command *command, const TextList *outputs);

/** Looks whether every frame could be written now. @return false after one line on stderr */
bool frame_outputs_check_files(const TextList *outputs, long first, long last);

/** @return whether a frame is there, in all outputs. */
bool frame_outputs_have(const TextList *outputs, long frame);

/** Writes a frame to every output. @param notes  their frame is set. @return the library's status */
SheenStatus frame_outputs_write(const Run *run, long frame, const SheenFilm *film, PictureNotes *notes);

#endif
