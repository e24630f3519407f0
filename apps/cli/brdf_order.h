// SPDX-License-Identifier: Apache-2.0
// How a scene's glossy materials are represented in harmonics, for `sheen info`: a picture and figures.
#ifndef SHEEN_CLI_BRDF_ORDER_H
#define SHEEN_CLI_BRDF_ORDER_H

#include "lobe_options.h"
#include "report.h"

#include "scene/scene.h"

#include <jansson.h>

/**
 * Adds "harmonics" to *info: for each material with a glossy lobe its name, the least and largest order, the mean
 * error, and the part of the outgoing directions for which it is cached. Draws the picture: a row for each material, at
 * most 64, with the disk of outgoing directions coloured by error and by order, and both along its middle.
 * @return the exit code, after one line for an error
 */
int brdf_order_report(const SheenScene *scene, const char *picture, const LobeValues *lobes, Report *report,
                      json_t *info);

#endif
