// SPDX-License-Identifier: Apache-2.0
#include "io/file.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

static SheenStatus read_open_file(FILE *f, const char *path, const SheenLog *log, SheenFile *out)
{
    struct stat info;
    if (fstat(fileno(f), &info)) return sheen_fail(log, SHEEN_ERR_IO, "%s: %s", path, strerror(errno));
    if (!S_ISREG(info.st_mode)) return sheen_fail(log, SHEEN_ERR_IO, "%s: is not a regular file", path);
    if (info.st_size < 0 || (uintmax_t)info.st_size >= SIZE_MAX)
        return sheen_fail(log, SHEEN_ERR_NOMEM, "%s: is too large", path);
    size_t size = (size_t)info.st_size;
    char *data = malloc(size + 1);
    if (!data) return sheen_fail(log, SHEEN_ERR_NOMEM, "%s: out of memory for its %zu bytes", path, size);
    if (fread(data, 1, size, f) != size) {
        free(data);
        return sheen_fail(log, SHEEN_ERR_IO, "%s: cannot read all of its %zu bytes", path, size);
    }
    data[size] = '\0';
    *out = (SheenFile){data, size};
    return SHEEN_OK;
}

SheenStatus sheen_file_read(const char *path, const SheenLog *log, SheenFile *out)
{
    *out = (SheenFile){NULL, 0};
    FILE *f = fopen(path, "rb");
    if (!f) return sheen_fail(log, SHEEN_ERR_IO, "%s: %s", path, strerror(errno));
    SheenStatus s = read_open_file(f, path, log, out);
    fclose(f);
    return s;
}

void sheen_file_free(SheenFile *file)
{
    free(file->data);
    *file = (SheenFile){NULL, 0};
}

bool sheen_file_readable(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode) && access(path, R_OK) == 0;
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
