// SPDX-License-Identifier: Apache-2.0
#include "integrator/hot_spot.h"

#include "math/warp.h"

// A hit belongs to a spot when it lies within this angle of its centre as seen from where it was found, and no spot
// grows beyond it: wider places are no rare finds.
static const float spot_angle = 0.06f;
// The least half angle of a cone: the border of a narrower one would be decided by rounding.
static const float least_angle = 0.004f;

void sheen_hot_spots_add(HotSpots *s, Vec3 p, float distance, float radiance)
{
    float near = spot_angle * distance, least = least_angle * distance;
    for (uint32_t i = 0; i < s->n; ++i) {
        HotSpot *spot = &s->spots[i];
        float d = v3_length(v3_sub(p, spot->center));
        if (d >= maxf(near, spot->radius)) continue;
        spot->radius = maxf(spot->radius, d + least);
        spot->radiance = maxf(spot->radiance, radiance);
        ++spot->hits;
        return;
    }
    if (s->n < SHEEN_HOT_SPOTS_MAX) s->spots[s->n++] = (HotSpot){p, maxf(least, 0.3f * near), radiance, 1};
}

// Of a cone, sr.
static float solid_angle(float sin2_max)
{
    return 2.0f * SHEEN_PI * sin2_max / (1.0f + safe_sqrtf(1.0f - sin2_max));
}

// The cone about one spot as seen from p. @return its solid angle, sr; 0 when p is too near, or below the horizon.
static float make_cone(const HotSpot *spot, Vec3 p, const Frame *frame, Cone *cone)
{
    Vec3 to = v3_sub(spot->center, p);
    float r2 = v3_length2(to), r = sqrtf(r2);
    if (!(r > 2.0f * spot->radius) || !(v3_dot(to, frame->n) > 0.0f)) return 0.0f;
    cone->axis = frame_to_local(frame, v3_scale(to, 1.0f / r));
    cone->sin2_max = maxf(sqrf(spot->radius) / r2, sqrf(least_angle));
    return solid_angle(cone->sin2_max);
}

// Gives a cone its rays. @return false when the spot is not worth one.
static bool give_rays(const HotSpot *spot, float omega, SheenStrata strata, float mean, float error, Cone *cone)
{
    enum { RAYS_MIN = 2, RAYS_MAX = 192 };
    const float spread = 0.7f;    // of the radiance in a cone, relative: it holds more than the spot
    const float tolerated = 0.3f; // of the error sought: there are other sources, and other spots
    const float cells_max = 4.0f; // wider spots the strata find
    float n = (float)strata_count(strata);
    float cells = n * strata_pdf(strata, cone->axis.z) * omega;
    float share = cells * spot->radiance / (n * mean); // of the irradiance, if all of it is seen
    if (!(cells < cells_max) || !(share > tolerated * error * sqrtf(cells))) return false;
    cone->rays = (uint32_t)clampf(sqrf(spread * share / error), RAYS_MIN, RAYS_MAX);
    cone->density = (float)cone->rays / omega;
    return true;
}

// Takes rays from all cones alike until no more are left than `most`. Densities are what the rays will be: a gather
// that then left some out would lose light.
static void limit_rays(uint32_t most, Guide *g)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < g->n; ++i) sum += g->cones[i].rays;
    if (sum <= most) return;
    float share = most > g->n ? (float)(most - g->n) / (float)(sum - g->n) : 0.0f;
    for (uint32_t i = 0; i < g->n; ++i) {
        Cone *c = &g->cones[i];
        c->density /= (float)c->rays;
        c->rays = 1 + (uint32_t)(share * (float)(c->rays - 1));
        c->density *= (float)c->rays;
    }
}

void sheen_guide_choose(const HotSpots *s, Vec3 p, const Frame *frame, SheenStrata strata, float mean, float error,
                        Guide *out)
{
    out->spots = s;
    out->mean = mean;
    out->n = 0;
    if (!(mean > 0.0f)) return;
    for (uint32_t i = 0; i < s->n; ++i) {
        Cone cone = {.spot = i};
        float omega = make_cone(&s->spots[i], p, frame, &cone);
        if (!(omega > 0.0f) || !give_rays(&s->spots[i], omega, strata, mean, error, &cone)) continue;
        if (out->n < SHEEN_CONES_MAX) {
            out->cones[out->n++] = cone;
            continue;
        }
        // With all places taken it replaces the cone where least is at stake.
        uint32_t least = 0;
        for (uint32_t j = 1; j < out->n; ++j)
            if (out->cones[j].rays < out->cones[least].rays) least = j;
        if (out->cones[least].rays < cone.rays) out->cones[least] = cone;
    }
    limit_rays(strata_count(strata), out);
}

Vec3 sheen_cone_direction(const Cone *cone, Vec2 u)
{
    float sin2 = 0.9999f * cone->sin2_max; // a hair inside, so that guide_density finds it
    Frame f = frame_from_normal(cone->axis);
    return v3_normalize(frame_to_world(&f, warp_cone(u, sin2 / (1.0f + safe_sqrtf(1.0f - sin2)))));
}

// The same spots seen from another point: `density` becomes what one ray has that chooses among them by what they
// would contribute unhidden. @return the sum of those contributions, W/m^2 in luminance
static float see_from(const Guide *g, Vec3 p, const Frame *frame, Guide *local)
{
    float sum = 0.0f, power[SHEEN_CONES_MAX], omega[SHEEN_CONES_MAX];
    local->n = 0;
    for (uint32_t i = 0; i < g->n; ++i) {
        const HotSpot *spot = &g->spots->spots[g->cones[i].spot];
        uint32_t k = local->n;
        omega[k] = make_cone(spot, p, frame, &local->cones[k]);
        if (!(omega[k] > 0.0f)) continue;
        power[k] = spot->radiance * omega[k] * local->cones[k].axis.z;
        sum += power[k];
        ++local->n;
    }
    for (uint32_t k = 0; k < local->n; ++k) local->cones[k].density = power[k] / (sum * omega[k]);
    return sum;
}

float sheen_guide_direction(const Guide *g, Vec3 p, const Frame *frame, float choice, Vec2 u, Vec3 *d)
{
    const float share_max = 0.7f; // hidden spots must leave rays for the rest
    Guide local;
    float hot = g->n ? see_from(g, p, frame, &local) : 0.0f;
    if (!(hot > 0.0f)) {
        *d = warp_cosine_hemisphere(u);
        return 1.0f;
    }
    float share = minf(hot / (hot + SHEEN_PI * g->mean), share_max);
    if (choice < share) {
        float left = choice / share;
        uint32_t k = 0;
        for (; k + 1 < local.n; ++k) {
            float probability = local.cones[k].density * solid_angle(local.cones[k].sin2_max);
            if (left < probability) break;
            left -= probability;
        }
        *d = sheen_cone_direction(&local.cones[k], u);
    } else {
        *d = warp_cosine_hemisphere(u);
    }
    if (!(d->z > 0.0f)) return 0.0f;
    float cosine = d->z * SHEEN_INV_PI;
    return cosine / ((1.0f - share) * cosine + share * guide_density(&local, *d));
}
