// SPDX-License-Identifier: Apache-2.0
// Scene files become calls on the builder.
#ifndef SHEEN_IO_LOAD_H
#define SHEEN_IO_LOAD_H

#include "base/log.h"
#include "io/defines.h"
#include "scene/scene.h"

/**
 * Reads a scene file; the format follows the ending (.xml: Mitsuba 0.5, 0.6, 2 and 3; .obj:
 * Wavefront OBJ with its material libraries).
 * @param path  file name; other files are looked for beside the file that names them
 * @param log   one line for the first error, warnings for what is not supported and what stands in for it
 * @param out   owned by the caller, NULL on failure
 * Errors: SHEEN_ERR_IO, SHEEN_ERR_PARSE, SHEEN_ERR_UNSUPPORTED (ending), SHEEN_ERR_NOMEM.
 */
SHEEN_NODISCARD SheenStatus sheen_scene_load(const char *path, const SheenLog *log, SheenScene **out);

/** The same with values for the $parameters of a Mitsuba scene; another format has none and warns. */
SHEEN_NODISCARD SheenStatus sheen_scene_load_with(const char *path, SheenDefines defines, const SheenLog *log,
                                                  SheenScene **out);

#endif
