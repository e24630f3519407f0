// SPDX-License-Identifier: Apache-2.0
#include "integrator/picture.h"

#include <stdlib.h>

bool sheen_picture_create(const SheenWork *work, SheenFilm *film, Picture *out)
{
    size_t n = (size_t)film->width * film->height;
    bool of_records = film->aov[SHEEN_AOV_RECORDS] || film->aov[SHEEN_AOV_ACCURACY] || film->aov[SHEEN_AOV_COVERAGE] ||
                      film->aov[SHEEN_AOV_ERROR];
    *out = (Picture){film, work->options.spp, malloc(n * sizeof *out->samples),
                     calloc(n * SHEEN_NOISE_GROUPS, sizeof *out->groups),
                     of_records ? calloc(n, sizeof *out->served) : NULL};
    if (!out->samples || !out->groups || (of_records && !out->served)) {
        sheen_picture_free(out);
        return false;
    }
    for (size_t i = 0; i < n; ++i) out->samples[i] = out->spp;
    return true;
}

void sheen_picture_free(Picture *picture)
{
    free(picture->samples);
    free(picture->groups);
    free(picture->served);
    *picture = (Picture){0};
}

void sheen_picture_add(Picture *picture, uint32_t pixel, uint32_t sample, Rgb value, SheenAov aov, SheenStats *stats)
{
    if (!rgb_finite(value)) {
        ++stats->nonfinite_samples;
        return;
    }
    SheenFilm *film = picture->film;
    film->color[pixel] = rgb_add(film->color[pixel], value);
    film_add(film, aov, pixel % film->width, pixel / film->width, value);
    if (sample >= picture->spp) return;
    uint32_t group = (uint32_t)((uint64_t)sample * SHEEN_NOISE_GROUPS / picture->spp);
    picture->groups[(size_t)pixel * SHEEN_NOISE_GROUPS + group] += rgb_luminance(value);
}

/** What the first samples of a pixel tell. */
typedef struct PixelNoise {
    float mean, variance; // of the mean
} PixelNoise;

// Groups of samples that follow each other are stratified in themselves, so that their scatter, unlike that of single
// samples, tells the error of stratified ones.
static PixelNoise pixel_noise(const Picture *picture, size_t pixel)
{
    const float *group = picture->groups + pixel * SHEEN_NOISE_GROUPS;
    float scale = (float)SHEEN_NOISE_GROUPS / (float)picture->spp, sum = 0.0f, square = 0.0f;
    for (int g = 0; g < SHEEN_NOISE_GROUPS; ++g) sum += scale * group[g];
    float mean = sum / SHEEN_NOISE_GROUPS;
    for (int g = 0; g < SHEEN_NOISE_GROUPS; ++g) square += sqrf(scale * group[g] - mean);
    return (PixelNoise){mean, square / (SHEEN_NOISE_GROUPS * (SHEEN_NOISE_GROUPS - 1))};
}

// The mean over the pixels at most `reach` away, without the pixel itself.
static PixelNoise neighbors_noise(const SheenFilm *film, const PixelNoise noise[], uint32_t x, uint32_t y,
                                  uint32_t reach)
{
    uint32_t x0 = x > reach ? x - reach : 0, x1 = x + reach < film->width ? x + reach : film->width - 1;
    uint32_t y0 = y > reach ? y - reach : 0, y1 = y + reach < film->height ? y + reach : film->height - 1;
    PixelNoise sum = {0.0f, 0.0f};
    uint32_t n = (x1 - x0 + 1) * (y1 - y0 + 1) - 1;
    for (uint32_t v = y0; v <= y1; ++v)
        for (uint32_t u = x0; u <= x1; ++u) {
            if (u == x && v == y) continue;
            sum.mean += noise[(size_t)v * film->width + u].mean;
            sum.variance += noise[(size_t)v * film->width + u].variance;
        }
    if (n == 0) return sum;
    return (PixelNoise){sum.mean / (float)n, sum.variance / (float)n};
}

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static float median(const PixelNoise noise[], size_t n, float scratch[])
{
    for (size_t i = 0; i < n; ++i) scratch[i] = noise[i].mean;
    qsort(scratch, n, sizeof *scratch, compare_floats);
    return scratch[n / 2];
}

// Samples that bring the variance of the mean down to what `error` allows.
static uint32_t samples_for(uint32_t spp, float variance, float error)
{
    if (!(variance > sqrf(error))) return spp;
    double n = (double)spp * (double)variance / ((double)error * (double)error);
    double most = (double)spp * (1 + SHEEN_MORE_MAX);
    return n < most ? (uint32_t)ceil(n) : spp * (1 + SHEEN_MORE_MAX);
}

bool sheen_picture_plan(float noise, Picture *picture, uint64_t *more)
{
    const float darkest = 0.25f; // of the median
    enum { NEAR = 1, FAR = 2 };
    const SheenFilm *film = picture->film;
    size_t n = (size_t)film->width * film->height;
    *more = 0;
    if (picture->spp < 2 * SHEEN_NOISE_GROUPS || !(noise > 0.0f)) return true; // nothing to tell it by
    PixelNoise *pixels = malloc(n * sizeof *pixels);
    float *scratch = malloc(n * sizeof *scratch);
    bool ok = pixels && scratch;
    if (ok) {
        for (size_t i = 0; i < n; ++i) pixels[i] = pixel_noise(picture, i);
        float floor = darkest * median(pixels, n, scratch);
        for (size_t i = 0; i < n; ++i) {
            uint32_t x = (uint32_t)(i % film->width), y = (uint32_t)(i / film->width);
            PixelNoise near = neighbors_noise(film, pixels, x, y, NEAR);
            PixelNoise far = neighbors_noise(film, pixels, x, y, FAR);
            float variance = maxf(near.variance, far.variance), error = noise * (near.mean + floor);
            picture->samples[i] = samples_for(picture->spp, variance, error);
            *more += picture->samples[i] - picture->spp;
        }
    }
    free(pixels);
    free(scratch);
    return ok;
}

// What a pixel's sum in a layer is to be divided by; 0 where there is no sum.
static float divisor(const Picture *picture, SheenAov aov, size_t pixel)
{
    const float *px = picture->film->aov[aov] + pixel * sheen_aov_info[aov].n_channels;
    switch (aov) {
    case SHEEN_AOV_PRIMITIVE: // of the first sample alone
        return 1.0f;
    case SHEEN_AOV_ACCURACY:
    case SHEEN_AOV_COVERAGE:
    case SHEEN_AOV_ERROR:
        return (float)picture->served[pixel];
    case SHEEN_AOV_TRANSPORT:
        return px[0] + px[1] + px[2];
    default:
        return (float)picture->samples[pixel];
    }
}

static void average_layer(const Picture *picture, SheenAov aov)
{
    SheenFilm *film = picture->film;
    size_t n = (size_t)film->width * film->height;
    unsigned n_channels = sheen_aov_info[aov].n_channels;
    float most = aov == SHEEN_AOV_RECORDS ? 1.0f : INFINITY; // a sample's ways may each see a dot
    for (size_t i = 0; i < n; ++i) {
        float over = divisor(picture, aov, i), scale = over > 0.0f ? 1.0f / over : 0.0f;
        float *px = film->aov[aov] + i * n_channels;
        for (unsigned c = 0; c < n_channels; ++c) px[c] = minf(px[c] * scale, most);
    }
}

void sheen_picture_average(Picture *picture)
{
    SheenFilm *film = picture->film;
    size_t n = (size_t)film->width * film->height;
    for (size_t i = 0; i < n; ++i) film->color[i] = rgb_scale(film->color[i], 1.0f / (float)picture->samples[i]);
    for (int a = 0; a < SHEEN_AOV_COUNT; ++a)
        if (film->aov[a]) average_layer(picture, (SheenAov)a);
}
