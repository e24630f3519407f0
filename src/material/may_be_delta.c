// SPDX-License-Identifier: Apache-2.0
#include "material/bsdf.h"
#include "scene/passage.h"

bool sheen_material_may_be_delta(const SheenScene *scene, uint32_t material)
{
    const SheenMaterial *m = &scene->materials[material];
    switch (m->kind) {
    case SHEEN_MATERIAL_DIFFUSE:
    case SHEEN_MATERIAL_ROUGH_DIFFUSE:
    case SHEEN_MATERIAL_PLASTIC:
    case SHEEN_MATERIAL_ROUGH_PLASTIC:
    case SHEEN_MATERIAL_DIFFUSE_TRANSMIT:
    case SHEEN_MATERIAL_PHONG:
    case SHEEN_MATERIAL_WARD:
    case SHEEN_MATERIAL_LAFORTUNE:
        return false;
    case SHEEN_MATERIAL_BLEND:
    case SHEEN_MATERIAL_SIDES:
        return sheen_material_may_be_delta(scene, m->nested[0]) || sheen_material_may_be_delta(scene, m->nested[1]);
    case SHEEN_MATERIAL_MASK:
        return sheen_material_may_be_delta(scene, m->nested[0]);
    case SHEEN_MATERIAL_BUMP:
    case SHEEN_MATERIAL_NORMAL:
    case SHEEN_MATERIAL_COATING:
    case SHEEN_MATERIAL_ROUGH_COATING: // shadow rays do not pass the holes below them
        return sheen_material_is_pierced(scene->materials, m->nested[0]) ||
               sheen_material_may_be_delta(scene, m->nested[0]);
    default:
        return true;
    }
}
