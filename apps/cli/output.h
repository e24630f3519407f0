// SPDX-License-Identifier: Apache-2.0
// Files that a command writes: looked at before the work, so that an hour is not lost, and written whole or not at all.
#ifndef SHEEN_CLI_OUTPUT_H
#define SHEEN_CLI_OUTPUT_H

#include <stdbool.h>
#include <stddef.h>

/**
 * Looks whether a file could be written now: its folder is there and writable, and it is not itself a folder.
 * @param to_device  the path may be a device or pipe, which is written to instead of being replaced
 * @return true, or false after one line on stderr
 */
bool output_check(const char *path, bool to_device);

/**
 * Writes a text and a line end: beside the file, then renamed; "-" is stdout; into a device or pipe directly.
 * @return true, or false after one line on stderr
 */
bool output_write_text(const char *path, const char *text);

#endif
