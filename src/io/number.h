// SPDX-License-Identifier: Apache-2.0
// Decimal numbers in text, read fast and the same under every locale.
#ifndef SHEEN_IO_NUMBER_H
#define SHEEN_IO_NUMBER_H

#include <stdbool.h>
#include <stdint.h>

/**
 * Reads a decimal number ("-1.5e3", ".5", "7.", "nan", "-inf") at *p.
 * @param p    moved behind the number on success, left where it is otherwise; no space is skipped
 * @param end  end of the text
 * @return false when there is no number. The value is correct to a relative 1e-18, rounded once to double.
 */
bool sheen_number_parse(const char **p, const char *end, double *out);

/** The same for an integer with an optional sign; false also when it does not fit. */
bool sheen_integer_parse(const char **p, const char *end, int64_t *out);

#endif
