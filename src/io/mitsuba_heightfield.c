// SPDX-License-Identifier: Apache-2.0
// Height fields of Mitsuba 0.6: a picture's luminance above [-1, 1]^2, its first row at y = -1, as triangles.
#include "io/mesh.h"
#include "io/mitsuba.h"

/** The picture of `filename`, or of a bitmap texture inside; other textures have a resolution that is asked for. */
static bool find_heights(Mitsuba *m, SheenXml *e, SheenTexture *out)
{
    *out = sheen_texture_constant(rgb_gray(0.0f));
    if (sheen_mi_child(e, "filename")) {
        out->kind = SHEEN_TEXTURE_BITMAP;
        return sheen_mi_bitmap(m, e, true, 0.0, &out->bitmap);
    }
    SheenXml *texture = sheen_mi_nested(m, e, "texture");
    if (texture)
        *out = sheen_mi_texture_of(m, texture, MITSUBA_INDEX, rgb_gray(0.0f));
    else
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "a heightfield needs a 'filename' or a texture");
    return !m->status;
}

static float height_at(const SheenTexture *t, uint32_t x, uint32_t y, uint32_t w, uint32_t h)
{
    const SheenBitmap *b = &t->bitmap;
    if (t->kind == SHEEN_TEXTURE_BITMAP && b->floats) return rgb_luminance(b->floats[(size_t)y * b->width + x]);
    // A texture's v runs upward; its pixels' centres are the vertices.
    Vec2 uv = v2(((float)x + 0.5f) / (float)w, 1.0f - ((float)y + 0.5f) / (float)h);
    return rgb_luminance(sheen_texture_eval(t, uv));
}

bool sheen_mi_height_field(Mitsuba *m, SheenXml *e, MeshData *mesh)
{
    SheenTexture t;
    int64_t w = sheen_mi_integer(m, e, "width", 0), h = sheen_mi_integer(m, e, "height", 0);
    float scale = (float)sheen_mi_float(m, e, "scale", 1.0);
    if (m->status || !find_heights(m, e, &t)) return false;
    if (t.kind == SHEEN_TEXTURE_BITMAP) w = t.bitmap.width, h = t.bitmap.height;
    if (!(w >= 2 && h >= 2 && w <= 16384 && h <= 16384)) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "a heightfield has 2 to 16384 heights a side, not %lld x %lld",
                      (long long)w, (long long)h);
        return false;
    }
    const uint32_t columns = (uint32_t)w, rows = (uint32_t)h;
    *mesh = (MeshData){.n_vertices = columns * rows, .n_triangles = 2 * (columns - 1) * (rows - 1)};
    if (!sheen_mesh_alloc(m->arena, mesh, false, true)) {
        sheen_mi_fail(m, SHEEN_ERR_NOMEM, e, "out of memory");
        return false;
    }
    for (uint32_t y = 0, i = 0; y < rows; ++y)
        for (uint32_t x = 0; x < columns; ++x, ++i) {
            float u = (float)x / (float)(columns - 1), v = (float)y / (float)(rows - 1);
            float z = scale * height_at(&t, x, y, columns, rows);
            mesh->p[i] = v3(2.0f * u - 1.0f, 2.0f * v - 1.0f, isfinite(z) ? z : 0.0f);
            mesh->uv[i] = v2(u, 1.0f - v);
            if (x + 1 == columns || y + 1 == rows) continue;
            uint32_t(*to)[3] = &mesh->triangles[2 * (y * (columns - 1) + x)];
            to[0][0] = i, to[0][1] = i + 1, to[0][2] = i + columns + 1;
            to[1][0] = i, to[1][1] = i + columns + 1, to[1][2] = i + columns;
        }
    return true;
}
