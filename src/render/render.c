// SPDX-License-Identifier: Apache-2.0
#include "render/render.h"

#include "base/clock.h"

// Fills and shades one picture.
static SheenStatus render(SheenSession *session, const SheenShot *shot, unsigned aovs, SheenFilm **film,
                          SheenStats *stats)
{
    SheenStatus status = sheen_session_look(session, shot, stats);
    if (status == SHEEN_OK) status = sheen_session_fill(session, shot, stats);
    if (status == SHEEN_OK) status = sheen_session_settle(session, stats);
    if (status == SHEEN_OK) status = sheen_session_shade(session, shot, aovs, film, stats);
    return status;
}

SheenStatus sheen_render(const SheenScene *scene, const SheenRenderSettings *settings, SheenPool *pool,
                         const atomic_bool *cancel, const SheenProgress *progress, const SheenLog *log,
                         SheenFilm **film, SheenStats *stats, SheenRenderTimes *times)
{
    double start = sheen_clock_seconds();
    *film = NULL;
    *stats = (SheenStats){0};
    *times = (SheenRenderTimes){0};
    if (!settings->camera && scene->n_cameras == 0)
        return sheen_fail(log, SHEEN_ERR_INVALID, "%s: the scene has no camera", scene->name);
    SheenSessionDesc desc = {scene, settings->integrator, settings->options, pool, cancel, progress, log};
    const SheenCamera *camera = settings->camera ? settings->camera : &scene->cameras[0];
    SheenShot shot = {camera, settings->width, settings->height, settings->filter};
    SheenSession *session = NULL;
    SheenStatus status = sheen_session_create(&desc, stats, &times->build, &session);
    if (status == SHEEN_OK) status = render(session, &shot, settings->aovs, film, stats);
    sheen_session_destroy(&session);
    times->total = sheen_clock_seconds() - start;
    return status;
}
