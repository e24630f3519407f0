// SPDX-License-Identifier: Apache-2.0
// Mitsuba scenes of several files: where they are looked for, parameters from outside, and XML as people write it.
#include "io_kit.h"

#include <sys/stat.h>

static void make_folder(const Kit *k, const char *name)
{
    char path[256];
    kit_path(k, name, path);
    assert_int_equal(mkdir(path, 0700), 0);
}

static SheenStatus load_with(Kit *k, const char *name, const char *const defines[], size_t n)
{
    char path[256];
    kit_reset(k);
    kit_path(k, name, path);
    return sheen_scene_load_with(path, (SheenDefines){defines, n}, &k->log, &k->scene);
}

static Rgb reflectance_of_first(const Kit *k)
{
    return sheen_texture_mean(&k->scene->materials[k->scene->shapes[0].material].reflectance);
}

// ---- folders ----------------------------------------------------------------------------------------------------

static const char triangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/** As in Mitsuba: what an include names is looked for from the scene's folder, and from each <path>. */
static void files_are_found_in_the_folders_of_the_scene(void **state)
{
    Kit *k = *state;
    make_folder(k, "parts");
    make_folder(k, "materials");
    make_folder(k, "common");
    kit_write(k, "materials/red.xml",
              "<scene version=\"3.0.0\"><bsdf type=\"diffuse\" id=\"m\">"
              "<spectrum name=\"reflectance\" filename=\"s.spd\"/></bsdf></scene>");
    kit_write(k, "common/s.spd", "300 0.25\n900 0.25\n");
    kit_write(k, "common/t.obj", triangle);
    kit_write(k, "parts/here.obj", triangle);
    kit_write(
        k, "parts/m.xml",
        "<scene version=\"3.0.0\"><default name=\"folder\" value=\"materials\"/>"
        "<include filename=\"$folder/red.xml\"/>"
        "<shape type=\"obj\"><string name=\"filename\" value=\"t.obj\"/><ref id=\"m\"/></shape>"
        "<shape type=\"obj\"><string name=\"filename\" value=\"here.obj\"/><ref id=\"m\"/></shape>"
        "<shape type=\"obj\"><string name=\"filename\" value=\"parts\\here.obj\"/><ref id=\"m\"/></shape></scene>");
    const SheenScene *s = kit_scene(k, "<path value=\"common\"/><include filename=\"parts/m.xml\"/>");
    assert_int_equal(s->n_shapes, 3);
    kit_assert_rgb(reflectance_of_first(k), rgb_gray(0.25f), 1e-3f);
    assert_null(strstr(k->warnings, "folder"));
    assert_int_equal(kit_load_version(k, "3.0.0", "<path value=\"none\"/>"), SHEEN_OK);
    assert_non_null(strstr(k->warnings, "scene.xml:2:1: the folder '"));
    kit_refused(k, "<path/>", SHEEN_ERR_PARSE, "scene.xml:2:1", "<path> needs 'value'");
    kit_refused(k, "<include filename=\"parts/none.xml\"/>", SHEEN_ERR_IO, "scene.xml:2:1", "cannot open");
}

static void the_folder_of_the_scene_goes_before_that_of_the_include(void **state)
{
    Kit *k = *state;
    make_folder(k, "parts");
    kit_write(k, "s.spd", "300 0.25\n900 0.25\n");
    kit_write(k, "parts/s.spd", "300 0.75\n900 0.75\n");
    // An include may be one element, without a scene around it.
    kit_write(k, "parts/shape.xml",
              "<shape type=\"sphere\"><bsdf type=\"diffuse\"><spectrum name=\"reflectance\" filename=\"s.spd\"/></bsdf>"
              "</shape>");
    kit_scene(k, "<include filename=\"parts/shape.xml\"/>");
    kit_assert_rgb(reflectance_of_first(k), rgb_gray(0.25f), 1e-3f);
    kit_scene(k, "<path value=\"parts/\"/><include filename=\"shape.xml\"/>");
    kit_assert_rgb(reflectance_of_first(k), rgb_gray(0.75f), 1e-3f);
}

// ---- parameters -------------------------------------------------------------------------------------------------

static void parameters_from_outside(void **state)
{
    Kit *k = *state;
    kit_write(k, "s.xml",
              "<scene version=\"3.0.0\"><default name=\"r\" value=\"1\"/><default name=\"unused\" value=\"1\"/>"
              "<shape type=\"sphere\"><float name=\"radius\" value=\"$r$tail\"/></shape></scene>");
    const char *const both[] = {"r=2", "tail="}, *const more[] = {"tail=.5=", "tail=.5", "other=a=b"},
                      *const bad[] = {"r 2"}, *const empty[] = {"=2"};
    assert_int_equal(load_with(k, "s.xml", both, 2), SHEEN_OK);
    assert_float_equal(k->scene->shapes[0].sphere.radius, 2.0f, 0.0f);
    assert_null(strstr(k->warnings, "refers"));
    // The last counts, and what nobody asks for is named.
    assert_int_equal(load_with(k, "s.xml", more, 3), SHEEN_OK);
    assert_float_equal(k->scene->shapes[0].sphere.radius, 1.5f, 0.0f);
    assert_non_null(strstr(k->warnings, "s.xml: nothing refers to $other\n"));
    assert_null(strstr(k->warnings, "$tail"));
    assert_int_equal(load_with(k, "s.xml", bad, 1), SHEEN_ERR_INVALID);
    assert_int_equal(load_with(k, "s.xml", empty, 1), SHEEN_ERR_INVALID);
    assert_int_equal(load_with(k, "s.xml", NULL, 0), SHEEN_ERR_PARSE);
    assert_non_null(strstr(k->error, "the parameter '$tail' is not defined"));
    kit_write(k, "s.obj", triangle);
    assert_int_equal(load_with(k, "s.obj", both, 1), SHEEN_OK);
    assert_non_null(strstr(k->warnings, "'r=2': a scene in this format has no parameters"));
}

// ---- XML --------------------------------------------------------------------------------------------------------

static const char plain[] = "<scene version=\"3.0.0\"><shape type=\"sphere\"/></scene>";

static void xml_as_people_write_it(void **state)
{
    Kit *k = *state;
    static const char *const good[] = {
        "\xEF\xBB\xBF<?xml version='1.0'?><scene version='3.0.0'><shape type='sphere'/></scene>",
        "<?xml version=\"1.0\" encoding=\"windows-1252\"?><!-- \xE4 --><scene version=\"3.0.0\">"
        "<shape type=\"sphere\" id=\"\xE4\"/></scene>",
        "<!DOCTYPE scene SYSTEM \"scene.dtd\"><scene version=\"3.0.0\"><shape type=\"sphere\"/></scene>",
        "<scene version=\"3.0.0\">\r\n<![CDATA[ \n ]]><!-- a <b> - comment -->\n<shape type='sphere'>"
        "<boolean name=\"flip_normals\" value=\" true\n\"/><integer name=\"unused\" value=\" 1 "
        "\"/></shape></scene>\n\n",
        "<scene version=\"3.0.0\"><shape type=\"sphere\" id=\"a &amp; &#98;\"/></scene>",
    };
    for (size_t i = 0; i < sizeof good / sizeof *good; ++i) {
        kit_write(k, "scene.xml", good[i]);
        SheenStatus s = kit_load(k, "scene.xml");
        if (s) fail_msg("%zu: %s", i, k->error);
        assert_int_equal(k->scene->n_shapes, 1);
    }
    char wide[2 * sizeof plain] = "\xFF\xFE"; // UTF-16
    for (size_t i = 0; plain[i]; ++i) wide[2 + 2 * i] = plain[i];
    kit_write_bytes(k, "scene.xml", wide, 2 * sizeof plain);
    assert_int_equal(kit_load(k, "scene.xml"), SHEEN_OK);
    static const char *const bad[] = {
        "<!DOCTYPE scene [<!ENTITY a \"b\">]><scene version=\"3.0.0\"/>",
        "<!DOCTYPE scene [<!ENTITY a SYSTEM \"/etc/passwd\">]><scene version=\"3.0.0\">&a;</scene>",
        "<!DOCTYPE scene [<!ENTITY % p SYSTEM \"x\"> %p;]><scene version=\"3.0.0\"/>",
        "<scene version=\"3.0.0\">&nothing;</scene>",
        "<scene version=\"3.0.0\"><![CDATA[text]]></scene>",
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        kit_write(k, "scene.xml", bad[i]);
        if (kit_load(k, "scene.xml") != SHEEN_ERR_PARSE) fail_msg("%zu: taken", i);
        assert_int_equal(k->n_errors, 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        KIT_TEST(files_are_found_in_the_folders_of_the_scene),
        KIT_TEST(the_folder_of_the_scene_goes_before_that_of_the_include),
        KIT_TEST(parameters_from_outside),
        KIT_TEST(xml_as_people_write_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
