// SPDX-License-Identifier: Apache-2.0
// One number for what a scene's light depends on, so that records kept in a file find their scene again.
#ifndef SHEEN_SCENE_SCENE_HASH_H
#define SHEEN_SCENE_SCENE_HASH_H

#include "scene/scene.h"

/**
 * Hash of the shapes, instances, materials, textures with their pixels, lights and environment, in their order; not of
 * cameras, names and files. Scenes that differ in one number differ in it but for one chance in 2^64. It is the same on
 * machines of the same byte order. Cost: each array once, some gigabytes a second; pure.
 */
uint64_t sheen_scene_hash(const SheenScene *scene);

#endif
