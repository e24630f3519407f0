// SPDX-License-Identifier: Apache-2.0
// The sRGB transfer curve. Source: iec61966-2-1.
#include "image/image.h"

float sheen_srgb_encode(float linear)
{
    float x = linear > 0.0f ? minf(linear, 1.0f) : 0.0f; // NaN becomes 0
    return x <= 0.0031308f ? 12.92f * x : 1.055f * powf(x, 1.0f / 2.4f) - 0.055f;
}

float sheen_srgb_decode(float encoded)
{
    float x = encoded > 0.0f ? minf(encoded, 1.0f) : 0.0f;
    return x <= 0.04045f ? x / 12.92f : powf((x + 0.055f) / 1.055f, 2.4f);
}
