// SPDX-License-Identifier: Apache-2.0
// `sheen info`: what a scene, image or cache file holds. Everything is collected as JSON; the text is the same, line by
// line.
#include "brdf_order.h"
#include "cache_info.h"
#include "cli.h"
#include "exr_header.h"
#include "json_text.h"
#include "report.h"
#include "scene_options.h"

#include "image/image.h"
#include "io/file_path.h"
#include "io/load.h"

#include <stdlib.h>
#include <string.h>

typedef struct InfoValues {
    SceneValues scene;
    LobeValues lobes;       // for brdf_order
    const char *brdf_order; // picture to write, or NULL
    bool json;
} InfoValues;

static const Option info_options[] = {
    {.kind = OPTION_TEXT,
     .name = "brdf-order",
     .argument = "FILE",
     .meaning =
         "Draw how a scene's glossy materials are represented in hemispherical harmonics, and print it: for each "
         "its name, the least and largest order, the mean error, and the part of the outgoing directions for "
         "which it is cached. The picture has a row for each material, at most 64: the disk of outgoing "
         "directions coloured by error and by order, blue for none to red for the largest allowed, dark where "
         "the material is sampled; and along the disk's middle the order as bars, the error as points.",
     .standard = "none",
     .example = "sheen info --brdf-order orders.png scene.xml",
     .offset = offsetof(InfoValues, brdf_order)},
    {.kind = OPTION_FLAG,
     .name = "json",
     .meaning = "One JSON object for machines instead of text.",
     .example = "sheen info --json box.exr",
     .offset = offsetof(InfoValues, json)},
    {0},
};

static const OptionTable tables[] = {
    {scene_options, offsetof(InfoValues, scene)},
    {info_options, 0},
    {lobe_options, offsetof(InfoValues, lobes)},
    {0},
};

// ---- scenes -----------------------------------------------------------------------------------------------------

static const char *const shape_kinds[] = {
    [SHEEN_SHAPE_MESH] = "mesh",
    [SHEEN_SHAPE_SPHERE] = "sphere",
    [SHEEN_SHAPE_DISK] = "disk",
};
static const char *const material_kinds[] = {
    [SHEEN_MATERIAL_DIFFUSE] = "diffuse",
    [SHEEN_MATERIAL_CONDUCTOR] = "conductor",
    [SHEEN_MATERIAL_DIELECTRIC] = "dielectric",
    [SHEEN_MATERIAL_THIN_DIELECTRIC] = "thin-dielectric",
    [SHEEN_MATERIAL_ROUGH_CONDUCTOR] = "rough-conductor",
    [SHEEN_MATERIAL_ROUGH_DIELECTRIC] = "rough-dielectric",
    [SHEEN_MATERIAL_PLASTIC] = "plastic",
    [SHEEN_MATERIAL_ROUGH_PLASTIC] = "rough-plastic",
    [SHEEN_MATERIAL_DIFFUSE_TRANSMIT] = "diffuse-transmitter",
    [SHEEN_MATERIAL_PHONG] = "phong",
    [SHEEN_MATERIAL_WARD] = "ward",
    [SHEEN_MATERIAL_LAFORTUNE] = "lafortune",
    [SHEEN_MATERIAL_PRINCIPLED] = "principled",
    [SHEEN_MATERIAL_PRINCIPLED_THIN] = "principled-thin",
    [SHEEN_MATERIAL_ROUGH_DIFFUSE] = "rough-diffuse",
    [SHEEN_MATERIAL_BLEND] = "blend",
    [SHEEN_MATERIAL_SIDES] = "two-sides",
    [SHEEN_MATERIAL_MASK] = "mask",
    [SHEEN_MATERIAL_BUMP] = "bump-map",
    [SHEEN_MATERIAL_NORMAL] = "normal-map",
    [SHEEN_MATERIAL_COATING] = "coating",
    [SHEEN_MATERIAL_ROUGH_COATING] = "rough-coating",
};
_Static_assert(sizeof material_kinds / sizeof *material_kinds == SHEEN_MATERIAL_COUNT, "each kind has a name");
static const char *const light_kinds[] = {
    [SHEEN_LIGHT_AREA] = "area",
    [SHEEN_LIGHT_POINT] = "point",
    [SHEEN_LIGHT_SPOT] = "spot",
    [SHEEN_LIGHT_DIRECTIONAL] = "directional",
    [SHEEN_LIGHT_ENVIRONMENT] = "environment",
    [SHEEN_LIGHT_PROJECTOR] = "projector",
};
_Static_assert(sizeof light_kinds / sizeof *light_kinds == SHEEN_LIGHT_KINDS, "each kind has a name");

/** Adds one to a count by name. */
static void count(json_t *counts, const char *name)
{
    json_int_t n = json_integer_value(json_object_get(counts, name));
    json_object_set_new(counts, name, json_integer(n + 1));
}

static json_t *cameras_json(const SheenScene *scene)
{
    json_t *cameras = json_array();
    for (uint32_t i = 0; i < scene->n_cameras; ++i) {
        const SheenCamera *c = &scene->cameras[i];
        json_t *camera = json_pack("{s:o, s:[I, I]}", "name", json_text(c->name), "size", (json_int_t)c->width,
                                   (json_int_t)c->height);
        // Without perspective there is no angle but a width: its picture shows -1 to 1 along its x axis.
        if (c->orthographic)
            json_object_set_new(camera, "width",
                                json_real(2.0 * (double)v3_length(transform_vector(&c->to_world, v3(1, 0, 0)))));
        else
            json_object_set_new(camera, "fov_degrees", json_real((double)(c->fov_x * 180.0f * SHEEN_INV_PI)));
        json_object_set_new(camera, "spp", json_integer((json_int_t)c->spp));
        json_array_append_new(cameras, camera);
    }
    return cameras;
}

static json_t *scene_json(const char *path, const SheenScene *scene)
{
    json_t *shapes = json_object(), *materials = json_object(), *lights = json_object();
    for (uint32_t i = 0; i < scene->n_shapes; ++i) count(shapes, shape_kinds[scene->shapes[i].kind]);
    for (uint32_t i = 0; i < scene->n_materials; ++i) count(materials, material_kinds[scene->materials[i].kind]);
    for (uint32_t i = 0; i < scene->n_lights; ++i) count(lights, light_kinds[scene->lights[i].kind]);
    return json_pack("{s:o, s:s, s:o, s:I, s:I, s:o, s:o, s:o, s:o}", "file", json_text(path), "kind", "scene",
                     "shapes", shapes, "triangles", (json_int_t)scene->n_triangles, "instances",
                     (json_int_t)scene->n_instances, "materials", materials, "lights", lights, "cameras",
                     cameras_json(scene), "bounds", json_bounds(&scene->bounds));
}

// ---- images -----------------------------------------------------------------------------------------------------

/** Mean, least and largest finite value of a channel. */
static json_t *channel_json(const SheenImage *image, int channel)
{
    uint64_t n = (uint64_t)image->width * image->height, finite = 0;
    double sum = 0.0, lo = 0.0, hi = 0.0;
    for (uint64_t i = 0; i < n; ++i) {
        const Rgb *p = &image->pixels[i];
        double x = channel == 0 ? p->r : channel == 1 ? p->g : p->b;
        if (!isfinite(x)) continue;
        lo = finite == 0 || x < lo ? x : lo;
        hi = finite == 0 || x > hi ? x : hi;
        sum += x;
        ++finite;
    }
    return json_pack("{s:f, s:f, s:f, s:I}", "mean", finite ? sum / (double)finite : 0.0, "min", lo, "max", hi,
                     "nonfinite", (json_int_t)(n - finite));
}

static json_t *image_json(const char *path, const SheenImage *image)
{
    json_t *channels = json_array(), *attributes = json_object();
    exr_header_read(path, channels, attributes);
    size_t n_listed = json_array_size(channels);
    for (const char *c = "RGB"; n_listed == 0 && *c; ++c) json_array_append_new(channels, json_stringn(c, 1));
    return json_pack("{s:o, s:s, s:[I, I], s:o, s:o, s:o, s:o, s:o}", "file", json_text(path), "kind", "image", "size",
                     (json_int_t)image->width, (json_int_t)image->height, "channels", channels, "red",
                     channel_json(image, 0), "green", channel_json(image, 1), "blue", channel_json(image, 2),
                     "attributes", attributes);
}

// ---- output -----------------------------------------------------------------------------------------------------

/** Names and attributes come from files: nothing in them reaches a terminal as a command. */
static void print_text(const char *text)
{
    for (const char *c = text; *c; ++c) putchar((unsigned char)*c < ' ' || *c == 127 ? '?' : *c);
}

/** Prints a value in one line: `a 1, b 2` for an object, `1, 2` for an array. */
static void print_value(const json_t *value, int depth)
{
    const char *key;
    json_t *item;
    size_t i;
    int n = 0;
    if (json_is_object(value)) {
        json_object_foreach((json_t *)value, key, item)
        {
            if (n++) fputs(", ", stdout);
            print_text(key);
            putchar(' ');
            print_value(item, depth + 1);
        }
    } else if (json_is_array(value)) {
        if (depth) putchar('(');
        json_array_foreach(value, i, item)
        {
            if (i) fputs(json_is_object(item) ? "; " : ", ", stdout);
            print_value(item, depth + 1);
        }
        if (depth) putchar(')');
    } else if (json_is_string(value)) {
        print_text(json_string_value(value));
    } else if (json_is_integer(value)) {
        printf("%lld", (long long)json_integer_value(value));
    } else if (json_is_real(value)) {
        printf("%.6g", json_real_value(value));
    } else if (json_is_boolean(value)) {
        fputs(json_is_true(value) ? "yes" : "no", stdout);
    } else {
        fputs("none", stdout);
    }
    if (n == 0 && json_is_object(value)) fputs("none", stdout);
}

static int print_info(json_t *info, bool as_json)
{
    if (!info) return cli_error("out of memory");
    const char *key;
    json_t *value;
    int width = 10;
    json_object_foreach(info, key, value) width = (int)strlen(key) > width ? (int)strlen(key) : width;
    if (as_json) {
        json_dumpf(info, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
        putchar('\n');
    } else {
        json_object_foreach(info, key, value)
        {
            printf("%-*s", width + 1, key);
            print_value(value, 0);
            putchar('\n');
        }
    }
    json_decref(info);
    return cli_finish_stdout();
}

static bool ends_in(const char *path, const char *const endings[])
{
    for (size_t i = 0; endings[i]; ++i)
        if (sheen_path_has_ending(path, endings[i])) return true;
    return false;
}

static const char *const image_endings[] = {".exr", ".hdr", ".pfm", ".png", ".jpg", ".jpeg",
                                            ".tga", ".bmp", ".ppm", ".pgm", NULL};
static const char *const cache_endings[] = {".shc", NULL};

static int image_info(const char *path, Report *report, json_t **info)
{
    SheenLog log = report_log(report);
    SheenImage image;
    int code = report_exit_code(report, sheen_image_read(path, &log, &image), path);
    if (code == CLI_DONE) *info = image_json(path, &image);
    sheen_image_free(&image);
    return code;
}

static int cache_info(const char *path, Report *report, json_t **info)
{
    SheenLog log = report_log(report);
    SheenCacheFile *file;
    int code = report_exit_code(report, sheen_cache_file_read(path, &log, &file), path);
    if (code == CLI_DONE) *info = cache_info_json(path, file);
    sheen_cache_file_destroy(&file);
    return code;
}

static int scene_info(const char *path, const InfoValues *values, Report *report, json_t **info)
{
    SheenLog log = report_log(report);
    const TextList *defines = &values->scene.defines;
    SheenScene *scene;
    SheenStatus status = sheen_scene_load_with(path, (SheenDefines){defines->items, defines->n}, &log, &scene);
    int code = report_exit_code(report, status, path);
    if (code == CLI_DONE) *info = scene_json(path, scene);
    if (code == CLI_DONE && values->brdf_order)
        code = brdf_order_report(scene, values->brdf_order, &values->lobes, report, *info);
    sheen_scene_destroy(&scene);
    return code;
}

static int run_info(int argc, char **argv)
{
    InfoValues values = {.lobes = lobe_values_default()};
    int code;
    if (!cli_parse(&command_info, &argc, argv, &values, &code)) return code;
    code = cli_check_operand(&command_info, argc, argv, "FILE", "file");
    if (code != CLI_DONE) return code;
    if (!scene_values_check(&command_info, &values.scene)) return CLI_USAGE;
    if (values.brdf_order && !sheen_image_writable_format(values.brdf_order))
        return cli_usage_error(&command_info, "--brdf-order: '%s' has no ending of a picture that can be written",
                               values.brdf_order);
    const char *path = argv[1];
    Report report = {.strict = values.scene.strict};
    json_t *info = NULL;
    if (ends_in(path, image_endings))
        code = image_info(path, &report, &info);
    else if (ends_in(path, cache_endings))
        code = cache_info(path, &report, &info);
    else
        code = scene_info(path, &values, &report, &info);
    if (code == CLI_DONE) return print_info(info, values.json);
    json_decref(info);
    return code;
}

const Command command_info = {
    .name = "info",
    .operands = "FILE",
    .summary = "what a scene, image or cache file holds",
    .description =
        "Prints what a scene file holds (shapes, triangles, materials and lights by kind, cameras, bounds), an image "
        "file (size, channels, mean, least and largest values, text attributes) or a cache file that ends in .shc "
        "(the scene's hash, the options that it was made with, and of each kind how many records, their order, their "
        "least, mean and largest radius, and where they are).",
    .options = tables,
    .example = "sheen info scenes/cornell-box.xml",
    .run = run_info,
};
