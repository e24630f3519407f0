// SPDX-License-Identifier: Apache-2.0
// An octree over the influence spheres of records: the records that may reach a point are in the nodes above it.
#ifndef SHEEN_CACHE_OCTREE_H
#define SHEEN_CACHE_OCTREE_H

#include "base/status.h"
#include "math/bounds.h"

#include <stdint.h>

typedef struct SheenOctree SheenOctree;

/** Up to eight spheres of a node's list. A free lane holds no point: its centre is infinitely far. */
enum { SHEEN_OCTREE_LANES = 8 };
typedef struct OctreeBlock {
    float x[SHEEN_OCTREE_LANES], y[SHEEN_OCTREE_LANES], z[SHEEN_OCTREE_LANES]; // centers
    float reach2[SHEEN_OCTREE_LANES];                                          // squared radii at insertion
    uint32_t record[SHEEN_OCTREE_LANES];                                       // the caller's numbers
    uint32_t n;                                                                // lanes in use, the first ones
    uint32_t next;                                                             // block of the same node, 0 at the end
} OctreeBlock;

typedef struct OctreeNode {
    uint32_t child[8]; // 0 for none
    uint32_t blocks;   // first block, the newest; 0 for none
} OctreeNode;

struct SheenOctree {
    Vec3 lo;        // lower corner of the root
    float side;     // of the root, metres
    float smallest; // side below which no node is divided
    OctreeNode *nodes;
    OctreeBlock *blocks;
    uint32_t n_nodes, n_blocks; // node 0 is the root, block 0 is unused
    uint32_t node_capacity, block_capacity;
};

/** @param bounds  where points will be; spheres may stick out */
SHEEN_NODISCARD SheenStatus sheen_octree_create(const Bounds *bounds, SheenOctree **out);
void sheen_octree_destroy(SheenOctree **tree);

/** An empty tree over the same space. */
SHEEN_NODISCARD SheenStatus sheen_octree_create_alike(const SheenOctree *tree, SheenOctree **out);

/**
 * Adds a sphere to the nodes whose side is two to four times its radius and that it overlaps; the smallest spheres to
 * the smallest nodes. One that holds no point, without radius or not finite, is left out.
 */
SHEEN_NODISCARD SheenStatus sheen_octree_insert(SheenOctree *tree, Vec3 center, float radius, uint32_t record);

/** Whether a sphere holds a point. */
bool sheen_octree_holds(const SheenOctree *tree, Vec3 p);

/** Bytes in use. */
uint64_t sheen_octree_bytes(const SheenOctree *tree);

/** Squared distances from p to the centers of a block. */
static inline void octree_block_distances2(const OctreeBlock *b, Vec3 p, float d2[SHEEN_OCTREE_LANES])
{
    for (int i = 0; i < SHEEN_OCTREE_LANES; ++i) d2[i] = v3_length2(v3_sub(p, v3(b->x[i], b->y[i], b->z[i])));
}

/** @return bit i for each lane i whose sphere holds a point with these squared distances to the centers. */
static inline unsigned octree_block_holding(const OctreeBlock *b, const float d2[SHEEN_OCTREE_LANES])
{
    unsigned lanes = 0;
    for (unsigned i = 0; i < SHEEN_OCTREE_LANES; ++i) lanes |= d2[i] < b->reach2[i] ? 1u << i : 0u;
    return lanes;
}

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
