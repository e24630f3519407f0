// SPDX-License-Identifier: Apache-2.0
// What every integrator reads and counts.
#ifndef SHEEN_INTEGRATOR_WORK_H
#define SHEEN_INTEGRATOR_WORK_H

#include "base/log.h"
#include "base/pool.h"
#include "base/progress.h"
#include "film/film.h"
#include "film/pixel_filter.h"
#include "gather/radiance.h"
#include "light/light.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "ray/accel.h"
#include "scene/scene.h"

typedef enum SheenSecondary { SHEEN_SECONDARY_CACHE, SHEEN_SECONDARY_PATH } SheenSecondary;

/** What sets the radius of a record: distances of what is around, or second derivatives of its light. */
typedef enum SheenErrorMetric { SHEEN_ERROR_SPLIT_SPHERE, SHEEN_ERROR_HESSIAN } SheenErrorMetric;

/** In which basis radiance records are: by the surface, or all in one. */
typedef enum SheenBasisChoice { SHEEN_BASIS_AUTO, SHEEN_BASIS_ALL_HSH, SHEEN_BASIS_ALL_SH } SheenBasisChoice;

/** Options of a render; sheen_options_default gives the documented defaults. */
typedef struct SheenOptions {
    uint32_t spp;           // samples per pixel
    uint32_t light_samples; // for each shading point; 0: 1 of one light, 2 of each of up to 4, else 4; 1 for `path`
    float noise;            // relative standard error that a pixel gets more samples for; not of `path`; 0: never
    uint32_t bounces;       // indirect bounces; 0 is direct light only
    double time_limit;      // seconds, path only; 0 for none
    float accuracy;         // a: a record is used where w > 1/a
    SheenErrorMetric error_metric;
    float reach_min;         // how far a record reaches on a plane, pixels: at least ...
    float reach_max;         // ... and at most; not less than reach_min
    uint32_t gather_rays;    // rays for each record
    SheenGradient gradients; // of irradiance stratified ones or none
    SheenBasisChoice basis;
    uint32_t order;   // largest of the harmonics of glossy light
    float brdf_error; // of a lobe in harmonics, relative energy; beyond it lobes are sampled
    SheenSecondary secondary;
    bool neighbor_clamping, gradient_clamping;
    bool adaptive;     // records become more accurate until none is told from its neighbors
    float discernible; // least difference that is told, relative to what a point reflects; with `adaptive`
    uint32_t seed;
} SheenOptions;

SheenOptions sheen_options_default(void);

/** Counters and seconds of a render. */
typedef struct SheenStats {
    double time_visibility, time_fill, time_direct, time_interpolate;
    double time_refine; // part of time_fill: where to refine records was found out
    uint64_t rays_camera, rays_shadow, rays_gather, rays_path, rays_specular;
    uint64_t records;          // of the caches that the picture reads: of irradiance ...
    uint64_t radiance_records; // ... and of radiance
    uint64_t deep_records;     // of the light beyond the first bounce
    uint64_t cache_bytes;
    uint64_t refined;  // passes of refinement over the kind of records that took most
    uint32_t passes;   // waves of the fill; passes of `path`
    uint32_t spp_done; // samples of each pixel, at least
    double spp_mean;   // in the mean
    uint64_t nonfinite_samples;
} SheenStats;

/** Adds the counters (not the times) of one worker to a total. */
void sheen_stats_add(SheenStats *total, const SheenStats *part);

/** The inputs of an integrator, all borrowed. */
typedef struct SheenWork {
    const SheenScene *scene;
    const SheenAccel *accel;
    const SheenLights *lights;
    const SheenCamera *camera;
    uint32_t width, height;                // of the picture, may differ from the camera's own
    const SheenPixelFilter *filter;        // NULL: a box
    const struct SheenGlossyCache *glossy; // NULL: glossy light is sampled, not cached
    SheenOptions options;
    SheenPool *pool;
    const atomic_bool *cancel; // may be NULL
    const SheenProgress *progress;
    const SheenLog *log;
} SheenWork;

/** A camera and the picture that it takes, as they are of a SheenWork; borrowed. */
typedef struct SheenView {
    const SheenCamera *camera;
    uint32_t width, height;
    const SheenPixelFilter *filter;
} SheenView;

/** @return the same work for another view. */
static inline SheenWork sheen_work_for(const SheenWork *work, const SheenView *view)
{
    SheenWork w = *work;
    w.camera = view->camera;
    w.width = view->width;
    w.height = view->height;
    w.filter = view->filter;
    return w;
}

/** A camera and the picture that it takes, ready to make rays. */
typedef struct SheenEye {
    Vec3 origin; // of the ray through the upper left corner of the picture; the same for all but for a parallel eye
    Vec3 corner; // from the origin to that corner at distance 1
    Vec3 right, down;    // one pixel's steps there, or of the origin of a parallel eye
    bool parallel;       // orthographic
    float pixel;         // side of a pixel at distance 1, metres; at any distance of a parallel eye
    Vec3 lens_u, lens_v; // radii of the lens, zero for a pinhole
    float focus;         // distance of what is sharp, in the unit of corner
} SheenEye;

/**
 * Number of sample s of a pixel in a sequence over the whole picture: pixels follow each other along a Z-order curve,
 * so that the samples of each aligned square of pixels are stratified together and neighbors' errors cancel. Source:
 * ahmed2020-z-sampler.
 */
uint32_t sheen_sample_index(uint32_t x, uint32_t y, uint32_t per_pixel, uint32_t s);

SheenEye sheen_eye(const SheenCamera *camera, uint32_t width, uint32_t height);

/**
 * The ray through a point of the picture.
 * @param x, y  in pixels, (0, 0) the upper left corner of the picture
 */
static inline Ray sheen_eye_ray(const SheenEye *eye, float x, float y)
{
    if (eye->parallel)
        return (Ray){v3_mad(v3_mad(eye->origin, x, eye->right), y, eye->down), INFINITY, v3_normalize(eye->corner)};
    return (Ray){eye->origin, INFINITY, v3_normalize(v3_mad(v3_mad(eye->corner, x, eye->right), y, eye->down))};
}

static inline bool sheen_eye_has_lens(const SheenEye *eye)
{
    return v3_length2(eye->lens_u) > 0.0f;
}

/** The same from a point of the thin lens, for u in [0, 1)^2: all meet in the plane in focus. Source: cook1984. */
static inline Ray sheen_eye_lens_ray(const SheenEye *eye, float x, float y, Vec2 u)
{
    Vec2 p = warp_disk(u);
    Vec3 offset = v3_mad(v3_scale(eye->lens_u, p.x), p.y, eye->lens_v);
    Vec3 target = v3_scale(v3_mad(v3_mad(eye->corner, x, eye->right), y, eye->down), eye->focus);
    return (Ray){v3_add(eye->origin, offset), INFINITY, v3_normalize(v3_sub(target, offset))};
}

/**
 * The ray of a pixel's sample: its place by the picture's filter, then a point of the lens if there is one.
 * @param sampler   its first dimensions are drawn
 * @param negative  gets whether the sample counts negatively, see sheen_pixel_filter_weights
 */
Ray sheen_camera_ray(const SheenWork *work, const SheenEye *eye, uint32_t x, uint32_t y, SheenSampler *sampler,
                     bool *negative);

/** @return side of a pixel on a surface after a way of that length, metres. */
static inline float sheen_eye_footprint(const SheenEye *eye, float length)
{
    return eye->parallel ? eye->pixel : length * eye->pixel;
}

/**
 * Renders the whole picture into the film and counts into *stats.
 * Errors: SHEEN_ERR_NOMEM, SHEEN_ERR_CANCELLED (the film is then incomplete).
 *
 * What all integrators count as light, with B = options.bounces:
 * - A scattering at a delta lobe (mirror, glass) is no bounce: it is followed, up to SHEEN_PATH_MAX_DELTA times a path.
 *   Emitters seen through delta lobes count fully; delta lights (point, spot, directional without a disk) cannot be
 * seen at all.
 * - Passage through holes (masks) is no scattering, and shadow rays pass them too: light behind them counts as if they
 *   were not there, weakened by their opacity. A way passes SHEEN_PASSAGES_MAX of them.
 * - Every other scattering is one. Light reaches the eye after at most B + 1 of them: B = 0 is direct light only.
 * - A direction on different sides of a surface's geometric and of its shading normal carries nothing.
 *
 * This one is the reference: path tracing with light samples and BSDF samples weighed by the power heuristic;
 * options.light_samples where a path first scatters, one at later vertices. With options.time_limit it
 * makes passes until the next would end too late, whatever options.spp says, at least one. The picture is a function of
 * scene, size, seed and stats->spp_done alone: not of threads and passes. Non-finite samples are counted and add
 * nothing. Layers of the cache stay zero.
 */
SHEEN_NODISCARD SheenStatus sheen_path_render(const SheenWork *work, SheenFilm *film, SheenStats *stats);

#endif
