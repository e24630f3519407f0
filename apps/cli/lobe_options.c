// SPDX-License-Identifier: Apache-2.0
#include "lobe_options.h"

#include "basis/rotation.h"
#include "integrator/work.h"

const Option lobe_options[] = {
    {.kind = OPTION_COUNT,
     .name = "order",
     .argument = "N",
     .meaning = "Of radiance records and glossy lobes: the largest order of the harmonics, of N * N coefficients.",
     .standard = "10",
     .example = "--order 6",
     .recorded = true,
     .of_records = true,
     .min = 1,
     .max = SHEEN_TILT_ORDER_MAX,
     .offset = offsetof(LobeValues, order)},
    {.kind = OPTION_NUMBER,
     .name = "brdf-error",
     .argument = "E",
     .meaning = "The largest share of a glossy lobe's energy that harmonics may miss. Where they miss more, light is "
                "sampled; where they miss more than half of that, both share the lobe.",
     .standard = "0.05",
     .example = "--brdf-error 0.02",
     .recorded = true,
     .of_records = true,
     .min = 0.001,
     .max = 0.5,
     .offset = offsetof(LobeValues, brdf_error)},
    {0},
};

LobeValues lobe_values_default(void)
{
    SheenOptions o = sheen_options_default();
    return (LobeValues){o.order, cli_decimal(o.brdf_error)};
}
