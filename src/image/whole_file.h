// SPDX-License-Identifier: Apache-2.0
// Files as a whole: read at once, or written so that they appear whole or not at all.
#ifndef SHEEN_IMAGE_WHOLE_FILE_H
#define SHEEN_IMAGE_WHOLE_FILE_H

#include "base/log.h"

#include <stddef.h>
#include <stdint.h>

/** Bytes that a file may have which is read as a whole. */
#define SHEEN_FILE_MAX (((uint64_t)1 << 32) - 1)

/**
 * Reads all of a file; a pipe too.
 * @param data  from malloc, owned by the caller; NULL on failure. An empty file gives a valid pointer.
 * Errors: SHEEN_ERR_IO with the file's name and the reason, also above 4 GiB; SHEEN_ERR_NOMEM.
 */
SHEEN_NODISCARD SheenStatus sheen_file_read(const char *path, const SheenLog *log, uint8_t **data, size_t *size);

/**
 * Writes a file beside `path` (PATH.tmpPID), flushes it to the disk and renames it, so that an existing file is
 * replaced only by a finished one. Nothing stays behind on failure. Errors: SHEEN_ERR_IO with the file's name and the
 * reason.
 */
SHEEN_NODISCARD SheenStatus sheen_file_write(const char *path, const void *data, size_t size, const SheenLog *log);

#endif
