// SPDX-License-Identifier: Apache-2.0
// Hard scenes rendered with the defaults, measured against paths: the mean, the worst block, and how many records it
// took. Include after cmocka.h.
#ifndef SHEEN_TESTS_ROBUST_KIT_H
#define SHEEN_TESTS_ROBUST_KIT_H

#include "analytic/irradiance_kit.h"
#include "image/image.h"

/** The defaults of `sheen render` but for the size: what a user gets. */
static inline SheenRenderSettings robust_settings(uint32_t width, uint32_t height)
{
    SheenRenderSettings s = {.integrator = SHEEN_INTEGRATOR_RADIANCE, .width = width, .height = height};
    s.options = sheen_options_default();
    return s;
}

/** How far a cached picture is from paths. Blocks have 8 x 8 pixels; all is relative. */
typedef struct Robustness {
    double mean;       // signed
    double worst, rms; // of blocks
    double noise;      // of a block of the reference, rms
    uint32_t x, y;     // the worst block's upper left pixel
    SheenStats stats;
} Robustness;

/** Writes a picture where SHEEN_PICTURES names a folder: for looking at. */
static inline void robust_write(const SheenFilm *film, const char *name, const char *what)
{
    const char *folder = getenv("SHEEN_PICTURES");
    if (!folder) return;
    char path[512];
    float exposure = log2f(0.3f / maxf((float)film_mean(film), 1e-20f));
    SheenImageView view = {.width = film->width, .height = film->height, .pixels = film->color};
    snprintf(path, sizeof path, "%s/%s-%s.pfm", folder, name, what);
    assert_int_equal(sheen_image_write(path, &view, 0.0f, &kit_log_sink), SHEEN_OK);
    snprintf(path, sizeof path, "%s/%s-%s.png", folder, name, what);
    assert_int_equal(sheen_image_write(path, &view, exposure, &kit_log_sink), SHEEN_OK);
}

/** Mean of two pictures, into the first. */
static inline void robust_average(SheenFilm *a, const SheenFilm *b)
{
    for (size_t i = 0; i < (size_t)a->width * a->height; ++i)
        a->color[i] = rgb_scale(rgb_add(a->color[i], b->color[i]), 0.5f);
}

/**
 * Compares pictures by blocks. What a block is off by is divided by its light, but by no less than a twentieth of the
 * picture's mean: in the dark a reference's noise is more than that.
 */
static inline void robust_compare(const SheenFilm *film, const SheenFilm *reference, Robustness *out)
{
    enum { SIDE = 8 };
    double sum = 0.0, least = 0.05 * film_mean(reference);
    size_t n = 0;
    out->mean = film_mean(film) / film_mean(reference) - 1.0;
    out->worst = 0.0;
    for (uint32_t y = 0; y + SIDE <= film->height; y += SIDE)
        for (uint32_t x = 0; x + SIDE <= film->width; x += SIDE) {
            double u = film_mean_of(film, x, y, x + SIDE, y + SIDE);
            double v = film_mean_of(reference, x, y, x + SIDE, y + SIDE);
            double off = fabs(u - v) / fmax(v, least);
            if (!(off <= out->worst)) out->worst = off, out->x = x, out->y = y;
            sum += off * off;
            ++n;
        }
    out->rms = sqrt(sum / (double)n);
}

/**
 * Renders a scene with the cache and with paths.
 * @param spp   paths a pixel, in two pictures, whose difference tells their noise. SHEEN_SPP takes its place, for
 *              measuring by hand; 0 for none
 * @param name  of the pictures to be looked at
 */
static inline Robustness robust_measure(const Stage *stage, const SheenRenderSettings *settings, uint32_t spp,
                                        const char *name)
{
    Robustness r = {0}, noise;
    double start = sheen_clock_seconds();
    SheenFilm *film = stage_render(stage, settings, &r.stats);
    double cached = sheen_clock_seconds() - start;
    robust_write(film, name, "cached");
    if (getenv("SHEEN_SPP")) spp = (uint32_t)atoi(getenv("SHEEN_SPP"));
    if (spp == 0) {
        show("%s: %u + %u records; %.2f s\n", name, (unsigned)r.stats.records, (unsigned)r.stats.radiance_records,
             cached);
        sheen_film_destroy(&film);
        return r;
    }
    SheenFilm *a = stage_reference(stage, settings, spp / 2, 1), *b = stage_reference(stage, settings, spp / 2, 2);
    double paths = sheen_clock_seconds() - start - cached;
    robust_compare(a, b, &noise);
    robust_average(a, b);
    robust_compare(film, a, &r);
    r.noise = 0.5 * noise.rms;
    robust_write(a, name, "paths");
    show("%s: mean %+.2f %%, worst block %.2f %% at (%u, %u), rms %.2f %%, noise %.2f %%; %u + %u records, %u deep; "
         "%.2f s, paths %.2f s\n",
         name, 100 * r.mean, 100 * r.worst, r.x, r.y, 100 * r.rms, 100 * r.noise, (unsigned)r.stats.records,
         (unsigned)r.stats.radiance_records, (unsigned)r.stats.deep_records, cached, paths);
    sheen_film_destroy(&film);
    sheen_film_destroy(&a);
    sheen_film_destroy(&b);
    return r;
}

#endif
