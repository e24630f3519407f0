// SPDX-License-Identifier: Apache-2.0
// Rays go on through mirrors and glass to the first surface that scatters.
#ifndef SHEEN_INTEGRATOR_FOLLOW_H
#define SHEEN_INTEGRATOR_FOLLOW_H

#include "integrator/work.h"
#include "material/bsdf.h"
#include "math/sampler.h"

/** Longest chain of mirrors and panes that is followed. */
enum { SHEEN_SPECULAR_MAX = 32 };

/** A point that scatters light, on the side from which it was seen. */
typedef struct DiffusePoint {
    Vec3 p;
    Vec3 origin;     // p off the surface, on the seen side: where rays leave
    Vec3 ng, n;      // unit geometric and shading normals of the seen side: where its records lie
    Vec3 bent;       // unit normal about which it scatters: n, unless a bump or normal map bends it
    Rgb reflectance; // albedo
} DiffusePoint;

/** The share of light that is alike from everywhere above n which a surface about `bent` receives. */
static inline float diffuse_point_open(const DiffusePoint *point)
{
    return 0.5f + 0.5f * v3_dot(point->n, point->bent);
}

/** Makes the point on the front or the back of a surface without a map. @return false when it is black */
bool sheen_set_point(const SurfacePoint *s, bool front, Rgb reflectance, DiffusePoint *out);

/** Bends the point as the maps of its diffuse lobes do. @param frame  about the shading normal; @param wo_l  in it */
void sheen_bend_point(const Bsdf *bsdf, const Frame *frame, Vec3 wo_l, DiffusePoint *point);

/** @return the material of a surface that is Lambertian and nothing else, which needs no BSDF; NULL for others. */
static inline const SheenMaterial *sheen_lambertian(const SheenScene *scene, const SurfacePoint *s)
{
    const SheenMaterial *m = &scene->materials[scene->shapes[s->shape].material];
    return m->kind == SHEEN_MATERIAL_DIFFUSE ? m : NULL;
}

/** The same on a Lambertian surface seen along wo (unit, toward the viewer). @return false when it is black. */
bool sheen_lambertian_point(const SheenScene *scene, const SheenMaterial *material, const SurfacePoint *s, Vec3 wo,
                            DiffusePoint *out);

/** What becomes of a ray at a surface. */
typedef enum SheenStep {
    SHEEN_STEP_ENDS,     // absorbed
    SHEEN_STEP_PASSES,   // straight through a hole: light samples do so too, so that nothing has happened
    SHEEN_STEP_GOES_ON,  // through a mirror, a pane, or along a narrow glossy reflection
    SHEEN_STEP_SCATTERS, // at a point that counts as diffuse
    SHEEN_STEP_TURNS     // the same, but by a glossy lobe, along `next`
} SheenStep;

/**
 * One way that light comes from, chosen by the sampler with the BSDF's own probabilities, so that blends, masks and
 * layers are right in the mean. Mirrors, passage and glossy lobes narrower than roughness 0.2 are followed. All else
 * counts as a Lambertian surface: diffuse lobes, wide glossy ones, and coats and highlights, narrow as they be, which
 * would make caustics; its reflectance is one sample's weight, whose mean is the albedo for wo. Of a glossy lobe it is
 * the weight of the direction drawn, which is told too: light other than lamps' may be asked there. Light that comes
 * through from behind makes it a surface of the other side.
 * @param wo          unit, toward the viewer
 * @param throughput  is multiplied where the ray passes or goes on
 */
SheenStep sheen_step(const SurfacePoint *s, const Bsdf *bsdf, Vec3 wo, SheenSampler *sampler, Rgb *throughput,
                     Ray *next, DiffusePoint *point);

/** wo in the local frame of s; a direction that the shading normal alone denies becomes grazing. */
Vec3 sheen_seen_from(const SurfacePoint *s, const Frame *frame, Vec3 wo);

/** Where a ray ended. */
typedef struct Followed {
    bool scatters;     // `point` is set
    bool glossy;       // ended on rough glossy lobes, none of which is ever followed: `surface` is set, whether or not
                       // the one direction that was drawn scatters
    bool escaped;      // left the scene along `direction`
    unsigned specular; // mirrors and panes on the way
    unsigned passages; // holes
    bool turns;        // `point` scatters by a glossy lobe, and this time from `onward`
    Vec3 onward;
    DiffusePoint point;
    SurfacePoint surface;
    Vec3 direction; // of the last segment
    Rgb throughput; // of the mirrors and panes
    Rgb emitted;    // radiance that the last surface emits back along the last segment
    Rgb passed;     // that of surfaces before it, from behind the first mirror on, times the throughput
    float distance; // length of the whole way, metres; INFINITY when escaped
} Followed;

/**
 * Follows a ray whose first hit is known; at glass one of reflection and refraction is chosen.
 * @param specular_rays  is counted up
 */
void sheen_follow(const SheenWork *work, const Ray *ray, const Hit *hit, SheenSampler *sampler, uint64_t *specular_rays,
                  Followed *out);

#endif
