// SPDX-License-Identifier: Apache-2.0
// A glossy lobe as a sum of fixed shapes: f cos(theta_i) = sum_k a_k s_k(wo, wi), where textured colours are in the
// factors a_k, and the shapes depend on nothing that varies but one roughness. Included by src/material only.
#ifndef SHEEN_MATERIAL_LOBE_SHAPE_H
#define SHEEN_MATERIAL_LOBE_SHAPE_H

#include "material/bsdf_ops.h"

enum { LOBE_SHAPES_MAX = 3, LOBE_SLOTS_MAX = SHEEN_BSDF_MAX_LOBES };

/** What the shapes of a lobe depend on: equal bytes, equal shapes. */
typedef struct LobeKey {
    const BsdfOps *ops;
    uint32_t shapes;      // of a principled lobe: bits of those that are not always zero
    uint32_t anisotropic; // the shape changes when both directions are turned about z
    uint32_t varies;      // the roughness is textured: it lies in [alpha_lo, alpha_hi], alike for both axes
    uint32_t distribution, ward;
    float alpha_lo[2], alpha_hi[2]; // along x and y; not of Phong's and Lafortune's lobes
    float ior, exponent, c[3], eta[3], k[3];
} LobeKey;

/** A lobe that may be tabulated. */
typedef struct LobeFamily {
    LobeKey key;
    const SheenMaterial *material; // one of those that have it
    SheenLafortune lafortune;      // of such a lobe, white
    unsigned n_shapes;
} LobeFamily;

/** @return the number of glossy reflecting lobes that a material without nested ones has: its slots. */
unsigned sheen_lobe_slots(const SheenMaterial *m);

/** @return false when the lobe cannot be written that way: too much of it is textured, or it transmits. */
bool sheen_lobe_family(const SheenMaterial *m, unsigned slot, LobeFamily *out);

/** @return the slot of a lobe that was looked up, or LOBE_SLOTS_MAX when it is no glossy reflection. */
unsigned sheen_lobe_slot(const BsdfLobe *lobe);

/** A lobe of the family with a roughness for each axis. It borrows from *family. */
BsdfLobe sheen_lobe_prototype(const LobeFamily *family, const float alpha[2]);

/** The shapes at a pair of directions. @param s  [family->n_shapes] out: 1/sr, finite */
void sheen_lobe_shapes(const LobeFamily *family, const BsdfLobe *prototype, Vec3 wo, Vec3 wi, float s[]);

/** The factors of a lobe that was looked up, its weight not among them. @param a  [family->n_shapes] out */
void sheen_lobe_factors(const LobeFamily *family, const BsdfLobe *lobe, Rgb a[]);

#endif
