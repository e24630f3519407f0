// SPDX-License-Identifier: Apache-2.0
// Whole files in memory, and names of files beside other files.
#ifndef SHEEN_IO_FILE_H
#define SHEEN_IO_FILE_H

#include "base/arena.h"
#include "base/log.h"

#include <stdbool.h>
#include <stddef.h>

/** The bytes of a file and a zero behind them; free with sheen_file_free. */
typedef struct SheenFile {
    char *data;
    size_t size;
} SheenFile;

/** Reads a regular file. Errors: SHEEN_ERR_IO (`FILE: reason`), SHEEN_ERR_NOMEM. */
SHEEN_NODISCARD SheenStatus sheen_file_read(const char *path, const SheenLog *log, SheenFile *out);

void sheen_file_free(SheenFile *file);

/** @return true when `path` is a regular file that can be read. */
bool sheen_file_readable(const char *path);

/** @return true when the path ends in `ending` (".xml"), in any case. */
bool sheen_path_has_ending(const char *path, const char *ending);

/** @return `name` as seen from the folder of the file `beside`, in the arena; NULL when out of memory. */
char *sheen_path_beside(SheenArena *arena, const char *beside, const char *name);

#endif
