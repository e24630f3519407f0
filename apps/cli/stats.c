// SPDX-License-Identifier: Apache-2.0
#include "stats.h"

#include "json_text.h"
#include "options_json.h"
#include "output.h"

#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

static json_int_t peak_rss_bytes(void)
{
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return (json_int_t)usage.ru_maxrss * 1024; // Linux counts kilobytes
}

// Stages that follow each other; but "refine" is a part of "fill".
static json_t *time_json(const RunStats *run)
{
    const SheenStats *s = &run->render;
    return json_pack("{s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f}", "load", run->load, "build", run->build,
                     "visibility", s->time_visibility, "fill", s->time_fill, "refine", s->time_refine, "direct",
                     s->time_direct, "interpolate", s->time_interpolate, "write", run->write, "total", run->total);
}

static json_t *rays_json(const SheenStats *s)
{
    return json_pack("{s:I, s:I, s:I, s:I, s:I}", "camera", (json_int_t)s->rays_camera, "shadow",
                     (json_int_t)s->rays_shadow, "gather", (json_int_t)s->rays_gather, "path", (json_int_t)s->rays_path,
                     "specular", (json_int_t)s->rays_specular);
}

// "irradiance" and "radiance" count the records that the picture reads, "deep" those of the light beyond the first
// bounce. "new" is what does not come from cache files.
static json_t *records_json(const RunStats *run)
{
    const SheenStats *s = &run->render;
    uint64_t made = s->records + s->radiance_records + s->deep_records - run->from_files;
    return json_pack("{s:I, s:I, s:i, s:I, s:I, s:I, s:i}", "irradiance", (json_int_t)s->records, "radiance",
                     (json_int_t)s->radiance_records, "light_vector", 0, "deep", (json_int_t)s->deep_records, "reused",
                     (json_int_t)(run->reused + run->from_files), "new", (json_int_t)made, "deleted", 0);
}

FrameStats frame_stats(long frame, double time, const SheenStats *stats)
{
    uint64_t records = stats->records + stats->radiance_records;
    return (FrameStats){frame, time, records, records};
}

void stats_sum(SheenStats *total, size_t n, const SheenStats *frame)
{
    sheen_stats_add(total, frame);
    total->time_visibility += frame->time_visibility;
    total->time_fill += frame->time_fill;
    total->time_refine += frame->time_refine;
    total->time_direct += frame->time_direct;
    total->time_interpolate += frame->time_interpolate;
    total->records += frame->records;
    total->radiance_records += frame->radiance_records;
    total->deep_records += frame->deep_records;
    total->passes += frame->passes;
    if (frame->refined > total->refined) total->refined = frame->refined;
    if (frame->cache_bytes > total->cache_bytes) total->cache_bytes = frame->cache_bytes;
    if (n == 0 || frame->spp_done < total->spp_done) total->spp_done = frame->spp_done;
    total->spp_mean += (frame->spp_mean - total->spp_mean) / (double)(n + 1);
}

static json_t *frames_json(const RunStats *run)
{
    json_t *frames = json_array();
    for (size_t i = 0; i < run->n_frames; ++i) {
        const FrameStats *f = &run->frames[i];
        json_array_append_new(frames, json_pack("{s:I, s:f, s:I, s:I}", "frame", (json_int_t)f->frame, "time", f->time,
                                                "records", (json_int_t)f->records, "new", (json_int_t)f->added));
    }
    return frames;
}

/** @return the object as text from malloc, or NULL when out of memory. */
static char *to_json(const Run *run, const RunStats *stats)
{
    const SheenStats *s = &stats->render;
    const RenderValues *v = run->values;
    json_t *object = json_pack(
        "{s:s, s:o, s:s, s:[I, I], s:i, s:I, s:o, s:o, s:o, s:o, s:I, s:I, s:I, s:I, s:I, s:f, s:I, s:o}", "version",
        SHEEN_VERSION, "scene", json_text(run->scene_path), "integrator", render_integrator_name(v), "size",
        (json_int_t)v->size.width, (json_int_t)v->size.height, "threads", (int)sheen_pool_size(run->pool), "seed",
        (json_int_t)v->seed, "options", options_json(run->command->options, run->all_values), "time", time_json(stats),
        "rays", rays_json(s), "records", records_json(stats), "cache_bytes", (json_int_t)s->cache_bytes,
        "peak_rss_bytes", peak_rss_bytes(), "passes", (json_int_t)s->passes, "refined", (json_int_t)s->refined,
        "spp_done", (json_int_t)s->spp_done, "spp_mean", s->spp_mean, "nonfinite_samples",
        (json_int_t)s->nonfinite_samples, "frames", frames_json(stats));
    char *text = object ? json_dumps(object, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(object);
    return text;
}

int stats_write(const Run *run, const RunStats *stats)
{
    const char *path = run->values->stats;
    if (!path) return CLI_DONE;
    char *text = to_json(run, stats);
    if (!text) return cli_error("%s: out of memory", path);
    bool ok = output_write_text(path, text);
    free(text);
    return ok ? CLI_DONE : CLI_WORLD;
}
