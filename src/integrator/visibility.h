// SPDX-License-Identifier: Apache-2.0
// Pass 1: rays from the eye, through mirrors and glass, end in shading points.
#ifndef SHEEN_INTEGRATOR_VISIBILITY_H
#define SHEEN_INTEGRATOR_VISIBILITY_H

#include "integrator/glossy_cache.h"
#include "integrator/picture.h"
#include "integrator/seen_points.h"

/** A rectangle of the picture. */
typedef struct Tile {
    uint32_t x, y, width, height;
} Tile;

enum { SHEEN_TILE_SIDE = 16 };
uint32_t sheen_tile_count(const SheenWork *work);
Tile sheen_tile(const SheenWork *work, uint32_t index);

/** A ray on its way. */
typedef struct EyeRay {
    Ray ray;
    Rgb throughput;
    float weight;        // of the sample in the mean of its pixel's samples, by the filter; may be negative
    float length;        // of the way so far
    float blur, blurred; // by glossy reflections: what a pixel grows by a metre, and has grown
    float footprint;     // side of a pixel's square where the ray arrived, metres
    uint32_t pixel, sample, branch, depth;
    uint32_t passages; // through holes, which do not count as depth
    bool gathered;     // went along a glossy reflection
    bool competes;     // the last of its way but passages did, from `origin`
    GlossyOrigin origin;
} EyeRay;

/** Samples of pixels that are traced together. */
typedef struct SampleRange {
    uint32_t first, n;    // [first, first + n) of each pixel ...
    const uint32_t *ends; // [pixels] ... below its own end; NULL: all of them
} SampleRange;

/** Sets the ends of one sample of every stride-th pixel both ways, of no other. @param ends  [height][width] */
void sheen_every_pixel(uint32_t stride, uint32_t width, uint32_t height, uint32_t ends[]);

/** Buffers and result of one worker. */
typedef struct Visibility {
    SeenPoints seen;
    // scratch
    SheenFilm *film; // whose layer counts the rays that are followed; may be NULL
    GlossyLobe lobe;
    EyeRay *rays[2];
    size_t n_rays[2], rays_capacity[2];
    Ray *batch;
    Hit *hits;
    size_t batch_capacity;
} Visibility;

void sheen_visibility_free(Visibility *v);

/**
 * Traces samples of each pixel of a tile. v->seen then holds what they see, sample by sample. Glossy lobes that
 * work->glossy holds become glossy points; without a picture, without their lobes.
 * At masks what passes and what does not are both followed, at glass and below coats all ways three times, after that
 * one of them is chosen. Of a glossy reflection one ray is followed; behind it, as behind three branchings, surfaces
 * are what sheen_step makes of them.
 * @param picture  emitted light, the sky and what light samples find on surfaces that are not Lambert's alone are
 *                 added to the colour, and first hits to the layers; NULL to find the points only
 * @return false when out of memory
 */
bool sheen_visibility_trace(const SheenWork *work, const Tile *tile, SampleRange range, Picture *picture, Visibility *v,
                            SheenStats *stats);

#endif
