// SPDX-License-Identifier: Apache-2.0
// A log that counts the errors told to it: a reader that fails tells exactly one.
#ifndef SHEEN_FUZZ_ERRORS_H
#define SHEEN_FUZZ_ERRORS_H

#include "base/log.h"

static void count_errors(void *user, SheenLogLevel level, const char *text)
{
    (void)text;
    *(int *)user += level == SHEEN_LOG_ERROR;
}

#endif
