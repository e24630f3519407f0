// SPDX-License-Identifier: Apache-2.0
// The picture in the making: weighted sums of each pixel's own samples, and named layers.
#ifndef SHEEN_FILM_FILM_H
#define SHEEN_FILM_FILM_H

#include "base/status.h"
#include "math/vec.h"

#include <stdint.h>

/** Layers that a render can write beside the colour. */
typedef enum SheenAov {
    SHEEN_AOV_DEPTH,     // distance from the camera along the first ray, metres; 0 where nothing is hit
    SHEEN_AOV_POSITION,  // first hit, world space
    SHEEN_AOV_NORMAL,    // shading normal of the first hit, world space
    SHEEN_AOV_ALBEDO,    // of the first hit
    SHEEN_AOV_UV,        // texture coordinates of the first hit; blue is 0
    SHEEN_AOV_PRIMITIVE, // shape, triangle and instance indices of the pixel's first sample
    SHEEN_AOV_DIRECT,    // emitted, specular and direct light: the colour less `indirect`
    SHEEN_AOV_INDIRECT,  // light from the cache, or of paths with more than one scattering
    SHEEN_AOV_RECORDS,   // the cache's records as dots: irradiance records white, radiance records orange
    // Means over the shading points of a pixel's samples that records serve, each counting as one; 0 without any:
    SHEEN_AOV_ACCURACY, // the value of a of the contributing records
    SHEEN_AOV_COVERAGE, // number of contributing records
    SHEEN_AOV_ERROR,    // expected error of what they say of the indirect light, relative, root mean square
    // Shares of a pixel's indirect light by where it was asked for, whatever came of it: of radiance records (red), of
    // irradiance records (green), and by following a ray along a mirror, glass or a sampled glossy lobe (blue). Each
    // question counts as one; 0 where nothing was asked.
    SHEEN_AOV_TRANSPORT,
    SHEEN_AOV_COUNT
} SheenAov;

/** Name, number of channels and channel letters of a layer. */
typedef struct SheenAovInfo {
    const char *name;
    unsigned n_channels;
    const char *suffixes;
} SheenAovInfo;
extern const SheenAovInfo sheen_aov_info[SHEEN_AOV_COUNT];

typedef struct SheenFilm {
    uint32_t width, height;
    Rgb *color;                  // [height][width]
    float *aov[SHEEN_AOV_COUNT]; // [height][width][n_channels], NULL for layers that nobody asked for
} SheenFilm;

/** @param aovs  bit 1 << SheenAov for each layer wanted. All values start at zero. */
SHEEN_NODISCARD SheenStatus sheen_film_create(uint32_t width, uint32_t height, unsigned aovs, SheenFilm **out);
void sheen_film_destroy(SheenFilm **film);

/** Adds `value` to a layer's pixel when the layer is wanted; one-channel layers take value.r. */
static inline void film_add(SheenFilm *film, SheenAov aov, uint32_t x, uint32_t y, Rgb value)
{
    float *layer = film->aov[aov];
    if (!layer) return;
    unsigned n = sheen_aov_info[aov].n_channels;
    float *px = layer + ((uint64_t)y * film->width + x) * n;
    px[0] += value.r;
    if (n == 3) px[1] += value.g, px[2] += value.b;
}

#endif
