// SPDX-License-Identifier: Apache-2.0
// Glossy lobes in harmonics: for each outgoing direction the coefficients of f(wo, .) cos(theta_i), and the order that
// they need. What no order represents well enough is left to importance sampling, without a boundary between.
//
// A lobe is represented when it is glossy, reflects only, and nothing but the other side or a turn about the normal
// stands around it. Source: krivanek2005-radiance-caching sec. 4.1
#ifndef SHEEN_MATERIAL_LOBE_TABLE_H
#define SHEEN_MATERIAL_LOBE_TABLE_H

#include "base/log.h"
#include "base/pool.h"
#include "basis/basis.h"
#include "material/bsdf.h"

/** Tables of all lobes of a scene's materials that can be represented. */
typedef struct SheenLobeTables SheenLobeTables;

/** All zero means the defaults. */
typedef struct SheenLobeTableDesc {
    unsigned order; // largest, 1 .. SHEEN_ORDER_MAX; 0 means 10
    float error;    // largest relative energy 1 - sum c^2 / ||f||^2 that may be missing, (0, 0.5]; 0 means 0.05
    size_t memory;  // bytes that the tables may take; 0 means 64 MB
} SheenLobeTableDesc;

/**
 * Tabulates the lobes. What is alike in several materials is tabulated once; lobes for which there is no room are
 * not represented, which is told as information.
 * @param scene   borrowed, must outlive the tables
 * @param pool    runs the work; the result does not depend on its size
 * @param cancel  may be NULL
 * @param out     owned by the caller
 * Errors: SHEEN_ERR_INVALID for numbers out of range, SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_lobe_tables_create(const SheenLog *log, const SheenScene *scene,
                                                     const SheenLobeTableDesc *desc, SheenPool *pool,
                                                     const atomic_bool *cancel, SheenLobeTables **out);

/** NULL-safe; sets *tables to NULL. */
void sheen_lobe_tables_destroy(SheenLobeTables **tables);

/** @return the largest order that a reading may have: what a record of incident radiance must hold; 0 when no lobe of
 *          the scene is represented, or for NULL. */
unsigned sheen_lobe_tables_order(const SheenLobeTables *tables);

/** @return whether a lobe of the material, nested ones included, is represented for some direction. */
bool sheen_lobe_tables_has(const SheenLobeTables *tables, uint32_t material);

/** What was read of one BSDF. */
typedef struct LobeReading {
    unsigned order;                    // n: n * n coefficients; 0 when nothing is represented
    float share[SHEEN_BSDF_MAX_LOBES]; // of each lobe of the BSDF, how much of it the coefficients hold, [0, 1]
    float error;                       // the largest error of the lobes represented, before the shares
} LobeReading;

/**
 * The represented part of a BSDF toward wo: the sum over its lobes of share times f cos(theta_i), so that the light it
 * reflects is the dot product with the coefficients of the incident radiance. Its error is within the desc's; a lobe's
 * share is 1 where order n_max represents it with half of that error, and falls smoothly to 0 where it does not with
 * all of it. All vary continuously with wo and the textures, the order's last band included.
 *
 * Frames: SH are those of the local frame, that of wo_l. HSH are those of the hemisphere on the side of wo: seen from
 * behind, wo_l.z < 0, directions are mirrored, (x, y, -z).
 * @param tables        NULL: nothing is represented
 * @param coefficients  [order of the tables, squared] out; zero from out->order^2 on
 * Pure, thread-safe.
 */
void sheen_lobe_table_read(const SheenLobeTables *tables, SheenBasis basis, const Bsdf *bsdf, Vec3 wo_l,
                           Rgb coefficients[], LobeReading *out);

/** Leaves what a reading does not hold: eval, pdf and sample are then those of the rest. */
static inline void sheen_bsdf_leave_rest(Bsdf *bsdf, const LobeReading *reading)
{
    for (uint32_t i = 0; i < bsdf->n_lobes; ++i) bsdf->lobes[i].weight *= 1.0f - reading->share[i];
}

#endif
