// SPDX-License-Identifier: Apache-2.0
#include "run.h"

#include "output.h"

#include "base/clock.h"
#include "io/load.h"

#include <stdlib.h>
#include <string.h>

void run_begin(Run *run, const char *scene_path)
{
    const RenderValues *v = run->values;
    run->scene_path = scene_path;
    run->show = progress_show_make(v->quiet ? PROGRESS_NONE : (ProgressMode)v->progress);
    run->report = (Report){.quiet = v->quiet, .verbose = v->verbose, .strict = v->scene.strict, .show = &run->show};
    run->log = report_log(&run->report);
    interrupt_end_early();
}

void run_end(Run *run)
{
    sheen_pool_destroy(&run->pool);
    sheen_scene_destroy(&run->scene);
}

int run_load(Run *run)
{
    if (run->report.failed) return CLI_WORLD; // by a warning under --strict
    const TextList *defines = &run->values->scene.defines;
    SheenStatus status =
        sheen_scene_load_with(run->scene_path, (SheenDefines){defines->items, defines->n}, &run->log, &run->scene);
    run->load = sheen_clock_seconds() - run->start;
    if (status == SHEEN_OK)
        sheen_info(&run->log, "%s: %u shapes, %llu triangles, %u lights", run->scene_path, run->scene->n_shapes,
                   (unsigned long long)run->scene->n_triangles, run->scene->n_lights);
    run->interrupted = interrupt_catch();
    return report_exit_code(&run->report, status, run->scene_path);
}

bool run_find_camera(const Run *run, const SheenCamera **camera)
{
    const char *wanted = run->values->camera;
    *camera = &run->scene->cameras[0];
    if (!wanted) return true;
    for (uint32_t i = 0; i < run->scene->n_cameras; ++i) {
        if (strcmp(run->scene->cameras[i].name, wanted) != 0) continue;
        *camera = &run->scene->cameras[i];
        return true;
    }
    if (strspn(wanted, "0123456789") == strlen(wanted) && strlen(wanted) < 10) {
        unsigned long index = strtoul(wanted, NULL, 10);
        *camera = &run->scene->cameras[index < run->scene->n_cameras ? index : 0];
        if (index < run->scene->n_cameras) return true;
    }
    cli_usage_error(run->command, "--camera: the scene has no camera '%s'; it has %u, the first is '%s'", wanted,
                    run->scene->n_cameras, run->scene->cameras[0].name);
    return false;
}

int run_start_threads(Run *run)
{
    if (sheen_pool_create(run->values->threads, &run->pool) == SHEEN_OK) return CLI_DONE;
    return cli_error("--threads: so many threads cannot be started on this machine");
}

bool run_is_interrupted(const Run *run)
{
    return run->interrupted && atomic_load(run->interrupted);
}

int run_exit_code(Run *run, SheenStatus status, const char *what)
{
    return status == SHEEN_ERR_CANCELLED ? CLI_INTERRUPTED : report_exit_code(&run->report, status, what);
}

int run_tell_interrupted(Run *run, const char *what)
{
    progress_show_clear(&run->show);
    cli_error("interrupted; %s", what);
    return CLI_INTERRUPTED;
}

void run_warn_nonfinite(const Run *run, uint64_t samples)
{
    if (samples == 0) return;
    sheen_warn(&run->log, "%s: %llu samples were not finite and were left out", run->scene_path,
               (unsigned long long)samples);
}

void run_warn_about_layers(const Run *run, bool exr)
{
    static const unsigned of_cache = 1u << SHEEN_AOV_RECORDS | 1u << SHEEN_AOV_ACCURACY | 1u << SHEEN_AOV_COVERAGE |
                                     1u << SHEEN_AOV_ERROR | 1u << SHEEN_AOV_TRANSPORT;
    const RenderValues *v = run->values;
    if (v->aovs & of_cache && v->integrator == SHEEN_INTEGRATOR_PATH)
        sheen_warn(&run->log, "--aov: the path integrator has no cache; the layers of the cache are black");
    if (v->aovs && !exr) sheen_warn(&run->log, "--aov: only .exr files have layers, and none is written");
}

bool run_check_files(const RenderValues *v)
{
    if (v->cache.out && !output_check(v->cache.out, false)) return false;
    return !v->stats || strcmp(v->stats, "-") == 0 || output_check(v->stats, true);
}
