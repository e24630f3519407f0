// SPDX-License-Identifier: Apache-2.0
#include "render/render.h"

#include "base/clock.h"
#include "image/image.h"

typedef struct Integrator {
    SheenStatus (*render)(const SheenWork *work, SheenFilm *film, SheenStats *stats);
    SheenEnvironmentSplit environment; // the part of the sky that is sampled as a light
} Integrator;

static const Integrator integrators[] = {
    [SHEEN_INTEGRATOR_RADIANCE] = {sheen_radiance_render, SHEEN_ENVIRONMENT_HARD},
    [SHEEN_INTEGRATOR_IRRADIANCE] = {sheen_irradiance_render, SHEEN_ENVIRONMENT_HARD},
    [SHEEN_INTEGRATOR_PATH] = {sheen_path_render, SHEEN_ENVIRONMENT_WHOLE},
};

SheenStatus sheen_render(const SheenScene *scene, const SheenRenderSettings *settings, SheenPool *pool,
                         const atomic_bool *cancel, const SheenProgress *progress, const SheenLog *log,
                         SheenFilm **film, SheenStats *stats, SheenRenderTimes *times)
{
    double start = sheen_clock_seconds();
    *film = NULL;
    *stats = (SheenStats){0};
    *times = (SheenRenderTimes){0};
    if (!settings->view && settings->camera >= scene->n_cameras)
        return sheen_fail(log, SHEEN_ERR_INVALID, "camera %u: the scene has %u", settings->camera, scene->n_cameras);
    const SheenCamera *camera = settings->view ? settings->view : &scene->cameras[settings->camera];
    uint32_t width = settings->width ? settings->width : camera->width;
    uint32_t height = settings->height ? settings->height : camera->height;
    if (width == 0 || height == 0 || width > SHEEN_IMAGE_MAX_SIDE || height > SHEEN_IMAGE_MAX_SIDE ||
        (uint64_t)width * height > SHEEN_IMAGE_MAX_PIXELS)
        return sheen_fail(log, SHEEN_ERR_INVALID,
                          "%s: a picture of %u x %u pixels is out of range (1 x 1 to %d a side, %llu in all)",
                          scene->name, width, height, SHEEN_IMAGE_MAX_SIDE, (unsigned long long)SHEEN_IMAGE_MAX_PIXELS);

    // The cached integrators find what is soft of an environment with the rays of their gathers.
    const Integrator *integrator = &integrators[settings->integrator];
    SheenEnvironmentSplit split = integrator->environment;
    SheenPixelFilter filter;
    sheen_pixel_filter_init(settings->filter.kind ? &settings->filter : &camera->filter, &filter);
    SheenLights *lights = NULL;
    SheenAccel *accel = NULL;
    progress_report(progress, "build", 0.0, 0);
    SheenStatus status = sheen_film_create(width, height, settings->aovs, film);
    if (status == SHEEN_OK) status = sheen_lights_create(scene, split, log, &lights);
    if (status == SHEEN_OK) status = sheen_accel_create(scene, pool, log, &accel);
    times->build = sheen_clock_seconds() - start;
    if (status == SHEEN_OK) {
        SheenWork work = {.scene = scene,
                          .accel = accel,
                          .lights = lights,
                          .camera = camera,
                          .width = width,
                          .height = height,
                          .filter = &filter,
                          .options = settings->options,
                          .pool = pool,
                          .cancel = cancel,
                          .progress = progress,
                          .log = log};
        status = integrator->render(&work, *film, stats);
    }
    sheen_accel_destroy(&accel);
    sheen_lights_destroy(&lights);
    if (status != SHEEN_OK) sheen_film_destroy(film);
    if (status == SHEEN_ERR_NOMEM) sheen_fail(log, status, "%s: out of memory", scene->name);
    times->total = sheen_clock_seconds() - start;
    return status;
}
