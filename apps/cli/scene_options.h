// SPDX-License-Identifier: Apache-2.0
// The options of every command that reads a scene file.
#ifndef SHEEN_CLI_SCENE_OPTIONS_H
#define SHEEN_CLI_SCENE_OPTIONS_H

#include "cli.h"

typedef struct SceneValues {
    TextList defines; // NAME=VALUE
    bool strict;
} SceneValues;

/** Of a SceneValues. */
extern const Option scene_options[];

/** @return true when all of --define are NAME=VALUE, or false after a message about the command line. */
bool scene_values_check(const Command *command, const SceneValues *values);

#endif
