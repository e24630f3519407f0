// SPDX-License-Identifier: Apache-2.0
// The harmonics of a lobe's shapes toward one outgoing direction, by quadrature. Included by src/material only.
#ifndef SHEEN_MATERIAL_LOBE_PROJECT_H
#define SHEEN_MATERIAL_LOBE_PROJECT_H

#include "basis/basis.h"
#include "material/lobe_shape.h"

/** Directions over the hemisphere and the basis functions there, for orders up to n. */
typedef struct LobeQuadrature LobeQuadrature;

/** @return owned by the caller, freed with free(); NULL when out of memory. */
LobeQuadrature *sheen_lobe_quadrature(unsigned n);

/**
 * How a node of a table is laid out, in floats: the coefficients of each shape, then for each order 0 .. n the energy
 * that is missing: for each pair i <= j of shapes <s_i, s_j> less the sum of the products of the coefficients. That of
 * order 0 is the energy itself.
 */
typedef struct LobeNode {
    unsigned n, n_shapes, n_pairs;
    bool isotropic;        // wo lies in the plane of x and z: only the terms of cos(m phi) are there, number
                           // basis_zenith_index(l, m); otherwise all, number basis_index(l, m)
    unsigned coefficients; // of a shape
    unsigned missing;      // where the energies begin
    unsigned size;
} LobeNode;

LobeNode sheen_lobe_node(unsigned n, const LobeFamily *family);

/** Number of a pair i <= j among the pairs of a node. */
static inline unsigned lobe_pair(const LobeNode *node, unsigned i, unsigned j)
{
    return i * node->n_shapes - i * (i + 1) / 2 + j;
}

/**
 * Fills a node.
 * @param wo   with y = 0 for an isotropic lobe
 * @param out  [2][node->size], for SHEEN_BASIS_HSH and SHEEN_BASIS_SH; SH of what is zero below the surface
 */
void sheen_lobe_project(const LobeQuadrature *q, const LobeNode *node, const LobeFamily *family,
                        const BsdfLobe *prototype, Vec3 wo, float *const out[2]);

#endif
