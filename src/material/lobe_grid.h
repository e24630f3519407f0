// SPDX-License-Identifier: Apache-2.0
// Where the tables of lobes have their nodes, and which of them a reading weighs. Included by src/material only.
#ifndef SHEEN_MATERIAL_LOBE_GRID_H
#define SHEEN_MATERIAL_LOBE_GRID_H

#include "material/lobe_project.h"

/**
 * Outgoing directions of a table by the parabolic map, p = (x, y) / (1 + z): of an isotropic lobe along one radius, of
 * others over a quarter of the disk, the rest being mirrored. Even steps from 0 to LOBE_RADIUS.
 */
#define LOBE_RADIUS 0.985f // cos(theta_o) = 0.015: beyond, lobes may grow without bound

/** A table. */
typedef struct LobeTable {
    LobeFamily family;
    LobeNode node;
    unsigned last;             // steps of the radius
    unsigned n_nodes;          // of a level
    unsigned n_levels;         // of roughness, the largest first; 0 where no order will do
    float log_alpha, log_step; // logarithm of the first level's roughness, and how much less it is at the next
    float *data[2];            // [n_levels][n_nodes][node.size] of each basis
    unsigned order[2];         // the largest that a reading may have, of each basis
} LobeTable;

/** The share of the error up to which a lobe is represented that is taken where the orders allow it. What an order
 * misses of a lobe is not only blur: it rings, and beside a bright thing the ringing is brighter than what is there. On
 * the wall of a box 5 % of missing energy leave an RMSE of 17 %, 0.5 % one of 9. */
#define LOBE_FINE 0.1f

struct SheenLobeTables {
    const SheenScene *scene;
    unsigned n; // n_max
    float error;
    unsigned order; // the largest of all tables
    LobeTable *tables;
    uint32_t n_tables;
    uint32_t (*slots)[LOBE_SLOTS_MAX]; // [scene->n_materials] table of a lobe, counted from 1; 0 for none
    bool *has;                         // [scene->n_materials] sheen_lobe_tables_has
};

/** The roughness of a level. @param alpha  [2] out, along x and y */
void sheen_lobe_level(const LobeTable *t, unsigned level, float alpha[2]);

/** The outgoing direction of a node. */
Vec3 sheen_lobe_node_direction(const LobeTable *t, unsigned node);

/** Nodes of a table with their weights: for functions that are even or odd in x and y. */
enum { LOBE_TAPS = 2 * 16 };
typedef struct LobeTaps {
    unsigned n;
    unsigned node[LOBE_TAPS];   // level * n_nodes + node
    float weight[4][LOBE_TAPS]; // of coefficients, number odd in x + 2 * odd in y: cubic
    float linear[LOBE_TAPS];    // of energies, which stay positive with it
    float fade;                 // 1, and toward the borders of the table down to 0
} LobeTaps;

/**
 * @param wo     of the lobe, z > 0, x and y >= 0; y = 0 for an isotropic one
 * @param alpha  its roughness along x
 */
void sheen_lobe_taps(const LobeTable *t, Vec3 wo, float alpha, LobeTaps *out);

#endif
