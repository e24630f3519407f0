// SPDX-License-Identifier: Apache-2.0
// `sheen render`: one picture of a scene file.
#include "cli.h"
#include "interrupt.h"
#include "output.h"
#include "progress.h"
#include "render_options.h"
#include "report.h"
#include "stats.h"

#include "base/clock.h"
#include "image/image.h"
#include "io/load.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/** A run of the command, from scene file to pictures. */
typedef struct Run {
    RenderValues values;
    const char *scene_path;
    const atomic_bool *interrupted;
    ProgressShow show;
    Report report;
    SheenLog log;
    SheenScene *scene;
    SheenPool *pool;
    SheenFilm *film;
    RunStats stats;
    double start;
} Run;

/** @return false after a message about a file that could not be written. */
static bool check_outputs(const RenderValues *v)
{
    for (size_t i = 0; i < v->outputs.n; ++i)
        if (!output_check(v->outputs.items[i], false)) return false;
    return !v->stats || strcmp(v->stats, "-") == 0 || output_check(v->stats, true);
}

/** Layers that would be lost or empty deserve a word. */
static void warn_about_layers(const Run *run)
{
    static const unsigned of_cache =
        1u << SHEEN_AOV_RECORDS | 1u << SHEEN_AOV_ACCURACY | 1u << SHEEN_AOV_COVERAGE | 1u << SHEEN_AOV_ERROR;
    const RenderValues *v = &run->values;
    if (v->aovs & of_cache && v->integrator == SHEEN_INTEGRATOR_PATH)
        sheen_warn(&run->log, "--aov: the path integrator has no cache; the layers of the cache are black");
    bool exr = false;
    for (size_t i = 0; i < v->outputs.n; ++i) {
        const char *dot = strrchr(v->outputs.items[i], '.');
        exr = exr || (dot && strcasecmp(dot, ".exr") == 0);
    }
    if (v->aovs && !exr) sheen_warn(&run->log, "--aov: only .exr files have layers, and none is written");
}

/** Finds --camera by name, then by index. @return false after a message about the command line. */
static bool find_camera(const Run *run, uint32_t *index)
{
    const char *wanted = run->values.camera;
    *index = 0;
    if (!wanted) return true;
    for (uint32_t i = 0; i < run->scene->n_cameras; ++i) {
        if (strcmp(run->scene->cameras[i].name, wanted) != 0) continue;
        *index = i;
        return true;
    }
    if (strspn(wanted, "0123456789") == strlen(wanted) && strlen(wanted) < 10) {
        *index = (uint32_t)strtoul(wanted, NULL, 10);
        if (*index < run->scene->n_cameras) return true;
    }
    cli_usage_error(&command_render, "--camera: the scene has no camera '%s'; it has %u, the first is '%s'", wanted,
                    run->scene->n_cameras, run->scene->cameras[0].name);
    return false;
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/** Writes the film to every output. @return the library's status. */
static SheenStatus write_pictures(const Run *run)
{
    const SheenFilm *film = run->film;
    const RenderValues *v = &run->values;
    json_t *options = render_values_json(v);
    char *options_text = options ? json_dumps(options, JSON_COMPACT | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(options);
    if (!options_text) return SHEEN_ERR_NOMEM;

    // Nothing here may differ between two runs that must give the same file: no times, no threads, no folders.
    char seed[16];
    snprintf(seed, sizeof seed, "%u", v->seed);
    SheenAttribute attributes[] = {
        {"sheen.version", SHEEN_VERSION},
        {"sheen.scene", base_name(run->scene_path)},
        {"sheen.seed", seed},
        {"sheen.options", options_text},
    };
    SheenLayer layers[SHEEN_AOV_COUNT];
    size_t n_layers = 0;
    for (int a = 0; a < SHEEN_AOV_COUNT; ++a) {
        const SheenAovInfo *info = &sheen_aov_info[a];
        if (film->aov[a]) layers[n_layers++] = (SheenLayer){info->name, info->n_channels, info->suffixes, film->aov[a]};
    }
    SheenImageView view = {
        .width = film->width,
        .height = film->height,
        .pixels = film->color,
        .layers = layers,
        .n_layers = n_layers,
        .attributes = attributes,
        .n_attributes = sizeof attributes / sizeof *attributes,
    };
    SheenStatus status = SHEEN_OK;
    for (size_t i = 0; status == SHEEN_OK && i < v->outputs.n; ++i)
        status = sheen_image_write(v->outputs.items[i], &view, (float)v->exposure, &run->log);
    free(options_text);
    return status;
}

/** Writes --stats. @return the exit code. */
static int write_stats(Run *run)
{
    if (!run->values.stats) return CLI_DONE;
    char *text = stats_to_json(&run->values, &run->stats);
    if (!text) return cli_error("%s: out of memory", run->values.stats);
    bool ok = output_write_text(run->values.stats, text);
    free(text);
    return ok ? CLI_DONE : CLI_WORLD;
}

static void print_summary(const Run *run)
{
    const RunStats *s = &run->stats;
    if (run->report.quiet || run->values.progress == PROGRESS_NONE) return;
    fprintf(stderr, "sheen: %s", run->values.outputs.items[0]);
    if (run->values.outputs.n > 1) fprintf(stderr, " and %zu more", run->values.outputs.n - 1);
    fprintf(stderr, ": %u x %u, %s", run->film->width, run->film->height, render_integrator_name(&run->values));
    if (s->render.records) fprintf(stderr, ", %llu records", (unsigned long long)s->render.records);
    fprintf(stderr, ", %.2f s\n", s->total);
    if (!run->report.verbose) return;
    const SheenStats *r = &s->render;
    fprintf(stderr,
            "sheen: seconds: load %.2f, build %.2f, visibility %.2f, fill %.2f, direct %.2f, interpolate %.2f, "
            "write %.2f\n",
            s->load, s->times.build, r->time_visibility, r->time_fill, r->time_direct, r->time_interpolate, s->write);
    fprintf(stderr, "sheen: rays: camera %llu, shadow %llu, gather %llu, path %llu, specular %llu\n",
            (unsigned long long)r->rays_camera, (unsigned long long)r->rays_shadow, (unsigned long long)r->rays_gather,
            (unsigned long long)r->rays_path, (unsigned long long)r->rays_specular);
}

static int load(Run *run)
{
    SheenDefines defines = {run->values.defines.items, run->values.defines.n};
    SheenStatus status = sheen_scene_load_with(run->scene_path, defines, &run->log, &run->scene);
    run->stats.load = sheen_clock_seconds() - run->start;
    if (status == SHEEN_OK)
        sheen_info(&run->log, "%s: %u shapes, %llu triangles, %u lights", run->scene_path, run->scene->n_shapes,
                   (unsigned long long)run->scene->n_triangles, run->scene->n_lights);
    return report_exit_code(&run->report, status, run->scene_path);
}

static int interrupted(Run *run)
{
    progress_show_clear(&run->show);
    cli_error("interrupted; nothing was written");
    return CLI_INTERRUPTED;
}

/** Renders the loaded scene into run->film. */
static int render(Run *run)
{
    uint32_t camera;
    if (!find_camera(run, &camera)) return CLI_USAGE;
    if (atomic_load(run->interrupted)) return interrupted(run);
    SheenStatus status = sheen_pool_create(run->values.threads, &run->pool);
    if (status != SHEEN_OK) return cli_error("--threads: so many threads cannot be started on this machine");
    run->stats.threads = sheen_pool_size(run->pool);

    SheenRenderSettings settings = render_values_settings(&run->values, &run->scene->cameras[camera], camera);
    SheenProgress progress = progress_show_sink(&run->show);
    status = sheen_render(run->scene, &settings, run->pool, run->interrupted, &progress, &run->log, &run->film,
                          &run->stats.render, &run->stats.times);
    if (status == SHEEN_ERR_CANCELLED) return interrupted(run);
    if (run->stats.render.nonfinite_samples)
        sheen_warn(&run->log, "%s: %llu samples were not finite and were left out", run->scene_path,
                   (unsigned long long)run->stats.render.nonfinite_samples);
    return report_exit_code(&run->report, status, run->scene_path);
}

static int write_all(Run *run)
{
    double start = sheen_clock_seconds();
    SheenStatus status = write_pictures(run);
    run->stats.write = sheen_clock_seconds() - start;
    run->stats.total = sheen_clock_seconds() - run->start;
    int code = report_exit_code(&run->report, status, run->values.outputs.items[0]);
    if (code == CLI_DONE) code = write_stats(run);
    if (code == CLI_DONE) print_summary(run);
    // The picture was whole when the signal came; that it is there does not make the run an undisturbed one.
    return code == CLI_DONE && atomic_load(run->interrupted) ? CLI_INTERRUPTED : code;
}

static int run_render(int argc, char **argv)
{
    Run run = {.values = render_values_default(), .start = sheen_clock_seconds()};
    int code;
    if (!cli_parse(&command_render, &argc, argv, &run.values, &code)) return code;
    if (argc < 2) return cli_usage_error(&command_render, "SCENE: the scene file is missing");
    if (argc > 2) return cli_usage_error(&command_render, "SCENE: '%s' is one scene file too many", argv[2]);
    if (!render_values_check(&run.values)) return CLI_USAGE;
    if (!check_outputs(&run.values)) return CLI_WORLD;

    const RenderValues *v = &run.values;
    run.scene_path = argv[1];
    run.stats.scene = argv[1];
    run.show = progress_show_make(v->quiet ? PROGRESS_NONE : (ProgressMode)v->progress);
    run.report = (Report){.quiet = v->quiet, .verbose = v->verbose, .strict = v->strict, .show = &run.show};
    run.log = report_log(&run.report);
    interrupt_end_early();

    warn_about_layers(&run);
    code = run.report.failed ? CLI_WORLD : load(&run);
    run.interrupted = interrupt_catch();
    if (code == CLI_DONE) code = render(&run);
    if (code == CLI_DONE) code = write_all(&run);
    sheen_film_destroy(&run.film);
    sheen_pool_destroy(&run.pool);
    sheen_scene_destroy(&run.scene);
    return code;
}

const Command command_render = {
    .name = "render",
    .operands = "SCENE -o FILE",
    .summary = "one picture of a scene file",
    .description =
        "Renders a scene file (Mitsuba XML, versions 0.5 to 3, or Wavefront OBJ with its material libraries) and "
        "writes the picture, in one or more formats.\n"
        "The picture holds radiance in the scene's units and linear sRGB primaries; .exr files carry the options, the "
        "seed, the version and the scene's name as attributes. The same scene, options and seed give the same file, "
        "bit "
        "by bit, at any number of threads.\n"
        "Ctrl-C drops the picture in work and leaves existing files as they are; twice stops at once.",
    .options = render_options,
    .example = "sheen render scenes/cornell-box.xml -o box.exr -o box.png --spp 64",
    .run = run_render,
};
