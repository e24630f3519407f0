// SPDX-License-Identifier: Apache-2.0
// Collects shapes, materials, lights and cameras, checks them, and hands out the immutable scene.
#ifndef SHEEN_SCENE_BUILDER_H
#define SHEEN_SCENE_BUILDER_H

#include "base/arena.h"
#include "base/log.h"
#include "scene/scene.h"

typedef struct SheenBuilder SheenBuilder;

/**
 * @param log   receives warnings and errors; borrowed until commit or destroy
 * @param name  the scene's name, copied
 */
SHEEN_NODISCARD SheenStatus sheen_builder_create(const SheenLog *log, const char *name, SheenBuilder **out);

/** Frees a builder that was not committed and sets *builder to NULL. NULL-safe. */
void sheen_builder_destroy(SheenBuilder **builder);

/** @return the arena of the scene to be: arrays that the add functions take must live in it. */
SheenArena *sheen_builder_arena(SheenBuilder *builder);

// Each add function copies the struct (not the arrays it points to) and returns its index, or SHEEN_NONE when out of
// memory; the failure is remembered and returned by sheen_builder_commit, so that callers need not check each call.

/**
 * Checks and completes a material, see scene/material_check.h. `material->nested` are indices of earlier ones, others
 * are the caller's mistake.
 */
uint32_t sheen_builder_add_material(SheenBuilder *builder, const SheenMaterial *material);
/** @return a material that was added, valid until the next is added; NULL for SHEEN_NONE. */
const SheenMaterial *sheen_builder_material(const SheenBuilder *builder, uint32_t index);
/** The shape joins the open group, or the world when none is open. `shape->light` is ignored. */
uint32_t sheen_builder_add_shape(SheenBuilder *builder, const SheenShape *shape);
/** Makes `shape`, in the world group, emit `radiance` from its front side. */
uint32_t sheen_builder_add_area_light(SheenBuilder *builder, uint32_t shape, Rgb radiance);
/** The same with a radiance that varies over the shape's uv; below zero it counts as zero. `radiance` is copied. */
uint32_t sheen_builder_add_textured_area_light(SheenBuilder *builder, uint32_t shape, const SheenTexture *radiance);
/** Any light but an area light. A second environment light replaces the first, with a warning. */
uint32_t sheen_builder_add_light(SheenBuilder *builder, const SheenLight *light);
uint32_t sheen_builder_add_camera(SheenBuilder *builder, const SheenCamera *camera);
/** Of a format that knows no cameras: one that sees the whole scene is no cause for a warning. */
void sheen_builder_expect_no_camera(SheenBuilder *builder);
/** Opens a group: shapes added until sheen_builder_end_group belong to it and are seen only through instances. */
uint32_t sheen_builder_begin_group(SheenBuilder *builder);
void sheen_builder_end_group(SheenBuilder *builder);
/** Places a closed group. SHEEN_NONE, with a warning, when the transform is singular. */
uint32_t sheen_builder_add_instance(SheenBuilder *builder, uint32_t group, const Transform *to_world);

/**
 * Checks and completes the scene: drops triangles with non-finite vertices or no area (one warning a shape, with their
 * number), replaces shading normals that are not finite or zero by face normals, drops shapes without anything left,
 * negative or non-finite radiance (a warning), adds a camera that sees the whole scene when there is none (a warning
 * where one was expected),
 * warns when there is no light, and computes the bounds.
 *
 * @param out  owned by the caller; *builder becomes NULL in every case
 * Errors: SHEEN_ERR_NOMEM; SHEEN_ERR_INVALID for an index out of range (the caller's mistake).
 */
SHEEN_NODISCARD SheenStatus sheen_builder_commit(SheenBuilder **builder, SheenScene **out);

#endif
