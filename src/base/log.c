// SPDX-License-Identifier: Apache-2.0
#include "base/log.h"

#include <stdarg.h>
#include <stdio.h>

static void emit(const SheenLog *log, SheenLogLevel level, const char *format, va_list args)
{
    if (!log || !log->fn) return;
    char text[1024];
    vsnprintf(text, sizeof text, format, args);
    log->fn(log->user, level, text);
}

SheenStatus sheen_fail(const SheenLog *log, SheenStatus status, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    emit(log, SHEEN_LOG_ERROR, format, args);
    va_end(args);
    return status;
}

void sheen_warn(const SheenLog *log, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    emit(log, SHEEN_LOG_WARNING, format, args);
    va_end(args);
}

void sheen_info(const SheenLog *log, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    emit(log, SHEEN_LOG_INFO, format, args);
    va_end(args);
}
