// SPDX-License-Identifier: Apache-2.0
#include "integrator/direct.h"

#include <stdlib.h>

bool sheen_direct_reserve(DirectScratch *s, size_t n)
{
    if (n <= s->capacity) return true;
    sheen_direct_free(s);
    s->rays = malloc(n * sizeof *s->rays);
    s->irradiance = malloc(n * sizeof *s->irradiance);
    s->occluded = malloc(n);
    if (!s->rays || !s->irradiance || !s->occluded) {
        sheen_direct_free(s);
        return false;
    }
    s->capacity = n;
    return true;
}

void sheen_direct_free(DirectScratch *s)
{
    free(s->rays);
    free(s->irradiance);
    free(s->occluded);
    *s = (DirectScratch){0};
}

// Unshadowed irradiance of one sample and its shadow ray. @return false when there is nothing to ask.
static bool sample_light(const SheenWork *work, const DiffusePoint *point, LightNumbers numbers, Rgb *E, Ray *shadow)
{
    uint32_t light = numbers.light;
    float u = numbers.choice, probability = 1.0f;
    if (light == SHEEN_NONE) probability = sheen_lights_choose(work->lights, point->p, point->n, &u, &light);
    if (!(probability > 0.0f)) return false;
    LightSample sample;
    if (!sheen_light_sample(work->lights, light, point->p, numbers.place, &sample)) return false;
    float cos_theta = v3_dot(sample.wi, point->n);
    if (cos_theta <= 0.0f || v3_dot(sample.wi, point->ng) <= 0.0f) return false;
    *E = rgb_scale(sample.radiance, cos_theta / probability);
    *shadow = sample.infinite ? (Ray){point->origin, INFINITY, sample.wi}
                              : (Ray){point->origin, 1.0f, v3_sub(sample.target, point->origin)};
    return !rgb_is_black(*E) && rgb_finite(*E);
}

uint64_t sheen_direct_add(const SheenWork *work, size_t n, const DiffusePoint points[], const LightNumbers numbers[],
                          float scale, DirectScratch *scratch, Rgb E[])
{
    uint64_t rays = 0;
    for (size_t i = 0; i < n; ++i) {
        if (sample_light(work, &points[i], numbers[i], &scratch->irradiance[i], &scratch->rays[i]))
            ++rays;
        else
            scratch->rays[i] = (Ray){points[i].p, -1.0f, points[i].n}; // skipped
    }
    sheen_accel_occluded_many(work->accel, SHEEN_INCOHERENT, n, scratch->rays, scratch->occluded);
    for (size_t i = 0; i < n; ++i)
        if (!scratch->occluded[i]) E[i] = rgb_mad(E[i], scale, scratch->irradiance[i]);
    return rays;
}
