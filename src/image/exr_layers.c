// SPDX-License-Identifier: Apache-2.0
#include "image/exr_layers.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/** @return what follows the last dot of a channel's name; the name where it has none. */
static const char *suffix(const char *channel)
{
    const char *dot = strrchr(channel, '.');
    return dot ? dot + 1 : channel;
}

/** Bytes of the layer's name in a channel's. A channel without a layer is one by itself. */
static size_t name_size(const char *channel)
{
    const char *dot = strrchr(channel, '.');
    return dot ? (size_t)(dot - channel) : strlen(channel);
}

static bool is_of(const SheenImageLayer *layer, const char *channel)
{
    size_t n = name_size(channel);
    return strchr(channel, '.') && strncmp(layer->name, channel, n) == 0 && layer->name[n] == '\0' &&
           strchr(layer->channels[0], '.');
}

static bool is_color(const char *channel, const char *const color[3])
{
    for (int c = 0; c < 3; ++c)
        if (color[c] && strcmp(color[c], channel) == 0) return true;
    return false;
}

/** Adds a channel to its layer, a new one where there is none. A layer has no more than three. @return false: no memory
 */
static bool add_channel(const char *channel, SheenImageLayers *out)
{
    SheenImageLayer *layer = NULL;
    for (size_t i = 0; i < out->n && !layer; ++i)
        if (is_of(&out->layers[i], channel)) layer = &out->layers[i];
    if (layer && layer->n_channels == 3) return true;
    char *name = strdup(channel);
    if (!name) return false;
    if (!layer) {
        SheenImageLayer *grown = realloc(out->layers, (out->n + 1) * sizeof *grown);
        if (grown) out->layers = grown;
        char *of_layer = grown ? strndup(channel, name_size(channel)) : NULL;
        if (!of_layer) {
            free(name);
            return false;
        }
        layer = &grown[out->n++];
        *layer = (SheenImageLayer){.name = of_layer};
    }
    layer->channels[layer->n_channels++] = name;
    return true;
}

/** Files list channels by the alphabet: a colour comes as B, G, R. */
static void order_color(SheenImageLayer *layer)
{
    static const char *const letters[] = {"R", "G", "B"};
    char *ordered[3] = {NULL, NULL, NULL};
    for (unsigned i = 0; i < layer->n_channels; ++i)
        for (int c = 0; c < 3; ++c)
            if (strcasecmp(suffix(layer->channels[i]), letters[c]) == 0) ordered[c] = layer->channels[i];
    layer->color = ordered[0] && ordered[1] && ordered[2];
    if (layer->color) memcpy(layer->channels, ordered, sizeof ordered);
}

static SheenStatus allocate(const ImageSource *source, SheenImageLayers *out)
{
    uint64_t pixels = (uint64_t)out->width * out->height, channels = 0;
    for (size_t i = 0; i < out->n; ++i) channels += out->layers[i].n_channels;
    if (channels > 3 * SHEEN_IMAGE_MAX_PIXELS / pixels)
        return sheen_fail(source->log, SHEEN_ERR_UNSUPPORTED,
                          "%s: %llu channels of %u x %u pixels are more than are allowed", source->name,
                          (unsigned long long)channels, out->width, out->height);
    for (size_t i = 0; i < out->n; ++i) {
        SheenImageLayer *layer = &out->layers[i];
        layer->data = calloc((size_t)pixels * layer->n_channels, sizeof *layer->data);
        if (!layer->data) return sheen_image_no_memory(source->name, source->log);
    }
    return SHEEN_OK;
}

/** @return where a channel's values go. */
static ExrPlane plane_of(const SheenImageLayers *layers, const char *channel)
{
    for (size_t i = 0; i < layers->n; ++i) {
        const SheenImageLayer *layer = &layers->layers[i];
        for (unsigned c = 0; c < layer->n_channels; ++c)
            if (strcmp(layer->channels[c], channel) == 0)
                return (ExrPlane){channel, layer->data + c, layer->n_channels};
    }
    return (ExrPlane){channel, NULL, 0};
}

SheenStatus sheen_exr_list_layers(const ImageSource *source, int n, const char *const color[3], SheenImageLayers *out,
                                  ExrPlane planes[])
{
    if (n > SHEEN_EXR_CHANNELS_MAX)
        return sheen_fail(source->log, SHEEN_ERR_UNSUPPORTED, "%s: %d channels are more than are allowed (%d)",
                          source->name, n, SHEEN_EXR_CHANNELS_MAX);
    for (int i = 0; i < n; ++i)
        if (!is_color(planes[i].channel, color) && !add_channel(planes[i].channel, out))
            return sheen_image_no_memory(source->name, source->log);
    for (size_t i = 0; i < out->n; ++i) order_color(&out->layers[i]);
    SheenStatus status = allocate(source, out);
    for (int i = 0; !status && i < n; ++i) planes[i] = plane_of(out, planes[i].channel);
    return status;
}
