// SPDX-License-Identifier: Apache-2.0
#include "scene/filter.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

SheenFilter sheen_filter_gaussian(float stddev)
{
    return (SheenFilter){.kind = SHEEN_FILTER_GAUSSIAN, .radius = 4.0f * stddev, .stddev = stddev};
}

SheenFilter sheen_filter_standard(SheenFilterKind kind)
{
    SheenFilter f = {.kind = kind};
    switch (kind) {
    case SHEEN_FILTER_TENT:
        f.radius = 1.0f;
        break;
    case SHEEN_FILTER_GAUSSIAN:
        return sheen_filter_gaussian(0.5f);
    case SHEEN_FILTER_MITCHELL:
        f.radius = 2.0f;
        f.b = f.c = (float)(1.0 / 3.0);
        break;
    case SHEEN_FILTER_CATMULL_ROM:
        f.radius = 2.0f;
        f.c = 0.5f;
        break;
    case SHEEN_FILTER_LANCZOS:
        f.radius = 3.0f;
        break;
    case SHEEN_FILTER_BOX:
        f.radius = 0.5f;
        break;
    case SHEEN_FILTER_UNSET:
    case SHEEN_FILTER_KINDS:
        break;
    }
    return f;
}

static double cubic(double x, double b, double c)
{
    if (x < 1.0)
        return ((12.0 - 9.0 * b - 6.0 * c) * x * x * x + (-18.0 + 12.0 * b + 6.0 * c) * x * x + 6.0 - 2.0 * b) / 6.0;
    return ((-b - 6.0 * c) * x * x * x + (6.0 * b + 30.0 * c) * x * x - (12.0 * b + 48.0 * c) * x + 8.0 * b +
            24.0 * c) /
           6.0;
}

static double sinc(double x)
{
    return x < 1e-8 ? 1.0 : sin(PI * x) / (PI * x);
}

double sheen_filter_eval(const SheenFilter *f, double x)
{
    double radius = (double)f->radius;
    x = fabs(x);
    if (!(x < radius)) return 0.0;
    switch (f->kind) {
    case SHEEN_FILTER_TENT:
        return 1.0 - x / radius;
    case SHEEN_FILTER_GAUSSIAN: {
        double k = -0.5 / ((double)f->stddev * (double)f->stddev);
        return exp(k * x * x) - exp(k * radius * radius);
    }
    case SHEEN_FILTER_MITCHELL:
    case SHEEN_FILTER_CATMULL_ROM:
        return cubic(x, (double)f->b, (double)f->c);
    case SHEEN_FILTER_LANCZOS:
        return sinc(x) * sinc(x / radius);
    case SHEEN_FILTER_UNSET:
    case SHEEN_FILTER_BOX:
    case SHEEN_FILTER_KINDS:
        break;
    }
    return 1.0;
}
