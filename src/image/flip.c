// SPDX-License-Identifier: Apache-2.0
// HDR-FLIP: the colour and feature pipelines of andersson2020, over the exposures of andersson2021.
//
// Pixels are kept as planes of one channel and all filters are separable, so that the time goes into plain sums of
// rows.
#include "image/flip.h"

#include "image/plane.h"

#include <stdlib.h>
#include <string.h>

static const float pixels_per_degree = 3840.0f / 180.0f * SHEEN_PI; // 0.7 m away, 0.7 m wide

// Exponent and breakpoint of the colour error, width of a feature in degrees, exponent of the feature error.
static const float qc = 0.7f, pc = 0.4f, pt = 0.95f, feature_width = 0.082f;

// Lab and opponent values are named as the paper names them.
typedef struct Xyz {
    float x, y, z;
} Xyz;
typedef struct Lab {
    float l, a, b;
} Lab;

// Computed from the chromaticities of iec61966-2-1: red (0.64, 0.33), green (0.30, 0.60), blue (0.15, 0.06), white D65
// (0.3127, 0.3290). The white is the sum of the primaries.
static const Xyz white = {0.950455927f, 1.0f, 1.089057751f};

static inline Xyz rgb_to_xyz(Rgb c)
{
    return (Xyz){0.412390799f * c.r + 0.357584339f * c.g + 0.180480788f * c.b,
                 0.212639006f * c.r + 0.715168679f * c.g + 0.072192315f * c.b,
                 0.019330819f * c.r + 0.119194780f * c.g + 0.950532152f * c.b};
}

static inline Rgb xyz_to_rgb(Xyz c)
{
    return (Rgb){3.240969942f * c.x - 1.537383178f * c.y - 0.498610760f * c.z,
                 -0.969243636f * c.x + 1.875967502f * c.y + 0.041555057f * c.z,
                 0.055630080f * c.x - 0.203976959f * c.y + 1.056971514f * c.z};
}

/** Cube root of a positive number to 2e-7: a third of the exponent, two steps of Halley. Unlike cbrtf it is inlined. */
static inline float cube_root(float x)
{
    union {
        float f;
        uint32_t u;
    } guess = {x};
    guess.u = guess.u / 3 + 0x2a5137a0u; // 4 % off at most
    float y = guess.f;
    for (int i = 0; i < 2; ++i) {
        float y3 = y * y * y;
        y *= (y3 + 2.0f * x) / (2.0f * y3 + x);
    }
    return y;
}

static inline float lab_curve(float t)
{
    const float delta = 6.0f / 29.0f;
    return t > delta * delta * delta ? cube_root(t) : t / (3.0f * delta * delta) + 4.0f / 29.0f;
}

/** CIELab of a linear colour in [0, 1], a and b weighted by the lightness (Hunt effect). */
static inline Lab hunt_lab(Rgb c)
{
    Xyz t = rgb_to_xyz(c);
    float x = lab_curve(t.x / white.x), y = lab_curve(t.y / white.y), z = lab_curve(t.z / white.z);
    float l = 116.0f * y - 16.0f;
    return (Lab){l, 0.01f * l * 500.0f * (x - y), 0.01f * l * 200.0f * (y - z)};
}

/** HyAB: city block in lightness, Euclid in the others; good for large differences too. */
static inline float hyab(Lab p, Lab q)
{
    return fabsf(p.l - q.l) + sqrtf(sqrf(p.a - q.a) + sqrf(p.b - q.b));
}

/** Filters of one run. The yellow-blue sensitivity is a sum of two Gaussians, the others are one each. */
typedef struct FlipFilters {
    PlaneFilter y, cx, cz[2];
    float cz_share[2]; // of the two parts, sum 1
    PlaneFilter smooth, edge, point;
} FlipFilters;

/** Samples exp(-pi^2 d^2 / b) at the pixels and normalises. @return the sum before. */
static double make_sensitivity(float b, PlaneFilter *filter)
{
    // One radius for all: three standard deviations of the widest, b = 0.04.
    filter->radius = (int)ceilf(3.0f * sqrtf(0.04f / (2.0f * SHEEN_PI * SHEEN_PI)) * pixels_per_degree);
    double sum = 0.0;
    for (int i = -filter->radius; i <= filter->radius; ++i) {
        double d = (double)i / (double)pixels_per_degree, pi = (double)SHEEN_PI;
        double value = exp(-pi * pi * d * d / (double)b);
        filter->taps[filter->radius + i] = (float)value;
        sum += value;
    }
    for (int i = 0; i <= 2 * filter->radius; ++i) filter->taps[i] = (float)((double)filter->taps[i] / sum);
    return sum;
}

/** Scales the positive weights to a sum of 1 and the negative ones to a sum of -1. */
static void balance(PlaneFilter *filter)
{
    float positive = 0.0f, negative = 0.0f;
    for (int i = 0; i <= 2 * filter->radius; ++i) {
        positive += maxf(filter->taps[i], 0.0f);
        negative -= minf(filter->taps[i], 0.0f);
    }
    for (int i = 0; i <= 2 * filter->radius; ++i) {
        if (filter->taps[i] > 0.0f) filter->taps[i] /= positive;
        if (filter->taps[i] < 0.0f) filter->taps[i] /= negative;
    }
}

static FlipFilters make_filters(void)
{
    FlipFilters f;
    // a and b of the three contrast sensitivities; a sqrt(pi / b) exp(-pi^2 d^2 / b) in the picture.
    make_sensitivity(0.0047f, &f.y);
    make_sensitivity(0.0053f, &f.cx);
    const float a[2] = {34.1f, 13.5f}, b[2] = {0.04f, 0.025f};
    double share[2];
    for (int i = 0; i < 2; ++i) {
        double sum = make_sensitivity(b[i], &f.cz[i]);
        share[i] = (double)a[i] * sqrt((double)(SHEEN_PI / b[i])) * sum * sum;
    }
    for (int i = 0; i < 2; ++i) f.cz_share[i] = (float)(share[i] / (share[0] + share[1]));

    // First and second derivative of a Gaussian in one direction, the Gaussian in the other.
    float sd = 0.5f * feature_width * pixels_per_degree;
    int radius = (int)ceilf(3.0f * sd);
    f.smooth.radius = f.edge.radius = f.point.radius = radius;
    float sum = 0.0f;
    for (int i = -radius; i <= radius; ++i) {
        float g = expf(-(float)(i * i) / (2.0f * sd * sd));
        f.smooth.taps[radius + i] = g;
        f.edge.taps[radius + i] = -(float)i * g;
        f.point.taps[radius + i] = ((float)(i * i) / (sd * sd) - 1.0f) * g;
        sum += g;
    }
    for (int i = 0; i <= 2 * radius; ++i) f.smooth.taps[i] /= sum;
    balance(&f.edge);
    balance(&f.point);
    return f;
}

/** Planes of one run, all [height][width]. */
typedef struct FlipWork {
    uint32_t width, height;
    size_t n;
    FlipFilters filters;
    float *memory;                 // everything below
    float *opponent[3];            // Y, Cx, Cz of one picture
    float *rows, *columns, *extra; // filtered along the rows, then the columns
    float *lab[2][3];              // of the reference and of the image
    float *edge[2], *point[2];     // strength of features
    float *row;                    // one padded row
} FlipWork;

enum { n_planes = 3 + 3 + 6 + 4 };

static SheenStatus work_create(uint32_t width, uint32_t height, const SheenLog *log, FlipWork *w)
{
    *w = (FlipWork){.width = width, .height = height, .n = (size_t)width * height, .filters = make_filters()};
    w->memory = malloc((n_planes * w->n + width + 2 * PLANE_MAX_RADIUS) * sizeof *w->memory);
    if (!w->memory) return sheen_fail(log, SHEEN_ERR_NOMEM, "comparing two pictures: out of memory");
    float *next = w->memory;
    float **const planes[n_planes] = {
        &w->opponent[0], &w->opponent[1], &w->opponent[2], &w->rows,      &w->columns,   &w->extra,
        &w->lab[0][0],   &w->lab[0][1],   &w->lab[0][2],   &w->lab[1][0], &w->lab[1][1], &w->lab[1][2],
        &w->edge[0],     &w->edge[1],     &w->point[0],    &w->point[1],
    };
    for (int i = 0; i < n_planes; ++i, next += w->n) *planes[i] = next;
    w->row = next;
    return SHEEN_OK;
}

/** The fit of the ACES film curve, in [0, 1]. Source: narkowicz2016 with the exposure of andersson2021. */
static inline float aces(float x)
{
    float y = 0.6f * x;
    return clampf(y * (2.51f * y + 0.03f) / (y * (2.43f * y + 0.59f) + 0.14f), 0.0f, 1.0f);
}

/** Exposes, tone-maps and converts to the opponent space YCxCz. */
static void to_opponent(const FlipWork *w, const SheenImage *picture, float scale)
{
    for (size_t i = 0; i < w->n; ++i) {
        Rgb c = picture->pixels[i];
        // Far above white all is white; so that squares stay finite.
        c = (Rgb){aces(clampf(scale * c.r, 0.0f, 1e6f)), aces(clampf(scale * c.g, 0.0f, 1e6f)),
                  aces(clampf(scale * c.b, 0.0f, 1e6f))};
        Xyz t = rgb_to_xyz(c);
        float x = t.x / white.x, y = t.y / white.y, z = t.z / white.z;
        w->opponent[0][i] = 116.0f * y - 16.0f;
        w->opponent[1][i] = 500.0f * (x - y);
        w->opponent[2][i] = 200.0f * (y - z);
    }
}

static void filter_both(const FlipWork *w, const float *in, const PlaneFilter *fx, const PlaneFilter *fy, float *out)
{
    sheen_plane_filter_x(in, w->width, w->height, fx, w->row, w->rows);
    sheen_plane_filter_y(w->rows, w->width, w->height, fy, out);
}

/** Edges and points of the lightness: lengths of the first and of the second derivatives. */
static void detect_features(const FlipWork *w, int which)
{
    const FlipFilters *f = &w->filters;
    const struct {
        const PlaneFilter *derivative;
        float *out;
    } kinds[2] = {{&f->edge, w->edge[which]}, {&f->point, w->point[which]}};
    for (int k = 0; k < 2; ++k) {
        filter_both(w, w->opponent[0], kinds[k].derivative, &f->smooth, w->columns);
        filter_both(w, w->opponent[0], &f->smooth, kinds[k].derivative, w->extra);
        // The filters sum to zero, so that of the normalised lightness (Y + 16) / 116 only the scale remains.
        for (size_t i = 0; i < w->n; ++i) kinds[k].out[i] = sqrtf(sqrf(w->columns[i]) + sqrf(w->extra[i])) / 116.0f;
    }
}

/** What the eye resolves of the colour, as Hunt-adjusted Lab. */
static void filter_color(const FlipWork *w, int which)
{
    const FlipFilters *f = &w->filters;
    float *const *lab = w->lab[which];
    filter_both(w, w->opponent[0], &f->y, &f->y, lab[0]);
    filter_both(w, w->opponent[1], &f->cx, &f->cx, lab[1]);
    filter_both(w, w->opponent[2], &f->cz[0], &f->cz[0], w->columns);
    filter_both(w, w->opponent[2], &f->cz[1], &f->cz[1], w->extra);
    for (size_t i = 0; i < w->n; ++i) {
        float cz = f->cz_share[0] * w->columns[i] + f->cz_share[1] * w->extra[i];
        float y = (lab[0][i] + 16.0f) / 116.0f, x = lab[1][i] / 500.0f + y, z = y - cz / 200.0f;
        Rgb c = xyz_to_rgb((Xyz){x * white.x, y * white.y, z * white.z});
        Lab q = hunt_lab((Rgb){clampf(c.r, 0.0f, 1.0f), clampf(c.g, 0.0f, 1.0f), clampf(c.b, 0.0f, 1.0f)});
        lab[0][i] = q.l;
        lab[1][i] = q.a;
        lab[2][i] = q.b;
    }
}

/** Combines colour and feature errors and keeps the largest of the exposures. */
static void keep_largest(const FlipWork *w, float *map)
{
    // The largest difference that is possible, between green and blue.
    float largest = powf(hyab(hunt_lab((Rgb){0.0f, 1.0f, 0.0f}), hunt_lab((Rgb){0.0f, 0.0f, 1.0f})), qc);
    float bend = pc * largest;
    for (size_t i = 0; i < w->n; ++i) {
        Lab p = {w->lab[0][0][i], w->lab[0][1][i], w->lab[0][2][i]};
        Lab q = {w->lab[1][0][i], w->lab[1][1][i], w->lab[1][2][i]};
        float color = powf(hyab(p, q), qc);
        color = color < bend ? color * pt / bend : pt + (color - bend) / (largest - bend) * (1.0f - pt);
        float edge = fabsf(w->edge[0][i] - w->edge[1][i]), point = fabsf(w->point[0][i] - w->point[1][i]);
        float feature = sqrtf(maxf(edge, point) * 0.70710678f); // the exponent 1/2 is qf
        float error = powf(clampf(color, 0.0f, 1.0f), 1.0f - minf(feature, 1.0f));
        map[i] = maxf(map[i], error);
    }
}

SheenStatus sheen_flip_compute(const SheenImage *reference, const SheenImage *image,
                               const SheenFlipExposures *exposures, const SheenLog *log, float *map)
{
    if (reference->width != image->width || reference->height != image->height)
        return sheen_fail(log, SHEEN_ERR_INVALID, "pictures of different sizes cannot be compared");
    FlipWork w;
    SheenStatus status = work_create(reference->width, reference->height, log, &w);
    if (status) return status;
    memset(map, 0, w.n * sizeof *map);
    const SheenImage *const pictures[2] = {reference, image};
    for (unsigned e = 0; e < exposures->count; ++e) {
        float t = exposures->count > 1 ? (float)e / (float)(exposures->count - 1) : 0.0f;
        float scale = exp2f(lerpf(exposures->start, exposures->stop, t));
        for (int which = 0; which < 2; ++which) {
            to_opponent(&w, pictures[which], scale);
            detect_features(&w, which);
            filter_color(&w, which);
        }
        keep_largest(&w, map);
    }
    free(w.memory);
    return SHEEN_OK;
}

static int by_value(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

SheenStatus sheen_flip_exposures(const SheenImage *reference, const SheenLog *log, SheenFlipExposures *out)
{
    size_t n = (size_t)reference->width * reference->height;
    float *luminance = malloc(n * sizeof *luminance);
    if (!luminance) return sheen_fail(log, SHEEN_ERR_NOMEM, "comparing two pictures: out of memory");
    for (size_t i = 0; i < n; ++i) {
        Rgb c = reference->pixels[i];
        luminance[i] = 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b;
    }
    qsort(luminance, n, sizeof *luminance, by_value);
    float largest = luminance[n - 1], median = luminance[n / 2];
    free(luminance);
    if (!(largest > 0.0f)) {
        *out = (SheenFlipExposures){0.0f, 0.0f, 1};
        return SHEEN_OK;
    }
    // The luminance that the tone curve maps to 0.85: the positive root of
    // 0.36 (2.51 - 0.85 2.43) x^2 + 0.6 (0.03 - 0.85 0.59) x - 0.85 0.14 = 0.
    const float t = 0.85f, a = 0.36f * (2.51f - t * 2.43f), b = 0.6f * (0.03f - t * 0.59f), c = -t * 0.14f;
    float bright = (-b + sqrtf(b * b - 4.0f * a * c)) / (2.0f * a);
    // The brightest pixel just not white at the first exposure, the median at the last.
    out->start = log2f(bright / largest);
    out->stop = maxf(log2f(bright / maxf(median, 0x1p-23f)), out->start);
    out->count = (unsigned)maxf(2.0f, ceilf(out->stop - out->start));
    return SHEEN_OK;
}
