// SPDX-License-Identifier: Apache-2.0
#include "cache/octree.h"

#include <stdlib.h>

// Nodes are no smaller than this share of the largest coordinate: below some ulps the octants of a node coincide, and a
// sphere would lie in all of them at every level.
static const float smallest_share = 0x1p-20f;

static SheenStatus create_root(Vec3 lo, float side, float smallest, SheenOctree **out)
{
    *out = NULL;
    SheenOctree *t = calloc(1, sizeof *t);
    if (!t) return SHEEN_ERR_NOMEM;
    t->lo = lo;
    t->side = side;
    t->smallest = smallest;
    t->node_capacity = t->block_capacity = 64;
    t->nodes = calloc(t->node_capacity, sizeof *t->nodes);
    t->blocks = calloc(t->block_capacity, sizeof *t->blocks);
    t->n_nodes = t->n_blocks = 1;
    if (!t->nodes || !t->blocks) {
        sheen_octree_destroy(&t);
        return SHEEN_ERR_NOMEM;
    }
    *out = t;
    return SHEEN_OK;
}

SheenStatus sheen_octree_create(const Bounds *bounds, SheenOctree **out)
{
    Vec3 size = v3_sub(bounds->hi, bounds->lo);
    float side = maxf(size.x, maxf(size.y, size.z));
    if (!(side > 0.0f) || !isfinite(side)) side = 1.0f;
    side *= 1.01f;
    Vec3 c = bounds_center(bounds);
    if (!v3_finite(c)) c = v3(0, 0, 0);
    float smallest = smallest_share * maxf(side, maxf(fabsf(c.x), maxf(fabsf(c.y), fabsf(c.z))));
    return create_root(v3(c.x - 0.5f * side, c.y - 0.5f * side, c.z - 0.5f * side), side, smallest, out);
}

SheenStatus sheen_octree_create_alike(const SheenOctree *tree, SheenOctree **out)
{
    return create_root(tree->lo, tree->side, tree->smallest, out);
}

void sheen_octree_destroy(SheenOctree **tree)
{
    if (!tree || !*tree) return;
    free((*tree)->nodes);
    free((*tree)->blocks);
    free(*tree);
    *tree = NULL;
}

uint64_t sheen_octree_bytes(const SheenOctree *t)
{
    return (uint64_t)t->n_nodes * sizeof *t->nodes + (uint64_t)t->n_blocks * sizeof *t->blocks;
}

/** A sphere to be inserted. */
typedef struct Sphere {
    Vec3 center;
    float radius;
    uint32_t record;
} Sphere;

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

// Puts an empty block in front of a node's list. @return false when out of memory
static bool add_block(SheenOctree *t, uint32_t node)
{
    if (t->n_blocks == t->block_capacity) {
        if (t->block_capacity > UINT32_MAX / 2) return false;
        OctreeBlock *grown = realloc(t->blocks, 2 * (size_t)t->block_capacity * sizeof *grown);
        if (!grown) return false;
        t->blocks = grown;
        t->block_capacity *= 2;
    }
    OctreeBlock *b = &t->blocks[t->n_blocks];
    *b = (OctreeBlock){.next = t->nodes[node].blocks};
    for (int i = 0; i < SHEEN_OCTREE_LANES; ++i) b->x[i] = INFINITY;
    t->nodes[node].blocks = t->n_blocks++;
    return true;
}

static SheenStatus add_sphere(SheenOctree *t, uint32_t node, const Sphere *s)
{
    uint32_t first = t->nodes[node].blocks;
    if ((first == 0 || t->blocks[first].n == SHEEN_OCTREE_LANES) && !add_block(t, node)) return SHEEN_ERR_NOMEM;
    OctreeBlock *b = &t->blocks[t->nodes[node].blocks];
    uint32_t lane = b->n++;
    b->x[lane] = s->center.x, b->y[lane] = s->center.y, b->z[lane] = s->center.z;
    b->reach2[lane] = s->radius * s->radius;
    b->record[lane] = s->record;
    return SHEEN_OK;
}

static float outside(float x, float lo, float hi)
{
    return x < lo ? lo - x : x > hi ? x - hi : 0.0f;
}

static bool overlaps(const Sphere *s, Vec3 lo, float side)
{
    float x = outside(s->center.x, lo.x, lo.x + side), y = outside(s->center.y, lo.y, lo.y + side),
          z = outside(s->center.z, lo.z, lo.z + side);
    return x * x + y * y + z * z <= s->radius * s->radius;
}

static SheenStatus insert(SheenOctree *t, uint32_t node, Vec3 lo, float side, const Sphere *s)
{
    if (side <= 4.0f * s->radius || side <= t->smallest) return add_sphere(t, node, s);
    float half = 0.5f * side;
    for (unsigned octant = 0; octant < 8; ++octant) {
        Vec3 corner =
            v3(octant & 1 ? lo.x + half : lo.x, octant & 2 ? lo.y + half : lo.y, octant & 4 ? lo.z + half : lo.z);
        if (!overlaps(s, corner, half)) continue;
        uint32_t child = child_of(t, node, octant);
        if (!child) return SHEEN_ERR_NOMEM;
        SheenStatus status = insert(t, child, corner, half, s);
        if (status != SHEEN_OK) return status;
    }
    return SHEEN_OK;
}

SheenStatus sheen_octree_insert(SheenOctree *t, Vec3 center, float radius, uint32_t record)
{
    if (!(radius > 0.0f) || !v3_finite(center)) return SHEEN_OK; // holds no point
    Sphere sphere = {center, radius, record};
    return insert(t, 0, t->lo, t->side, &sphere);
}

bool sheen_octree_holds(const SheenOctree *t, Vec3 p)
{
    for (OctreeWalk walk = octree_walk(t); walk.node != SHEEN_OCTREE_END; octree_descend(t, &walk, p))
        for (uint32_t b = t->nodes[walk.node].blocks; b; b = t->blocks[b].next) {
            float d2[SHEEN_OCTREE_LANES];
            octree_block_distances2(&t->blocks[b], p, d2);
            if (octree_block_holding(&t->blocks[b], d2)) return true;
        }
    return false;
}
