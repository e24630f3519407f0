// SPDX-License-Identifier: Apache-2.0
#include "frame_maker.h"

#include "record_files.h"

SheenCameraFault frame_maker_camera(const FrameMaker *m, long frame, SheenCamera *out)
{
    if (m->path) return sheen_camera_path_at(m->path, (double)frame, out);
    *out = *m->camera;
    return SHEEN_CAMERA_FINE;
}

/** A frame's camera as the session wants it. */
typedef struct Aim {
    SheenCamera camera; // that the shot borrows
    SheenShot shot;
} Aim;

static void aim_at(const FrameMaker *m, long frame, Aim *aim)
{
    aim->camera = *m->camera;
    (void)frame_maker_camera(m, frame, &aim->camera); // that every frame has one was looked at before
    aim->shot = (SheenShot){&aim->camera, m->settings.width, m->settings.height, m->settings.filter};
}

static RecordCounts count_kept(const FrameMaker *m)
{
    const SheenCaches *caches = m->session ? sheen_session_caches(m->session) : NULL;
    return caches ? sheen_caches_counts(caches) : (RecordCounts){0};
}

typedef SheenStatus Pass(SheenSession *session, const SheenShot *shot, SheenStats *stats);

/** Runs a pass for some frames. @param what  literal, for the progress */
static SheenStatus run_pass(FrameMaker *m, Pass *pass, const char *what, long first, long last)
{
    SheenStatus status = SHEEN_OK;
    for (long frame = first; status == SHEEN_OK && frame <= last; ++frame) {
        Aim aim;
        aim_at(m, frame, &aim);
        progress_show_part(&m->run->show, what, (size_t)(frame - first), (size_t)(last - first) + 1);
        status = run_is_interrupted(m->run) ? SHEEN_ERR_CANCELLED : pass(m->session, &aim.shot, &m->stats->render);
    }
    return status;
}

static SheenStatus fill_and_settle(SheenSession *session, const SheenShot *shot, SheenStats *stats)
{
    SheenStatus status = sheen_session_fill(session, shot, stats);
    return status == SHEEN_OK ? sheen_session_settle(session, stats) : status;
}

static SheenStatus create_session(FrameMaker *m)
{
    Run *run = m->run;
    m->progress = progress_show_sink(&run->show);
    SheenSessionDesc desc = {
        run->scene, m->settings.integrator, m->settings.options, run->pool, run->interrupted, &m->progress, &run->log};
    return sheen_session_create(&desc, &m->stats->render, &m->stats->build, &m->session);
}

static const char filling[] = "filling frame"; // for the progress

// Fills all frames until a pass adds nothing: later frames' records and refinement uncover points of earlier ones.
static SheenStatus fill_all(FrameMaker *m)
{
    enum { PASSES_MAX = 8 };
    const AnimateValues *v = m->values;
    SheenStatus status = SHEEN_OK;
    uint64_t before, after = UINT64_MAX;
    for (int pass = 0; pass < PASSES_MAX && status == SHEEN_OK; ++pass) {
        before = after;
        status = run_pass(m, sheen_session_fill, filling, v->records_first, v->records_last);
        RecordCounts counts = count_kept(m);
        after = record_counts_all(&counts);
        if (after == before) break;
    }
    return status == SHEEN_OK ? sheen_session_settle(m->session, &m->stats->render) : status;
}

/** Looks at and fills what is to be filled before the first frame. @return the library's status */
static SheenStatus fill_before(FrameMaker *m, long begin)
{
    const AnimateValues *v = m->values;
    SheenStatus status = run_pass(m, sheen_session_look, "looking at frame", v->records_first, v->records_last);
    if (status != SHEEN_OK) return status;
    if (v->prefill == SWITCH_OFF) return run_pass(m, fill_and_settle, filling, v->first, begin - 1);
    return fill_all(m);
}

int frame_maker_begin(FrameMaker *m, long begin)
{
    Run *run = m->run;
    bool has_records = m->values->render.integrator != SHEEN_INTEGRATOR_PATH;
    if (has_records && m->values->static_records == SWITCH_OFF) return CLI_DONE;
    int code = run_exit_code(run, create_session(m), run->scene_path);
    if (code != CLI_DONE || !has_records) return code;
    code = record_files_read(run, m->session, &m->stats->from_files);
    if (code != CLI_DONE) return code;
    code = run_exit_code(run, fill_before(m, begin), run->scene_path);
    m->kept = count_kept(m);
    m->stats->render.records += m->kept.irradiance;
    m->stats->render.radiance_records += record_counts_radiance(&m->kept);
    // All that will be made is there: an hour of shading cannot lose it.
    return code == CLI_DONE && m->values->prefill == SWITCH_ON ? frame_maker_keep(m) : code;
}

int frame_maker_keep(FrameMaker *m)
{
    if (m->written || !m->session || !m->values->render.cache.out || record_files_count(m->session) == 0)
        return CLI_DONE;
    int code = record_files_write(m->run, m->session, m->stats);
    m->written = code == CLI_DONE;
    return code;
}

/** Renders a frame from the session. @param stats  gets its figures, the kept records included */
static SheenStatus shade(FrameMaker *m, const SheenShot *shot, SheenFilm **film, SheenStats *stats)
{
    SheenStatus status = SHEEN_OK;
    if (m->values->static_records == SWITCH_ON && m->values->prefill == SWITCH_OFF)
        status = fill_and_settle(m->session, shot, stats);
    if (status == SHEEN_OK) status = sheen_session_shade(m->session, shot, m->settings.aovs, film, stats);
    return status;
}

static SheenStatus render_alone(FrameMaker *m, const Aim *aim, SheenFilm **film, SheenStats *stats)
{
    Run *run = m->run;
    SheenProgress progress = progress_show_sink(&run->show);
    SheenRenderTimes times;
    m->settings.camera = &aim->camera;
    SheenStatus status =
        sheen_render(run->scene, &m->settings, run->pool, run->interrupted, &progress, &run->log, film, stats, &times);
    m->stats->build += times.build;
    return status;
}

SheenStatus frame_maker_render(FrameMaker *m, long number, SheenFilm **film, FrameStats *frame)
{
    Aim aim;
    SheenStats stats = {0};
    aim_at(m, number, &aim);
    SheenStatus status = m->session ? shade(m, &aim.shot, film, &stats) : render_alone(m, &aim, film, &stats);
    if (status != SHEEN_OK) return status;
    uint64_t before = record_counts_all(&m->kept);
    *frame = frame_stats(number, 0.0, &stats);
    frame->added -= before;
    m->stats->reused += before;
    // The totals count a record once.
    stats.records -= m->kept.irradiance;
    stats.radiance_records -= record_counts_radiance(&m->kept);
    stats.deep_records -= m->deep;
    m->kept = count_kept(m);
    if (m->session) m->deep += stats.deep_records;
    stats_sum(&m->stats->render, m->stats->n_frames++, &stats);
    return SHEEN_OK;
}

void frame_maker_end(FrameMaker *m)
{
    sheen_session_destroy(&m->session);
}
