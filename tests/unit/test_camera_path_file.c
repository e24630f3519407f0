// SPDX-License-Identifier: Apache-2.0
// Files of camera paths: what they tell and leave to the scene's camera, and one line with its place for every mistake.
#include "io/camera_path_file.h"
#include "io/json_place.h"

#include "io_kit.h"

static SheenCamera scene_camera(void)
{
    return (SheenCamera){.name = "scene",
                         .to_world = transform_look_at(v3(0, 0, 0), v3(0, -1, 1), v3(0, 1, 0)),
                         .fov_x = 0.7f,
                         .width = 8,
                         .height = 6};
}

static SheenStatus parse(Kit *k, const char *text, SheenCameraPath **path)
{
    SheenCamera base = scene_camera();
    kit_reset(k);
    return sheen_camera_path_parse(text, strlen(text), "path.json", &base, &k->log, path);
}

static void test_what_is_told_and_what_is_not(void **state)
{
    Kit *k = *state;
    SheenCameraPath *path;
    SheenCamera c;
    double first, last;
    assert_int_equal(parse(k,
                           "{\"keys\": [{\"frame\": 1, \"origin\": [1, 2, 3], \"target\": [1, 2, 9]},\n"
                           " {\"frame\": 2.5, \"origin\": [1e0, 2, 3.5], \"target\": [5, 2, 3.5],"
                           " \"up\": [0, 0, 2], \"fov\": 90}]}",
                           &path),
                     SHEEN_OK);
    assert_int_equal(k->n_errors + k->n_warnings, 0);
    sheen_camera_path_range(path, &first, &last);
    assert_true(first == 1.0 && last == 2.5);
    assert_int_equal(sheen_camera_path_at(path, 1.0, &c), SHEEN_CAMERA_FINE);
    assert_true(c.fov_x == 0.7f && c.to_world.m[2][3] == 3.0);
    kit_assert_v3(transform_vector(&c.to_world, v3(0, 1, 0)), v3(0, 1, 0), 1e-6f); // the scene's, which is level
    assert_int_equal(sheen_camera_path_at(path, 2.5, &c), SHEEN_CAMERA_FINE);
    assert_true(fabsf(c.fov_x - 0.5f * SHEEN_PI) < 1e-6f && c.to_world.m[2][3] == 3.5);
    kit_assert_v3(transform_vector(&c.to_world, v3(0, 1, 0)), v3(0, 0, 1), 1e-6f);
    kit_assert_v3(transform_vector(&c.to_world, v3(0, 0, 1)), v3(1, 0, 0), 1e-6f);
    sheen_camera_path_destroy(&path);
}

#define KEY "{\"frame\": 1, \"origin\": [0, 0, 0], \"target\": [0, 0, 1]}"

static void test_unknown_members_are_told_once(void **state)
{
    Kit *k = *state;
    SheenCameraPath *path;
    assert_int_equal(parse(k,
                           "{\"name\": \"x\", \"keys\": [\n"
                           "  {\"frame\": 1, \"roll\": 3, \"origin\": [0, 0, 0], \"target\": [0, 0, 1]},\n"
                           "  {\"frame\": 2, \"roll\": [\"frame\"], \"origin\": [0, 0, 0], \"target\": [0, 0, 1]}]}",
                           &path),
                     SHEEN_OK);
    assert_string_equal(k->warnings, "path.json:2:24: 'roll' is not known and is left out\n"
                                     "path.json:1:10: 'name' is not known and is left out\n");
    sheen_camera_path_destroy(&path);
}

static void test_mistakes_and_their_places(void **state)
{
    static const struct {
        const char *text, *want;
    } cases[] = {
        {"", "path.json:1:0: "},
        {"{\"keys\": [" KEY "}", "path.json:1:"},
        {"{\"keys\":\n [{\"frame\": 1, \"frame\": 2}]}", "path.json:2:"},
        {"{\"keys\": [{\"frame\": 1e999}]}", "path.json:1:"},
        {"[]", "path.json:1:1: a camera path is"},
        {"{}", "path.json:1:1: a camera path is"},
        {"{\n \"keys\": []}", "path.json:2:10: a camera path is"},
        {"{\"keys\": 3}", "path.json:1:10: a camera path is"},
        {"{\"keys\": [" KEY ",\n 3]}", "path.json:2:2: key 1: is not an object"},
        {"{\"keys\": [\n  {}]}", "path.json:2:3: key 0: 'frame' is missing"},
        {"{\"keys\": [{\"frame\": \"1\"}]}", "path.json:1:21: key 0: 'frame' is not a number"},
        {"{\"keys\": [{\"frame\": 1e10}]}", "path.json:1:21: key 0: 'frame' is not a number from"},
        {"{\"keys\": [{\"frame\": 1}]}", "path.json:1:11: key 0: 'origin' is missing"},
        {"{\"keys\": [{\"frame\": 1, \"origin\": [1, 2]}]}", "path.json:1:34: key 0: 'origin' is not three numbers"},
        {"{\"keys\": [{\"frame\": 1, \"origin\": [1, 2, 1e20]}]}", "path.json:1:34: key 0: 'origin' is not three"},
        {"{\"keys\": [{\"frame\": 1, \"origin\": [1, 2, null]}]}", "path.json:1:34: key 0: 'origin' is not three"},
        {"{\"keys\": [{\"frame\": 1, \"origin\": [1, 2, 3]}]}", "path.json:1:11: key 0: 'target' is missing"},
        {"{\"keys\": [{\"frame\": 1, \"origin\": [1, 2, 3], \"target\": [1, 2, 3]}]}",
         "path.json:1:55: key 0: the camera stands where it looks"},
        {"{\"keys\": [{\"frame\": 1, \"origin\": [1, 2, 3], \"target\": [1, 2, 4], \"up\": [0, 0, 1]}]}",
         "path.json:1:72: key 0: the camera has its up along its view"},
        {"{\"keys\": [{\"frame\": 1, \"origin\": [1, 2, 3], \"target\": [1, 2, 4], \"up\": [0, 0, 0]}]}",
         "path.json:1:72: key 0: the camera has its up along its view"},
        {"{\"keys\": [{\"frame\": 1, \"origin\": [1, 2, 3], \"target\": [1, 7, 3]}]}",
         "path.json:1:55: key 0: the camera has its up along its view"},
        {"{\"keys\": [{\"frame\": 1, \"fov\": 180, \"origin\": [1, 2, 3], \"target\": [1, 2, 4]}]}",
         "path.json:1:31: key 0: 'fov' is not a number from 0.001 to 179.9"},
        {"{\"keys\": [{\"fov\": 0, \"frame\": 1, \"origin\": [1, 2, 3], \"target\": [1, 2, 4]}]}",
         "path.json:1:19: key 0: 'fov' is not a number"},
        {"{\"keys\": [" KEY ",\n" KEY "]}", "path.json:2:11: key 1: frame 1 does not follow frame 1"},
        {"{\"keys\": [" KEY ",\n{\"frame\": -1, \"origin\": [0, 0, 0], \"target\": [0, 0, 1]}]}",
         "path.json:2:11: key 1: frame -1 does not follow frame 1"},
    };
    Kit *k = *state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        SheenCameraPath *path;
        SheenStatus s = parse(k, cases[i].text, &path);
        if (s != SHEEN_ERR_PARSE || k->n_errors != 1 || strncmp(k->error, cases[i].want, strlen(cases[i].want)) != 0)
            fail_msg("'%s'\nsaid '%s' instead of '%s'", cases[i].text, k->error, cases[i].want);
        assert_null(path);
    }
}

static void test_files(void **state)
{
    Kit *k = *state;
    SheenCameraPath *path;
    SheenCamera base = scene_camera();
    char name[256];
    kit_path(k, "path.json", name);
    assert_int_equal(sheen_camera_path_read(name, &base, &k->log, &path), SHEEN_ERR_IO);
    assert_int_equal(k->n_errors, 1);
    kit_write(k, "path.json", "{\"keys\": [" KEY "]}\n");
    assert_int_equal(sheen_camera_path_read(name, &base, &k->log, &path), SHEEN_OK);
    sheen_camera_path_destroy(&path);
}

// Names and brackets within strings, escapes, empty containers, and steps that lead nowhere.
static void test_places(void **state)
{
    (void)state;
    static const char text[] = " {\"a]\\\"\": [\"}\", {}, [],\n  {\"b\": 1, \"c\": [2]}],\n\"b\": 7}";
    static const struct {
        JsonStep steps[3];
        size_t n;
        JsonPlace want;
    } cases[] = {
        {{{0}}, 0, {1, 2}},
        {{{"b", 0}}, 1, {3, 6}},
        {{{"a]\\\"", 0}, {NULL, 0}}, 2, {1, 12}},
        {{{"a]\\\"", 0}, {NULL, 2}}, 2, {1, 21}},
        {{{"a]\\\"", 0}, {NULL, 3}, {"c", 0}}, 3, {2, 17}},
        {{{"a]\\\"", 0}, {NULL, 4}}, 2, {1, 11}}, // there is no fifth
        {{{"none", 0}, {NULL, 0}}, 2, {1, 2}},
        {{{NULL, 0}}, 1, {1, 2}}, // not an array
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        JsonPlace at = sheen_json_place(text, strlen(text), cases[i].steps, cases[i].n);
        if (at.line != cases[i].want.line || at.column != cases[i].want.column)
            fail_msg("case %zu: %d:%d", i, at.line, at.column);
    }
    JsonPlace at = sheen_json_place("", 0, cases[1].steps, 1);
    assert_true(at.line == 1 && at.column == 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        KIT_TEST(test_what_is_told_and_what_is_not),
        KIT_TEST(test_unknown_members_are_told_once),
        KIT_TEST(test_mistakes_and_their_places),
        KIT_TEST(test_files),
        cmocka_unit_test(test_places),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
