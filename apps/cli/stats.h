// SPDX-License-Identifier: Apache-2.0
// Statistics of a run as one JSON object.
#ifndef SHEEN_CLI_STATS_H
#define SHEEN_CLI_STATS_H

#include "run.h"

/** Of one picture. */
typedef struct FrameStats {
    long frame;
    double time;      // seconds
    uint64_t records; // that it reads, of irradiance and of radiance
    uint64_t added;   // of these, how many were made for it
} FrameStats;

/** What a run measured; counters and times are sums over its frames, in which a record counts
 * once. Times in seconds. */
typedef struct RunStats {
    double load, build, write, total;
    SheenStats render;
    uint64_t reused;          // times that a frame read a record made before it
    uint64_t from_files;      // records of --cache-in
    const FrameStats *frames; // [n_frames]
    size_t n_frames;
} RunStats;

/** @return the figures of a picture whose records were all made for it. */
FrameStats frame_stats(long frame, double time, const SheenStats *stats);

/**
 * Adds the figures of a frame to those of the `n` frames before: times and counters are sums, samples of a pixel the
 * least and the mean, memory the most.
 */
void stats_sum(SheenStats *total, size_t n, const SheenStats *frame);

/** Writes --stats, if given: one object, whose keys never change their meaning. @return the exit code */
int stats_write(const Run *run, const RunStats *stats);

#endif
