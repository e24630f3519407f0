// SPDX-License-Identifier: Apache-2.0
// Mitsuba scenes: what each element becomes. Values marked "Mitsuba 3" were read from version 3.9 for the same input.
#include "image/image.h"
#include "io/sky.h"
#include "io_kit.h"
#include "light/environment.h"
#include "scene/metal.h"

// Coordinates of order 1 through a few double operations and one rounding.
#define EPS 2e-6f

static const SheenMaterial *material_named(const SheenScene *s, const char *name)
{
    for (uint32_t i = 0; i < s->n_materials; ++i)
        if (strcmp(s->materials[i].name, name) == 0) return &s->materials[i];
    fail_msg("no material '%s'", name);
    return NULL;
}

/** Loads one <bsdf id="m"> on a rectangle. */
static const SheenMaterial *material(Kit *k, const char *version, const char *bsdf)
{
    char body[4096];
    snprintf(body, sizeof body, "<shape type=\"rectangle\"><ref id=\"m\"/></shape>%s", bsdf);
    assert_int_equal(kit_load_version(k, version, body), SHEEN_OK);
    return material_named(k->scene, "m");
}

static Vec3 front(const SheenMesh *m, uint32_t i)
{
    const uint32_t *t = m->triangles[i];
    return v3_normalize(v3_cross(v3_sub(m->p[t[1]], m->p[t[0]]), v3_sub(m->p[t[2]], m->p[t[0]])));
}

// ---- transforms -------------------------------------------------------------------------------------------------

/** Where the rectangle's centre, x and y axes go. */
static void assert_axes(Kit *k, const char *transform, Vec3 center, Vec3 x, Vec3 y)
{
    char body[1024];
    snprintf(body, sizeof body, "<shape type=\"disk\"><transform name=\"to_world\">%s</transform></shape>", transform);
    const SheenDisk *d = &kit_scene(k, body)->shapes[0].disk;
    kit_assert_v3(d->center, center, EPS);
    kit_assert_v3(d->du, x, EPS);
    kit_assert_v3(d->dv, v3_neg(y), EPS); // turned round, for uv
}

static void transforms_compose_in_order(void **state)
{
    Kit *k = *state;
    const Vec3 o = {0, 0, 0}, x = {1, 0, 0}, y = {0, 1, 0};
    assert_axes(k, "<translate x=\"1\" z=\"-2\"/>", v3(1, 0, -2), x, y);
    assert_axes(k, "<translate value=\"1, 2, 3\"/>", v3(1, 2, 3), x, y);
    assert_axes(k, "<scale value=\"2\"/>", o, v3(2, 0, 0), v3(0, 2, 0));
    assert_axes(k, "<scale y=\"3\"/>", o, x, v3(0, 3, 0));
    assert_axes(k, "<rotate z=\"1\" angle=\"90\"/>", o, y, v3(-1, 0, 0));
    assert_axes(k, "<rotate value=\"0 0 1\" angle=\"90\"/><translate x=\"1\"/>", x, y, v3(-1, 0, 0));
    assert_axes(k, "<translate x=\"1\"/><rotate z=\"1\" angle=\"90\"/>", y, y, v3(-1, 0, 0));
    assert_axes(k, "<matrix value=\"1 2 0 4  0 1 0 5  0 0 1 6  0 0 0 1\"/>", v3(4, 5, 6), x, v3(2, 1, 0));
    assert_axes(k, "<matrix value=\"1 2 0 0 1 0 0 0 1\"/>", o, x, v3(2, 1, 0));
    assert_axes(k, "<lookat origin=\"1,2,3\" target=\"1,2,-7\" up=\"0,1,0\"/>", v3(1, 2, 3), v3(-1, 0, 0), y);
}

// ---- shapes -----------------------------------------------------------------------------------------------------

static void rectangle_and_cube(void **state)
{
    Kit *k = *state;
    const SheenScene *s = kit_scene(k, "<shape type=\"rectangle\"/><shape type=\"cube\"/>");
    const SheenMesh *r = &s->shapes[0].mesh, *c = &s->shapes[1].mesh;
    assert_int_equal(r->n_triangles, 2);
    kit_assert_v3(front(r, 0), v3(0, 0, 1), EPS);
    kit_assert_v3(front(r, 1), v3(0, 0, 1), EPS);
    assert_null(r->n);
    for (uint32_t i = 0; i < 4; ++i) { // uv (0, 0) of Mitsuba, the picture's upper left, at (-1, -1)
        assert_float_equal(r->uv[i].x, 0.5f * (r->p[i].x + 1.0f), EPS);
        assert_float_equal(r->uv[i].y, 0.5f * (1.0f - r->p[i].y), EPS);
    }
    assert_int_equal(c->n_triangles, 12);
    float volume = 0.0f; // by the divergence theorem, so that a hole or an overlap shows
    for (uint32_t i = 0; i < 12; ++i) {
        const uint32_t *t = c->triangles[i];
        assert_true(v3_dot(front(c, i), v3_add(c->p[t[0]], v3_add(c->p[t[1]], c->p[t[2]]))) > 2.9f); // outward
        volume += v3_dot(c->p[t[0]], v3_cross(c->p[t[1]], c->p[t[2]])) / 6.0f;
    }
    assert_float_equal(volume, 8.0f, 1e-5f);
    Vec3 middle[6] = {0}; // of each face's triangles: the face's centre only when they make up the square
    for (uint32_t i = 0; i < 12; ++i)
        for (int j = 0; j < 3; ++j) middle[i / 2] = v3_mad(middle[i / 2], 1.0f / 6.0f, c->p[c->triangles[i][j]]);
    for (int i = 0; i < 6; ++i) assert_float_equal(v3_length(middle[i]), 1.0f, EPS);
    // Mitsuba 3: a ray down -z hits the top at (0.3, 0.2, 1) with uv (0.6, 0.65).
    for (uint32_t i = 0; i < c->n_vertices; ++i)
        if (i >= 12 && i < 16) {
            assert_float_equal(c->p[i].z, 1.0f, 0.0f);
            assert_float_equal(c->uv[i].x, 0.5f * (c->p[i].y + 1.0f), EPS);
            assert_float_equal(1.0f - c->uv[i].y, 0.5f * (c->p[i].x + 1.0f), EPS);
        }
    assert_string_equal(s->materials[s->shapes[0].material].name, "default");
    kit_assert_rgb(sheen_texture_mean(&s->materials[s->shapes[0].material].reflectance), rgb_gray(0.5f), 0.0f);
}

/** Which side is the front under reflections and flips. All as Mitsuba 3's shading normal. */
static void front_sides_follow_mitsuba(void **state)
{
    Kit *k = *state;
    kit_write(k, "n.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n");
    kit_write(k, "none.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n");
    kit_write(k, "against.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nvn 0 0 -1\nf 1//1 2//1 3//1\n");
    static const struct {
        const char *shape, *scale, *more;
        float z;
    } cases[] = {
        {"rectangle", "", "", 1},
        {"rectangle", "x=\"-1\"", "", 1},
        {"rectangle", "z=\"-1\"", "", -1},
        {"rectangle", "", "<boolean name=\"flip_normals\" value=\"true\"/>", -1},
        {"n.obj", "", "", 1},
        {"n.obj", "x=\"-1\"", "", 1},
        {"n.obj", "z=\"-1\"", "", -1},
        {"n.obj", "x=\"-1\"", "<boolean name=\"flipNormals\" value=\"true\"/>", -1},
        {"n.obj", "x=\"-1\"", "<boolean name=\"faceNormals\" value=\"true\"/>", -1},
        {"none.obj", "", "", 1},
        {"none.obj", "x=\"-1\"", "", -1},
        {"none.obj", "z=\"-1\"", "", 1},
        {"none.obj", "", "<boolean name=\"flip_normals\" value=\"true\"/>", -1},
        {"against.obj", "", "", -1},
        {"against.obj", "", "<boolean name=\"face_normals\" value=\"true\"/>", 1},
        {"against.obj", "z=\"-1\"", "", 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char body[512], file[128] = "";
        bool obj = strstr(cases[i].shape, ".obj") != NULL;
        if (obj) snprintf(file, sizeof file, "<string name=\"filename\" value=\"%s\"/>", cases[i].shape);
        snprintf(body, sizeof body,
                 "<shape type=\"%s\">%s%s<transform name=\"to_world\"><scale %s/></transform></shape>",
                 obj ? "obj" : cases[i].shape, file, cases[i].more, cases[i].scale);
        const SheenMesh *m = &kit_scene(k, body)->shapes[0].mesh;
        float z = front(m, 0).z;
        if (fabsf(z - cases[i].z) > EPS)
            fail_msg("%s %s %s: %g", cases[i].shape, cases[i].scale, cases[i].more, (double)z);
        bool has_normals = obj && !strstr(cases[i].more, "ace");
        assert_int_equal(m->n != NULL, has_normals); // computed where the file has none
        if (m->n) kit_assert_v3(m->n[0], v3(0, 0, z), EPS);
    }
}

static void spheres_and_disks(void **state)
{
    Kit *k = *state;
    const SheenScene *s = kit_scene(
        k, "<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"0\" z=\"0\"/><float name=\"radius\" value=\"2\"/>"
           "<transform name=\"to_world\"><scale value=\"2\"/></transform></shape>"
           "<shape type=\"sphere\"><transform name=\"toWorld\"><scale x=\"-1\"/></transform></shape>"
           "<shape type=\"sphere\"><boolean name=\"flipNormals\" value=\"true\"/></shape>"
           "<shape type=\"disk\"><transform name=\"to_world\"><scale z=\"-1\"/></transform></shape>"
           "<shape type=\"disk\"><transform name=\"to_world\"><scale x=\"-3\"/></transform></shape>"
           "<shape type=\"disk\"><boolean name=\"flip_normals\" value=\"true\"/></shape>");
    kit_assert_v3(s->shapes[0].sphere.center, v3(2, 0, 0), EPS);
    assert_float_equal(s->shapes[0].sphere.radius, 4.0f, EPS);
    assert_false(s->shapes[0].sphere.flip);
    assert_true(s->shapes[1].sphere.flip); // Mitsuba 3: mirrored is inside out
    assert_true(s->shapes[2].sphere.flip);
    assert_float_equal(s->shapes[3].disk.n.z, -1.0f, EPS);
    assert_float_equal(s->shapes[4].disk.n.z, 1.0f, EPS);
    assert_float_equal(s->shapes[4].disk.du.x, -3.0f, EPS);
    assert_float_equal(s->shapes[5].disk.n.z, -1.0f, EPS);
    assert_int_equal(k->n_warnings, 2); // no light, no camera
}

static void an_ellipsoid_becomes_triangles(void **state)
{
    Kit *k = *state;
    const SheenScene *s = kit_scene(k, "<shape type=\"sphere\"><float name=\"radius\" value=\"2\"/>"
                                       "<transform name=\"to_world\"><scale x=\"2\"/></transform></shape>");
    assert_non_null(strstr(k->warnings, "scene.xml:2:1: the transform makes the sphere an ellipsoid"));
    const SheenMesh *m = &s->shapes[0].mesh;
    assert_float_equal(s->bounds.hi.x, 4.0f, 1e-5f);
    assert_float_equal(s->bounds.hi.z, 2.0f, 1e-5f);
    double volume = 0.0;
    for (uint32_t i = 0; i < m->n_triangles; ++i) {
        const uint32_t *t = m->triangles[i];
        volume += (double)v3_dot(m->p[t[0]], v3_cross(m->p[t[1]], m->p[t[2]])) / 6.0;
    }
    // 4/3 pi a b c; 128 x 64 quads inscribed lose 0.2 % around (sin t / t, t = 2 pi / 128: 0.04 %) and down.
    assert_true(fabs(volume / (4.0 / 3.0 * 3.14159265 * 4 * 2 * 2) - 1.0) < 2.5e-3);
    assert_true(volume > 0.0);
}

static void meshes_keep_their_texture_orientation(void **state)
{
    Kit *k = *state;
    const char *ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                      "property float u\nproperty float v\nelement face 1\nproperty list uchar int vertex_index\n"
                      "end_header\n0 0 0 0.1 0.2\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n";
    kit_write(k, "t.ply", ply);
    kit_write(k, "t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.1 0.2\nf 1/1 2/1 3/1\n");
    const SheenScene *s = kit_scene(k, "<shape type=\"obj\"><string name=\"filename\" value=\"t.obj\"/></shape>"
                                       "<shape type=\"ply\"><string name=\"filename\" value=\"t.ply\"/></shape>"
                                       "<shape type=\"obj\"><string name=\"filename\" value=\"t.obj\"/>"
                                       "<boolean name=\"flip_tex_coords\" value=\"false\"/></shape>");
    assert_float_equal(s->shapes[0].mesh.uv[0].y, 0.2f, EPS); // upward, as OBJ has it
    assert_float_equal(s->shapes[1].mesh.uv[0].y, 0.8f, EPS); // Mitsuba takes PLY's v as it is, downward
    assert_float_equal(s->shapes[2].mesh.uv[0].y, 0.8f, EPS);
}

/** The places, normals and uv that Mitsuba 3 gives for the same shapes; our v runs upward. */
static void cylinders(void **state)
{
    Kit *k = *state;
    static const struct {
        const char *more;
        Vec3 lo, hi;
        float out; // 1 when the front is outside
    } cases[] = {
        {"", {0.5f, 2, 2.5f}, {1.5f, 4, 3.5f}, 1},
        {"<boolean name=\"flip_normals\" value=\"true\"/>", {0.5f, 2, 2.5f}, {1.5f, 4, 3.5f}, -1},
        {"<transform name=\"toWorld\"><scale x=\"-1\"/></transform>", {-1.5f, 2, 2.5f}, {-0.5f, 4, 3.5f}, 1},
        {"<boolean name=\"flipNormals\" value=\"true\"/><transform name=\"to_world\"><scale x=\"-1\"/></transform>",
         {-1.5f, 2, 2.5f},
         {-0.5f, 4, 3.5f},
         -1},
        {"<transform name=\"to_world\"><scale y=\"3\"/></transform>", {0.5f, 6, 2.5f}, {1.5f, 12, 3.5f}, 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i)
        for (int sign = -1; sign <= 1; sign += 2) {
            char body[512];
            snprintf(body, sizeof body,
                     "<shape type=\"cylinder\"><point name=\"p0\" x=\"1\" y=\"2\" z=\"3\"/><point name=\"p1\" "
                     "x=\"1\" y=\"4\" z=\"3\"/><float name=\"radius\" value=\"%g\"/>%s</shape>",
                     0.5 * sign, cases[i].more);
            const SheenScene *s = kit_scene(k, body);
            const SheenMesh *m = &s->shapes[0].mesh;
            // 256 sides touch the circle at its corners, among them those on the axes.
            kit_assert_v3(s->bounds.lo, cases[i].lo, 1e-5f);
            kit_assert_v3(s->bounds.hi, cases[i].hi, 1e-5f);
            Vec3 center = bounds_center(&s->bounds);
            for (uint32_t t = 0; t < m->n_triangles; ++t) {
                Vec3 a = m->p[m->triangles[t][0]], b = m->p[m->triangles[t][1]], c = m->p[m->triangles[t][2]];
                Vec3 face = v3_cross(v3_sub(b, a), v3_sub(c, a)), from = v3_sub(a, center);
                from.y = 0.0f;
                assert_true(v3_dot(face, from) * cases[i].out > 0.0f);
                assert_true(v3_dot(m->n[m->triangles[t][0]], from) * cases[i].out > 0.0f);
            }
        }
    const SheenScene *s = kit_scene(k, "<shape type=\"cylinder\"/>");
    const SheenMesh *m = &s->shapes[0].mesh;
    for (uint32_t i = 0; i < m->n_vertices; ++i) {
        float phi = 2.0f * SHEEN_PI * m->uv[i].x;
        kit_assert_v3(m->p[i], v3(cosf(phi), sinf(phi), 1.0f - m->uv[i].y), 1e-6f);
    }
    kit_scene(k, "<shape type=\"cylinder\"><point name=\"p1\" value=\"0,0,0\"/></shape>");
    assert_non_null(strstr(k->warnings, "scene.xml:2:1: a cylinder from a point to itself is left out"));
}

/** A roof whose sides meet at a right angle, with wrong normals that maxSmoothAngle discards. */
static void normals_by_the_largest_smooth_angle(void **state)
{
    Kit *k = *state;
    kit_write(k, "roof.obj",
              "v -1 0 0\nv -1 1 0\nv 0 0 1\nv 0 1 1\nv 1 0 0\nv 1 1 0\nvn 0 1 0\n"
              "f 1//1 3//1 4//1 2//1\nf 3//1 5//1 6//1 4//1\n");
#define ROOF(more) "<shape type=\"obj\"><string name=\"filename\" value=\"roof.obj\"/>" more "</shape>"
    const SheenMesh *m = &kit_scene(k, ROOF("<float name=\"maxSmoothAngle\" value=\"89\"/>"))->shapes[0].mesh;
    assert_int_equal(k->n_warnings, 2); // no light, no camera
    assert_int_equal(m->n_vertices, 8);
    for (uint32_t i = 0; i < 8; ++i) assert_true(fabsf(m->n[i].y) < 1e-6f && fabsf(m->n[i].z - 0.7071068f) < 1e-6f);
    m = &kit_scene(k, ROOF("<float name=\"max_smooth_angle\" value=\"91\"/>"))->shapes[0].mesh;
    assert_int_equal(m->n_vertices, 6);
    uint32_t n_up = 0;
    for (uint32_t i = 0; i < 6; ++i) n_up += fabsf(m->n[i].z - 1.0f) < 1e-6f;
    assert_int_equal(n_up, 2); // on the ridge
    m = &kit_scene(k, ROOF("<float name=\"maxSmoothAngle\" value=\"89\"/>"
                           "<boolean name=\"faceNormals\" value=\"true\"/>"))
             ->shapes[0]
             .mesh;
    assert_null(m->n);
}

static void shapes_that_are_not_there_are_named(void **state)
{
    Kit *k = *state;
    static const char *const names[] = {"deformable", "ellipsoids", "sdfgrid", "subdivision"};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        char body[128], want[128];
        snprintf(body, sizeof body, "\n<shape type=\"cube\"/><shape type=\"%s\"/>", names[i]);
        snprintf(want, sizeof want, "scene.xml:3:21: the shape '%s' is not supported and is left out", names[i]);
        assert_int_equal(kit_scene(k, body)->n_shapes, 1);
        assert_non_null(strstr(k->warnings, want));
    }
}

static void shape_groups_and_instances(void **state)
{
    Kit *k = *state;
    const SheenScene *s = kit_scene(
        k,
        "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\"><translate x=\"5\"/></transform></shape>"
        "<shape type=\"shapegroup\" id=\"g\"><shape type=\"cube\"/><shape type=\"sphere\">"
        "<emitter type=\"area\"/></shape></shape>"
        "<shape type=\"instance\"><ref id=\"g\"/></shape><shape type=\"rectangle\"/>");
    assert_int_equal(s->n_instances, 2);
    assert_int_equal(s->n_groups, 2);
    assert_int_equal(s->groups[0].n_shapes, 1);
    assert_int_equal(s->groups[1].n_shapes, 2);
    assert_float_equal(s->bounds.hi.x, 6.0f, EPS);
    assert_int_equal(s->n_lights, 0);
    assert_non_null(strstr(k->warnings, "a light inside a shapegroup is not supported"));
}

// ---- materials --------------------------------------------------------------------------------------------------

static void supported_materials(void **state)
{
    Kit *k = *state;
    const SheenMaterial *m = material(
        k, "3.0.0", "<bsdf type=\"diffuse\" id=\"m\"><rgb name=\"reflectance\" value=\"0.1, 0.2 0.3\"/></bsdf>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_DIFFUSE);
    assert_false(m->two_sided);
    kit_assert_rgb(m->reflectance.value, rgb(0.1f, 0.2f, 0.3f), 0.0f);

    m = material(k, "3.0.0", "<bsdf type=\"dielectric\" id=\"m\"/>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_DIELECTRIC);
    assert_float_equal(m->ior, 1.504183292f, 1e-6f); // Mitsuba 3
    m = material(k, "0.6.0",
                 "<bsdf type=\"thindielectric\" id=\"m\"><string name=\"intIOR\" value=\"diamond\"/>"
                 "<float name=\"extIOR\" value=\"1\"/><rgb name=\"specularTransmittance\" value=\"0.5\"/></bsdf>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_THIN_DIELECTRIC);
    assert_float_equal(m->ior, 2.419f, 1e-6f);
    assert_float_equal(m->specular_transmittance.value.g, 0.5f, 0.0f);

    Rgb eta, copper_k;
    assert_true(sheen_metal_find("Cu", &eta, &copper_k));
    m = material(k, "3.0.0", "<bsdf type=\"conductor\" id=\"m\"><string name=\"material\" value=\"Cu\"/></bsdf>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_CONDUCTOR);
    kit_assert_rgb(m->k, copper_k, 0.0f);
    m = material(k, "3.0.0", "<bsdf type=\"conductor\" id=\"m\"/>"); // Mitsuba 3: a perfect mirror
    kit_assert_rgb(m->eta, rgb_gray(0), 0.0f);
    kit_assert_rgb(m->k, rgb_gray(1), 0.0f);
    m = material(k, "0.5.0", "<bsdf type=\"conductor\" id=\"m\"/>"); // 0.6: copper in air
    kit_assert_rgb(m->k, copper_k, 2e-3f);                           // air's index is 1.000277
    m = material(k, "0.5.0",
                 "<bsdf type=\"conductor\" id=\"m\"><float name=\"extEta\" value=\"2\"/>"
                 "<rgb name=\"eta\" value=\"1 2 4\"/><rgb name=\"k\" value=\"6\"/></bsdf>");
    kit_assert_rgb(m->eta, rgb(0.5f, 1, 2), EPS);
    kit_assert_rgb(m->k, rgb_gray(3), EPS);
    assert_int_equal(k->n_warnings, 2); // no light, no camera
}

static void stand_ins_are_named_once(void **state)
{
    Kit *k = *state;
    static const struct {
        const char *bsdf;
        SheenMaterialKind kind;
    } cases[] = {
        {"<bsdf type=\"hk\" id=\"m\"><rgb name=\"albedo\" value=\"0.25\"/><float name=\"thickness\" "
         "value=\"2\"/></bsdf>",
         SHEEN_MATERIAL_DIFFUSE},
        {"<bsdf type=\"pplastic\" id=\"m\"><float name=\"alpha\" value=\"0.2\"/></bsdf>", SHEEN_MATERIAL_ROUGH_PLASTIC},
        {"<bsdf type=\"marble\" id=\"m\"/>", SHEEN_MATERIAL_DIFFUSE},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char body[1024];
        snprintf(body, sizeof body,
                 "<shape type=\"cube\"><ref id=\"m\"/></shape><shape type=\"rectangle\"><ref id=\"m\"/>"
                 "</shape>\n%s",
                 cases[i].bsdf);
        const SheenMaterial *m = material_named(kit_scene(k, body), "m");
        assert_int_equal(m->kind, cases[i].kind);
        assert_int_equal(k->n_warnings, 3); // the stand-in, no light, no camera
        assert_non_null(strstr(k->warnings, "scene.xml:3:1: the material '"));
        assert_non_null(strstr(k->warnings, "stands in"));
        assert_int_equal(k->scene->n_materials, 1);
        if (strstr(cases[i].bsdf, "0.25")) assert_float_equal(m->reflectance.value.r, 0.25f, 0.0f);
    }
}

// ---- the other materials ----------------------------------------------------------------------------------------

/** Both spellings of a parameter; defaults of Mitsuba's manuals. */
static void rough_materials_and_plastics(void **state)
{
    Kit *k = *state;
    const SheenMaterial *m = material(k, "3.0.0", "<bsdf type=\"roughconductor\" id=\"m\"/>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_ROUGH_CONDUCTOR);
    assert_int_equal(m->distribution, SHEEN_DISTRIBUTION_BECKMANN);
    assert_float_equal(m->alpha_u.value.g, 0.1f, 0.0f);
    assert_false(m->anisotropic);
    m = material(k, "0.6.0",
                 "<bsdf type=\"roughconductor\" id=\"m\"><string name=\"distribution\" value=\"ggx\"/>"
                 "<float name=\"alphaU\" value=\"0.3\"/><float name=\"alphaV\" value=\"0.05\"/>"
                 "<boolean name=\"sampleVisible\" value=\"false\"/></bsdf>");
    assert_int_equal(m->distribution, SHEEN_DISTRIBUTION_GGX);
    assert_float_equal(m->alpha_u.value.g, 0.3f, 0.0f);
    assert_float_equal(m->alpha_v.value.g, 0.05f, 0.0f);
    assert_true(m->anisotropic);
    m = material(k, "3.0.0",
                 "<bsdf type=\"roughdielectric\" id=\"m\"><texture name=\"alpha\" type=\"checkerboard\">"
                 "<rgb name=\"color0\" value=\"0.2\"/></texture></bsdf>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_ROUGH_DIELECTRIC);
    assert_int_equal(m->alpha_u.kind, SHEEN_TEXTURE_CHECKERBOARD);
    assert_true(!m->anisotropic && m->has_two_sides);
    assert_float_equal(m->ior, 1.504183292f, 1e-6f);

    m = material(k, "0.5.0",
                 "<bsdf type=\"plastic\" id=\"m\"><srgb name=\"diffuseReflectance\" value=\"#ffffff\"/>"
                 "<boolean name=\"nonlinear\" value=\"true\"/></bsdf>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_PLASTIC);
    assert_true(m->nonlinear);
    assert_float_equal(m->ior, 1.49f / 1.000277f, 1e-6f);
    assert_float_equal(m->reflectance.value.g, 1.0f, 0.0f);
    assert_float_equal(m->inside, 0.5905f, 1e-3f); // Egan and Hilgeman's fit
    m = material(k, "3.0.0",
                 "<bsdf type=\"roughplastic\" id=\"m\"><string name=\"int_ior\" value=\"diamond\"/></bsdf>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_ROUGH_PLASTIC);
    assert_non_null(m->coat);
    assert_int_equal(k->n_warnings, 2); // no light, no camera
}

static void empirical_materials(void **state)
{
    Kit *k = *state;
    const SheenMaterial *m =
        material(k, "0.6.0", "<bsdf type=\"phong\" id=\"m\"><float name=\"exponent\" value=\"12\"/></bsdf>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_PHONG);
    assert_float_equal(m->exponent, 12.0f, 1e-5f);
    assert_float_equal(m->specular_reflectance.value.g, 0.2f, 0.0f);
    m = material(k, "0.6.0",
                 "<bsdf type=\"ward\" id=\"m\"><string name=\"variant\" value=\"ward-duer\"/>"
                 "<float name=\"alphaU\" value=\"0.3\"/></bsdf>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_WARD);
    assert_int_equal(m->ward, SHEEN_WARD_DUER);
    assert_true(m->anisotropic);
    assert_int_equal(k->n_warnings, 2);
    m = material(k, "3.0.0",
                 "<bsdf type=\"lafortune\" id=\"m\"><vector name=\"lobe_1\" x=\"-1\" y=\"-0.5\" z=\"0.75\"/>"
                 "<float name=\"exponent_1\" value=\"16\"/><rgb name=\"weight_2\" value=\"0.1 0.2 0.3\"/></bsdf>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_LAFORTUNE);
    assert_int_equal(m->n_lafortune, 2);
    assert_true(m->anisotropic && m->lafortune[0].c.y == -0.5f && m->lafortune[0].exponent == 16.0f);
    assert_true(m->lafortune[1].c.x == -1.0f && m->lafortune[1].exponent == 30.0f);
    assert_float_equal(m->lafortune[1].weight.b, 0.3f, 1e-6f);
    m = material(k, "3.0.0",
                 "<bsdf type=\"lafortune\" id=\"m\"><float name=\"exponent_1\" value=\"1\"/>"
                 "<float name=\"exponent_2\" value=\"1\"/><float name=\"exponent_3\" value=\"1\"/>"
                 "<float name=\"exponent_4\" value=\"1\"/><float name=\"exponent_5\" value=\"1\"/>"
                 "<float name=\"exponent_6\" value=\"1\"/><float name=\"exponent_7\" value=\"1\"/>"
                 "<float name=\"exponent_8\" value=\"-1\"/></bsdf>");
    assert_non_null(strstr(k->warnings, "has 8 lobes: the first 7 are used"));
    assert_true(m->n_lafortune == 7 && m->n_lobes == SHEEN_MATERIAL_MAX_LOBES);
    m = material(k, "0.6.0",
                 "<bsdf type=\"phong\" id=\"m\"><rgb name=\"diffuseReflectance\" value=\"0.9 0.5 0.1\"/>"
                 "<rgb name=\"specularReflectance\" value=\"0.6\"/></bsdf>");
    assert_non_null(strstr(k->warnings, "reflects 1.5 times the light"));
    kit_assert_rgb(rgb_add(m->reflectance.value, m->specular_reflectance.value), rgb(0.99f, 0.726f, 0.462f), 1e-6f);
}

static void principled_materials(void **state)
{
    Kit *k = *state;
    const SheenMaterial *m = material(k, "3.0.0", "<bsdf type=\"principled\" id=\"m\"/>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_PRINCIPLED);
    assert_float_equal(m->ior, 1.5f, 1e-6f); // specular 0.5 is 0.04 at normal incidence
    assert_float_equal(m->alpha_u.value.g, 0.5f, 0.0f);
    assert_true(!m->has_two_sides && !m->anisotropic);
    m = material(k, "3.0.0",
                 "<bsdf type=\"principled\" id=\"m\"><float name=\"spec_trans\" value=\"0.5\"/>"
                 "<float name=\"eta\" value=\"1.3\"/><float name=\"anisotropic\" value=\"0.4\"/>"
                 "<float name=\"main_specular_sampling_rate\" value=\"2\"/></bsdf>");
    assert_float_equal(m->ior, 1.3f, 1e-6f);
    assert_float_equal(m->principled->spec_trans.value.g, 0.5f, 0.0f);
    assert_true(m->has_two_sides && m->anisotropic);
    assert_int_equal(k->n_warnings, 2);
}

static void materials_inside_others(void **state)
{
    Kit *k = *state;
    const SheenMaterial *m = material(k, "3.0.0",
                                      "<bsdf type=\"mask\" id=\"m\"><float name=\"opacity\" value=\"0.3\"/>"
                                      "<bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf></bsdf>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_MASK);
    assert_float_equal(m->weight.value.g, 0.3f, 0.0f);
    assert_true(k->scene->materials[m->nested[0]].two_sided);
    assert_true(m->n_lobes == 2 && m->n_wraps == 1);
    m = material(k, "3.0.0",
                 "<bsdf type=\"blendbsdf\" id=\"m\"><float name=\"weight\" value=\"0.25\"/><ref id=\"a\"/>"
                 "<ref id=\"a\"/></bsdf><bsdf type=\"diffuse\" id=\"a\"/>");
    assert_int_equal(m->nested[0], m->nested[1]); // one material, used twice
    assert_int_equal(k->scene->n_materials, 2);
    m = material(k, "0.6.0",
                 "<bsdf type=\"twosided\" id=\"m\"><bsdf type=\"diffuse\"/><bsdf type=\"plastic\"/></bsdf>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_SIDES);
    m = material(k, "0.6.0",
                 "<bsdf type=\"mixturebsdf\" id=\"m\"><string name=\"weights\" value=\"0.1, 0.2, 0.3\"/>"
                 "<bsdf type=\"diffuse\"/><bsdf type=\"plastic\"/><bsdf type=\"conductor\"/></bsdf>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_BLEND);
    assert_float_equal(m->weight.value.g, 0.4f, 1e-6f); // black
    assert_float_equal(k->scene->materials[m->nested[0]].weight.value.g, 0.5f, 1e-6f);
    m = material(k, "0.6.0",
                 "<bsdf type=\"coating\" id=\"m\"><float name=\"thickness\" value=\"2\"/><rgb name=\"sigmaA\" "
                 "value=\"0.1 0.2 3\"/><bsdf type=\"bumpmap\"><texture type=\"scale\"><float name=\"scale\" "
                 "value=\"0.5\"/><texture type=\"checkerboard\"/></texture><bsdf type=\"diffuse\"/></bsdf></bsdf>");
    assert_int_equal(m->kind, SHEEN_MATERIAL_COATING);
    kit_assert_rgb(m->absorption, rgb(0.2f, 0.4f, 6), 1e-6f);
    const SheenMaterial *bump = &k->scene->materials[m->nested[0]];
    assert_int_equal(bump->kind, SHEEN_MATERIAL_BUMP);
    assert_float_equal(bump->map_scale, 1.0f, 0.0f);
    assert_float_equal(bump->map.value.g, 0.1f, 1e-7f); // 0.2 scaled
    assert_false(bump->shadow_normals);                 // version 3 only
    assert_int_equal(k->n_warnings, 2);
    // A transmitting material has two sides of its own.
    m = material(k, "3.0.0", "<bsdf type=\"twosided\" id=\"m\"><bsdf type=\"roughdielectric\"/></bsdf>");
    assert_false(m->two_sided);
    assert_non_null(strstr(k->warnings, "'twosided' ignored"));
}

static void broken_materials_are_mended_with_a_line(void **state)
{
    Kit *k = *state;
    static const struct {
        const char *bsdf, *says;
    } cases[] = {
        {"<bsdf type=\"roughconductor\" id=\"m\">\n<float name=\"alpha\" value=\"-0.5\"/></bsdf>",
         "scene.xml:3:1: 'alpha' is -0.5, outside [0.0001, 10]: taken as 0.0001"},
        {"<bsdf type=\"roughplastic\" id=\"m\"><string name=\"distribution\" value=\"phong\"/></bsdf>",
         "scene.xml:2:46: the distribution 'phong' is not supported: 'beckmann' stands in"},
        {"<bsdf type=\"mask\" id=\"m\"><float name=\"opacity\" value=\"7\"/><bsdf type=\"diffuse\"/></bsdf>",
         "'opacity' is 7, outside [0, 1]: taken as 1"},
        {"<bsdf type=\"blendbsdf\" id=\"m\"><float name=\"weight\" value=\"-2\"/><bsdf type=\"diffuse\"/>"
         "<bsdf type=\"diffuse\"/></bsdf>",
         "'weight' is -2, outside [0, 1]: taken as 0"},
        {"<bsdf type=\"blendbsdf\" id=\"m\"><bsdf type=\"diffuse\"/></bsdf>", "'blendbsdf' needs two materials"},
        {"<bsdf type=\"blendbsdf\" id=\"m\"><bsdf type=\"diffuse\"/><bsdf type=\"diffuse\"/><bsdf "
         "type=\"plastic\"/></bsdf>",
         "a further material inside 'blendbsdf' is left out"},
        {"<bsdf type=\"mask\" id=\"m\"/>", "no material inside 'mask': diffuse 0.5 stands in"},
        {"<bsdf type=\"coating\" id=\"m\"/>", "no material inside 'coating'"},
        {"<bsdf type=\"twosided\" id=\"m\"/>", "no material inside 'twosided'"},
        {"<bsdf type=\"bumpmap\" id=\"m\"><bsdf type=\"diffuse\"/></bsdf>", "'bumpmap' has no texture and is ignored"},
        {"<bsdf type=\"principled\" id=\"m\"><float name=\"metallic\" value=\"3\"/></bsdf>",
         "'metallic' is 3, outside [0, 1]: taken as 1"},
        {"<bsdf type=\"principled\" id=\"m\"><float name=\"eta\" value=\"1.4\"/><float name=\"specular\" "
         "value=\"0.4\"/></bsdf>",
         "'specular' is ignored beside 'eta'"},
        {"<bsdf type=\"plastic\" id=\"m\"><float name=\"int_ior\" value=\"1000\"/></bsdf>",
         "material 'm': the refractive index is 999.723, outside [0.1, 10]: taken as 10"},
        {"<bsdf type=\"coating\" id=\"m\"><rgb name=\"sigma_a\" value=\"-1 0 0\"/><bsdf type=\"diffuse\"/></bsdf>",
         "material 'm': the absorption is -1, outside [0, 1e+06]: taken as 0"},
        {"<bsdf type=\"plastic\" id=\"m\"><float name=\"gloss\" value=\"1\"/></bsdf>",
         "<float name=\"gloss\"> is not supported in <bsdf type=\"plastic\">"},
        {"<bsdf type=\"ward\" id=\"m\"><string name=\"variant\" value=\"x\"/></bsdf>", "the variant 'x' is not known"},
        {"<bsdf type=\"mixturebsdf\" id=\"m\"><string name=\"weights\" value=\"3 1\"/><bsdf type=\"diffuse\"/>"
         "<bsdf type=\"conductor\"/></bsdf>",
         "the weights sum to 4: scaled to 1"},
        {"<bsdf type=\"blendbsdf\" id=\"m\"><ref id=\"four\"/><ref id=\"four\"/></bsdf><bsdf type=\"blendbsdf\" "
         "id=\"four\"><ref id=\"three\"/><ref id=\"three\"/></bsdf><bsdf type=\"principled\" id=\"three\"/>",
         "material 'm' has too many parts: the first of them stands in"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char body[2048];
        snprintf(body, sizeof body, "<shape type=\"rectangle\"><ref id=\"m\"/></shape>%s", cases[i].bsdf);
        material_named(kit_scene(k, body), "m");
        if (k->n_warnings != 3 || !strstr(k->warnings, cases[i].says))
            fail_msg("wanted '%s', said: %s", cases[i].says, k->warnings);
    }
}

static void nested_references_and_aliases(void **state)
{
    Kit *k = *state;
    const SheenScene *s = kit_scene(
        k,
        "<shape type=\"cube\"><ref name=\"bsdf\" id=\"both\"/></shape><shape type=\"cube\"><ref id=\"other\"/></shape>"
        "<texture type=\"checkerboard\" id=\"t\"><rgb name=\"color0\" value=\"0.9\"/></texture>"
        "<bsdf type=\"twosided\" id=\"both\"><ref id=\"one\"/></bsdf><alias id=\"one\" as=\"other\"/>"
        "<bsdf type=\"diffuse\" id=\"one\"><ref name=\"reflectance\" id=\"t\"/></bsdf>");
    const SheenMaterial *both = material_named(s, "both"), *one = material_named(s, "one");
    assert_true(both->two_sided);
    assert_false(one->two_sided);
    assert_int_equal(one->reflectance.kind, SHEEN_TEXTURE_CHECKERBOARD);
    assert_int_equal(both->reflectance.kind, SHEEN_TEXTURE_CHECKERBOARD);
}

static void colors_and_spectra(void **state)
{
    Kit *k = *state;
    static const struct {
        const char *value;
        Rgb want;
        float eps;
    } cases[] = {
        {"<rgb name=\"reflectance\" value=\"0.5\"/>", {0.5f, 0.5f, 0.5f}, 0.0f},
        {"<rgb name=\"reflectance\" value=\"#ff0080\"/>", {1.0f, 0.0f, 0.50196f}, 1e-5f},
        {"<srgb name=\"reflectance\" value=\"#ff0080\"/>", {1.0f, 0.0f, 0.215861f}, 1e-5f},
        {"<color name=\"reflectance\" value=\"0.1 0.2 0.3\"/>", {0.1f, 0.2f, 0.3f}, 0.0f},
        {"<float name=\"reflectance\" value=\"0.7\"/>", {0.7f, 0.7f, 0.7f}, 0.0f},
        {"<spectrum name=\"reflectance\" value=\"0.25\"/>", {0.25f, 0.25f, 0.25f}, 0.0f},
        {"<spectrum name=\"reflectance\" value=\"300:0.5, 900:0.5\"/>", {0.5f, 0.5f, 0.5f}, 1e-5f},
        // Mitsuba 3; the fit of the matching functions is good to about 1 %.
        {"<spectrum name=\"reflectance\" value=\"400:0.1, 500:0.2, 600:.5, 700:.3\"/>",
         {0.525029f, 0.329035f, 0.127148f},
         0.01f},
        {"<spectrum name=\"reflectance\" filename=\"s.spd\"/>", {0.525029f, 0.329035f, 0.127148f}, 0.01f},
    };
    kit_write(k, "s.spd", "# wavelength value\n400 0.1\n500 0.2\n\n600 0.5 # here\n700 0.3\n");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char body[512];
        snprintf(body, sizeof body, "<bsdf type=\"diffuse\" id=\"m\">%s</bsdf>", cases[i].value);
        kit_assert_rgb(material(k, "3.0.0", body)->reflectance.value, cases[i].want, cases[i].eps);
    }
    // A reflectance above 1 would let light grow.
    const SheenMaterial *m =
        material(k, "3.0.0", "<bsdf type=\"diffuse\" id=\"m\"><rgb name=\"reflectance\" value=\"2 0.5 -1\"/></bsdf>");
    kit_assert_rgb(m->reflectance.value, rgb(1, 0.5f, 0), 0.0f);
    assert_non_null(strstr(k->warnings, "is clamped"));
}

static void lights_of_spectra(void **state)
{
    Kit *k = *state;
#define CONSTANT(value) "<emitter type=\"constant\">" value "</emitter>"
    kit_scene(k, CONSTANT("<rgb name=\"radiance\" value=\"1 2 3\"/>"));
    kit_assert_rgb(k->scene->lights[0].radiance, rgb(1, 2, 3), 0.0f);
    // One number for all wavelengths: equal-energy white in Mitsuba 3 (these values), gray before.
    kit_scene(k, CONSTANT("<spectrum name=\"radiance\" value=\"0.5\"/>"));
    kit_assert_rgb(k->scene->lights[0].radiance, rgb(0.602397f, 0.474146f, 0.454458f), 0.01f);
    assert_int_equal(kit_load_version(k, "0.6.0", CONSTANT("<spectrum name=\"radiance\" value=\"0.5\"/>")), SHEEN_OK);
    kit_assert_rgb(k->scene->lights[0].radiance, rgb_gray(0.5f), 0.0f);
    kit_scene(k, CONSTANT("<spectrum name=\"radiance\" value=\"400:0, 500:4, 600:10, 700:3\"/>"));
    kit_assert_rgb(k->scene->lights[0].radiance, rgb(11.3495f, 6.45602f, 1.25074f), 0.12f); // Mitsuba 3, to 1 %
    kit_scene(k, CONSTANT("<spectrum name=\"radiance\" type=\"blackbody\"><float name=\"temperature\" value=\"6500\"/>"
                          "<float name=\"scale\" value=\"2\"/></spectrum>"));
    Rgb c = k->scene->lights[0].radiance;
    // Its chromaticity, x = 0.3135, y = 0.3237, is sRGB (1.0424, 0.9839, 1.0348) at luminance 1.
    assert_true(fabsf(c.r / c.g - 1.0595f) < 0.01f && fabsf(c.b / c.g - 1.0518f) < 0.01f);
    // Planck's radiance at 555 nm, 6500 K: 4.27e13 W m^-2 sr^-1 m^-1; the luminosity-weighted mean is within 3 %.
    assert_true(fabsf(rgb_luminance(c) / (2.0f * 4.27e4f) - 1.0f) < 0.03f);
}

// ---- textures ---------------------------------------------------------------------------------------------------

/** 2 x 2 floats: top red green, bottom blue white; as PFM, which has no gamma to think of. */
static void write_picture(Kit *k)
{
    static const Rgb pixels[4] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    char path[256];
    kit_path(k, "q.pfm", path);
    assert_int_equal(sheen_image_write(path, &(SheenImageView){.width = 2, .height = 2, .pixels = pixels}, 0, &k->log),
                     SHEEN_OK);
}

static void bitmaps_lie_as_in_mitsuba(void **state)
{
    Kit *k = *state;
    write_picture(k);
#define BITMAP(more)                                                                                                   \
    "<bsdf type=\"diffuse\" id=\"m\"><texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" "         \
    "value=\"q.pfm\"/><string name=\"filter_type\" value=\"nearest\"/>" more "</texture></bsdf>"
    const SheenTexture *t = &material(k, "3.0.0", BITMAP(""))->reflectance;
    // Mitsuba's (u, v) is our (u, 1 - v); its (0.25, 0.25) is red.
    kit_assert_rgb(sheen_texture_eval(t, v2(0.25f, 0.75f)), rgb(1, 0, 0), 0.0f);
    kit_assert_rgb(sheen_texture_eval(t, v2(0.75f, 0.75f)), rgb(0, 1, 0), 0.0f);
    kit_assert_rgb(sheen_texture_eval(t, v2(0.25f, 0.25f)), rgb(0, 0, 1), 0.0f);
    assert_int_equal(t->wrap_u, SHEEN_WRAP_REPEAT);

    t = &material(k, "3.0.0",
                  BITMAP("<transform name=\"to_uv\"><scale x=\"2\"/><translate x=\"0.5\" y=\"0.5\"/>"
                         "</transform>"))
             ->reflectance;
    // Mitsuba's (0.1, 0.25) goes to (0.7, 0.75): white.
    kit_assert_rgb(sheen_texture_eval(t, v2(0.1f, 0.75f)), rgb(1, 1, 1), 0.0f);
    kit_assert_rgb(sheen_texture_eval(t, v2(0.3f, 0.75f)), rgb(0, 0, 1), 0.0f);

    t = &material(k, "0.6.0",
                  BITMAP("<float name=\"vscale\" value=\"0.5\"/><float name=\"uoffset\" value=\"0.5\"/>"
                         "<string name=\"wrapMode\" value=\"clamp\"/>"))
             ->reflectance;
    // Mitsuba's v in [0, 1] covers the upper half only.
    kit_assert_rgb(sheen_texture_eval(t, v2(0.25f, 0.1f)), rgb(0, 1, 0), 0.0f);
    kit_assert_rgb(sheen_texture_eval(t, v2(0.9f, 0.9f)), rgb(0, 1, 0), 0.0f);
    assert_int_equal(t->wrap_v, SHEEN_WRAP_CLAMP);
}

static void checkerboards_lie_as_in_mitsuba(void **state)
{
    Kit *k = *state;
    const SheenTexture *t =
        &material(k, "3.0.0",
                  "<bsdf type=\"diffuse\" id=\"m\"><texture type=\"checkerboard\" name=\"reflectance\">"
                  "<rgb name=\"color0\" value=\"0.9\"/><rgb name=\"color1\" value=\"0.1\"/><transform name=\"to_uv\">"
                  "<scale x=\"3\" y=\"2\"/></transform></texture></bsdf>")
             ->reflectance;
    // Mitsuba 3: (0.1, 0.1), (0.1, 0.4) and (0.2, 0.1) of its own uv, whose v is 1 - v of ours.
    assert_float_equal(sheen_texture_eval(t, v2(0.1f, 0.9f)).r, 0.9f, 0.0f);
    assert_float_equal(sheen_texture_eval(t, v2(0.1f, 0.6f)).r, 0.1f, 0.0f);
    assert_float_equal(sheen_texture_eval(t, v2(0.2f, 0.9f)).r, 0.1f, 0.0f);
}

static void grids_and_scales(void **state)
{
    Kit *k = *state;
#define GRID(name, width)                                                                                              \
    "<bsdf type=\"diffuse\" id=\"m\"><texture type=\"scale\" name=\"reflectance\"><rgb name=\"scale\" "                \
    "value=\"0.5, 0.5, 1\"/><texture type=\"" name "\"><rgb name=\"color0\" value=\"0.8\"/><float name=\"" width       \
    "\" value=\"0.05\"/><float name=\"uscale\" value=\"2\"/></texture></texture></bsdf>"
    const SheenTexture *t = &material(k, "0.5.0", GRID("gridtexture", "lineWidth"))->reflectance;
    assert_int_equal(t->kind, SHEEN_TEXTURE_GRID);
    kit_assert_rgb(sheen_texture_eval(t, v2(0.25f, 0.5f)), rgb(0.4f, 0.4f, 0.8f), 1e-6f);
    kit_assert_rgb(sheen_texture_eval(t, v2(0.51f, 0.5f)), rgb(0.2f, 0.2f, 0.4f), 1e-6f); // color1 is 0.4
    assert_int_equal(k->n_warnings, 2);                                                   // no light, no camera
    material(k, "3.0.0", GRID("grid_texture", "line_width"));
    assert_int_equal(k->n_warnings, 2);
#undef GRID
    t = &material(k, "0.6.0",
                  "<bsdf type=\"diffuse\" id=\"m\"><texture type=\"scale\" name=\"reflectance\"><float name=\"scale\" "
                  "value=\"3\"/><texture type=\"checkerboard\"/></texture></bsdf>")
             ->reflectance;
    kit_assert_rgb(sheen_texture_mean(t), rgb_gray(0.8f), 1e-6f); // 1.2 is clamped to 1, and 0.6
    assert_non_null(strstr(k->warnings, "is outside [0, 1] and is clamped"));
}

static void pictures_are_read_once(void **state)
{
    Kit *k = *state;
    write_picture(k);
    const SheenScene *s = kit_scene(
        k, "<shape type=\"cube\">" BITMAP(
               "") "</shape><shape type=\"cube\"><bsdf type=\"diffuse\">"
                   "<texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" value=\"q.pfm\"/></texture>"
                   "</bsdf></shape>");
    assert_ptr_equal(s->materials[0].reflectance.bitmap.floats, s->materials[1].reflectance.bitmap.floats);
}

static void byte_pictures_are_decoded(void **state)
{
    Kit *k = *state;
    char path[256];
    const Rgb gray = rgb_gray(0.2158605f); // 128 in sRGB
    kit_path(k, "g.png", path);
    assert_int_equal(sheen_image_write(path, &(SheenImageView){.width = 1, .height = 1, .pixels = &gray}, 0, &k->log),
                     SHEEN_OK);
#define PNG(more)                                                                                                      \
    "<bsdf type=\"diffuse\" id=\"m\"><texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" "         \
    "value=\"g.png\"/>" more "</texture></bsdf>"
    kit_assert_rgb(sheen_texture_mean(&material(k, "3.0.0", PNG(""))->reflectance), gray, 1e-5f);
    const float byte = 128.0f / 255.0f;
    kit_assert_rgb(
        sheen_texture_mean(&material(k, "3.0.0", PNG("<boolean name=\"raw\" value=\"true\"/>"))->reflectance),
        rgb_gray(byte), 1e-5f);
    kit_assert_rgb(sheen_texture_mean(&material(k, "0.6.0", PNG("<float name=\"gamma\" value=\"2\"/>"))->reflectance),
                   rgb_gray(byte * byte), 1e-5f);
}

static void maps_turn_and_wrap_pictures(void **state)
{
    Kit *k = *state;
    write_picture(k);
    const SheenTexture *t =
        &material(k, "3.0.0",
                  BITMAP("<transform name=\"to_uv\"><translate x=\"-0.5\" y=\"-0.5\"/><rotate z=\"1\" angle=\"90\"/>"
                         "<translate x=\"0.5\" y=\"0.5\"/></transform>"))
             ->reflectance;
    // Mitsuba's (x, y) goes to (1 - y, x): its (0.25, 0.25) to (0.75, 0.25), green.
    kit_assert_rgb(sheen_texture_eval(t, v2(0.25f, 0.75f)), rgb(0, 1, 0), 0.0f);
    kit_assert_rgb(sheen_texture_eval(t, v2(0.75f, 0.75f)), rgb(1, 1, 1), 0.0f);
    kit_assert_rgb(sheen_texture_eval(t, v2(0.25f, 0.25f)), rgb(1, 0, 0), 0.0f);
    // Mirrored along u, held along v.
    t = &material(k, "0.6.0",
                  BITMAP("<string name=\"wrapModeU\" value=\"mirror\"/><string name=\"wrapModeV\" value=\"clamp\"/>"))
             ->reflectance;
    kit_assert_rgb(sheen_texture_eval(t, v2(1.25f, 0.75f)), rgb(0, 1, 0), 0.0f);
    kit_assert_rgb(sheen_texture_eval(t, v2(0.25f, 1.75f)), rgb(1, 0, 0), 0.0f);
    kit_assert_rgb(sheen_texture_eval(t, v2(1.75f, -0.25f)), rgb(0, 0, 1), 0.0f);
    assert_int_equal(k->n_warnings, 2); // no light, no camera
    t = &material(k, "0.6.0", BITMAP("<string name=\"channel\" value=\"g\"/>"))->reflectance;
    kit_assert_rgb(sheen_texture_eval(t, v2(0.75f, 0.75f)), rgb_gray(1), 0.0f);
    kit_assert_rgb(sheen_texture_eval(t, v2(0.25f, 0.75f)), rgb_gray(0), 0.0f);
    material(k, "0.6.0", BITMAP("<string name=\"channel\" value=\"a\"/>"));
    assert_non_null(strstr(k->warnings, "the channel 'a' of a picture is not supported: its colours stand in"));
}

/** The same two bytes of a picture as a portable pixmap and graymap. */
static void pixmaps_are_pictures(void **state)
{
    Kit *k = *state;
    kit_write(k, "c.ppm", "P6\n# a comment\n1 1\n255\n\x80\x40\x01");
    kit_write(k, "g.pgm", "P5 1 1 255\n\x80");
    const char *const names[] = {"c.ppm", "g.pgm"};
    const Rgb want[] = {{128, 64, 1}, {128, 128, 128}};
    for (int i = 0; i < 2; ++i) {
        char body[512];
        snprintf(body, sizeof body,
                 "<bsdf type=\"diffuse\" id=\"m\"><texture type=\"bitmap\" name=\"reflectance\"><string "
                 "name=\"filename\" value=\"%s\"/><boolean name=\"raw\" value=\"true\"/></texture></bsdf>",
                 names[i]);
        kit_assert_rgb(sheen_texture_mean(&material(k, "3.0.0", body)->reflectance), rgb_scale(want[i], 1.0f / 255.0f),
                       1e-6f);
    }
    kit_write(k, "short.ppm", "P6 2 1 255\nabc");
    char path[256];
    SheenImage image;
    kit_path(k, "short.ppm", path);
    assert_int_equal(sheen_image_read(path, &k->log, &image), SHEEN_ERR_PARSE);
}

// ---- lights and cameras -----------------------------------------------------------------------------------------

static void lights(void **state)
{
    Kit *k = *state;
    const SheenScene *s = kit_scene(
        k,
        "<emitter type=\"point\"><point name=\"position\" x=\"1\" y=\"2\" z=\"3\"/>"
        "<rgb name=\"intensity\" value=\"7\"/></emitter>"
        "<emitter type=\"spot\"><transform name=\"to_world\"><lookat origin=\"0,5,0\" target=\"0,0,0\" up=\"1,0,0\"/>"
        "</transform><float name=\"cutoff_angle\" value=\"60\"/></emitter>"
        "<emitter type=\"directional\"><vector name=\"direction\" x=\"0\" y=\"-2\" z=\"0\"/>"
        "<rgb name=\"irradiance\" value=\"3\"/></emitter>"
        "<shape type=\"rectangle\"><emitter type=\"area\"><rgb name=\"radiance\" value=\"1 2 3\"/></emitter></shape>"
        "<emitter type=\"collimated\"/><emitter type=\"area\"/>"
        "<emitter type=\"area\" id=\"lamp\"><rgb name=\"radiance\" value=\"8\"/></emitter>"
        "<shape type=\"disk\"><ref id=\"lamp\"/></shape>");
    assert_int_equal(s->n_lights, 5);
    assert_float_equal(s->lights[4].radiance.r, 8.0f, 0.0f);
    assert_int_equal(k->n_warnings, 3); // collimated, area on no shape, no camera
    kit_assert_v3(s->lights[0].position, v3(1, 2, 3), 0.0f);
    assert_float_equal(s->lights[0].radiance.g, 7.0f, 0.0f);
    kit_assert_v3(s->lights[1].position, v3(0, 5, 0), 0.0f);
    kit_assert_v3(s->lights[1].direction, v3(0, -1, 0), EPS);
    assert_float_equal(s->lights[1].cos_outer, 0.5f, EPS);
    assert_float_equal(s->lights[1].cos_inner, cosf(0.25f * SHEEN_PI), EPS); // three quarters of the cutoff
    kit_assert_v3(s->lights[2].direction, v3(0, -1, 0), EPS);
    assert_int_equal(s->lights[3].kind, SHEEN_LIGHT_AREA);
    assert_int_equal(s->shapes[s->lights[3].shape].light, 3);
    assert_non_null(strstr(k->warnings, "'collimated' is not supported and is left out"));
}

static void textured_lamps(void **state)
{
    Kit *k = *state;
    const SheenScene *s = kit_scene(
        k, "<shape type=\"rectangle\"><emitter type=\"area\"><texture name=\"radiance\" type=\"checkerboard\">"
           "<rgb name=\"color0\" value=\"4 0 0\"/><rgb name=\"color1\" value=\"0 8 0\"/></texture></emitter></shape>");
    assert_int_equal(k->n_warnings, 1); // of the camera; radiances may be over 1
    assert_non_null(s->lights[0].texture);
    kit_assert_rgb(s->lights[0].radiance, rgb(2, 4, 0), 1e-6f);
    // As in Mitsuba, (0.1, 0.1) of its uv has color0; its v runs downward.
    kit_assert_rgb(sheen_texture_eval(s->lights[0].texture, v2(0.1f, 0.9f)), rgb(4, 0, 0), 0.0f);
    s = kit_scene(k, "<texture type=\"checkerboard\" id=\"t\"><float name=\"color0\" value=\"0\"/><float "
                     "name=\"color1\" value=\"0\"/></texture><shape type=\"sphere\"><emitter type=\"area\">"
                     "<ref name=\"radiance\" id=\"t\"/></emitter></shape>");
    assert_int_equal(s->n_lights, 0); // black
}

static void environments(void **state)
{
    Kit *k = *state;
    write_picture(k);
    const SheenScene *s = kit_scene(
        k, "<emitter type=\"envmap\"><string name=\"filename\" value=\"q.pfm\"/><float name=\"scale\" value=\"2\"/>"
           "<transform name=\"to_world\"><rotate x=\"1\" angle=\"90\"/></transform></emitter>");
    const SheenLight *l = &s->lights[s->environment];
    assert_int_equal(l->environment.width, 2);
    kit_assert_rgb(l->environment.floats[1], rgb(0, 1, 0), 0.0f);
    assert_float_equal(l->radiance.b, 2.0f, 0.0f);
    kit_assert_v3(transform_vector(&l->to_world, v3(0, 1, 0)), v3(0, 0, 1), EPS);
    kit_assert_v3(transform_vector(&l->to_light, v3(0, 0, 1)), v3(0, 1, 0), EPS);
}

static void skies_and_suns(void **state)
{
    Kit *k = *state;
    const double candelas = 683.0 * 106.86;
    static const struct {
        const char *version, *sun, *haze;
        Vec3 up;
    } cases[] = {{"3.0.0", "<vector name=\"sun_direction\" x=\"0.6\" z=\"0.8\"/>", "sky_scale", {0, 0, 1}},
                 {"0.5.0", "<vector name=\"sunDirection\" x=\"0.6\" y=\"0.8\"/>", "skyScale", {0, 1, 0}},
                 {"0.6.0", "<vector name=\"sunDirection\" z=\"-0.6\" y=\"0.8\"/>", "skyScale", {0, 1, 0}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char body[512];
        snprintf(body, sizeof body,
                 "<emitter type=\"sunsky\">%s<float name=\"%s\" value=\"30\"/><float name=\"turbidity\" value=\"4\"/>"
                 "</emitter>",
                 cases[i].sun, cases[i].haze);
        assert_int_equal(kit_load_version(k, cases[i].version, body), SHEEN_OK);
        const SheenScene *s = k->scene;
        assert_int_equal(s->n_lights, 2);
        assert_int_equal(k->n_warnings, 1); // no camera
        const SheenLight *sky = &s->lights[s->environment], *sun = &s->lights[1];
        Vec3 to_sun = v3_neg(sun->direction);
        assert_float_equal(v3_dot(to_sun, cases[i].up), 0.8f, EPS);
        float zenith = rgb_luminance(sheen_environment_radiance(sky, cases[i].up));
        // The pixels at the pole are all the zenith; sRGB's matrix has four digits.
        assert_true(fabs((double)zenith * candelas / (30.0 * sheen_sky_zenith(4.0, acos(0.8))) - 1.0) < 1e-3);
        Vec3 mirrored = v3_sub(v3_scale(cases[i].up, 1.6f), to_sun);
        assert_true(sheen_environment_radiance(sky, to_sun).g > 2.0f * sheen_environment_radiance(sky, mirrored).g);
        assert_true(rgb_is_black(sheen_environment_radiance(sky, v3_scale(cases[i].up, -1.0f))));
        kit_assert_rgb(sun->radiance, sheen_sun_irradiance(4.0, acos(0.8)), 1e-5f);
        assert_float_equal(sun->disk, 0.0046757f, 1e-6f); // half of 0.5358 degrees
    }
    const SheenScene *wide = kit_scene(k, "<emitter type=\"sun\"><float name=\"sun_aperture\" value=\"2\"/></emitter>");
    assert_float_equal(wide->lights[0].disk, 0.0174533f, 1e-6f);
    assert_int_equal(
        kit_load_version(k, "0.6.0", "<emitter type=\"sun\"><float name=\"sunRadiusScale\" value=\"0\"/></emitter>"),
        SHEEN_OK);
    assert_true(k->scene->lights[0].disk == 0.0f);
    wide = kit_scene(k, "<emitter type=\"sun\"><float name=\"sun_aperture\" value=\"-1\"/></emitter>");
    assert_float_equal(wide->lights[0].disk, 0.0046757f, 1e-6f);
    assert_non_null(strstr(k->warnings, "scene.xml:2:1: the sun's width of -1 degrees is outside [0, 90]"));
    // Mitsuba 3.9 has the sky of its default, a summer afternoon in Tokyo, brightest over (0.0698, 0.9976).
    const SheenScene *s = kit_scene(k, "<emitter type=\"sun\"/>");
    Vec3 to_sun = v3_neg(s->lights[0].direction);
    assert_true(to_sun.y > 0.0f && to_sun.z > 0.0f);
    assert_float_equal(to_sun.x / to_sun.y, 0.0698f, 0.02f); // it was looked for in steps of two degrees
    kit_scene(k, "<emitter type=\"sky\"><float name=\"turbidity\" value=\"1\"/></emitter>");
    assert_non_null(strstr(k->warnings, "the turbidity 1 is outside [2, 10]"));
    s = kit_scene(k, "<emitter type=\"sunsky\"/>\n<emitter type=\"sunsky\"/>");
    assert_int_equal(s->n_lights, 3);
    assert_non_null(strstr(k->warnings, "scene.xml:3:1: a second sky is left out"));
    s = kit_scene(k, "<emitter type=\"sunsky\"><vector name=\"sun_direction\" z=\"-1\"/></emitter>");
    assert_int_equal(s->n_lights, 0);
    assert_non_null(strstr(k->warnings, "scene.xml:2:1: the sun of 'sunsky' is below the horizon"));
}

static void cameras(void **state)
{
    Kit *k = *state;
    static const struct {
        const char *fov;
        double degrees;
    } cases[] = {
        // Mitsuba 3 for 200 x 100 pixels.
        {"<float name=\"fov\" value=\"40\"/>", 40},
        {"<float name=\"fov\" value=\"40\"/><string name=\"fov_axis\" value=\"y\"/>", 72.10477447509766},
        {"<float name=\"fov\" value=\"40\"/><string name=\"fovAxis\" value=\"diagonal\"/>", 36.064788818359375},
        {"<float name=\"fov\" value=\"40\"/><string name=\"fovAxis\" value=\"smaller\"/>", 72.10477447509766},
        {"<float name=\"fov\" value=\"40\"/><string name=\"fovAxis\" value=\"larger\"/>", 40},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char body[1024];
        snprintf(body, sizeof body,
                 "<sensor type=\"perspective\" id=\"eye\">%s<transform name=\"toWorld\"><lookat origin=\"0,0,4\" "
                 "target=\"0,0,0\" up=\"0,1,0\"/></transform><sampler type=\"independent\"><integer "
                 "name=\"sampleCount\" value=\"64\"/></sampler><film type=\"hdrfilm\"><integer name=\"width\" "
                 "value=\"200\"/><integer name=\"height\" value=\"100\"/></film></sensor>",
                 cases[i].fov);
        const SheenCamera *c = &kit_scene(k, body)->cameras[0];
        assert_true(fabs((double)c->fov_x * 180.0 / 3.14159265358979 - cases[i].degrees) < 1e-4);
        assert_int_equal(c->width, 200);
        assert_int_equal(c->height, 100);
        assert_int_equal(c->spp, 64);
        assert_string_equal(c->name, "eye");
        kit_assert_v3(transform_vector(&c->to_world, v3(0, 0, 1)), v3(0, 0, -1), EPS);
    }
    // Neither angle nor focal length: 50 mm on a film of 36 x 24 mm (Mitsuba 3), 768 x 576 pixels.
    const SheenCamera *c = &kit_scene(k, "<sensor type=\"spherical\"/>")->cameras[0];
    assert_true(fabs((double)c->fov_x * 180.0 / 3.14159265358979 - 38.1848) < 1e-4);
    assert_int_equal(c->width, 768);
    assert_non_null(strstr(k->warnings, "'spherical' is not supported: a perspective camera stands in"));
}

static void other_cameras(void **state)
{
    Kit *k = *state;
    const SheenScene *s =
        kit_scene(k, "<sensor type=\"orthographic\"><float name=\"near_clip\" value=\"1\"/></sensor>");
    assert_true(s->cameras[0].orthographic);
    assert_int_equal(k->n_warnings, 1); // no light
    static const struct {
        const char *version, *aperture, *focus, *shift;
    } spellings[] = {{"0.5.0", "apertureRadius", "focusDistance", "principalPointOffsetX"},
                     {"3.0.0", "aperture_radius", "focus_distance", "principal_point_offset_x"}};
    for (size_t i = 0; i < sizeof spellings / sizeof *spellings; ++i) {
        char body[1024];
        snprintf(body, sizeof body,
                 "<sensor type=\"thinlens\"><float name=\"fov\" value=\"40\"/><float name=\"%s\" value=\"0.2\"/>"
                 "<float name=\"%s\" value=\"7\"/><float name=\"%s\" value=\"0.1\"/></sensor>",
                 spellings[i].aperture, spellings[i].focus, spellings[i].shift);
        assert_int_equal(kit_load_version(k, spellings[i].version, body), SHEEN_OK);
        const SheenCamera *c = &k->scene->cameras[0];
        assert_float_equal(c->aperture, 0.2f, 0.0f);
        assert_float_equal(c->focus, 7.0f, 0.0f);
        assert_float_equal(c->cut_lo.x, 0.1f, 0.0f);
        assert_float_equal(c->cut_hi.x, -0.1f, 0.0f);
        assert_int_equal(k->n_warnings, 1);
    }
    // A window of a film: the angle remains the whole film's, along y here.
    s = kit_scene(k, "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/><string name=\"fov_axis\" "
                     "value=\"y\"/><film type=\"hdrfilm\"><integer name=\"width\" value=\"200\"/><integer "
                     "name=\"height\" value=\"100\"/><integer name=\"crop_offset_x\" value=\"50\"/><integer "
                     "name=\"cropOffsetY\" value=\"25\"/><integer name=\"crop_width\" value=\"20\"/><integer "
                     "name=\"crop_height\" value=\"50\"/></film></sensor>");
    const SheenCamera *c = &s->cameras[0];
    assert_int_equal(c->width, 20);
    assert_int_equal(c->height, 50);
    assert_float_equal(c->fov_x * 180.0f / SHEEN_PI, 72.10477f, 1e-4f); // as above
    assert_float_equal(c->cut_lo.x, 0.25f, 0.0f);
    assert_float_equal(c->cut_hi.x, 0.65f, 1e-7f);
    assert_float_equal(c->cut_lo.y, 0.25f, 0.0f);
    assert_float_equal(c->cut_hi.y, 0.25f, 0.0f);
    assert_int_equal(k->n_warnings, 1); // no light
}

static const SheenFilter *filter_of(Kit *k, const char *rfilter)
{
    char body[512];
    snprintf(body, sizeof body, "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/>%s</sensor>", rfilter);
    return &kit_scene(k, body)->cameras[0].filter;
}

static void reconstruction_filters(void **state)
{
    Kit *k = *state;
    static const struct {
        const char *text;
        SheenFilter want;
    } cases[] = {
        {"", {SHEEN_FILTER_GAUSSIAN, 2.0f, 0.5f, 0, 0}},
        {"<film type=\"hdrfilm\"/>", {SHEEN_FILTER_GAUSSIAN, 2.0f, 0.5f, 0, 0}},
        {"<film type=\"hdrfilm\"><rfilter type=\"box\"/></film>", {SHEEN_FILTER_BOX, 0.5f, 0, 0, 0}},
        {"<film type=\"hdrfilm\"><rfilter type=\"tent\"/></film>", {SHEEN_FILTER_TENT, 1.0f, 0, 0, 0}},
        {"<film type=\"hdrfilm\"><rfilter type=\"tent\"><float name=\"radius\" value=\"1.5\"/></rfilter></film>",
         {SHEEN_FILTER_TENT, 1.5f, 0, 0, 0}},
        {"<film type=\"ldrfilm\"><rfilter type=\"gaussian\"><float name=\"stddev\" value=\"0.25\"/></rfilter></film>",
         {SHEEN_FILTER_GAUSSIAN, 1.0f, 0.25f, 0, 0}},
        {"<film type=\"hdrfilm\"><rfilter type=\"mitchell\"/></film>",
         {SHEEN_FILTER_MITCHELL, 2.0f, 0, 1.0f / 3.0f, 1.0f / 3.0f}},
        {"<film type=\"hdrfilm\"><rfilter type=\"mitchell\"><float name=\"B\" value=\"0.25\"/><float name=\"C\" "
         "value=\"0.5\"/></rfilter></film>",
         {SHEEN_FILTER_MITCHELL, 2.0f, 0, 0.25f, 0.5f}},
        {"<film type=\"hdrfilm\"><rfilter type=\"catmullrom\"/></film>", {SHEEN_FILTER_CATMULL_ROM, 2.0f, 0, 0, 0.5f}},
        {"<film type=\"hdrfilm\"><rfilter type=\"lanczos\"/></film>", {SHEEN_FILTER_LANCZOS, 3.0f, 0, 0, 0}},
        {"<film type=\"hdrfilm\"><rfilter type=\"lanczos\"><integer name=\"lobes\" value=\"2\"/></rfilter></film>",
         {SHEEN_FILTER_LANCZOS, 2.0f, 0, 0, 0}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const SheenFilter *f = filter_of(k, cases[i].text), *want = &cases[i].want;
        assert_int_equal(f->kind, want->kind);
        assert_true(f->radius == want->radius && f->stddev == want->stddev && f->b == want->b && f->c == want->c);
        assert_int_equal(k->n_warnings, 1); // no light
    }
    assert_int_equal(filter_of(k, "<film type=\"hdrfilm\"><rfilter type=\"wsinc\"/></film>")->kind,
                     SHEEN_FILTER_GAUSSIAN);
    assert_non_null(strstr(k->warnings, "the reconstruction filter 'wsinc' is not supported: 'gaussian' stands in"));
    filter_of(k, "<film type=\"hdrfilm\"><rfilter type=\"box\"><float name=\"radius\" value=\"2\"/></rfilter></film>");
    assert_non_null(strstr(k->warnings, "<float name=\"radius\"> is not supported in <rfilter type=\"box\">"));
    kit_refused(k,
                "<sensor type=\"perspective\"><film type=\"hdrfilm\"><rfilter type=\"gaussian\"><float name=\"stddev\" "
                "value=\"0\"/></rfilter></film></sensor>",
                SHEEN_ERR_PARSE, "scene.xml:2:74", "'stddev' of a reconstruction filter must be 0.00025 to 4, not 0");
}

// ---- the language -----------------------------------------------------------------------------------------------

static void parameters_and_includes(void **state)
{
    Kit *k = *state;
    kit_write(k, "part.xml",
              "<scene version=\"3.0.0\"><default name=\"r\" value=\"9\"/><default name=\"after\" value=\"0.5\"/>"
              "<shape type=\"sphere\"><float name=\"radius\" value=\"$r\"/></shape></scene>");
    const SheenScene *s = kit_scene(
        k, "<default name=\"r\" value=\"2\"/><default name=\"r\" value=\"3\"/><default name=\"x\" value=\"-$r\"/>"
           "<include filename=\"part.xml\"/><shape type=\"disk\"><transform name=\"to_world\">"
           "<translate value=\"$x,$r.5,$after\"/></transform></shape>");
    assert_int_equal(s->n_shapes, 2);
    assert_float_equal(s->shapes[0].sphere.radius, 2.0f, 0.0f); // the first definition holds
    kit_assert_v3(s->shapes[1].disk.center, v3(-2, 2.5f, 0.5f), 0.0f);
}

static void what_is_not_known_is_named_and_ignored(void **state)
{
    Kit *k = *state;
    kit_scene(k, "<shape type=\"cube\" colour=\"red\">\n<float name=\"wobble\" value=\"1\"/>\n"
                 "<hide name=\"to_world\"/></shape>\n<wibble/>\n<shape type=\"sdfgrid\"/>");
    assert_non_null(strstr(k->warnings, "scene.xml:2:1: the attribute 'colour' of <shape> is not known"));
    assert_non_null(
        strstr(k->warnings, "scene.xml:3:1: <float name=\"wobble\"> is not supported in <shape type=\"cube\">"));
    assert_non_null(strstr(k->warnings, "scene.xml:4:1: <hide name=\"to_world\"> is not supported"));
    assert_non_null(strstr(k->warnings, "scene.xml:5:1: <wibble> is not supported"));
    assert_non_null(strstr(k->warnings, "scene.xml:6:1: the shape 'sdfgrid' is not supported and is left out"));
}

static void both_spellings_mean_the_same(void **state)
{
    Kit *k = *state;
    kit_write(k, "t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nf 1//1 2//1 3//1\n");
    kit_scene(k, "<shape type=\"obj\"><string name=\"filename\" value=\"t.obj\"/>"
                 "<boolean name=\"faceNormals\" value=\"true\"/></shape>"
                 "<shape type=\"obj\"><string name=\"filename\" value=\"t.obj\"/>"
                 "<boolean name=\"face_normals\" value=\"true\"/></shape>");
    assert_null(k->scene->shapes[0].mesh.n);
    assert_null(k->scene->shapes[1].mesh.n);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        KIT_TEST(transforms_compose_in_order),
        KIT_TEST(rectangle_and_cube),
        KIT_TEST(front_sides_follow_mitsuba),
        KIT_TEST(spheres_and_disks),
        KIT_TEST(an_ellipsoid_becomes_triangles),
        KIT_TEST(meshes_keep_their_texture_orientation),
        KIT_TEST(cylinders),
        KIT_TEST(normals_by_the_largest_smooth_angle),
        KIT_TEST(shapes_that_are_not_there_are_named),
        KIT_TEST(shape_groups_and_instances),
        KIT_TEST(supported_materials),
        KIT_TEST(stand_ins_are_named_once),
        KIT_TEST(rough_materials_and_plastics),
        KIT_TEST(empirical_materials),
        KIT_TEST(principled_materials),
        KIT_TEST(materials_inside_others),
        KIT_TEST(broken_materials_are_mended_with_a_line),
        KIT_TEST(nested_references_and_aliases),
        KIT_TEST(colors_and_spectra),
        KIT_TEST(lights_of_spectra),
        KIT_TEST(bitmaps_lie_as_in_mitsuba),
        KIT_TEST(checkerboards_lie_as_in_mitsuba),
        KIT_TEST(grids_and_scales),
        KIT_TEST(pictures_are_read_once),
        KIT_TEST(byte_pictures_are_decoded),
        KIT_TEST(maps_turn_and_wrap_pictures),
        KIT_TEST(pixmaps_are_pictures),
        KIT_TEST(lights),
        KIT_TEST(textured_lamps),
        KIT_TEST(environments),
        KIT_TEST(skies_and_suns),
        KIT_TEST(cameras),
        KIT_TEST(other_cameras),
        KIT_TEST(reconstruction_filters),
        KIT_TEST(parameters_and_includes),
        KIT_TEST(what_is_not_known_is_named_and_ignored),
        KIT_TEST(both_spellings_mean_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
