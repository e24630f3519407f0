// SPDX-License-Identifier: Apache-2.0
#include "io/obj_scene.h"

#include "image/whole_file.h"
#include "io/file_path.h"
#include "io/mesh_smooth.h"
#include "io/mtl_material.h"
#include "io/obj.h"
#include "scene/builder.h"

#include <stdlib.h>
#include <string.h>

typedef struct Reader {
    const char *path;
    const SheenLog *log;
    SheenBuilder *builder;
    SheenArena *arena;   // of the scene
    SheenArena *scratch; // gone after reading
    ObjFile file;
    MtlMaterial *materials; // [file.n_materials + 1], by index of usemtl; the last is the default
    uint32_t *indices;      // [file.n_materials + 1] into the scene's materials
    bool *found;            // [file.n_materials]
    uint32_t n_libraries, n_lights;
} Reader;

static SheenStatus no_memory(const Reader *r)
{
    return sheen_fail(r->log, SHEEN_ERR_NOMEM, "%s: out of memory", r->path);
}

// ---- libraries --------------------------------------------------------------------------------------------------

/** @return the path of a file that the scene names, or of one of the same base name beside it; NULL: there is none. */
static const char *find_beside(const Reader *r, const char *name)
{
    const char *path = sheen_path_beside(r->scratch, r->path, name);
    if (path && sheen_path_readable(path)) return path;
    const char *slash = strrchr(name, '/');
    path = slash ? sheen_path_beside(r->scratch, r->path, slash + 1) : NULL;
    return path && sheen_path_readable(path) ? path : NULL;
}

/** Of several definitions of a material the first counts. */
static SheenStatus read_library(Reader *r, const char *path)
{
    uint8_t *data;
    size_t size;
    MtlLibrary library;
    const char *name = sheen_arena_strdup(r->scratch, path);
    SheenStatus s = name ? sheen_file_read(path, r->log, &data, &size) : no_memory(r);
    if (s) return s;
    s = sheen_mtl_parse((const char *)data, size, name, r->scratch, r->log, &library);
    free(data);
    r->n_libraries++;
    for (uint32_t i = 0; !s && i < library.n; ++i)
        for (uint32_t j = 0; j < r->file.n_materials; ++j)
            if (!r->found[j] && strcmp(r->file.materials[j], library.materials[i].name) == 0) {
                r->materials[j] = library.materials[i];
                r->found[j] = true;
            }
    return s;
}

/** The next of several names with blanks between them; "\ " stands for a blank in a name. */
static const char *next_name(const char *at, char *out)
{
    while (*at == ' ' || *at == '\t') ++at;
    for (; *at && *at != ' ' && *at != '\t'; ++at) {
        if (*at == '\\' && at[1] == ' ') ++at;
        *out++ = *at;
    }
    *out = '\0';
    return at;
}

/** mtllib names one file whose name may hold blanks, or several. Some of several may be missing, not all. */
static SheenStatus read_libraries_of(Reader *r, const ObjLibrary *l)
{
    char *names = sheen_arena_strdup(r->scratch, l->names);
    char *name = sheen_arena_alloc(r->scratch, strlen(l->names) + 1, 1);
    if (!names || !name) return no_memory(r);
    bool windows = !strstr(names, "\\ "); // a backslash that is no escape parts folders
    for (char *c = names; windows && *c; ++c)
        if (*c == '\\') *c = '/';
    const char *path = find_beside(r, names);
    if (path) return read_library(r, path);
    uint32_t before = r->n_libraries;
    for (const char *at = next_name(names, name); *name; at = next_name(at, name)) {
        path = find_beside(r, name);
        SheenStatus s = path ? read_library(r, path) : SHEEN_OK;
        if (s) return s;
    }
    if (r->n_libraries == before)
        sheen_warn(r->log, "%s:%u: cannot open the material library '%s'", r->path, l->line, l->names);
    return SHEEN_OK;
}

/** Where no library was found: the one that has the scene's own name. */
static SheenStatus read_own_library(Reader *r)
{
    char *path = sheen_arena_strdup(r->scratch, r->path);
    if (!path) return no_memory(r);
    strcpy(path + strlen(path) - 4, ".mtl"); // in place of ".obj"
    return sheen_path_readable(path) ? read_library(r, path) : SHEEN_OK;
}

/** @return SHEEN_OK also when a material is not defined: gray stands in. */
static SheenStatus read_materials(Reader *r)
{
    uint32_t n = r->file.n_materials;
    r->materials = SHEEN_ARENA_NEW(r->scratch, MtlMaterial, (size_t)n + 1);
    r->indices = SHEEN_ARENA_NEW(r->scratch, uint32_t, (size_t)n + 1);
    r->found = SHEEN_ARENA_NEW(r->scratch, bool, n);
    if (!r->materials || !r->indices || !r->found) return no_memory(r);
    for (uint32_t i = 0; i <= n; ++i) r->materials[i] = sheen_mtl_default(i < n ? r->file.materials[i] : "default");
    SheenStatus s = SHEEN_OK;
    for (uint32_t i = 0; !s && i < r->file.n_libraries; ++i) s = read_libraries_of(r, &r->file.libraries[i]);
    if (!s && r->n_libraries == 0 && n > 0) s = read_own_library(r);
    uint32_t n_missing = 0, first = 0;
    for (uint32_t i = n; i-- > 0;)
        if (!r->found[i]) n_missing++, first = i;
    if (!s && n_missing)
        sheen_warn(r->log, "%s: the material '%s'%s defined nowhere: gray 0.5 stands in", r->path,
                   r->file.materials[first], n_missing > 1 ? " and others are" : " is");
    return s;
}

/** Adds the materials that triangles use. */
static SheenStatus add_materials(Reader *r)
{
    MtlReader reader = {
        .log = r->log, .builder = r->builder, .arena = r->arena, .scratch = r->scratch, .scene = r->path};
    for (uint32_t i = 0; i <= r->file.n_materials; ++i) r->indices[i] = SHEEN_NONE;
    for (uint32_t i = 0; i < r->file.n_runs; ++i) {
        uint32_t name = r->file.runs[i].material == SHEEN_NONE ? r->file.n_materials : r->file.runs[i].material;
        if (r->indices[name] != SHEEN_NONE) continue;
        SheenStatus s = sheen_mtl_add(&reader, &r->materials[name], &r->indices[name]);
        if (s) return s;
    }
    return SHEEN_OK;
}

// ---- shapes -----------------------------------------------------------------------------------------------------

/** Runs that become one shape: those of a material, or of a light's material in one object. */
typedef struct Part {
    uint32_t material; // index into r->materials
    uint32_t n_triangles;
    uint32_t first_run, last_run; // chained by next[]
    bool smooth;
} Part;

/**
 * @param map     [n_vertices] SHEEN_NONE everywhere, before and after
 * @param groups  [n_triangles] room for the smoothing groups
 */
static SheenStatus add_shape(Reader *r, const Part *part, const uint32_t next[], uint32_t map[], uint32_t groups[])
{
    const MeshData *all = &r->file.mesh;
    MeshData m = {.n_triangles = part->n_triangles};
    uint32_t *source = malloc(3 * (size_t)part->n_triangles * sizeof *source + 1);
    m.triangles = sheen_arena_alloc(r->arena, m.n_triangles, sizeof *m.triangles);
    if (!source || !m.triangles) {
        free(source);
        return no_memory(r);
    }
    uint32_t n = 0;
    bool has_n = false;
    for (uint32_t i = part->first_run; i != SHEEN_NONE; i = next[i]) {
        const ObjRun *run = &r->file.runs[i];
        for (uint32_t t = 0; t < run->n; ++t, ++n) {
            groups[n] = run->smoothing;
            for (int j = 0; j < 3; ++j) {
                uint32_t v = all->triangles[run->first + t][j];
                if (map[v] == SHEEN_NONE) {
                    map[v] = m.n_vertices;
                    source[m.n_vertices++] = v;
                    has_n = has_n || (all->n && v3_length2(all->n[v]) > 0.0f);
                }
                m.triangles[n][j] = map[v];
            }
        }
    }
    m.p = SHEEN_ARENA_NEW(r->arena, Vec3, (size_t)m.n_vertices + 1);
    m.n = has_n ? SHEEN_ARENA_NEW(r->arena, Vec3, m.n_vertices) : NULL;
    m.uv = all->uv ? SHEEN_ARENA_NEW(r->arena, Vec2, m.n_vertices) : NULL;
    m.color = all->color ? SHEEN_ARENA_NEW(r->arena, Rgb, m.n_vertices) : NULL;
    bool ok = m.p && (m.n || !has_n) && (m.uv || !all->uv) && (m.color || !all->color);
    for (uint32_t i = 0; i < m.n_vertices; ++i) {
        map[source[i]] = SHEEN_NONE;
        if (!ok) continue;
        m.p[i] = all->p[source[i]];
        if (m.n) m.n[i] = all->n[source[i]];
        if (m.uv) m.uv[i] = all->uv[source[i]];
        if (m.color) m.color[i] = all->color[source[i]];
    }
    free(source);
    if (ok && !has_n && part->smooth) ok = sheen_mesh_smooth_edges(r->arena, &m, groups, SHEEN_PI);
    if (!ok) return no_memory(r);
    const MtlMaterial *material = &r->materials[part->material];
    SheenShape shape = {.kind = SHEEN_SHAPE_MESH,
                        .mesh = sheen_mesh_finish(&m),
                        .material = r->indices[part->material],
                        .name = sheen_arena_strdup(r->arena, material->name)};
    if (!shape.name) return no_memory(r);
    uint32_t index = sheen_builder_add_shape(r->builder, &shape);
    if (rgb_is_black(material->emission)) return SHEEN_OK;
    r->n_lights++;
    sheen_builder_add_area_light(r->builder, index, material->emission);
    return SHEEN_OK;
}

/** Finds the parts: lights of the same material stay apart by object, so that each can be aimed at. */
static uint32_t find_parts(const Reader *r, Part parts[], uint32_t next[])
{
    uint32_t n = 0, lit = SHEEN_NONE; // the part of the light that is going on
    uint32_t *of_material = malloc(((size_t)r->file.n_materials + 1) * sizeof *of_material);
    if (!of_material) return SHEEN_NONE;
    memset(of_material, 0xff, ((size_t)r->file.n_materials + 1) * sizeof *of_material);
    for (uint32_t i = 0; i < r->file.n_runs; ++i) {
        const ObjRun *run = &r->file.runs[i];
        uint32_t material = run->material == SHEEN_NONE ? r->file.n_materials : run->material;
        bool emits = !rgb_is_black(r->materials[material].emission);
        bool goes_on = lit != SHEEN_NONE && parts[lit].material == material && run->object == run[-1].object;
        uint32_t *part = emits ? &lit : &of_material[material];
        if (emits ? !goes_on : *part == SHEEN_NONE) {
            *part = n;
            parts[n++] = (Part){.material = material, .first_run = i, .last_run = i};
        } else {
            next[parts[*part].last_run] = i;
            parts[*part].last_run = i;
        }
        if (!emits) lit = SHEEN_NONE;
        next[i] = SHEEN_NONE;
        parts[*part].n_triangles += run->n;
        parts[*part].smooth = parts[*part].smooth || run->smoothing != 0;
    }
    free(of_material);
    return n;
}

static SheenStatus add_shapes(Reader *r)
{
    size_t n_vertices = r->file.mesh.n_vertices;
    Part *parts = malloc((size_t)r->file.n_runs * sizeof *parts + 1);
    uint32_t *next = malloc((size_t)r->file.n_runs * sizeof *next + 1);
    uint32_t *map = malloc(n_vertices * sizeof *map + 1);
    uint32_t *groups = malloc((size_t)r->file.mesh.n_triangles * sizeof *groups + 1);
    SheenStatus s = parts && next && map && groups ? SHEEN_OK : no_memory(r);
    uint32_t n = s ? 0 : find_parts(r, parts, next);
    if (n == SHEEN_NONE) s = no_memory(r);
    if (!s) memset(map, 0xff, n_vertices * sizeof *map);
    for (uint32_t i = 0; !s && i < n; ++i) s = add_shape(r, &parts[i], next, map, groups);
    free(parts);
    free(next);
    free(map);
    free(groups);
    return s;
}

// ---- the scene --------------------------------------------------------------------------------------------------

static SheenStatus read_scene(Reader *r)
{
    uint8_t *data;
    size_t size;
    SheenStatus s = sheen_file_read(r->path, r->log, &data, &size);
    if (s) return s;
    s = sheen_obj_parse_parts((const char *)data, size, r->path, r->scratch, r->log, &r->file);
    free(data);
    if (!s) s = read_materials(r);
    if (!s) s = add_materials(r);
    if (!s) s = add_shapes(r);
    if (!s && r->n_lights == 0) {
        const SheenLight sky = {.kind = SHEEN_LIGHT_ENVIRONMENT, .radiance = rgb_gray(1.0f)};
        sheen_warn(r->log, "%s: no material emits light (Ke): a uniform sky of radiance 1 stands in", r->path);
        sheen_builder_add_light(r->builder, &sky);
    }
    return s;
}

SheenStatus sheen_obj_read(const char *path, const SheenLog *log, SheenScene **out)
{
    *out = NULL;
    Reader r = {.path = path, .log = log, .scratch = sheen_arena_create()};
    SheenStatus s = r.scratch ? sheen_builder_create(log, path, &r.builder) : no_memory(&r);
    if (!s) {
        r.arena = sheen_builder_arena(r.builder);
        sheen_builder_expect_no_camera(r.builder);
        s = read_scene(&r);
    }
    sheen_arena_destroy(&r.scratch); // before the renderer needs the memory
    if (s) {
        sheen_builder_destroy(&r.builder);
        return s;
    }
    return sheen_builder_commit(&r.builder, out);
}
