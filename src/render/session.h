// SPDX-License-Identifier: Apache-2.0
// A scene made ready to be rendered from many views: what outlives a picture.
#ifndef SHEEN_RENDER_SESSION_H
#define SHEEN_RENDER_SESSION_H

#include "film/film.h"
#include "integrator/cached.h"

typedef enum SheenIntegrator {
    SHEEN_INTEGRATOR_RADIANCE,
    SHEEN_INTEGRATOR_IRRADIANCE,
    SHEEN_INTEGRATOR_PATH
} SheenIntegrator;

typedef struct SheenSession SheenSession;

/** What a session needs; all is borrowed until it ends. */
typedef struct SheenSessionDesc {
    const SheenScene *scene;
    SheenIntegrator integrator;
    SheenOptions options;
    SheenPool *pool;
    const atomic_bool *cancel; // may be NULL
    const SheenProgress *progress;
    const SheenLog *log;
} SheenSessionDesc;

/**
 * Builds the acceleration structure, the lights and the tables.
 * @param build    out: seconds
 * @param session  owned by the caller, NULL on failure
 * Errors: SHEEN_ERR_INVALID, SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_session_create(const SheenSessionDesc *desc, SheenStats *stats, double *build,
                                                 SheenSession **session);
void sheen_session_destroy(SheenSession **session);

/** One picture: a camera, one of the scene's or the caller's own, and what of its settings is replaced. */
typedef struct SheenShot {
    const SheenCamera *camera;
    uint32_t width, height; // 0: the camera's
    SheenFilter filter;     // SHEEN_FILTER_UNSET: the camera's
} SheenShot;

/**
 * The passes of the cached integrators, see sheen_cached_look, sheen_cached_fill and sheen_cached_settle; nothing with
 * the path integrator. First all shots are looked at, then those are filled whose light is to be kept.
 * Errors: SHEEN_ERR_INVALID for a size out of range, SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_session_look(SheenSession *session, const SheenShot *shot, SheenStats *stats);
SHEEN_NODISCARD SheenStatus sheen_session_fill(SheenSession *session, const SheenShot *shot, SheenStats *stats);
SHEEN_NODISCARD SheenStatus sheen_session_settle(SheenSession *session, SheenStats *stats);

/**
 * Renders a picture from the settled records; see sheen_cached_shade.
 * @param aovs  bit 1 << SheenAov
 * @param film  owned by the caller, NULL on failure
 * Errors: SHEEN_ERR_INVALID for a size out of range, SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED.
 */
SHEEN_NODISCARD SheenStatus sheen_session_shade(SheenSession *session, const SheenShot *shot, unsigned aovs,
                                                SheenFilm **film, SheenStats *stats);

/** The session's records, to be written or to be added to before anything is filled; NULL with the path integrator.
 *  After records were added to, sheen_session_adopt tells that they are settled already. */
SheenCaches *sheen_session_caches(SheenSession *session);
void sheen_session_adopt(SheenSession *session);

#endif
