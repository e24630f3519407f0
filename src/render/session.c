// SPDX-License-Identifier: Apache-2.0
#include "render/session.h"

#include "base/clock.h"
#include "image/image.h"

#include <stdlib.h>

struct SheenSession {
    SheenWork work; // without a view
    SheenLights *lights;
    SheenAccel *accel;
    SheenCached *cached; // NULL with the path integrator
};

static SheenStatus build(const SheenSessionDesc *d, SheenSession *s)
{
    // The cached integrators find what is soft of an environment with the rays of their gathers.
    bool path = d->integrator == SHEEN_INTEGRATOR_PATH;
    SheenEnvironmentSplit sampled = path ? SHEEN_ENVIRONMENT_WHOLE : SHEEN_ENVIRONMENT_HARD;
    SheenStatus status = sheen_lights_create(d->scene, sampled, d->log, &s->lights);
    if (status == SHEEN_OK) status = sheen_accel_create(d->scene, d->pool, d->log, &s->accel);
    return status;
}

SheenStatus sheen_session_create(const SheenSessionDesc *d, SheenStats *stats, double *seconds, SheenSession **out)
{
    *out = NULL;
    double start = sheen_clock_seconds();
    SheenSession *s = calloc(1, sizeof *s);
    if (!s) return sheen_fail(d->log, SHEEN_ERR_NOMEM, "%s: out of memory", d->scene->name);
    progress_report(d->progress, "build", 0.0, 0);
    SheenStatus status = build(d, s);
    *seconds = sheen_clock_seconds() - start;
    s->work = (SheenWork){.scene = d->scene,
                          .accel = s->accel,
                          .lights = s->lights,
                          .options = d->options,
                          .pool = d->pool,
                          .cancel = d->cancel,
                          .progress = d->progress,
                          .log = d->log};
    if (status == SHEEN_OK && d->integrator != SHEEN_INTEGRATOR_PATH)
        status = sheen_cached_create(&s->work, d->integrator == SHEEN_INTEGRATOR_RADIANCE, stats, &s->cached);
    if (status == SHEEN_ERR_NOMEM) sheen_fail(d->log, status, "%s: out of memory", d->scene->name);
    if (status != SHEEN_OK) sheen_session_destroy(&s);
    *out = s;
    return status;
}

void sheen_session_destroy(SheenSession **session)
{
    SheenSession *s = session ? *session : NULL;
    if (!s) return;
    sheen_cached_destroy(&s->cached);
    sheen_accel_destroy(&s->accel);
    sheen_lights_destroy(&s->lights);
    free(s);
    *session = NULL;
}

SheenCaches *sheen_session_caches(SheenSession *s)
{
    return s->cached ? sheen_cached_caches(s->cached) : NULL;
}

void sheen_session_adopt(SheenSession *s)
{
    if (s->cached) sheen_cached_adopt(s->cached);
}

/** A shot with its settings resolved. */
typedef struct Aim {
    SheenView view;
    SheenPixelFilter filter; // that the view borrows
} Aim;

static SheenStatus aim_at(const SheenSession *s, const SheenShot *shot, Aim *out)
{
    const SheenCamera *camera = shot->camera;
    uint32_t width = shot->width ? shot->width : camera->width;
    uint32_t height = shot->height ? shot->height : camera->height;
    if (width == 0 || height == 0 || width > SHEEN_IMAGE_MAX_SIDE || height > SHEEN_IMAGE_MAX_SIDE ||
        (uint64_t)width * height > SHEEN_IMAGE_MAX_PIXELS)
        return sheen_fail(s->work.log, SHEEN_ERR_INVALID,
                          "%s: a picture of %u x %u pixels is out of range (1 x 1 to %d a side, %llu in all)",
                          s->work.scene->name, width, height, SHEEN_IMAGE_MAX_SIDE,
                          (unsigned long long)SHEEN_IMAGE_MAX_PIXELS);
    sheen_pixel_filter_init(shot->filter.kind ? &shot->filter : &camera->filter, &out->filter);
    out->view = (SheenView){camera, width, height, &out->filter};
    return SHEEN_OK;
}

static SheenStatus report(const SheenSession *s, SheenStatus status)
{
    if (status == SHEEN_ERR_NOMEM) sheen_fail(s->work.log, status, "%s: out of memory", s->work.scene->name);
    return status;
}

SheenStatus sheen_session_look(SheenSession *s, const SheenShot *shot, SheenStats *stats)
{
    Aim aim;
    SheenStatus status = aim_at(s, shot, &aim);
    if (status != SHEEN_OK || !s->cached) return status;
    return report(s, sheen_cached_look(s->cached, &aim.view, stats));
}

SheenStatus sheen_session_fill(SheenSession *s, const SheenShot *shot, SheenStats *stats)
{
    Aim aim;
    SheenStatus status = aim_at(s, shot, &aim);
    if (status != SHEEN_OK || !s->cached) return status;
    return report(s, sheen_cached_fill(s->cached, &aim.view, stats));
}

SheenStatus sheen_session_settle(SheenSession *s, SheenStats *stats)
{
    return s->cached ? report(s, sheen_cached_settle(s->cached, stats)) : SHEEN_OK;
}

SheenStatus sheen_session_shade(SheenSession *s, const SheenShot *shot, unsigned aovs, SheenFilm **film,
                                SheenStats *stats)
{
    Aim aim;
    *film = NULL;
    SheenStatus status = aim_at(s, shot, &aim);
    if (status != SHEEN_OK) return status;
    SheenWork work = sheen_work_for(&s->work, &aim.view);
    status = sheen_film_create(aim.view.width, aim.view.height, aovs, film);
    if (status == SHEEN_OK)
        status =
            s->cached ? sheen_cached_shade(s->cached, &aim.view, *film, stats) : sheen_path_render(&work, *film, stats);
    if (status != SHEEN_OK) sheen_film_destroy(film);
    return report(s, status);
}
