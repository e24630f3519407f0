// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include "base/clock.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const double live_interval = 0.1, plain_interval = 5.0; // seconds
enum { BAR_WIDTH = 24 };

// Below a second of work or a hundredth of the share, an estimate of what is left is a guess.
static const double least_elapsed = 1.0, least_done = 0.01;

ProgressShow progress_show_make(ProgressMode mode)
{
    return (ProgressShow){.on = mode != PROGRESS_NONE, .live = mode == PROGRESS_AUTO && isatty(STDERR_FILENO)};
}

static void print_line(const ProgressShow *show, double done, uint64_t records, double elapsed)
{
    char bar[BAR_WIDTH + 1];
    memset(bar, '.', BAR_WIDTH);
    memset(bar, '#', (size_t)(done * BAR_WIDTH));
    bar[BAR_WIDTH] = '\0';
    fputs(show->live ? "\r\033[K" : "sheen: ", stderr);
    if (show->n_parts > 1) fprintf(stderr, "%s %zu of %zu, ", show->parts, show->part + 1, show->n_parts);
    if (show->live)
        fprintf(stderr, "%s [%s] %3.0f %%", show->stage, bar, 100.0 * done);
    else
        fprintf(stderr, "%s %.0f %%", show->stage, 100.0 * done);
    if (records) fprintf(stderr, ", %llu records", (unsigned long long)records);
    if (show->n_parts > 1) {
        // Parts are alike, the stages of one are not: what is left is told by the parts that are done.
        elapsed = show->last_shown - show->parts_start;
        done = (double)show->part / (double)show->n_parts;
    }
    if (elapsed >= least_elapsed && done >= least_done && done < 1.0)
        fprintf(stderr, ", %.0f s left", elapsed * (1.0 - done) / done);
    if (!show->live) fputc('\n', stderr);
    fflush(stderr);
}

static void on_progress(void *user, const char *stage, double done, uint64_t records)
{
    ProgressShow *show = user;
    double now = sheen_clock_seconds();
    bool new_stage = !show->stage || strcmp(show->stage, stage) != 0;
    if (new_stage) {
        // The first plain line waits for its interval, so that a quick render says nothing.
        if (!show->stage) show->last_shown = now;
        show->stage = stage;
        show->stage_start = now;
    }
    if (now - show->last_shown < (show->live ? live_interval : plain_interval)) return;
    show->last_shown = now;
    show->on_screen = show->live;
    if (!(done >= 0.0)) done = 0.0; // also a NaN
    if (done > 1.0) done = 1.0;
    print_line(show, done, records, now - show->stage_start);
}

SheenProgress progress_show_sink(ProgressShow *show)
{
    return (SheenProgress){.fn = show->on ? on_progress : NULL, .user = show};
}

void progress_show_part(ProgressShow *show, const char *what, size_t part, size_t n)
{
    if (part == 0 || show->parts != what) show->parts_start = sheen_clock_seconds();
    show->parts = what;
    show->part = part;
    show->n_parts = n;
}

void progress_show_clear(ProgressShow *show)
{
    if (show->on_screen) fputs("\r\033[K", stderr);
    show->on_screen = false;
}
