// SPDX-License-Identifier: Apache-2.0
#include "integrator/first_points.h"

#include <stdlib.h>

typedef struct FirstPoints {
    const SheenWork *work;
    const uint32_t *ends; // [pixels]
    Visibility *workers;  // [workers] buffers
    SheenStats *stats;    // [workers]
    SeenPoints *tiles;    // [tiles]
    atomic_bool failed;
} FirstPoints;

static void first_points_task(void *user, size_t item, unsigned worker)
{
    FirstPoints *f = user;
    Visibility *v = &f->workers[worker];
    Tile tile = sheen_tile(f->work, (uint32_t)item);
    bool ok = sheen_visibility_trace(f->work, &tile, (SampleRange){0, 1, f->ends}, NULL, v, &f->stats[worker]) &&
              sheen_seen_append(&v->seen, &f->tiles[item]);
    if (!ok) atomic_store(&f->failed, true);
}

SheenStatus sheen_first_points(const SheenWork *work, const uint32_t ends[], SheenStats *stats, SeenPoints *points)
{
    unsigned workers = sheen_pool_size(work->pool);
    uint32_t tiles = sheen_tile_count(work);
    FirstPoints f = {.work = work,
                     .ends = ends,
                     .workers = calloc(workers, sizeof(Visibility)),
                     .stats = calloc(workers, sizeof(SheenStats)),
                     .tiles = calloc(tiles, sizeof(SeenPoints))};
    SheenStatus status = f.workers && f.stats && f.tiles ? SHEEN_OK : SHEEN_ERR_NOMEM;
    if (status == SHEEN_OK && !sheen_pool_run(work->pool, tiles, first_points_task, &f, work->cancel))
        status = SHEEN_ERR_CANCELLED;
    if (status == SHEEN_OK && atomic_load(&f.failed)) status = SHEEN_ERR_NOMEM;
    for (uint32_t i = 0; i < tiles && f.tiles; ++i) {
        if (status == SHEEN_OK && !sheen_seen_append(&f.tiles[i], points)) status = SHEEN_ERR_NOMEM;
        sheen_seen_free(&f.tiles[i]);
    }
    for (unsigned i = 0; i < workers; ++i) {
        if (f.stats) sheen_stats_add(stats, &f.stats[i]);
        if (f.workers) sheen_visibility_free(&f.workers[i]);
    }
    free(f.workers);
    free(f.stats);
    free(f.tiles);
    return status;
}
