// SPDX-License-Identifier: Apache-2.0
// Shapes of Mitsuba scenes, placed into world space, or into the space of their group.
//
// Mirroring transforms, found by asking Mitsuba 3: it transforms vertices and normals and keeps the order of the
// vertices, and what it takes for the front side (of lights and one-sided materials) is the side of the shading normal.
// So meshes with normals are given the vertex order that agrees with them, and meshes without take the side that the
// mirrored order gives. A mirrored sphere is turned inside out, a mirrored disk is not.
#include "image/image.h"
#include "image/whole_file.h"
#include "io/mesh_smooth.h"
#include "io/mitsuba.h"
#include "io/primitive.h"

#include <stdlib.h>
#include <string.h>

/** @return false for a shape that is left out. */
typedef bool ReadFn(Mitsuba *m, SheenXml *e, SheenShape *out);

typedef struct Plugin {
    const char *name;
    ReadFn *read;
} Plugin;

static bool no_memory(Mitsuba *m, const SheenXml *e)
{
    sheen_mi_fail(m, SHEEN_ERR_NOMEM, e, "out of memory");
    return false;
}

// ---- meshes -----------------------------------------------------------------------------------------------------

static void flip_v(MeshData *mesh)
{
    for (uint32_t i = 0; mesh->uv && i < mesh->n_vertices; ++i) mesh->uv[i].y = 1.0f - mesh->uv[i].y;
}

/** Places a mesh and settles its front side. @param flat  drop the normals then: each face is flat */
static bool place_mesh(Mitsuba *m, SheenXml *e, MeshData *mesh, bool flat, SheenShape *out)
{
    Transform to_world = sheen_mi_transform(m, e, "to_world");
    bool flip = sheen_mi_bool(m, e, "flip_normals", false);
    if (m->status) return false;
    if (!sheen_mesh_place(mesh, &to_world) && mesh->n_triangles)
        sheen_xml_warn(m->log, e, "the transform is singular: the shape is flattened");
    sheen_mesh_face_normals_side(mesh);
    if (flip) sheen_mesh_flip(mesh);
    if (flat) mesh->n = NULL;
    out->kind = SHEEN_SHAPE_MESH;
    out->mesh = sheen_mesh_finish(mesh);
    return true;
}

/** Up to version 0.6 colours are in the sRGB curve unless a mesh says otherwise, from version 2 on linear. */
static void decode_colors(Mitsuba *m, const SheenXml *e, MeshData *mesh)
{
    if (!sheen_mi_bool(m, e, "srgb", m->version < 2)) return;
    Rgb *colors[] = {mesh->color, mesh->face_color};
    const uint32_t n[] = {mesh->n_vertices, mesh->n_triangles};
    for (int k = 0; k < 2; ++k)
        for (uint32_t i = 0; colors[k] && i < n[k]; ++i) {
            Rgb c = colors[k][i];
            colors[k][i] = rgb(sheen_srgb_decode(c.r), sheen_srgb_decode(c.g), sheen_srgb_decode(c.b));
        }
}

typedef enum MeshFormat { MESH_OBJ, MESH_PLY, MESH_SERIALIZED } MeshFormat;

/** Reads the file that an element names. @param face_normals  whether the file asks for them */
static bool read_mesh(Mitsuba *m, const SheenXml *e, MeshFormat format, MeshData *mesh, bool *face_normals)
{
    const char *path = sheen_mi_path(m, e, "filename", "mesh");
    int64_t index = format == MESH_SERIALIZED ? sheen_mi_integer(m, e, "shape_index", 0) : 0;
    if (index < 0 || index >= SHEEN_NONE) sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "'shape_index' is out of range");
    if (m->status) return false;
    uint8_t *data;
    size_t size;
    SheenStatus s = sheen_file_read(path, m->log, &data, &size);
    if (!s) {
        const char *text = (const char *)data;
        *face_normals = false;
        if (format == MESH_OBJ)
            s = sheen_obj_parse(text, size, path, m->arena, m->log, mesh);
        else if (format == MESH_PLY)
            s = sheen_ply_parse(text, size, path, m->arena, m->log, mesh);
        else
            s = sheen_serialized_parse(text, size, path, (uint32_t)index, m->arena, m->log, mesh, face_normals);
        free(data);
    }
    if (s) m->status = s; // reported with the file's own place
    return !s;
}

static bool read_mesh_file(Mitsuba *m, SheenXml *e, MeshFormat format, SheenShape *out)
{
    MeshData mesh;
    bool face_normals, v_is_up = format == MESH_OBJ;
    if (!read_mesh(m, e, format, &mesh, &face_normals)) return false;
    // Mitsuba's v runs downward in a picture. It turns the v of OBJ, which runs upward as ours does, and not that of
    // the other formats.
    if (sheen_mi_bool(m, e, "flip_tex_coords", v_is_up) != v_is_up) v_is_up = !v_is_up;
    if (!v_is_up) flip_v(&mesh);
    decode_colors(m, e, &mesh);
    face_normals = sheen_mi_bool(m, e, "face_normals", face_normals);
    if (face_normals) mesh.n = NULL;
    sheen_mi_ignore(e, "collapse shape_index");
    // Normals are made after placing the mesh: where there are none, and anew where edges are told by their angle.
    bool edges = sheen_mi_child(e, "max_smooth_angle") && !face_normals;
    double max_angle = sheen_mi_float(m, e, "max_smooth_angle", 180.0) * (3.14159265358979323846 / 180.0);
    bool smooth = !face_normals && !mesh.n;
    if (!place_mesh(m, e, &mesh, false, out)) return false;
    if (edges ? !sheen_mesh_smooth_edges(m->arena, &mesh, NULL, (float)max_angle)
              : smooth && !sheen_mesh_smooth(m->arena, &mesh))
        return no_memory(m, e);
    out->mesh = sheen_mesh_finish(&mesh);
    return true;
}

static bool read_obj(Mitsuba *m, SheenXml *e, SheenShape *out)
{
    return read_mesh_file(m, e, MESH_OBJ, out);
}

static bool read_ply(Mitsuba *m, SheenXml *e, SheenShape *out)
{
    return read_mesh_file(m, e, MESH_PLY, out);
}

static bool read_serialized(Mitsuba *m, SheenXml *e, SheenShape *out)
{
    return read_mesh_file(m, e, MESH_SERIALIZED, out);
}

static bool read_rectangle(Mitsuba *m, SheenXml *e, SheenShape *out)
{
    MeshData mesh;
    if (!sheen_primitive_rectangle(m->arena, &mesh)) return no_memory(m, e);
    return place_mesh(m, e, &mesh, true, out);
}

static bool read_cube(Mitsuba *m, SheenXml *e, SheenShape *out)
{
    MeshData mesh;
    if (!sheen_primitive_cube(m->arena, &mesh)) return no_memory(m, e);
    return place_mesh(m, e, &mesh, true, out);
}

// ---- spheres and disks ------------------------------------------------------------------------------------------

/** @return true when the transform keeps shapes: rotation, uniform scale, reflection. Scale files round to 1e-4. */
static bool is_similarity(const Vec3 axis[3])
{
    float l = v3_length(axis[0]);
    for (int i = 0; i < 3; ++i)
        if (!(fabsf(v3_length(axis[i]) - l) <= 1e-3f * l && fabsf(v3_dot(axis[i], axis[(i + 1) % 3])) <= 1e-3f * l * l))
            return false;
    return l > 0.0f;
}

static bool read_sphere(Mitsuba *m, SheenXml *e, SheenShape *out)
{
    Transform t = sheen_mi_transform(m, e, "to_world");
    Vec3 center = sheen_mi_vector(m, e, "center", v3(0, 0, 0));
    float radius = (float)sheen_mi_float(m, e, "radius", 1.0);
    bool flip = sheen_mi_bool(m, e, "flip_normals", false);
    Vec3 axis[3] = {transform_vector(&t, v3(1, 0, 0)), transform_vector(&t, v3(0, 1, 0)),
                    transform_vector(&t, v3(0, 0, 1))};
    if (!is_similarity(axis)) {
        MeshData mesh;
        sheen_xml_warn(m->log, e, "the transform makes the sphere an ellipsoid: triangles stand in");
        if (!sheen_primitive_sphere(m->arena, &mesh)) return no_memory(m, e);
        for (uint32_t i = 0; i < mesh.n_vertices; ++i) mesh.p[i] = v3_mad(center, radius, mesh.p[i]);
        return place_mesh(m, e, &mesh, false, out);
    }
    out->kind = SHEEN_SHAPE_SPHERE;
    out->sphere.center = transform_point(&t, center);
    out->sphere.radius = radius * v3_length(axis[0]);
    out->sphere.flip = flip != (transform_determinant(&t) < 0.0);
    // uv from the azimuth and the polar angle as in Mitsuba; about -z, so that v runs upward.
    out->sphere.frame = (Frame){v3_normalize(axis[0]), v3_normalize(axis[1]), v3_neg(v3_normalize(axis[2]))};
    return true;
}

static bool read_disk(Mitsuba *m, SheenXml *e, SheenShape *out)
{
    Transform t = sheen_mi_transform(m, e, "to_world"), inverse;
    bool flip = sheen_mi_bool(m, e, "flip_normals", false);
    if (!transform_invert(&t, &inverse)) {
        sheen_xml_warn(m->log, e, "the transform is singular: the disk is left out");
        return false;
    }
    Vec3 n = transform_normal(&inverse, v3(0, 0, 1));
    out->kind = SHEEN_SHAPE_DISK;
    out->disk.center = transform_point(&t, v3(0, 0, 0));
    out->disk.du = transform_vector(&t, v3(1, 0, 0));
    out->disk.dv = transform_vector(&t, v3(0, -1, 0)); // Mitsuba's v, the azimuth, turned round
    out->disk.n = flip ? v3_neg(n) : n;
    return true;
}

/** A tube from p0 to p1; a negative radius only turns the azimuth, as in Mitsuba. */
static bool read_cylinder(Mitsuba *m, SheenXml *e, SheenShape *out)
{
    Vec3 p0 = sheen_mi_vector(m, e, "p0", v3(0, 0, 0)), p1 = sheen_mi_vector(m, e, "p1", v3(0, 0, 1));
    float radius = (float)sheen_mi_float(m, e, "radius", 1.0);
    Vec3 axis = v3_sub(p1, p0);
    float length = v3_length(axis);
    if (!(length > 0.0f && isfinite(length))) {
        sheen_xml_warn(m->log, e, "a cylinder from a point to itself is left out");
        return false;
    }
    Frame frame = frame_from_normal(v3_scale(axis, 1.0f / length));
    MeshData mesh;
    if (!sheen_primitive_tube(m->arena, &mesh)) return no_memory(m, e);
    for (uint32_t i = 0; i < mesh.n_vertices; ++i) {
        Vec3 p = mesh.p[i];
        mesh.p[i] = v3_add(p0, frame_to_world(&frame, v3(radius * p.x, radius * p.y, length * p.z)));
        mesh.n[i] = frame_to_world(&frame, v3_scale(mesh.n[i], radius < 0.0f ? -1.0f : 1.0f));
    }
    return place_mesh(m, e, &mesh, false, out);
}

// ---- curves and height fields -----------------------------------------------------------------------------------

static bool read_curves(Mitsuba *m, SheenXml *e, MitsubaCurve kind, SheenShape *out)
{
    MeshData mesh;
    if (!sheen_mi_curves(m, e, kind, &mesh)) return false;
    out->kind = SHEEN_SHAPE_MESH;
    out->mesh = sheen_mesh_finish(&mesh);
    return true;
}

static bool read_linear_curves(Mitsuba *m, SheenXml *e, SheenShape *out)
{
    return read_curves(m, e, MITSUBA_CURVE_LINEAR, out);
}

static bool read_splines(Mitsuba *m, SheenXml *e, SheenShape *out)
{
    return read_curves(m, e, MITSUBA_CURVE_SPLINE, out);
}

static bool read_hair(Mitsuba *m, SheenXml *e, SheenShape *out)
{
    return read_curves(m, e, MITSUBA_CURVE_HAIR, out);
}

static bool read_height_field(Mitsuba *m, SheenXml *e, SheenShape *out)
{
    MeshData mesh;
    bool smooth = sheen_mi_bool(m, e, "shading_normals", true);
    if (!sheen_mi_height_field(m, e, &mesh) || !place_mesh(m, e, &mesh, false, out)) return false;
    if (smooth && !sheen_mesh_smooth(m->arena, &mesh)) return no_memory(m, e);
    out->mesh = sheen_mesh_finish(&mesh);
    return true;
}

// ---- all shapes -------------------------------------------------------------------------------------------------

static const Plugin plugins[] = {
    {"obj", read_obj},
    {"ply", read_ply},
    {"rectangle", read_rectangle},
    {"cube", read_cube},
    {"sphere", read_sphere},
    {"disk", read_disk},
    {"serialized", read_serialized},
    {"cylinder", read_cylinder},
    {"linearcurve", read_linear_curves},
    {"bsplinecurve", read_splines},
    {"hair", read_hair},
    {"heightfield", read_height_field},
};

static void add_area_light(Mitsuba *m, SheenXml *emitter, uint32_t shape, bool in_group)
{
    if (!sheen_mi_same(sheen_mi_type(emitter), "area")) {
        sheen_xml_warn(m->log, emitter, "the light '%s' on a shape is not supported and is left out",
                       sheen_mi_type(emitter));
        return;
    }
    if (in_group) {
        sheen_xml_warn(m->log, emitter, "a light inside a shapegroup is not supported and is left out");
        return;
    }
    SheenXml *radiance = sheen_mi_child(emitter, "radiance");
    SheenXml *value = radiance ? sheen_mi_resolve(m, radiance) : NULL;
    SheenTexture texture = sheen_texture_constant(rgb_gray(1.0f));
    if (value) texture = sheen_mi_texture_of(m, value, MITSUBA_EMISSION, texture.value);
    sheen_mi_ignore(emitter, "sampling_weight");
    sheen_mi_report_unused(m, emitter);
    if (!m->status) sheen_builder_add_textured_area_light(m->builder, shape, &texture);
}

/** For messages: the id, else the file's or the plugin's name. */
static const char *name_of(Mitsuba *m, const SheenXml *e)
{
    const char *id = sheen_xml_attribute(e, "id");
    return sheen_arena_strdup(m->arena, id ? id : sheen_mi_string(m, e, "filename", sheen_mi_type(e)));
}

/** In version 0.6 the border of a medium that has no material is not seen. */
static bool has_medium(Mitsuba *m, const SheenXml *e)
{
    for (SheenXml *c = e->first; c && !m->status; c = c->next) {
        const SheenXml *target = sheen_mi_resolve(m, c);
        if (target && strcmp(target->tag, "medium") == 0) return true;
    }
    return false;
}

void sheen_mi_shape(Mitsuba *m, SheenXml *e, bool in_group)
{
    const Plugin *plugin = NULL;
    for (size_t i = 0; i < sizeof plugins / sizeof *plugins; ++i)
        if (sheen_mi_same(plugins[i].name, sheen_mi_type(e))) plugin = &plugins[i];
    if (!plugin) {
        sheen_xml_warn(m->log, e, "the shape '%s' is not supported and is left out", sheen_mi_type(e));
        return;
    }
    SheenShape shape = {.name = name_of(m, e)};
    if (!plugin->read(m, e, &shape)) return;
    SheenXml *bsdf = sheen_mi_nested(m, e, "bsdf"), *emitter = sheen_mi_nested(m, e, "emitter");
    if (m->status) return;
    bool clear = !bsdf && !emitter && m->version == 0 && has_medium(m, e);
    if (m->status) return;
    shape.material = clear              ? sheen_mi_clear_material(m)
                     : emitter && !bsdf ? sheen_mi_lamp_material(m)
                                        : sheen_mi_material(m, bsdf);
    uint32_t index = sheen_builder_add_shape(m->builder, &shape);
    if (emitter) add_area_light(m, emitter, index, in_group);
    sheen_mi_ignore(e, "silhouette_sampling_weight");
    if (!m->status) sheen_mi_report_unused(m, e);
}

void sheen_mi_shape_group(Mitsuba *m, SheenXml *e)
{
    e->index = sheen_builder_begin_group(m->builder);
    for (SheenXml *c = e->first; c && !m->status; c = c->next) {
        SheenXml *shape = sheen_mi_resolve(m, c);
        if (!shape || strcmp(shape->tag, "shape") != 0) continue;
        c->used = true;
        if (sheen_mi_same(sheen_mi_type(shape), "instance") || sheen_mi_same(sheen_mi_type(shape), "shapegroup"))
            sheen_xml_warn(m->log, c, "a shapegroup inside a shapegroup is not supported and is left out");
        else
            sheen_mi_shape(m, shape, true);
    }
    sheen_builder_end_group(m->builder);
    if (!m->status) sheen_mi_report_unused(m, e);
}
