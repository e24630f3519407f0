// SPDX-License-Identifier: Apache-2.0
#include "record_files.h"

#include "frame_name.h"
#include "json_text.h"
#include "options_json.h"

#include "base/clock.h"
#include "cache/cache_file.h"
#include "scene/scene_hash.h"

#include <stdlib.h>

uint64_t record_files_count(SheenSession *session)
{
    const SheenCaches *caches = sheen_session_caches(session);
    if (!caches) return 0;
    RecordCounts n = sheen_caches_counts(caches);
    return record_counts_all(&n);
}

/** @return what the records are made with, a new reference; NULL when out of memory. */
static json_t *about_json(const Run *run)
{
    return json_pack("{s:s, s:o, s:o}", "version", SHEEN_VERSION, "scene", json_text(path_last_part(run->scene_path)),
                     "options", options_json_of_records(run->command->options, run->all_values));
}

/** Warns of each option that differs. */
static void compare_options(const Run *run, const char *path, const json_t *then, json_t *now)
{
    const char *name;
    json_t *value;
    json_object_foreach(now, name, value)
    {
        json_t *other = json_object_get(then, name);
        if (!other || json_equal(value, other)) continue;
        char *was = json_value_text(other);
        char *is = json_value_text(value);
        sheen_warn(&run->log, "%s: its records were made with --%s %s, which is %s now", path, name, was ? was : "?",
                   is ? is : "another");
        free(was);
        free(is);
    }
}

static void compare(const Run *run, const char *path, const SheenCacheFile *file, uint64_t scene_hash, json_t *about)
{
    if (file->scene_hash != scene_hash)
        sheen_warn(&run->log, "%s: its records were made in another scene than %s, or one that has changed", path,
                   run->scene_path);
    json_t *then = json_loads(file->about, 0, NULL);
    compare_options(run, path, json_object_get(then, "options"), json_object_get(about, "options"));
    json_decref(then);
}

static SheenStatus append(const Run *run, const char *path, const SheenCacheFile *file, const SheenCaches *caches)
{
    SheenStatus status = caches->irradiance ? sheen_cache_file_append_irradiance(file, caches->irradiance) : SHEEN_OK;
    uint64_t left_out = caches->irradiance ? 0 : file->parts[SHEEN_CACHE_PART_IRRADIANCE].n;
    for (int b = 0; b < SHEEN_BASIS_COUNT && status == SHEEN_OK; ++b) {
        if (caches->radiance[b])
            status = sheen_cache_file_append_radiance(file, caches->radiance[b]);
        else
            left_out += file->parts[SHEEN_CACHE_PART_HSH + b].n;
    }
    if (status != SHEEN_OK) return sheen_fail(&run->log, status, "%s: out of memory", path);
    uint64_t n = 0;
    for (int i = 0; i < SHEEN_CACHE_PARTS; ++i) n += file->parts[i].n;
    sheen_info(&run->log, "%s: %llu records", path, (unsigned long long)n);
    if (left_out > 0)
        sheen_info(&run->log, "%s: %llu records of light that this picture does not keep are left out", path,
                   (unsigned long long)left_out);
    return SHEEN_OK;
}

int record_files_read(Run *run, SheenSession *session, uint64_t *reused)
{
    const TextList *in = &run->values->cache.in;
    *reused = 0;
    if (in->n == 0) return CLI_DONE;
    uint64_t scene_hash = sheen_scene_hash(run->scene);
    json_t *about = about_json(run);
    if (!about) return cli_error("%s: out of memory", in->items[0]);
    SheenStatus status = SHEEN_OK;
    int code = CLI_DONE;
    for (size_t i = 0; i < in->n && code == CLI_DONE; ++i) {
        SheenCacheFile *file;
        status = sheen_cache_file_read(in->items[i], &run->log, &file);
        if (status == SHEEN_OK) {
            compare(run, in->items[i], file, scene_hash, about);
            status = append(run, in->items[i], file, sheen_session_caches(session));
        }
        sheen_cache_file_destroy(&file);
        code = report_exit_code(&run->report, status, in->items[i]);
    }
    json_decref(about);
    sheen_session_adopt(session);
    *reused = record_files_count(session);
    return code;
}

static int write_file(Run *run, SheenSession *session, const char *path)
{
    json_t *about = about_json(run);
    char *text = about ? json_dumps(about, JSON_COMPACT) : NULL;
    json_decref(about);
    if (!text) return cli_error("%s: out of memory", path);
    const SheenCaches *caches = sheen_session_caches(session);
    SheenCacheContents contents = {
        .scene_hash = sheen_scene_hash(run->scene), .about = text, .irradiance = caches->irradiance};
    for (int b = 0; b < SHEEN_BASIS_COUNT; ++b) contents.radiance[b] = caches->radiance[b];
    SheenStatus status = sheen_cache_file_write(path, &contents, &run->log);
    free(text);
    return report_exit_code(&run->report, status, path);
}

int record_files_write(Run *run, SheenSession *session, RunStats *stats)
{
    const char *path = run->values->cache.out;
    if (!path) return CLI_DONE;
    double start = sheen_clock_seconds();
    // After Ctrl-C some have not learnt from their neighbors yet.
    SheenStatus status = sheen_session_settle(session, &stats->render);
    int code = report_exit_code(&run->report, status, run->scene_path);
    if (code == CLI_DONE) code = write_file(run, session, path);
    stats->write += sheen_clock_seconds() - start;
    return code;
}
