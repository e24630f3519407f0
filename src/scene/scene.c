// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.h"

#include "base/arena.h"

#include <stddef.h>

void sheen_scene_destroy(SheenScene **scene)
{
    if (!scene || !*scene) return;
    SheenArena *arena = (*scene)->arena; // owns the scene struct itself as well
    sheen_arena_destroy(&arena);
    *scene = NULL;
}
