// SPDX-License-Identifier: Apache-2.0
#include "render_options.h"

#include "options_json.h"

#include "image/image.h"

static const Choice integrators[] = {
    {"irradiance", SHEEN_INTEGRATOR_IRRADIANCE},
    {"path", SHEEN_INTEGRATOR_PATH},
    {"radiance", SHEEN_INTEGRATOR_RADIANCE},
    {"light-vectors", CHOICE_LATER},
    {0},
};
static const Choice gradients[] = {
    {"stratified", SHEEN_GRADIENT_STRATIFIED},
    {"analytical", SHEEN_GRADIENT_ANALYTICAL},
    {"numerical", SHEEN_GRADIENT_NUMERICAL},
    {"none", SHEEN_GRADIENT_NONE},
    {0},
};
static const Choice bases[] = {
    {"auto", SHEEN_BASIS_AUTO},
    {"hsh", SHEEN_BASIS_ALL_HSH},
    {"sh", SHEEN_BASIS_ALL_SH},
    {0},
};
static const Choice secondaries[] = {
    {"cache", SHEEN_SECONDARY_CACHE},
    {"path", SHEEN_SECONDARY_PATH},
    {0},
};
static const Choice error_metrics[] = {
    {"split-sphere", SHEEN_ERROR_SPLIT_SPHERE},
    {"hessian", SHEEN_ERROR_HESSIAN},
    {0},
};
static const Choice filters[] = {
    {"scene", SHEEN_FILTER_UNSET},       {"box", SHEEN_FILTER_BOX},
    {"tent", SHEEN_FILTER_TENT},         {"gaussian", SHEEN_FILTER_GAUSSIAN},
    {"mitchell", SHEEN_FILTER_MITCHELL}, {"catmullrom", SHEEN_FILTER_CATMULL_ROM},
    {"lanczos", SHEEN_FILTER_LANCZOS},   {0},
};
static const Choice progress_modes[] = {
    {"auto", PROGRESS_AUTO},
    {"plain", PROGRESS_PLAIN},
    {"none", PROGRESS_NONE},
    {0},
};
static const Choice aovs[] = {
    {"depth", SHEEN_AOV_DEPTH},
    {"position", SHEEN_AOV_POSITION},
    {"normal", SHEEN_AOV_NORMAL},
    {"albedo", SHEEN_AOV_ALBEDO},
    {"uv", SHEEN_AOV_UV},
    {"primitive", SHEEN_AOV_PRIMITIVE},
    {"direct", SHEEN_AOV_DIRECT},
    {"indirect", SHEEN_AOV_INDIRECT},
    {"records", SHEEN_AOV_RECORDS},
    {"accuracy", SHEEN_AOV_ACCURACY},
    {"coverage", SHEEN_AOV_COVERAGE},
    {"error", SHEEN_AOV_ERROR},
    {"transport", SHEEN_AOV_TRANSPORT},
    {0},
};

#define FIELD(name) .offset = offsetof(RenderValues, name)
#define RANGE(lo, hi) .min = (lo), .max = (hi)

const Option render_options[] = {
    {.kind = OPTION_CHOICE,
     .name = "integrator",
     .argument = "NAME",
     .meaning = "How light is found. radiance: indirect light on diffuse surfaces from a cache of irradiance records, "
                "on glossy ones from radiance records where harmonics hold their lobes, by samples where not; mirrors "
                "and glass are followed. irradiance: the same with samples for all that is glossy. path: the unbiased "
                "reference, path tracing with next-event estimation and multiple importance sampling.",
     .standard = "radiance",
     .example = "--integrator path",
     .choices = integrators,
     .recorded = true,
     .of_records = true,
     FIELD(integrator)},
    {.kind = OPTION_SIZE,
     .name = "size",
     .argument = "WxH",
     .meaning = "Size of the picture in pixels. The horizontal angle of view stays.",
     .standard = "the scene's",
     .example = "--size 640x480",
     .recorded = true,
     RANGE(1, SHEEN_IMAGE_MAX_SIDE),
     FIELD(size)},
    {.kind = OPTION_TEXT,
     .name = "camera",
     .argument = "NAME|INDEX",
     .meaning = "Which camera of the scene, by its name or by its index from 0.",
     .standard = "the first",
     .example = "--camera 1",
     .recorded = true,
     FIELD(camera)},
    {.kind = OPTION_COUNT,
     .name = "spp",
     .argument = "N",
     .meaning = "Samples per pixel: of the whole estimate with --integrator path; of what is seen and of direct light "
                "otherwise.",
     .standard = "the scene's with --integrator path, else 16",
     .example = "--spp 64",
     .recorded = true,
     RANGE(1, 1 << 24),
     FIELD(spp)},
    {.kind = OPTION_CHOICE,
     .name = "filter",
     .argument = "scene|box|tent|gaussian|mitchell|catmullrom|lanczos",
     .meaning = "How a pixel averages its samples: by the filter that the scene names, or by this one with its usual "
                "parameters. Samples are drawn where the filter is high; no pixel takes another's.",
     .standard = "scene; where it names none, gaussian in Mitsuba's format and box in OBJ",
     .example = "--filter box",
     .choices = filters,
     .recorded = true,
     FIELD(filter)},
    {.kind = OPTION_NUMBER,
     .name = "noise",
     .argument = "E",
     .meaning = "Of the cached integrators: the standard error, relative to a pixel's brightness, above which it gets "
                "more samples, up to 16 times --spp. Needs --spp 8 or more. 0: every pixel has --spp samples.",
     .standard = "0.03",
     .example = "--noise 0.01",
     .recorded = true,
     RANGE(0.0, 1.0),
     FIELD(noise)},
    {.kind = OPTION_COUNT,
     .name = "light-samples",
     .argument = "N",
     .meaning = "Light samples for each shading point. Up to 4 lights share them evenly, of more they are chosen.",
     .standard =
         "2 for each light where there are 2 to 4 (1 for those without size), else 1 or 4; 1 with --integrator path",
     .example = "--light-samples 4",
     .recorded = true,
     .of_records = true,
     RANGE(1, 4096),
     FIELD(light_samples)},
    {.kind = OPTION_COUNT,
     .name = "bounces",
     .argument = "N",
     .meaning = "Indirect bounces: 0 is direct light only, 1 is one gather.",
     .standard = "8",
     .example = "--bounces 3",
     .recorded = true,
     .of_records = true,
     RANGE(0, 1024),
     FIELD(bounces)},
    {.kind = OPTION_NUMBER,
     .name = "accuracy",
     .argument = "A",
     .meaning = "The largest interpolation error of the cache: a record is used where its weight is over 1/A. Smaller "
                "is finer and slower.",
     .standard = "0.2",
     .example = "--accuracy 0.1",
     .recorded = true,
     .of_records = true,
     RANGE(0.01, 1.0),
     FIELD(accuracy)},
    {.kind = OPTION_CHOICE,
     .name = "error-metric",
     .argument = "split-sphere|hessian",
     .meaning = "What sets how far a record of irradiance may be used. hessian: how its light bends, occlusion "
                "included, in ellipses. split-sphere: the distances of what is around.",
     .standard = "hessian",
     .example = "--error-metric split-sphere",
     .choices = error_metrics,
     .recorded = true,
     .of_records = true,
     FIELD(error_metric)},
    {.kind = OPTION_NUMBER,
     .name = "reach-min",
     .argument = "PIXELS",
     .meaning = "The least distance that a record is used over: finer detail of indirect light is lost.",
     .standard = "4.0",
     .example = "--reach-min 2",
     .recorded = true,
     .of_records = true,
     RANGE(0.5, 1000.0),
     FIELD(reach_min)},
    {.kind = OPTION_NUMBER,
     .name = "reach-max",
     .argument = "PIXELS",
     .meaning = "The largest distance that a record is used over, where light is even. The farther, the fewer records, "
                "and the wider the discs that their noise is seen in.",
     .standard = "25.0",
     .example = "--reach-max 50",
     .recorded = true,
     .of_records = true,
     RANGE(0.5, 1000.0),
     FIELD(reach_max)},
    {.kind = OPTION_COUNT,
     .name = "gather-rays",
     .argument = "N",
     .meaning = "First rays for each record of the cache, rounded to its grid of strata. Where they find light hard to "
                "catch up to three times as many follow.",
     .standard = "400",
     .example = "--gather-rays 1000",
     .recorded = true,
     .of_records = true,
     RANGE(16, 1 << 20),
     FIELD(gather_rays)},
    {.kind = OPTION_CHOICE,
     .name = "gradients",
     .argument = "KIND",
     .meaning = "Gradients with which records are interpolated. stratified: from the strata of the gather. analytical, "
                "numerical: of radiance records by derivatives of what the rays hit, blind for what comes into view; "
                "of irradiance stratified. none.",
     .standard = "stratified",
     .example = "--gradients none",
     .choices = gradients,
     .recorded = true,
     .of_records = true,
     FIELD(gradients)},
    {.kind = OPTION_CHOICE,
     .name = "basis",
     .argument = "auto|hsh|sh",
     .meaning = "Basis of the radiance records: hemispherical harmonics in each record's frame, or spherical ones in "
                "the world's. auto: hemispherical on flat surfaces, spherical on curved ones.",
     .standard = "auto",
     .example = "--basis sh",
     .choices = bases,
     .recorded = true,
     .of_records = true,
     FIELD(basis)},
    {.kind = OPTION_CHOICE,
     .name = "secondary",
     .argument = "cache|path",
     .meaning = "Light beyond the first bounce: from a sparse cache of its own, or by one path for each gather ray.",
     .standard = "cache",
     .example = "--secondary path",
     .choices = secondaries,
     .recorded = true,
     .of_records = true,
     FIELD(secondary)},
    {.kind = OPTION_CHOICE,
     .name = "adaptive",
     .argument = "on|off",
     .meaning = "Make records more accurate, and more of them, until no overlap of their areas shows a difference. "
                "--accuracy then is where they begin; none is made finer than a quarter of it.",
     .standard = "on",
     .example = "--adaptive off",
     .choices = cli_on_off,
     .recorded = true,
     .of_records = true,
     FIELD(adaptive)},
    {.kind = OPTION_NUMBER,
     .name = "discernible",
     .argument = "F",
     .meaning = "With --adaptive: the least difference that is told, relative to what a point shows with its direct "
                "light.",
     .standard = "0.02",
     .example = "--discernible 0.01",
     .recorded = true,
     .of_records = true,
     RANGE(0.0, 1.0),
     FIELD(discernible)},
    {.kind = OPTION_CHOICE,
     .name = "neighbor-clamping",
     .argument = "on|off",
     .meaning = "Keep the radius of a record below that of its neighbors plus their distance, so that small detail is "
                "not skipped.",
     .standard = "on",
     .example = "--neighbor-clamping off",
     .choices = cli_on_off,
     .recorded = true,
     .of_records = true,
     FIELD(neighbor_clamping)},
    {.kind = OPTION_CHOICE,
     .name = "gradient-clamping",
     .argument = "on|off",
     .meaning = "Keep the radius of a record below the distance over which its gradient would change it by as much as "
                "its value.",
     .standard = "on",
     .example = "--gradient-clamping off",
     .choices = cli_on_off,
     .recorded = true,
     .of_records = true,
     FIELD(gradient_clamping)},
    {.kind = OPTION_SET,
     .name = "aov",
     .argument = "NAME,...",
     .meaning = "More layers in .exr files: depth, position, normal, albedo, uv, primitive, direct, indirect, and of "
                "the cache records (as dots; irradiance white, radiance orange), accuracy (the value of A), coverage "
                "(number of contributing records), error (expected of their light, relative) and transport (what "
                "indirect light was asked of: radiance records red, irradiance records green, rays followed along "
                "mirrors, glass and sampled gloss blue).",
     .standard = "none",
     .example = "--aov depth,normal,indirect",
     .choices = aovs,
     FIELD(aovs)},
    {.kind = OPTION_NUMBER,
     .name = "exposure",
     .argument = "EV",
     .meaning = "Stops by which .png files are brightened; formats that hold light itself are never scaled.",
     .standard = "0",
     .example = "--exposure -1.5",
     RANGE(-64.0, 64.0),
     FIELD(exposure)},
    {.kind = OPTION_COUNT,
     .name = "threads",
     .argument = "N",
     .meaning = "Worker threads. The picture is the same, bit by bit, at any number.",
     .standard = "all cores",
     .example = "--threads 2",
     RANGE(1, 1024),
     FIELD(threads)},
    {.kind = OPTION_COUNT,
     .name = "seed",
     .argument = "N",
     .meaning = "Seed of all random numbers.",
     .standard = "0",
     .example = "--seed 7",
     .recorded = true,
     .of_records = true,
     RANGE(0, UINT32_MAX),
     FIELD(seed)},
    {.kind = OPTION_TEXT,
     .name = "stats",
     .argument = "FILE",
     .meaning = "Write statistics as JSON: options, times, rays, records, memory. - is standard output.",
     .standard = "none",
     .example = "--stats stats.json",
     FIELD(stats)},
    {.kind = OPTION_CHOICE,
     .name = "progress",
     .argument = "auto|plain|none",
     .meaning = "Progress on standard error: auto is a live line on a terminal and plain elsewhere, plain a line every "
                "few seconds.",
     .standard = "auto",
     .example = "--progress none",
     .choices = progress_modes,
     FIELD(progress)},
    {.kind = OPTION_FLAG,
     .name = "quiet",
     .meaning = "Nothing on standard error but errors.",
     .example = "--quiet",
     FIELD(quiet)},
    {.kind = OPTION_FLAG,
     .name = "verbose",
     .meaning = "Say more on standard error: what was loaded, and what took how long.",
     .example = "--verbose",
     FIELD(verbose)},
    {0},
};

RenderValues render_values_default(void)
{
    SheenOptions o = sheen_options_default();
    return (RenderValues){
        .integrator = SHEEN_INTEGRATOR_RADIANCE,
        .light_samples = o.light_samples,
        .bounces = o.bounces,
        .noise = cli_decimal(o.noise),
        .error_metric = (int)o.error_metric,
        .reach_min = cli_decimal(o.reach_min),
        .reach_max = cli_decimal(o.reach_max),
        .accuracy = cli_decimal(o.accuracy),
        .gather_rays = o.gather_rays,
        .gradients = (int)o.gradients,
        .lobes = lobe_values_default(),
        .basis = (int)o.basis,
        .secondary = (int)o.secondary,
        .neighbor_clamping = o.neighbor_clamping,
        .gradient_clamping = o.gradient_clamping,
        .adaptive = o.adaptive,
        .discernible = cli_decimal(o.discernible),
        .seed = o.seed,
        .progress = PROGRESS_AUTO,
    };
}

bool render_values_check(const Command *command, const RenderValues *values)
{
    if (!scene_values_check(command, &values->scene)) return false;
    if (values->reach_min > values->reach_max) {
        cli_usage_error(command, "--reach-min: more than --reach-max");
        return false;
    }
    if ((uint64_t)values->size.width * values->size.height <= SHEEN_IMAGE_MAX_PIXELS) return true;
    cli_usage_error(command, "--size: a picture has at most %llu pixels", (unsigned long long)SHEEN_IMAGE_MAX_PIXELS);
    return false;
}

SheenRenderSettings render_values_settings(RenderValues *values, const SheenCamera *camera)
{
    SheenOptions o = sheen_options_default();
    values->camera = camera->name;
    if (values->size.width == 0) values->size = (PictureSize){camera->width, camera->height};
    if (values->spp == 0)
        values->spp = values->integrator == SHEEN_INTEGRATOR_PATH && camera->spp ? camera->spp : o.spp;
    SheenFilter filter =
        values->filter == SHEEN_FILTER_UNSET ? camera->filter : sheen_filter_standard((SheenFilterKind)values->filter);
    values->filter = filter.kind == SHEEN_FILTER_UNSET ? SHEEN_FILTER_BOX : (int)filter.kind;
    o.spp = values->spp;
    o.light_samples = values->light_samples;
    o.bounces = values->bounces;
    o.time_limit = values->time_limit;
    o.noise = (float)values->noise;
    o.error_metric = (SheenErrorMetric)values->error_metric;
    o.reach_min = (float)values->reach_min;
    o.reach_max = (float)values->reach_max;
    o.accuracy = (float)values->accuracy;
    o.gather_rays = values->gather_rays;
    o.gradients = (SheenGradient)values->gradients;
    o.order = values->lobes.order;
    o.brdf_error = (float)values->lobes.brdf_error;
    o.basis = (SheenBasisChoice)values->basis;
    o.secondary = (SheenSecondary)values->secondary;
    o.neighbor_clamping = values->neighbor_clamping != 0;
    o.gradient_clamping = values->gradient_clamping != 0;
    o.adaptive = values->adaptive != 0;
    o.discernible = (float)values->discernible;
    o.seed = values->seed;
    return (SheenRenderSettings){
        .integrator = (SheenIntegrator)values->integrator,
        .camera = camera,
        .width = values->size.width,
        .height = values->size.height,
        .aovs = values->aovs,
        .filter = filter,
        .options = o,
    };
}

const char *render_integrator_name(const RenderValues *values)
{
    return choice_name(integrators, values->integrator);
}
