// SPDX-License-Identifier: Apache-2.0
// The choice of one light among all, in proportion to estimates.
#ifndef SHEEN_LIGHT_CHOOSE_H
#define SHEEN_LIGHT_CHOOSE_H

#include "light/unshadowed.h"

/** More lights than these are refused: in all, and those without a place (directional lights, the environment). */
#define CHOOSE_MAX (1u << 20)
#define CHOOSE_INFINITE_MAX 256u

typedef struct Chooser {
    EstimateTable table;
    uint32_t n;
    // Many lights are chosen in two steps, a group of neighbours first. Groups are runs of `group_size` sources; the
    // last sources, those without a place, stand for themselves among the groups.
    uint32_t n_placed, n_groups, group_size; // no groups for few lights
    Bodies groups;
} Chooser;

/** @param sources  [n], n <= CHOOSE_MAX, in the order of their kinds, neighbours together; borrowed
 *  @return false when out of memory */
bool sheen_chooser_init(const Source sources[], uint32_t n, SheenArena *arena, Chooser *out);

/** As sheen_lights_choose and sheen_lights_choose_probability. */
float sheen_chooser_pick(const Chooser *c, Vec3 p, Vec3 n, float *u, uint32_t *light);
float sheen_chooser_probability(const Chooser *c, Vec3 p, Vec3 n, uint32_t light);

#endif
