// SPDX-License-Identifier: Apache-2.0
#include "film/film.h"

#include <stdlib.h>

const SheenAovInfo sheen_aov_info[SHEEN_AOV_COUNT] = {
    [SHEEN_AOV_DEPTH] = {"depth", 1, "Z"},
    [SHEEN_AOV_POSITION] = {"position", 3, "XYZ"},
    [SHEEN_AOV_NORMAL] = {"normal", 3, "XYZ"},
    [SHEEN_AOV_ALBEDO] = {"albedo", 3, "RGB"},
    [SHEEN_AOV_UV] = {"uv", 3, "UVW"},
    [SHEEN_AOV_PRIMITIVE] = {"primitive", 3, "XYZ"},
    [SHEEN_AOV_DIRECT] = {"direct", 3, "RGB"},
    [SHEEN_AOV_INDIRECT] = {"indirect", 3, "RGB"},
    [SHEEN_AOV_RECORDS] = {"records", 3, "RGB"},
    [SHEEN_AOV_ACCURACY] = {"accuracy", 1, "V"},
    [SHEEN_AOV_COVERAGE] = {"coverage", 1, "V"},
    [SHEEN_AOV_ERROR] = {"error", 1, "V"},
    [SHEEN_AOV_TRANSPORT] = {"transport", 3, "RGB"},
};

SheenStatus sheen_film_create(uint32_t width, uint32_t height, unsigned aovs, SheenFilm **out)
{
    *out = NULL;
    SheenFilm *film = calloc(1, sizeof *film);
    if (!film) return SHEEN_ERR_NOMEM;
    film->width = width;
    film->height = height;
    size_t n = (size_t)width * height;
    film->color = calloc(n, sizeof *film->color);
    bool ok = film->color != NULL;
    for (int a = 0; a < SHEEN_AOV_COUNT; ++a) {
        if (!(aovs >> a & 1u)) continue;
        film->aov[a] = calloc(n * sheen_aov_info[a].n_channels, sizeof(float));
        ok = ok && film->aov[a];
    }
    if (!ok) {
        sheen_film_destroy(&film);
        return SHEEN_ERR_NOMEM;
    }
    *out = film;
    return SHEEN_OK;
}

void sheen_film_destroy(SheenFilm **film)
{
    if (!film || !*film) return;
    free((*film)->color);
    for (int a = 0; a < SHEEN_AOV_COUNT; ++a) free((*film)->aov[a]);
    free(*film);
    *film = NULL;
}
