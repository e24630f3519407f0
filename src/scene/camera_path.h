// SPDX-License-Identifier: Apache-2.0
// A camera that moves: keys at frames, and a smooth curve through them.
#ifndef SHEEN_SCENE_CAMERA_PATH_H
#define SHEEN_SCENE_CAMERA_PATH_H

#include "base/status.h"
#include "scene/scene.h"

#include <stddef.h>

/** Where the camera is at a frame, and what it looks at. */
typedef struct SheenCameraKey {
    double frame;
    double origin[3], target[3]; // world space, metres
    double up[3];                // of any length but zero
    double fov;                  // as SheenCamera.fov_x, radians; says nothing for an orthographic camera
} SheenCameraKey;

/** Why there is no picture from a key, or from a place between two. */
typedef enum SheenCameraFault {
    SHEEN_CAMERA_FINE,
    SHEEN_CAMERA_AT_TARGET,
    SHEEN_CAMERA_UP_ALONG_VIEW,
    SHEEN_CAMERA_BAD_ANGLE // the field of view is not in (0, pi)
} SheenCameraFault;

typedef struct SheenCameraPath SheenCameraPath;

/** @return what is wrong, after "the camera ...": "stands where it looks"; a literal */
const char *sheen_camera_fault_text(SheenCameraFault fault);

SheenCameraFault sheen_camera_key_fault(const SheenCameraKey *key);

/**
 * What a key has of a camera where it says nothing else: up and fov. Up is the axis of the world about which the camera
 * stands level, if there is one, so that it stays level when it turns; else the camera's own.
 */
SheenCameraKey sheen_camera_key_of(const SheenCamera *camera);

/**
 * @param base  has what keys do not tell: size, filter, lens, kind, and the scale of its transform, which may mirror
 * @param keys  [n], n >= 1, copied; ascending by frame, none with a fault
 * @param out   owned by the caller; borrows base->name. NULL on failure
 * Errors: SHEEN_ERR_NOMEM.
 */
SHEEN_NODISCARD SheenStatus sheen_camera_path_create(const SheenCamera *base, const SheenCameraKey *keys, size_t n,
                                                     SheenCameraPath **out);

/** NULL-safe; sets *path to NULL. */
void sheen_camera_path_destroy(SheenCameraPath **path);

/** The frames of the first and of the last key. */
void sheen_camera_path_range(const SheenCameraPath *path, double *first, double *last);

/**
 * The camera at a frame, which may lie between two; before the first and after the last key it stands still.
 *
 * Origin, target and up follow cubics between the keys, with one velocity on both sides of a key: that of the parabola
 * through the key and its neighbors (at an end through the three last), no longer than three times the slower of the
 * chords beside it. So
 * - the path goes through the keys exactly, and turns with the keys when they are turned;
 * - keys on a parabola in time give that parabola, two keys a straight line at constant speed;
 * - where two keys have one place the camera stands still between them, and moves off and arrives softly.
 * The field of view moves so too, but never beyond the values of the keys beside it.
 *
 * @param out  not changed when there is a fault, which can be between keys that have none
 * Source: catmull1974 (curves through points from neighbors' chords), fritsch1980 (the limit of three chords).
 */
SheenCameraFault sheen_camera_path_at(const SheenCameraPath *path, double frame, SheenCamera *out);

#endif
