// SPDX-License-Identifier: Apache-2.0
// The parts of the page of `sheen compare --html` that do not depend on the pictures: lines, NULL at the end.
#ifndef SHEEN_CLI_COMPARE_SCRIPT_H
#define SHEEN_CLI_COMPARE_SCRIPT_H

extern const char *const compare_style[], *const compare_controls[], *const compare_script[];

#endif
