// SPDX-License-Identifier: Apache-2.0
// The page that `sheen compare --html` writes: one file that needs nothing else.
#ifndef SHEEN_CLI_COMPARE_PAGE_H
#define SHEEN_CLI_COMPARE_PAGE_H

#include "image/metric.h"

#include <jansson.h>
#include <stdbool.h>

typedef struct ComparePage ComparePage;

/** @param path, reference  borrowed as long as the page. @return NULL when out of memory */
ComparePage *compare_page_create(const char *path, const char *reference, SheenLog log);

/**
 * Offers a frame of an operand; of all the frames of one operand the page keeps that with the largest FLIP.
 * @param name  of the operand, borrowed as long as the page
 * Errors: SHEEN_ERR_NOMEM, reported.
 */
SHEEN_NODISCARD SheenStatus compare_page_offer(ComparePage *page, const char *name, long frame,
                                               const SheenImage *reference, const SheenImage *image,
                                               const SheenMetrics *figures);

/** Ends an operand. @param result  its JSON object, whose numbers the page shows */
void compare_page_finish(ComparePage *page, json_t *result);

/** Writes the page whole or not at all. @return true, or false after one line on stderr */
bool compare_page_write(ComparePage *page);

void compare_page_destroy(ComparePage **page);

#endif
