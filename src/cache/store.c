// SPDX-License-Identifier: Apache-2.0
#include "cache/store.h"

#include <stdlib.h>

// A point on a record has infinite weight; this finite one still outweighs all others.
static const float weight_max = 1e6f;

SheenStatus sheen_store_create(float accuracy, bool neighbor_clamping, const Bounds *bounds, SheenRecordStore **out)
{
    *out = NULL;
    SheenRecordStore *s = calloc(1, sizeof *s);
    if (!s) return SHEEN_ERR_NOMEM;
    s->accuracy = s->a_least = accuracy;
    s->neighbor_clamping = neighbor_clamping;
    s->cos_min = -1.0f;
    if (sheen_octree_create(bounds, &s->octree) != SHEEN_OK) {
        free(s);
        return SHEEN_ERR_NOMEM;
    }
    *out = s;
    return SHEEN_OK;
}

void sheen_store_destroy(SheenRecordStore **store)
{
    if (!store || !*store) return;
    sheen_octree_destroy(&(*store)->octree);
    free((*store)->records);
    free(*store);
    *store = NULL;
}

// One sphere of influence that clamping visits: a record's own.
typedef struct Clamp {
    const SheenRecordStore *store;
    Vec3 p;
    float R;         // first pass: search radius
    float smallest;  // out, first pass: least R_j + distance
    float limit;     // in, second pass: neighbors shrink to limit + distance
    Record *shrinks; // second pass: the store's records; NULL in the first
} Clamp;

static void clamp_record(Clamp *c, uint32_t record)
{
    const Record *r = &c->store->records[record];
    float d = v3_length(v3_sub(r->p, c->p));
    if (c->shrinks)
        c->shrinks[record].R = maxf(r->R_min, minf(r->R, c->limit + d));
    else if (!record_is_sliver(r))
        c->smallest = minf(c->smallest, r->R + d);
}

// Visits all entries of the nodes near p. The first pass looks for records nearer than R: others bound nothing. The
// second looks for records whose own R is more than their distance; below the root these have at most half a node's
// side as reach, which is a R or more. A record may be met more than once: both passes are idempotent.
static void clamp_visit(Clamp *c, uint32_t node, Vec3 lo, float side)
{
    const SheenOctree *t = c->store->octree;
    float R = node == 0 ? INFINITY : c->shrinks ? 0.51f * side / c->store->a_least : c->R;
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

void sheen_store_bound(const SheenRecordStore *store, Record *r)
{
    if (!store->neighbor_clamping || record_is_sliver(r)) return;
    Clamp c = {.store = store, .p = r->p, .R = r->R, .smallest = r->R};
    clamp_visit(&c, 0, store->octree->lo, store->octree->side);
    r->R = maxf(r->R_min, c.smallest);
}

static void shrink_neighbors(SheenRecordStore *store, const Record *r)
{
    if (!store->neighbor_clamping || record_is_sliver(r)) return;
    Clamp c = {.store = store, .p = r->p, .limit = r->R, .shrinks = store->records};
    clamp_visit(&c, 0, store->octree->lo, store->octree->side);
}

static SheenStatus index_record(SheenOctree *tree, const Record *r, uint32_t number)
{
    return sheen_octree_insert(tree, r->p, record_reach(r), number);
}

SheenStatus sheen_store_append(SheenRecordStore *s, const Record *record)
{
    if (s->n == s->capacity) {
        uint32_t capacity = s->capacity ? 2 * s->capacity : 1024;
        if (capacity < s->capacity) return SHEEN_ERR_NOMEM;
        Record *grown = realloc(s->records, (size_t)capacity * sizeof *grown);
        if (!grown) return SHEEN_ERR_NOMEM;
        s->records = grown;
        s->capacity = capacity;
    }
    SheenStatus status = index_record(s->octree, record, s->n);
    if (status != SHEEN_OK) return status;
    s->records[s->n++] = *record;
    s->a_least = minf(s->a_least, record->a);
    return SHEEN_OK;
}

SheenStatus sheen_store_insert(SheenRecordStore *s, const Record *record)
{
    Record r = *record;
    sheen_store_bound(s, &r);
    shrink_neighbors(s, &r);
    return sheen_store_append(s, &r);
}

SheenStatus sheen_store_reindex(SheenRecordStore *s)
{
    SheenOctree *tree = NULL;
    SheenStatus status = sheen_octree_create_alike(s->octree, &tree);
    for (uint32_t i = 0; i < s->n && status == SHEEN_OK; ++i) status = index_record(tree, &s->records[i], i);
    if (status != SHEEN_OK) {
        sheen_octree_destroy(&tree);
        return status;
    }
    sheen_octree_destroy(&s->octree);
    s->octree = tree;
    for (uint32_t i = 0; i < s->n; ++i) s->a_least = minf(s->a_least, s->records[i].a);
    return SHEEN_OK;
}

// The weight w - 1/a of a record, continuous where its influence ends. A record whose radius had to be enlarged to what
// the picture resolves keeps its full weight within its own radius; in the ring beyond it a thousandth: that decides
// only where no other record reaches. A contact's darkness would otherwise paint discs onto the open floor beside it.
// @param most   metres that an enlarged record reaches at most
// @param cover  out: 2 for a record that reaches the point by itself, 1 where it was enlarged
static float influence(const Record *r, float most, float d2, float cos_n, unsigned *cover)
{
    const float ring = 1e-3f;
    float least = 1.0f / r->a;
    if (!record_is_enlarged(r)) {
        *cover = 2;
        return record_weight(r->R, d2, cos_n) - least;
    }
    float w = record_weight(maxf(r->R_sure, minf(r->R, most / r->a)), d2, cos_n) - least;
    float own = record_weight(r->R_sure, d2, cos_n) - least;
    *cover = own > 0.0f ? 2 : 1;
    return ring * minf(w, least) + maxf(own, 0.0f);
}

// Adds a contributor; when there are too many it takes the place of the lightest: large records are met first, and
// small ones would be left out where a surface shows most detail.
static void add_contributor(uint32_t record, float w, Contributors *out)
{
    unsigned at = out->n;
    if (out->n < SHEEN_CONTRIBUTORS_MAX)
        ++out->n;
    else {
        at = 0;
        for (unsigned i = 1; i < out->n; ++i)
            if (out->weight[i] < out->weight[at]) at = i;
        if (!(w > out->weight[at])) return;
        out->weight_sum -= out->weight[at];
    }
    out->record[at] = record;
    out->weight[at] = w;
    out->weight_sum += w;
}

/** What is asked of the store. */
typedef struct Query {
    Vec3 p, n;
    float most;
} Query;

// Takes a record when it serves the point.
static void consider(const SheenRecordStore *s, uint32_t record, const Query *q, Contributors *out)
{
    const Record *r = &s->records[record];
    unsigned cover;
    float cos_n = v3_dot(q->n, r->n), w = influence(r, q->most, record_distance2(r, q->p), cos_n, &cover);
    if (!(w > 0.0f) || cos_n < s->cos_min || record_in_front(r, q->p, q->n)) return;
    add_contributor(record, minf(w, weight_max), out);
    out->cover += cover;
}

// The records of a block that reach the point, the newest first.
static void consider_block(const SheenRecordStore *s, const OctreeBlock *b, const Query *q, Contributors *out)
{
    float d2[SHEEN_OCTREE_LANES];
    octree_block_distances2(b, q->p, d2);
    for (unsigned lanes = octree_block_holding(b, d2); lanes != 0;) {
        unsigned lane = 31u - (unsigned)__builtin_clz(lanes);
        lanes ^= 1u << lane;
        consider(s, b->record[lane], q, out);
    }
}

static void find(const SheenRecordStore *s, const Query *q, Contributors *out)
{
    out->n = out->cover = 0;
    out->weight_sum = 0.0f;
    const SheenOctree *t = s->octree;
    for (OctreeWalk walk = octree_walk(t); walk.node != SHEEN_OCTREE_END; octree_descend(t, &walk, q->p))
        for (uint32_t b = t->nodes[walk.node].blocks; b; b = t->blocks[b].next)
            consider_block(s, &t->blocks[b], q, out);
}

void sheen_store_find(const SheenRecordStore *s, Vec3 p, Vec3 n, Contributors *out)
{
    find(s, &(Query){p, n, INFINITY}, out);
}

void sheen_store_find_near(const SheenRecordStore *s, Vec3 p, Vec3 n, float most, Contributors *out)
{
    find(s, &(Query){p, n, most}, out);
}

RecordExpected sheen_store_expect(const SheenRecordStore *s, Vec3 p)
{
    RecordExpected e = {INFINITY, 0.0f};
    float nearest2 = INFINITY;
    const SheenOctree *t = s->octree;
    for (OctreeWalk walk = octree_walk(t); walk.node != SHEEN_OCTREE_END; octree_descend(t, &walk, p))
        for (uint32_t i = t->nodes[walk.node].blocks; i; i = t->blocks[i].next) {
            const OctreeBlock *b = &t->blocks[i];
            float d2[SHEEN_OCTREE_LANES];
            octree_block_distances2(b, p, d2);
            for (uint32_t k = 0; k < b->n; ++k) {
                float a = s->records[b->record[k]].a;
                e.reach = minf(sqrtf(b->reach2[k]) + a * sqrtf(d2[k]), e.reach);
                if (d2[k] < nearest2) nearest2 = d2[k], e.a = a;
            }
        }
    return e;
}

void sheen_store_refine(SheenRecordStore *s, const float a[])
{
    for (uint32_t i = 0; i < s->n; ++i) {
        Record *r = &s->records[i];
        if (!(a[i] < r->a)) continue;
        r->R_min *= r->a / a[i];
        r->a = a[i];
    }
}

uint64_t sheen_store_bytes(const SheenRecordStore *s)
{
    return (uint64_t)s->n * sizeof *s->records + sheen_octree_bytes(s->octree);
}
