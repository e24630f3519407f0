// SPDX-License-Identifier: Apache-2.0
// The options of the commands that render: their table, their values, and what the library gets of them.
#ifndef SHEEN_CLI_RENDER_OPTIONS_H
#define SHEEN_CLI_RENDER_OPTIONS_H

#include "cache_options.h"
#include "lobe_options.h"
#include "progress.h"
#include "scene_options.h"

#include "render/render.h"

/** What the tables of a command that renders fill. Numbers that are 0 come from the scene or the machine. */
typedef struct RenderValues {
    TextList outputs; // pictures, patterns of pictures
    SceneValues scene;
    LobeValues lobes;
    CacheValues cache;
    int integrator; // SheenIntegrator
    PictureSize size;
    int filter;         // SheenFilterKind; SHEEN_FILTER_UNSET for the camera's
    const char *camera; // name or index, NULL for the first
    uint32_t spp, light_samples, bounces;
    double time_limit; // of `sheen render` alone
    double noise;
    int error_metric;
    double reach_min, reach_max;
    double accuracy;
    uint32_t gather_rays;
    int gradients, basis, secondary; // SheenGradient, SheenBasisChoice, SheenSecondary
    int neighbor_clamping, gradient_clamping, adaptive;
    double discernible;
    unsigned aovs; // bit 1 << SheenAov
    double exposure;
    uint32_t threads, seed;
    const char *stats;
    int progress; // ProgressMode
    bool quiet, verbose;
} RenderValues;

/** Of a RenderValues; those in `scene`, `lobes` and `cache` have tables of their own. */
extern const Option render_options[];

/** The tables of the options that all commands share that render, for a RenderValues at `base`. */
#define RENDER_TABLES(base)                                                                                            \
    {scene_options, (base) + offsetof(RenderValues, scene)}, {render_options, (base)},                                 \
    {                                                                                                                  \
        lobe_options, (base) + offsetof(RenderValues, lobes)                                                           \
    }

/** The values without any option, from the library's own defaults. */
RenderValues render_values_default(void);

/** Checks what one option alone cannot show. @return true, or false after a message about the command line */
bool render_values_check(const Command *command, const RenderValues *values);

/** The library's settings, for a scene's camera; fills camera and filter, and size and spp where they are 0, of
 * *values. */
SheenRenderSettings render_values_settings(RenderValues *values, const SheenCamera *camera);

/** @return the name of the integrator. */
const char *render_integrator_name(const RenderValues *values);

#endif
