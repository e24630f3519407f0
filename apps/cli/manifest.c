// SPDX-License-Identifier: Apache-2.0
#include "manifest.h"

#include "frame_name.h"
#include "frame_outputs.h"
#include "json_text.h"
#include "options_json.h"
#include "output.h"

#include "image/whole_file.h"
#include "scene/scene_hash.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <xxhash.h>

/** @return the content of a file as a hash, a new reference; NULL after a message or when out of memory. */
static json_t *content_json(const Run *run, const char *path)
{
    uint8_t *data;
    size_t size;
    if (sheen_file_read(path, &run->log, &data, &size) != SHEEN_OK) return NULL;
    json_t *hash = json_hash(XXH3_64bits(data, size));
    free(data);
    return hash;
}

/** What of a camera the options do not tell. */
static json_t *camera_json(const SheenCamera *c)
{
    const float numbers[] = {c->fov_x,         c->aperture,      c->focus,    c->orthographic ? 1.0f : 0.0f,
                             c->cut_lo.x,      c->cut_lo.y,      c->cut_hi.x, c->cut_hi.y,
                             c->filter.radius, c->filter.stddev, c->filter.b, c->filter.c};
    uint64_t place = XXH3_64bits(&c->to_world, sizeof c->to_world);
    return json_hash(XXH3_64bits_withSeed(numbers, sizeof numbers, place));
}

/** Adds the content of --cache-in, on which pictures depend. @return false after a message */
static bool add_records(const Run *run, json_t *options)
{
    const TextList *in = &run->values->cache.in;
    json_t *files = json_array();
    json_object_set_new(options, "cache-in", files);
    for (size_t i = 0; i < in->n; ++i)
        if (json_array_append_new(files, content_json(run, in->items[i])) != 0) return false;
    return true;
}

int manifest_make(const Run *run, const char *camera_path, const SheenCamera *camera, long first, Manifest *out)
{
    *out = (Manifest){.first = first, .next = first};
    const OptionTable *tables = run->command->options;
    json_t *path = camera_path ? content_json(run, camera_path) : json_null();
    if (!path) return run->report.failed ? CLI_WORLD : cli_error("%s: out of memory", camera_path);
    json_t *options = options_json(tables, run->all_values);
    json_object_del(options, "camera-path"); // its content counts
    // Files depend on these too, though the light in them does not.
    json_object_set_new(options, "aov", options_json_value(tables, run->all_values, "aov"));
    json_object_set_new(options, "exposure", options_json_value(tables, run->all_values, "exposure"));
    if (!add_records(run, options)) {
        json_decref(path);
        json_decref(options);
        return CLI_WORLD;
    }
    out->made_with = json_pack("{s:s, s:o, s:o, s:o, s:o}", "version", SHEEN_VERSION, "scene",
                               json_hash(sheen_scene_hash(run->scene)), "camera", camera_json(camera), "camera path",
                               path, "options", options);
    return out->made_with ? CLI_DONE : cli_error("%s: out of memory", run->scene_path);
}

void manifest_free(Manifest *manifest)
{
    json_decref(manifest->made_with);
    manifest->made_with = NULL;
}

/** @return the path of a pattern's file, from malloc, or NULL after a message. */
static char *path_of(const char *pattern)
{
    size_t size = strlen(pattern) + sizeof ".json";
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%s.json", pattern);
    else
        cli_error("%s: out of memory", pattern);
    return path;
}

bool manifest_write(const Manifest *manifest, const TextList *outputs)
{
    json_t *whole = json_pack("{s:I, s:I}", "first", (json_int_t)manifest->first, "next", (json_int_t)manifest->next);
    json_t *object = json_pack("{s:o, s:O}", "whole frames", whole, "made with", manifest->made_with);
    char *text = object ? json_dumps(object, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(object);
    bool ok = text != NULL;
    if (!ok) cli_error("%s: out of memory", outputs->items[0]);
    for (size_t i = 0; ok && i < outputs->n; ++i) {
        if (video_has_ending(outputs->items[i])) continue;
        char *path = path_of(outputs->items[i]);
        ok = path && output_write_text(path, text);
        free(path);
    }
    free(text);
    return ok;
}

/** Tells the first option that differs. */
static int refuse_option(const Command *command, const char *path, json_t *then, json_t *now)
{
    const char *name;
    json_t *value;
    json_object_foreach(now, name, value)
    {
        json_t *other = json_object_get(then, name);
        if (json_equal(value, other)) continue;
        char *was = other ? json_value_text(other) : NULL;
        char *is = json_value_text(value);
        int code = cli_usage_error(command, "--resume: --%s was %s in the run that %s tells of, and is %s now", name,
                                   was ? was : "not there", path, is ? is : "another");
        free(was);
        free(is);
        return code;
    }
    return CLI_DONE;
}

/** Compares what an earlier run was made with. */
static int compare(const Command *command, const char *path, json_t *then, json_t *now)
{
    int code = refuse_option(command, path, json_object_get(then, "options"), json_object_get(now, "options"));
    const char *name;
    json_t *value;
    if (code != CLI_DONE) return code;
    json_object_foreach(now, name, value)
    {
        if (strcmp(name, "options") == 0 || json_equal(value, json_object_get(then, name))) continue;
        return cli_error("%s: --resume: the %s is not that of the earlier run", path, name);
    }
    return CLI_DONE;
}

/** Reads one file. @param whole  gets the whole frames: from [0] to before [1] */
static int read_one(const Command *command, const char *path, const Manifest *manifest, long whole[2])
{
    json_error_t error;
    json_t *object = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
    if (!object) return cli_error("%s:%d:%d: %s", path, error.line, error.column, error.text);
    json_t *frames = json_object_get(object, "whole frames"), *then = json_object_get(object, "made with");
    const json_t *first = json_object_get(frames, "first"), *next = json_object_get(frames, "next");
    whole[0] = (long)json_integer_value(first), whole[1] = (long)json_integer_value(next);
    int code = CLI_DONE;
    if (!json_is_object(then) || !json_is_integer(first) || !json_is_integer(next) || whole[0] < 0 ||
        whole[1] < whole[0] || whole[1] > FRAME_MAX + 1L)
        code = cli_error("%s: does not tell what frames were made with", path);
    else
        code = compare(command, path, then, manifest->made_with);
    json_decref(object);
    return code;
}

int manifest_resume(const Command *command, const TextList *outputs, long last, Manifest *manifest)
{
    long first = manifest->first, whole[2] = {0, FRAME_MAX + 1L};
    bool found = true;
    for (size_t i = 0; i < outputs->n; ++i) {
        char *path = path_of(outputs->items[i]);
        if (!path) return CLI_WORLD;
        long of_one[2] = {0, 0};
        bool there = access(path, F_OK) == 0;
        int code = there ? read_one(command, path, manifest, of_one) : CLI_DONE;
        free(path);
        if (code != CLI_DONE) return code;
        found = found && there;
        if (of_one[0] > whole[0]) whole[0] = of_one[0];
        if (of_one[1] < whole[1]) whole[1] = of_one[1];
    }
    if (!found || first < whole[0] || first > whole[1]) return CLI_DONE;
    while (manifest->next < whole[1] && manifest->next <= last && frame_outputs_have(outputs, manifest->next))
        ++manifest->next;
    // What was made before is whole still, unless something is missing from here on.
    if (manifest->next == whole[1]) manifest->first = whole[0];
    return CLI_DONE;
}
