// SPDX-License-Identifier: Apache-2.0
#include "json_text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

json_t *json_text(const char *text)
{
    json_t *json = json_string(text);
    if (json) return json;
    char *copy = strdup(text);
    if (!copy) return NULL;
    for (char *c = copy; *c; ++c)
        if ((unsigned char)*c >= 0x80) *c = '?';
    json = json_string(copy);
    free(copy);
    return json;
}

json_t *json_hash(uint64_t hash)
{
    char text[17];
    snprintf(text, sizeof text, "%016llx", (unsigned long long)hash);
    return json_string(text);
}

json_t *json_bounds(const Bounds *b)
{
    if (bounds_is_empty(b) || !v3_finite(b->lo) || !v3_finite(b->hi)) return json_null();
    return json_pack("[[f, f, f], [f, f, f]]", (double)b->lo.x, (double)b->lo.y, (double)b->lo.z, (double)b->hi.x,
                     (double)b->hi.y, (double)b->hi.z);
}

char *json_value_text(const json_t *value)
{
    return json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(9));
}
