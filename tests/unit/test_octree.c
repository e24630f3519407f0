// SPDX-License-Identifier: Apache-2.0
// The octree over spheres: a walk down to a point meets every sphere that holds it.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/hash.h"
#include "cache/octree.h"

#include <stdlib.h>

/** Random numbers of one test. */
typedef struct Dice {
    uint32_t state;
} Dice;

static float dice(Dice *d, float lo, float hi)
{
    return lo + (hi - lo) * hash_to_unit(hash_u32(++d->state));
}
static Vec3 dice_point(Dice *d, Vec3 lo, Vec3 hi)
{
    float x = dice(d, lo.x, hi.x), y = dice(d, lo.y, hi.y), z = dice(d, lo.z, hi.z);
    return v3(x, y, z);
}

typedef struct Ball {
    Vec3 center;
    float radius;
} Ball;

static SheenOctree *tree_of(Bounds bounds, const Ball balls[], uint32_t n)
{
    SheenOctree *tree = NULL;
    assert_int_equal(sheen_octree_create(&bounds, &tree), SHEEN_OK);
    for (uint32_t i = 0; i < n; ++i)
        assert_int_equal(sheen_octree_insert(tree, balls[i].center, balls[i].radius, i), SHEEN_OK);
    return tree;
}

// Marks the lanes whose sphere holds p; returns how many lanes are in use.
static size_t meet_block(const OctreeBlock *b, Vec3 p, uint32_t n, unsigned char met[])
{
    float d2[SHEEN_OCTREE_LANES];
    octree_block_distances2(b, p, d2);
    unsigned holding = octree_block_holding(b, d2);
    assert_in_range(b->n, 1, SHEEN_OCTREE_LANES);
    assert_int_equal(holding >> b->n, 0); // a free lane holds no point
    for (uint32_t i = 0; i < b->n; ++i) {
        assert_in_range(b->record[i], 0, n - 1);
        Vec3 center = v3(b->x[i], b->y[i], b->z[i]);
        assert_int_equal(holding >> i & 1, v3_length2(v3_sub(p, center)) < b->reach2[i]);
        if (!(holding >> i & 1)) continue;
        assert_int_equal(met[b->record[i]], 0); // a walk passes each level once: no record is met twice
        met[b->record[i]] = 1;
    }
    return b->n;
}

// Marks what a walk to p meets whose sphere holds p; returns how many spheres it looked at.
static size_t meet(const SheenOctree *tree, Vec3 p, uint32_t n, unsigned char met[])
{
    size_t looked = 0;
    for (uint32_t i = 0; i < n; ++i) met[i] = 0;
    for (OctreeWalk walk = octree_walk(tree); walk.node != SHEEN_OCTREE_END; octree_descend(tree, &walk, p))
        for (uint32_t b = tree->nodes[walk.node].blocks; b; b = tree->blocks[b].next)
            looked += meet_block(&tree->blocks[b], p, n, met);
    return looked;
}

// Compares walks with brute force at points of the bounds and at points of the spheres that lie in the bounds.
static void assert_all_met(Bounds bounds, const Ball balls[], uint32_t n, uint32_t n_points, size_t least_hits)
{
    SheenOctree *tree = tree_of(bounds, balls, n);
    unsigned char *met = malloc(n);
    assert_non_null(met);
    Dice d = {77};
    size_t hits = 0;
    for (uint32_t i = 0; i < n_points; ++i) {
        Vec3 p = dice_point(&d, bounds.lo, bounds.hi);
        if (i & 1) { // near a sphere: small ones are never hit by chance
            const Ball *b = &balls[hash_u32(i) % n];
            p = v3_mad(b->center, b->radius, dice_point(&d, v3(-1, -1, -1), v3(1, 1, 1)));
            p = v3_min(v3_max(p, bounds.lo), bounds.hi);
        }
        meet(tree, p, n, met);
        for (uint32_t j = 0; j < n; ++j) {
            bool holds = v3_length2(v3_sub(p, balls[j].center)) < balls[j].radius * balls[j].radius;
            assert_int_equal(met[j], holds);
            hits += holds;
        }
    }
    assert_true(hits > least_hits); // the comparison was about something
    free(met);
    sheen_octree_destroy(&tree);
    assert_null(tree);
}

static const Bounds unit = {{-1.0f, -1.0f, -1.0f}, {1.0f, 1.0f, 1.0f}};

static void test_random_spheres(void **state)
{
    (void)state;
    enum { N = 500 };
    Ball balls[N];
    Dice d = {1};
    for (int i = 0; i < N; ++i) {
        balls[i].center = dice_point(&d, unit.lo, unit.hi);
        balls[i].radius = expf(dice(&d, -8.0f, -0.5f)); // 0.0003 to 0.6: most levels of the tree
    }
    assert_all_met(unit, balls, N, 4000, 4000);
}

static void test_flat_and_long_bounds(void **state)
{
    (void)state;
    enum { N = 200 };
    Bounds flat = {{100.0f, -3.0f, 5.0f}, {400.0f, -3.0f, 5.5f}};
    Ball balls[N];
    Dice d = {2};
    for (int i = 0; i < N; ++i) {
        balls[i].center = dice_point(&d, flat.lo, flat.hi);
        balls[i].radius = dice(&d, 0.05f, 20.0f);
    }
    assert_all_met(flat, balls, N, 1000, 5000);
}

// Spheres that hold the whole root, and spheres that reach into it from outside or miss it.
static void test_spheres_that_stick_out(void **state)
{
    (void)state;
    enum { N = 200 };
    Ball balls[N];
    Dice d = {3};
    for (int i = 0; i < N; ++i) {
        balls[i].center = dice_point(&d, v3(-3, -3, -3), v3(3, 3, 3));
        balls[i].radius = i % 4 ? dice(&d, 0.1f, 2.0f) : dice(&d, 5.0f, 50.0f);
    }
    assert_all_met(unit, balls, N, 1000, 20000);
}

// Down to spheres far below the smallest node: depth is bounded, nothing is lost.
static void test_many_levels(void **state)
{
    (void)state;
    enum { N = 64 };
    Bounds room = {{0.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 1.0f}};
    Ball balls[N];
    Dice d = {4};
    for (int i = 0; i < N; ++i) {
        // Near the origin floats resolve small radii, which elsewhere would round away.
        float size = ldexpf(1.0f, -i / 2);
        balls[i].center = dice_point(&d, v3(0, 0, 0), v3(size, size, size));
        balls[i].radius = 0.3f * size;
    }
    assert_all_met(room, balls, N, 2000, 500);
}

// What an octree is for: a walk looks at few of many small spheres.
static void test_walk_is_short(void **state)
{
    (void)state;
    enum { N = 4000 };
    Ball *balls = malloc(N * sizeof *balls);
    unsigned char *met = malloc(N);
    assert_true(balls && met);
    Dice d = {5};
    for (int i = 0; i < N; ++i) balls[i] = (Ball){dice_point(&d, unit.lo, unit.hi), 0.02f};
    SheenOctree *tree = tree_of(unit, balls, N);
    size_t looked = 0;
    for (int i = 0; i < 500; ++i) looked += meet(tree, dice_point(&d, unit.lo, unit.hi), N, met);
    // Cells of side up to 0.08 and spheres of radius 0.02 that overlap them: at most (0.12 / 2)^3 x 4000 < 1 a cell.
    assert_true(looked < 500 * 4);
    sheen_octree_destroy(&tree);
    free(balls);
    free(met);
}

static void test_degenerate_bounds(void **state)
{
    (void)state;
    static const Ball balls[3] = {{{0.1f, 0.2f, 0.3f}, 0.25f}, {{0, 0, 0}, 1e-3f}, {{-0.2f, 0, 0.1f}, 3.0f}};
    Bounds cases[3] = {bounds_empty(), {{0, 0, 0}, {0, 0, 0}}, {{0, 0, 0}, {INFINITY, 1, 1}}};
    for (int c = 0; c < 3; ++c) {
        SheenOctree *tree = tree_of(cases[c], balls, 3);
        assert_true(tree->side > 0.0f && isfinite(tree->side) && v3_finite(tree->lo));
        unsigned char met[3];
        meet(tree, v3(0, 0, 0), 3, met);
        for (int j = 0; j < 3; ++j) assert_int_equal(met[j], v3_length(balls[j].center) < balls[j].radius);
        sheen_octree_destroy(&tree);
    }
    sheen_octree_destroy(NULL);
}

// Radius zero, spheres in one point, infinite and non-finite ones: no hang and no crash, and others are still found.
static void test_odd_spheres(void **state)
{
    (void)state;
    Ball balls[104];
    for (int i = 0; i < 100; ++i) balls[i] = (Ball){{0.5f, 0.5f, 0.5f}, 0.1f};
    balls[100] = (Ball){{0.25f, 0.25f, 0.25f}, 0.0f};
    balls[101] = (Ball){{0, 0, 0}, INFINITY};
    balls[102] = (Ball){{0, 0, 0}, NAN};
    balls[103] = (Ball){{0, 0, 0}, 0.0f}; // on the corner of all eight octants
    SheenOctree *tree = tree_of(unit, balls, 104);
    unsigned char met[104];
    meet(tree, v3(0.52f, 0.5f, 0.5f), 104, met);
    for (int i = 0; i < 100; ++i) assert_int_equal(met[i], 1);
    assert_int_equal(met[101], 1);
    assert_int_equal(met[100] + met[102] + met[103], 0);
    sheen_octree_destroy(&tree);
}

// Far from the origin the sides of small nodes are below what floats resolve: the tree stays small.
static void test_far_from_the_origin(void **state)
{
    (void)state;
    Bounds far = {{1e6f, 1e6f, 1e6f}, {1e6f + 4.0f, 1e6f + 4.0f, 1e6f + 4.0f}};
    Ball balls[64];
    Dice d = {6};
    for (int i = 0; i < 64; ++i) balls[i] = (Ball){dice_point(&d, far.lo, far.hi), i % 2 ? 1e-4f : 0.5f};
    SheenOctree *tree = tree_of(far, balls, 64);
    assert_true(tree->n_nodes < 1000 && tree->n_blocks < 1000); // a sphere overlaps 27 nodes of its size at most
    unsigned char met[64];
    for (int i = 0; i < 64; ++i) {
        meet(tree, balls[i].center, 64, met);
        assert_int_equal(met[i], 1);
    }
    sheen_octree_destroy(&tree);
}

static void test_bytes_grow(void **state)
{
    (void)state;
    SheenOctree *tree = tree_of(unit, NULL, 0);
    uint64_t empty = sheen_octree_bytes(tree), before = empty;
    assert_true(before > 0);
    for (uint32_t i = 0; i < 1000; ++i) {
        Vec3 p = v3(0.9f * sinf((float)i), 0.9f * cosf((float)i), 0.0f);
        assert_int_equal(sheen_octree_insert(tree, p, 0.01f, i), SHEEN_OK);
        uint64_t now = sheen_octree_bytes(tree);
        assert_true(now >= before);
        before = now;
    }
    assert_true(before >= empty + 1000 / SHEEN_OCTREE_LANES * sizeof(OctreeBlock)); // at least one lane each
    sheen_octree_destroy(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_spheres),
        cmocka_unit_test(test_flat_and_long_bounds),
        cmocka_unit_test(test_spheres_that_stick_out),
        cmocka_unit_test(test_many_levels),
        cmocka_unit_test(test_walk_is_short),
        cmocka_unit_test(test_degenerate_bounds),
        cmocka_unit_test(test_odd_spheres),
        cmocka_unit_test(test_far_from_the_origin),
        cmocka_unit_test(test_bytes_grow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
