// SPDX-License-Identifier: Apache-2.0
#include "integrator/converge.h"

#include "base/clock.h"

#include <stdlib.h>
#include <string.h>

enum { BLOCK = 4096 }; // points an item

// Adds the spheres, as the octree has them, of records from number `first` on, and of those that reach less now. Where
// there are any the octree is built anew: look-ups depend on the order and the radii of its spheres, and are to be the
// same after the records were written and read.
static SheenStatus take_changes(SheenRecordStore *store, uint32_t first, SheenOctree *spheres)
{
    const SheenOctree *t = store->octree;
    SheenStatus status = SHEEN_OK;
    bool changed = false;
    float *reach2 = calloc((size_t)store->n + 1, sizeof *reach2);
    if (!reach2) return SHEEN_ERR_NOMEM;
    for (uint32_t b = 1; b < t->n_blocks; ++b)
        for (uint32_t k = 0; k < t->blocks[b].n; ++k) reach2[t->blocks[b].record[k]] = t->blocks[b].reach2[k];
    for (uint32_t i = 0; i < store->n && status == SHEEN_OK; ++i) {
        const Record *r = &store->records[i];
        if (i < first && !(sqrf(record_reach(r)) < reach2[i])) continue;
        changed = true;
        status = sheen_octree_insert(spheres, r->p, sqrtf(reach2[i]), i);
    }
    free(reach2);
    return changed && status == SHEEN_OK ? sheen_store_reindex(store) : status;
}

/** Points, and those among them that spheres hold. */
typedef struct Held {
    const SheenOctree *spheres;
    const ShadingPoint *points; // [n]
    size_t n;
    unsigned char *held; // [n]
} Held;

static void held_task(void *user, size_t item, unsigned worker)
{
    (void)worker;
    Held *h = user;
    for (size_t i = item * BLOCK; i < h->n && i < (item + 1) * BLOCK; ++i)
        h->held[i] = sheen_octree_holds(h->spheres, h->points[i].point.p);
}

/** The rounds' state. */
typedef struct Rounds {
    const Convergence *c;
    const ShadingPoint *all; // [n_all]
    size_t n_all;
    ShadingPoint *points; // [n] those that the last round touched
    size_t n;
    unsigned char *held;     // [n_all]
    SheenOctree *touched[2]; // where this round changed records, and where the last one did, NULL in the first
} Rounds;

static SheenStatus choose_points(Rounds *r)
{
    Held h = {r->touched[0], r->all, r->n_all, r->held};
    if (!sheen_pool_run(r->c->work->pool, (r->n_all + BLOCK - 1) / BLOCK, held_task, &h, r->c->work->cancel))
        return SHEEN_ERR_CANCELLED;
    r->n = 0;
    for (size_t i = 0; i < r->n_all; ++i)
        if (r->held[i]) r->points[r->n++] = r->all[i];
    return SHEEN_OK;
}

static SheenStatus refine(Rounds *r, SheenStats *stats)
{
    const Convergence *c = r->c;
    SheenRecordStore *store = adapt_store(&c->cache);
    double start = sheen_clock_seconds();
    SheenStatus status = c->view->direct ? SHEEN_OK : sheen_adapt_look(c->work, stats, c->view);
    if (status == SHEEN_OK) status = sheen_adapt_pass(c->work, c->view, r->touched[1] ? r->touched : NULL, &c->cache);
    if (status == SHEEN_OK) status = take_changes(store, store->n, r->touched[0]);
    stats->time_refine += sheen_clock_seconds() - start;
    return status;
}

static SheenStatus run_round(Rounds *r, SheenStats *stats)
{
    const Convergence *c = r->c;
    SheenRecordStore *store = adapt_store(&c->cache);
    uint32_t first = store->n;
    sheen_octree_destroy(&r->touched[1]);
    r->touched[1] = r->touched[0];
    SheenStatus status = sheen_octree_create_alike(store->octree, &r->touched[0]);
    if (status == SHEEN_OK) status = sheen_fill_run(c->work, c->kind, r->points, r->n, stats);
    if (status == SHEEN_OK) status = take_changes(store, first, r->touched[0]);
    return status == SHEEN_OK && c->view ? refine(r, stats) : status;
}

SheenStatus sheen_converge(const Convergence *c, const ShadingPoint points[], size_t n, SheenStats *stats)
{
    Rounds r = {.c = c, .all = points, .n_all = n, .n = n};
    if (n == 0) return SHEEN_OK;
    r.points = malloc(n * sizeof *r.points);
    r.held = malloc(n);
    SheenStatus status = r.points && r.held ? SHEEN_OK : SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK) memcpy(r.points, points, n * sizeof *points);
    for (unsigned round = 0; round < c->rounds && r.n > 0 && status == SHEEN_OK; ++round) {
        status = run_round(&r, stats);
        if (c->view && stats->refined <= round) stats->refined = round + 1;
        if (status == SHEEN_OK && round + 1 < c->rounds) status = choose_points(&r);
    }
    for (int i = 0; i < 2; ++i) sheen_octree_destroy(&r.touched[i]);
    free(r.points);
    free(r.held);
    return status;
}
