// SPDX-License-Identifier: Apache-2.0
// Ctrl-C: once asks the work to stop, twice stops at once.
#ifndef SHEEN_CLI_INTERRUPT_H
#define SHEEN_CLI_INTERRUPT_H

#include <stdatomic.h>

/** SIGINT and SIGTERM end the process at once from now on, with their line and exit code: while the scene is loaded. */
void interrupt_end_early(void);

/** Catches SIGINT and SIGTERM from now on. @return the flag that the first one sets, of the whole process */
const atomic_bool *interrupt_catch(void);

#endif
