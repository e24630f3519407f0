// SPDX-License-Identifier: Apache-2.0
// A gather's rays: what the hemisphere above a point holds, as radiance per stratum and vertices that wait for light.
#ifndef SHEEN_INTEGRATOR_HEMISPHERE_H
#define SHEEN_INTEGRATOR_HEMISPHERE_H

#include "gather/estimate.h"
#include "integrator/direct.h"
#include "integrator/hot_spot.h"

/** A scattering point that a gather sees: it sends weight times its irradiance toward the gather's point. */
typedef struct GatherVertex {
    DiffusePoint point;
    Rgb weight;       // radiance in the cell per irradiance at the vertex, 1/sr
    uint32_t cell;    // stratum that it belongs to
    uint32_t ray;     // number in the gather: keys the random numbers
    float distance;   // length of the way from the vertex before, metres
    unsigned bounces; // b: the light wanted here is direct light and b - 1 bounces; 0: the sky alone
    bool lit;         // its direct light is in L
    bool turns;       // what it sends comes from `onward` alone: weight / (1/pi) of the radiance there
    Vec3 onward;
} GatherVertex;

/** Further rays of a gather are at most so many times its strata. */
enum { SHEEN_FURTHER_MAX = 3 };

/** A ray of a gather beside the first of each stratum. */
typedef struct GatherRay {
    Vec3 d; // local
    uint32_t cell;
    float weight; // of its radiance in the cell's mean
} GatherRay;

/** Buffers of one worker, and the gather that they hold. */
typedef struct Hemisphere {
    SheenStrata strata;
    Frame frame;             // the local frame of `directions`
    uint32_t key;            // of all random numbers of this gather
    Guide guide;             // hot spots, for rays beside the first of each stratum
    Vec3 *directions;        // [cells] local
    Rgb *L;                  // [cells] radiance so far
    Rgb *caustic;            // [cells] radiance of emitters seen through mirrors and glass
    unsigned char *specular; // [cells] 1 where a mirror or glass lay on the way
    Rgb *glossy; // [cells] where direct light on rough glossy surfaces is added: L, h->apart, or NULL when these are
                 // taken for Lambertian
    float *distance; // [cells] to what sends it; INFINITY for the sky
    Vec3 *normals;   // [cells] local, of what sends it, toward the point; along the ray for the sky
    GatherVertex *vertices;
    size_t n_vertices;
    float error; // relative standard error of the irradiance that sheen_hemisphere_refine expects
    // scratch
    uint32_t *extra;          // [cells] rays beside the first
    GatherRay *further;       // [SHEEN_FURTHER_MAX cells] those, and the ones into cones
    float *value, *deviation; // [cells]
    Rgb *mirrored;            // [cells]
    Rgb *apart;               // [cells] for h->glossy
    uint32_t *through;        // cells whose ray came to a mirror or a pane
    uint32_t caustic_rays;    // rays in each of them
    float *sorted;            // [cells]
    GatherVertex *moved;
    Ray *rays;
    Hit *hits;
    DiffusePoint *points;
    LightNumbers *numbers;
    Rgb *irradiance; // [vertices] direct
    DirectScratch direct;
    size_t cells, capacity; // allocated
} Hemisphere;

/** @return false when out of memory. */
bool sheen_hemisphere_reserve(Hemisphere *h, SheenStrata strata);
void sheen_hemisphere_free(Hemisphere *h);

/** Begins a gather at a point: its frame and its key. It has no hot spots until sheen_guide_choose gives it some, and
 *  takes glossy surfaces for Lambertian unless h->glossy is set. */
void sheen_hemisphere_begin(const DiffusePoint *point, uint32_t key, Hemisphere *h);

/**
 * Traces the fan over a point, in sector order, and fills everything but the light at the vertices.
 * Directions below the geometric surface, which a shading normal tilts there, are mirrored to above it.
 * @param bounces  b of the vertices
 */
void sheen_hemisphere_trace(const SheenWork *work, const DiffusePoint *point, unsigned bounces, Hemisphere *h,
                            SheenStats *stats);

/**
 * Chooses where more rays are worth most, and traces them: into the cones about hot spots, and into strata whose
 * neighbors differ. Both are told by other rays than those that they refine. L and caustic become means over all rays,
 * weighed by the balance heuristic (veach1995-combining): a ray along d has the weight of the strata's density over
 * that of all rays that may go there. The new vertices, which replace the old, wait for light.
 * @param bounces  b of the vertices
 * @param error    relative standard error of the irradiance that is enough
 * @return the number of rays; at most SHEEN_FURTHER_MAX times the cells
 */
size_t sheen_hemisphere_refine(const SheenWork *work, const DiffusePoint *point, unsigned bounces, float error,
                               Hemisphere *h, SheenStats *stats);

/**
 * Moves vertices on by one ray, after their direct light has been added to L: those of glossy lobes along these,
 * and those nearer than `near` to their predecessor along a ray that is cosine-weighted or toward a hot spot. What the
 * ray finds becomes a vertex in their place. The others keep their place and order.
 * @param near  metres; INFINITY moves all
 * @return the number of vertices moved
 */
size_t sheen_hemisphere_extend(const SheenWork *work, float near, Hemisphere *h, SheenStats *stats);

/** Adds the direct light at vertices [first, n_vertices) to L: of few lights one sample of each, else `samples` of
 * lights that are chosen. */
void sheen_hemisphere_direct(const SheenWork *work, size_t first, uint32_t samples, Hemisphere *h, SheenStats *stats);

/**
 * Ends a gather: adds the caustics to L. Of lamps seen through mirrors and glass a ray brings at most twice the mean of
 * the cells, the light straight from lamps on `point` included, and surfaces seen so are cut to 8 times the mean: what
 * a single ray finds there is noise that a cache would spread over a wide splotch. What one cell in 64 sees is not cut,
 * nor the soft sky. Energy that is cut is lost: small lamps inside glass are too weak.
 * @param noisier  times by which both limits are higher
 */
void sheen_hemisphere_add_caustics(const SheenWork *work, const DiffusePoint *point, float noisier, Hemisphere *h,
                                   SheenStats *stats);

#endif
