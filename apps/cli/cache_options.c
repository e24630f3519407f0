// SPDX-License-Identifier: Apache-2.0
#include "cache_options.h"

#include "io/file_path.h"

#include <string.h>

const Option cache_options[] = {
    {.kind = OPTION_TEXTS,
     .name = "cache-in",
     .argument = "FILE",
     .meaning = "Take the records of a cache file that --cache-out wrote, and make only those that are missing. May be "
                "given several times: the records add up. A file of another scene, or made with other options that "
                "records depend on, is read with a warning.",
     .standard = "none",
     .example = "--cache-in box.shc",
     .offset = offsetof(CacheValues, in)},
    {.kind = OPTION_TEXT,
     .name = "cache-out",
     .argument = "FILE",
     .meaning = "Write all records, those of --cache-in and the new ones, to a cache file, before the picture is "
                "shaded. Ctrl-C during the work writes those that are there. The file, whose name ends in .shc, "
                "appears whole or not at "
                "all.",
     .standard = "none",
     .example = "--cache-out box.shc",
     .offset = offsetof(CacheValues, out)},
    {0},
};

static bool refuse(const Command *command, const char *option, const char *why)
{
    cli_usage_error(command, "%s: %s", option, why);
    return false;
}

bool cache_values_check(const Command *command, const CacheValues *v, bool has_cache)
{
    static const char no_cache[] = "--integrator path has no cache";
    if (v->in.n > 0 && !has_cache) return refuse(command, "--cache-in", no_cache);
    if (v->out && !has_cache) return refuse(command, "--cache-out", no_cache);
    if (v->out && !sheen_path_has_ending(v->out, ".shc")) {
        // So that neither a picture nor a scene is replaced by mistake.
        cli_usage_error(command, "--cache-out: '%s' does not end in .shc", v->out);
        return false;
    }
    if (v->records_only && !v->out) return refuse(command, "--records-only", "goes with --cache-out only");
    for (size_t i = 0; i < v->in.n; ++i)
        for (size_t k = 0; k < i; ++k) {
            if (strcmp(v->in.items[i], v->in.items[k]) != 0) continue;
            cli_usage_error(command, "--cache-in: '%s' is given twice", v->in.items[i]);
            return false;
        }
    return true;
}
