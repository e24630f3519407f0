// SPDX-License-Identifier: Apache-2.0
// Three scenes around a point at z = 0, normal +z, whose light is known in closed form, the bases in double and from
// their definitions, and the coefficients of radiance by quadrature: what gathers are judged by.
#ifndef SHEEN_TESTS_ANALYTIC_RADIANCE_KIT_H
#define SHEEN_TESTS_ANALYTIC_RADIANCE_KIT_H

#include "basis/basis.h"

#include <math.h>
#include <string.h>

enum { KIT_ORDER_MAX = 12, KIT_BASIS_MAX = KIT_ORDER_MAX * KIT_ORDER_MAX };

typedef struct Double3 {
    double x, y, z;
} Double3;

static inline Double3 d3(double x, double y, double z)
{
    return (Double3){x, y, z};
}
static inline Double3 d3_mad(Double3 a, double s, Double3 b)
{
    return d3(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}
static inline double d3_dot(Double3 a, Double3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// ---- scenes -----------------------------------------------------------------------------------------------------

/** What a ray meets: radiance, distance (INFINITY for a miss), and the normal toward the ray's origin. */
typedef struct Seen {
    double L, r;
    Double3 n;
} Seen;
typedef Seen KitScene(Double3 p, Double3 d);

static inline double kit_box_radiance(Double3 q)
{
    return 1.0 + 0.25 * q.x + 0.15 * q.y * q.z;
}

/** A: inside the box [0, 4] x [0, 3] x [0, 2.5], whose walls and ceiling emit. Nothing hides anything. */
static inline Seen kit_box(Double3 p, Double3 d)
{
    double tx = d.x > 0 ? (4.0 - p.x) / d.x : d.x < 0 ? -p.x / d.x : INFINITY;
    double ty = d.y > 0 ? (3.0 - p.y) / d.y : d.y < 0 ? -p.y / d.y : INFINITY;
    double tz = d.z > 0 ? (2.5 - p.z) / d.z : INFINITY;
    double t = fmin(tx, fmin(ty, tz));
    Double3 n = t == tx ? d3(d.x > 0 ? -1 : 1, 0, 0) : t == ty ? d3(0, d.y > 0 ? -1 : 1, 0) : d3(0, 0, -1);
    return (Seen){kit_box_radiance(d3_mad(p, t, d)), t, n};
}

static const Double3 kit_center = {0.5, 0.2, 0.9};
static const double kit_radius = 0.3;

static inline double kit_sphere_distance(Double3 p, Double3 d)
{
    Double3 v = d3_mad(kit_center, -1.0, p);
    double b = d3_dot(d, v), disc = b * b - (d3_dot(v, v) - kit_radius * kit_radius);
    return disc > 0 && b > 0 ? b - sqrt(disc) : INFINITY;
}

/** B1: a sphere emits 1 on black. */
static inline Seen kit_bright_sphere(Double3 p, Double3 d)
{
    double t = kit_sphere_distance(p, d);
    if (isinf(t)) return (Seen){0.0, t, d3(0, 0, 0)};
    Double3 v = d3_mad(d3_mad(p, t, d), -1.0, kit_center);
    return (Seen){1.0, t, d3(v.x / kit_radius, v.y / kit_radius, v.z / kit_radius)};
}

static inline double kit_ceiling_radiance(Double3 p, Double3 d)
{
    Double3 q = d3_mad(p, (2.0 - p.z) / d.z, d);
    return 1.0 / (1.0 + (q.x * q.x + q.y * q.y) / 4.0);
}

/** B2: the same sphere is black under an infinite ceiling at z = 2 that emits. */
static inline Seen kit_dark_sphere(Double3 p, Double3 d)
{
    Seen s = kit_bright_sphere(p, d);
    if (!isinf(s.r)) return (Seen){0.0, s.r, s.n};
    return (Seen){kit_ceiling_radiance(p, d), (2.0 - p.z) / d.z, d3(0, 0, -1)};
}

// ---- bases ------------------------------------------------------------------------------------------------------

/** All functions, by the recurrences of the Legendre functions. @param out  [n * n] */
static inline void kit_basis(SheenBasis basis, unsigned n, double cos_theta, double phi, double out[])
{
    static const double pi = 3.141592653589793;
    double x = basis == SHEEN_BASIS_HSH ? 2.0 * cos_theta - 1.0 : cos_theta, s = sqrt(fmax(0.0, 1.0 - x * x));
    double stretch = basis == SHEEN_BASIS_HSH ? 2.0 : 1.0, diagonal = 1.0;
    for (unsigned m = 0; m < n; ++m) {
        if (m) diagonal *= -(2.0 * m - 1.0) * s;
        double before = 0.0, here = diagonal, c = cos(m * phi), d = sin(m * phi);
        for (unsigned l = m; l < n; ++l) {
            double K2 = stretch * (m ? 2.0 : 1.0) * (2.0 * l + 1.0) / (4.0 * pi);
            for (unsigned i = l - m + 1; i <= l + m; ++i) K2 /= i;
            out[basis_index(l, (int)m)] = sqrt(K2) * here * c;
            if (m) out[basis_index(l, -(int)m)] = sqrt(K2) * here * d;
            double next = ((2.0 * l + 1.0) * x * here - (double)(l + m) * before) / (l - m + 1.0);
            before = here;
            here = next;
        }
    }
}

// ---- quadrature -------------------------------------------------------------------------------------------------

enum { KIT_NODES = 48 };

/** Nodes and weights of Gauss and Legendre on [0, 1]. */
typedef struct Gauss {
    double x[KIT_NODES], w[KIT_NODES];
} Gauss;

static inline void kit_gauss(Gauss *g)
{
    for (int i = 0; i < KIT_NODES; ++i) {
        double x = cos(3.141592653589793 * (i + 0.75) / (KIT_NODES + 0.5)), slope = 1.0;
        for (int round = 0; round < 6; ++round) { // Newton
            double before = 0.0, p = 1.0;
            for (int l = 0; l < KIT_NODES; ++l) {
                double next = ((2.0 * l + 1.0) * x * p - l * before) / (l + 1.0);
                before = p;
                p = next;
            }
            slope = KIT_NODES * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        g->x[i] = 0.5 * (x + 1.0);
        g->w[i] = 1.0 / ((1.0 - x * x) * slope * slope);
    }
}

/** Coefficients that a quadrature adds up. */
typedef struct Coefficients {
    SheenBasis basis;
    unsigned n;
    double of[KIT_BASIS_MAX];
} Coefficients;

static inline void kit_add(Coefficients *c, Double3 d, double weight)
{
    double b[KIT_BASIS_MAX];
    kit_basis(c->basis, c->n, d.z, atan2(d.y, d.x), b);
    for (unsigned i = 0; i < c->n * c->n; ++i) c->of[i] += weight * b[i];
}

// A point of a wall, `side` wide.
static inline void kit_add_wall(Coefficients *c, Double3 p, Double3 q, Double3 n, double side)
{
    Double3 v = d3_mad(q, -1.0, p);
    double r = sqrt(d3_dot(v, v));
    Double3 d = d3(v.x / r, v.y / r, v.z / r);
    kit_add(c, d, kit_box_radiance(q) * side * -d3_dot(d, n) / (r * r));
}

// Walls are split before the point. Their heights are squares: that takes the root out of the functions at the floor.
static inline void kit_integrate_box(const Gauss *g, Double3 p, Coefficients *c)
{
    const double split_x[3] = {0, p.x, 4}, split_y[3] = {0, p.y, 3}, Z = 2.5;
    for (int half = 0; half < 4; ++half)
        for (int i = 0; i < KIT_NODES; ++i)
            for (int k = 0; k < KIT_NODES; ++k) {
                double x0 = split_x[half & 1], wx = split_x[(half & 1) + 1] - x0, x = x0 + wx * g->x[i];
                double y0 = split_y[half >> 1], wy = split_y[(half >> 1) + 1] - y0, y = y0 + wy * g->x[k];
                kit_add_wall(c, p, d3(x, y, Z), d3(0, 0, -1), g->w[i] * wx * g->w[k] * wy);
                double z = Z * g->x[k] * g->x[k], dz = g->w[k] * Z * 2.0 * g->x[k];
                int far = half >> 1; // of two walls that face each other
                x0 = split_x[half & 1];
                kit_add_wall(c, p, d3(x0 + wx * g->x[i], far ? 3 : 0, z), d3(0, far ? -1 : 1, 0), g->w[i] * wx * dz);
                y0 = split_y[half & 1], wy = split_y[(half & 1) + 1] - y0;
                kit_add_wall(c, p, d3(far ? 4 : 0, y0 + wy * g->x[i], z), d3(far ? -1 : 1, 0, 0), g->w[i] * wy * dz);
            }
}

// `sign` times what comes through the cone of the sphere: radiance 1, or that of the ceiling behind it.
static inline void kit_integrate_cone(const Gauss *g, Double3 p, bool ceiling, double sign, Coefficients *c)
{
    Double3 v = d3_mad(kit_center, -1.0, p);
    double r2 = d3_dot(v, v), r = sqrt(r2), height = 1.0 - sqrt(1.0 - kit_radius * kit_radius / r2);
    Double3 axis = d3(v.x / r, v.y / r, v.z / r);
    double flat = hypot(axis.y, axis.z);
    Double3 t = d3(0, axis.z / flat, -axis.y / flat);
    Double3 b = d3(axis.y * t.z - axis.z * t.y, axis.z * t.x - axis.x * t.z, axis.x * t.y - axis.y * t.x);
    for (int i = 0; i < KIT_NODES; ++i)
        for (int k = 0; k < KIT_NODES; ++k) {
            double u = 1.0 - height * g->x[i], s = sqrt(1.0 - u * u), phi = 2.0 * 3.141592653589793 * k / KIT_NODES;
            Double3 d = d3_mad(d3_mad(d3(u * axis.x, u * axis.y, u * axis.z), s * cos(phi), t), s * sin(phi), b);
            double weight = sign * height * g->w[i] * 2.0 * 3.141592653589793 / KIT_NODES;
            kit_add(c, d, ceiling ? weight * kit_ceiling_radiance(p, d) : weight);
        }
}

static inline void kit_integrate_ceiling(const Gauss *g, Double3 p, Coefficients *c)
{
    enum { TURNS = 96 };
    for (int i = 0; i < KIT_NODES; ++i)
        for (int k = 0; k < TURNS; ++k) {
            double z = g->x[i] * g->x[i], s = sqrt(1.0 - z * z), phi = 2.0 * 3.141592653589793 * k / TURNS;
            Double3 d = d3(s * cos(phi), s * sin(phi), z);
            kit_add(c, d, g->w[i] * 2.0 * g->x[i] * 2.0 * 3.141592653589793 / TURNS * kit_ceiling_radiance(p, d));
        }
    kit_integrate_cone(g, p, true, -1.0, c);
}

/** One of the scenes, and the point in it. */
typedef struct KitCase {
    const char *name;
    KitScene *scene;
    Double3 p;
} KitCase;

enum { KIT_CASES = 3 };
static const KitCase kit_cases[KIT_CASES] = {{"box", kit_box, {1.2, 1.1, 0}},
                                             {"bright sphere", kit_bright_sphere, {0, 0, 0}},
                                             {"dark sphere", kit_dark_sphere, {0, 0, 0}}};

static inline void kit_integrate(const Gauss *g, KitScene *scene, Double3 p, Coefficients *c)
{
    memset(c->of, 0, sizeof c->of);
    if (scene == kit_box)
        kit_integrate_box(g, p, c);
    else if (scene == kit_bright_sphere)
        kit_integrate_cone(g, p, false, 1.0, c);
    else
        kit_integrate_ceiling(g, p, c);
}

/** Exact coefficients and gradients. */
typedef struct KitTruth {
    double lambda[KIT_BASIS_MAX], slope[2][KIT_BASIS_MAX]; // d/dx, d/dy
} KitTruth;

/** Quadrature, and its central differences of fourth order. */
static inline void kit_truth(const KitCase *k, SheenBasis basis, unsigned n, KitTruth *out)
{
    const double h = 2e-3;
    Gauss g;
    kit_gauss(&g);
    Coefficients c = {basis, n, {0}};
    kit_integrate(&g, k->scene, k->p, &c);
    memcpy(out->lambda, c.of, sizeof c.of);
    memset(out->slope, 0, sizeof out->slope);
    for (int axis = 0; axis < 2; ++axis)
        for (int step = -2; step <= 2; ++step) {
            if (!step) continue;
            double weight = (step > 0 ? 1.0 : -1.0) * (step * step == 1 ? 8.0 : -1.0) / (12.0 * h);
            kit_integrate(&g, k->scene, d3_mad(k->p, step * h, axis ? d3(0, 1, 0) : d3(1, 0, 0)), &c);
            for (unsigned i = 0; i < n * n; ++i) out->slope[axis][i] += weight * c.of[i];
        }
}

#endif
