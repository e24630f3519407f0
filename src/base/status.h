// SPDX-License-Identifier: Apache-2.0
// One table of all error codes and their texts.
#ifndef SHEEN_BASE_STATUS_H
#define SHEEN_BASE_STATUS_H

// clang-format off
#define SHEEN_STATUS_MAP(X)                                   \
    X(SHEEN_OK, 0, "success")                                 \
    X(SHEEN_ERR_INVALID, -1, "invalid argument")              \
    X(SHEEN_ERR_NOMEM, -2, "out of memory")                   \
    X(SHEEN_ERR_IO, -3, "read or write failed")               \
    X(SHEEN_ERR_PARSE, -4, "malformed input")                 \
    X(SHEEN_ERR_UNSUPPORTED, -5, "not supported")             \
    X(SHEEN_ERR_CANCELLED, -6, "cancelled by the caller")
// clang-format on

#define X(name, value, text) name = value,
typedef enum SheenStatus { SHEEN_STATUS_MAP(X) } SheenStatus;
#undef X

/** Functions whose status must not be dropped. */
#define SHEEN_NODISCARD __attribute__((warn_unused_result))

/** @return the text of `status`, a literal; "unknown status" for a value outside the table. */
const char *sheen_status_text(SheenStatus status);

#endif
