// SPDX-License-Identifier: Apache-2.0
// The hash of a scene: the same for the same light, another for each number that light depends on.
#include "io_kit.h"

#include "image/image.h"
#include "scene/scene_hash.h"

enum { BODY_MAX = 8192, VARIANTS_MAX = 128 };

static const char body[] =
    "<sensor type=\"perspective\" id=\"eye\"><float name=\"fov\" value=\"40\"/><film type=\"hdrfilm\">"
    "<integer name=\"width\" value=\"32\"/></film><sampler type=\"independent\"><integer name=\"sample_count\" "
    "value=\"4\"/></sampler></sensor>"
    "<bsdf type=\"roughconductor\" id=\"steel\"><float name=\"alpha\" value=\"0.3\"/></bsdf>"
    "<bsdf type=\"principled\" id=\"paint\"><float name=\"metallic\" value=\"0.5\"/></bsdf>"
    "<bsdf type=\"plastic\" id=\"toy\"><float name=\"int_ior\" value=\"1.5\"/></bsdf>"
    "<shape type=\"obj\" id=\"first\"><string name=\"filename\" value=\"a.obj\"/><ref id=\"steel\"/></shape>"
    "<shape type=\"sphere\"><point name=\"center\" x=\"2\" y=\"0\" z=\"1\"/><float name=\"radius\" value=\"0.75\"/>"
    "<ref id=\"paint\"/></shape>"
    "<shape type=\"disk\"><transform name=\"to_world\"><translate x=\"7\"/></transform><ref id=\"toy\"/></shape>"
    "<shape type=\"shapegroup\" id=\"group\"><shape type=\"cube\"><bsdf type=\"diffuse\"><texture type=\"bitmap\" "
    "name=\"reflectance\"><string name=\"filename\" value=\"a.pfm\"/><string name=\"wrap_mode\" value=\"repeat\"/>"
    "</texture></bsdf></shape></shape>"
    "<shape type=\"instance\"><ref id=\"group\"/><transform name=\"to_world\"><translate x=\"3\"/></transform>"
    "</shape>"
    "<emitter type=\"spot\"><rgb name=\"intensity\" value=\"1 2 3\"/><float name=\"cutoff_angle\" value=\"20\"/>"
    "</emitter>"
    "<emitter type=\"directional\"><vector name=\"direction\" x=\"0\" y=\"-1\" z=\"0.5\"/></emitter>"
    "<emitter type=\"envmap\"><string name=\"filename\" value=\"b.pfm\"/><float name=\"scale\" value=\"2\"/></emitter>";

static void write_picture(const Kit *k, const char *name, float value)
{
    char path[256];
    Rgb pixels[8];
    for (int i = 0; i < 8; ++i) pixels[i] = rgb(0.1f * (float)i, 0.5f, value);
    SheenImageView view = {.width = 4, .height = 2, .pixels = pixels};
    kit_path(k, name, path);
    assert_int_equal(sheen_image_write(path, &view, 0.0f, NULL), SHEEN_OK);
}

static void write_files(const Kit *k)
{
    static const char obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1/1 2/2/1 3/3/1\n";
    kit_write(k, "a.obj", obj);
    kit_write(k, "same.obj", obj);
    kit_write(k, "moved.obj", "v 0 0 0\nv 1 0 0.125\nv 0 1 0\nvn 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1/1 2/2/1 3/3/1\n");
    kit_write(k, "bent.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 1 1\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1/1 2/2/1 3/3/1\n");
    kit_write(k, "shifted.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nvt 1 .5\nvt 0 1\nf 1/1/1 2/2/1 3/3/1\n");
    kit_write(k, "turned.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nf 2/2/1 3/3/1 1/1/1\n");
    write_picture(k, "a.pfm", 0.25f);
    write_picture(k, "b.pfm", 0.5f);
    write_picture(k, "same.pfm", 0.25f);
    write_picture(k, "other.pfm", 0.26f);
}

// Hash of the scene with one piece of its text replaced.
static uint64_t hash_with(Kit *k, const char *from, const char *to)
{
    static char text[BODY_MAX];
    const char *at = strstr(body, from);
    assert_non_null(at);
    assert_null(strstr(at + 1, from)); // the piece is met once
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - body), body, to, at + strlen(from));
    return sheen_scene_hash(kit_scene(k, text));
}

static void test_same_light(void **state)
{
    Kit *k = *state;
    write_files(k);
    uint64_t base = sheen_scene_hash(kit_scene(k, body));
    assert_true(sheen_scene_hash(k->scene) == base);
    static const char *const changes[][2] = {
        {"value=\"40\"", "value=\"41\""},                                 // the camera
        {"value=\"32\"", "value=\"64\""},                                 // the film
        {"value=\"4\"", "value=\"16\""},                                  // its samples
        {"id=\"first\"", "id=\"second\""},                                // names
        {"id=\"eye\"", "id=\"ear\""},      {"\"a.obj\"", "\"same.obj\""}, // files
        {"\"a.pfm\"", "\"same.pfm\""},
    };
    for (size_t i = 0; i < sizeof changes / sizeof *changes; ++i)
        if (hash_with(k, changes[i][0], changes[i][1]) != base) fail_msg("%s counts", changes[i][1]);
    char from[256], to[256];
    kit_scene(k, body);
    kit_path(k, "scene.xml", from);
    kit_path(k, "moved.xml", to);
    assert_int_equal(rename(from, to), 0);
    assert_int_equal(kit_load(k, "moved.xml"), SHEEN_OK);
    assert_true(sheen_scene_hash(k->scene) == base);
}

static void test_other_light(void **state)
{
    Kit *k = *state;
    write_files(k);
    static const char *const changes[][2] = {
        {"\"a.obj\"", "\"moved.obj\""},
        {"\"a.obj\"", "\"bent.obj\""},
        {"\"a.obj\"", "\"shifted.obj\""},
        {"\"a.obj\"", "\"turned.obj\""},
        {"x=\"2\"", "x=\"2.0000002\""},
        {"value=\"0.75\"", "value=\"0.76\""},
        {"<ref id=\"paint\"/>", "<ref id=\"toy\"/>"},
        {"<ref id=\"paint\"/>", "<ref id=\"paint\"/><boolean name=\"flip_normals\" value=\"true\"/>"},
        {"<ref id=\"paint\"/>", "<ref id=\"paint\"/><emitter type=\"area\"/>"},
        {"x=\"7\"", "x=\"8\""},
        {"x=\"3\"", "x=\"4\""},
        {"<emitter type=\"spot\">", "<shape type=\"instance\"><ref id=\"group\"/></shape><emitter type=\"spot\">"},
        {"<emitter type=\"spot\">", "<shape type=\"cube\"/><emitter type=\"spot\">"},
        {"value=\"0.3\"", "value=\"0.31\""},
        {"type=\"roughconductor\"", "type=\"roughdielectric\""},
        {"value=\"0.5\"", "value=\"0.51\""},
        {"value=\"1.5\"", "value=\"1.51\""},
        {"<float name=\"int_ior\"", "<boolean name=\"nonlinear\" value=\"true\"/><float name=\"int_ior\""},
        {"\"a.pfm\"", "\"other.pfm\""},
        {"value=\"repeat\"", "value=\"mirror\""},
        {"value=\"1 2 3\"", "value=\"1 2 3.1\""},
        {"value=\"20\"", "value=\"21\""},
        {"y=\"-1\"", "y=\"-2\""},
        {"\"b.pfm\"", "\"other.pfm\""},
        {"<float name=\"scale\" value=\"2\"/>", "<float name=\"scale\" value=\"3\"/>"},
        {"<float name=\"scale\" value=\"2\"/>",
         "<float name=\"scale\" value=\"2\"/><transform name=\"to_world\"><rotate y=\"1\" angle=\"5\"/></transform>"},
    };
    enum { N = sizeof changes / sizeof *changes };
    uint64_t hashes[N + 1];
    hashes[N] = sheen_scene_hash(kit_scene(k, body));
    for (size_t i = 0; i < N; ++i) hashes[i] = hash_with(k, changes[i][0], changes[i][1]);
    for (size_t i = 0; i <= N; ++i)
        for (size_t j = 0; j < i; ++j)
            if (hashes[i] == hashes[j]) fail_msg("no difference: %s", changes[j][1]);
}

static void assert_all_differ(const uint64_t hashes[], size_t n)
{
    for (size_t i = 0; i < n; ++i)
        for (size_t j = 0; j < i; ++j)
            if (hashes[i] == hashes[j]) fail_msg("variants %zu and %zu are the same", j, i);
}

// Members of lights and shapes that the text above does not reach.
static void test_members_of_lights_and_shapes(void **state)
{
    (void)state;
    Rgb colors[3] = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    Vec3 p[4] = {0};
    uint32_t triangles[1][3] = {{0, 1, 2}};
    uint8_t bytes[6] = {1, 2, 3, 4, 5, 6};
    float decode[256] = {0};
    SheenTexture texture = {.bitmap = {.width = 2, .height = 1, .bytes = bytes, .decode = decode}};
    SheenLight light = {.kind = SHEEN_LIGHT_SPOT};
    SheenShape shape = {
        .mesh = {.n_vertices = 3, .n_triangles = 1, .p = p, .triangles = (const uint32_t(*)[3])triangles}};
    SheenGroup group = {0};
    SheenInstance instance = {.group = 1};
    SheenScene scene = {.lights = &light,
                        .n_lights = 1,
                        .shapes = &shape,
                        .n_shapes = 1,
                        .groups = &group,
                        .n_groups = 1,
                        .instances = &instance,
                        .n_instances = 1,
                        .environment = SHEEN_NONE};
    uint64_t seen[VARIANTS_MAX];
    size_t n = 0;
    seen[n++] = sheen_scene_hash(&scene);
#define CHANGE(what) (what, seen[n++] = sheen_scene_hash(&scene))
    CHANGE(light.texture = &texture);
    CHANGE(bytes[4] = 7);
    CHANGE(decode[255] = 1.0f);
    CHANGE(texture.bitmap.height = 0);
    CHANGE(light.kind = SHEEN_LIGHT_POINT);
    CHANGE(light.shape = 1);
    CHANGE(light.position.y = 1.0f);
    CHANGE(light.direction.y = 1.0f);
    CHANGE(light.cos_inner = 1.0f);
    CHANGE(light.cos_outer = 1.0f);
    CHANGE(light.disk = 1.0f);
    CHANGE(light.tan_x = 1.0f);
    CHANGE(light.tan_y = 1.0f);
    CHANGE(scene.environment = 0);
    CHANGE(instance.group = 2);
    CHANGE(group.n_shapes = 1);
    CHANGE(group.first_shape = 1);
    CHANGE(shape.light = 3);
    CHANGE(shape.material = 3);
    CHANGE(shape.mesh.color = colors);
    CHANGE((shape.mesh.color = NULL, shape.mesh.face_color = colors));
    CHANGE(colors[0].b = 2.0f);
    CHANGE(triangles[0][2] = 0);
    CHANGE((shape.mesh.face_color = NULL, shape.mesh.n = p));
    CHANGE((shape.kind = SHEEN_SHAPE_DISK, shape.disk = (SheenDisk){.du = {1, 0, 0}}));
    CHANGE(shape.disk.du.x = 3.0f);
    CHANGE(shape.disk.dv.x = 3.0f);
    CHANGE(shape.disk.n.x = 3.0f);
    CHANGE(shape.disk.center.x = 3.0f);
    CHANGE((shape.kind = SHEEN_SHAPE_SPHERE, shape.sphere = (SheenSphere){.radius = 1.0f}));
    CHANGE(shape.sphere.frame.n.z = 1.0f);
    CHANGE(shape.sphere.flip = true);
#undef CHANGE
    assert_all_differ(seen, n);
}

// Members of materials that few kinds of text reach: each alone makes another hash.
static void test_each_member_of_a_material(void **state)
{
    (void)state;
    SheenMaterial m = {.kind = SHEEN_MATERIAL_DIFFUSE, .name = "m"};
    SheenScene scene = {.name = "s", .materials = &m, .n_materials = 1, .environment = SHEEN_NONE};
    SheenLafortune lobe = {.c = v3(1, 2, 3), .exponent = 4.0f, .weight = rgb_gray(5.0f)};
    SheenPrincipled principled = {0};
    uint64_t seen[VARIANTS_MAX];
    size_t n = 0;
#define VARY(member, value)                                                                                            \
    do {                                                                                                               \
        SheenMaterial keep = m;                                                                                        \
        m.member = value;                                                                                              \
        seen[n++] = sheen_scene_hash(&scene);                                                                          \
        m = keep;                                                                                                      \
    } while (0)
    VARY(kind, SHEEN_MATERIAL_DIFFUSE); // as it is
    VARY(kind, SHEEN_MATERIAL_WARD);
    VARY(two_sided, true);
    VARY(nonlinear, true);
    VARY(fast, true);
    VARY(turn_normals, true);
    VARY(shadow_normals, true);
    VARY(reflectance.value.g, 0.5f);
    VARY(reflectance.value2.g, 0.5f);
    VARY(reflectance.scale.b, 0.5f);
    VARY(reflectance.kind, SHEEN_TEXTURE_GRID);
    VARY(reflectance.nearest, true);
    VARY(reflectance.line_width, 0.5f);
    VARY(reflectance.wrap_u, SHEEN_WRAP_CLAMP);
    VARY(reflectance.wrap_v, SHEEN_WRAP_CLAMP);
    VARY(reflectance.uv[1][2], 0.5f);
    VARY(specular_reflectance.value.g, 0.5f);
    VARY(specular_transmittance.value.g, 0.5f);
    VARY(eta.r, 0.5f);
    VARY(k.r, 0.5f);
    VARY(ior, 0.5f);
    VARY(distribution, (SheenDistribution)1);
    VARY(alpha_u.value.g, 0.5f);
    VARY(alpha_v.value.g, 0.5f);
    VARY(exponent, 0.5f);
    VARY(ward, SHEEN_WARD_DUER);
    VARY(absorption.b, 0.5f);
    VARY(weight.value.g, 0.5f);
    VARY(map.value.g, 0.5f);
    VARY(map_scale, 0.5f);
    VARY(nested[0], 5);
    VARY(nested[1], 5);
    VARY(principled, &principled);
    principled.flatness.value.r = 1.0f;
    VARY(principled, &principled);
    principled.diff_trans.value.r = 1.0f;
    VARY(principled, &principled);
    m.n_lafortune = 1;
    VARY(lafortune, &lobe);
    lobe.exponent = 5.0f;
    VARY(lafortune, &lobe);
    lobe.c.y = 5.0f;
    VARY(lafortune, &lobe);
    lobe.weight.r = 6.0f;
    VARY(lafortune, &lobe);
#undef VARY
    assert_all_differ(seen, n);
    m.n_lafortune = 0;
    m.name = "another";
    m.n_lobes = 3;
    assert_true(sheen_scene_hash(&scene) == seen[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        KIT_TEST(test_same_light),
        KIT_TEST(test_other_light),
        cmocka_unit_test(test_members_of_lights_and_shapes),
        cmocka_unit_test(test_each_member_of_a_material),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
