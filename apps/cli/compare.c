// SPDX-License-Identifier: Apache-2.0
// `sheen compare`: error figures of pictures, of folders of pictures, or frame by frame of animations, as JSON.
#include "cli.h"
#include "compare_page.h"
#include "json_text.h"
#include "output.h"
#include "report.h"
#include "sequence.h"

#include "image/metric.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct CompareValues {
    const char *html;
    bool strict;
} CompareValues;

static const Option compare_options[] = {
    {.kind = OPTION_TEXT,
     .name = "html",
     .argument = "FILE",
     .meaning = "Write one self-contained page to look at: the images side by side with a slider, the error map, the "
                "figures, an exposure control; of EXR files each layer. Of folders whose pictures have names it shows "
                "all, to choose from; of "
                "animations the frame with the largest FLIP.",
     .standard = "none",
     .example = "sheen compare --html errors.html reference.exr box.exr",
     .offset = offsetof(CompareValues, html)},
    {.kind = OPTION_FLAG,
     .name = "strict",
     .meaning = "Take warnings, such as about an EXR file without a main layer, for errors.",
     .example = "sheen compare --strict reference.exr box.exr",
     .offset = offsetof(CompareValues, strict)},
    {0},
};

/** What is compared with what, and where messages go. */
typedef struct Comparison {
    SheenLog log;
    const char *reference;    // as given
    const char *image;        // as given
    Sequence references, own; // one frame each for single pictures
    bool several;             // folders or patterns, and not single pictures
    ComparePage *page;        // NULL without --html
} Comparison;

/** A number as JSON; null for what JSON cannot say: infinity of equal pictures, NaN of nothing compared. */
static json_t *number(double x)
{
    return isfinite(x) ? json_real(x) : json_null();
}

static json_t *figures_json(const SheenMetrics *m)
{
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:I}", "mse", number(m->mse), "rmse", number(m->rmse),
                     "relmse", number(m->relmse), "mae", number(m->mae), "psnr", number(m->psnr), "flip",
                     number(m->flip), "ssim", number(m->ssim), "bias", number(m->bias), "nonfinite",
                     (json_int_t)m->nonfinite);
}

/** Figures of several pictures: means over them; bias and PSNR from the means, so that they are those of all pixels. */
typedef struct Totals {
    SheenMetrics sum; // of frames; peak: the largest
    double flicker;
    size_t n, n_flicker;
} Totals;

static void add_frame(Totals *t, const SheenMetrics *m)
{
    SheenMetrics *s = &t->sum;
    s->mse += m->mse;
    s->relmse += m->relmse;
    s->mae += m->mae;
    s->flip += m->flip;
    s->ssim += m->ssim;
    s->mean += m->mean;
    s->reference_mean += m->reference_mean;
    s->nonfinite += m->nonfinite;
    if (m->peak > s->peak) s->peak = m->peak;
    ++t->n;
}

static SheenMetrics mean_of_frames(const Totals *t)
{
    SheenMetrics m = t->sum;
    double n = (double)t->n;
    m.mse /= n;
    m.rmse = sqrt(m.mse);
    m.relmse /= n;
    m.mae /= n;
    m.flip /= n;
    m.ssim /= n;
    m.psnr = 10.0 * log10(m.peak * m.peak / m.mse);
    m.bias = m.mean == m.reference_mean ? 0.0 : m.mean / m.reference_mean - 1.0;
    return m;
}

static SheenStatus read_pair(const Comparison *c, size_t frame, SheenImage *reference, SheenImage *image)
{
    const char *reference_path = c->references.frames[frame].path, *path = c->own.frames[frame].path;
    SheenStatus status = sheen_image_read(reference_path, &c->log, reference);
    if (!status) status = sheen_image_read(path, &c->log, image);
    if (!status && (image->width != reference->width || image->height != reference->height))
        status = sheen_fail(&c->log, SHEEN_ERR_INVALID, "%s: %u x %u pixels, but the reference '%s' has %u x %u", path,
                            image->width, image->height, reference_path, reference->width, reference->height);
    return status;
}

/** Flicker between the frame before, at [0], and this one, at [1]. */
static SheenStatus add_flicker(const Comparison *c, size_t frame, const SheenImage reference[2],
                               const SheenImage image[2], Totals *t)
{
    if (image[0].width != image[1].width || image[0].height != image[1].height)
        return sheen_fail(&c->log, SHEEN_ERR_INVALID, "%s: another size than the frame before",
                          c->own.frames[frame].path);
    double flicker = sheen_metrics_flicker(reference, image);
    if (!isfinite(flicker)) return SHEEN_OK;
    t->flicker += flicker;
    ++t->n_flicker;
    return SHEEN_OK;
}

/** The object of one of several pictures: what tells it from the others, and its figures. */
static json_t *frame_json(const Comparison *c, const SequenceFrame *frame, const SheenMetrics *m)
{
    json_t *entry = c->own.numbered ? json_pack("{s:I}", "frame", (json_int_t)frame->number)
                                    : json_pack("{s:o}", "picture", json_text(frame->name));
    json_t *figures = figures_json(m);
    if (entry && figures) json_object_update(entry, figures);
    json_decref(figures);
    return entry;
}

/** Compares all frames, of which two are in memory at a time. @param frames  array that gains an object for each */
static SheenStatus compare_frames(const Comparison *c, Totals *t, json_t *frames)
{
    SheenImage reference[2] = {{0}, {0}}, image[2] = {{0}, {0}};
    SheenStatus status = SHEEN_OK;
    for (size_t i = 0; !status && i < c->own.n; ++i) {
        SheenMetrics m;
        status = read_pair(c, i, &reference[1], &image[1]);
        if (!status) status = sheen_metrics_compute(&reference[1], &image[1], &c->log, &m);
        const SequenceFrame *frame = &c->own.frames[i];
        if (!status && i > 0 && c->own.numbered) status = add_flicker(c, i, reference, image, t);
        if (!status && c->page)
            status = compare_page_offer(c->page, c->image, frame, c->references.frames[i].path, &reference[1],
                                        &image[1], &m);
        if (!status) {
            add_frame(t, &m);
            json_t *entry = frame_json(c, frame, &m);
            if (c->page && !c->own.numbered) compare_page_finish(c->page, frame->name, entry);
            json_array_append_new(frames, entry);
        }
        sheen_image_free(&reference[0]);
        sheen_image_free(&image[0]);
        reference[0] = reference[1];
        image[0] = image[1];
        reference[1] = image[1] = (SheenImage){0};
    }
    sheen_image_free(&reference[0]);
    sheen_image_free(&image[0]);
    return status;
}

/** @return the object of one image operand, NULL after a failure that was reported, with the status in *status. */
static json_t *compare_one(const Comparison *c, SheenStatus *status)
{
    Totals t = {0};
    json_t *frames = json_array();
    *status = compare_frames(c, &t, frames);
    json_t *result = NULL;
    if (!*status) {
        SheenMetrics m = mean_of_frames(&t);
        result = json_pack("{s:o}", "image", json_text(c->image));
        json_t *figures = figures_json(&m);
        if (result && figures) json_object_update(result, figures);
        json_decref(figures);
        if (result && c->several && c->own.numbered)
            json_object_set_new(result, "flicker", number(t.flicker / (double)t.n_flicker));
        if (result && c->several) json_object_set(result, c->own.numbered ? "frames" : "pictures", frames);
        if (result && c->page && c->own.numbered) compare_page_finish(c->page, NULL, result);
        if (!result) *status = sheen_fail(&c->log, SHEEN_ERR_NOMEM, "%s: out of memory", c->image);
    }
    json_decref(frames);
    return result;
}

static bool list(const char *path, bool several, Sequence *out)
{
    if (several) return sequence_list(path, out);
    *out = (Sequence){.frames = calloc(1, sizeof *out->frames), .numbered = true};
    char *copy = strdup(path);
    if (!out->frames || !copy) {
        free(copy);
        cli_error("%s: out of memory", path);
        return false;
    }
    out->frames[out->n++] = (SequenceFrame){.path = copy, .number = -1};
    return true;
}

/** Frames are matched by their numbers, other pictures by their names, and none may be left over. */
static bool match(Comparison *c)
{
    if (c->references.numbered != c->own.numbered &&
        (!sequence_use_names(c->reference, &c->references) || !sequence_use_names(c->image, &c->own)))
        return false;
    bool numbered = c->own.numbered;
    for (size_t i = 0; i < c->references.n || i < c->own.n; ++i) {
        const SequenceFrame *reference = i < c->references.n ? &c->references.frames[i] : NULL;
        const SequenceFrame *own = i < c->own.n ? &c->own.frames[i] : NULL;
        int order = !reference ? 1 : !own ? -1 : sequence_compare(reference, own, numbered);
        if (order == 0) continue;
        const char *where = order < 0 ? c->image : c->reference, *there = order < 0 ? c->reference : c->image;
        const SequenceFrame *missing = order < 0 ? reference : own;
        if (numbered)
            cli_error("%s: frame %ld is not there, but it is in '%s'", where, missing->number, there);
        else
            cli_error("%s: the picture '%s' is not there, but it is in '%s'", where, missing->name, there);
        return false;
    }
    return true;
}

static int print_json(json_t *results)
{
    json_t *shown = json_array_size(results) == 1 ? json_array_get(results, 0) : results;
    if (!shown || json_dumpf(shown, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) != 0)
        return cli_error("standard output: cannot write");
    putchar('\n');
    return cli_finish_stdout();
}

/** Compares each operand after the first with the first. */
static int compare_all(int argc, char **argv, Report *report, ComparePage *page)
{
    Comparison c = {.log = report_log(report), .reference = argv[1], .page = page};
    c.several = sequence_is(argv[1]);
    if (!list(argv[1], c.several, &c.references)) {
        sequence_free(&c.references);
        return CLI_WORLD;
    }
    json_t *results = json_array();
    int code = CLI_DONE;
    for (int i = 2; i < argc && code == CLI_DONE; ++i) {
        c.image = argv[i];
        SheenStatus status = SHEEN_OK;
        if (!list(argv[i], c.several, &c.own) || !match(&c)) {
            code = CLI_WORLD;
        } else {
            json_array_append_new(results, compare_one(&c, &status));
            code = report_exit_code(report, status, argv[i]);
        }
        sequence_free(&c.own);
    }
    sequence_free(&c.references);
    if (code == CLI_DONE && page && !compare_page_write(page)) code = CLI_WORLD;
    if (code == CLI_DONE) code = print_json(results);
    json_decref(results);
    return code;
}

static int run_compare(int argc, char **argv)
{
    CompareValues values = {0};
    int code;
    if (!cli_parse(&command_compare, &argc, argv, &values, &code)) return code;
    if (argc < 2) return cli_usage_error(&command_compare, "REFERENCE: the reference is missing");
    if (argc < 3) return cli_usage_error(&command_compare, "IMAGE: there is no image to compare with the reference");
    for (int i = 1; i < argc; ++i) { // that kinds differ says nothing when one is missing
        if (!sequence_is(argv[i]) && access(argv[i], F_OK) != 0) return cli_error("%s: %s", argv[i], strerror(errno));
    }
    for (int i = 2; i < argc; ++i) {
        if (sequence_is(argv[i]) != sequence_is(argv[1]))
            return cli_usage_error(&command_compare, "IMAGE: of '%s' and '%s' one is a picture and one is several",
                                   argv[i], argv[1]);
    }
    if (values.html && !output_check(values.html, false)) return CLI_WORLD;
    Report report = {.strict = values.strict};
    ComparePage *page = NULL;
    if (values.html && !(page = compare_page_create(values.html, argv[1], report_log(&report))))
        return cli_error("%s: out of memory", values.html);
    code = compare_all(argc, argv, &report, page);
    compare_page_destroy(&page);
    return code;
}

const Command command_compare = {
    .name = "compare",
    .operands = "REFERENCE IMAGE...",
    .summary = "error figures of pictures against a reference, as JSON",
    .description =
        "Prints an object for each image, an array of them for several: mse, rmse, relmse (the mean over pixels and "
        "channels of (x - r)^2 / (r^2 + 0.01)), mae, psnr (its peak is the largest value of the reference; null for "
        "equal pictures), flip (the mean of HDR-FLIP), ssim (of the luminance as sRGB), bias (mean(x) / mean(r) - 1) "
        "and nonfinite, the number of values that are NaN or infinite and left out.\n"
        "With folders or patterns such as dir/name.####.exr it compares frame by frame, matched by their numbers: the "
        "figures are means over the frames, followed by flicker, the mean of |(x' - x) - (r' - r)| / (r + 0.1) over "
        "pixels and consecutive frames, and frames, the figures of each. Folders in which a name has no number hold no "
        "animation: their pictures are matched by their names without the ending, and pictures has the figures of "
        "each, "
        "without flicker.\n"
        "Pictures may be EXR, HDR, PFM, PNG, JPEG, TGA or BMP; each has the size of its reference.",
    .options = (const OptionTable[]){{compare_options, 0}, {0}},
    .example = "sheen compare reference.exr box.exr",
    .run = run_compare,
};
