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
    {"<shape type=\"", "\"/>", "sphere cylinder disk rectangle cube", "deformable sdfgrid ellipsoids ellipsoidsmesh"},
    {"<shape type=\"", "\"><string name=\"filename\" value=\"curves.txt\"/></shape>", "linearcurve bsplinecurve hair",
     ""},
    {"<shape type=\"",
     "\"><texture type=\"checkerboard\"/><integer name=\"width\" value=\"4\"/><integer "
     "name=\"height\" value=\"3\"/></shape>",
     "heightfield", ""},
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
    kit_write(k, "curves.txt", "0 0 0 0.1\n1 0 0 0.1\n2 0 0 0.1\n3 0 0 0.1\n");
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
    m = material(k, "<bsdf type=\"principledthin\"><texture name=\"diff_trans\" type=\"checkerboard\"><float "
                    "name=\"color0\" value=\"0.4\"/><float name=\"color1\" value=\"1.4\"/></texture><texture "
                    "name=\"eta\" type=\"checkerboard\"><float name=\"color0\" value=\"1.4\"/><float name=\"color1\" "
                    "value=\"1.6\"/></texture></bsdf>");
    assert_float_equal(m->principled->diff_trans.value.g, 1.4f, 1e-6f); // beyond what reflectances may be
    assert_float_equal(m->ior, 1.5f, 1e-6f);
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
    Rgb eta, k, other = rgb_gray(-1.0f);
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

/** Values of Mitsuba 3, which has exact tubes; ours have 12 sides, cos(pi / 12) = 0.966. */
static void curves_become_tubes(void **state)
{
    Kit *k = *state;
    kit_write(k, "c.txt",
              "# two curves\n0 0 0 0.1\n1 0 0 0.1\r\n2 0 0 0.1\n3 0 0 0.1\n4 0 0 0.1\n \n\n0 2 0 0.2\n"
              "1 2 0 0.2\n2 2 0 0.2\n3 2 0 0.2");
    static const struct {
        const char *type;
        Vec3 lo, hi;
    } cases[] = {{"linearcurve", {-0.2f, -0.1f, -0.2f}, {8.1f, 4.2f, 0.2f}},
                 {"bsplinecurve", {2, -0.1f, -0.2f}, {6, 4.2f, 0.2f}}};
    for (size_t i = 0; i < 2; ++i) {
        char body[512];
        snprintf(body, sizeof body,
                 "<shape type=\"%s\"><string name=\"filename\" value=\"c.txt\"/><transform name=\"to_world\"><scale "
                 "value=\"2\"/></transform></shape>",
                 cases[i].type);
        const SheenScene *s = kit_scene(k, body);
        kit_assert_v3(s->bounds.lo, cases[i].lo, 0.007f); // the transform leaves the radius
        kit_assert_v3(s->bounds.hi, cases[i].hi, 0.007f);
        const SheenMesh *m = &s->shapes[0].mesh;
        for (uint32_t t = 0; t < m->n_triangles; ++t) { // outward, as the normals
            const uint32_t *v = m->triangles[t];
            Vec3 face = v3_cross(v3_sub(m->p[v[1]], m->p[v[0]]), v3_sub(m->p[v[2]], m->p[v[0]]));
            assert_true(v3_dot(face, m->n[v[0]]) > 0.0f);
        }
        for (uint32_t v = 0; v < m->n_vertices; ++v) {
            if (i == 0 && (m->p[v].x < 0.001f || m->p[v].y > 1.0f || m->p[v].x > 7.999f)) continue;
            float want = i == 0 ? m->p[v].x / 14.0f : (m->p[v].x - 2.0f) / 6.0f; // of 7 and of 3 segments
            if (m->p[v].y < 1.0f) assert_float_equal(1.0f - m->uv[v].y, want, 1e-5f);
            assert_float_equal(v3_length(m->n[v]), 1.0f, 1e-5f);
        }
        assert_int_equal(told(k), 0);
    }
    // Version 0.6: one radius for all, three numbers a line or their bytes.
    kit_write(k, "h.txt", "0 0 0\n0 0 1\n\n1 0 0\n1 0 1\n1 0 2\n");
    const float strands[] = {0, 0, 0, 0, 0, 1, INFINITY, 1, 0, 0, 1, 0, 1, 1, 0, 2};
    char bytes[15 + sizeof strands] = "BINARY_HAIR\5";
    memcpy(bytes + 15, strands, sizeof strands);
    kit_write_bytes(k, "h.bin", bytes, sizeof bytes);
    Bounds bounds[2];
    for (int i = 0; i < 2; ++i) {
        bounds[i] = kit_scene(k, i ? "<shape type=\"hair\"><string name=\"filename\" value=\"h.bin\"/></shape>"
                                   : "<shape type=\"hair\"><string name=\"filename\" value=\"h.txt\"/></shape>")
                        ->bounds;
        assert_int_equal(k->scene->n_triangles, 3 * 12 * 2);
        kit_assert_v3(bounds[i].lo, v3(-0.025f, -0.025f, 0), 0.002f);
        kit_assert_v3(bounds[i].hi, v3(1.025f, 0.025f, 2), 0.002f);
    }
    static const char *const bad[] = {"0 0 0\n1 1 1\n", "0 0 0 x\n", "0 0 0 1 2\n", "0 0 0 nan\n", "BINARY_HAIR"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        kit_write(k, "bad.txt", bad[i]);
        kit_refused(k, "<shape type=\"linearcurve\"><string name=\"filename\" value=\"bad.txt\"/></shape>",
                    SHEEN_ERR_PARSE, "scene.xml:2:1", "is not a list of the points of curves");
    }
    kit_write_bytes(k, "h.bin", bytes, sizeof bytes - 1);
    kit_refused(k, "<shape type=\"hair\"><string name=\"filename\" value=\"h.bin\"/></shape>", SHEEN_ERR_PARSE,
                "scene.xml:2:1", "is not a list of the points of curves");
    kit_write(k, "empty.txt", "\n\n0 0 0 1\n");
    assert_int_equal(kit_scene(k, "<shape type=\"linearcurve\"><string name=\"filename\" value=\"empty.txt\"/>"
                                  "</shape>")
                         ->n_triangles,
                     0);
}

/** Heights are the picture's, its first row at y = -1. */
static void height_fields(void **state)
{
    Kit *k = *state;
    const unsigned char pfm[] = "Pf\n3 2\n-1.0\n";
    const float rows[2][3] = {{0.1f, 0.2f, 0.3f}, {0.4f, 0.5f, 0.6f}}; // a PFM's last row comes first
    unsigned char bytes[sizeof pfm - 1 + sizeof rows];
    memcpy(bytes, pfm, sizeof pfm - 1);
    memcpy(bytes + sizeof pfm - 1, rows, sizeof rows);
    kit_write_bytes(k, "h.pfm", bytes, sizeof bytes);
    const SheenScene *s = kit_scene(k, "<shape type=\"heightfield\"><string name=\"filename\" value=\"h.pfm\"/><float "
                                       "name=\"scale\" value=\"10\"/></shape>");
    const SheenMesh *m = &s->shapes[0].mesh;
    assert_int_equal(m->n_triangles, 4);
    assert_non_null(m->n);
    kit_assert_v3(m->p[0], v3(-1, -1, 4), 1e-6f);
    kit_assert_v3(m->p[1], v3(0, -1, 5), 1e-6f);
    kit_assert_v3(m->p[5], v3(1, 1, 3), 1e-6f);
    for (uint32_t i = 0; i < 6; ++i) assert_true(m->n[i].z > 0.0f);
    assert_int_equal(told(k), 0);
    s = kit_scene(k, "<shape type=\"heightfield\"><string name=\"filename\" value=\"h.pfm\"/><boolean "
                     "name=\"shadingNormals\" value=\"false\"/></shape>");
    assert_null(s->shapes[0].mesh.n);
    kit_refused(k, "<shape type=\"heightfield\"/>", SHEEN_ERR_PARSE, "scene.xml:2:1", "needs a 'filename'");
    kit_refused(k, "<shape type=\"heightfield\"><texture type=\"checkerboard\"/></shape>", SHEEN_ERR_PARSE,
                "scene.xml:2:1", "2 to 16384 heights");
}

static void textures_that_are_constant(void **state)
{
    Kit *k = *state;
    static const struct {
        const char *texture;
        Rgb value;
        int n_told;
    } cases[] = {
        {"<texture name=\"reflectance\" type=\"uniform\"><float name=\"value\" value=\"0.25\"/></texture>",
         {0.25f, 0.25f, 0.25f},
         0},
        {"<texture name=\"reflectance\" type=\"rgb\"><rgb name=\"color\" value=\"0.1 0.2 0.3\"/></texture>",
         {0.1f, 0.2f, 0.3f},
         0},
        {"<texture name=\"reflectance\" type=\"scale\"><float name=\"scale\" value=\"0.5\"/><rgb name=\"value\" "
         "value=\"0.2 0.4 0.6\"/></texture>",
         {0.1f, 0.2f, 0.3f},
         0},
        {"<texture name=\"reflectance\" type=\"wireframe\"><rgb name=\"interiorColor\" value=\"0.1 0.2 0.3\"/><float "
         "name=\"lineWidth\" value=\"1\"/></texture>",
         {0.1f, 0.2f, 0.3f},
         1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        kit_assert_rgb(reflectance(k, cases[i].texture), cases[i].value, 1e-6f);
        assert_int_equal(told(k), cases[i].n_told);
    }
}

/** Without a version the spelling of names tells; an animation stands still. */
static void versions_and_animations(void **state)
{
    Kit *k = *state;
    kit_write(k, "scene.xml",
              "<scene><bsdf type=\"conductor\" id=\"m\"/><shape type=\"sphere\"><transform "
              "name=\"toWorld\"/><ref id=\"m\"/></shape></scene>");
    assert_int_equal(kit_load(k, "scene.xml"), SHEEN_OK);
    assert_non_null(strstr(k->warnings, "<scene> has no version: taken for 0.6.0"));
    assert_true(k->scene->materials[k->scene->shapes[0].material].eta.r > 0.1f); // copper
    kit_write(k, "scene.xml",
              "<scene><bsdf type=\"conductor\" id=\"m\"/><shape type=\"sphere\"><animation "
              "name=\"animation\"><transform time=\"0\"><translate x=\"3\"/></transform><transform "
              "time=\"1\"/></animation><ref id=\"m\"/></shape></scene>");
    assert_int_equal(kit_load(k, "scene.xml"), SHEEN_OK);
    assert_non_null(strstr(k->warnings, "<scene> has no version: taken for 3.0.0"));
    assert_true(k->scene->materials[k->scene->shapes[0].material].eta.r == 0.0f); // a mirror
    kit_assert_v3(k->scene->shapes[0].sphere.center, v3(3, 0, 0), 0.0f);
    assert_non_null(strstr(k->warnings, "its first transform stands in"));
}

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
        KIT_TEST(curves_become_tubes),
        KIT_TEST(height_fields),
        KIT_TEST(textures_that_are_constant),
        KIT_TEST(versions_and_animations),
        KIT_TEST(sensors_of_all_kinds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
