// SPDX-License-Identifier: Apache-2.0
#include "cache/octree.h"

#include <stdlib.h>

// Nodes are no smaller than this share of the largest coordinate: below some ulps the octants of a node coincide, and a
// sphere would lie in all of them at every level.
static const float smallest_share = 0x1p-20f;

SheenStatus sheen_octree_create(const Bounds *bounds, SheenOctree **out)
{
    *out = NULL;
    SheenOctree *t = calloc(1, sizeof *t);
    if (!t) return SHEEN_ERR_NOMEM;
    Vec3 size = v3_sub(bounds->hi, bounds->lo);
    float side = maxf(size.x, maxf(size.y, size.z));
    if (!(side > 0.0f) || !isfinite(side)) side = 1.0f;
    side *= 1.01f;
    Vec3 c = bounds_center(bounds);
    if (!v3_finite(c)) c = v3(0, 0, 0);
    t->side = side;
    t->smallest = smallest_share * maxf(side, maxf(fabsf(c.x), maxf(fabsf(c.y), fabsf(c.z))));
    t->lo = v3(c.x - 0.5f * side, c.y - 0.5f * side, c.z - 0.5f * side);
    t->node_capacity = t->entry_capacity = 64;
    t->nodes = calloc(t->node_capacity, sizeof *t->nodes);
    t->entries = calloc(t->entry_capacity, sizeof *t->entries);
    t->n_nodes = t->n_entries = 1;
    if (!t->nodes || !t->entries) {
        sheen_octree_destroy(&t);
        return SHEEN_ERR_NOMEM;
    }
    *out = t;
    return SHEEN_OK;
}

void sheen_octree_destroy(SheenOctree **tree)
{
    if (!tree || !*tree) return;
    free((*tree)->nodes);
    free((*tree)->entries);
    free(*tree);
    *tree = NULL;
}

uint64_t sheen_octree_bytes(const SheenOctree *t)
{
    return (uint64_t)t->n_nodes * sizeof *t->nodes + (uint64_t)t->n_entries * sizeof *t->entries;
}

// Returns the child's number, 0 when out of memory.
static uint32_t child_of(SheenOctree *t, uint32_t node, unsigned octant)
{
    if (t->nodes[node].child[octant]) return t->nodes[node].child[octant];
    if (t->n_nodes == t->node_capacity) {
        if (t->node_capacity > UINT32_MAX / 2) return 0;
        OctreeNode *grown = realloc(t->nodes, 2 * (size_t)t->node_capacity * sizeof *grown);
        if (!grown) return 0;
        t->nodes = grown;
        t->node_capacity *= 2;
    }
    uint32_t child = t->n_nodes++;
    t->nodes[child] = (OctreeNode){0};
    t->nodes[node].child[octant] = child;
    return child;
}

static SheenStatus add_entry(SheenOctree *t, uint32_t node, const OctreeEntry *entry)
{
    if (t->n_entries == t->entry_capacity) {
        if (t->entry_capacity > UINT32_MAX / 2) return SHEEN_ERR_NOMEM;
        OctreeEntry *grown = realloc(t->entries, 2 * (size_t)t->entry_capacity * sizeof *grown);
        if (!grown) return SHEEN_ERR_NOMEM;
        t->entries = grown;
        t->entry_capacity *= 2;
    }
    t->entries[t->n_entries] = *entry;
    t->entries[t->n_entries].next = t->nodes[node].entries;
    t->nodes[node].entries = t->n_entries++;
    return SHEEN_OK;
}

static float outside(float x, float lo, float hi)
{
    return x < lo ? lo - x : x > hi ? x - hi : 0.0f;
}

static bool overlaps(const OctreeEntry *e, Vec3 lo, float side)
{
    float x = outside(e->center.x, lo.x, lo.x + side), y = outside(e->center.y, lo.y, lo.y + side),
          z = outside(e->center.z, lo.z, lo.z + side);
    return x * x + y * y + z * z <= e->reach2;
}

static SheenStatus insert(SheenOctree *t, uint32_t node, Vec3 lo, float side, float radius, const OctreeEntry *entry)
{
    if (side <= 4.0f * radius || side <= t->smallest) return add_entry(t, node, entry);
    float half = 0.5f * side;
    for (unsigned octant = 0; octant < 8; ++octant) {
        Vec3 corner =
            v3(octant & 1 ? lo.x + half : lo.x, octant & 2 ? lo.y + half : lo.y, octant & 4 ? lo.z + half : lo.z);
        if (!overlaps(entry, corner, half)) continue;
        uint32_t child = child_of(t, node, octant);
        if (!child) return SHEEN_ERR_NOMEM;
        SheenStatus status = insert(t, child, corner, half, radius, entry);
        if (status != SHEEN_OK) return status;
    }
    return SHEEN_OK;
}

SheenStatus sheen_octree_insert(SheenOctree *t, Vec3 center, float radius, uint32_t record)
{
    if (!(radius > 0.0f) || !v3_finite(center)) return SHEEN_OK; // holds no point
    OctreeEntry entry = {center, radius * radius, record, 0};
    return insert(t, 0, t->lo, t->side, radius, &entry);
}
