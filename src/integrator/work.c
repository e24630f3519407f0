// SPDX-License-Identifier: Apache-2.0
#include "integrator/work.h"

SheenOptions sheen_options_default(void)
{
    return (SheenOptions){
        .spp = 16,
        .noise = 0.03f,
        .bounces = 8,
        .accuracy = 0.2f,
        .error_metric = SHEEN_ERROR_HESSIAN,
        .reach_min = 4.0f,
        .reach_max = 25.0f,
        .gather_rays = 400,
        .gradients = SHEEN_GRADIENT_STRATIFIED,
        .basis = SHEEN_BASIS_AUTO,
        .order = 10,
        .brdf_error = 0.05f,
        .secondary = SHEEN_SECONDARY_CACHE,
        .neighbor_clamping = true,
        .adaptive = true,
        .discernible = 0.02f,
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

// Spreads the low 16 bits to the even bits.
static uint32_t spread(uint32_t x)
{
    x &= 0xffffu;
    x = (x | x << 8) & 0x00ff00ffu;
    x = (x | x << 4) & 0x0f0f0f0fu;
    x = (x | x << 2) & 0x33333333u;
    return (x | x << 1) & 0x55555555u;
}

uint32_t sheen_sample_index(uint32_t x, uint32_t y, uint32_t per_pixel, uint32_t s)
{
    return (spread(x) | spread(y) << 1) * per_pixel + s;
}

Ray sheen_camera_ray(const SheenWork *work, const SheenEye *eye, uint32_t x, uint32_t y, SheenSampler *sampler,
                     bool *negative)
{
    Vec2 place = sheen_pixel_filter_sample(work->filter, sampler_2d(sampler), negative);
    float px = (float)x + place.x, py = (float)y + place.y;
    return sheen_eye_has_lens(eye) ? sheen_eye_lens_ray(eye, px, py, sampler_2d(sampler)) : sheen_eye_ray(eye, px, py);
}

SheenEye sheen_eye(const SheenCamera *camera, uint32_t width, uint32_t height)
{
    // The camera looks along +z; +x is to the left in the picture and +y up.
    const Transform *t = &camera->to_world;
    Vec2 lo = camera->cut_lo, hi = camera->cut_hi;
    float half = camera->orthographic ? 1.0f : tanf(0.5f * camera->fov_x);
    float pixel = 2.0f * half * (1.0f - lo.x - hi.x) / (float)width;
    float film_height = (float)height / (1.0f - lo.y - hi.y); // pixels
    float x = half - lo.x * 2.0f * half, y = (0.5f - lo.y) * film_height * pixel;
    SheenEye eye = {.origin = transform_point(t, v3(0, 0, 0)),
                    .corner = transform_vector(t, v3(x, y, 1.0f)),
                    .right = transform_vector(t, v3(-pixel, 0, 0)),
                    .down = transform_vector(t, v3(0, -pixel, 0)),
                    .pixel = pixel,
                    .lens_u = transform_vector(t, v3(camera->aperture, 0, 0)),
                    .lens_v = transform_vector(t, v3(0, camera->aperture, 0)),
                    .focus = camera->focus};
    if (camera->orthographic) {
        eye.parallel = true;
        eye.origin = transform_point(t, v3(x, y, 0.0f));
        eye.corner = transform_vector(t, v3(0, 0, 1));
        eye.pixel = sqrtf(v3_length(v3_cross(eye.right, eye.down)));
        eye.lens_u = eye.lens_v = v3(0, 0, 0);
    }
    return eye;
}
