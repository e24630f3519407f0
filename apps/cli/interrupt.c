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

// While nothing is made yet nothing has to be put away.
static void on_early_signal(int number)
{
    (void)number;
    static const char line[] = "sheen: interrupted; nothing was written\n";
    ssize_t written = write(STDERR_FILENO, line, sizeof line - 1);
    (void)written; // there is nobody to tell
    _exit(CLI_INTERRUPTED);
}

static void catch_with(void (*handler)(int))
{
    struct sigaction action = {.sa_handler = handler, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

void interrupt_end_early(void)
{
    catch_with(on_early_signal);
}

const atomic_bool *interrupt_catch(void)
{
    catch_with(on_signal);
    return &interrupted;
}
