// SPDX-License-Identifier: Apache-2.0
// Holes: where light passes a surface as if nothing was there, found without a BSDF, since shadow rays ask for it.
#ifndef SHEEN_SCENE_PASSAGE_H
#define SHEEN_SCENE_PASSAGE_H

#include "scene/scene.h"

/** A path goes straight on through so many surfaces at most: a bound against numbers that go wrong, not on foliage. */
enum { SHEEN_PASSAGES_MAX = 1024 };

/** @return true when light may pass the material somewhere: of masks, but not below a map or a coating, which bend. */
bool sheen_material_is_pierced(const SheenMaterial materials[], uint32_t index);

/**
 * @param uv     texture coordinates
 * @param front  whether the surface is seen from its front
 * @return the share of light that goes straight on, [0, 1]: the factor of the BSDF's lobes of passage
 *         (BsdfSample.passage) in the same direction. Pure, thread-safe.
 */
float sheen_material_passage(const SheenMaterial materials[], uint32_t index, Vec2 uv, bool front);

#endif
