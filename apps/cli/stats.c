// SPDX-License-Identifier: Apache-2.0
#include "stats.h"

#include "json_text.h"

#include <string.h>
#include <sys/resource.h>

static json_int_t peak_rss_bytes(void)
{
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return (json_int_t)usage.ru_maxrss * 1024; // Linux counts kilobytes
}

static json_t *time_json(const RunStats *run)
{
    const SheenStats *s = &run->render;
    return json_pack("{s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f}", "load", run->load, "build", run->times.build,
                     "visibility", s->time_visibility, "fill", s->time_fill, "direct", s->time_direct, "interpolate",
                     s->time_interpolate, "write", run->write, "total", run->total);
}

static json_t *rays_json(const SheenStats *s)
{
    return json_pack("{s:I, s:I, s:I, s:I, s:I}", "camera", (json_int_t)s->rays_camera, "shadow",
                     (json_int_t)s->rays_shadow, "gather", (json_int_t)s->rays_gather, "path", (json_int_t)s->rays_path,
                     "specular", (json_int_t)s->rays_specular);
}

// "irradiance" and "radiance" count the records that the picture reads, "deep" those of the light beyond the first
// bounce.
static json_t *records_json(const SheenStats *s)
{
    return json_pack("{s:I, s:I, s:i, s:I, s:i, s:I, s:i}", "irradiance", (json_int_t)s->records, "radiance",
                     (json_int_t)s->radiance_records, "light_vector", 0, "deep", (json_int_t)s->deep_records, "reused",
                     0, "new", (json_int_t)(s->records + s->radiance_records + s->deep_records), "deleted", 0);
}

char *stats_to_json(const RenderValues *values, const RunStats *run)
{
    const SheenStats *s = &run->render;
    json_t *frame = json_pack("{s:i, s:f, s:I}", "frame", 0, "time", run->times.total, "records",
                              (json_int_t)(s->records + s->radiance_records));
    json_t *object = json_pack(
        "{s:s, s:o, s:s, s:[I, I], s:i, s:I, s:o, s:o, s:o, s:o, s:I, s:I, s:I, s:I, s:f, s:I, s:[o]}", "version",
        SHEEN_VERSION, "scene", json_text(run->scene), "integrator", render_integrator_name(values), "size",
        (json_int_t)values->size.width, (json_int_t)values->size.height, "threads", (int)run->threads, "seed",
        (json_int_t)values->seed, "options", render_values_json(values), "time", time_json(run), "rays", rays_json(s),
        "records", records_json(s), "cache_bytes", (json_int_t)s->cache_bytes, "peak_rss_bytes", peak_rss_bytes(),
        "passes", (json_int_t)s->passes, "spp_done", (json_int_t)s->spp_done, "spp_mean", s->spp_mean,
        "nonfinite_samples", (json_int_t)s->nonfinite_samples, "frames", frame);
    char *text = object ? json_dumps(object, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(object);
    return text;
}
