// SPDX-License-Identifier: Apache-2.0
// A Wavefront OBJ file, with its material libraries, as a whole scene.
#ifndef SHEEN_IO_OBJ_SCENE_H
#define SHEEN_IO_OBJ_SCENE_H

#include "base/log.h"
#include "scene/scene.h"

/**
 * Reads an OBJ file as a scene. What emits (Ke) is a light; without any, a uniform sky of radiance 1 shines. A library
 * or picture that is not there is named in a warning, and gray or the material's colour stands in.
 * `path` ends in .obj. Errors as in sheen_scene_load.
 */
SHEEN_NODISCARD SheenStatus sheen_obj_read(const char *path, const SheenLog *log, SheenScene **out);

#endif
