// SPDX-License-Identifier: Apache-2.0
// Colours of vertices and faces: from the files, through clean-up and smoothing, to the surface.
#include "io_kit.h"

#include "io/mesh_smooth.h"
#include "ray/surface.h"

#include <cmocka.h>

#define SHAPE(type, file, rest)                                                                                        \
    "<shape type=\"" type "\"><string name=\"filename\" value=\"" file "\"/><bsdf type=\"diffuse\">" rest              \
    "</bsdf></shape>"
#define ATTRIBUTE(name)                                                                                                \
    "<texture name=\"reflectance\" type=\"mesh_attribute\"><string name=\"name\" value=\"" name "\"/></texture>"

/** A triangle of three colours and one without area before it; its square and fifth vertex belong to the latter. */
static const char vertices_of_ply[] = "0 0 0 0.8 0 0\n9 9 9 1 1 1\n1 0 0 0 0.6 0\n0 1 0 0 0 0.4\n";

static void write_ply(const Kit *k, const char *name, const char *type, const char *names, const char *vertices)
{
    char text[1024], r[16], g[16], b[16];
    assert_int_equal(sscanf(names, "%15s %15s %15s", r, g, b), 3);
    snprintf(text, sizeof text,
             "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
             "property %s %s\nproperty %s %s\nproperty %s %s\nelement face 2\nproperty list uchar int vertex_indices\n"
             "end_header\n%s3 0 1 1\n3 0 2 3\n",
             type, r, type, g, type, b, vertices);
    kit_write(k, name, text);
}

/** The reflectance where the barycentric coordinates of the first shape's first triangle are u and v. */
static Rgb color_at(const SheenScene *s, float u, float v)
{
    const SheenMesh *mesh = &s->shapes[0].mesh;
    const uint32_t *t = mesh->triangles[0];
    Vec3 p = v3_mad(v3_mad(v3_scale(mesh->p[t[0]], 1.0f - u - v), u, mesh->p[t[1]]), v, mesh->p[t[2]]);
    SurfacePoint at = {.p = p, .instance = SHEEN_NONE};
    return sheen_surface_texture(s, &s->materials[s->shapes[0].material].reflectance, &at);
}

static void colors_of_ply_vertices_are_interpolated(void **state)
{
    Kit *k = *state;
    write_ply(k, "m.ply", "float", "r g b", vertices_of_ply);
    // The mesh has no normals: it is smoothed, and its first triangle is dropped.
    const SheenScene *s = kit_scene(k, SHAPE("ply", "m.ply", ATTRIBUTE("vertex_color")));
    assert_int_equal(s->shapes[0].mesh.n_triangles, 1);
    kit_assert_rgb(color_at(s, 0, 0), rgb(0.8f, 0, 0), 1e-6f);
    kit_assert_rgb(color_at(s, 1, 0), rgb(0, 0.6f, 0), 1e-6f);
    kit_assert_rgb(color_at(s, 0, 1), rgb(0, 0, 0.4f), 1e-6f);
    kit_assert_rgb(color_at(s, 0.25f, 0.5f), rgb(0.2f, 0.15f, 0.2f), 1e-6f);
    write_ply(k, "m.ply", "uchar", "red green blue", "0 0 0 204 0 0\n9 9 9 0 0 0\n1 0 0 0 255 0\n0 1 0 0 0 51\n");
    s = kit_scene(k, SHAPE("ply", "m.ply", ATTRIBUTE("vertex_color")));
    kit_assert_rgb(color_at(s, 0, 0), rgb(0.8f, 0, 0), 1e-6f); // bytes over 255
    kit_assert_rgb(color_at(s, 0, 1), rgb(0, 0, 0.2f), 1e-6f);
    // In version 0.5 colours are in the sRGB curve unless told otherwise.
    const char *old = SHAPE("ply", "m.ply", "<texture name=\"reflectance\" type=\"vertexcolors\"/>");
    assert_int_equal(kit_load_version(k, "0.5.0", old), SHEEN_OK);
    kit_assert_rgb(color_at(k->scene, 0, 1), rgb(0, 0, 0.0331048f), 1e-6f);
    old = "<shape type=\"ply\"><string name=\"filename\" value=\"m.ply\"/><boolean name=\"srgb\" value=\"false\"/>"
          "<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"vertexcolors\"/></bsdf></shape>";
    assert_int_equal(kit_load_version(k, "0.5.0", old), SHEEN_OK);
    kit_assert_rgb(color_at(k->scene, 0, 1), rgb(0, 0, 0.2f), 1e-6f);
}

static void colors_of_ply_faces_stay_with_their_triangles(void **state)
{
    Kit *k = *state;
    kit_write(k, "f.ply",
              "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
              "element face 3\nproperty uchar red\nproperty list uchar int vertex_indices\nproperty uchar green\n"
              "property uchar blue\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
              "255 3 0 1 1 0 0\n0 4 0 1 2 3 51 0\n102 3 0 1 3 0 255\n");
    const SheenScene *s = kit_scene(k, SHAPE("ply", "f.ply", ATTRIBUTE("face_color")));
    assert_int_equal(s->shapes[0].mesh.n_triangles, 3); // of a quadrilateral and a triangle; one has no area
    for (uint32_t i = 0; i < 3; ++i) {
        SurfacePoint at = {.triangle = i, .instance = SHEEN_NONE};
        Rgb c = sheen_surface_texture(s, &s->materials[s->shapes[0].material].reflectance, &at);
        kit_assert_rgb(c, i < 2 ? rgb(0, 0.2f, 0) : rgb(0.4f, 0, 1), 1e-6f);
    }
}

static void colors_of_obj_vertices_follow_them(void **state)
{
    Kit *k = *state;
    // The colour belongs to the position, whatever corners are made of it; the second position has none and is white.
    kit_write(k, "m.obj", "v 0 0 0 0.8 0 0\nv 1 0 0\nv 0 1 0 0 0 0.4\nvt 0 0\nvt 1 0\nf 1/2 2/1 3/1\nf 1/1 3/2 2/2\n");
    const SheenScene *s = kit_scene(k, SHAPE("obj", "m.obj", ATTRIBUTE("vertex_color")));
    kit_assert_rgb(color_at(s, 0, 0), rgb(0.8f, 0, 0), 1e-6f);
    kit_assert_rgb(color_at(s, 1, 0), rgb(1, 1, 1), 1e-6f);
    kit_assert_rgb(color_at(s, 0, 0.5f), rgb(0.4f, 0, 0.2f), 1e-6f);
    // Four numbers are a position with a weight.
    kit_write(k, "w.obj", "v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n");
    s = kit_scene(k, SHAPE("obj", "w.obj", ATTRIBUTE("vertex_color")));
    assert_null(s->shapes[0].mesh.color);
    kit_assert_rgb(color_at(s, 0, 0), rgb_gray(0.5f), 0.0f); // what stands in
}

static void edges_split_vertices_and_keep_colors(void **state)
{
    Kit *k = *state;
    // Two faces at a right angle: the two vertices of the edge become four.
    kit_write(k, "m.obj", "v 0 0 0 1 0 0\nv 0 1 0 0 1 0\nv 1 0 0 0 0 1\nv 0 0 1 0.5 0.5 0\nf 1 3 2\nf 1 2 4\n");
    const SheenScene *s =
        kit_scene(k, "<shape type=\"obj\"><string name=\"filename\" value=\"m.obj\"/><float name=\"maxSmoothAngle\" "
                     "value=\"30\"/><bsdf type=\"diffuse\">" ATTRIBUTE("vertex_color") "</bsdf></shape>");
    const SheenMesh *mesh = &s->shapes[0].mesh;
    assert_int_equal(mesh->n_vertices, 6);
    for (uint32_t i = 0; i < 6; ++i) {
        Vec3 p = mesh->p[i];
        Rgb want = p.x > 0 ? rgb(0, 0, 1) : p.y > 0 ? rgb(0, 1, 0) : p.z > 0 ? rgb(0.5f, 0.5f, 0) : rgb(1, 0, 0);
        kit_assert_rgb(mesh->color[i], want, 0.0f);
    }
}

/** An instance's point is in the world, the mesh in its group. */
static void instances_have_the_colors_of_their_group(void **state)
{
    Kit *k = *state;
    write_ply(k, "m.ply", "float", "r g b", vertices_of_ply);
    const SheenScene *s = kit_scene(
        k, "<shape type=\"shapegroup\" id=\"g\">" SHAPE(
               "ply", "m.ply", ATTRIBUTE("vertex_color")) "</shape>"
                                                          "<shape type=\"instance\"><ref id=\"g\"/><transform "
                                                          "name=\"to_world\"><scale value=\"2\"/>"
                                                          "<translate x=\"5\"/></transform></shape>");
    assert_int_equal(s->n_instances, 1);
    uint32_t shape = s->groups[s->instances[0].group].first_shape;
    SurfacePoint at = {.p = v3(5.5f, 1, 0), .shape = shape, .instance = 0};
    Rgb c = sheen_surface_texture(s, &s->materials[s->shapes[shape].material].reflectance, &at);
    kit_assert_rgb(c, rgb(0.2f, 0.15f, 0.2f), 1e-6f);
}

static void what_is_not_there_is_named(void **state)
{
    Kit *k = *state;
    write_ply(k, "m.ply", "float", "r g b", vertices_of_ply);
    kit_scene(k, SHAPE("ply", "m.ply", ATTRIBUTE("vertex_taste")));
    assert_non_null(strstr(k->warnings, "the mesh attribute 'vertex_taste' is not supported: gray 0.5 stands in"));
    kit_scene(k, "<shape type=\"ply\"><string name=\"filename\" value=\"m.ply\"/><bsdf type=\"mask\"><texture "
                 "name=\"opacity\" type=\"mesh_attribute\"/><bsdf type=\"diffuse\"/></bsdf></shape>");
    assert_non_null(strstr(k->warnings, "an opacity from a mesh's colours is not supported"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        KIT_TEST(colors_of_ply_vertices_are_interpolated),  KIT_TEST(colors_of_ply_faces_stay_with_their_triangles),
        KIT_TEST(colors_of_obj_vertices_follow_them),       KIT_TEST(edges_split_vertices_and_keep_colors),
        KIT_TEST(instances_have_the_colors_of_their_group), KIT_TEST(what_is_not_there_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
