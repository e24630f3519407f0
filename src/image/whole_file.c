// SPDX-License-Identifier: Apache-2.0
#include "image/whole_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/** Reads to the end of the descriptor. @return 0 or an errno value; what was read is in *data in either case. */
static int read_all(int fd, size_t expected, uint8_t **data, size_t *size)
{
    size_t capacity = expected + 1; // one more, so that the end is seen without growing
    *data = malloc(capacity);
    if (!*data) return ENOMEM;
    for (;;) {
        if (*size == capacity) {
            if (capacity > SHEEN_FILE_MAX / 2) return EFBIG;
            uint8_t *grown = realloc(*data, 2 * capacity);
            if (!grown) return ENOMEM;
            *data = grown;
            capacity *= 2;
        }
        ssize_t got = read(fd, *data + *size, capacity - *size);
        if (got == 0) return 0;
        if (got > 0) *size += (size_t)got;
        if (got < 0 && errno != EINTR) return errno;
    }
}

SheenStatus sheen_file_read(const char *path, const SheenLog *log, uint8_t **data, size_t *size)
{
    *data = NULL;
    *size = 0;
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    if (fd < 0) return sheen_fail(log, SHEEN_ERR_IO, "%s: %s", path, strerror(errno));
    struct stat info;
    int error = fstat(fd, &info) == 0 ? 0 : errno;
    size_t expected = 4095;
    if (!error && S_ISREG(info.st_mode)) {
        if ((uint64_t)info.st_size > SHEEN_FILE_MAX) error = EFBIG;
        expected = (size_t)info.st_size;
    }
    if (!error) error = read_all(fd, expected, data, size);
    close(fd);
    if (!error) return SHEEN_OK;
    free(*data);
    *data = NULL;
    *size = 0;
    return sheen_fail(log, error == ENOMEM ? SHEEN_ERR_NOMEM : SHEEN_ERR_IO, "%s: %s", path, strerror(error));
}

/** Opens a new file beside `path`. Another thread may be writing the same picture, so a few names are tried. */
static int open_beside(const char *path, char *temporary, size_t capacity)
{
    for (int attempt = 0; attempt < 16; ++attempt) {
        int n = attempt == 0 ? snprintf(temporary, capacity, "%s.tmp%ld", path, (long)getpid())
                             : snprintf(temporary, capacity, "%s.tmp%ld-%d", path, (long)getpid(), attempt);
        if (n < 0 || (size_t)n >= capacity) {
            errno = ENAMETOOLONG;
            return -1;
        }
        int fd = open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0 || errno != EEXIST) return fd;
    }
    return -1;
}

static bool write_all(int fd, const uint8_t *data, size_t size)
{
    while (size > 0) {
        ssize_t n = write(fd, data, size);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        data += n;
        size -= (size_t)n;
    }
    return true;
}

SheenStatus sheen_file_write(const char *path, const void *data, size_t size, const SheenLog *log)
{
    size_t capacity = strlen(path) + 64;
    char *temporary = malloc(capacity);
    if (!temporary) return sheen_fail(log, SHEEN_ERR_NOMEM, "%s: out of memory", path);
    int fd = open_beside(path, temporary, capacity);
    if (fd < 0) {
        int error = errno;
        free(temporary);
        return sheen_fail(log, SHEEN_ERR_IO, "%s: %s", path, strerror(error));
    }
    int error = 0;
    // EINVAL and EROFS: a file system that cannot flush; the data are then as safe as they get.
    if (!write_all(fd, data, size) || (fsync(fd) != 0 && errno != EINVAL && errno != EROFS)) error = errno;
    if (close(fd) != 0 && !error) error = errno; // network file systems report a full disk here
    if (!error && rename(temporary, path) != 0) error = errno;
    if (error) unlink(temporary);
    free(temporary);
    return error ? sheen_fail(log, SHEEN_ERR_IO, "%s: %s", path, strerror(error)) : SHEEN_OK;
}
