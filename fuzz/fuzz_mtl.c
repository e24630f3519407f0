// SPDX-License-Identifier: Apache-2.0
// The reader of material libraries, and the OBJ reader with its parts, on any bytes: no crash, one line for a failure.
#include "errors.h"
#include "io/mtl.h"
#include "io/obj.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int n_errors = 0;
    SheenLog log = {count_errors, &n_errors};
    SheenArena *arena = sheen_arena_create();
    MtlLibrary library;
    ObjFile file;
    if (!arena) return 0;
    SheenStatus s = sheen_mtl_parse((const char *)data, size, "fuzz.mtl", arena, &log, &library);
    if (n_errors != (s != SHEEN_OK)) abort();
    for (uint32_t i = 0; i < library.n; ++i)
        if (!library.materials[i].name || !rgb_finite(library.materials[i].diffuse)) abort();
    n_errors = 0;
    s = sheen_obj_parse_parts((const char *)data, size, "fuzz.obj", arena, &log, &file);
    if (n_errors != (s != SHEEN_OK)) abort();
    uint32_t next = 0;
    for (uint32_t i = 0; i < file.n_runs; ++i) {
        const ObjRun *run = &file.runs[i];
        if (run->first != next || (run->material != SHEEN_NONE && run->material >= file.n_materials)) abort();
        next = run->first + run->n;
    }
    if (next != file.mesh.n_triangles) abort();
    sheen_arena_destroy(&arena);
    return 0;
}
