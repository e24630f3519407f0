// SPDX-License-Identifier: Apache-2.0
#include "scene_options.h"

#include "io/defines.h"

const Option scene_options[] = {
    {.kind = OPTION_TEXTS,
     .letter = 'D',
     .name = "define",
     .argument = "NAME=VALUE",
     .meaning = "The value of $NAME in a Mitsuba scene, before what its <default> says. May be given several times.",
     .standard = "what the scene says",
     .example = "-D spp=64",
     .recorded = true,
     .offset = offsetof(SceneValues, defines)},
    {.kind = OPTION_FLAG,
     .name = "strict",
     .meaning = "Take warnings, such as about parts of a scene that are not supported, for errors.",
     .example = "--strict",
     .offset = offsetof(SceneValues, strict)},
    {0},
};

bool scene_values_check(const Command *command, const SceneValues *values)
{
    for (size_t i = 0; i < values->defines.n; ++i) {
        if (sheen_define_is_valid(values->defines.items[i])) continue;
        cli_usage_error(command, "--define: '%s' is not NAME=VALUE", values->defines.items[i]);
        return false;
    }
    return true;
}
