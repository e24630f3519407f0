// SPDX-License-Identifier: Apache-2.0
// The gradients that follow what the rays hit: by derivatives, and by finite differences.
#include "gather/radiance_gradient.h"

#include <string.h>

// Least cosine at a hit that the change of its solid angle is divided by.
static const float cos_least = 0.05f;

/** What a ray hits, seen from the point. */
typedef struct Facet {
    Vec3 d;        // toward it
    Vec3 n;        // its normal on the side of the point
    float inverse; // one over the distance; 0 for the sky
    float cos_hit; // between n and the way back
} Facet;

static Facet facet_of(const RadianceSamples *s, size_t i)
{
    Facet f = {s->directions[i], s->normals[i], inverse_distance(s->distance[i]), 0.0f};
    f.cos_hit = -v3_dot(f.n, f.d);
    if (f.cos_hit < 0.0f) {
        f.n = v3_neg(f.n);
        f.cos_hit = -f.cos_hit;
    }
    return f;
}

/** Gradients of one coefficient: d/dx, then d/dy; per channel. */
typedef struct Slope {
    double of[6];
} Slope;

// ---- by derivatives ---------------------------------------------------------------------------------------------

/*
 * Distance times the derivative of ln(solid angle), for a shift along x (y): 3 d_x + n_x / cos(xi), whose parts that
 * stem from the turn of the facet, d_x + n_x / cos(xi), have the bounded divisor.
 */
static Vec2 solid_angle_slope(const Facet *f)
{
    float cos_hit = maxf(f->cos_hit, cos_least);
    return v2(2.0f * f->d.x + (f->n.x + f->cos_hit * f->d.x) / cos_hit,
              2.0f * f->d.y + (f->n.y + f->cos_hit * f->d.y) / cos_hit);
}

// theta changes by -cos(theta) cos(phi) / r, phi by sin(phi) / (r sin(theta)) for a shift along x; along y by
// -cos(theta) sin(phi) / r and -cos(phi) / (r sin(theta)). The basis' derivatives contain cos(theta), 1 / sin(theta).
static void add_facet(const SheenRadianceTables *t, const Facet *f, Rgb L, Slope gradient[])
{
    float value[SHEEN_BASIS_MAX], by_theta[SHEEN_BASIS_MAX], by_phi[SHEEN_BASIS_MAX];
    sheen_basis_eval(t->basis, t->n, f->d, value);
    sheen_basis_derive(t->basis, t->n, f->d, by_theta, by_phi);
    float sin_theta = sqrtf(sqrf(f->d.x) + sqrf(f->d.y));
    Vec2 turn = sin_theta > 0.0f ? v2(f->d.x / sin_theta, f->d.y / sin_theta) : v2(1.0f, 0.0f);
    Vec2 wider = solid_angle_slope(f);
    L = rgb_scale(L, f->inverse);
    for (size_t i = 0; i < basis_size(t->n); ++i) {
        float x = wider.x * value[i] - turn.x * by_theta[i] + turn.y * by_phi[i];
        float y = wider.y * value[i] - turn.y * by_theta[i] - turn.x * by_phi[i];
        double *sum = gradient[i].of;
        sum[0] += (double)(x * L.r);
        sum[1] += (double)(x * L.g);
        sum[2] += (double)(x * L.b);
        sum[3] += (double)(y * L.r);
        sum[4] += (double)(y * L.g);
        sum[5] += (double)(y * L.b);
    }
}

static void scale_out(const SheenRadianceTables *t, const Slope gradient[], Rgb dx[], Rgb dy[])
{
    double per_cell = 6.283185307179586 / strata_count(t->strata);
    for (size_t i = 0; i < basis_size(t->n); ++i) {
        const double *g = gradient[i].of;
        dx[i] = rgb((float)(per_cell * g[0]), (float)(per_cell * g[1]), (float)(per_cell * g[2]));
        dy[i] = rgb((float)(per_cell * g[3]), (float)(per_cell * g[4]), (float)(per_cell * g[5]));
    }
}

void sheen_radiance_gradient_analytical(const SheenRadianceTables *t, const RadianceSamples *samples, Rgb dx[],
                                        Rgb dy[])
{
    Slope gradient[SHEEN_BASIS_MAX];
    memset(gradient, 0, basis_size(t->n) * sizeof *gradient);
    for (size_t i = 0; i < strata_count(t->strata); ++i) {
        Facet f = facet_of(samples, i);
        if (f.inverse > 0.0f) add_facet(t, &f, samples->L[i], gradient);
    }
    scale_out(t, gradient, dx, dy);
}

// ---- by differences ---------------------------------------------------------------------------------------------

enum { CELLS_AT_ONCE = 64 };

/** Directions and values whose sum of products with the basis is a sum of differences. */
typedef struct Differences {
    Vec3 w[2 * CELLS_AT_ONCE];
    Rgb value[2 * CELLS_AT_ONCE];
    size_t n;
} Differences;

// The facet from the point shifted by `shift` of the facet's distance, weighed by its change of solid angle.
static void add_shifted(const Facet *f, Vec3 shift, Rgb L, Differences *out)
{
    Vec3 to = v3_sub(f->d, shift);
    float r = v3_length(to);
    Vec3 w = v3_scale(to, 1.0f / r);
    float wider = 1.0f + (-v3_dot(f->n, w) - f->cos_hit) / maxf(f->cos_hit, cos_least);
    out->w[out->n] = w;
    out->value[out->n++] = rgb_scale(L, wider / (r * r));
}

static void add_differences(const SheenRadianceTables *t, const Differences *d, unsigned axis, Slope gradient[])
{
    Rgb sum[SHEEN_BASIS_MAX];
    sheen_basis_project(t->basis, t->n, d->n, d->w, d->value, sum);
    for (size_t i = 0; i < basis_size(t->n); ++i) {
        double *of = gradient[i].of + (size_t)3 * axis;
        of[0] += (double)sum[i].r;
        of[1] += (double)sum[i].g;
        of[2] += (double)sum[i].b;
    }
}

void sheen_radiance_gradient_numerical(const SheenRadianceTables *t, const RadianceSamples *samples, Rgb dx[], Rgb dy[])
{
    // In units of the distance. Differences leave out step^2 / 6 of the third derivative, 2e-4 of the gradient for
    // order 10, and have the rounding of sums of floats over the step, about 5e-5 of it; smaller steps trade one for
    // the other.
    const float step = 3e-3f;
    Slope gradient[SHEEN_BASIS_MAX];
    memset(gradient, 0, basis_size(t->n) * sizeof *gradient);
    size_t cells = strata_count(t->strata);
    for (size_t first = 0; first < cells; first += CELLS_AT_ONCE) {
        size_t end = cells - first < CELLS_AT_ONCE ? cells : first + CELLS_AT_ONCE;
        for (unsigned axis = 0; axis < 2; ++axis) {
            Differences d;
            d.n = 0;
            Vec3 shift = axis ? v3(0.0f, step, 0.0f) : v3(step, 0.0f, 0.0f);
            for (size_t i = first; i < end; ++i) {
                Facet f = facet_of(samples, i);
                if (!(f.inverse > 0.0f)) continue;
                Rgb L = rgb_scale(samples->L[i], f.inverse / (2.0f * step));
                add_shifted(&f, shift, L, &d);
                add_shifted(&f, v3_neg(shift), rgb_scale(L, -1.0f), &d);
            }
            add_differences(t, &d, axis, gradient);
        }
    }
    scale_out(t, gradient, dx, dy);
}
