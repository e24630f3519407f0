// SPDX-License-Identifier: Apache-2.0
// Every plugin that Mitsuba's manuals (0.6, 2 and 3) list: a scene with it loads, and the warnings name what Sheen does
// not have. Of what it has, nothing is said.
#include "io_kit.h"
#include "scene/metal.h"

/** Lines of k->warnings that are not about a scene without light or camera. */
static int told(const Kit *k)
{
    int n = 0;
    for (const char *line = k->warnings; *line; ++n) {
        size_t length = strcspn(line, "\n");
        char text[2048];
        snprintf(text, sizeof text, "%.*s", (int)length, line);
        if (strstr(text, "no light") || strstr(text, "no camera") || strstr(text, "no shape")) --n;
        line += length + (line[length] == '\n');
    }
    return n;
}

typedef struct Plugins {
    const char *before, *after; // around the plugin's name
    const char *known, *others; // names, blanks between them
} Plugins;

#define CONTROL "<bsdf type=\"diffuse\"/>"
#define SHAPE(inside) "<shape type=\"rectangle\">" inside "</shape>"

static const Plugins plugins[] = {
    {"<shape type=\"rectangle\"><bsdf type=\"", "\"/></shape>",
     "diffuse roughdiffuse dielectric thindielectric roughdielectric conductor roughconductor plastic roughplastic "
     "phong ward difftrans null principled principledthin",
     "hk irawan pplastic polarizer retarder circular hair measured measured_polarized dipolebrdf sssbrdf openpbr"},
    {"<shape type=\"rectangle\"><bsdf type=\"", "\">" CONTROL "</bsdf></shape>", "twosided mask coating roughcoating",
     "bumpmap normalmap"}, // maps without their texture
    {"<shape type=\"rectangle\"><bsdf type=\"", "\">" CONTROL CONTROL "</bsdf></shape>", "blendbsdf twosided", ""},
    {"<shape type=\"", "\"/>", "sphere cylinder disk rectangle cube",
     "hair heightfield deformable linearcurve bsplinecurve sdfgrid ellipsoids ellipsoidsmesh"},
    {"<emitter type=\"", "\"/>", "point spot directional constant sky sun sunsky projector",
     "timed_sunsky collimated volume astroobject"},
    {"<shape type=\"rectangle\"><emitter type=\"", "\"/></shape>", "area", "directionalarea volume projector"},
    {"<sensor type=\"", "\"/>", "perspective thinlens orthographic",
     "perspective_rdist telecentric spherical radiancemeter irradiancemeter fluencemeter distant batch"},
    {"<sensor type=\"perspective\"><film type=\"", "\"/></sensor>", "hdrfilm tiledhdrfilm ldrfilm mfilm specfilm", ""},
    {"<sensor type=\"perspective\"><sampler type=\"", "\"/></sensor>",
     "independent stratified multijitter orthogonal ldsampler halton hammersley sobol", ""},
    {"<integrator type=\"", "\"/>",
     "ao direct path volpath_simple volpath volpathmis bdpt photonmapper ppm sppm pssmlt mlt erpt ptracer adaptive vpl "
     "irrcache multichannel field motion depth aov moment stokes prb prb_basic prbvolpath direct_projective "
     "prb_projective",
     ""},
    {"<medium type=\"", "\"/>", "homogeneous heterogeneous", ""},
    {"<phase type=\"", "\"/>", "isotropic hg rayleigh kkay microflake mixturephase blendphase tabphase sggx", ""},
    {"<volume type=\"", "\"/>", "constvolume gridvolume volcache", ""},
    {"<shape type=\"rectangle\"><bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"", "\"/></bsdf></shape>",
     "checkerboard gridtexture", "wireframe curvature volume"},
    {"<shape type=\"rectangle\"><medium name=\"interior\" type=\"", "\"/></shape>", "", "homogeneous heterogeneous"},
    {"<shape type=\"rectangle\"><subsurface type=\"", "\"/></shape>", "", "dipole singlescatter"},
};

static void check_names(Kit *k, const Plugins *p, const char *names, bool known)
{
    char list[1024], body[1024];
    snprintf(list, sizeof list, "%s", names);
    char *save;
    for (char *name = strtok_r(list, " ", &save); name; name = strtok_r(NULL, " ", &save)) {
        static const char *const versions[] = {"0.6.0", "2.1.0", "3.0.0"};
        for (int v = 0; v < 3; ++v) {
            snprintf(body, sizeof body, "%s%s%s", p->before, name, p->after);
            if (kit_load_version(k, versions[v], body) != SHEEN_OK) fail_msg("%s: %s", body, k->error);
            if ((told(k) == 0) != known) fail_msg("%s: said '%s'", body, k->warnings);
            if (!known && !strstr(k->warnings, "scene.xml:2:")) fail_msg("%s: no place in '%s'", body, k->warnings);
        }
    }
}

static void all_that_is_published_loads(void **state)
{
    Kit *k = *state;
    for (size_t i = 0; i < sizeof plugins / sizeof *plugins; ++i) {
        check_names(k, &plugins[i], plugins[i].known, true);
        check_names(k, &plugins[i], plugins[i].others, false);
    }
}

static const SheenMaterial *material(Kit *k, const char *bsdf)
{
    char body[1024];
    snprintf(body, sizeof body, SHAPE("%s"), bsdf);
    const SheenScene *s = kit_scene(k, body);
    return &s->materials[s->shapes[0].material];
}

// ---- materials --------------------------------------------------------------------------------------------------

static void rough_diffuse_and_sheets(void **state)
{
    Kit *k = *state;
    const SheenMaterial *m = material(k, "<bsdf type=\"roughdiffuse\"/>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_ROUGH_DIFFUSE);
    assert_float_equal(m->reflectance.value.g, 0.5f, 0.0f);
    assert_float_equal(m->alpha_u.value.g, 0.2f, 0.0f);
    assert_false(m->fast);
    m = material(k, "<bsdf type=\"roughdiffuse\"><rgb name=\"diffuseReflectance\" value=\"0.25\"/><float "
                    "name=\"alpha\" value=\"0.7\"/><boolean name=\"useFastApprox\" value=\"true\"/></bsdf>");
    assert_float_equal(m->reflectance.value.g, 0.25f, 0.0f);
    assert_float_equal(m->alpha_u.value.g, 0.7f, 0.0f);
    assert_true(m->fast);
    m = material(k, "<bsdf type=\"principledthin\"><float name=\"diff_trans\" value=\"1.5\"/><float "
                    "name=\"spec_trans\" value=\"0.25\"/><float name=\"eta\" value=\"1.33\"/><float name=\"sheen\" "
                    "value=\"0.5\"/><float name=\"diffuse_transmittance_sampling_rate\" value=\"2\"/></bsdf>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_PRINCIPLED_THIN);
    assert_true(m->two_sided);
    assert_float_equal(m->ior, 1.33f, 0.0f);
    assert_float_equal(m->principled->diff_trans.value.g, 1.5f, 0.0f);
    assert_float_equal(m->principled->spec_trans.value.g, 0.25f, 0.0f);
    assert_float_equal(m->principled->sheen.value.g, 0.5f, 0.0f);
    assert_int_equal(told(k), 0);
}

static void what_polarizes_only_dims(void **state)
{
    Kit *k = *state;
    static const struct {
        const char *name;
        float share;
    } cases[] = {{"polarizer", 0.25f}, {"circular", 0.25f}, {"retarder", 0.5f}};
    for (size_t i = 0; i < 3; ++i) {
        char bsdf[256];
        snprintf(bsdf, sizeof bsdf, "<bsdf type=\"%s\"><float name=\"transmittance\" value=\"0.5\"/></bsdf>",
                 cases[i].name);
        const SheenMaterial *m = material(k, bsdf);
        assert_int_equal(m->kind, SHEEN_MATERIAL_THIN_DIELECTRIC);
        assert_float_equal(m->ior, 1.0f, 0.0f);
        assert_float_equal(m->specular_transmittance.value.g, cases[i].share, 0.0f);
    }
}

static void names_of_metals(void **state)
{
    (void)state;
    Rgb eta, k, other;
    assert_true(sheen_metal_find("Na", &eta, &k) && sheen_metal_find("Na_palik", &other, &k));
    kit_assert_rgb(eta, other, 0.0f);
    assert_true(sheen_metal_find("Cu", &eta, &k) && sheen_metal_find("Cu_palik", &other, &k));
    assert_true(eta.r != other.r); // two measurements
    assert_true(sheen_metal_find("K", &eta, &k) && sheen_metal_find("K_palik", &other, &k));
    kit_assert_rgb(eta, other, 0.0f);
    assert_true(sheen_metal_find("Te-e_palik", &eta, &k) && eta.r > 7.5f); // Mitsuba 3: 7.508907
    assert_false(sheen_metal_find("Cu2", &eta, &k) || sheen_metal_find("_palik", &eta, &k) ||
                 sheen_metal_find("", &eta, &k));
}

// ---- spectra ----------------------------------------------------------------------------------------------------

static Rgb reflectance(Kit *k, const char *spectrum)
{
    char bsdf[512];
    snprintf(bsdf, sizeof bsdf, "<bsdf type=\"diffuse\">%s</bsdf>", spectrum);
    return material(k, bsdf)->reflectance.value;
}

static void spectra_in_lists(void **state)
{
    Kit *k = *state;
    const Rgb want = reflectance(k, "<spectrum name=\"reflectance\" value=\"400:0.1, 550:0.8, 700:0.3\"/>");
    assert_true(want.g > want.r && want.r > want.b);
    static const char *const same[] = {
        "<spectrum type=\"irregular\" name=\"reflectance\"><string name=\"wavelengths\" value=\"400, 550, 700\"/>"
        "<string name=\"values\" value=\"0.1, 0.8, 0.3\"/></spectrum>",
        "<spectrum type=\"regular\" name=\"reflectance\"><float name=\"wavelength_min\" value=\"400\"/><float "
        "name=\"wavelength_max\" value=\"700\"/><string name=\"values\" value=\"0.1 0.8 0.3\"/></spectrum>",
        "<spectrum type=\"regular\" name=\"reflectance\"><string name=\"range\" value=\"400, 700\"/><string "
        "name=\"values\" value=\"0.1,0.8,0.3\"/></spectrum>",
    };
    for (size_t i = 0; i < sizeof same / sizeof *same; ++i) kit_assert_rgb(reflectance(k, same[i]), want, 1e-6f);
    kit_assert_rgb(reflectance(k, "<spectrum type=\"rawconstant\" name=\"reflectance\"><string name=\"value\" "
                                  "value=\"0.1, 0.2, 0.3\"/></spectrum>"),
                   rgb(0.1f, 0.2f, 0.3f), 0.0f);
    assert_int_equal(told(k), 0);
    static const char *const bad[] = {
        "<spectrum type=\"irregular\" name=\"reflectance\"><string name=\"wavelengths\" value=\"400, 550\"/>"
        "<string name=\"values\" value=\"0.1, 0.8, 0.3\"/></spectrum>",
        "<spectrum type=\"irregular\" name=\"reflectance\"><string name=\"wavelengths\" value=\"550, 400\"/>"
        "<string name=\"values\" value=\"0.1, 0.8\"/></spectrum>",
        "<spectrum type=\"regular\" name=\"reflectance\"><string name=\"values\" value=\"0.1\"/></spectrum>",
        "<spectrum type=\"regular\" name=\"reflectance\"><string name=\"values\" value=\"0.1 inf\"/></spectrum>",
        "<spectrum type=\"regular\" name=\"reflectance\"><string name=\"range\" value=\"700 400\"/><string "
        "name=\"values\" value=\"0.1 0.2\"/></spectrum>",
        "<spectrum type=\"regular\" name=\"reflectance\"/>",
        "<spectrum type=\"rawconstant\" name=\"reflectance\"/>",
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        char body[1024];
        snprintf(body, sizeof body, SHAPE("<bsdf type=\"diffuse\">%s</bsdf>"), bad[i]);
        if (kit_load_version(k, "3.0.0", body) != SHEEN_ERR_PARSE) fail_msg("taken: %s", bad[i]);
        assert_int_equal(k->n_errors, 1);
    }
}

// ---- shapes, lights and sensors ---------------------------------------------------------------------------------

/** In version 0.6 a shape without a material that holds a medium is not seen; in 3 it is diffuse. */
static void borders_of_media(void **state)
{
    Kit *k = *state;
    const char *body = "<medium type=\"homogeneous\" id=\"fog\"/><shape type=\"sphere\"><ref name=\"interior\" "
                       "id=\"fog\"/></shape><shape type=\"disk\"/>";
    assert_int_equal(kit_load_version(k, "0.6.0", body), SHEEN_OK);
    const SheenScene *s = k->scene;
    const SheenMaterial *clear = &s->materials[s->shapes[0].material];
    assert_int_equal(clear->kind, SHEEN_MATERIAL_MASK);
    assert_float_equal(clear->weight.value.g, 0.0f, 0.0f);
    assert_int_equal(s->materials[s->shapes[1].material].kind, SHEEN_MATERIAL_DIFFUSE);
    assert_int_equal(told(k), 1);
    s = kit_scene(k, body);
    assert_int_equal(s->materials[s->shapes[0].material].kind, SHEEN_MATERIAL_DIFFUSE);
}

static void projectors_and_pictures_of_spots(void **state)
{
    Kit *k = *state;
    const SheenScene *s =
        kit_scene(k, "<emitter type=\"projector\"><float name=\"scale\" value=\"3\"/><texture name=\"irradiance\" "
                     "type=\"checkerboard\"/><float name=\"fov\" value=\"60\"/></emitter>");
    assert_int_equal(s->n_lights, 1);
    assert_int_equal(k->n_warnings, 1); // of the camera
    assert_int_equal(s->lights[0].kind, SHEEN_LIGHT_PROJECTOR);
    assert_float_equal(s->lights[0].radiance.g, 3.0f * SHEEN_PI, 1e-5f);
    assert_float_equal(s->lights[0].tan_x, sqrtf(1.0f / 3.0f), 1e-6f);
    assert_float_equal(s->lights[0].tan_y, sqrtf(1.0f / 3.0f), 1e-6f);
    assert_int_equal(s->lights[0].texture->kind, SHEEN_TEXTURE_CHECKERBOARD);
    kit_refused(k, "<emitter type=\"projector\"><float name=\"fov\" value=\"180\"/></emitter>", SHEEN_ERR_PARSE,
                "scene.xml:2:1", "between 0 and 180");
    s = kit_scene(k, "<emitter type=\"spot\"><float name=\"cutoff_angle\" value=\"45\"/><texture name=\"texture\" "
                     "type=\"checkerboard\"/></emitter>");
    assert_int_equal(k->n_warnings, 1);
    assert_float_equal(s->lights[0].tan_x, 1.0f, 1e-6f);
    assert_non_null(s->lights[0].texture);
    s = kit_scene(k, "<emitter type=\"spot\"><float name=\"cutoff_angle\" value=\"90\"/><texture name=\"texture\" "
                     "type=\"checkerboard\"/></emitter>");
    assert_non_null(strstr(k->warnings, "a spot's texture needs a cutoffAngle below 90 degrees and is ignored"));
    assert_null(s->lights[0].texture);
}

static void sensors_of_all_kinds(void **state)
{
    Kit *k = *state;
    const SheenScene *s = kit_scene(
        k, "<sensor type=\"batch\"><sensor type=\"perspective\" id=\"a\"/><ref id=\"b\"/></sensor><sensor "
           "type=\"radiancemeter\" id=\"c\"/><sensor type=\"telecentric\" id=\"d\"/>\n<sensor type=\"thinlens\" "
           "id=\"b\"/>");
    assert_int_equal(s->n_cameras, 4);
    assert_string_equal(s->cameras[0].name, "a");
    assert_string_equal(s->cameras[1].name, "b");
    assert_string_equal(s->cameras[2].name, "d");
    assert_true(s->cameras[2].orthographic);
    assert_non_null(strstr(k->warnings, "the sensor 'radiancemeter' takes no picture and is left out"));
    kit_scene(k, "<integrator type=\"moment\"><integrator type=\"path\">\n<boolean name=\"hide_emitters\" "
                 "value=\"true\"/></integrator></integrator>");
    assert_non_null(strstr(k->warnings, "scene.xml:3:1: 'hide_emitters' is not supported"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        KIT_TEST(all_that_is_published_loads),
        KIT_TEST(rough_diffuse_and_sheets),
        KIT_TEST(what_polarizes_only_dims),
        KIT_TEST(names_of_metals),
        KIT_TEST(spectra_in_lists),
        KIT_TEST(borders_of_media),
        KIT_TEST(projectors_and_pictures_of_spots),
        KIT_TEST(sensors_of_all_kinds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
