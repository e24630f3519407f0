// SPDX-License-Identifier: Apache-2.0
// The store of records: insertion with clamping, and which records serve a point. Knows not what light they hold, no
// scene and no rays.
#ifndef SHEEN_CACHE_STORE_H
#define SHEEN_CACHE_STORE_H

#include "cache/octree.h"
#include "cache/record.h"

/** Records in the order of insertion. Readers may run in parallel while nobody inserts. */
typedef struct SheenRecordStore {
    float accuracy;         // the largest a of a record
    float a_least;          // the least a that a record in the octree had when it was put there
    bool neighbor_clamping; // krivanek2006-making-caching-practical sec. 5.2
    float cos_min;          // least cosine between the normals of a record and of a point that it serves; -1 at first
    SheenOctree *octree;
    Record *records;
    uint32_t n, capacity;
} SheenRecordStore;

/**
 * @param accuracy  the largest a that a record will have, in (0, 1]
 * @param bounds    where records and shading points will be
 */
SHEEN_NODISCARD SheenStatus sheen_store_create(float accuracy, bool neighbor_clamping, const Bounds *bounds,
                                               SheenRecordStore **out);
void sheen_store_destroy(SheenRecordStore **store);

/**
 * Stores a copy of the record. With neighbor clamping its radius first becomes at most R_j + distance of each record j,
 * and then those records' radii at most R + distance, none below its own R_min. Slivers clamp nobody.
 * Source: krivanek2006-making-caching-practical sec. 5.2, with radii clamped to their minimum first: a contact's tiny
 * unclamped radius would otherwise push all its neighbors to their minimum too.
 */
SHEEN_NODISCARD SheenStatus sheen_store_insert(SheenRecordStore *store, const Record *record);

/** Stores a copy of a record whose radius is final, one that was clamped when it was made: nothing is clamped. */
SHEEN_NODISCARD SheenStatus sheen_store_append(SheenRecordStore *store, const Record *record);

/**
 * Builds the octree anew from the records in their order with the radii that they have now. It then is as if they had
 * just been appended, so that look-ups meet them in the same order; and smaller, where insertions clamped radii.
 * Errors: SHEEN_ERR_NOMEM; the store is unchanged then.
 */
SHEEN_NODISCARD SheenStatus sheen_store_reindex(SheenRecordStore *store);

/**
 * With neighbor clamping: makes a record's radius at most R_j + distance of each record j of the store, not below its
 * own R_min. Thread-safe. Source: krivanek2006-making-caching-practical sec. 5.2.
 */
void sheen_store_bound(const SheenRecordStore *store, Record *record);

/** The records that serve a point. */
enum { SHEEN_CONTRIBUTORS_MAX = 32 };
typedef struct Contributors {
    unsigned n;
    uint32_t record[SHEEN_CONTRIBUTORS_MAX];
    float weight[SHEEN_CONTRIBUTORS_MAX]; // w - 1/a > 0: continuous where a record's influence ends
    float weight_sum;                     // 0 when no record covers the point
    unsigned cover;                       // two or more where the point needs no further record
} Contributors;

/**
 * Finds the records with w > 1/a at (p, n), none in front of which the point lies. More than SHEEN_CONTRIBUTORS_MAX:
 * the heaviest are kept. Thread-safe.
 * @param n  unit normal of the lit side
 */
void sheen_store_find(const SheenRecordStore *store, Vec3 p, Vec3 n, Contributors *out);

/**
 * The same for a picture that resolves more than the one that the records were made for: those whose radius was
 * enlarged to what a picture resolves reach at most so far, or as far as their own radius where that is more.
 * Thread-safe.
 * @param most  metres
 */
void sheen_store_find_near(const SheenRecordStore *store, Vec3 p, Vec3 n, float most, Contributors *out);

/** What a record may be expected to be like. */
typedef struct RecordExpected {
    float reach; // a R, metres; INFINITY where no record is near
    float a;     // of the nearest record; 0 where there is none
} RecordExpected;

/**
 * What a record at p may be expected to be like, by those that lie near it in the octree: it reaches the least of their
 * reaches plus a times the distance. Thread-safe. Source: krivanek2006-making-caching-practical sec. 5.2, its
 * inequality used as a guess.
 */
RecordExpected sheen_store_expect(const SheenRecordStore *store, Vec3 p);

/**
 * Makes records more accurate. The least radius that clamping may set grows as a shrinks: the least reach stays.
 * @param a  [n] of each record of the store; those that are not less than it has change nothing
 * The octree stays as it is; sheen_store_reindex makes it smaller.
 */
void sheen_store_refine(SheenRecordStore *store, const float a[]);

uint64_t sheen_store_bytes(const SheenRecordStore *store);

#endif
