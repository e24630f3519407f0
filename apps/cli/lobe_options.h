// SPDX-License-Identifier: Apache-2.0
// The options that tell which glossy lobes harmonics represent.
#ifndef SHEEN_CLI_LOBE_OPTIONS_H
#define SHEEN_CLI_LOBE_OPTIONS_H

#include "cli.h"

typedef struct LobeValues {
    uint32_t order;    // largest of the harmonics
    double brdf_error; // relative energy
} LobeValues;

/** Of a LobeValues. */
extern const Option lobe_options[];

/** The values without any option, from the library's own defaults. */
LobeValues lobe_values_default(void);

#endif
