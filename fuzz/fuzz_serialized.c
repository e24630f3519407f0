// SPDX-License-Identifier: Apache-2.0
// The reader of serialized meshes on any bytes: no crash, and every index that it lets through is in range. The first
// byte chooses the mesh of the file; the rest is taken as the file, and as what its zlib stream holds.
#include "io/mesh.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void parse(const uint8_t *data, size_t size, uint32_t index)
{
    SheenArena *arena = sheen_arena_create();
    MeshData m;
    bool face_normals;
    if (!arena) return;
    if (sheen_serialized_parse((const char *)data, size, "fuzz.serialized", index, arena, NULL, &m, &face_normals) ==
        SHEEN_OK)
        for (uint32_t i = 0; i < m.n_triangles; ++i)
            for (int j = 0; j < 3; ++j)
                if (m.triangles[i][j] >= m.n_vertices) abort();
    sheen_arena_destroy(&arena);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 2) return 0;
    parse(data + 1, size - 1, data[0] & 3);
    uLongf packed = compressBound(size - 1);
    uint8_t *file = malloc(packed + 4);
    if (!file) return 0;
    const uint8_t header[4] = {0x1C, 0x04, 3 + (data[0] & 1), 0};
    memcpy(file, header, sizeof header);
    if (compress(file + 4, &packed, data + 1, size - 1) == Z_OK) parse(file, packed + 4, 0);
    free(file);
    return 0;
}
