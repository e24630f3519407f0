// SPDX-License-Identifier: Apache-2.0
#include "base/pool.h"

#include <pthread.h>
#include <sched.h>
#include <stdlib.h>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

enum { MAX_THREADS = 1024 };

typedef struct Worker {
    struct SheenPool *pool;
    pthread_t thread;
    unsigned index;
} Worker;

struct SheenPool {
    unsigned size;
    Worker *workers; // [size]; workers[0] is the caller's and has no thread
    pthread_mutex_t lock;
    pthread_cond_t start, done;
    unsigned long generation; // counts batches; a change wakes the threads
    unsigned active;          // threads that have not finished the batch
    bool quit;
    // The batch in work.
    SheenTaskFn *task;
    void *user;
    size_t n;
    const atomic_bool *cancel;
    atomic_size_t next;
};

// Denormals slow tracing down and Embree wants them off: flush to zero, denormals are zero, on each tracing thread.
static void set_flush_to_zero(void)
{
#if defined(__SSE__)
    _mm_setcsr(_mm_getcsr() | 0x8040u);
#endif
}

static void run_items(SheenPool *pool, unsigned worker)
{
    for (;;) {
        if (pool->cancel && atomic_load_explicit(pool->cancel, memory_order_relaxed)) return;
        size_t i = atomic_fetch_add_explicit(&pool->next, 1, memory_order_relaxed);
        if (i >= pool->n) return;
        pool->task(pool->user, i, worker);
    }
}

static void *worker_main(void *arg)
{
    Worker *self = arg;
    SheenPool *pool = self->pool;
    unsigned long seen = 0;
    set_flush_to_zero();
    pthread_mutex_lock(&pool->lock);
    for (;;) {
        while (!pool->quit && pool->generation == seen) pthread_cond_wait(&pool->start, &pool->lock);
        if (pool->quit) break;
        seen = pool->generation;
        pthread_mutex_unlock(&pool->lock);
        run_items(pool, self->index);
        pthread_mutex_lock(&pool->lock);
        if (--pool->active == 0) pthread_cond_signal(&pool->done);
    }
    pthread_mutex_unlock(&pool->lock);
    return NULL;
}

static unsigned core_count(void)
{
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
    int n = CPU_COUNT(&set);
    return n < 1 ? 1 : (unsigned)n;
}

SheenStatus sheen_pool_create(unsigned n_threads, SheenPool **out)
{
    *out = NULL;
    if (n_threads > MAX_THREADS) return SHEEN_ERR_INVALID;
    if (n_threads == 0) n_threads = core_count();
    SheenPool *pool = calloc(1, sizeof *pool);
    if (!pool) return SHEEN_ERR_NOMEM;
    pool->workers = calloc(n_threads, sizeof *pool->workers);
    if (!pool->workers) {
        free(pool);
        return SHEEN_ERR_NOMEM;
    }
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->start, NULL);
    pthread_cond_init(&pool->done, NULL);
    pool->size = 1;
    for (unsigned i = 1; i < n_threads; ++i) {
        pool->workers[i] = (Worker){.pool = pool, .index = i};
        if (pthread_create(&pool->workers[i].thread, NULL, worker_main, &pool->workers[i]) != 0) {
            sheen_pool_destroy(&pool);
            return SHEEN_ERR_NOMEM;
        }
        pool->size = i + 1;
    }
    *out = pool;
    return SHEEN_OK;
}

void sheen_pool_destroy(SheenPool **pool_ptr)
{
    SheenPool *pool = pool_ptr ? *pool_ptr : NULL;
    if (!pool) return;
    pthread_mutex_lock(&pool->lock);
    pool->quit = true;
    pthread_cond_broadcast(&pool->start);
    pthread_mutex_unlock(&pool->lock);
    for (unsigned i = 1; i < pool->size; ++i) pthread_join(pool->workers[i].thread, NULL);
    pthread_cond_destroy(&pool->done);
    pthread_cond_destroy(&pool->start);
    pthread_mutex_destroy(&pool->lock);
    free(pool->workers);
    free(pool);
    *pool_ptr = NULL;
}

unsigned sheen_pool_size(const SheenPool *pool)
{
    return pool->size;
}

bool sheen_pool_run(SheenPool *pool, size_t n, SheenTaskFn *task, void *user, const atomic_bool *cancel)
{
    set_flush_to_zero();
    pthread_mutex_lock(&pool->lock);
    pool->task = task;
    pool->user = user;
    pool->n = n;
    pool->cancel = cancel;
    atomic_store_explicit(&pool->next, 0, memory_order_relaxed);
    pool->active = pool->size - 1;
    ++pool->generation;
    pthread_cond_broadcast(&pool->start);
    pthread_mutex_unlock(&pool->lock);

    run_items(pool, 0);

    pthread_mutex_lock(&pool->lock);
    while (pool->active > 0) pthread_cond_wait(&pool->done, &pool->lock);
    pthread_mutex_unlock(&pool->lock);
    return atomic_load(&pool->next) >= n;
}
