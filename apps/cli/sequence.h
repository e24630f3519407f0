// SPDX-License-Identifier: Apache-2.0
// Several pictures as one operand: those of a folder, or those that a pattern `name.####.exr` matches. They are frames
// of an animation where every name has a number; else each stands for itself, by its name.
#ifndef SHEEN_CLI_SEQUENCE_H
#define SHEEN_CLI_SEQUENCE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct SequenceFrame {
    char *path;  // from malloc
    char *name;  // from malloc: without folder and ending
    long number; // the last digits in its name; not of an animation: says nothing
} SequenceFrame;

typedef struct Sequence {
    SequenceFrame *frames; // ascending by number, else by name
    size_t n;
    bool numbered;
} Sequence;

/** @return true for a folder and for a path with '#' in its last part that is not itself a file. */
bool sequence_is(const char *path);

/**
 * Lists the frames, at least one.
 * @return true, or false after one line on stderr; free with sequence_free in either case
 */
bool sequence_list(const char *path, Sequence *out);

/** Makes names, not numbers, tell the pictures apart. @return false after one line on stderr if two are alike */
bool sequence_use_names(const char *path, Sequence *sequence);

/** @return the order of two pictures of sequences that are numbered, or that are not: below, equal to or above 0. */
int sequence_compare(const SequenceFrame *a, const SequenceFrame *b, bool numbered);

void sequence_free(Sequence *sequence);

#endif
