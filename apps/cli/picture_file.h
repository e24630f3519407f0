// SPDX-License-Identifier: Apache-2.0
// A rendered film becomes picture files that tell how they were made.
#ifndef SHEEN_CLI_PICTURE_FILE_H
#define SHEEN_CLI_PICTURE_FILE_H

#include "run.h"

/** What is written about a picture beside its pixels; nothing that may differ between two runs for the same picture. */
typedef struct PictureNotes {
    char *options; // the recorded options as JSON, from malloc
    char seed[16];
    char frame[16]; // "" for a picture that stands alone
    const char *scene;
} PictureNotes;

/** @return false when out of memory; free with picture_notes_free in either case. */
bool picture_notes_make(const Run *run, PictureNotes *notes);
void picture_notes_free(PictureNotes *notes);

/** Writes the film with its layers and notes; PNG files by --exposure. */
SheenStatus picture_file_write(const Run *run, const char *path, const SheenFilm *film, const PictureNotes *notes);

/** @return whether some path ends in .exr, which has layers. */
bool picture_files_have_layers(const TextList *paths);

#endif
