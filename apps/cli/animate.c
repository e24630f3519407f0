// SPDX-License-Identifier: Apache-2.0
// `sheen animate`: a range of frames of a scene file.
#include "animate_options.h"
#include "cli.h"
#include "frame_maker.h"
#include "frame_name.h"
#include "frame_outputs.h"
#include "manifest.h"
#include "run.h"
#include "stats.h"

#include "base/clock.h"
#include "io/camera_path_file.h"

#include <stdlib.h>

/** A run of the command, from scene file to frames. */
typedef struct Animation {
    Run run;
    AnimateValues values;
    FrameRange range;      // that the values point to
    SheenCameraPath *path; // NULL: the scene's camera stands still
    FrameMaker maker;
    FrameOutputs outputs;
    Manifest manifest;
    size_t n;           // frames from values.first to values.last
    FrameStats *frames; // [stats.n_frames] of those that are whole
    RunStats stats;
} Animation;

/** Reads --camera-path and decides which frames there are. @return the exit code */
static int read_path(Animation *a, const SheenCamera *camera)
{
    AnimateValues *v = &a->values;
    double first = 0.0, last = 0.0;
    if (v->camera_path) {
        SheenStatus status = sheen_camera_path_read(v->camera_path, camera, &a->run.log, &a->path);
        int code = report_exit_code(&a->run.report, status, v->camera_path);
        if (code != CLI_DONE) return code;
        sheen_camera_path_range(a->path, &first, &last);
    }
    if (v->frames) return CLI_DONE;
    if (ceil(first) < 0.0 || floor(last) > FRAME_MAX || ceil(first) > floor(last))
        return cli_usage_error(a->run.command, "--frames: the keys of '%s' hold no frame from 0 to %d; say which",
                               v->camera_path, FRAME_MAX);
    v->first = (long)ceil(first), v->last = (long)floor(last);
    return CLI_DONE;
}

/** Looks whether all frames have a camera, so that a bad one is told before the work. @return the exit code */
static int check_cameras(const Animation *a, long first, long last)
{
    for (long frame = first; frame <= last; ++frame) {
        SheenCamera camera;
        SheenCameraFault fault = frame_maker_camera(&a->maker, frame, &camera);
        if (fault)
            return cli_error("%s: at frame %ld the camera %s", a->values.camera_path, frame,
                             sheen_camera_fault_text(fault));
    }
    return CLI_DONE;
}

/** Decides which frames there are and how they are made. @return the exit code */
static int plan(Animation *a)
{
    Run *run = &a->run;
    AnimateValues *v = &a->values;
    const SheenCamera *camera;
    if (!run_find_camera(run, &camera)) return CLI_USAGE;
    SheenRenderSettings settings = render_values_settings(&v->render, camera);
    int code = read_path(a, camera);
    if (code != CLI_DONE) return code;
    animate_values_resolve(v, &a->range);
    a->maker = (FrameMaker){
        .run = run, .values = v, .path = a->path, .camera = camera, .settings = settings, .stats = &a->stats};
    code = check_cameras(a, v->first, v->last);
    if (code == CLI_DONE && v->static_records == SWITCH_ON) code = check_cameras(a, v->records_first, v->records_last);
    if (code != CLI_DONE) return code;
    a->n = (size_t)(v->last - v->first) + 1;
    a->frames = malloc(a->n * sizeof *a->frames);
    return a->frames ? CLI_DONE : cli_error("--frames: %zu are too many for the memory", a->n);
}

/** All that can go wrong before the work. @return the exit code */
static int prepare(Animation *a)
{
    Run *run = &a->run;
    AnimateValues *v = &a->values;
    const TextList *outputs = &v->render.outputs;
    int code = plan(a);
    if (code != CLI_DONE) return code;
    if (!frame_outputs_check_files(outputs, v->first, v->last)) return CLI_WORLD;

    const char *camera_path = v->camera_path;
    // Pictures tell how they were made, wherever that was.
    if (camera_path) v->camera_path = path_last_part(camera_path);
    code = manifest_make(run, camera_path, a->maker.camera, v->first, &a->manifest);
    if (code == CLI_DONE && v->resume) code = manifest_resume(run->command, outputs, v->last, &a->manifest);
    if (code == CLI_DONE) code = run_start_threads(run);
    if (code != CLI_DONE) return code;
    SheenStatus status = frame_outputs_open(run, v->fps, &a->outputs);
    return report_exit_code(&run->report, status, outputs->items[0]);
}

/** Renders and writes a frame. @return the exit code */
static int render_frame(Animation *a, long number)
{
    const TextList *outputs = &a->values.render.outputs;
    double start = sheen_clock_seconds();
    SheenFilm *film = NULL;
    FrameStats *frame = &a->frames[a->stats.n_frames];
    int code = run_exit_code(&a->run, frame_maker_render(&a->maker, number, &film, frame), a->run.scene_path);
    double rendered = sheen_clock_seconds();
    if (code == CLI_DONE)
        code = run_exit_code(&a->run, frame_outputs_write(&a->outputs, number, film), outputs->items[0]);
    sheen_film_destroy(&film);
    if (code != CLI_DONE) return code;
    a->manifest.next = number + 1;
    if (!manifest_write(&a->manifest, outputs)) return CLI_WORLD;
    frame->time = sheen_clock_seconds() - start;
    a->stats.write += start + frame->time - rendered;
    return CLI_DONE;
}

static int interrupted(Animation *a)
{
    const TextList *outputs = &a->values.render.outputs;
    size_t patterns = frame_outputs_patterns(outputs), done = (size_t)(a->manifest.next - a->values.first);
    char what[96] = "nothing was written";
    if (patterns > 0)
        snprintf(what, sizeof what, "%zu frames of %zu are whole%s", done, a->n,
                 patterns < outputs->n ? ", the video was dropped" : "");
    return run_tell_interrupted(&a->run, what);
}

static int render_frames(Animation *a)
{
    const AnimateValues *v = &a->values;
    long begin = a->manifest.next;
    // So that a later run does not take what lies there from before for whole.
    if (begin <= v->last && !manifest_write(&a->manifest, &v->render.outputs)) return CLI_WORLD;
    int code = begin <= v->last ? frame_maker_begin(&a->maker, begin) : CLI_DONE;
    for (long frame = begin; frame <= v->last && code == CLI_DONE; ++frame) {
        progress_show_part(&a->run.show, "frame", (size_t)(frame - begin), (size_t)(v->last - begin) + 1);
        code = run_is_interrupted(&a->run) ? CLI_INTERRUPTED : render_frame(a, frame);
    }
    if (code == CLI_DONE || code == CLI_INTERRUPTED) {
        int kept = frame_maker_keep(&a->maker);
        if (kept != CLI_DONE) code = kept;
    }
    progress_show_clear(&a->run.show);
    if (code == CLI_DONE) code = run_exit_code(&a->run, frame_outputs_finish(&a->outputs), v->render.outputs.items[0]);
    run_warn_nonfinite(&a->run, a->stats.render.nonfinite_samples);
    return code == CLI_DONE && a->run.report.failed ? CLI_WORLD : code;
}

static void print_summary(const Animation *a)
{
    const RenderValues *v = &a->values.render;
    if (a->run.report.quiet || v->progress == PROGRESS_NONE) return;
    fprintf(stderr, "sheen: %s: %zu frames of %u x %u, %s, %.2f s\n", v->outputs.items[0], a->stats.n_frames,
            v->size.width, v->size.height, render_integrator_name(v), a->stats.total);
}

/** Statistics and summary, of an interrupted run too. @return the exit code */
static int report(Animation *a, int code)
{
    a->stats.frames = a->frames;
    a->stats.load = a->run.load;
    a->stats.total = sheen_clock_seconds() - a->run.start;
    if (code == CLI_INTERRUPTED) interrupted(a);
    int written = stats_write(&a->run, &a->stats);
    if (code == CLI_DONE && written == CLI_DONE) print_summary(a);
    return code == CLI_DONE ? written : code;
}

static void animation_free(Animation *a)
{
    frame_maker_end(&a->maker);
    free(a->frames);
    frame_outputs_close(&a->outputs);
    manifest_free(&a->manifest);
    sheen_camera_path_destroy(&a->path);
    run_end(&a->run);
}

static int run_animate(int argc, char **argv)
{
    Animation a = {.values = animate_values_default()};
    a.run = (Run){.command = &command_animate,
                  .all_values = &a.values,
                  .values = &a.values.render,
                  .start = sheen_clock_seconds()};
    AnimateValues *v = &a.values;
    int code;
    if (!cli_parse(&command_animate, &argc, argv, v, &code)) return code;
    code = cli_check_operand(&command_animate, argc, argv, "SCENE", "scene file");
    if (code != CLI_DONE) return code;
    if (!animate_values_check(&command_animate, v)) return CLI_USAGE;
    // Before a large scene is loaded; all frames are looked at when it is known which there are.
    if (!frame_outputs_check_files(&v->render.outputs, v->first, v->first) || !run_check_files(&v->render))
        return CLI_WORLD;

    run_begin(&a.run, argv[1]);
    run_warn_about_layers(&a.run, picture_files_have_layers(&v->render.outputs));
    code = run_load(&a.run);
    if (code == CLI_DONE) code = prepare(&a);
    if (code == CLI_DONE) {
        code = render_frames(&a);
        if (code == CLI_DONE || code == CLI_INTERRUPTED) code = report(&a, code);
    }
    animation_free(&a);
    return code;
}

const Command command_animate = {
    .name = "animate",
    .operands = "SCENE -o FRAMES|VIDEO",
    .summary = "a range of frames of a scene file",
    .description =
        "Renders a walkthrough: the scene stands still, and the camera moves along a path. The records of the cache "
        "serve "
        "all frames: they are placed for the whole walkthrough first, then each frame is shaded from them, so that its "
        "indirect light does not change where the camera does not see anew.\n"
        "Frames are written as they are finished, a video when all are. The same scene, options and seed give the same "
        "files, bit by bit, at "
        "any number of threads, and after --resume.\n"
        "With --cache-out the records outlive the run, and --cache-in takes them.\n"
        "Ctrl-C drops the frame in work and keeps those that are finished, but not the half of a video; twice stops at "
        "once.",
    .options = animate_tables,
    .example = "sheen animate scenes/glossy-box.xml --camera-path walk.json -o walk.####.png",
    .run = run_animate,
};
