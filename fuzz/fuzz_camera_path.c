// SPDX-License-Identifier: Apache-2.0
// The reader of camera paths on any bytes: no crash, one line for a failure; and every frame of what it takes has a
// camera that can be inverted, or a fault.
#include "errors.h"
#include "io/camera_path_file.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int n_errors = 0;
    SheenLog log = {count_errors, &n_errors};
    SheenCamera base = {.name = "fuzz", .to_world = transform_identity(), .fov_x = 1.0f, .width = 4, .height = 4};
    SheenCameraPath *path;
    SheenStatus s = sheen_camera_path_parse((const char *)data, size, "fuzz.json", &base, &log, &path);
    if (n_errors != (s != SHEEN_OK) || (path != NULL) != (s == SHEEN_OK)) abort();
    if (!path) return 0;
    double first, last;
    sheen_camera_path_range(path, &first, &last);
    for (int i = -1; i <= 33; ++i) {
        SheenCamera c;
        Transform inverse;
        if (sheen_camera_path_at(path, first + (last - first) * i / 32.0, &c)) continue;
        if (!transform_invert(&c.to_world, &inverse) || !(c.fov_x > 0.0f && c.fov_x < SHEEN_PI)) abort();
    }
    sheen_camera_path_destroy(&path);
    return 0;
}
