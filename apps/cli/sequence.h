// SPDX-License-Identifier: Apache-2.0
// Frames of an animation as files: the pictures of a folder, or those that a pattern `name.####.exr` matches.
#ifndef SHEEN_CLI_SEQUENCE_H
#define SHEEN_CLI_SEQUENCE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct SequenceFrame {
    char *path;  // from malloc
    long number; // the last digits in its name; its place in the folder when a name there has none
} SequenceFrame;

typedef struct Sequence {
    SequenceFrame *frames; // ascending by number
    size_t n;
} Sequence;

/** @return true for a folder and for a path with '#' in its last part that is not itself a file. */
bool sequence_is(const char *path);

/**
 * Lists the frames, at least one.
 * @return true, or false after one line on stderr; free with sequence_free in either case
 */
bool sequence_list(const char *path, Sequence *out);

void sequence_free(Sequence *sequence);

#endif
