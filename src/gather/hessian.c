// SPDX-License-Identifier: Apache-2.0
// One edge between two triangles of the virtual mesh. The point is at the origin, w0 and w1 are the directions of the
// edge's ends, q0 and q1 one over their distances, P the angle between them, f the weight of a direction: z . w for
// irradiance. As the point moves by s, the edge moves by q (s . n) radians out of the triangle to its left, where
// n = w0 x w1 / sin(P), and what that triangle sends grows by the integral of this times f over the edge's angle. The
// ends of the edge stay where they are, so that another derivative needs no more than those of f and q. With <> the
// mean over the angle and F = P / sin(P):
//
//     grad = (w0 x w1) F <f q>        Hess = sym (w0 x w1) (4 F <f q^2 w> - F <g q^2>)'
//
// times the radiance to the left less that to the right, where sym A = (A + A') / 2 and g is the gradient of
// |v| f(v / |v|), which is z for irradiance and drops out. (The edges' terms differ from those of
// schwarzhaupt2012-hessian by what cancels around a triangle.) Where the edge is seen at angle t from w0, its direction
// and one over its distance are the same mixture of those at the ends, and so is z . w:
//
//     w = A w0 + B w1,  q = A q0 + B q1,  A = sin(P - t) / sin(P),  B = sin(t) / sin(P).
//
// Nothing here divides by the length of the edge or the area seen, as |r0 x r1|^2 |e|^2 of the published forms: short
// edges, edges that point at the observer and ends at infinity (q = 0) need no care.
//
// The means are F <A^2>, F <AB>, F <A^4>, F <A^3 B>, F <A^2 B^2>. Since |w| = 1, A^2 + B^2 + 2 A B cos(P) = 1, so that
// two of them give the others. They are derivatives of F with respect to x = 1 - cos(P): F <AB> = F' / 2 and
// F <A^2 B^2> = F'' / 8, and F = sum_n x^n 2^n (n!)^2 / (2n + 1)!.
#include "gather/hessian.h"

#include <float.h>
#include <stddef.h>

/** What a gather knows. */
typedef struct Samples {
    SheenStrata s;
    const Vec3 *directions;
    const Vec3 *weight; // NULL: the cosine's, (0, 0, 1)
    const Rgb *L;
    const float *distance;
} Samples;

/** A vertex of the mesh. */
typedef struct Vertex {
    double x, y, z;   // direction
    double q;         // one over the distance, 0 for the sky
    double f, gx, gy; // weight, and that part of g which is in the plane
    double L;         // luminance
} Vertex;

typedef struct EdgeSum {
    double x, y;       // gradient
    double xx, xy, yy; // Hessian
} EdgeSum;

/** F <.> of products of A and B. */
typedef struct EdgeMeans {
    double aa, ab, aaaa, aaab, aabb;
} EdgeMeans;

// Within this the series below are exact to 1e-7: angles to 29 degrees.
static const double SERIES_MAX = 0.125;

static EdgeMeans edge_means(double x)
{
    static const double a[] = {1.0,       1.0 / 3,     2.0 / 15,    2.0 / 35,      8.0 / 315,
                               8.0 / 693, 16.0 / 3003, 16.0 / 6435, 128.0 / 109395};
    double f = a[8], f1 = 8 * a[8], f2 = 56 * a[8];
    for (int n = 7; n >= 0; --n) f = f * x + a[n];
    for (int n = 7; n >= 1; --n) f1 = f1 * x + n * a[n];
    for (int n = 7; n >= 2; --n) f2 = f2 * x + n * (n - 1) * a[n];
    double c = 1.0 - x;
    EdgeMeans m = {.ab = 0.5 * f1, .aabb = 0.125 * f2};
    m.aa = 0.5 * f - c * m.ab;
    m.aaab = 0.5 * m.ab - c * m.aabb;
    m.aaaa = m.aa - m.aabb - 2.0 * c * m.aaab;
    return m;
}

static void add_short_edge(const Vertex *v0, const Vertex *v1, double x, double dL, EdgeSum *sum)
{
    EdgeMeans e = edge_means(x);
    double q0 = v0->q, q1 = v1->q, q00 = q0 * q0, q01 = 2.0 * q0 * q1, q11 = q1 * q1;
    double ax = dL * (v0->y * v1->z - v0->z * v1->y), ay = dL * (v0->z * v1->x - v0->x * v1->z);
    double fq = e.aa * (v0->f * q0 + v1->f * q1) + e.ab * (v0->f * q1 + v1->f * q0);
    double qq = e.aa * (q00 + q11) + e.ab * q01;
    // f q^2 = c0 A^3 + c1 A^2 B + c2 A B^2 + c3 B^3
    double c0 = v0->f * q00, c1 = v1->f * q00 + v0->f * q01, c2 = v0->f * q11 + v1->f * q01, c3 = v1->f * q11;
    double b0 = 4.0 * (e.aaaa * c0 + e.aaab * (c1 + c3) + e.aabb * c2);
    double b1 = 4.0 * (e.aaaa * c3 + e.aaab * (c2 + c0) + e.aabb * c1);
    double bx = b0 * v0->x + b1 * v1->x - 0.5 * (v0->gx + v1->gx) * qq;
    double by = b0 * v0->y + b1 * v1->y - 0.5 * (v0->gy + v1->gy) * qq;
    sum->x += ax * fq;
    sum->y += ay * fq;
    sum->xx += ax * bx;
    sum->xy += 0.5 * (ax * by + ay * bx);
    sum->yy += ay * by;
}

// A longer edge is halved, by angle: four times is enough for any whose ends are not opposite.
static void add_long_edge(const Vertex *v0, const Vertex *v1, double dL, int halvings, EdgeSum *sum)
{
    double x = 1.0 - (v0->x * v1->x + v0->y * v1->y + v0->z * v1->z);
    if (x <= SERIES_MAX) {
        add_short_edge(v0, v1, x, dL, sum);
        return;
    }
    if (halvings == 0) return;
    Vertex middle = {.x = v0->x + v1->x, .y = v0->y + v1->y, .z = v0->z + v1->z};
    double length = sqrt(middle.x * middle.x + middle.y * middle.y + middle.z * middle.z);
    middle.x /= length;
    middle.y /= length;
    middle.z /= length;
    middle.q = (v0->q + v1->q) / length;
    middle.f = (v0->f + v1->f) / length;
    middle.gx = 0.5 * (v0->gx + v1->gx);
    middle.gy = 0.5 * (v0->gy + v1->gy);
    add_long_edge(v0, &middle, dL, halvings - 1, sum);
    add_long_edge(&middle, v1, dL, halvings - 1, sum);
}

// @param left, right  radiances beside the edge, as seen along it from v0 with z up
static inline void add_edge(const Vertex *v0, const Vertex *v1, double left, double right, EdgeSum *sum)
{
    double dL = left - right;
    if (dL == 0.0) return;
    double x = 1.0 - (v0->x * v1->x + v0->y * v1->y + v0->z * v1->z);
    if (x <= SERIES_MAX)
        add_short_edge(v0, v1, x, dL, sum);
    else
        add_long_edge(v0, v1, dL, 4, sum);
}

// Vertices much nearer than the farthest stand on an occluder: what is between the two is background.
static double triangle_radiance(const Vertex *a, const Vertex *b, const Vertex *c)
{
    const Vertex *v[] = {a, b, c}, *far = a->q < b->q ? a : b;
    double limit = 1.5 * (c->q < far->q ? c->q : far->q), sum = 0.0;
    int n = 0;
    for (unsigned i = 0; i < 3; ++i)
        if (v[i]->q <= limit) {
            sum += v[i]->L;
            ++n;
        }
    return sum / n; // exact where all are alike
}

/** The vertices of a sector: [0] the pole, [1..rings] the samples, [rings + 1] on the horizon. */
typedef struct Meridian {
    Vertex v[SHEEN_RINGS_MAX + 2];
} Meridian;

static Vec3 weight_at(const Samples *in, size_t i)
{
    if (!in->weight) return v3(0.0f, 0.0f, 1.0f);
    return v3_finite(in->weight[i]) ? in->weight[i] : v3(0.0f, 0.0f, 0.0f);
}

static Vertex vertex(const Samples *in, size_t i)
{
    Vec3 d = in->directions[i], g = weight_at(in, i);
    float luminance = rgb_luminance(in->L[i]), distance = in->distance[i];
    return (Vertex){.x = (double)d.x,
                    .y = (double)d.y,
                    .z = (double)d.z,
                    .q = distance > 0.0f ? 1.0 / fmax((double)distance, 1e-15) : 0.0,
                    .f = (double)v3_dot(g, d),
                    .gx = (double)g.x,
                    .gy = (double)g.y,
                    .L = isfinite(luminance) ? (double)luminance : 0.0};
}

// The mean of the innermost ring; g is taken for constant within it, so that f at the pole is g . z.
static Vertex pole_of(const Samples *in)
{
    Vertex pole = {.z = 1.0};
    double N = in->s.sectors;
    for (unsigned k = 0; k < in->s.sectors; ++k) {
        Vertex v = vertex(in, (size_t)k * in->s.rings);
        pole.q += v.q;
        pole.f += (double)weight_at(in, (size_t)k * in->s.rings).z;
        pole.gx += v.gx;
        pole.gy += v.gy;
        pole.L += v.L;
    }
    // Divided after the sum: exact where all are alike.
    return (Vertex){.z = 1.0, .q = pole.q / N, .f = pole.f / N, .gx = pole.gx / N, .gy = pole.gy / N, .L = pole.L / N};
}

static void read_meridian(const Samples *in, unsigned k, Meridian *m)
{
    unsigned rings = in->s.rings;
    size_t first = (size_t)(k % in->s.sectors) * rings;
    for (unsigned j = 0; j < rings; ++j) m->v[j + 1] = vertex(in, first + j);
    // Let fall onto the plane, walls stay walls. Nothing from there counts: f and g are 0 but for g's z.
    const Vertex *last = &m->v[rings];
    double sine = sqrt(last->x * last->x + last->y * last->y), inverse = sine > 0.0 ? 1.0 / sine : 0.0;
    m->v[rings + 1] = (Vertex){.x = last->x * inverse, .y = last->y * inverse, .q = last->q * inverse, .L = last->L};
}

/** Radiance of the triangles between two meridians: each quad from j to j + 1 is cut from (j + 1) to (j, next). */
typedef struct Strip {
    double inner[SHEEN_RINGS_MAX + 1], outer[SHEEN_RINGS_MAX + 1];
} Strip;

static void fill_strip(unsigned rings, const Meridian *here, const Meridian *next, Strip *out)
{
    const Vertex *a = here->v, *b = next->v;
    for (unsigned j = 0; j <= rings; ++j) {
        out->outer[j] = triangle_radiance(&a[j + 1], &b[j + 1], &b[j]);
        out->inner[j] = j ? triangle_radiance(&a[j], &a[j + 1], &b[j]) : out->outer[0]; // at the pole there is one
    }
}

// The edges of one meridian, and those from it to the next. Edges along the horizon do not move with the point.
static void add_strip(unsigned rings, const Meridian *here, const Meridian *next, const Strip *before,
                      const Strip *after, EdgeSum *sum)
{
    const Vertex *a = here->v, *b = next->v;
    for (unsigned j = 0; j <= rings; ++j) {
        add_edge(&a[j], &a[j + 1], after->inner[j], before->outer[j], sum);
        add_edge(&a[j + 1], &b[j], after->inner[j], after->outer[j], sum);
        if (j < rings) add_edge(&a[j + 1], &b[j + 1], after->outer[j], after->inner[j + 1], sum);
    }
}

static float finite_float(double x)
{
    return isfinite(x) ? (float)fmax(-(double)FLT_MAX, fmin(x, (double)FLT_MAX)) : 0.0f;
}

void sheen_estimate_lobe_hessian(SheenStrata s, const Vec3 directions[], const Vec3 weight[], const Rgb L[],
                                 const float distance[], IrradianceHessian *out, float gradient[2])
{
    const Samples in = {s, directions, weight, L, distance};
    Meridian meridians[2], *here = &meridians[0], *next = &meridians[1];
    Strip strips[2], *before = &strips[0], *after = &strips[1];
    EdgeSum sum = {0, 0, 0, 0, 0};
    here->v[0] = next->v[0] = pole_of(&in);
    read_meridian(&in, s.sectors - 1, next);
    read_meridian(&in, 0, here);
    fill_strip(s.rings, next, here, before);
    for (unsigned k = 0; k < s.sectors; ++k) {
        read_meridian(&in, k + 1, next);
        fill_strip(s.rings, here, next, after);
        add_strip(s.rings, here, next, before, after, &sum);
        Meridian *m = here;
        here = next;
        next = m;
        Strip *t = before;
        before = after;
        after = t;
    }
    *out = (IrradianceHessian){finite_float(sum.xx), finite_float(sum.xy), finite_float(sum.yy)};
    if (!gradient) return;
    gradient[0] = finite_float(sum.x);
    gradient[1] = finite_float(sum.y);
}

void sheen_estimate_hessian(SheenStrata s, const Vec3 directions[], const Rgb L[], const float distance[],
                            IrradianceHessian *out, float gradient[2])
{
    sheen_estimate_lobe_hessian(s, directions, NULL, L, distance, out, gradient);
}

HessianEllipse sheen_hessian_ellipse(const IrradianceHessian *h, float E, float error)
{
    double mean = 0.5 * ((double)h->xx + (double)h->yy), half = 0.5 * ((double)h->xx - (double)h->yy);
    double spread = hypot(half, (double)h->xy), angle = 0.5 * atan2((double)h->xy, half);
    // The eigenvalues are mean + spread, along the angle, and mean - spread across.
    double along = mean + spread, across = mean - spread;
    bool swap = fabs(across) > fabs(along);
    double most = swap ? across : along, least = swap ? along : across;
    double scale = 4.0 * fmax((double)error, 0.0) * fmax((double)E, 0.0), c = cos(angle), sine = sin(angle);
    HessianEllipse out = {(float)(swap ? -sine : c), (float)(swap ? c : sine), {INFINITY, INFINITY}};
    if (most != 0.0) out.radius[0] = (float)sqrt(scale / fabs(most));
    if (least != 0.0) out.radius[1] = (float)sqrt(scale / fabs(least));
    return out;
}
