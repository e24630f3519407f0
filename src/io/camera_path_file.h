// SPDX-License-Identifier: Apache-2.0
// Files of camera paths: {"keys": [{"frame": 0, "origin": [x, y, z], "target": [x, y, z], "up": [x, y, z], "fov": 40},
// ...]}. "up" and "fov" (the whole picture's horizontal angle, degrees) may be left out: the scene's camera tells them.
#ifndef SHEEN_IO_CAMERA_PATH_FILE_H
#define SHEEN_IO_CAMERA_PATH_FILE_H

#include "base/log.h"
#include "scene/camera_path.h"

/**
 * @param base  the scene's camera, for what the file does not tell; see sheen_camera_path_create
 * @param log   `FILE:LINE:COLUMN: what` for the first error; warnings for members that are not known
 * @param out   owned by the caller, NULL on failure
 * Errors: SHEEN_ERR_IO, SHEEN_ERR_PARSE, SHEEN_ERR_NOMEM.
 */
SHEEN_NODISCARD SheenStatus sheen_camera_path_read(const char *path, const SheenCamera *base, const SheenLog *log,
                                                   SheenCameraPath **out);

/** The same from memory; `name` is for messages. */
SHEEN_NODISCARD SheenStatus sheen_camera_path_parse(const char *text, size_t size, const char *name,
                                                    const SheenCamera *base, const SheenLog *log,
                                                    SheenCameraPath **out);

#endif
