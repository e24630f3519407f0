// SPDX-License-Identifier: Apache-2.0
// Names of files beside other files.
#ifndef SHEEN_IO_FILE_PATH_H
#define SHEEN_IO_FILE_PATH_H

#include "base/arena.h"

#include <stdbool.h>

/** @return true when `path` is a regular file that can be read. */
bool sheen_path_readable(const char *path);

/** @return true when `path` is a folder. */
bool sheen_path_is_folder(const char *path);

/** @return true when the path ends in `ending` (".xml"), in any case. */
bool sheen_path_has_ending(const char *path, const char *ending);

/** @return `name` as seen from the folder of the file `beside`, in the arena; NULL when out of memory. */
char *sheen_path_beside(SheenArena *arena, const char *beside, const char *name);

#endif
