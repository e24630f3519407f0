// SPDX-License-Identifier: Apache-2.0
#include "scene/passage.h"

static float number_at(const SheenTexture *t, Vec2 uv)
{
    return unit_or_zero(rgb_luminance(sheen_texture_eval(t, uv)));
}

static bool is_opaque(const SheenTexture *opacity)
{
    return opacity->kind == SHEEN_TEXTURE_CONSTANT && rgb_luminance(opacity->value) >= 1.0f;
}

bool sheen_material_is_pierced(const SheenMaterial materials[], uint32_t index)
{
    const SheenMaterial *m = &materials[index];
    switch (m->kind) {
    case SHEEN_MATERIAL_MASK:
        return !is_opaque(&m->weight) || sheen_material_is_pierced(materials, m->nested[0]);
    case SHEEN_MATERIAL_BLEND:
    case SHEEN_MATERIAL_SIDES:
        return sheen_material_is_pierced(materials, m->nested[0]) || sheen_material_is_pierced(materials, m->nested[1]);
    default:
        return false;
    }
}

float sheen_material_passage(const SheenMaterial materials[], uint32_t index, Vec2 uv, bool front)
{
    const SheenMaterial *m = &materials[index];
    front = front || m->two_sided;
    switch (m->kind) {
    case SHEEN_MATERIAL_MASK: {
        float opacity = number_at(&m->weight, uv);
        if (opacity == 0.0f) return 1.0f;
        return 1.0f - opacity + opacity * sheen_material_passage(materials, m->nested[0], uv, front);
    }
    case SHEEN_MATERIAL_BLEND: {
        float a = sheen_material_passage(materials, m->nested[0], uv, front);
        float b = sheen_material_passage(materials, m->nested[1], uv, front);
        return a == b ? a : lerpf(a, b, number_at(&m->weight, uv));
    }
    case SHEEN_MATERIAL_SIDES:
        return sheen_material_passage(materials, m->nested[front ? 0 : 1], uv, front);
    default:
        return 0.0f;
    }
}
