// SPDX-License-Identifier: Apache-2.0
// An octree over the influence spheres of records: the records that may reach a point are in the nodes above it.
#ifndef SHEEN_CACHE_OCTREE_H
#define SHEEN_CACHE_OCTREE_H

#include "base/status.h"
#include "math/bounds.h"

#include <stdint.h>

typedef struct SheenOctree SheenOctree;

/** One sphere in a node's list. */
typedef struct OctreeEntry {
    Vec3 center;
    float reach2;    // squared radius at insertion
    uint32_t record; // the caller's number
    uint32_t next;   // entry of the same node, 0 at the end
} OctreeEntry;

typedef struct OctreeNode {
    uint32_t child[8]; // 0 for none
    uint32_t entries;  // first entry, 0 for none
} OctreeNode;

struct SheenOctree {
    Vec3 lo;        // lower corner of the root
    float side;     // of the root, metres
    float smallest; // side below which no node is divided
    OctreeNode *nodes;
    OctreeEntry *entries;
    uint32_t n_nodes, n_entries; // node 0 is the root, entry 0 is unused
    uint32_t node_capacity, entry_capacity;
};

/** @param bounds  where points will be; spheres may stick out */
SHEEN_NODISCARD SheenStatus sheen_octree_create(const Bounds *bounds, SheenOctree **out);
void sheen_octree_destroy(SheenOctree **tree);

/**
 * Adds a sphere to the nodes whose side is two to four times its radius and that it overlaps; the smallest spheres to
 * the smallest nodes. One that holds no point, without radius or not finite, is left out.
 */
SHEEN_NODISCARD SheenStatus sheen_octree_insert(SheenOctree *tree, Vec3 center, float radius, uint32_t record);

/** Bytes in use. */
uint64_t sheen_octree_bytes(const SheenOctree *tree);

/** A walk down from the root to the deepest node that holds a point. */
typedef struct OctreeWalk {
    uint32_t node; // SHEEN_OCTREE_END when done
    Vec3 lo;
    float half;
} OctreeWalk;
#define SHEEN_OCTREE_END UINT32_MAX

static inline OctreeWalk octree_walk(const SheenOctree *tree)
{
    return (OctreeWalk){0, tree->lo, 0.5f * tree->side};
}

/** Goes to the child that holds p; walk->node becomes SHEEN_OCTREE_END below the last. */
static inline void octree_descend(const SheenOctree *tree, OctreeWalk *walk, Vec3 p)
{
    Vec3 mid = v3(walk->lo.x + walk->half, walk->lo.y + walk->half, walk->lo.z + walk->half);
    unsigned x = p.x >= mid.x, y = p.y >= mid.y, z = p.z >= mid.z;
    uint32_t child = tree->nodes[walk->node].child[x | y << 1 | z << 2];
    walk->lo = v3(x ? mid.x : walk->lo.x, y ? mid.y : walk->lo.y, z ? mid.z : walk->lo.z);
    walk->half *= 0.5f;
    walk->node = child ? child : SHEEN_OCTREE_END;
}

#endif
