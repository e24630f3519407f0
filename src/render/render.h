// SPDX-License-Identifier: Apache-2.0
// One image from a scene: the driver behind `sheen render`.
#ifndef SHEEN_RENDER_RENDER_H
#define SHEEN_RENDER_RENDER_H

#include "render/session.h"

typedef struct SheenRenderSettings {
    SheenIntegrator integrator;
    const SheenCamera *camera; // borrowed; NULL: the scene's first
    uint32_t width, height;    // 0: the camera's
    unsigned aovs;             // bit 1 << SheenAov
    SheenFilter filter;        // SHEEN_FILTER_UNSET: the camera's
    SheenOptions options;
} SheenRenderSettings;

/** Seconds of the driver's own stages beside SheenStats. */
typedef struct SheenRenderTimes {
    double build, total;
} SheenRenderTimes;

/**
 * Builds the acceleration structure, renders, returns the film.
 * @param film  owned by the caller, NULL on failure
 * Errors: SHEEN_ERR_INVALID for a scene without a camera and a size out of range, SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_render(const SheenScene *scene, const SheenRenderSettings *settings, SheenPool *pool,
                                         const atomic_bool *cancel, const SheenProgress *progress, const SheenLog *log,
                                         SheenFilm **film, SheenStats *stats, SheenRenderTimes *times);

#endif
