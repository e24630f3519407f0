// SPDX-License-Identifier: Apache-2.0
#include "picture_file.h"

#include "frame_name.h"
#include "options_json.h"

#include "image/image.h"
#include "io/file_path.h"

#include <stdlib.h>

bool picture_notes_make(const Run *run, PictureNotes *notes)
{
    *notes = (PictureNotes){.scene = path_last_part(run->scene_path)};
    snprintf(notes->seed, sizeof notes->seed, "%u", run->values->seed);
    json_t *options = options_json(run->command->options, run->all_values);
    notes->options = options ? json_dumps(options, JSON_COMPACT | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(options);
    return notes->options != NULL;
}

void picture_notes_free(PictureNotes *notes)
{
    free(notes->options);
    notes->options = NULL;
}

SheenStatus picture_file_write(const Run *run, const char *path, const SheenFilm *film, const PictureNotes *notes)
{
    SheenAttribute attributes[] = {
        {"sheen.version", SHEEN_VERSION},  {"sheen.scene", notes->scene}, {"sheen.seed", notes->seed},
        {"sheen.options", notes->options}, {"sheen.frame", notes->frame},
    };
    size_t n_attributes = sizeof attributes / sizeof *attributes;
    SheenLayer layers[SHEEN_AOV_COUNT];
    size_t n_layers = 0;
    for (int a = 0; a < SHEEN_AOV_COUNT; ++a) {
        const SheenAovInfo *info = &sheen_aov_info[a];
        if (film->aov[a]) layers[n_layers++] = (SheenLayer){info->name, info->n_channels, info->suffixes, film->aov[a]};
    }
    SheenImageView view = {
        .width = film->width,
        .height = film->height,
        .pixels = film->color,
        .layers = layers,
        .n_layers = n_layers,
        .attributes = attributes,
        .n_attributes = *notes->frame ? n_attributes : n_attributes - 1,
    };
    return sheen_image_write(path, &view, (float)run->values->exposure, &run->log);
}

static bool has_layers(const char *path)
{
    return sheen_path_has_ending(path, ".exr");
}

bool picture_files_have_layers(const TextList *paths)
{
    for (size_t i = 0; i < paths->n; ++i)
        if (has_layers(paths->items[i])) return true;
    return false;
}
