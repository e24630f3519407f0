// SPDX-License-Identifier: Apache-2.0
// Where messages go. The library never prints: it hands one line of text to the caller's function.
#ifndef SHEEN_BASE_LOG_H
#define SHEEN_BASE_LOG_H

#include "base/status.h"

typedef enum SheenLogLevel { SHEEN_LOG_ERROR, SHEEN_LOG_WARNING, SHEEN_LOG_INFO } SheenLogLevel;

/**
 * Receives one message. Called by the thread that called the library, never by a worker, without locks held.
 * @param text  one line without a newline, valid during the call
 */
typedef void SheenLogFn(void *user, SheenLogLevel level, const char *text);

/** A message sink; `fn` NULL drops everything. Passed by const pointer; NULL drops everything too. */
typedef struct SheenLog {
    SheenLogFn *fn;
    void *user;
} SheenLog;

/**
 * Formats one error line, hands it to the log and returns `status`, so that a caller writes `return sheen_fail(...)`.
 * A line about a file reads `FILE:LINE:COLUMN: what is wrong` or `FILE: what is wrong`. Lines over 1,023 bytes are cut.
 */
SheenStatus sheen_fail(const SheenLog *log, SheenStatus status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/** Formats one warning line: what was not supported or doubtful, and what was done instead. */
void sheen_warn(const SheenLog *log, const char *format, ...) __attribute__((format(printf, 2, 3)));

/** Formats one line that a user may want to see with `--verbose`. */
void sheen_info(const SheenLog *log, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
