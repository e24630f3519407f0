// SPDX-License-Identifier: Apache-2.0
#include "cache/irradiance_cache.h"

#include <stdlib.h>

// A point on a record has infinite weight; this finite one still outweighs all others.
static const float weight_max = 1e6f;

SheenStatus sheen_irradiance_cache_create(float accuracy, bool neighbor_clamping, const Bounds *bounds,
                                          SheenIrradianceCache **out)
{
    *out = NULL;
    SheenIrradianceCache *c = calloc(1, sizeof *c);
    if (!c) return SHEEN_ERR_NOMEM;
    c->accuracy = accuracy;
    c->neighbor_clamping = neighbor_clamping;
    if (sheen_octree_create(bounds, &c->octree) != SHEEN_OK) {
        free(c);
        return SHEEN_ERR_NOMEM;
    }
    *out = c;
    return SHEEN_OK;
}

void sheen_irradiance_cache_destroy(SheenIrradianceCache **cache)
{
    if (!cache || !*cache) return;
    sheen_octree_destroy(&(*cache)->octree);
    free((*cache)->records);
    free(*cache);
    *cache = NULL;
}

// One sphere of influence that clamping visits: a record's own.
typedef struct Clamp {
    SheenIrradianceCache *cache;
    Vec3 p;
    float R;        // first pass: search radius
    float smallest; // out, first pass: least R_j + distance
    float limit;    // in, second pass: neighbors shrink to limit + distance
    bool shrink;    // second pass
} Clamp;

static void clamp_record(Clamp *c, uint32_t record)
{
    IrradianceRecord *r = &c->cache->records[record];
    float d = v3_length(v3_sub(r->p, c->p));
    if (c->shrink)
        r->R = maxf(r->R_min, minf(r->R, c->limit + d));
    else if (!record_is_sliver(r))
        c->smallest = minf(c->smallest, r->R + d);
}

// Visits all entries of the nodes near p. The first pass looks for records nearer than R: others bound nothing. The
// second looks for records whose own R is more than their distance; below the root these have at most half a node's
// side as reach a R. A record may be met more than once: both passes are idempotent.
static void clamp_visit(Clamp *c, uint32_t node, Vec3 lo, float side)
{
    const SheenOctree *t = c->cache->octree;
    float R = node == 0 ? INFINITY : c->shrink ? 0.51f * side / c->cache->accuracy : c->R;
    if (c->p.x + R < lo.x || c->p.x - R > lo.x + side || c->p.y + R < lo.y || c->p.y - R > lo.y + side ||
        c->p.z + R < lo.z || c->p.z - R > lo.z + side)
        return;
    for (uint32_t b = t->nodes[node].blocks; b; b = t->blocks[b].next)
        for (uint32_t i = 0; i < t->blocks[b].n; ++i) clamp_record(c, t->blocks[b].record[i]);
    float half = 0.5f * side;
    for (unsigned o = 0; o < 8; ++o) {
        uint32_t child = t->nodes[node].child[o];
        if (!child) continue;
        clamp_visit(c, child, v3(o & 1 ? lo.x + half : lo.x, o & 2 ? lo.y + half : lo.y, o & 4 ? lo.z + half : lo.z),
                    half);
    }
}

static void clamp_neighbors(SheenIrradianceCache *cache, IrradianceRecord *r)
{
    if (record_is_sliver(r)) return;
    Clamp c = {.cache = cache, .p = r->p, .R = r->R, .smallest = r->R};
    clamp_visit(&c, 0, cache->octree->lo, cache->octree->side);
    r->R = maxf(r->R_min, c.smallest);
    c.limit = r->R;
    c.shrink = true;
    clamp_visit(&c, 0, cache->octree->lo, cache->octree->side);
}

SheenStatus sheen_irradiance_cache_insert(SheenIrradianceCache *c, const IrradianceRecord *record)
{
    if (c->n_records == c->capacity) {
        uint32_t capacity = c->capacity ? 2 * c->capacity : 1024;
        if (capacity < c->capacity) return SHEEN_ERR_NOMEM;
        IrradianceRecord *grown = realloc(c->records, (size_t)capacity * sizeof *grown);
        if (!grown) return SHEEN_ERR_NOMEM;
        c->records = grown;
        c->capacity = capacity;
    }
    IrradianceRecord r = *record;
    if (c->neighbor_clamping) clamp_neighbors(c, &r);
    SheenStatus status = sheen_octree_insert(c->octree, r.p, c->accuracy * r.R, c->n_records);
    if (status != SHEEN_OK) return status;
    c->records[c->n_records++] = r;
    return SHEEN_OK;
}

// The weight w - 1/a of a record, continuous where its influence ends. A record whose radius had to be enlarged to what
// the picture resolves keeps its full weight within its own radius; in the ring beyond it a thousandth: that decides
// only where no other record reaches. A contact's darkness would otherwise paint discs onto the open floor beside it.
// @param cover  out: 2 for a record that reaches the point by itself, 1 where it was enlarged
static float influence(const SheenIrradianceCache *c, const IrradianceRecord *r, float d2, float cos_n, unsigned *cover)
{
    const float ring = 1e-3f;
    float least = 1.0f / c->accuracy, w = record_weight(r->R, d2, cos_n) - least;
    if (!record_is_enlarged(r)) {
        *cover = 2;
        return w;
    }
    float own = record_weight(r->R_sure, d2, cos_n) - least;
    *cover = own > 0.0f ? 2 : 1;
    return ring * minf(w, least) + maxf(own, 0.0f);
}

// Takes a record when it serves the point. @param d2  squared distance, below the square of the record's reach
static void consider(const SheenIrradianceCache *c, uint32_t record, float d2, Vec3 p, Vec3 n, float slack,
                     Contributors *out)
{
    const IrradianceRecord *r = &c->records[record];
    unsigned cover;
    float w = influence(c, r, d2, v3_dot(n, r->n), &cover);
    if (!(w > 0.0f) || record_in_front(r, p, n, c->accuracy, slack) || out->n == SHEEN_CONTRIBUTORS_MAX) return;
    w = minf(w, weight_max);
    out->record[out->n] = record;
    out->weight[out->n++] = w;
    out->weight_sum += w;
    out->cover += cover;
}

// The records of a block that reach the point, the newest first.
static void consider_block(const SheenIrradianceCache *c, const OctreeBlock *b, Vec3 p, Vec3 n, float slack,
                           Contributors *out)
{
    float d2[SHEEN_OCTREE_LANES];
    octree_block_distances2(b, p, d2);
    for (unsigned lanes = octree_block_holding(b, d2); lanes != 0;) {
        unsigned lane = 31u - (unsigned)__builtin_clz(lanes);
        lanes ^= 1u << lane;
        consider(c, b->record[lane], d2[lane], p, n, slack, out);
    }
}

void sheen_irradiance_cache_find(const SheenIrradianceCache *c, Vec3 p, Vec3 n, float slack, Contributors *out)
{
    out->n = out->cover = 0;
    out->weight_sum = 0.0f;
    const SheenOctree *t = c->octree;
    for (OctreeWalk walk = octree_walk(t); walk.node != SHEEN_OCTREE_END; octree_descend(t, &walk, p))
        for (uint32_t b = t->nodes[walk.node].blocks; b; b = t->blocks[b].next)
            consider_block(c, &t->blocks[b], p, n, slack, out);
}

float sheen_irradiance_cache_expect_radius(const SheenIrradianceCache *c, Vec3 p)
{
    float least = INFINITY;
    const SheenOctree *t = c->octree;
    for (OctreeWalk walk = octree_walk(t); walk.node != SHEEN_OCTREE_END; octree_descend(t, &walk, p))
        for (uint32_t b = t->nodes[walk.node].blocks; b; b = t->blocks[b].next) {
            float d2[SHEEN_OCTREE_LANES];
            octree_block_distances2(&t->blocks[b], p, d2);
            for (int i = 0; i < SHEEN_OCTREE_LANES; ++i)
                least = minf(sqrtf(t->blocks[b].reach2[i]) / c->accuracy + sqrtf(d2[i]), least);
        }
    return least;
}

Rgb sheen_irradiance_cache_interpolate(const SheenIrradianceCache *c, const Contributors *found, Vec3 p, Vec3 n)
{
    Rgb sum = rgb_gray(0.0f);
    if (found->n == 0) return sum;
    for (unsigned i = 0; i < found->n; ++i)
        sum = rgb_mad(sum, found->weight[i], record_extrapolate(&c->records[found->record[i]], p, n));
    return rgb_scale(sum, 1.0f / found->weight_sum);
}

uint64_t sheen_irradiance_cache_bytes(const SheenIrradianceCache *c)
{
    return (uint64_t)c->n_records * sizeof *c->records + sheen_octree_bytes(c->octree);
}
