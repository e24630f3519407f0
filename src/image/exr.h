// SPDX-License-Identifier: Apache-2.0
// What reading and writing of OpenEXR share. Inner header.
#ifndef SHEEN_IMAGE_EXR_H
#define SHEEN_IMAGE_EXR_H

#include "image/format.h"

#include <openexr.h>

/** The user data of an EXR context: the stream, and the first message of the library. */
typedef struct ExrStream {
    const uint8_t *data; // when reading
    size_t size;
    ImageBuffer *buffer; // when writing
    bool no_memory;      // the buffer could not grow, which the library takes for a failed write
    char message[200];
} ExrStream;

/** A context initializer with our limits, allocator and messages; `stream` must live as long as the context. */
exr_context_initializer_t sheen_exr_initializer(ExrStream *stream);

/** Reports a failure of the library as one line and returns the status that stands for it. */
SheenStatus sheen_exr_fail(const ExrStream *stream, exr_result_t result, const char *name, const SheenLog *log);

SHEEN_NODISCARD SheenStatus sheen_exr_decode(const ImageSource *source, SheenImage *out);
SHEEN_NODISCARD SheenStatus sheen_exr_encode(const ImageTarget *target, ImageBuffer *out);

#endif
