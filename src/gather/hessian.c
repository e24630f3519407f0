// SPDX-License-Identifier: Apache-2.0
// One edge between two triangles of the virtual mesh. The point is at the origin with normal z, w0 and w1 are the
// directions of the edge's ends, q0 and q1 one over their distances, P the angle between them. Where the edge is seen
// at angle t from w0 its direction and one over its distance are the same mixture of those at the ends,
//
//     w = A w0 + B w1,  q = A q0 + B q1,  A = sin(P - t) / sin(P),  B = sin(t) / sin(P),
//
// and all line integrals of the published formulas become integrals over the angle. With <> the mean over it, and
// F = P / sin(P):
//
//     m    = z x (q0 w1 - q1 w0)          g = F <w q>
//     k    = z . (w0 x w1)                T = F <w w' q^2>,  trace F <q^2>
//     grad = (F m + 2 k g) / 2            Hess = m g' + g m' + k (4 T - F <q^2> Id)
//
// times the radiance to the left less that to the right. Nothing here divides by the length of the edge or the area
// seen: short edges, edges that point at the observer and ends at infinity (q = 0) need no care. Source:
// schwarzhaupt2012-hessian, whose forms divide by |r0 x r1|^2 |e|^2.
//
// The means are F <A^2>, F <AB>, F <A^4>, F <A^3 B>, F <A^2 B^2>. Since |w| = 1, A^2 + B^2 + 2 A B cos(P) = 1, so that
// two of them give the others. They are derivatives of F with respect to x = 1 - cos(P): F <AB> = F' / 2 and
// F <A^2 B^2> = F'' / 8, and F = sum_n x^n 2^n (n!)^2 / (2n + 1)!.
#include "gather/hessian.h"

#include <float.h>
#include <stddef.h>

/** A vertex of the mesh: direction and one over the distance, 0 for the sky. */
typedef struct Vertex {
    double x, y, z, q;
    double L; // luminance
} Vertex;

typedef struct EdgeSum {
    double x, y;       // gradient
    double xx, xy, yy; // Hessian
} EdgeSum;

/** F and F <.> of products of A and B. */
typedef struct EdgeMeans {
    double one, aa, ab, aaaa, aaab, aabb;
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
    EdgeMeans m = {.one = f, .ab = 0.5 * f1, .aabb = 0.125 * f2};
    m.aa = 0.5 * m.one - c * m.ab;
    m.aaab = 0.5 * m.ab - c * m.aabb;
    m.aaaa = m.aa - m.aabb - 2.0 * c * m.aaab;
    return m;
}

static void add_short_edge(const Vertex *v0, const Vertex *v1, double x, double dL, EdgeSum *sum)
{
    EdgeMeans e = edge_means(x);
    double q0 = v0->q, q1 = v1->q, q00 = q0 * q0, q01 = q0 * q1, q11 = q1 * q1;
    double k = v0->x * v1->y - v0->y * v1->x;
    double mx = q1 * v0->y - q0 * v1->y, my = q0 * v1->x - q1 * v0->x;
    double g0 = e.aa * q0 + e.ab * q1, g1 = e.ab * q0 + e.aa * q1;
    double gx = g0 * v0->x + g1 * v1->x, gy = g0 * v0->y + g1 * v1->y;
    double qq = e.aa * (q00 + q11) + 2.0 * e.ab * q01;
    double t00 = e.aaaa * q00 + 2.0 * e.aaab * q01 + e.aabb * q11;
    double t01 = e.aaab * (q00 + q11) + 2.0 * e.aabb * q01;
    double t11 = e.aabb * q00 + 2.0 * e.aaab * q01 + e.aaaa * q11;
    // T = w0 a' + w1 b'
    double ax = t00 * v0->x + t01 * v1->x, ay = t00 * v0->y + t01 * v1->y;
    double bx = t01 * v0->x + t11 * v1->x, by = t01 * v0->y + t11 * v1->y;
    sum->x += dL * (0.5 * e.one * mx + k * gx);
    sum->y += dL * (0.5 * e.one * my + k * gy);
    sum->xx += dL * (2.0 * mx * gx + k * (4.0 * (v0->x * ax + v1->x * bx) - qq));
    sum->xy += dL * (mx * gy + my * gx + k * 4.0 * (v0->x * ay + v1->x * by));
    sum->yy += dL * (2.0 * my * gy + k * (4.0 * (v0->y * ay + v1->y * by) - qq));
}

// A longer edge is halved, by angle: four times is enough for any whose ends are not opposite.
static void add_long_edge(const Vertex *v0, const Vertex *v1, double dL, int halvings, EdgeSum *sum)
{
    double x = 1.0 - (v0->x * v1->x + v0->y * v1->y + v0->z * v1->z);
    if (x <= SERIES_MAX) {
        add_short_edge(v0, v1, x, dL, sum);
        return;
    }
    Vertex middle = {.x = v0->x + v1->x, .y = v0->y + v1->y, .z = v0->z + v1->z};
    double length = sqrt(middle.x * middle.x + middle.y * middle.y + middle.z * middle.z);
    if (halvings == 0) return;
    middle.x /= length;
    middle.y /= length;
    middle.z /= length;
    middle.q = (v0->q + v1->q) / length;
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

static Vertex vertex(Vec3 d, Rgb L, float distance)
{
    float luminance = rgb_luminance(L);
    return (Vertex){.x = (double)d.x,
                    .y = (double)d.y,
                    .z = (double)d.z,
                    .q = distance > 0.0f ? 1.0 / fmax((double)distance, 1e-15) : 0.0,
                    .L = isfinite(luminance) ? (double)luminance : 0.0};
}

static Vertex pole_of(SheenStrata s, const Vec3 directions[], const Rgb L[], const float distance[])
{
    Vertex pole = {.z = 1.0};
    for (unsigned k = 0; k < s.sectors; ++k) {
        size_t i = (size_t)k * s.rings;
        Vertex v = vertex(directions[i], L[i], distance[i]);
        pole.q += v.q;
        pole.L += v.L;
    }
    pole.q /= s.sectors; // after the sum: exact where all are alike
    pole.L /= s.sectors;
    return pole;
}

static void read_meridian(SheenStrata s, unsigned k, const Vec3 directions[], const Rgb L[], const float distance[],
                          Meridian *m)
{
    size_t first = (size_t)(k % s.sectors) * s.rings;
    for (unsigned j = 0; j < s.rings; ++j)
        m->v[j + 1] = vertex(directions[first + j], L[first + j], distance[first + j]);
    // Let fall onto the plane, walls stay walls.
    Vertex *last = &m->v[s.rings], *horizon = &m->v[s.rings + 1];
    double sine = sqrt(last->x * last->x + last->y * last->y);
    *horizon = *last;
    if (!(sine > 0.0)) return;
    *horizon = (Vertex){.x = last->x / sine, .y = last->y / sine, .q = last->q / sine, .L = last->L};
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

// The edges of one meridian, and those from it to the next.
// @param below  radiance below the horizon: any, the same for all sectors
static void add_strip(unsigned rings, const Meridian *here, const Meridian *next, const Strip *before,
                      const Strip *after, double below, EdgeSum *sum)
{
    const Vertex *a = here->v, *b = next->v;
    for (unsigned j = 0; j <= rings; ++j) {
        add_edge(&a[j], &a[j + 1], after->inner[j], before->outer[j], sum);
        add_edge(&a[j + 1], &b[j], after->inner[j], after->outer[j], sum);
        add_edge(&a[j + 1], &b[j + 1], after->outer[j], j < rings ? after->inner[j + 1] : below, sum);
    }
}

static float finite_float(double x)
{
    return isfinite(x) ? (float)fmax(-(double)FLT_MAX, fmin(x, (double)FLT_MAX)) : 0.0f;
}

void sheen_estimate_hessian(SheenStrata s, const Vec3 directions[], const Rgb L[], const float distance[],
                            IrradianceHessian *out, float gradient[2])
{
    Meridian meridians[2], *here = &meridians[0], *next = &meridians[1];
    Strip strips[2], *before = &strips[0], *after = &strips[1];
    EdgeSum sum = {0, 0, 0, 0, 0};
    here->v[0] = next->v[0] = pole_of(s, directions, L, distance);
    read_meridian(s, s.sectors - 1, directions, L, distance, next);
    read_meridian(s, 0, directions, L, distance, here);
    fill_strip(s.rings, next, here, before);
    double below = before->outer[s.rings];
    for (unsigned k = 0; k < s.sectors; ++k) {
        read_meridian(s, k + 1, directions, L, distance, next);
        fill_strip(s.rings, here, next, after);
        add_strip(s.rings, here, next, before, after, below, &sum);
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
