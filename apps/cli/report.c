// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include "cli.h"

static void on_message(void *user, SheenLogLevel level, const char *text)
{
    Report *report = user;
    if (report->show) progress_show_clear(report->show);
    if (level == SHEEN_LOG_ERROR || (level == SHEEN_LOG_WARNING && report->strict)) {
        // One line: what follows a first error is its consequence.
        if (!report->failed) cli_error("%s", text);
        report->failed = true;
    } else if (level == SHEEN_LOG_WARNING) {
        if (!report->quiet) cli_note("sheen: warning: ", "%s", text);
    } else if (report->verbose) {
        cli_note("sheen: ", "%s", text);
    }
}

SheenLog report_log(Report *report)
{
    return (SheenLog){.fn = on_message, .user = report};
}

int report_exit_code(Report *report, SheenStatus status, const char *what)
{
    if (report->show) progress_show_clear(report->show);
    if (status != SHEEN_OK && !report->failed) {
        cli_error("%s: %s", what, sheen_status_text(status));
        report->failed = true;
    }
    return report->failed ? CLI_WORLD : CLI_DONE;
}
