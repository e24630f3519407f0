// SPDX-License-Identifier: Apache-2.0
#include "io/camera_path_file.h"

#include "image/whole_file.h"
#include "io/json_place.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE (3.14159265358979323846 / 180.0)

// Beyond these a float has no room for a square, an angle no picture.
static const double coordinate_max = 1e15, frame_max = 1e9, fov_min = 1e-3, fov_max = 179.9;
// A file for days of film has some thousands.
enum { keys_max = 1 << 20, unknown_max = 16 };

/** A file in reading. Functions stop at the first error, which is in `status`. */
typedef struct Reader {
    const char *text, *name;
    size_t size;
    const SheenLog *log;
    SheenStatus status;
    json_t *unknown; // names that were warned about
} Reader;

/** Fails at a value; `member` NULL is the key itself. */
static void fail(Reader *r, size_t key, const char *member, const char *what)
{
    JsonPlace at =
        sheen_json_place(r->text, r->size, (const JsonStep[]){{"keys", 0}, {NULL, key}, {member, 0}}, member ? 3 : 2);
    r->status = sheen_fail(r->log, SHEEN_ERR_PARSE, "%s:%d:%d: key %zu: %s", r->name, at.line, at.column, key, what);
}

/** Warns about members that are not in `known`, each name once. @param steps  [n] to the object */
static void warn_unknown(Reader *r, json_t *object, const char *const known[], const JsonStep steps[], size_t n)
{
    const char *name;
    json_t *value;
    json_object_foreach(object, name, value)
    {
        bool is_known = false;
        for (const char *const *k = known; *k; ++k) is_known = is_known || strcmp(name, *k) == 0;
        if (is_known || json_object_get(r->unknown, name) || json_object_size(r->unknown) == unknown_max) continue;
        json_object_set_new(r->unknown, name, json_true());
        JsonStep to[3] = {0};
        for (size_t i = 0; i < n; ++i) to[i] = steps[i];
        to[n].member = name;
        JsonPlace at = sheen_json_place(r->text, r->size, to, n + 1);
        sheen_warn(r->log, "%s:%d:%d: '%.60s' is not known and is left out", r->name, at.line, at.column, name);
    }
}

static double read_number(Reader *r, size_t key, const json_t *object, const char *name, double lo, double hi)
{
    const json_t *value = json_object_get(object, name);
    double x = json_number_value(value);
    char what[120];
    if (json_is_number(value) && x >= lo && x <= hi) return x;
    if (value)
        snprintf(what, sizeof what, "'%s' is not a number from %.10g to %.10g", name, lo, hi);
    else
        snprintf(what, sizeof what, "'%s' is missing", name);
    fail(r, key, value ? name : NULL, what);
    return 0.0;
}

static void read_vector(Reader *r, size_t key, const json_t *object, const char *name, double out[3])
{
    const json_t *value = json_object_get(object, name);
    char what[120];
    bool fine = json_is_array(value) && json_array_size(value) == 3;
    for (size_t i = 0; fine && i < 3; ++i) {
        const json_t *x = json_array_get(value, i);
        out[i] = json_number_value(x);
        fine = json_is_number(x) && fabs(out[i]) <= coordinate_max;
    }
    if (fine) return;
    if (value)
        snprintf(what, sizeof what, "'%s' is not three numbers up to %g", name, coordinate_max);
    else
        snprintf(what, sizeof what, "'%s' is missing", name);
    fail(r, key, value ? name : NULL, what);
}

/** Tells what is wrong with a key as a whole, at the member that is most likely meant. */
static void check_key(Reader *r, size_t i, const json_t *object, const SheenCameraKey *keys)
{
    SheenCameraFault fault = sheen_camera_key_fault(&keys[i]);
    char what[120];
    if (i > 0 && !(keys[i].frame > keys[i - 1].frame)) {
        snprintf(what, sizeof what, "frame %.10g does not follow frame %.10g", keys[i].frame, keys[i - 1].frame);
        fail(r, i, "frame", what);
    } else if (fault) {
        bool up = fault == SHEEN_CAMERA_UP_ALONG_VIEW && json_object_get(object, "up");
        snprintf(what, sizeof what, "the camera %s", sheen_camera_fault_text(fault));
        fail(r, i, up ? "up" : "target", what);
    }
}

static void read_key(Reader *r, json_t *object, size_t i, const SheenCameraKey *standard, SheenCameraKey *keys)
{
    static const char *const known[] = {"frame", "origin", "target", "up", "fov", NULL};
    if (!json_is_object(object)) {
        fail(r, i, NULL, "is not an object");
        return;
    }
    SheenCameraKey *key = &keys[i];
    *key = *standard;
    key->frame = read_number(r, i, object, "frame", -frame_max, frame_max);
    if (!r->status) read_vector(r, i, object, "origin", key->origin);
    if (!r->status) read_vector(r, i, object, "target", key->target);
    if (!r->status && json_object_get(object, "up")) read_vector(r, i, object, "up", key->up);
    if (!r->status && json_object_get(object, "fov"))
        key->fov = DEGREE * read_number(r, i, object, "fov", fov_min, fov_max);
    if (!r->status) check_key(r, i, object, keys);
    if (!r->status) warn_unknown(r, object, known, (const JsonStep[]){{"keys", 0}, {NULL, i}}, 2);
}

static SheenStatus read_path(Reader *r, json_t *root, const SheenCamera *base, SheenCameraPath **out)
{
    static const char *const known[] = {"keys", NULL};
    json_t *list = json_object_get(root, "keys");
    size_t n = json_array_size(list);
    if (n == 0 || n > keys_max) {
        JsonPlace at = sheen_json_place(r->text, r->size, (const JsonStep[]){{"keys", 0}}, 1);
        return sheen_fail(r->log, SHEEN_ERR_PARSE, "%s:%d:%d: a camera path is {\"keys\": [...]} with 1 to %d keys",
                          r->name, at.line, at.column, keys_max);
    }
    const SheenCameraKey standard = sheen_camera_key_of(base);
    SheenCameraKey *keys = malloc(n * sizeof *keys);
    if (!keys) return SHEEN_ERR_NOMEM;
    for (size_t i = 0; i < n && !r->status; ++i) read_key(r, json_array_get(list, i), i, &standard, keys);
    if (!r->status) warn_unknown(r, root, known, NULL, 0);
    if (!r->status) r->status = sheen_camera_path_create(base, keys, n, out);
    free(keys);
    return r->status;
}

SheenStatus sheen_camera_path_parse(const char *text, size_t size, const char *name, const SheenCamera *base,
                                    const SheenLog *log, SheenCameraPath **out)
{
    *out = NULL;
    json_error_t error;
    json_t *root = json_loadb(text, size, JSON_REJECT_DUPLICATES, &error);
    if (!root)
        return sheen_fail(log, json_error_code(&error) == json_error_out_of_memory ? SHEEN_ERR_NOMEM : SHEEN_ERR_PARSE,
                          "%s:%d:%d: %s", name, error.line, error.column, error.text);
    Reader reader = {.text = text, .name = name, .size = size, .log = log, .unknown = json_object()};
    SheenStatus status = read_path(&reader, root, base, out);
    json_decref(reader.unknown);
    json_decref(root);
    return status == SHEEN_ERR_NOMEM ? sheen_fail(log, status, "%s: out of memory", name) : status;
}

SheenStatus sheen_camera_path_read(const char *path, const SheenCamera *base, const SheenLog *log,
                                   SheenCameraPath **out)
{
    *out = NULL;
    uint8_t *data;
    size_t size;
    SheenStatus status = sheen_file_read(path, log, &data, &size);
    if (status) return status;
    status = sheen_camera_path_parse((const char *)data, size, path, base, log, out);
    free(data);
    return status;
}
