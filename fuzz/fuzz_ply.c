// SPDX-License-Identifier: Apache-2.0
// The PLY reader on any bytes: no crash, and every index that it lets through is in range.
#include "io/mesh.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    SheenArena *arena = sheen_arena_create();
    MeshData m;
    if (!arena) return 0;
    if (sheen_ply_parse((const char *)data, size, "fuzz.ply", arena, NULL, &m) == SHEEN_OK)
        for (uint32_t i = 0; i < m.n_triangles; ++i)
            for (int j = 0; j < 3; ++j)
                if (m.triangles[i][j] >= m.n_vertices) abort();
    sheen_arena_destroy(&arena);
    return 0;
}
