// SPDX-License-Identifier: Apache-2.0
// Where the frames of an animation go: patterns of picture files, and videos.
#ifndef SHEEN_CLI_FRAME_OUTPUTS_H
#define SHEEN_CLI_FRAME_OUTPUTS_H

#include "picture_file.h"
#include "video.h"

/** The outputs of a run. */
typedef struct FrameOutputs {
    const Run *run;
    PictureNotes notes;
    Video *videos[TEXT_LIST_MAX]; // NULL for patterns
} FrameOutputs;

/** Checks that names are patterns or videos with endings that can be written. @return false after a message */
bool frame_outputs_check_names(const Command *command, const TextList *outputs);

/** Looks whether every frame could be written now. @return false after one line on stderr */
bool frame_outputs_check_files(const TextList *outputs, long first, long last);

/** @return how many of the outputs are patterns of pictures, not videos. */
size_t frame_outputs_patterns(const TextList *outputs);

/** @return whether a frame is there, of all patterns. */
bool frame_outputs_have(const TextList *outputs, long frame);

/**
 * Begins the videos of a run whose size is known, and makes the notes of its pictures.
 * @param out  free with frame_outputs_close in either case. @return the library's status
 */
SheenStatus frame_outputs_open(const Run *run, double fps, FrameOutputs *out);

/** Writes a frame to every output. @return the library's status */
SheenStatus frame_outputs_write(FrameOutputs *outputs, long frame, const SheenFilm *film);

/** Ends the videos. @return the library's status */
SheenStatus frame_outputs_finish(FrameOutputs *outputs);

/** Frees all, and drops videos that are not finished. */
void frame_outputs_close(FrameOutputs *outputs);

#endif
