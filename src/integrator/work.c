// SPDX-License-Identifier: Apache-2.0
#include "integrator/work.h"

SheenOptions sheen_options_default(void)
{
    return (SheenOptions){
        .spp = 16,
        .light_samples = 1,
        .bounces = 8,
        .accuracy = 0.15f,
        .gather_rays = 1024,
        .gradients = SHEEN_GRADIENTS_STRATIFIED,
        .secondary = SHEEN_SECONDARY_CACHE,
        .neighbor_clamping = true,
        .gradient_clamping = true,
    };
}

void sheen_stats_add(SheenStats *total, const SheenStats *part)
{
    total->rays_camera += part->rays_camera;
    total->rays_shadow += part->rays_shadow;
    total->rays_gather += part->rays_gather;
    total->rays_path += part->rays_path;
    total->rays_specular += part->rays_specular;
    total->nonfinite_samples += part->nonfinite_samples;
}

Ray sheen_camera_ray(const SheenCamera *camera, uint32_t width, uint32_t height, float x, float y)
{
    float half = tanf(0.5f * camera->fov_x);
    float px = (1.0f - 2.0f * x / (float)width) * half; // +x is to the left
    float py = ((float)height - 2.0f * y) / (float)width * half;
    Vec3 d = transform_vector(&camera->to_world, v3(px, py, 1.0f));
    return (Ray){transform_point(&camera->to_world, v3(0, 0, 0)), INFINITY, v3_normalize(d)};
}
