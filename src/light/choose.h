// SPDX-License-Identifier: Apache-2.0
// Estimates of how much each light contributes at a point, cheap enough for every shading point.
#ifndef SHEEN_LIGHT_CHOOSE_H
#define SHEEN_LIGHT_CHOOSE_H

#include "light/source.h"

/** The lights as structures of arrays, in the order of the sources. */
typedef struct ChooseTable ChooseTable;

/** @param sources  [n] in the order of their kinds; borrowed */
SHEEN_NODISCARD SheenStatus sheen_choose_table_init(const Source sources[], uint32_t n, SheenArena *arena,
                                                    ChooseTable **out);

/** As sheen_lights_choose and sheen_lights_choose_probability. */
float sheen_choose_table_pick(const ChooseTable *t, Vec3 p, Vec3 n, float *u, uint32_t *light);
float sheen_choose_table_probability(const ChooseTable *t, Vec3 p, Vec3 n, uint32_t light);

#endif
