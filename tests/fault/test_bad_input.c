// SPDX-License-Identifier: Apache-2.0
// Broken scenes: each gives one clear line with its place, the right status and no scene; doubtful ones a warning.
#include "image/image.h"
#include "io/mitsuba.h"
#include "io_kit.h"

static void missing_files(void **state)
{
    Kit *k = *state;
    kit_refused(k, "<shape type=\"obj\">\n<string name=\"filename\" value=\"no.obj\"/></shape>", SHEEN_ERR_IO,
                "scene.xml:3:1", "cannot open the mesh '");
    kit_refused(k,
                "<shape type=\"cube\"><bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\">\n"
                "  <string name=\"filename\" value=\"no.png\"/></texture></bsdf></shape>",
                SHEEN_ERR_IO, "scene.xml:3:3", "no.png'");
    kit_refused(k, "<emitter type=\"envmap\"><string name=\"filename\" value=\".\"/></emitter>", SHEEN_ERR_IO,
                "scene.xml:2:24", "cannot open the picture");
    kit_refused(k, "\n<include filename=\"no.xml\"/>", SHEEN_ERR_IO, "scene.xml:3:1", "no.xml'");
    kit_refused(k, "<shape type=\"ply\"/>", SHEEN_ERR_PARSE, "scene.xml:2:1", "has no 'filename'");
    kit_refused(k, "<emitter type=\"constant\"><spectrum name=\"radiance\" filename=\"no.spd\"/></emitter>",
                SHEEN_ERR_IO, "scene.xml:2:26", "cannot open the spectrum 'no.spd'");
    assert_int_equal(kit_load(k, "no.xml"), SHEEN_ERR_IO);
    assert_int_equal(k->n_errors, 1);
    assert_non_null(strstr(k->error, "no.xml: "));
    assert_int_equal(kit_load(k, "scene.blend"), SHEEN_ERR_UNSUPPORTED);
    assert_non_null(strstr(k->error, "scene.blend: "));
}

static void broken_files_name_themselves(void **state)
{
    Kit *k = *state;
    kit_write(k, "bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
    kit_refused(k, "<shape type=\"obj\"><string name=\"filename\" value=\"bad.obj\"/></shape>", SHEEN_ERR_PARSE,
                "bad.obj:4", "vertex index 4 is out of range: there are 3");
    kit_write(k, "bad.ply",
              "ply\nformat ascii 1.0\nelement vertex 100000000\nproperty float x\nproperty float y\n"
              "property float z\nend_header\n0 0 0\n");
    kit_refused(k, "<shape type=\"ply\"><string name=\"filename\" value=\"bad.ply\"/></shape>", SHEEN_ERR_PARSE,
                "bad.ply", "promises more");
    kit_write_bytes(k, "bad.serialized", "\x1c\x04\x04\x00not packed", 14);
    kit_refused(k, "<shape type=\"serialized\"><string name=\"filename\" value=\"bad.serialized\"/></shape>",
                SHEEN_ERR_PARSE, "bad.serialized", "mesh 0: its compressed data is damaged");
    kit_write(k, "bad.mtl", "newmtl a\nKd .5 .5 .5\nNs shiny\n");
    kit_write(k, "room.obj", "mtllib bad.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    assert_int_equal(kit_load(k, "room.obj"), SHEEN_ERR_PARSE);
    assert_int_equal(k->n_errors, 1);
    assert_non_null(strstr(k->error, "/bad.mtl:3: 'Ns' needs finite numbers"));
    kit_write(k, "bad.xml", "<scene version=\"3.0.0\">\n\n<shape></scene>");
    kit_refused(k, "<include filename=\"bad.xml\"/>", SHEEN_ERR_PARSE, "bad.xml:3:10", "mismatched tag");
    kit_write(k, "bad.png", "\x89PNG\r\n\x1a\n");
    assert_int_equal(
        kit_load_version(k, "3.0.0",
                         "<shape type=\"cube\"><bsdf type=\"diffuse\"><texture type=\"bitmap\" "
                         "name=\"reflectance\"><string name=\"filename\" value=\"bad.png\"/></texture></bsdf>"
                         "</shape>"),
        SHEEN_ERR_PARSE);
    assert_int_equal(k->n_errors, 1);
    assert_non_null(strstr(k->error, "bad.png"));
}

static void whole_text_refused(Kit *k, const char *text, const char *place, const char *what)
{
    char expected[512];
    kit_write(k, "whole.xml", text);
    assert_int_equal(kit_load(k, "whole.xml"), SHEEN_ERR_PARSE);
    assert_int_equal(k->n_errors, 1);
    snprintf(expected, sizeof expected, "%s/whole.xml:%s: ", k->folder, place);
    if (strncmp(k->error, expected, strlen(expected)) != 0 || !strstr(k->error, what))
        fail_msg("'%s' is not '%s...%s'", k->error, expected, what);
}

static void truncated_and_mistyped_xml(void **state)
{
    Kit *k = *state;
    whole_text_refused(k, "", "1:1", "no element found");
    whole_text_refused(k, "<scene version=\"3.0.0\">\n<shape type=\"cube\"/>\n", "3:1", "no element found");
    whole_text_refused(k, "<scene version=\"3.0.0\">\n<shape type=cube/></scene>", "2:13", "not well-formed");
    whole_text_refused(k, "<scene version=\"3.0.0\"><shape type=\"cube\"></scene>", "1:45", "mismatched tag");
    whole_text_refused(k, "<scene version=\"3.0.0\">\n  oops</scene>", "2:1",
                       "unexpected text between elements: 'oops'");
    whole_text_refused(k, "<scenery/>", "1:1", "not a Mitsuba scene");
    whole_text_refused(k, "\x01\x02garbage", "1:1", "not well-formed");
    // Every truncation of a scene is refused, each with one line.
    const char *text =
        "<scene version=\"3.0.0\"><shape type=\"sphere\"><float name=\"radius\" value=\"2\"/></shape></scene>";
    for (size_t n = 0; n < strlen(text); ++n) {
        int before = k->n_errors;
        SheenScene *scene = NULL;
        assert_int_equal(sheen_mitsuba_parse(text, n, "t", false, &k->log, &scene), SHEEN_ERR_PARSE);
        assert_int_equal(k->n_errors, before + 1);
        assert_null(scene);
    }
}

static void mistyped_values(void **state)
{
    Kit *k = *state;
    static const struct {
        const char *body, *place, *what;
    } cases[] = {
        {"<shape type=\"sphere\"><float name=\"radius\" value=\"wide\"/></shape>", "scene.xml:2:22",
         "not a finite number"},
        {"<shape type=\"sphere\"><float name=\"radius\" value=\"nan\"/></shape>", "scene.xml:2:22",
         "not a finite number"},
        {"<shape type=\"sphere\"><float name=\"radius\" value=\"1e999\"/></shape>", "scene.xml:2:22", "not a finite"},
        {"<shape type=\"sphere\"><float name=\"radius\"/></shape>", "scene.xml:2:22", "<float> has no 'value'"},
        {"<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"a\"/></shape>", "scene.xml:2:22", "'y' in <point>"},
        {"<shape type=\"cube\"><boolean name=\"flip_normals\" value=\"maybe\"/></shape>", "scene.xml:2:20",
         "neither true"},
        {"<emitter type=\"point\"><rgb name=\"intensity\" value=\"1 2\"/></emitter>", "scene.xml:2:23", "one or three"},
        {"<emitter type=\"point\"><rgb name=\"intensity\" value=\"inf\"/></emitter>", "scene.xml:2:23", "one or three"},
        {"<emitter type=\"point\"><rgb name=\"intensity\" value=\"1e39\"/></emitter>", "scene.xml:2:23", "not finite"},
        {"<emitter type=\"point\"><srgb name=\"intensity\" value=\"#12345\"/></emitter>", "scene.xml:2:23", "#rrggbb"},
        {"<emitter type=\"point\"><spectrum name=\"intensity\" value=\"400:1, 300:1\"/></emitter>", "scene.xml:2:23",
         "rising wavelengths"},
        {"<emitter type=\"point\"><spectrum name=\"intensity\" value=\"400:1, 500\"/></emitter>", "scene.xml:2:23",
         "rising wavelengths"},
        {"<emitter type=\"point\"><spectrum name=\"intensity\"/></emitter>", "scene.xml:2:23", "neither 'value' nor"},
        {"<emitter type=\"spot\"><float name=\"cutoff_angle\" value=\"-5\"/></emitter>", "scene.xml:2:1",
         "a spot needs"},
        {"<shape type=\"cube\"><transform name=\"to_world\"><matrix value=\"1 2 3\"/></transform></shape>",
         "scene.xml:2:47", "9 or 16"},
        {"<shape type=\"cube\"><transform name=\"to_world\"><scale value=\"1 2\"/></transform></shape>",
         "scene.xml:2:47", "three finite numbers"},
        {"<shape type=\"cube\"><transform name=\"to_world\"><rotate x=\"1\" angle=\"x\"/></transform></shape>",
         "scene.xml:2:47", "'angle'"},
        {"<shape type=\"cube\"><transform name=\"to_world\"><lookat origin=\"0,0,0\" "
         "target=\"0,0,0\"/></transform></shape>",
         "scene.xml:2:47", "target at its origin"},
        {"<shape type=\"cube\"><transform name=\"to_world\"><scale value=\"1e20\"/><scale "
         "value=\"1e20\"/></transform></shape>",
         "scene.xml:2:20", "overflows"},
        {"<shape type=\"cube\"><bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"jelly\"/></bsdf></shape>",
         "scene.xml:2:44", "nor the name of a medium: 'jelly'"},
        {"<shape type=\"cube\"><bsdf type=\"dielectric\"><float name=\"int_ior\" value=\"0\"/></bsdf></shape>",
         "scene.xml:2:44", "neither a positive number"},
        {"<sensor type=\"perspective\"><float name=\"fov\" value=\"180\"/></sensor>", "scene.xml:2:1", "field of view"},
        {"<sensor type=\"perspective\"><float name=\"fov\" value=\"45\"/><string name=\"fov_axis\" "
         "value=\"w\"/></sensor>",
         "scene.xml:2:1", "the axis 'w'"},
        {"<sensor type=\"perspective\"><string name=\"focal_length\" value=\"35 inch\"/></sensor>", "scene.xml:2:1",
         "focalLength"},
        {"<sensor type=\"perspective\"><transform name=\"to_world\"><scale x=\"0\"/></transform></sensor>",
         "scene.xml:2:1", "singular"},
        {"<shape type=\"cube\"><bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"scale\"/></bsdf></shape>",
         "scene.xml:2:41", "holds no texture"},
        {"<shape type=\"cube\"><bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"gridtexture\"><float "
         "name=\"line_width\" value=\"0.6\"/></texture></bsdf></shape>",
         "scene.xml:2:88", "0 to 0.5 wide"},
        {"<sensor type=\"thinlens\"><float name=\"fov\" value=\"40\"/><float name=\"aperture_radius\" "
         "value=\"-1\"/></sensor>",
         "scene.xml:2:1", "a lens needs"},
        {"<sensor type=\"thinlens\"><float name=\"fov\" value=\"40\"/><float name=\"focus_distance\" "
         "value=\"0\"/></sensor>",
         "scene.xml:2:1", "a lens needs"},
        {"<sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"crop_offset_x\" value=\"760\"/><integer "
         "name=\"crop_width\" value=\"9\"/></film></sensor>",
         "scene.xml:2:28", "the crop window does not lie"},
        {"<sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"crop_offset_y\" "
         "value=\"-1\"/></film></sensor>",
         "scene.xml:2:28", "the crop window does not lie"},
        {"<emitter type=\"sunsky\"><integer name=\"month\" value=\"13\"/></emitter>", "scene.xml:2:1",
         "in the calendar"},
        {"<emitter type=\"sky\"><vector name=\"sun_direction\"/></emitter>", "scene.xml:2:1",
         "the sun has no direction"},
        {"<emitter type=\"sky\"><transform name=\"to_world\"><scale value=\"0\"/></transform></emitter>",
         "scene.xml:2:1", "the transform of the sky is singular"},
        {"<default name=\"a\"/>", "scene.xml:2:1", "<default> needs"},
        {"<shape type=\"$kind\"/>", "scene.xml:2:1", "the parameter '$kind' is not defined"},
        {"<include/>", "scene.xml:2:1", "<include> needs"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i)
        kit_refused(k, cases[i].body, SHEEN_ERR_PARSE, cases[i].place, cases[i].what);
}

static void absurd_pictures(void **state)
{
    Kit *k = *state;
    static const struct {
        const char *width, *height, *place;
    } cases[] = {{"0", "10", "scene.xml:3:1"},
                 {"10", "0", "scene.xml:4:1"},
                 {"-5", "10", "scene.xml:3:1"},
                 {"65537", "10", "scene.xml:3:1"},
                 {"99999999999999999999", "10", "scene.xml:3:1"},
                 {"1.5", "10", "scene.xml:3:1"},
                 {"65536", "65536", "scene.xml:2:28"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char body[512];
        snprintf(body, sizeof body,
                 "<sensor type=\"perspective\"><film type=\"hdrfilm\">\n<integer name=\"width\" value=\"%s\"/>\n"
                 "<integer name=\"height\" value=\"%s\"/></film></sensor>",
                 cases[i].width, cases[i].height);
        kit_refused(k, body, SHEEN_ERR_PARSE, cases[i].place, "");
    }
}

static void references_that_lead_nowhere_or_in_circles(void **state)
{
    Kit *k = *state;
    kit_refused(k, "<shape type=\"cube\">\n <ref id=\"gone\"/></shape>", SHEEN_ERR_PARSE, "scene.xml:3:2",
                "no element has the id 'gone'");
    kit_refused(k,
                "<shape type=\"cube\"><ref id=\"a\"/></shape><bsdf type=\"twosided\" id=\"a\"><ref id=\"b\"/></bsdf>\n"
                "<bsdf type=\"mask\" id=\"b\"><ref id=\"a\"/></bsdf>",
                SHEEN_ERR_PARSE, "scene.xml:2:41", "the material refers to itself");
    kit_refused(k,
                "<shape type=\"cube\"><ref id=\"a\"/></shape><bsdf type=\"blendbsdf\" id=\"a\"><bsdf "
                "type=\"diffuse\"/>\n<bsdf type=\"bumpmap\"><texture type=\"checkerboard\"/><ref "
                "id=\"a\"/></bsdf></bsdf>",
                SHEEN_ERR_PARSE, "scene.xml:2:41", "the material refers to itself");
    char chain[8192] = "<shape type=\"cube\"><ref id=\"m0\"/></shape><bsdf type=\"diffuse\" id=\"m40\"/>\n";
    for (int i = 0; i < 40; ++i)
        snprintf(chain + strlen(chain), sizeof chain - strlen(chain),
                 "<bsdf type=\"mask\" id=\"m%d\"><ref id=\"m%d\"/></bsdf>\n", i, i + 1);
    kit_refused(k, chain, SHEEN_ERR_PARSE, "scene.xml:35:1", "more than 32 materials lie inside each other");
    kit_refused(k,
                "<shape type=\"cube\"><bsdf type=\"mixturebsdf\">\n<string name=\"weights\" value=\"1\"/><bsdf "
                "type=\"diffuse\"/><bsdf type=\"diffuse\"/></bsdf></shape>",
                SHEEN_ERR_PARSE, "scene.xml:2:20", "'weights' needs one number for each of 2 materials");
    kit_refused(
        k, "<shape type=\"cube\"><bsdf type=\"roughplastic\">\n<float name=\"alpha\" value=\"nan\"/></bsdf></shape>",
        SHEEN_ERR_PARSE, "scene.xml:3:1", "is not a finite number");
    kit_refused(k, "<shape type=\"cube\"><ref id=\"a\"/></shape><alias id=\"b\" as=\"a\"/><alias id=\"a\" as=\"b\"/>",
                SHEEN_ERR_PARSE, "scene.xml:2:20", "leads to itself");
    kit_refused(k,
                "<shape type=\"cube\"><bsdf type=\"diffuse\"><ref name=\"reflectance\" id=\"t\"/></bsdf></shape>\n"
                "<texture type=\"scale\" id=\"t\"><ref id=\"t\"/></texture>",
                SHEEN_ERR_PARSE, "scene.xml:3:1", "the texture refers to itself");
    kit_refused(k, "<shape type=\"cube\" id=\"x\"/>\n<shape type=\"cube\" id=\"x\"/>", SHEEN_ERR_PARSE, "scene.xml:3:1",
                "the id 'x' is given already at");
    kit_refused(k, "<shape type=\"instance\"/>", SHEEN_ERR_PARSE, "scene.xml:2:1", "an instance needs");
    kit_refused(k, "<shape type=\"instance\"><ref id=\"c\"/></shape><shape type=\"cube\" id=\"c\"/>", SHEEN_ERR_PARSE,
                "scene.xml:2:1", "an instance needs");
    // A material that nothing uses is not read, so its loop does no harm.
    kit_scene(k, "<bsdf type=\"mask\" id=\"b\"><ref id=\"b\"/></bsdf>");
}

static void cyclic_and_endless_includes(void **state)
{
    Kit *k = *state;
    kit_write(k, "a.xml", "<scene version=\"3.0.0\">\n<include filename=\"b.xml\"/></scene>");
    kit_write(k, "b.xml", "<scene version=\"3.0.0\">\n\n<include filename=\"./a.xml\"/></scene>");
    kit_refused(k, "<include filename=\"a.xml\"/>", SHEEN_ERR_PARSE, "b.xml:3:1", "cyclic include of");
    kit_refused(k, "<include filename=\"scene.xml\"/>", SHEEN_ERR_PARSE, "scene.xml:2:1", "cyclic include of");
    // The same file twice, one after the other, is no cycle; thousands of them are too many.
    kit_write(k, "c.xml", "<scene version=\"3.0.0\"><shape type=\"cube\"/></scene>");
    assert_int_equal(kit_scene(k, "<include filename=\"c.xml\"/><include filename=\"c.xml\"/>")->n_shapes, 2);
    char doubling[64], name[16];
    for (int i = 0; i < 12; ++i) { // 2^12 files
        snprintf(name, sizeof name, "d%d.xml", i);
        snprintf(doubling, sizeof doubling, "<include filename=\"d%d.xml\"/>", i + 1);
        char text[256];
        snprintf(text, sizeof text, "<scene version=\"3.0.0\">%s%s</scene>", doubling, doubling);
        kit_write(k, name, text);
    }
    kit_write(k, "d12.xml", "<scene version=\"3.0.0\"/>");
    assert_int_equal(kit_load_version(k, "3.0.0", "<include filename=\"d0.xml\"/>"), SHEEN_ERR_PARSE);
    assert_int_equal(k->n_errors, 1);
    assert_non_null(strstr(k->error, "too many includes"));
}

static void bombs(void **state)
{
    Kit *k = *state;
    whole_text_refused(k,
                       "<!DOCTYPE scene [\n<!ENTITY a \"aaaaaaaaaa\">\n<!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">\n"
                       "]>\n<scene version=\"3.0.0\">&b;</scene>",
                       "2:12", "the entity 'a' is declared");
    whole_text_refused(k, "<!DOCTYPE scene [<!ENTITY a SYSTEM \"/etc/passwd\">]><scene version=\"3.0.0\">&a;</scene>",
                       "1:49", "the entity 'a' is declared");
    // A document type without entities is harmless.
    kit_write(k, "plain.xml", "<!DOCTYPE scene><scene version=\"3.0.0\"><shape type=\"cube\"/></scene>");
    assert_int_equal(kit_load(k, "plain.xml"), SHEEN_OK);
    // Parameters double thirty times.
    char body[4096] = "<default name=\"p0\" value=\"xxxxxxxxxx\"/>";
    for (int i = 0; i < 30; ++i) {
        size_t n = strlen(body);
        snprintf(body + n, sizeof body - n, "\n<default name=\"p%d\" value=\"$p%d$p%d\"/>", i + 1, i, i);
    }
    assert_int_equal(kit_load_version(k, "3.0.0", body), SHEEN_ERR_PARSE);
    assert_non_null(strstr(k->error, "an attribute grows beyond 65536 bytes"));
    // Elements nested far too deep, also by way of includes.
    char deep[8192] = "";
    for (int i = 0; i < 500; ++i) strcat(deep, "<shape>");
    assert_int_equal(kit_load_version(k, "3.0.0", deep), SHEEN_ERR_PARSE);
    assert_non_null(strstr(k->error, "nested more than 64 deep"));
    kit_write(k, "half.xml",
              "<s><a><a><a><a><a><a><a><a><a><a><a><a><a><a><a><a><a><a><a><a><a><a><a><a><a><a><a><a><a>"
              "<a><a><a><a/></a></a></a></a></a></a></a></a></a></a></a></a></a></a></a></a></a></a></a></a>"
              "</a></a></a></a></a></a></a></a></a></a></a></a></a></s>");
    deep[0] = '\0';
    for (int i = 0; i < 40; ++i) strcat(deep, "<shape>");
    strcat(deep, "<include filename=\"half.xml\"/>");
    for (int i = 0; i < 40; ++i) strcat(deep, "</shape>");
    assert_int_equal(kit_load_version(k, "3.0.0", deep), SHEEN_ERR_PARSE);
    assert_non_null(strstr(k->error, "half.xml:1:"));
    assert_non_null(strstr(k->error, "nested more than 64 deep"));
}

static void bad_triangles_are_left_out_with_a_warning(void **state)
{
    Kit *k = *state;
    kit_write(k, "t.obj",
              "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 0 inf 0\nv 2 0 0\n"
              "f 1 2 3\nf 1 2 4\nf 1 5 3\nf 1 2 6\nf 1 1 1\n");
    const SheenScene *s = kit_scene(k, "<shape type=\"obj\"><string name=\"filename\" value=\"t.obj\"/></shape>");
    assert_int_equal(s->n_triangles, 1);
    assert_non_null(strstr(k->warnings, "t.obj: 4 of 5 triangles have no area or a non-finite vertex"));
    for (uint32_t i = 0; i < 3; ++i) kit_assert_v3(s->shapes[0].mesh.n[i], v3(0, 0, 1), 1e-6f);
    assert_float_equal(s->bounds.hi.x, 1.0f, 0.0f);
}

static void scenes_without_anything_get_defaults(void **state)
{
    Kit *k = *state;
    const SheenScene *s = kit_scene(k, "");
    assert_int_equal(s->n_cameras, 1);
    assert_int_equal(s->n_shapes, 0);
    assert_int_equal(k->n_warnings, 2);
    assert_non_null(strstr(k->warnings, "the scene has no light"));
    assert_non_null(strstr(k->warnings, "the scene has no camera"));
    kit_write(k, "bare.xml", "<scene><shape type=\"cube\"/></scene>");
    assert_int_equal(kit_load(k, "bare.xml"), SHEEN_OK);
    assert_non_null(strstr(k->warnings, "bare.xml:1:1: <scene> has no version"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        KIT_TEST(missing_files),
        KIT_TEST(broken_files_name_themselves),
        KIT_TEST(truncated_and_mistyped_xml),
        KIT_TEST(mistyped_values),
        KIT_TEST(absurd_pictures),
        KIT_TEST(references_that_lead_nowhere_or_in_circles),
        KIT_TEST(cyclic_and_endless_includes),
        KIT_TEST(bombs),
        KIT_TEST(bad_triangles_are_left_out_with_a_warning),
        KIT_TEST(scenes_without_anything_get_defaults),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
