// SPDX-License-Identifier: Apache-2.0
// Messages of the library on stderr: one line for an error, warnings that --strict turns into errors.
#ifndef SHEEN_CLI_REPORT_H
#define SHEEN_CLI_REPORT_H

#include "progress.h"

#include "base/log.h"

#include <stdbool.h>

typedef struct Report {
    bool quiet, verbose, strict;
    ProgressShow *show; // its live line makes room for messages; may be NULL
    bool failed;        // an error was reported, or a warning under --strict
} Report;

/** @param report  borrowed */
SheenLog report_log(Report *report);

/**
 * The exit code of a status of the library: makes sure that an error has its one line.
 * @param what  the file or thing that the line names when the library said nothing
 */
int report_exit_code(Report *report, SheenStatus status, const char *what);

#endif
