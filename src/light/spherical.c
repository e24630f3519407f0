// SPDX-License-Identifier: Apache-2.0
#include "light/spherical.h"

#include "math/warp.h"

// Rounding leaves about 1e-15 sr in a rectangle's solid angle: below this one the area takes over, whose density is as
// even there but for points at grazing angles.
#define RECTANGLE_MIN 1e-8
// Arvo's formulas lose their digits with the square of the least angle of the spherical triangle. A triangle that is
// small from p is left to its area, whose density then varies by a third at most; a near one that is thin, since p is
// almost in its plane, only where it fills less than this.
#define TRIANGLE_FAR 0.1 // edge over distance
#define TRIANGLE_MIN 1e-6

#define TWO_PI 6.283185307179586

static double clampd(double x, double lo, double hi) // a NaN becomes lo
{
    return x > lo ? (x < hi ? x : hi) : lo;
}

// ---- rectangle --------------------------------------------------------------------------------------------------

SheenRectangle sheen_rectangle_make(Vec3 corner, Vec3 ex, Vec3 ey)
{
    SheenRectangle r = {.corner = corner, .ex = ex, .ey = ey, .n = v3_normalize(v3_cross(ex, ey))};
    D3 x = d3_sub(ex, v3(0, 0, 0)), y = d3_sub(ey, v3(0, 0, 0));
    r.lx = d3_length(x);
    r.ly = d3_length(y);
    r.x = d3_scale(x, 1.0 / r.lx);
    r.y = d3_scale(y, 1.0 / r.ly);
    r.z = d3_cross(r.x, r.y);
    r.center = v3_mad(v3_mad(corner, 0.5f, ex), 0.5f, ey);
    r.area = (float)(r.lx * r.ly);
    r.diagonal2 = (float)(r.lx * r.lx + r.ly * r.ly);
    return r;
}

// The rectangle from p: x0..x1, y0..y1 at height z < 0 of a frame whose z axis is its normal.
typedef struct View {
    double x0, x1, y0, y1, z;
    double cos_k, sin_k; // of k = 2 pi - (inner angles at x0)
    double solid_angle;
} View;

typedef struct Complex {
    double re, im;
} Complex;

static Complex complex_mul(Complex a, Complex b)
{
    return (Complex){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

// The solid angle is the sum of the inner angles g of the spherical quadrilateral less 2 pi. For the corner (x, y) the
// planes of its edges give cos g = s x y / m and sin g = |z| sqrt(x^2 + y^2 + z^2) / m, s = -1 on the diagonal where x
// and y are both lower or both upper. So the angles add up as arguments of a product: one arc tangent instead of four
// arc cosines, and no cancellation for small g.
static Complex corner_angle(double sign, double x, double y, double z)
{
    return (Complex){sign * x * y, -z * sqrt(x * x + y * y + z * z)};
}

static bool view_from(const SheenRectangle *r, Vec3 p, View *v)
{
    D3 o = d3_sub(r->corner, p);
    v->z = d3_dot(o, r->z);
    if (!(v->z < 0.0)) return false;
    v->x0 = d3_dot(o, r->x);
    v->y0 = d3_dot(o, r->y);
    v->x1 = v->x0 + r->lx;
    v->y1 = v->y0 + r->ly;
    Complex right = complex_mul(corner_angle(1, v->x1, v->y0, v->z), corner_angle(-1, v->x1, v->y1, v->z));
    Complex left = complex_mul(corner_angle(1, v->x0, v->y1, v->z), corner_angle(-1, v->x0, v->y0, v->z));
    double m = sqrt(left.re * left.re + left.im * left.im);
    v->cos_k = left.re / m;
    v->sin_k = -left.im / m;
    Complex all = complex_mul(right, left);
    double s = atan2(all.im, all.re);
    v->solid_angle = s < -1e-9 ? s + TWO_PI : s; // a small negative angle is rounding, not nearly 2 pi
    return true;
}

static bool by_solid_angle(const View *v)
{
    return v->solid_angle > RECTANGLE_MIN;
}

static double area_density(double d2, double area_times_height)
{
    return d2 * sqrt(d2) / area_times_height; // d^2 / (area cos), cos = height / d
}

// Density of area sampling at q as seen from p, 0 from behind.
static float far_density(const SheenRectangle *r, Vec3 p, Vec3 q)
{
    Vec3 d = v3_sub(q, p);
    float d2 = v3_length2(d), height = -v3_dot(d, r->n);
    return height > 0.0f ? d2 * sqrtf(d2) / (height * r->area) : 0.0f;
}

bool sheen_rectangle_sample(const SheenRectangle *r, Vec3 p, Vec2 u, Vec2 *st, float *solid_angle)
{
    View v;
    if (!view_from(r, p, &v)) return false;
    if (!by_solid_angle(&v)) {
        *st = u;
        double x = v.x0 + (double)u.x * r->lx, y = v.y0 + (double)u.y * r->ly;
        *solid_angle = (float)(1.0 / area_density(x * x + y * y + v.z * v.z, -v.z * r->lx * r->ly));
        return true;
    }
    // Vertical great circle that cuts off the part u of the solid angle: angle au = u S + k.
    double us = (double)u.x * v.solid_angle, c = cos(us), s = sin(us), z2 = v.z * v.z;
    double cos_au = c * v.cos_k - s * v.sin_k, sin_au = s * v.cos_k + c * v.sin_k;
    double b0 = -v.y0 / sqrt(z2 + v.y0 * v.y0), b1 = v.y1 / sqrt(z2 + v.y1 * v.y1);
    double fu = (cos_au * b0 - b1) / sin_au;
    double x = clampd(copysign(-v.z / sqrt(fmax(fu * fu + b0 * b0 - 1.0, 1e-300)), fu), v.x0, v.x1);
    // Along it, the sine of the elevation is uniform.
    double d2 = x * x + z2, h0 = v.y0 / sqrt(d2 + v.y0 * v.y0), h1 = v.y1 / sqrt(d2 + v.y1 * v.y1);
    double h = h0 + (double)u.y * (h1 - h0);
    double y = clampd(h * sqrt(d2 / fmax(1.0 - h * h, 1e-300)), v.y0, v.y1);
    *st = v2((float)((x - v.x0) / r->lx), (float)((y - v.y0) / r->ly));
    *solid_angle = (float)v.solid_angle;
    return true;
}

float sheen_rectangle_pdf(const SheenRectangle *r, Vec3 p, Vec3 q)
{
    if (sheen_rectangle_is_far(r, p)) return far_density(r, p, q);
    View v;
    if (!view_from(r, p, &v)) return 0.0f;
    if (by_solid_angle(&v)) return (float)(1.0 / v.solid_angle);
    D3 d = d3_sub(q, p);
    return (float)area_density(d3_dot(d, d), -v.z * r->lx * r->ly);
}

// ---- triangle ---------------------------------------------------------------------------------------------------

// The triangle from p.
typedef struct Corners {
    D3 a, b, c; // vertices less p
    double la, lb, lc;
    double volume; // a . (b x c): -2 area height for p in front
    double solid_angle;
    bool by_area;
} Corners;

static bool corners_from(const Vec3 v[3], Vec3 p, Corners *t)
{
    t->a = d3_sub(v[0], p);
    t->b = d3_sub(v[1], p);
    t->c = d3_sub(v[2], p);
    t->volume = d3_dot(t->a, d3_cross(t->b, t->c));
    if (!(t->volume < 0.0)) return false;
    t->la = d3_length(t->a);
    t->lb = d3_length(t->b);
    t->lc = d3_length(t->c);
    // Source: vanoosterom1983.
    double den =
        t->la * t->lb * t->lc + d3_dot(t->a, t->b) * t->lc + d3_dot(t->b, t->c) * t->la + d3_dot(t->c, t->a) * t->lb;
    t->solid_angle = 2.0 * atan2(-t->volume, den);
    double edge = fmax(d3_length(d3_sub(v[1], v[0])), d3_length(d3_sub(v[2], v[0])));
    t->by_area = edge < TRIANGLE_FAR * t->la || t->solid_angle < TRIANGLE_MIN;
    return true;
}

static D3 normalized_rejection(D3 v, D3 axis)
{
    D3 w = d3_mad(v, -d3_dot(v, axis), axis);
    return d3_scale(w, 1.0 / d3_length(w));
}

// A direction uniform over the spherical triangle. Letters are those of the paper.
static D3 arvo_direction(const Corners *t, Vec2 u)
{
    D3 a = d3_scale(t->a, 1.0 / t->la), b = d3_scale(t->b, 1.0 / t->lb), c = d3_scale(t->c, 1.0 / t->lc);
    double alpha = atan2(fabs(d3_dot(a, d3_cross(b, c))), d3_dot(d3_cross(a, b), d3_cross(a, c)));
    double cos_alpha = cos(alpha), sin_alpha = sin(alpha), cos_c = d3_dot(a, b);
    double phi = (double)u.x * t->solid_angle - alpha, s = sin(phi), co = cos(phi);
    double uu = co - cos_alpha, vv = s + sin_alpha * cos_c;
    double q = clampd(((vv * co - uu * s) * cos_alpha - vv) / ((vv * s + uu * co) * sin_alpha), -1.0, 1.0);
    D3 c_hat = d3_mad(d3_scale(a, q), sqrt(1.0 - q * q), normalized_rejection(c, a));
    double z = 1.0 - (double)u.y * (1.0 - d3_dot(c_hat, b));
    return d3_mad(d3_scale(b, z), sqrt(fmax(1.0 - z * z, 0.0)), normalized_rejection(c_hat, b));
}

bool sheen_triangle_sample(const Vec3 v[3], Vec3 p, Vec2 u, Vec2 *b, float *pdf)
{
    Corners t;
    if (!corners_from(v, p, &t)) return false;
    if (t.by_area) {
        *b = warp_triangle(u);
        double b1 = (double)b->x, b2 = (double)b->y;
        D3 q = d3_mad(d3_mad(d3_scale(t.a, 1.0 - b1 - b2), b1, t.b), b2, t.c);
        *pdf = (float)area_density(d3_dot(q, q), -0.5 * t.volume);
        return isfinite(*pdf);
    }
    // The direction is a combination of the vertices; its coefficients are the barycentric coordinates, but for scale.
    D3 d = arvo_direction(&t, u);
    double w0 = fmin(d3_dot(d, d3_cross(t.b, t.c)), 0.0), w1 = fmin(d3_dot(d, d3_cross(t.c, t.a)), 0.0);
    double w2 = fmin(d3_dot(d, d3_cross(t.a, t.b)), 0.0), sum = w0 + w1 + w2;
    if (!(sum < 0.0)) return false;
    *b = v2((float)(w1 / sum), (float)(w2 / sum));
    *pdf = (float)(1.0 / t.solid_angle);
    return true;
}

float sheen_triangle_pdf(const Vec3 v[3], Vec3 p, Vec3 q)
{
    Corners t;
    if (!corners_from(v, p, &t)) return 0.0f;
    if (!t.by_area) return (float)(1.0 / t.solid_angle);
    D3 d = d3_sub(q, p);
    return (float)area_density(d3_dot(d, d), -0.5 * t.volume);
}
