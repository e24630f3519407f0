// SPDX-License-Identifier: Apache-2.0
// The page that `sheen compare --html` writes: one file that needs nothing else.
#ifndef SHEEN_CLI_COMPARE_PAGE_H
#define SHEEN_CLI_COMPARE_PAGE_H

#include "sequence.h"

#include "image/metric.h"

#include <jansson.h>
#include <stdbool.h>

typedef struct ComparePage ComparePage;

/** @param path, reference  borrowed as long as the page. @return NULL when out of memory */
ComparePage *compare_page_create(const char *path, const char *reference, SheenLog log);

/**
 * Offers a frame, whose number is below 0 where it has none; of all that are offered before the next finish the page
 * keeps that with the largest FLIP.
 * @param name            of the operand, borrowed as long as the page
 * @param reference_path  the reference's file; both files' layers are read here
 * Errors: those of reading the layers, SHEEN_ERR_NOMEM; reported.
 */
SHEEN_NODISCARD SheenStatus compare_page_offer(ComparePage *page, const char *name, const SequenceFrame *frame,
                                               const char *reference_path, const SheenImage *reference,
                                               const SheenImage *image, const SheenMetrics *figures);

/**
 * Ends an operand, or one picture of it.
 * @param picture  its name when the operand has several to choose from, copied; NULL for an operand as a whole
 * @param result   its JSON object, whose numbers the page shows
 */
void compare_page_finish(ComparePage *page, const char *picture, json_t *result);

/** Writes the page whole or not at all. @return true, or false after one line on stderr */
bool compare_page_write(ComparePage *page);

void compare_page_destroy(ComparePage **page);

#endif
