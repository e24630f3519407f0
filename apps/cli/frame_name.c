// SPDX-License-Identifier: Apache-2.0
#include "frame_name.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { max_digits = 9 }; // of FRAME_MAX; a long holds them everywhere

const char *path_last_part(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

bool frame_name_is_pattern(const char *path)
{
    const char *name = path_last_part(path);
    size_t before = strcspn(name, "#"), hashes = strspn(name + before, "#");
    return hashes > 0 && hashes <= max_digits && !strchr(name + before + hashes, '#');
}

bool frame_name_match(const char *pattern, const char *name, long *frame)
{
    size_t before = strcspn(pattern, "#"), digits = 0, hashes = strspn(pattern + before, "#");
    if (strncmp(pattern, name, before) != 0) return false;
    const char *first = name + before;
    while (isdigit((unsigned char)first[digits])) ++digits;
    // 0001 to 9999 and 10000, but not 00001.
    if (digits < hashes || digits > max_digits || (digits > hashes && first[0] == '0')) return false;
    *frame = strtol(first, NULL, 10);
    return strcmp(first + digits, pattern + before + hashes) == 0;
}

char *frame_name_make(const char *pattern, long frame)
{
    const char *name = path_last_part(pattern);
    size_t before = (size_t)(name - pattern) + strcspn(name, "#"), hashes = strspn(pattern + before, "#");
    size_t size = strlen(pattern) + max_digits + 2;
    char *path = malloc(size);
    if (path) snprintf(path, size, "%.*s%0*ld%s", (int)before, pattern, (int)hashes, frame, pattern + before + hashes);
    return path;
}
