// SPDX-License-Identifier: Apache-2.0
#include "sequence.h"

#include "cli.h"
#include "frame_name.h"

#include "image/image.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { max_digits = 9 }; // of a frame's number, see FRAME_MAX

static bool is_folder(const char *path)
{
    struct stat s;
    return stat(path, &s) == 0 && S_ISDIR(s.st_mode);
}

bool sequence_is(const char *path)
{
    struct stat s;
    if (stat(path, &s) == 0) return S_ISDIR(s.st_mode);
    return strchr(path_last_part(path), '#') != NULL;
}

/** Takes the last run of digits before the ending. @return false when there is none. */
static bool last_number(const char *name, long *number)
{
    const char *end = strrchr(name, '.');
    if (!end) end = name + strlen(name);
    while (end > name && !isdigit((unsigned char)end[-1])) --end;
    const char *first = end;
    while (first > name && isdigit((unsigned char)first[-1]) && end - first < max_digits) --first;
    *number = strtol(first, NULL, 10);
    return first < end;
}

static bool add_frame(Sequence *s, const char *folder, size_t folder_size, const char *file, long number)
{
    SequenceFrame *grown = realloc(s->frames, (s->n + 1) * sizeof *grown);
    if (!grown) return false;
    s->frames = grown;
    size_t size = folder_size + strlen(file) + 1;
    const char *dot = strrchr(file, '.');
    char *path = malloc(size), *name = dot ? strndup(file, (size_t)(dot - file)) : strdup(file);
    if (!path || !name) {
        free(path);
        free(name);
        return false;
    }
    memcpy(path, folder, folder_size);
    memcpy(path + folder_size, file, size - folder_size);
    s->frames[s->n++] = (SequenceFrame){path, name, number};
    return true;
}

int sequence_compare(const SequenceFrame *a, const SequenceFrame *b, bool numbered)
{
    return numbered ? (a->number > b->number) - (a->number < b->number) : strcmp(a->name, b->name);
}

static int by_name(const void *a, const void *b)
{
    int order = sequence_compare(a, b, false);
    return order ? order : strcmp(((const SequenceFrame *)a)->path, ((const SequenceFrame *)b)->path);
}

static int by_number(const void *a, const void *b)
{
    int order = sequence_compare(a, b, true);
    return order ? order : by_name(a, b);
}

/** Collects the files. @param pattern  NULL takes all pictures */
static bool collect(const char *path, const char *folder, size_t folder_size, const char *pattern, Sequence *out)
{
    char *name = folder_size ? strndup(folder, folder_size) : strdup(".");
    DIR *dir = name ? opendir(name) : NULL;
    free(name);
    if (!dir) {
        cli_error("%s: %s", path, strerror(errno));
        return false;
    }
    bool ok = true;
    for (struct dirent *e; ok && (e = readdir(dir));) {
        long number = 0;
        if (pattern ? !frame_name_match(pattern, e->d_name, &number)
                    : e->d_name[0] == '.' || !sheen_image_readable_format(e->d_name))
            continue;
        if (!pattern && !last_number(e->d_name, &number)) out->numbered = false;
        ok = add_frame(out, folder, folder_size, e->d_name, number);
    }
    closedir(dir);
    if (!ok) cli_error("%s: out of memory", path);
    return ok;
}

/** Sorts; no two may be alike. */
static bool sort(const char *path, Sequence *s)
{
    qsort(s->frames, s->n, sizeof *s->frames, s->numbered ? by_number : by_name);
    for (size_t i = 1; i < s->n; ++i) {
        const SequenceFrame *a = &s->frames[i - 1], *b = &s->frames[i];
        if (sequence_compare(a, b, s->numbered) != 0) continue;
        if (s->numbered)
            cli_error("%s: both '%s' and '%s' are frame %ld", path, path_last_part(a->path), path_last_part(b->path),
                      b->number);
        else
            cli_error("%s: both '%s' and '%s' are the picture '%s'", path, path_last_part(a->path),
                      path_last_part(b->path), b->name);
        return false;
    }
    return true;
}

bool sequence_use_names(const char *path, Sequence *sequence)
{
    if (!sequence->numbered) return true;
    sequence->numbered = false;
    return sort(path, sequence);
}

bool sequence_list(const char *path, Sequence *out)
{
    *out = (Sequence){.numbered = true};
    bool ok;
    if (is_folder(path)) {
        size_t n = strlen(path);
        char *folder = malloc(n + 2);
        if (!folder) {
            cli_error("%s: out of memory", path);
            return false;
        }
        memcpy(folder, path, n + 1);
        if (folder[n - 1] != '/') folder[n++] = '/';
        ok = collect(path, folder, n, NULL, out);
        free(folder);
    } else {
        const char *pattern = path_last_part(path);
        ok = collect(path, path, (size_t)(pattern - path), pattern, out);
    }
    if (!ok) return false;
    if (out->n == 0) {
        cli_error("%s: there are no pictures", path);
        return false;
    }
    return sort(path, out);
}

void sequence_free(Sequence *sequence)
{
    for (size_t i = 0; i < sequence->n; ++i) {
        free(sequence->frames[i].path);
        free(sequence->frames[i].name);
    }
    free(sequence->frames);
    *sequence = (Sequence){0};
}
