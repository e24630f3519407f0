// SPDX-License-Identifier: Apache-2.0
// Names of frames: a pattern with one run of '#' in its last part, which stands for as many digits, or more.
#ifndef SHEEN_CLI_FRAME_NAME_H
#define SHEEN_CLI_FRAME_NAME_H

#include <stdbool.h>

/** Largest number of a frame: so many digits are read back. */
enum { FRAME_MAX = 999999999 };

/** @return whether the path has exactly one run of '#' in its last part. */
bool frame_name_is_pattern(const char *path);

/** @return whether the name, without its folder, is a frame of the pattern, likewise; *frame gets its number. */
bool frame_name_match(const char *pattern, const char *name, long *frame);

/** @return the path of a frame, from malloc; NULL when out of memory. @param frame  0 to FRAME_MAX */
char *frame_name_make(const char *pattern, long frame);

/** @return what stands behind the last slash. */
const char *path_last_part(const char *path);

#endif
