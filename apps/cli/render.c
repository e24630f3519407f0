// SPDX-License-Identifier: Apache-2.0
// `sheen render`: one picture of a scene file.
#include "cli.h"
#include "output.h"
#include "picture_file.h"
#include "record_files.h"
#include "run.h"
#include "stats.h"

#include "base/clock.h"
#include "image/image.h"

#include <string.h>

static const Option output_options[] = {
    {.kind = OPTION_TEXTS,
     .letter = 'o',
     .name = "output",
     .argument = "FILE",
     .meaning = "The picture to write; its ending tells the format: .exr (float, linear, with the layers of --aov), "
                ".hdr, .pfm, .png (8 bit, sRGB). May be given several times. A file appears whole or not at all, and "
                "an existing one is replaced by a finished one only.",
     .standard = "none; at least one is required",
     .example = "-o box.exr -o box.png",
     .offset = offsetof(RenderValues, outputs)},
    {0},
};

static const Option picture_options[] = {
    {.kind = OPTION_NUMBER,
     .name = "time-limit",
     .argument = "SECONDS",
     .meaning = "With --integrator path only: pass after pass until the time is up, whatever --spp says. The "
                "statistics tell how many there were.",
     .standard = "none",
     .example = "--integrator path --time-limit 30",
     .recorded = true,
     .min = 0.001,
     .max = 1e9,
     .offset = offsetof(RenderValues, time_limit)},
    {.kind = OPTION_FLAG,
     .name = "records-only",
     .meaning = "Make the records that the picture would need, write them to --cache-out, and no picture.",
     .example = "--records-only --cache-out box.shc",
     .offset = offsetof(RenderValues, cache.records_only)},
    {.kind = OPTION_LATER, .name = "frame"},
    {0},
};

static const OptionTable tables[] = {
    {output_options, 0}, RENDER_TABLES(0), {cache_options, offsetof(RenderValues, cache)}, {picture_options, 0}, {0},
};

static bool check_outputs_given(const RenderValues *v)
{
    if (v->cache.records_only && v->outputs.n > 0) {
        cli_usage_error(&command_render, "--output: with --records-only there is no picture");
        return false;
    }
    if (!v->cache.records_only && v->outputs.n == 0) {
        cli_usage_error(&command_render, "--output: at least one picture file is required");
        return false;
    }
    for (size_t i = 0; i < v->outputs.n; ++i) {
        const char *path = v->outputs.items[i];
        if (!sheen_image_writable_format(path)) {
            cli_usage_error(&command_render, "--output: '%s' does not end in .exr, .hdr, .pfm or .png", path);
            return false;
        }
        for (size_t k = 0; k < i; ++k) {
            if (strcmp(path, v->outputs.items[k]) != 0) continue;
            cli_usage_error(&command_render, "--output: '%s' is given twice", path);
            return false;
        }
    }
    return true;
}

static bool check_values(const RenderValues *v)
{
    bool has_cache = v->integrator != SHEEN_INTEGRATOR_PATH;
    if (!cache_values_check(&command_render, &v->cache, has_cache) || !check_outputs_given(v)) return false;
    if (v->time_limit > 0.0 && v->integrator != SHEEN_INTEGRATOR_PATH) {
        cli_usage_error(&command_render, "--time-limit: goes with --integrator path only");
        return false;
    }
    return render_values_check(&command_render, v);
}

/** @return false after a message about a file that could not be written. */
static bool check_outputs(const RenderValues *v)
{
    for (size_t i = 0; i < v->outputs.n; ++i)
        if (!output_check(v->outputs.items[i], false)) return false;
    return run_check_files(v);
}

/** Writes the film to every output. @return the library's status. */
static SheenStatus write_pictures(const Run *run, const SheenFilm *film)
{
    const TextList *outputs = &run->values->outputs;
    PictureNotes notes;
    SheenStatus status = picture_notes_make(run, &notes) ? SHEEN_OK : SHEEN_ERR_NOMEM;
    for (size_t i = 0; status == SHEEN_OK && i < outputs->n; ++i)
        status = picture_file_write(run, outputs->items[i], film, &notes);
    picture_notes_free(&notes);
    return status;
}

static void print_summary(const Run *run, const RunStats *s)
{
    const RenderValues *v = run->values;
    if (run->report.quiet || v->progress == PROGRESS_NONE) return;
    const SheenStats *r = &s->render;
    uint64_t records = r->records + r->radiance_records;
    fprintf(stderr, "sheen: %s", v->cache.records_only ? v->cache.out : v->outputs.items[0]);
    if (v->outputs.n > 1) fprintf(stderr, " and %zu more", v->outputs.n - 1);
    fprintf(stderr, ": %u x %u, %s", v->size.width, v->size.height, render_integrator_name(v));
    if (records) fprintf(stderr, ", %llu records", (unsigned long long)records);
    if (v->cache.in.n) fprintf(stderr, " (%llu new)", (unsigned long long)(records - s->from_files));
    fprintf(stderr, ", %.2f s\n", s->total);
    if (!run->report.verbose) return;
    fprintf(stderr,
            "sheen: seconds: load %.2f, build %.2f, visibility %.2f, fill %.2f (refine %.2f), direct %.2f, "
            "interpolate %.2f, write %.2f\n",
            s->load, s->build, r->time_visibility, r->time_fill, r->time_refine, r->time_direct, r->time_interpolate,
            s->write);
    fprintf(stderr, "sheen: rays: camera %llu, shadow %llu, gather %llu, path %llu, specular %llu\n",
            (unsigned long long)r->rays_camera, (unsigned long long)r->rays_shadow, (unsigned long long)r->rays_gather,
            (unsigned long long)r->rays_path, (unsigned long long)r->rays_specular);
}

/** The records of the loaded scene, and the picture made from them. */
typedef struct Work {
    Run *run;
    RunStats *stats;
    SheenSession *session;
    SheenShot shot;
    bool kept; // the records are in --cache-out
} Work;

static int write_records(Work *w)
{
    int code = record_files_write(w->run, w->session, w->stats);
    w->kept = code == CLI_DONE && w->run->values->cache.out;
    return code;
}

/** Ctrl-C in the middle: with --cache-out what was made so far is not lost. @return the exit code */
static int interrupted(Work *w)
{
    uint64_t n = w->session ? record_files_count(w->session) : 0;
    const char *path = w->run->values->cache.out;
    if (path && !w->kept && n > 0) {
        int code = write_records(w);
        if (code != CLI_DONE) return code;
    }
    if (!w->kept) return run_tell_interrupted(w->run, "nothing was written");
    char what[1024];
    snprintf(what, sizeof what, "%s has the %llu records made so far", path, (unsigned long long)n);
    return run_tell_interrupted(w->run, what);
}

/** Makes the records that the picture needs and writes them. @return the library's status; *code the exit code */
static SheenStatus make_records(Work *w, int *code)
{
    SheenStats *stats = &w->stats->render;
    *code = record_files_read(w->run, w->session, &w->stats->from_files);
    if (*code != CLI_DONE) return SHEEN_OK;
    SheenStatus status = sheen_session_look(w->session, &w->shot, stats);
    if (status == SHEEN_OK) status = sheen_session_fill(w->session, &w->shot, stats);
    if (status == SHEEN_OK) status = sheen_session_settle(w->session, stats);
    if (status == SHEEN_OK) *code = write_records(w);
    return status;
}

/** @param film  gets the picture; none with --records-only @return the exit code */
static int make_picture(Work *w, const SheenSessionDesc *desc, SheenFilm **film)
{
    const RenderValues *v = w->run->values;
    SheenStats *stats = &w->stats->render;
    int code = CLI_DONE;
    SheenStatus status = sheen_session_create(desc, stats, &w->stats->build, &w->session);
    if (status == SHEEN_OK) status = make_records(w, &code);
    if (status == SHEEN_OK && code == CLI_DONE) {
        if (v->cache.records_only)
            sheen_caches_count(sheen_session_caches(w->session), stats);
        else
            status = sheen_session_shade(w->session, &w->shot, v->aovs, film, stats);
    }
    if (status == SHEEN_ERR_CANCELLED) return interrupted(w);
    return code == CLI_DONE ? report_exit_code(&w->run->report, status, w->run->scene_path) : code;
}

/** Renders the loaded scene. @param film  gets the picture */
static int render(Run *run, RenderValues *values, FrameStats *frame, SheenFilm **film, RunStats *stats)
{
    const SheenCamera *camera;
    if (!run_find_camera(run, &camera)) return CLI_USAGE;
    if (run_is_interrupted(run)) return run_tell_interrupted(run, "nothing was written");
    int code = run_start_threads(run);
    if (code != CLI_DONE) return code;
    double start = sheen_clock_seconds();
    SheenRenderSettings settings = render_values_settings(values, camera);
    SheenProgress progress = progress_show_sink(&run->show);
    SheenSessionDesc desc = {run->scene,       settings.integrator, settings.options, run->pool,
                             run->interrupted, &progress,           &run->log};
    Work work = {.run = run, .stats = stats, .shot = {camera, settings.width, settings.height, settings.filter}};
    code = make_picture(&work, &desc, film);
    sheen_session_destroy(&work.session);
    if (code != CLI_DONE) return code;
    *frame = frame_stats(0, sheen_clock_seconds() - start, &stats->render);
    frame->added -= stats->from_files;
    run_warn_nonfinite(run, stats->render.nonfinite_samples);
    return report_exit_code(&run->report, SHEEN_OK, run->scene_path);
}

/** @param film  NULL where there is no picture */
static int write_all(Run *run, const SheenFilm *film, RunStats *stats)
{
    double start = sheen_clock_seconds();
    SheenStatus status = film ? write_pictures(run, film) : SHEEN_OK;
    stats->load = run->load;
    stats->write += sheen_clock_seconds() - start;
    stats->total = sheen_clock_seconds() - run->start;
    int code = report_exit_code(&run->report, status, film ? run->values->outputs.items[0] : run->scene_path);
    if (code == CLI_DONE) code = stats_write(run, stats);
    if (code == CLI_DONE) print_summary(run, stats);
    // The picture was whole when the signal came; that it is there does not make the run an undisturbed one.
    return code == CLI_DONE && run_is_interrupted(run) ? CLI_INTERRUPTED : code;
}

static int run_render(int argc, char **argv)
{
    RenderValues values = render_values_default();
    Run run = {.command = &command_render, .all_values = &values, .values = &values, .start = sheen_clock_seconds()};
    int code;
    if (!cli_parse(&command_render, &argc, argv, &values, &code)) return code;
    code = cli_check_operand(&command_render, argc, argv, "SCENE", "scene file");
    if (code != CLI_DONE) return code;
    if (!check_values(&values)) return CLI_USAGE;
    if (!check_outputs(&values)) return CLI_WORLD;

    run_begin(&run, argv[1]);
    run_warn_about_layers(&run, picture_files_have_layers(&values.outputs));
    FrameStats frame;
    RunStats stats = {.frames = &frame, .n_frames = 1};
    SheenFilm *film = NULL;
    code = run_load(&run);
    if (code == CLI_DONE) code = render(&run, &values, &frame, &film, &stats);
    if (code == CLI_DONE) code = write_all(&run, film, &stats);
    sheen_film_destroy(&film);
    run_end(&run);
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
        "bit by bit, at any number of threads.\n"
        "With --cache-out the records of its cache outlive the picture: a later run of the same scene, from this view "
        "or another, takes them with --cache-in. With the same options and view it gives the same picture, bit by "
        "bit.\n"
        "Ctrl-C drops the picture in work and leaves existing files as they are; twice stops at once. With --cache-out "
        "once writes the records made so far.",
    .options = tables,
    .example = "sheen render scenes/cornell-box.xml -o box.exr -o box.png --spp 64",
    .run = run_render,
};
