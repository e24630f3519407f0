// SPDX-License-Identifier: Apache-2.0
#include "io/polygon.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_CORNERS = 4096 }; // time grows with the square

typedef struct Corner {
    double x, y; // in the plane
    uint32_t previous, next;
    bool ear;
} Corner;

static void put(uint32_t t[3], uint32_t a, uint32_t b, uint32_t c)
{
    t[0] = a, t[1] = b, t[2] = c;
}

/** The sum of the cross products of the corners: twice the area times the normal, wherever the polygon lies. */
static Vec3 area_vector(const Vec3 p[], uint32_t n)
{
    Vec3 sum = v3(0, 0, 0);
    for (uint32_t i = 1; i + 1 < n; ++i) sum = v3_add(sum, v3_cross(v3_sub(p[i], p[0]), v3_sub(p[i + 1], p[0])));
    return sum;
}

/** @return true when some corner turns the other way than the polygon as a whole. */
static bool has_inward_corner(const Vec3 p[], uint32_t n, Vec3 normal)
{
    for (uint32_t i = 0; i < n; ++i) {
        Vec3 a = p[i], b = p[i + 1 < n ? i + 1 : 0], c = p[(i + 2) % n];
        if (v3_dot(v3_cross(v3_sub(b, a), v3_sub(c, b)), normal) < 0.0f) return true;
    }
    return false;
}

/** Drops the axis along which the polygon is flattest, so that it runs counter-clockwise. */
static void project(const Vec3 p[], uint32_t n, Vec3 normal, Corner out[])
{
    Vec3 a = v3(fabsf(normal.x), fabsf(normal.y), fabsf(normal.z));
    for (uint32_t i = 0; i < n; ++i) {
        double x = (double)p[i].x, y = (double)p[i].y, sign = (double)normal.z;
        if (a.x >= a.y && a.x >= a.z)
            x = (double)p[i].y, y = (double)p[i].z, sign = (double)normal.x;
        else if (a.y >= a.z)
            x = (double)p[i].z, y = (double)p[i].x, sign = (double)normal.y;
        out[i] = (Corner){sign < 0.0 ? -x : x, y, i ? i - 1 : n - 1, i + 1 < n ? i + 1 : 0, false};
    }
}

/** Twice the signed area of a triangle. */
static double turn(const Corner *a, const Corner *b, const Corner *c)
{
    return (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
}

static bool same_place(const Corner *a, const Corner *b)
{
    return a->x == b->x && a->y == b->y;
}

/** A corner is an ear when it points outward and no other corner is in the triangle with its neighbors. */
static bool is_ear(const Corner c[], uint32_t i)
{
    const Corner *a = &c[c[i].previous], *b = &c[i], *d = &c[c[i].next];
    if (!(turn(a, b, d) > 0.0)) return false;
    for (uint32_t j = d->next; j != c[i].previous; j = c[j].next) {
        const Corner *q = &c[j];
        // A corner in the same place as one of the ear's is where a hole is tied to the outline: it does no harm.
        if (turn(a, b, q) >= 0.0 && turn(b, d, q) >= 0.0 && turn(d, a, q) >= 0.0 && !same_place(q, a) &&
            !same_place(q, b) && !same_place(q, d))
            return false;
    }
    return true;
}

static void cut_ears(Corner c[], uint32_t n, uint32_t (*triangles)[3])
{
    for (uint32_t i = 0; i < n; ++i) c[i].ear = is_ear(c, i);
    uint32_t at = 0;
    for (uint32_t left = n; left > 3; --left) {
        // Without an ear the polygon crosses itself: any corner will do.
        for (uint32_t tries = 0; !c[at].ear && tries < left; ++tries) at = c[at].next;
        uint32_t before = c[at].previous, after = c[at].next;
        put(*triangles++, before, at, after);
        c[before].next = after;
        c[after].previous = before;
        c[before].ear = is_ear(c, before);
        c[after].ear = is_ear(c, after);
        at = c[after].next; // not the neighbor: a fan of needles would follow
    }
    put(*triangles, c[at].previous, at, c[at].next);
}

bool sheen_polygon_cut(const Vec3 p[], uint32_t n, uint32_t (*triangles)[3])
{
    Vec3 normal = n > 3 ? area_vector(p, n) : v3(0, 0, 0);
    bool usable = v3_finite(normal) && v3_length2(normal) > 0.0f;
    if (!usable || n > MAX_CORNERS || !has_inward_corner(p, n, normal)) {
        for (uint32_t i = 0; i + 2 < n; ++i) put(triangles[i], 0, i + 1, i + 2);
        return true;
    }
    Corner *c = malloc((size_t)n * sizeof *c);
    if (!c) return false;
    project(p, n, normal, c);
    cut_ears(c, n, triangles);
    free(c);
    return true;
}
