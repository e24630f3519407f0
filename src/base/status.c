// SPDX-License-Identifier: Apache-2.0
#include "base/status.h"

const char *sheen_status_text(SheenStatus status)
{
    switch (status) {
#define X(name, value, text)                                                                                           \
    case name:                                                                                                         \
        return text;
        SHEEN_STATUS_MAP(X)
#undef X
    }
    return "unknown status";
}
