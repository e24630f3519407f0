// SPDX-License-Identifier: Apache-2.0
#include "integrator/direct.h"

#include <stdlib.h>

enum { KEY_LIGHT = 0x11c7 };

bool sheen_direct_reserve(DirectScratch *s, size_t n)
{
    if (n <= s->capacity) return true;
    sheen_direct_free(s);
    s->rays = malloc(n * sizeof *s->rays);
    s->irradiance = malloc(n * sizeof *s->irradiance);
    s->transmittance = malloc(n * sizeof *s->transmittance);
    if (!s->rays || !s->irradiance || !s->transmittance) {
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
    free(s->transmittance);
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
    float cos_theta = v3_dot(sample.wi, point->bent);
    if (cos_theta <= 0.0f || v3_dot(sample.wi, point->n) <= 0.0f || v3_dot(sample.wi, point->ng) <= 0.0f) return false;
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
    sheen_accel_transmittance_many(work->accel, n, scratch->rays, scratch->transmittance);
    for (size_t i = 0; i < n; ++i) {
        float through = scratch->transmittance[i];
        if (through > 0.0f) E[i] = rgb_mad(E[i], scale * through, scratch->irradiance[i]);
    }
    return rays;
}

// Few lights are all asked: a choice goes by what they would send if nothing was in the way, and is noise wherever the
// strongest is hidden. Two samples each cost less than the choice did and leave half its error.
LightPlan sheen_light_plan(const SheenWork *work)
{
    uint32_t n = sheen_lights_count(work->lights), wanted = work->options.light_samples, deltas = 0;
    if (n > SHEEN_FEW_LIGHTS || (wanted > 0 && wanted < n)) return (LightPlan){0, wanted ? wanted : SHEEN_FEW_LIGHTS};
    if (wanted == 0) return (LightPlan){n, n > 1 ? 2 : 1};
    for (uint32_t i = 0; i < n; ++i) deltas += sheen_light_is_delta(work->lights, i);
    return (LightPlan){n, deltas < n ? (wanted - deltas) / (n - deltas) : 1};
}

LightSequence sheen_light_sequence(const SheenWork *work, LightPlan plan, uint32_t branch, uint32_t pixel,
                                   uint32_t sample)
{
    uint32_t key = hash_combine(work->options.seed ^ KEY_LIGHT, branch), spp = work->options.spp;
    uint32_t x = pixel % work->width, y = pixel / work->width;
    // The first samples of all pixels share one sequence, further ones have one for each pixel.
    if (sample < spp) return (LightSequence){key, sheen_sample_index(x, y, spp * plan.samples, sample * plan.samples)};
    return (LightSequence){hash_combine(key, pixel + 1), (sample - spp) * plan.samples};
}
