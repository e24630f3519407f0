// SPDX-License-Identifier: Apache-2.0
// Records of a session from and to cache files.
#ifndef SHEEN_CLI_RECORD_FILES_H
#define SHEEN_CLI_RECORD_FILES_H

#include "stats.h"

#include "render/session.h"

/**
 * Reads the files of --cache-in into a session that has no records yet; warns of those made from another scene or with
 * other options.
 * @param reused  gets the number of records
 * @return the exit code
 */
int record_files_read(Run *run, SheenSession *session, uint64_t *reused);

/** Writes the session's records, settled, to --cache-out, if that is given. @param stats  its time is added
 *  @return the exit code */
int record_files_write(Run *run, SheenSession *session, RunStats *stats);

/** @return how many records the session has. */
uint64_t record_files_count(SheenSession *session);

#endif
