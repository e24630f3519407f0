// SPDX-License-Identifier: Apache-2.0
#include "scene/camera_path.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

struct SheenCameraPath {
    SheenCamera base;
    SheenCameraKey *keys; // [n]
    size_t n;
};

// A direction between points that are nearer to each other than this, relative to their coordinates, is rounding error.
static const double least_distance = 1e-9;
// Sine of the angle between view and up below which the picture's upright would turn at random.
static const double least_sine = 1e-4;
// Longest tangents, in chords, for which a cubic between two values does not leave them. Source: fritsch1980.
static const double longest_tangent = 3.0;

const char *sheen_camera_fault_text(SheenCameraFault fault)
{
    switch (fault) {
    case SHEEN_CAMERA_AT_TARGET:
        return "stands where it looks";
    case SHEEN_CAMERA_UP_ALONG_VIEW:
        return "has its up along its view";
    case SHEEN_CAMERA_BAD_ANGLE:
        return "has no field of view";
    case SHEEN_CAMERA_FINE:
        break;
    }
    return "is fine";
}

static double length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/** The unit vector of `from` to `to`. @return false when there is none */
static bool direction(const double from[3], const double to[3], double out[3])
{
    for (int i = 0; i < 3; ++i) out[i] = to[i] - from[i];
    double distance = length(out);
    if (!(distance > least_distance * (length(from) + length(to))) || !isfinite(distance)) return false;
    for (int i = 0; i < 3; ++i) out[i] /= distance;
    return true;
}

/** Finds view and up as unit vectors. */
static SheenCameraFault orient(const SheenCameraKey *key, double view[3], double up[3])
{
    static const double zero[3] = {0.0, 0.0, 0.0};
    if (!direction(key->origin, key->target, view)) return SHEEN_CAMERA_AT_TARGET;
    if (!direction(zero, key->up, up)) return SHEEN_CAMERA_UP_ALONG_VIEW;
    double across[3] = {view[1] * up[2] - view[2] * up[1], view[2] * up[0] - view[0] * up[2],
                        view[0] * up[1] - view[1] * up[0]};
    return length(across) > least_sine ? SHEEN_CAMERA_FINE : SHEEN_CAMERA_UP_ALONG_VIEW;
}

SheenCameraFault sheen_camera_key_fault(const SheenCameraKey *key)
{
    double view[3], up[3];
    SheenCameraFault fault = orient(key, view, up);
    if (fault) return fault;
    return key->fov >= 0.0 && key->fov < (double)SHEEN_PI ? SHEEN_CAMERA_FINE : SHEEN_CAMERA_BAD_ANGLE;
}

SheenCameraKey sheen_camera_key_of(const SheenCamera *camera)
{
    const float level = 1e-3f; // sine; a scene file's own rounding is far below
    Vec3 right = v3_normalize(transform_vector(&camera->to_world, v3(1, 0, 0)));
    Vec3 up = v3_normalize(transform_vector(&camera->to_world, v3(0, 1, 0)));
    float r[3] = {right.x, right.y, right.z}, u[3] = {up.x, up.y, up.z};
    SheenCameraKey key = {.up = {up.x, up.y, up.z}, .fov = camera->fov_x};
    int axis = -1;
    for (int i = 0; i < 3; ++i)
        if (fabsf(r[i]) < level && fabsf(u[i]) > level && (axis < 0 || fabsf(u[i]) > fabsf(u[axis]))) axis = i;
    for (int i = 0; axis >= 0 && i < 3; ++i) key.up[i] = i == axis ? copysign(1.0, (double)u[i]) : 0.0;
    return key;
}

SheenStatus sheen_camera_path_create(const SheenCamera *base, const SheenCameraKey *keys, size_t n,
                                     SheenCameraPath **out)
{
    *out = NULL;
    assert(n >= 1);
    SheenCameraPath *path = malloc(sizeof *path);
    SheenCameraKey *copy = n <= SIZE_MAX / sizeof *copy ? malloc(n * sizeof *copy) : NULL;
    if (!path || !copy) {
        free(path);
        free(copy);
        return SHEEN_ERR_NOMEM;
    }
    memcpy(copy, keys, n * sizeof *copy);
    *path = (SheenCameraPath){*base, copy, n};
    *out = path;
    return SHEEN_OK;
}

void sheen_camera_path_destroy(SheenCameraPath **path)
{
    if (!*path) return;
    free((*path)->keys);
    free(*path);
    *path = NULL;
}

void sheen_camera_path_range(const SheenCameraPath *path, double *first, double *last)
{
    *first = path->keys[0].frame;
    *last = path->keys[path->n - 1].frame;
}

// ---- the curve --------------------------------------------------------------------------------------------------

/** One of the curves of a path: `n` numbers at `offset` of each key. */
typedef struct Channel {
    const SheenCameraPath *path;
    size_t offset;
    int n;
    bool bounded; // does not leave the values of two keys between them
} Channel;

static const double *value(const Channel *c, size_t key)
{
    return (const double *)((const char *)&c->path->keys[key] + c->offset);
}

/** Velocity of the chord from a key to the next, a frame. @return its length */
static double chord(const Channel *c, size_t key, double out[3])
{
    const double *a = value(c, key), *b = value(c, key + 1);
    double h = c->path->keys[key + 1].frame - c->path->keys[key].frame, sum = 0.0;
    for (int i = 0; i < c->n; ++i) {
        out[i] = (b[i] - a[i]) / h;
        sum += out[i] * out[i];
    }
    return sqrt(sum);
}

/** Velocity at a key, a frame. */
static void tangent(const Channel *c, size_t key, double out[3])
{
    const SheenCameraKey *keys = c->path->keys;
    size_t n = c->path->n;
    bool first = key == 0, last = key + 1 == n;
    // The chords before and after; at an end that one and the next inwards.
    size_t a = first ? 0 : last ? n - 2 : key - 1, b = first ? (n > 2 ? 1 : 0) : last ? (n > 2 ? n - 3 : n - 2) : key;
    double u[3], v[3];
    double least = chord(c, a, u), other = chord(c, b, v);
    double ha = keys[a + 1].frame - keys[a].frame, hb = keys[b + 1].frame - keys[b].frame;
    // The parabola's slope at a chord's middle is the chord's; it is linear in time.
    double weight = first || last ? -ha / (ha + hb) : ha / (ha + hb);
    if (!first && !last) least = fmin(least, other);
    double size = 0.0;
    for (int i = 0; i < c->n; ++i) {
        out[i] = u[i] + weight * (v[i] - u[i]);
        if (c->bounded && (out[i] * u[i] <= 0.0 || (!first && !last && u[i] * v[i] <= 0.0))) out[i] = 0.0;
        size += out[i] * out[i];
    }
    size = sqrt(size);
    if (!(size > longest_tangent * least)) return;
    for (int i = 0; i < c->n; ++i) out[i] *= longest_tangent * least / size;
}

/** The curve between a key and the next. @param t  of the way in time, [0, 1] */
static void evaluate(const Channel *c, size_t key, double t, double out[3])
{
    const double *a = value(c, key), *b = value(c, key + 1);
    double h = c->path->keys[key + 1].frame - c->path->keys[key].frame;
    double u[3], v[3];
    tangent(c, key, u);
    tangent(c, key + 1, v);
    double s = 1.0 - t;
    for (int i = 0; i < c->n; ++i)
        out[i] = a[i] * s * s * (1.0 + 2.0 * t) + b[i] * t * t * (1.0 + 2.0 * s) + h * t * s * (u[i] * s - v[i] * t);
}

static SheenCameraKey key_at(const SheenCameraPath *path, double frame)
{
    if (!(frame > path->keys[0].frame)) return path->keys[0];
    if (frame >= path->keys[path->n - 1].frame) return path->keys[path->n - 1];
    size_t lo = 0, hi = path->n - 1; // keys[lo].frame <= frame < keys[hi].frame
    while (hi - lo > 1) {
        size_t middle = lo + (hi - lo) / 2;
        if (path->keys[middle].frame <= frame)
            lo = middle;
        else
            hi = middle;
    }
    SheenCameraKey key = {.frame = frame};
    double t = (frame - path->keys[lo].frame) / (path->keys[hi].frame - path->keys[lo].frame);
    evaluate(&(Channel){path, offsetof(SheenCameraKey, origin), 3, false}, lo, t, key.origin);
    evaluate(&(Channel){path, offsetof(SheenCameraKey, target), 3, false}, lo, t, key.target);
    evaluate(&(Channel){path, offsetof(SheenCameraKey, up), 3, false}, lo, t, key.up);
    double fov[3];
    evaluate(&(Channel){path, offsetof(SheenCameraKey, fov), 1, true}, lo, t, fov);
    key.fov = fov[0];
    return key;
}

/** Lengths of a camera's axes: what lens, film and mirroring are scaled by. */
static Transform scale_of(const Transform *t)
{
    double side = transform_determinant(t) < 0.0 ? -1.0 : 1.0, axes[3];
    for (int i = 0; i < 3; ++i) axes[i] = length((const double[3]){t->m[0][i], t->m[1][i], t->m[2][i]});
    return transform_scale(side * axes[0], axes[1], axes[2]);
}

SheenCameraFault sheen_camera_path_at(const SheenCameraPath *path, double frame, SheenCamera *out)
{
    SheenCameraKey key = key_at(path, frame);
    double z[3], up[3];
    SheenCameraFault fault = orient(&key, z, up);
    if (fault) return fault;
    Transform look = transform_look_at(v3(0, 0, 0), v3((float)z[0], (float)z[1], (float)z[2]),
                                       v3((float)up[0], (float)up[1], (float)up[2]));
    SheenCamera camera = path->base;
    camera.to_world = transform_mul(look, scale_of(&path->base.to_world));
    for (int i = 0; i < 3; ++i) camera.to_world.m[i][3] = key.origin[i];
    if (!camera.orthographic) camera.fov_x = (float)key.fov;
    *out = camera;
    return SHEEN_CAMERA_FINE;
}
