// SPDX-License-Identifier: Apache-2.0
#include "integrator/thin.h"

#include "cache/record.h"

#include <stdlib.h>

/** Accepted points by cells of the picture: lists through `next`. */
typedef struct Grid {
    uint32_t nx, ny, side; // cells, and pixels a cell
    uint32_t *first;       // [ny][nx] index + 1 into accepted, 0 at the end
    uint32_t *next;        // [accepted]
} Grid;

static bool would_cover(float a, float spacing, const DiffusePoint *c, const DiffusePoint *q)
{
    Vec3 d = v3_sub(c->p, q->p);
    float d2 = v3_length2(d);
    return d2 < spacing * spacing && record_weight(spacing / a, d2, v3_dot(c->n, q->n)) > 1.0f / a;
}

static bool crowded(const Grid *g, const ShadingPoint points[], const uint32_t accepted[], const ShadingPoint *c,
                    uint32_t x, uint32_t y, float a, float spacing)
{
    for (uint32_t cy = y ? y - 1 : 0; cy <= y + 1 && cy < g->ny; ++cy)
        for (uint32_t cx = x ? x - 1 : 0; cx <= x + 1 && cx < g->nx; ++cx)
            for (uint32_t e = g->first[(size_t)cy * g->nx + cx]; e; e = g->next[e - 1])
                if (would_cover(a, spacing, &c->point, &points[accepted[e - 1]].point)) return true;
    return false;
}

SheenStatus sheen_thin(float cell_px, uint32_t width, const ShadingPoint points[], size_t n,
                       const uint32_t candidates[], const float spacing[], const float a[], uint32_t accepted[],
                       size_t *n_accepted)
{
    *n_accepted = 0;
    if (n == 0) return SHEEN_OK;
    uint32_t last = 0;
    for (size_t i = 0; i < n; ++i)
        if (points[candidates[i]].pixel > last) last = points[candidates[i]].pixel;
    Grid g = {.side = (uint32_t)ceilf(cell_px)};
    g.nx = (width + g.side - 1) / g.side;
    g.ny = (last / width + g.side) / g.side;
    g.first = calloc((size_t)g.nx * g.ny, sizeof *g.first);
    g.next = malloc(n * sizeof *g.next);
    if (!g.first || !g.next) {
        free(g.first);
        free(g.next);
        return SHEEN_ERR_NOMEM;
    }
    size_t count = 0;
    for (size_t i = 0; i < n; ++i) {
        const ShadingPoint *c = &points[candidates[i]];
        uint32_t x = c->pixel % width / g.side, y = c->pixel / width / g.side;
        if (crowded(&g, points, accepted, c, x, y, a[candidates[i]], spacing[i])) continue;
        uint32_t *head = &g.first[(size_t)y * g.nx + x];
        g.next[count] = *head;
        accepted[count++] = candidates[i];
        *head = (uint32_t)count;
    }
    free(g.first);
    free(g.next);
    *n_accepted = count;
    return SHEEN_OK;
}
