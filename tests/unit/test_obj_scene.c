// SPDX-License-Identifier: Apache-2.0
// OBJ files as scenes: libraries and where they are looked for, materials, lights, parts, defaults.
#include "image/image.h"
#include "io/mtl.h"
#include "io_kit.h"

static const char square[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

static const SheenScene *scene(Kit *k, const char *mtl, const char *obj)
{
    char text[4096];
    snprintf(text, sizeof text, "mtllib room.mtl\n%s%s", square, obj);
    if (mtl) kit_write(k, "room.mtl", mtl);
    kit_write(k, "room.obj", text);
    SheenStatus s = kit_load(k, "room.obj");
    if (s) fail_msg("%s", k->error);
    return k->scene;
}

/** The material that is described by `body`, below a first line. */
static const SheenMaterial *material_of(Kit *k, const char *first, const char *body)
{
    char mtl[1024];
    snprintf(mtl, sizeof mtl, "%snewmtl a\n%s\n", first, body);
    const SheenScene *s = scene(k, mtl, "usemtl a\nf 1/1 2/2 3/3\n");
    const SheenMaterial *m = &s->materials[s->shapes[0].material];
    assert_int_equal(s->n_materials, 1 + (m->kind == SHEEN_MATERIAL_MASK || m->kind == SHEEN_MATERIAL_NORMAL));
    assert_string_equal(m->name, "a");
    return m;
}

static const SheenMaterial *material(Kit *k, const char *body)
{
    return material_of(k, "", body);
}

static void parts_by_material_and_lamps_by_object(void **state)
{
    Kit *k = *state;
    const char *mtl = "newmtl wall\nKd .1 .2 .3\nnewmtl lamp\nKe 5 6 7\nnewmtl unused\nKd 1 1 1\n";
    const SheenScene *s = scene(k, mtl,
                                "usemtl wall\nf 1 2 3\no one\nusemtl lamp\nf 1 2 3 4\nusemtl wall\nf 1 3 4\n"
                                "o two\nusemtl lamp\nf 1 2 3\ng rest\nusemtl lamp\nf 2 3 4\n");
    assert_int_equal(s->n_materials, 2);
    assert_int_equal(s->n_shapes, 4); // the wall and three lamps
    assert_int_equal(s->n_lights, 3);
    assert_int_equal(s->shapes[0].mesh.n_triangles, 2);
    assert_int_equal(s->shapes[0].mesh.n_vertices, 4);
    assert_int_equal(s->shapes[1].mesh.n_triangles, 2);
    assert_int_equal(s->shapes[2].mesh.n_vertices, 3); // no more than it uses
    kit_assert_rgb(s->lights[2].radiance, rgb(5, 6, 7), 0.0f);
    kit_assert_rgb(s->materials[0].reflectance.value, rgb(0.1f, 0.2f, 0.3f), 1e-6f);
    assert_true(s->materials[0].two_sided);
    assert_null(s->shapes[0].mesh.n); // no smoothing group: flat
    assert_int_equal(k->n_warnings, 0);
    assert_int_equal(s->n_cameras, 1); // the format knows none: no cause for a warning
}

static void a_scene_without_lamps_has_a_sky(void **state)
{
    Kit *k = *state;
    const SheenScene *s = scene(k, "newmtl a\nKd 1 0 0\n", "usemtl a\nf 1 2 3\n");
    assert_int_equal(s->n_lights, 1);
    assert_int_equal(s->lights[0].kind, SHEEN_LIGHT_ENVIRONMENT);
    kit_assert_rgb(s->lights[0].radiance, rgb_gray(1.0f), 0.0f);
    assert_non_null(strstr(k->warnings, "room.obj: no material emits light (Ke): a uniform sky of radiance 1"));
}

static void materials_by_their_model_of_light(void **state)
{
    Kit *k = *state;
    const SheenMaterial *m = material(k, "Kd .2 .3 .4 # a comment\nKs .9 .9 .9\nNs 100\nNi 1.5\nd 1\nTr 0\nillum 1");
    assert_int_equal(m->kind, SHEEN_MATERIAL_DIFFUSE);
    kit_assert_rgb(m->reflectance.value, rgb(0.2f, 0.3f, 0.4f), 1e-6f);
    m = material(k, "Kd .01 .01 .01\nKs .95 .9 .8\nillum 5");
    assert_int_equal(m->kind, SHEEN_MATERIAL_CONDUCTOR);
    kit_assert_rgb(m->specular_reflectance.value, rgb(0.95f, 0.9f, 0.8f), 1e-6f);
    m = material(k, "Kd .8 .8 .8\nKs .5 .5 .5\nillum 3"); // more diffuse than a mirror
    assert_int_equal(m->kind, SHEEN_MATERIAL_DIFFUSE);
    m = material(k, "Kd 0 0 0\nKs .3 .3 .3\nTf .05 .1 .1\nNi 2.5\nillum 7");
    assert_int_equal(m->kind, SHEEN_MATERIAL_DIELECTRIC);
    assert_float_equal(m->ior, 2.5f, 0.0f);
    // In and out again leaves the hue of Tf.
    kit_assert_rgb(m->specular_transmittance.value, rgb(0.70710678f, 1, 1), 1e-6f);
    m = material(k, "illum 2\nNi 1.5\nd 0.0\nTf 1 1 1"); // clear
    assert_int_equal(m->kind, SHEEN_MATERIAL_DIELECTRIC);
    m = material(k, "illum 6\nTf .5 1 1");
    assert_int_equal(m->kind, SHEEN_MATERIAL_THIN_DIELECTRIC);
    kit_assert_rgb(m->specular_transmittance.value, rgb(0.5f, 1, 1), 1e-6f);
    m = material(k, "illum 4\nTf 1 1 1\nNi 1.0"); // as Maya writes what is opaque
    assert_int_equal(m->kind, SHEEN_MATERIAL_DIFFUSE);
    m = material(k, "Tr 1\nNi 1.33");
    assert_int_equal(m->kind, SHEEN_MATERIAL_DIELECTRIC);
    m = material(k, "d 1\nTr 1\nNi 1.33"); // d counts
    assert_int_equal(m->kind, SHEEN_MATERIAL_DIFFUSE);
    m = material(k, "Kd 2 -1 .5\nKa 20 20 20");
    kit_assert_rgb(m->reflectance.value, rgb(1, 0, 0.5f), 0.0f);
    m = material(k, "Kd .25");
    kit_assert_rgb(m->reflectance.value, rgb_gray(0.25f), 0.0f);
}

static void highlights_are_phong_lobes(void **state)
{
    Kit *k = *state;
    const SheenMaterial *m = material(k, "Kd .2 .3 .4\nKs .1 .2 .3\nNs 50");
    assert_int_equal(m->kind, SHEEN_MATERIAL_PHONG);
    assert_true(m->two_sided && m->exponent == 50.0f);
    kit_assert_rgb(m->reflectance.value, rgb(0.2f, 0.3f, 0.4f), 1e-6f);
    kit_assert_rgb(m->specular_reflectance.value, rgb(0.1f, 0.2f, 0.3f), 1e-6f);
    m = material(k, "Kd .8 .8 .8\nKs .8 .4 .8\nNs 9"); // more than all
    kit_assert_rgb(m->reflectance.value, rgb_gray(0.495f), 1e-6f);
    kit_assert_rgb(m->specular_reflectance.value, rgb(0.495f, 0.2475f, 0.495f), 1e-6f);
    assert_int_equal(material(k, "Kd .2 .2 .2\nKs .5 .5 .5\nNs 0")->kind, SHEEN_MATERIAL_DIFFUSE);
}

static void blender_and_its_principled_materials(void **state)
{
    Kit *k = *state;
    const char *blender = "# Blender 4.2.0 MTL File: 'None'\n";
    const SheenMaterial *m =
        material_of(k, blender, "Ns 250\nKa 1 1 1\nKd .1 .2 .3\nKs .5 .5 .5\nNi 1.45\nd 1\nillum 2");
    assert_int_equal(m->kind, SHEEN_MATERIAL_PRINCIPLED);
    assert_float_equal(m->alpha_u.value.r, 0.5f, 1e-6f); // 250 = 1000 (1 - 0.5)^2
    kit_assert_rgb(m->principled->metallic.value, rgb_gray(0), 0.0f);
    kit_assert_rgb(m->reflectance.value, rgb(0.1f, 0.2f, 0.3f), 1e-6f);
    m = material_of(k, blender, "Ns 1000\nKa .75 .75 .75\nKd .1 .2 .3\nKs .5 .5 .5\nillum 3");
    kit_assert_rgb(m->principled->metallic.value, rgb_gray(0.75f), 0.0f);
    assert_float_equal(m->alpha_u.value.r, 0.0f, 1e-6f);
    m = material_of(k, blender, "Kd .1 .2 .3\nNi 1.45\nd .25\nillum 9");
    assert_int_equal(m->kind, SHEEN_MATERIAL_MASK);
    m = material_of(k, blender, "Kd .1 .2 .3\nNi 1.45\nTf 1 1 1\nillum 6");
    assert_int_equal(m->kind, SHEEN_MATERIAL_DIELECTRIC);
    m = material(k, "Kd .1 .2 .3\nPr 0.2\nPm 0.3");
    assert_int_equal(m->kind, SHEEN_MATERIAL_PRINCIPLED);
    assert_float_equal(m->alpha_u.value.r, 0.2f, 1e-6f);
    kit_assert_rgb(m->principled->metallic.value, rgb_gray(0.3f), 1e-6f);
    m = material(k, "Kd .1 .2 .3\nPr 0.2\nPs 0.4\nPc 0.5\nPcr 0.6\naniso 0.7\nanisor 0.8");
    assert_float_equal(m->principled->sheen.value.r, 0.4f, 1e-6f);
    assert_float_equal(m->principled->clearcoat.value.r, 0.5f, 1e-6f);
    assert_float_equal(m->principled->clearcoat_gloss.value.r, 0.4f, 1e-6f);
    assert_float_equal(m->principled->anisotropic.value.r, 0.7f, 1e-6f);
}

/** A picture of one pixel, sRGB 188: about 0.5. */
static void write_pixel(Kit *k, const char *name)
{
    const Rgb half = rgb_gray(0.5f);
    const SheenImageView view = {.width = 1, .height = 1, .pixels = &half};
    char path[256];
    kit_path(k, name, path);
    assert_int_equal(sheen_image_write(path, &view, 0.0f, &k->log), SHEEN_OK);
}

/** Raw numbers, not colours; they take the place of the number beside them. */
static void pictures_of_roughness_and_metal(void **state)
{
    Kit *k = *state;
    write_pixel(k, "half.png");
    const SheenMaterial *m = material(k, "Kd .1 .2 .3\nPr 0.1\nmap_Pr -clamp on half.png\nmap_Pm half.png");
    assert_int_equal(m->kind, SHEEN_MATERIAL_PRINCIPLED);
    assert_float_equal(sheen_texture_mean(&m->alpha_u).g, 188.0f / 255.0f, 1e-3f);
    assert_float_equal(sheen_texture_mean(&m->principled->metallic).g, 188.0f / 255.0f, 1e-3f);
    assert_int_equal(m->alpha_u.wrap_v, SHEEN_WRAP_CLAMP);
    m = material(k, "Kd .1 .2 .3\nPr 0.1\nPm 0.6\nmap_Pr none.png\nmap_Pm none.png"); // with warnings
    assert_float_equal(m->alpha_u.value.g, 0.1f, 1e-6f);
    assert_float_equal(m->principled->metallic.value.g, 0.6f, 1e-6f);
    assert_non_null(strstr(k->warnings, "cannot open the picture 'none.png'"));
}

static void pictures_are_multiplied_by_the_colour(void **state)
{
    Kit *k = *state;
    write_pixel(k, "a b.png");
    const SheenMaterial *m = material(k, "Kd .5 .5 .5\nmap_Kd -o 0.25 0.5 -s 2 3 1 -clamp on -mm 0 1 a b.png  ");
    assert_int_equal(m->reflectance.kind, SHEEN_TEXTURE_BITMAP);
    assert_int_equal(m->reflectance.wrap_u, SHEEN_WRAP_CLAMP);
    assert_true(m->reflectance.uv[0][0] == 2.0f && m->reflectance.uv[1][1] == 3.0f);
    assert_true(m->reflectance.uv[0][2] == 0.25f && m->reflectance.uv[1][2] == 0.5f);
    const float eps = 0.005f; // 8 bits
    kit_assert_rgb(sheen_texture_eval(&m->reflectance, v2(0, 0)), rgb_gray(0.25f), eps);
    m = material(k, "Kd 1 .5 0\nmap_Kd C:\\textures\\a b.png"); // by its base name, and in colour
    kit_assert_rgb(sheen_texture_eval(&m->reflectance, v2(0, 0)), rgb(0.5f, 0.25f, 0), eps);
    m = material(k, "Kd 0 0 0\nmap_Kd a b.png"); // black means no colour is given
    kit_assert_rgb(sheen_texture_eval(&m->reflectance, v2(0, 0)), rgb_gray(0.5f), eps);
    m = material(k, "Kd .3 .3 .3\nmap_Kd no.png");
    assert_non_null(strstr(k->warnings, "room.mtl:1: cannot open the picture 'no.png'"));
    kit_assert_rgb(sheen_texture_eval(&m->reflectance, v2(0, 0)), rgb_gray(0.3f), 1e-6f);
}

static void what_is_partly_transparent_is_a_mask(void **state)
{
    Kit *k = *state;
    write_pixel(k, "half.png");
    const SheenMaterial *m = material(k, "Kd .1 .2 .3\nd 0.75\nTr 0.9");
    assert_int_equal(m->kind, SHEEN_MATERIAL_MASK);
    kit_assert_rgb(m->weight.value, rgb_gray(0.75f), 0.0f);
    kit_assert_rgb(k->scene->materials[m->nested[0]].reflectance.value, rgb(0.1f, 0.2f, 0.3f), 1e-6f);
    m = material(k, "d 0.5\nmap_d half.png"); // bytes are the share, not a colour: 188 / 255
    kit_assert_rgb(sheen_texture_eval(&m->weight, v2(0, 0)), rgb_gray(0.5f * 188.0f / 255.0f), 1e-5f);
    m = material(k, "map_Kd half.png\nmap_d half.png"); // its alpha, which it has not
    assert_int_equal(m->kind, SHEEN_MATERIAL_DIFFUSE);
}

/** A TGA file of 2 x 1 pixels, blue, green, red, alpha, from top left. */
static void write_tga(Kit *k, const char *name, uint8_t left_alpha, uint8_t right_alpha)
{
    const uint8_t bytes[18 + 8] = {0, 0, 2, 0,  0,    0,  0,   0,  0,          0,  0,   0,  2,
                                   0, 1, 0, 32, 0x28, 10, 100, 51, left_alpha, 10, 100, 51, right_alpha};
    kit_write_bytes(k, name, bytes, sizeof bytes);
}

static void alpha_channels_are_opacities(void **state)
{
    Kit *k = *state;
    write_tga(k, "leaf.tga", 0, 204);
    const char *const both[] = {"Kd 1 1 1\nmap_Kd leaf.tga\nmap_d leaf.tga", "map_d leaf.tga"};
    for (int i = 0; i < 2; ++i) {
        const SheenMaterial *m = material(k, both[i]);
        assert_int_equal(m->kind, SHEEN_MATERIAL_MASK);
        assert_true(rgb_is_black(sheen_texture_eval(&m->weight, v2(0.25f, 0.5f))));
        kit_assert_rgb(sheen_texture_eval(&m->weight, v2(0.75f, 0.5f)), rgb_gray(0.8f), 1e-6f);
        kit_assert_rgb(sheen_texture_eval(&m->weight, v2(0.5f, 0.5f)), rgb_gray(0.4f), 1e-6f); // bilinear
        if (i == 0) // the colours are read beside
            kit_assert_rgb(
                sheen_texture_eval(&k->scene->materials[m->nested[0]].reflectance, v2(0.25f, 0.5f)),
                rgb(sheen_srgb_decode(0.2f), sheen_srgb_decode(100.0f / 255.0f), sheen_srgb_decode(10.0f / 255.0f)),
                1e-5f);
    }
    write_tga(k, "leaf.tga", 255, 255); // opaque everywhere: then the numbers count
    const SheenMaterial *m = material(k, "map_d leaf.tga");
    assert_float_equal(rgb_luminance(sheen_texture_eval(&m->weight, v2(0.25f, 0.5f))),
                       rgb_luminance(rgb(0.2f, 100.0f / 255.0f, 10.0f / 255.0f)), 1e-6f);
    m = material(k, "map_Kd leaf.tga\nmap_d leaf.tga");
    assert_int_equal(m->kind, SHEEN_MATERIAL_DIFFUSE);
}

static void maps_of_normals(void **state)
{
    Kit *k = *state;
    write_pixel(k, "n.png");
    const SheenMaterial *m = material(k, "Kd .1 .2 .3\nnorm -bm 1 n.png");
    assert_int_equal(m->kind, SHEEN_MATERIAL_NORMAL);
    kit_assert_rgb(sheen_texture_eval(&m->map, v2(0, 0)), rgb_gray(188.0f / 255.0f), 1e-5f); // no colour
    kit_assert_rgb(k->scene->materials[m->nested[0]].reflectance.value, rgb(0.1f, 0.2f, 0.3f), 1e-6f);
    m = material_of(k, "# Blender 4.2.0\n", "map_Bump -bm 1.0 n.png");
    assert_int_equal(m->kind, SHEEN_MATERIAL_NORMAL);
    m = material(k, "map_Bump -bm 1.0 n.png");
    assert_int_equal(m->kind, SHEEN_MATERIAL_DIFFUSE);
    assert_non_null(strstr(k->warnings, "room.mtl:2: 'map_Bump' is not supported"));
    m = material(k, "norm no.png");
    assert_int_equal(m->kind, SHEEN_MATERIAL_DIFFUSE);
}

static void libraries_are_looked_for(void **state)
{
    Kit *k = *state;
    static const struct {
        const char *statement, *file; // of the library
        bool found;
    } cases[] = {
        {"mtllib a.mtl", "a.mtl", true},
        {"mtllib models/a.mtl", "a.mtl", true},
        {"mtllib C:\\models\\a.mtl\r", "a.mtl", true},
        {"mtllib my room.mtl ", "my room.mtl", true},
        {"mtllib no.mtl none\\ at\\ all.mtl my\\ room.mtl", "my room.mtl", true},
        {"mtllib no.mtl a.mtl", "a.mtl", true},
        {"mtllib no.mtl", "scene.mtl", true}, // the scene's own name
        {"", "scene.mtl", true},
        {"mtllib b.mtl", "a.mtl", false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char text[512], path[256];
        snprintf(text, sizeof text, "%s\n%susemtl red  \nf 1 2 3\n", cases[i].statement, square);
        kit_write(k, "scene.obj", text);
        kit_write(k, cases[i].file, "  newmtl  red\t\r\n\tKd 1 0 0\r\n");
        assert_int_equal(kit_load(k, "scene.obj"), SHEEN_OK);
        Rgb want = cases[i].found ? rgb(1, 0, 0) : rgb_gray(0.5f);
        kit_assert_rgb(k->scene->materials[0].reflectance.value, want, 0.0f);
        kit_path(k, cases[i].file, path);
        assert_int_equal(remove(path), 0);
    }
    assert_non_null(strstr(k->warnings, "scene.obj:1: cannot open the material library 'b.mtl'"));
    assert_non_null(strstr(k->warnings, "scene.obj: the material 'red' is defined nowhere: gray 0.5 stands in"));
}

static void normals_follow_the_smoothing_groups(void **state)
{
    Kit *k = *state;
    const char *roof = "v 0 0 1\nv 1 0 1\nusemtl a\ns 1\nf 1 2 3 4\nf 1 5 6 2\n";
    const SheenMesh *m = &scene(k, "newmtl a\n", roof)->shapes[0].mesh;
    assert_non_null(m->n);
    bool smooth = false;
    for (uint32_t i = 0; i < m->n_vertices; ++i) smooth = smooth || fabsf(m->n[i].y - m->n[i].z) < 1e-6f;
    assert_true(smooth);
    // Given normals count more.
    m = &scene(k, "newmtl a\n", "vn 0 1 0\nusemtl a\ns 1\nf 1//1 2//1 3//1\n")->shapes[0].mesh;
    kit_assert_v3(m->n[0], v3(0, 1, 0), 0.0f);
}

static void broken_files_are_refused(void **state)
{
    Kit *k = *state;
    static const struct {
        const char *mtl, *what;
    } cases[] = {
        {"newmtl a\nKd 1 x 0\n", "room.mtl:2: 'Kd' needs finite numbers"},
        {"newmtl a\nKd\n", "room.mtl:2: 'Kd' needs a number"},
        {"newmtl a\n\nKe nan 0 0\n", "room.mtl:3: 'Ke' needs finite numbers"},
        {"newmtl a\nKe 1e40 0 0\n", "room.mtl:2: 'Ke' needs finite numbers"},
        {"newmtl a\nNi # none\n", "room.mtl:2: 'Ni' needs a number"},
        {"newmtl a\nd -halo\n", "room.mtl:2: 'd' needs a number"},
        {"newmtl a\nillum glass\n", "room.mtl:2: 'illum' needs finite numbers"},
        {"Kd 1 1 1\nnewmtl a\n", "room.mtl:1: 'Kd' stands before the first 'newmtl'"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        kit_write(k, "room.mtl", cases[i].mtl);
        kit_write(k, "room.obj", "mtllib room.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
        assert_int_equal(kit_load(k, "room.obj"), SHEEN_ERR_PARSE);
        assert_int_equal(k->n_errors, 1);
        if (!strstr(k->error, cases[i].what)) fail_msg("'%s' does not say '%s'", k->error, cases[i].what);
    }
    // Colours by wavelength are no error, and what is not known is named once.
    kit_write(k, "room.mtl", "newmtl a\nKd spectral file.rfl 1\nKe xyz 1 1 1\nblob\nblub\nmap_Kd\n");
    assert_int_equal(kit_load(k, "room.obj"), SHEEN_OK);
    assert_non_null(strstr(k->warnings, "room.mtl:2: 'Kd spectral' is not supported"));
    assert_non_null(strstr(k->warnings, "room.mtl:4: 'blob' is not supported"));
    assert_null(strstr(k->warnings, "blub"));
    kit_write(k, "room.obj", "v 0 0 0\nf 1 2 3\n");
    assert_int_equal(kit_load(k, "room.obj"), SHEEN_ERR_PARSE);
    assert_non_null(strstr(k->error, "room.obj:2: vertex index 2 is out of range"));
    kit_write_bytes(k, "bad.png", "\x89PNG\r\n\x1a\n", 8);
    kit_write(k, "room.mtl", "newmtl a\nmap_Kd bad.png\n");
    kit_write(k, "room.obj", "mtllib room.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    assert_int_equal(kit_load(k, "room.obj"), SHEEN_ERR_PARSE);
    assert_non_null(strstr(k->error, "bad.png"));
}

/** Every truncation of a scene and of its library ends in a scene or in one line. */
static void truncated_files(void **state)
{
    Kit *k = *state;
    const char *mtl = "newmtl a\nKd .1 .2 .3\nKe 1 1 1\nillum 7\nmap_Kd -s 2 2 no.png\nnewmtl b\nTr .5\n";
    char obj[512];
    snprintf(obj, sizeof obj, "mtllib room.mtl\n%susemtl a\nf 1/1 2/2 3/3 4/4\ns 1\nusemtl b\nf -1 -2 -3\n", square);
    for (int which = 0; which < 2; ++which)
        for (size_t n = 0; n < strlen(which ? mtl : obj); ++n) {
            kit_write_bytes(k, "room.mtl", mtl, which ? n : strlen(mtl));
            kit_write_bytes(k, "room.obj", obj, which ? strlen(obj) : n);
            SheenStatus s = kit_load(k, "room.obj");
            assert_int_equal(k->n_errors, s != SHEEN_OK);
            assert_int_equal(k->scene != NULL, s == SHEEN_OK);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        KIT_TEST(parts_by_material_and_lamps_by_object),
        KIT_TEST(a_scene_without_lamps_has_a_sky),
        KIT_TEST(materials_by_their_model_of_light),
        KIT_TEST(highlights_are_phong_lobes),
        KIT_TEST(blender_and_its_principled_materials),
        KIT_TEST(maps_of_normals),
        KIT_TEST(what_is_partly_transparent_is_a_mask),
        KIT_TEST(pictures_of_roughness_and_metal),
        KIT_TEST(alpha_channels_are_opacities),
        KIT_TEST(pictures_are_multiplied_by_the_colour),
        KIT_TEST(libraries_are_looked_for),
        KIT_TEST(normals_follow_the_smoothing_groups),
        KIT_TEST(broken_files_are_refused),
        KIT_TEST(truncated_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
