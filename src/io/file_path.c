// SPDX-License-Identifier: Apache-2.0
#include "io/file_path.h"

#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

bool sheen_path_readable(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode) && access(path, R_OK) == 0;
}

bool sheen_path_is_folder(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

bool sheen_path_has_ending(const char *path, const char *ending)
{
    size_t n = strlen(path), m = strlen(ending);
    return n >= m && strcasecmp(path + n - m, ending) == 0;
}

char *sheen_path_beside(SheenArena *arena, const char *beside, const char *name)
{
    const char *slash = strrchr(beside, '/');
    if (name[0] == '/' || !slash) return sheen_arena_strdup(arena, name);
    size_t folder = (size_t)(slash - beside) + 1, n = strlen(name) + 1;
    char *path = sheen_arena_alloc(arena, folder + n, 1);
    if (!path) return NULL;
    memcpy(path, beside, folder);
    memcpy(path + folder, name, n);
    return path;
}
