// SPDX-License-Identifier: Apache-2.0
// A fixed set of threads that run the items of one batch after another.
#ifndef SHEEN_BASE_POOL_H
#define SHEEN_BASE_POOL_H

#include "base/status.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct SheenPool SheenPool;

/**
 * One item of a batch.
 * @param user    what the batch was started with
 * @param item    index in [0, n)
 * @param worker  index in [0, sheen_pool_size) of the thread that runs it; at most one item runs on a worker at a time.
 *                For scratch memory and counters only: a result must not depend on it.
 */
typedef void SheenTaskFn(void *user, size_t item, unsigned worker);

/**
 * Starts the threads. The calling thread is worker 0 of each batch, so that n_threads - 1 threads are made.
 * @param n_threads  1..1024; 0 means all cores that this process may use
 * @param out        owned by the caller
 * Errors: SHEEN_ERR_INVALID above 1024, SHEEN_ERR_NOMEM when a thread cannot be made.
 */
SHEEN_NODISCARD SheenStatus sheen_pool_create(unsigned n_threads, SheenPool **out);

/** Joins the threads, frees the pool and sets *pool to NULL. NULL-safe. */
void sheen_pool_destroy(SheenPool **pool);

/** @return the number of workers, the caller's thread included. */
unsigned sheen_pool_size(const SheenPool *pool);

/**
 * Runs task(user, i, worker) for each i in [0, n), each exactly once, in no particular order, and returns when all are
 * done. Items are handed out one at a time, so an item should take 10 microseconds or more.
 * @param cancel  may be NULL; once it is true no further item starts
 * @return true when all items ran, false when cancelled
 * Not reentrant: a task must not run a batch on the same pool.
 */
bool sheen_pool_run(SheenPool *pool, size_t n, SheenTaskFn *task, void *user, const atomic_bool *cancel);

#endif
