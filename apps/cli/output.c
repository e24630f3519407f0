// SPDX-License-Identifier: Apache-2.0
#include "output.h"

#include "cli.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/** @return the folder of a path, from malloc; NULL when out of memory. */
static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (!slash) return strdup(".");
    return slash == path ? strdup("/") : strndup(path, (size_t)(slash - path));
}

static bool is_device(const char *path)
{
    struct stat s;
    return stat(path, &s) == 0 && !S_ISREG(s.st_mode) && !S_ISDIR(s.st_mode);
}

static bool folder_check(const char *path, const char *folder)
{
    struct stat s;
    if (stat(folder, &s) != 0)
        cli_error("%s: the folder '%s' is not there: %s", path, folder, strerror(errno));
    else if (!S_ISDIR(s.st_mode))
        cli_error("%s: '%s' is not a folder", path, folder);
    else if (access(folder, W_OK | X_OK) != 0)
        cli_error("%s: cannot write into '%s': %s", path, folder, strerror(errno));
    else
        return true;
    return false;
}

bool output_check(const char *path, bool to_device)
{
    struct stat s;
    bool there = stat(path, &s) == 0;
    if (there && S_ISDIR(s.st_mode)) {
        cli_error("%s: is a folder", path);
        return false;
    }
    if (there && !S_ISREG(s.st_mode)) {
        if (to_device) return true;
        cli_error("%s: is not a regular file", path);
        return false;
    }
    char *folder = folder_of(path);
    if (!folder) {
        cli_error("%s: out of memory", path);
        return false;
    }
    bool ok = folder_check(path, folder);
    free(folder);
    return ok;
}

/** @return true, or false with the reason in errno. */
static bool write_stream(FILE *file, const char *text)
{
    bool ok = fprintf(file, "%s\n", text) >= 0 && fflush(file) == 0;
    int error = errno;
    if (fclose(file) != 0 && ok) return false;
    errno = error;
    return ok;
}

bool output_write_text(const char *path, const char *text)
{
    if (strcmp(path, "-") == 0) {
        puts(text);
        return cli_finish_stdout() == CLI_DONE;
    }
    bool direct = is_device(path);
    size_t size = strlen(path) + 32;
    char *beside = malloc(size);
    if (!beside) {
        cli_error("%s: out of memory", path);
        return false;
    }
    snprintf(beside, size, direct ? "%s" : "%s.%ld.part", path, (long)getpid());
    FILE *file = fopen(beside, "w");
    bool ok = file && write_stream(file, text) && (direct || rename(beside, path) == 0);
    if (!ok) {
        cli_error("%s: %s", path, strerror(errno));
        if (!direct) unlink(beside);
    }
    free(beside);
    return ok;
}
