// SPDX-License-Identifier: Apache-2.0
// The reader of Mitsuba scenes on any bytes, without other files: no crash, and either a scene or an error.
#include "errors.h"
#include "io/mitsuba.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int n_errors = 0;
    SheenLog log = {count_errors, &n_errors};
    SheenScene *scene = NULL;
    SheenStatus s = sheen_mitsuba_parse((const char *)data, size, "fuzz.xml", false, &log, &scene);
    if ((s == SHEEN_OK) != (scene != NULL) || n_errors != (s != SHEEN_OK)) abort();
    sheen_scene_destroy(&scene);
    return 0;
}
