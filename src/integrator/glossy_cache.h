// SPDX-License-Identifier: Apache-2.0
// Which glossy light is cached: the tables of lobes, and the basis that a surface's records are in.
#ifndef SHEEN_INTEGRATOR_GLOSSY_CACHE_H
#define SHEEN_INTEGRATOR_GLOSSY_CACHE_H

#include "basis/rotation.h"
#include "integrator/glossy.h"

/** Immutable; what all points of a picture share. */
typedef struct SheenGlossyCache SheenGlossyCache;

/**
 * Tabulates the scene's lobes by work->options.
 * @param out  owned by the caller; borrows the scene. NULL where no lobe of the scene can be represented
 * Errors: SHEEN_ERR_INVALID, SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_glossy_cache_create(const SheenWork *work, SheenGlossyCache **out);
void sheen_glossy_cache_destroy(SheenGlossyCache **glossy);

/** The order of the records that the lobes are read with. */
unsigned sheen_glossy_cache_order(const SheenGlossyCache *glossy);

/** What harmonics hold of a surface's lobes. */
typedef struct GlossyLobe {
    SheenBasis basis;
    unsigned order;                    // 0: nothing
    Rgb coefficients[SHEEN_BASIS_MAX]; // [order * order]
} GlossyLobe;

/** Reads the lobes of a surface, in the frames of sheen_lobe_table_read, and leaves in v->rest what they do not hold.
 */
void sheen_glossy_cache_read(const SheenGlossyCache *glossy, SeenSurface *v, GlossyLobe *out);

/** Turns what was read to the frames of RadianceLobe: spherical harmonics to the world's, hemispherical ones to
 *  frame_from_normal of the shading normal on the viewer's side. */
void sheen_glossy_cache_orient(const SheenGlossyCache *glossy, const SeenSurface *v, GlossyLobe *lobe);

#endif
