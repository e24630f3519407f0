// SPDX-License-Identifier: Apache-2.0
#include "integrator/seen_points.h"

#include <stdlib.h>
#include <string.h>

void sheen_seen_free(SeenPoints *seen)
{
    free(seen->points);
    free(seen->glossy);
    free(seen->lobes);
    *seen = (SeenPoints){0};
}

// Makes room for n more items. @return the array, moved or not; NULL when out of memory, and the old one stays
static void *reserve(void *items, size_t count, size_t n, size_t size, size_t *capacity)
{
    if (count + n <= *capacity) return items;
    size_t wanted = 2 * (count + n) + 64;
    void *grown = realloc(items, wanted * size);
    if (grown) *capacity = wanted;
    return grown;
}

bool sheen_seen_add(const ShadingPoint points[], size_t n, SeenPoints *seen)
{
    if (n == 0) return true;
    ShadingPoint *p = reserve(seen->points, seen->n_points, n, sizeof *p, &seen->points_capacity);
    if (!p) return false;
    seen->points = p;
    memcpy(p + seen->n_points, points, n * sizeof *p);
    seen->n_points += n;
    return true;
}

bool sheen_seen_add_glossy(const ShadingPoint *at, SheenBasis basis, unsigned order, const Rgb lobe[], SeenPoints *seen)
{
    size_t n = lobe ? basis_size(order) : 0;
    GlossyPoint *g = reserve(seen->glossy, seen->n_glossy, 1, sizeof *g, &seen->glossy_capacity);
    if (!g) return false;
    seen->glossy = g;
    if (n) {
        Rgb *lobes = reserve(seen->lobes, seen->n_lobes, n, sizeof *lobes, &seen->lobes_capacity);
        if (!lobes) return false;
        seen->lobes = lobes;
        memcpy(lobes + seen->n_lobes, lobe, n * sizeof *lobes);
    }
    g[seen->n_glossy++] = (GlossyPoint){*at, basis, lobe ? order : 0, seen->n_lobes};
    seen->n_lobes += n;
    return true;
}

bool sheen_seen_append(const SeenPoints *more, SeenPoints *seen)
{
    if (!sheen_seen_add(more->points, more->n_points, seen)) return false;
    for (size_t i = 0; i < more->n_glossy; ++i) {
        const GlossyPoint *g = &more->glossy[i];
        const Rgb *lobe = more->n_lobes ? more->lobes + g->lobe : NULL;
        if (!sheen_seen_add_glossy(&g->at, g->basis, g->order, lobe, seen)) return false;
    }
    return true;
}
