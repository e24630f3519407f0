// SPDX-License-Identifier: Apache-2.0
// The options of `sheen render`: their table, their values, and what the library gets of them.
#ifndef SHEEN_CLI_RENDER_OPTIONS_H
#define SHEEN_CLI_RENDER_OPTIONS_H

#include "cli.h"
#include "progress.h"

#include "render/render.h"

#include <jansson.h>

/** What the options of the table fill. Numbers that are 0 come from the scene or the machine. */
typedef struct RenderValues {
    TextList outputs, defines;
    int integrator; // SheenIntegrator
    PictureSize size;
    int filter;         // SheenFilterKind; SHEEN_FILTER_UNSET for the camera's
    const char *camera; // name or index, NULL for the first
    uint32_t spp, light_samples, bounces;
    double time_limit;
    double noise;
    double accuracy;
    uint32_t gather_rays;
    int gradients, basis, secondary; // SheenGradient, SheenBasisChoice, SheenSecondary
    uint32_t order;
    double brdf_error;
    int neighbor_clamping, gradient_clamping;
    unsigned aovs; // bit 1 << SheenAov
    double exposure;
    uint32_t threads, seed;
    const char *stats;
    int progress; // ProgressMode
    bool quiet, verbose, strict;
} RenderValues;

extern const Option render_options[];

/** The values without any option, from the library's own defaults. */
RenderValues render_values_default(void);

/** @return true when all of --define are NAME=VALUE, or false after a message about the command line. */
bool defines_check(const Command *command, const TextList *defines);

/**
 * Checks what one option alone cannot show: outputs and their endings, and options that go with one integrator only.
 * @return true, or false after a message about the command line
 */
bool render_values_check(const RenderValues *values);

/** The library's settings, for a scene's camera; fills camera and filter, and size and spp where they are 0, of
 * *values. */
SheenRenderSettings render_values_settings(RenderValues *values, const SheenCamera *camera, uint32_t camera_index);

/** @return the options that the picture depends on as a JSON object, a new reference; NULL when out of memory. */
json_t *render_values_json(const RenderValues *values);

/** @return the name of the integrator. */
const char *render_integrator_name(const RenderValues *values);

#endif
