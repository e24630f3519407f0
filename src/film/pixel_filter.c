// SPDX-License-Identifier: Apache-2.0
#include "film/pixel_filter.h"

// Appends a knot of the table; its cell, unless it is the first knot, has the sign of the filter in the cell's middle.
static void add_knot(SheenPixelFilter *out, const SheenFilter *filter, uint32_t at, double x)
{
    out->x[at] = (float)x;
    // The radius itself belongs to the last cell: the box does not slope down to the zero beyond it.
    double inside = x < (double)filter->radius ? x : (double)filter->radius * (1.0 - 1e-9);
    out->f[at] = (float)fabs(sheen_filter_eval(filter, inside));
    if (at > 0) {
        double middle = 0.5 * ((double)out->x[at - 1] + x);
        out->negative[at - 1] = sheen_filter_eval(filter, middle) < 0.0;
        out->has_signs = out->has_signs || out->negative[at - 1];
    }
}

// Where the filter changes its sign between lo and hi.
static double root(const SheenFilter *filter, double lo, double hi)
{
    bool below = sheen_filter_eval(filter, lo) < 0.0;
    for (int i = 0; i < 60; ++i) {
        double middle = 0.5 * (lo + hi);
        *((sheen_filter_eval(filter, middle) < 0.0) == below ? &lo : &hi) = middle;
    }
    return 0.5 * (lo + hi);
}

void sheen_pixel_filter_init(const SheenFilter *filter, SheenPixelFilter *out)
{
    *out = (SheenPixelFilter){0};
    const SheenFilter box = sheen_filter_standard(SHEEN_FILTER_BOX);
    if (filter->kind == SHEEN_FILTER_UNSET) filter = &box;
    uint32_t cells = filter->kind == SHEEN_FILTER_BOX ? 1 : SHEEN_PIXEL_FILTER_CELLS, roots = 0;
    double width = (double)filter->radius / cells, before = 0.0;
    add_knot(out, filter, 0, 0.0);
    for (uint32_t i = 1; i <= cells; ++i) {
        double x = width * i;
        // A sign that is only rounding's at a zero on a knot makes a cell of no width, which nothing is drawn from.
        bool below = sheen_filter_eval(filter, before) < 0.0, above = i < cells && sheen_filter_eval(filter, x) < 0.0;
        if (i < cells && below != above && roots < SHEEN_PIXEL_FILTER_ROOTS) {
            ++roots;
            add_knot(out, filter, ++out->n, root(filter, before, x));
        }
        add_knot(out, filter, ++out->n, x);
        before = x;
    }
    double all = 0.0, sum = 0.0;
    for (uint32_t i = 0; i < out->n; ++i) {
        double area = 0.5 * ((double)out->f[i] + (double)out->f[i + 1]) * ((double)out->x[i + 1] - (double)out->x[i]);
        all += area;
        sum += out->negative[i] ? -area : area;
        out->cdf[i + 1] = (float)all;
    }
    for (uint32_t i = 1; i <= out->n; ++i) out->cdf[i] = (float)((double)out->cdf[i] / all);
    out->cdf[out->n] = 1.0f;
    for (uint32_t i = 0, at = 0; i < SHEEN_PIXEL_FILTER_CELLS; ++i) {
        while (at + 1 < out->n && out->cdf[at + 1] * (float)SHEEN_PIXEL_FILTER_CELLS <= (float)i) ++at;
        out->guide[i] = (uint16_t)at;
    }
    out->gain = (float)((all / sum) * (all / sum));
}

// Draws along one axis, from -radius to radius as u goes from 0 to 1.
static float sample_axis(const SheenPixelFilter *f, float u, bool *negative)
{
    float q = fabsf(2.0f * u - 1.0f);
    uint32_t slot = (uint32_t)(q * (float)SHEEN_PIXEL_FILTER_CELLS);
    uint32_t at = f->guide[slot < SHEEN_PIXEL_FILTER_CELLS ? slot : SHEEN_PIXEL_FILTER_CELLS - 1];
    while (at + 1 < f->n && f->cdf[at + 1] <= q) ++at; // one step in the mean
    // Inside the cell the density is linear, from a to b: t solves a t + (b - a) t^2 / 2 = q (a + b) / 2.
    float a = f->f[at], b = f->f[at + 1], mass = f->cdf[at + 1] - f->cdf[at];
    q = mass > 0.0f ? clampf((q - f->cdf[at]) / mass, 0.0f, 1.0f) : 0.0f;
    float below = a + sqrtf(maxf(a * a + q * (b * b - a * a), 0.0f));
    float x = f->x[at] + (below > 0.0f ? q * (a + b) / below : q) * (f->x[at + 1] - f->x[at]);
    *negative = f->negative[at];
    return u < 0.5f ? -x : x;
}

Vec2 sheen_pixel_filter_sample(const SheenPixelFilter *f, Vec2 u, bool *negative)
{
    *negative = false;
    if (!f) return u;
    bool negative_x, negative_y;
    float x = sample_axis(f, u.x, &negative_x), y = sample_axis(f, u.y, &negative_y);
    *negative = negative_x != negative_y;
    return v2(0.5f + x, 0.5f + y);
}

void sheen_pixel_filter_weights(const SheenPixelFilter *f, uint32_t n, uint32_t n_negative, double weight[2])
{
    weight[0] = weight[1] = 1.0;
    if (!f || !f->has_signs || n == 0) return;
    double negative = (double)n_negative / n, gain = (double)f->gain;
    weight[0] += 2.0 * gain * negative;
    weight[1] -= 2.0 * gain * (1.0 - negative);
}
