// SPDX-License-Identifier: Apache-2.0
// Any bytes as a picture: refused with exactly one line, or decoded within what the bytes can hold.
// Seeds of all formats: fuzz/corpus/image. A good run: fuzz_image -max_len=4096 -timeout=10 DIR fuzz/corpus/image
#include "image/image.h"

#include <stdlib.h>

static void count_error(void *user, SheenLogLevel level, const char *text)
{
    (void)text;
    *(int *)user += level == SHEEN_LOG_ERROR;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size > 8192) return 0; // a reader may allocate 16384 pixels a byte
    int errors = 0;
    SheenLog log = {count_error, &errors};
    SheenImage image;
    SheenStatus status = sheen_image_decode(data, size, "fuzz", &log, &image);
    if (errors != (status ? 1 : 0)) abort();
    if ((image.pixels == NULL) != (status != SHEEN_OK)) abort();
    sheen_image_free(&image);
    SheenImageLayers layers;
    errors = 0;
    status = sheen_image_decode_layers(data, size, "fuzz", &log, &layers);
    if (errors != (status ? 1 : 0) || (status && layers.n > 0)) abort();
    sheen_image_layers_free(&layers);
    return 0;
}
