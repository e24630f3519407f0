// SPDX-License-Identifier: Apache-2.0
#include "io/load.h"

#include "io/file_path.h"
#include "io/mitsuba.h"
#include "io/obj_scene.h"

SheenStatus sheen_scene_load(const char *path, const SheenLog *log, SheenScene **out)
{
    return sheen_scene_load_with(path, (SheenDefines){NULL, 0}, log, out);
}

SheenStatus sheen_scene_load_with(const char *path, SheenDefines defines, const SheenLog *log, SheenScene **out)
{
    *out = NULL;
    if (sheen_path_has_ending(path, ".xml")) return sheen_mitsuba_read(path, defines, log, out);
    if (defines.n) sheen_warn(log, "%s: '%s': a scene in this format has no parameters", path, defines.items[0]);
    if (sheen_path_has_ending(path, ".obj")) return sheen_obj_read(path, log, out);
    return sheen_fail(log, SHEEN_ERR_UNSUPPORTED,
                      "%s: not a scene file that can be read: the ending must be .xml or .obj", path);
}
