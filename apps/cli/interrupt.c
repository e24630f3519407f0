// SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include "cli.h"

#include <signal.h>
#include <unistd.h>

// The one writable variable of the program: a signal handler can reach nothing else.
static atomic_bool interrupted;

static void on_signal(int number)
{
    (void)number;
    if (atomic_exchange(&interrupted, true)) _exit(CLI_INTERRUPTED);
}

const atomic_bool *interrupt_catch(void)
{
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    return &interrupted;
}
