// SPDX-License-Identifier: Apache-2.0
// How far the work is, for whoever shows it.
#ifndef SHEEN_BASE_PROGRESS_H
#define SHEEN_BASE_PROGRESS_H

#include <stddef.h>
#include <stdint.h>

/** Receives progress on the thread that called the renderer, at most some hundred times a second. */
typedef struct SheenProgress {
    /** @param stage  literal name of the stage; @param done  share of the stage in [0, 1]; @param records  so far */
    void (*fn)(void *user, const char *stage, double done, uint64_t records);
    void *user;
} SheenProgress;

static inline void progress_report(const SheenProgress *p, const char *stage, double done, uint64_t records)
{
    if (p && p->fn) p->fn(p->user, stage, done, records);
}

#endif
