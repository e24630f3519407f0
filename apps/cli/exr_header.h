// SPDX-License-Identifier: Apache-2.0
// What the header of an EXR file says beside its pixels: names of channels and attributes that are text.
#ifndef SHEEN_CLI_EXR_HEADER_H
#define SHEEN_CLI_EXR_HEADER_H

#include <jansson.h>

/**
 * Reads the headers of an EXR file. Where it has several parts, names get that of their part before them and a dot.
 * @param channels    array; gains the channels' names in the order of the file
 * @param attributes  object; gains the text attributes
 * A file that is no EXR or is cut off gains what could be read until then: the pixels' reader gives the error.
 */
void exr_header_read(const char *path, json_t *channels, json_t *attributes);

#endif
