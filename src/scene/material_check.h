// SPDX-License-Identifier: Apache-2.0
// What a material must hold before it is shaded.
#ifndef SHEEN_SCENE_MATERIAL_CHECK_H
#define SHEEN_SCENE_MATERIAL_CHECK_H

#include "base/arena.h"
#include "base/log.h"
#include "scene/scene.h"

/**
 * Makes a material fit for shading: numbers out of range are clamped with a warning (bitmaps are clamped in shading),
 * a material of too many parts becomes its first nested one with a warning, two_sided is taken from what transmits, and
 * the fields that the builder owes are filled in.
 * @param scene     name for messages
 * @param arena     for tables
 * @param earlier   [n] materials that m->nested may refer to
 * Errors: SHEEN_ERR_INVALID when m->nested refers elsewhere; SHEEN_ERR_NOMEM.
 */
SHEEN_NODISCARD SheenStatus sheen_material_complete(const SheenLog *log, const char *scene, SheenArena *arena,
                                                    const SheenMaterial earlier[], uint32_t n, SheenMaterial *m);

#endif
