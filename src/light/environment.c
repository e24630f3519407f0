// SPDX-License-Identifier: Apache-2.0
#include "light/environment.h"

#include "math/warp.h"

// Times the mean luminance: what is brighter is left to light sampling. Gather rays find the rest with little noise.
#define SOFT_FACTOR 4.0f

// ---- lookup -----------------------------------------------------------------------------------------------------

// A place in the grid of cells: between columns i and i + 1 (around the seam) and rows j and j + 1. Columns have their
// pixel in the middle and rows span the poles exactly, as Mitsuba reads these images.
typedef struct Place {
    uint32_t i, j;
    float x, y; // within the cell, [0, 1]
} Place;

typedef struct CellRgb {
    Rgb c[4]; // (i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)
} CellRgb;

static uint32_t rows_of_cells(const SheenLight *light)
{
    return light->environment.height > 1 ? light->environment.height - 1 : 1;
}

static Place place_of_direction(const SheenLight *light, Vec3 wi)
{
    Vec3 d = v3_normalize(transform_vector(&light->to_light, wi));
    uint32_t n_cols = light->environment.width, n_rows = rows_of_cells(light);
    float u = atan2f(d.x, -d.z) * (0.5f * SHEEN_INV_PI);
    float v = atan2f(sqrtf(d.x * d.x + d.z * d.z), d.y) * SHEEN_INV_PI; // near the poles an arc cosine has no digits
    u = u * (float)n_cols - 0.5f;
    if (u < 0.0f) u += (float)n_cols;
    u = clampf(u, 0.0f, (float)n_cols); // rounding can reach the seam
    v = clampf(v, 0.0f, 1.0f) * (float)n_rows;
    Place c = {.i = (uint32_t)u, .j = (uint32_t)v};
    if (c.i >= n_cols) c.i = n_cols - 1;
    if (c.j >= n_rows) c.j = n_rows - 1;
    c.x = minf(u - (float)c.i, 1.0f);
    c.y = v - (float)c.j;
    return c;
}

static Vec3 direction_of_place(const SheenLight *light, Place c)
{
    float phi = 2.0f * SHEEN_PI * ((float)c.i + 0.5f + c.x) / (float)light->environment.width;
    float theta = SHEEN_PI * ((float)c.j + c.y) / (float)rows_of_cells(light);
    float s = sinf(theta);
    Vec3 d = v3(s * sinf(phi), cosf(theta), -s * cosf(phi));
    return v3_normalize(transform_vector(&light->to_world, d));
}

// Negative pixels emit nothing, nor do those that are not numbers; infinite ones are very bright.
static float sane(float x)
{
    return x > 0.0f ? minf(x, 1e30f) : 0.0f;
}

static Rgb pixel(const SheenLight *light, uint32_t i, uint32_t j)
{
    const SheenBitmap *b = &light->environment;
    if (i >= b->width) i = 0; // around the seam
    if (j >= b->height) j = b->height - 1;
    Rgb c = b->floats[(size_t)j * b->width + i];
    return rgb(sane(c.r * light->radiance.r), sane(c.g * light->radiance.g), sane(c.b * light->radiance.b));
}

static CellRgb cell_at(const SheenLight *light, uint32_t i, uint32_t j)
{
    return (CellRgb){{pixel(light, i, j), pixel(light, i + 1, j), pixel(light, i, j + 1), pixel(light, i + 1, j + 1)}};
}

static Rgb bilinear(const CellRgb *cell, float x, float y)
{
    Rgb top = rgb_mad(rgb_scale(cell->c[0], 1.0f - x), x, cell->c[1]);
    Rgb bottom = rgb_mad(rgb_scale(cell->c[2], 1.0f - x), x, cell->c[3]);
    return rgb_mad(rgb_scale(top, 1.0f - y), y, bottom);
}

Rgb sheen_environment_radiance(const SheenLight *light, Vec3 wi)
{
    if (light->environment.width == 0) return light->radiance;
    Place c = place_of_direction(light, wi);
    CellRgb cell = cell_at(light, c.i, c.j);
    return bilinear(&cell, c.x, c.y);
}

Rgb sheen_environment(const SheenScene *scene, Vec3 wi)
{
    if (scene->environment == SHEEN_NONE) return rgb_gray(0.0f);
    return sheen_environment_radiance(&scene->lights[scene->environment], wi);
}

// ---- distribution -----------------------------------------------------------------------------------------------

// Luminance above the threshold at the four corners. It is a convex function of the radiance: interpolated between the
// corners, it is at least that of the interpolated radiance, hence never zero where there is something to sample.
typedef struct CellWeight {
    float c[4];
} CellWeight;

static CellWeight weigh(const CellRgb *cell, float threshold)
{
    CellWeight w;
    for (int k = 0; k < 4; ++k) w.c[k] = maxf(rgb_luminance(cell->c[k]) - threshold, 0.0f);
    return w;
}

static double mean_weight(const CellWeight *w)
{
    return 0.25 * ((double)w->c[0] + (double)w->c[1] + (double)w->c[2] + (double)w->c[3]);
}

// Mean over a row of cells of the sine of the polar angle.
static double row_sine(uint32_t j, uint32_t n_rows)
{
    double step = 3.14159265358979324 / n_rows;
    return (cos(j * step) - cos((j + 1) * step)) / step;
}

static double mean_luminance(const SheenLight *light)
{
    uint32_t n_rows = rows_of_cells(light), n_cols = light->environment.width;
    double sum = 0.0, total = 0.0;
    for (uint32_t j = 0; j < n_rows; ++j) {
        double row = 0.0, sine = row_sine(j, n_rows);
        for (uint32_t i = 0; i < n_cols; ++i) {
            CellRgb cell = cell_at(light, i, j);
            CellWeight w = weigh(&cell, 0.0f);
            row += mean_weight(&w);
        }
        sum += row * sine;
        total += sine * n_cols;
    }
    return sum / total;
}

// What of a radiance is left to sampling.
static Rgb hard_part(Rgb radiance, float threshold)
{
    float l = rgb_luminance(radiance);
    return l > threshold ? rgb_scale(radiance, 1.0f - threshold / l) : rgb_gray(0.0f);
}

// Fills the row's CDF of cells; adds its flux. @return the sum of the cells' mean weights.
static double add_row(EnvironmentSampler *e, uint32_t j, double sine, double flux[4])
{
    double *cdf = e->col_cdf + (size_t)j * (e->n_cols + 1), sum = 0.0;
    for (uint32_t i = 0; i < e->n_cols; ++i) {
        CellRgb cell = cell_at(e->light, i, j);
        CellWeight w = weigh(&cell, e->threshold);
        cdf[i] = sum;
        sum += mean_weight(&w);
        if (!(mean_weight(&w) > 0.0)) continue;
        Rgb l = rgb_gray(0.0f);
        for (int k = 0; k < 4; ++k) l = rgb_mad(l, 0.25f, hard_part(cell.c[k], e->threshold));
        double mean = ((double)l.r + (double)l.g + (double)l.b) / 3.0 * sine;
        Vec3 d = direction_of_place(e->light, (Place){i, j, 0.5f, 0.5f});
        flux[0] += mean;
        flux[1] += mean * (double)d.x;
        flux[2] += mean * (double)d.y;
        flux[3] += mean * (double)d.z;
    }
    for (uint32_t i = 0; i < e->n_cols; ++i) cdf[i] = sum > 0.0 ? cdf[i] / sum : 0.0;
    cdf[e->n_cols] = 1.0;
    return sum;
}

SheenStatus sheen_environment_sampler_init(const SheenLight *light, SheenEnvironmentSplit split, SheenArena *arena,
                                           EnvironmentSampler *out)
{
    *out = (EnvironmentSampler){.light = light};
    bool hard = split == SHEEN_ENVIRONMENT_HARD;
    if (light->environment.width == 0) {
        Rgb l = light->radiance;
        out->threshold = hard ? INFINITY : 0.0f;
        out->flux = hard ? 0.0f : 4.0f * SHEEN_PI * (l.r + l.g + l.b) / 3.0f;
        return SHEEN_OK;
    }
    if (hard) out->threshold = SOFT_FACTOR * (float)mean_luminance(light);
    out->n_cols = light->environment.width;
    out->n_rows = rows_of_cells(light);
    out->row_cdf = SHEEN_ARENA_NEW(arena, double, (size_t)out->n_rows + 1);
    out->col_cdf = SHEEN_ARENA_NEW(arena, double, (size_t)out->n_rows *((size_t)out->n_cols + 1));
    if (!out->row_cdf || !out->col_cdf) return SHEEN_ERR_NOMEM;
    double flux[4] = {0.0};
    for (uint32_t j = 0; j < out->n_rows; ++j) {
        double sine = row_sine(j, out->n_rows);
        out->row_cdf[j] = out->weight;
        out->weight += add_row(out, j, sine, flux) * sine;
    }
    if (!(out->weight > 0.0)) return SHEEN_OK;
    for (uint32_t j = 0; j < out->n_rows; ++j) out->row_cdf[j] /= out->weight;
    out->row_cdf[out->n_rows] = 1.0;
    double cell = 2.0 * 3.14159265358979324 * 3.14159265358979324 / ((double)out->n_rows * out->n_cols);
    out->flux = (float)(flux[0] * cell);
    out->flux_vector = v3((float)(flux[1] * cell), (float)(flux[2] * cell), (float)(flux[3] * cell));
    return SHEEN_OK;
}

// The step of a CDF over n steps in which u falls, with a width that is not zero; u becomes its place there, [0, 1].
static uint32_t find_step(const double *cdf, uint32_t n, double *u)
{
    uint32_t lo = 0, hi = n; // cdf[lo] <= u < cdf[hi]
    while (hi - lo > 1) {
        uint32_t mid = lo + (hi - lo) / 2;
        if (cdf[mid] <= *u)
            lo = mid;
        else
            hi = mid;
    }
    *u = (*u - cdf[lo]) / (cdf[hi] - cdf[lo]);
    return lo;
}

// x in [0, 1] with a density that goes linearly from a to b.
static float sample_linear(float u, float a, float b)
{
    float root = sqrtf(lerpf(a * a, b * b, u));
    return a + root > 0.0f ? minf(u * (a + b) / (a + root), 1.0f) : u;
}

static float bilinear_weight(const CellWeight *w, float x, float y)
{
    return lerpf(lerpf(w->c[0], w->c[1], x), lerpf(w->c[2], w->c[3], x), y);
}

// A bilinear density over the cells turned into one over solid angle: the map's Jacobian is 2 pi^2 sin(theta).
static float density(const EnvironmentSampler *e, const CellWeight *w, const Place *c)
{
    double step = 3.14159265358979324 / e->n_rows;
    double sine = sin(fmax((c->j + (double)c->y) * step, 1e-9));
    double cells = (double)e->n_cols * e->n_rows;
    double in_square = (double)bilinear_weight(w, c->x, c->y) * row_sine(c->j, e->n_rows) / e->weight * cells;
    return (float)(in_square / (2.0 * 3.14159265358979324 * 3.14159265358979324 * fmax(sine, 1e-9)));
}

bool sheen_environment_sampler_sample(const EnvironmentSampler *e, Vec2 u, Vec3 *wi, Rgb *radiance, float *pdf)
{
    if (!(e->flux > 0.0f)) return false;
    if (e->n_rows == 0) {
        *wi = warp_sphere(u);
        *radiance = e->light->radiance;
        *pdf = 0.25f * SHEEN_INV_PI;
        return true;
    }
    double ux = (double)u.x, uy = (double)u.y;
    Place c;
    c.j = find_step(e->row_cdf, e->n_rows, &uy);
    c.i = find_step(e->col_cdf + (size_t)c.j * (e->n_cols + 1), e->n_cols, &ux);
    CellRgb cell = cell_at(e->light, c.i, c.j);
    CellWeight w = weigh(&cell, e->threshold);
    c.y = sample_linear((float)uy, w.c[0] + w.c[1], w.c[2] + w.c[3]);
    c.x = sample_linear((float)ux, lerpf(w.c[0], w.c[2], c.y), lerpf(w.c[1], w.c[3], c.y));
    *pdf = density(e, &w, &c);
    if (!(*pdf > 0.0f)) return false;
    *wi = direction_of_place(e->light, c);
    *radiance = hard_part(bilinear(&cell, c.x, c.y), e->threshold);
    return true;
}

float sheen_environment_sampler_pdf(const EnvironmentSampler *e, Vec3 wi)
{
    if (!(e->flux > 0.0f)) return 0.0f;
    if (e->n_rows == 0) return 0.25f * SHEEN_INV_PI;
    Place c = place_of_direction(e->light, wi);
    CellRgb cell = cell_at(e->light, c.i, c.j);
    CellWeight w = weigh(&cell, e->threshold);
    return density(e, &w, &c);
}
