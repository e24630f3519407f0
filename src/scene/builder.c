// SPDX-License-Identifier: Apache-2.0
#include "scene/builder.h"

#include "scene/clean.h"
#include "scene/material_check.h"

#include <stdlib.h>
#include <string.h>

/** A growing array of one type; the element size is passed at each call. */
typedef struct List {
    void *data;
    uint32_t n, capacity;
} List;

typedef struct Entry {
    SheenShape shape;
    uint32_t group;
} Entry;

struct SheenBuilder {
    const SheenLog *log;
    SheenArena *arena;
    const char *name;
    List entries, materials, lights, cameras, instances; // Entry, SheenMaterial, SheenLight, ...
    uint32_t n_groups;                                   // the world included
    uint32_t group;                                      // that shapes join, 0 for the world
    uint32_t environment;                                // index into lights, or SHEEN_NONE
    bool no_camera_expected;
    SheenStatus status; // first failure of an add function
};

#define LIST_AT(list, T, i) (&((T *)(list).data)[i])

static uint32_t list_add(SheenBuilder *b, List *list, const void *item, size_t size)
{
    if (list->n == list->capacity) {
        uint64_t capacity = list->capacity ? 2 * (uint64_t)list->capacity : 16;
        void *data = capacity < SHEEN_NONE ? realloc(list->data, (size_t)capacity * size) : NULL;
        if (!data) {
            if (!b->status) b->status = SHEEN_ERR_NOMEM;
            return SHEEN_NONE;
        }
        list->data = data;
        list->capacity = (uint32_t)capacity;
    }
    memcpy((char *)list->data + (size_t)list->n * size, item, size);
    return list->n++;
}

SheenStatus sheen_builder_create(const SheenLog *log, const char *name, SheenBuilder **out)
{
    *out = NULL;
    SheenBuilder *b = calloc(1, sizeof *b);
    if (!b) return sheen_fail(log, SHEEN_ERR_NOMEM, "%s: out of memory", name);
    b->log = log;
    b->n_groups = 1;
    b->environment = SHEEN_NONE;
    b->arena = sheen_arena_create();
    b->name = b->arena ? sheen_arena_strdup(b->arena, name) : NULL;
    if (!b->name) {
        sheen_builder_destroy(&b);
        return sheen_fail(log, SHEEN_ERR_NOMEM, "%s: out of memory", name);
    }
    *out = b;
    return SHEEN_OK;
}

void sheen_builder_destroy(SheenBuilder **builder)
{
    if (!builder || !*builder) return;
    SheenBuilder *b = *builder;
    free(b->entries.data);
    free(b->materials.data);
    free(b->lights.data);
    free(b->cameras.data);
    free(b->instances.data);
    sheen_arena_destroy(&b->arena);
    free(b);
    *builder = NULL;
}

SheenArena *sheen_builder_arena(SheenBuilder *builder)
{
    return builder->arena;
}

uint32_t sheen_builder_add_material(SheenBuilder *b, const SheenMaterial *material)
{
    SheenMaterial m = *material;
    if (!m.name) m.name = "";
    SheenStatus s = sheen_material_complete(b->log, b->name, b->arena, b->materials.data, b->materials.n, &m);
    if (s) {
        if (!b->status) b->status = s;
        return SHEEN_NONE;
    }
    return list_add(b, &b->materials, &m, sizeof m);
}

const SheenMaterial *sheen_builder_material(const SheenBuilder *b, uint32_t index)
{
    return index < b->materials.n ? LIST_AT(b->materials, SheenMaterial, index) : NULL;
}

uint32_t sheen_builder_add_shape(SheenBuilder *b, const SheenShape *shape)
{
    Entry e = {*shape, b->group};
    e.shape.light = SHEEN_NONE;
    if (!e.shape.name) e.shape.name = "";
    return list_add(b, &b->entries, &e, sizeof e);
}

/** Negative and non-finite channels become zero, with a warning. */
static Rgb checked_radiance(const SheenBuilder *b, Rgb c, const char *of)
{
    Rgb good = rgb(c.r >= 0.0f && isfinite(c.r) ? c.r : 0.0f, c.g >= 0.0f && isfinite(c.g) ? c.g : 0.0f,
                   c.b >= 0.0f && isfinite(c.b) ? c.b : 0.0f);
    if (!rgb_finite(c) || good.r != c.r || good.g != c.g || good.b != c.b)
        sheen_warn(b->log, "%s: %s emits a negative or non-finite radiance (%g %g %g): taken as %g %g %g", b->name, of,
                   (double)c.r, (double)c.g, (double)c.b, (double)good.r, (double)good.g, (double)good.b);
    return good;
}

uint32_t sheen_builder_add_area_light(SheenBuilder *b, uint32_t shape, Rgb radiance)
{
    if (shape == SHEEN_NONE) return SHEEN_NONE; // the failure of adding the shape is remembered
    if (shape >= b->entries.n || LIST_AT(b->entries, Entry, shape)->group != 0) {
        if (!b->status) b->status = SHEEN_ERR_INVALID;
        return SHEEN_NONE;
    }
    SheenShape *s = &LIST_AT(b->entries, Entry, shape)->shape;
    SheenLight light = {.kind = SHEEN_LIGHT_AREA, .shape = shape, .radiance = checked_radiance(b, radiance, s->name)};
    if (s->light != SHEEN_NONE)
        *LIST_AT(b->lights, SheenLight, s->light) = light;
    else
        s->light = list_add(b, &b->lights, &light, sizeof light);
    return s->light;
}

uint32_t sheen_builder_add_textured_area_light(SheenBuilder *b, uint32_t shape, const SheenTexture *radiance)
{
    SheenTexture *copy = NULL;
    if (radiance->kind != SHEEN_TEXTURE_CONSTANT) {
        copy = SHEEN_ARENA_NEW(b->arena, SheenTexture, 1);
        if (!copy) {
            b->status = SHEEN_ERR_NOMEM;
            return SHEEN_NONE;
        }
        *copy = *radiance;
    }
    uint32_t light = sheen_builder_add_area_light(b, shape, sheen_texture_mean(radiance));
    if (light != SHEEN_NONE) LIST_AT(b->lights, SheenLight, light)->texture = copy;
    return light;
}

uint32_t sheen_builder_add_light(SheenBuilder *b, const SheenLight *light)
{
    static const char *const names[SHEEN_LIGHT_KINDS] = {"an area light",       "a point light",   "a spot light",
                                                         "a directional light", "the environment", "a projector"};
    SheenLight l = *light;
    l.shape = SHEEN_NONE;
    l.radiance = checked_radiance(b, l.radiance, names[l.kind]);
    bool has_window = l.texture != NULL && (l.kind == SHEEN_LIGHT_SPOT || l.kind == SHEEN_LIGHT_PROJECTOR);
    bool has_position = l.kind == SHEEN_LIGHT_POINT || l.kind == SHEEN_LIGHT_SPOT || l.kind == SHEEN_LIGHT_PROJECTOR;
    bool has_direction = l.kind == SHEEN_LIGHT_DIRECTIONAL || l.kind == SHEEN_LIGHT_SPOT;
    if (has_direction) l.direction = v3_normalize(l.direction);
    if ((has_position && !sheen_position_ok(l.position)) ||
        (has_direction && !(v3_length2(l.direction) > 0.5f && v3_finite(l.direction)))) {
        sheen_warn(b->log, "%s: %s without a finite position or direction is left out", b->name, names[l.kind]);
        return SHEEN_NONE;
    }
    if ((has_window || l.kind == SHEEN_LIGHT_PROJECTOR) &&
        !(has_window && l.tan_x > 0.0f && l.tan_y > 0.0f && transform_invert(&l.to_world, &l.to_light))) {
        sheen_warn(b->log, "%s: %s without a picture, angle or place for it is left out", b->name, names[l.kind]);
        return SHEEN_NONE;
    }
    // A narrower disk is none that rays can find; a wider one would be an environment.
    if (l.kind != SHEEN_LIGHT_DIRECTIONAL || !(l.disk >= 1e-4f)) l.disk = 0.0f;
    l.disk = minf(l.disk, 1.5f);
    if (l.kind != SHEEN_LIGHT_ENVIRONMENT) return list_add(b, &b->lights, &l, sizeof l);

    if (l.environment.width == 0)
        l.to_world = l.to_light = transform_identity();
    else if (!transform_invert(&l.to_world, &l.to_light)) {
        sheen_warn(b->log, "%s: the environment's transform is singular and is ignored", b->name);
        l.to_world = transform_identity();
    }
    if (b->environment != SHEEN_NONE) {
        sheen_warn(b->log, "%s: a second environment light replaces the first", b->name);
        *LIST_AT(b->lights, SheenLight, b->environment) = l;
    } else {
        b->environment = list_add(b, &b->lights, &l, sizeof l);
    }
    return b->environment;
}

static bool camera_ok(const SheenCamera *c)
{
    Transform inverse;
    float w = 1.0f - c->cut_lo.x - c->cut_hi.x, h = 1.0f - c->cut_lo.y - c->cut_hi.y;
    bool film = c->width && c->height && w > 0.0f && h > 0.0f && isfinite(w) && isfinite(h);
    bool angle = c->orthographic || (c->fov_x > 0.0f && c->fov_x < SHEEN_PI);
    bool lens = c->aperture == 0.0f || (c->aperture > 0.0f && isfinite(c->aperture) && isnormal(c->focus));
    return film && angle && lens && transform_invert(&c->to_world, &inverse);
}

uint32_t sheen_builder_add_camera(SheenBuilder *b, const SheenCamera *camera)
{
    SheenCamera c = *camera;
    if (!c.name) c.name = "";
    if (!camera_ok(&c)) {
        sheen_warn(b->log, "%s: camera '%s' has a singular transform, no picture, field of view or focus: left out",
                   b->name, c.name);
        return SHEEN_NONE;
    }
    return list_add(b, &b->cameras, &c, sizeof c);
}

void sheen_builder_expect_no_camera(SheenBuilder *b)
{
    b->no_camera_expected = true;
}

uint32_t sheen_builder_begin_group(SheenBuilder *b)
{
    b->group = b->n_groups++;
    return b->group;
}

void sheen_builder_end_group(SheenBuilder *b)
{
    b->group = 0;
}

uint32_t sheen_builder_add_instance(SheenBuilder *b, uint32_t group, const Transform *to_world)
{
    SheenInstance i = {.group = group, .to_world = *to_world};
    if (!transform_invert(&i.to_world, &i.to_group)) {
        sheen_warn(b->log, "%s: an instance with a singular transform is left out", b->name);
        return SHEEN_NONE;
    }
    return list_add(b, &b->instances, &i, sizeof i);
}

// ---- commit -----------------------------------------------------------------------------------------------------

/** The caller's mistakes: indices that lead nowhere. */
static bool indices_ok(const SheenBuilder *b)
{
    for (uint32_t i = 0; i < b->entries.n; ++i) {
        const SheenShape *s = &LIST_AT(b->entries, Entry, i)->shape;
        if (s->material >= b->materials.n) return false;
        if (s->kind != SHEEN_SHAPE_MESH) continue;
        for (uint32_t t = 0; t < s->mesh.n_triangles; ++t)
            for (int j = 0; j < 3; ++j)
                if (s->mesh.triangles[t][j] >= s->mesh.n_vertices) return false;
    }
    for (uint32_t i = 0; i < b->instances.n; ++i) {
        uint32_t group = LIST_AT(b->instances, SheenInstance, i)->group;
        if (group == 0 || group >= b->n_groups) return false;
    }
    return true;
}

/** @return 1 when the shape can stay, 0 when nothing of it is left, -1 when out of memory. */
static int clean_shape(const SheenBuilder *b, SheenShape *s)
{
    if (s->kind == SHEEN_SHAPE_MESH) {
        uint32_t dropped = 0;
        if (!sheen_mesh_clean(b->arena, &s->mesh, &dropped)) return -1;
        if (dropped)
            sheen_warn(b->log, "%s: %s: %u of %u triangles have no area or a non-finite vertex: left out", b->name,
                       s->name, dropped, dropped + s->mesh.n_triangles);
        if (s->mesh.n_triangles == 0) sheen_warn(b->log, "%s: %s has no triangles: left out", b->name, s->name);
        return s->mesh.n_triangles > 0;
    }
    bool ok;
    if (s->kind == SHEEN_SHAPE_SPHERE) {
        float r = s->sphere.radius;
        ok = sheen_position_ok(s->sphere.center) && r <= SHEEN_COORDINATE_MAX && isnormal(r * r) && r > 0.0f;
    } else {
        const SheenDisk *d = &s->disk;
        ok = sheen_position_ok(d->center) && sheen_position_ok(d->du) && sheen_position_ok(d->dv) &&
             isnormal(v3_length2(v3_cross(d->du, d->dv))) && isnormal(v3_length2(d->n));
        if (ok) s->disk.n = v3_normalize(d->n);
    }
    if (!ok) sheen_warn(b->log, "%s: %s has no area or is not finite: left out", b->name, s->name);
    return ok;
}

/** Cleans the shapes and lays them out group by group; map[] takes an index of the builder to one of the scene. */
static SheenStatus lay_out_shapes(SheenBuilder *b, SheenScene *scene, uint32_t map[])
{
    SheenShape *shapes = SHEEN_ARENA_NEW(b->arena, SheenShape, b->entries.n);
    SheenGroup *groups = SHEEN_ARENA_NEW(b->arena, SheenGroup, b->n_groups);
    uint32_t *next = calloc(b->n_groups, sizeof *next);
    if (!shapes || !groups || !next) {
        free(next);
        return SHEEN_ERR_NOMEM;
    }
    for (uint32_t i = 0; i < b->entries.n; ++i) {
        Entry *e = LIST_AT(b->entries, Entry, i);
        int keep = clean_shape(b, &e->shape);
        if (keep < 0) {
            free(next);
            return SHEEN_ERR_NOMEM;
        }
        map[i] = keep ? 0 : SHEEN_NONE;
        if (keep) groups[e->group].n_shapes++;
    }
    for (uint32_t g = 1; g < b->n_groups; ++g)
        next[g] = groups[g].first_shape = groups[g - 1].first_shape + groups[g - 1].n_shapes;
    for (uint32_t i = 0; i < b->entries.n; ++i) {
        const Entry *e = LIST_AT(b->entries, Entry, i);
        if (map[i] == SHEEN_NONE) continue;
        map[i] = next[e->group]++;
        shapes[map[i]] = e->shape;
        shapes[map[i]].light = SHEEN_NONE;
        if (e->shape.kind == SHEEN_SHAPE_MESH) scene->n_triangles += e->shape.mesh.n_triangles;
        scene->n_shapes++;
    }
    free(next);
    scene->shapes = shapes;
    scene->groups = groups;
    scene->n_groups = b->n_groups;
    return SHEEN_OK;
}

/** Copies the lights that shine, and ties area lights to their shapes. */
static SheenStatus lay_out_lights(SheenBuilder *b, SheenScene *scene, const uint32_t map[])
{
    SheenLight *lights = SHEEN_ARENA_NEW(b->arena, SheenLight, b->lights.n);
    if (!lights) return SHEEN_ERR_NOMEM;
    scene->environment = SHEEN_NONE;
    for (uint32_t i = 0; i < b->lights.n; ++i) {
        SheenLight l = *LIST_AT(b->lights, SheenLight, i);
        if (rgb_is_black(l.radiance)) continue;
        if (l.kind == SHEEN_LIGHT_AREA) {
            l.shape = map[l.shape];
            if (l.shape == SHEEN_NONE) continue;
            ((SheenShape *)scene->shapes)[l.shape].light = scene->n_lights; // ours until the scene is handed out
        }
        if (i == b->environment) scene->environment = scene->n_lights;
        lights[scene->n_lights++] = l;
    }
    scene->lights = lights;
    if (scene->n_lights == 0) sheen_warn(b->log, "%s: the scene has no light: the picture will be black", b->name);
    return SHEEN_OK;
}

static Bounds group_bounds(const SheenScene *scene, uint32_t group)
{
    Bounds bounds = bounds_empty();
    const SheenGroup *g = &scene->groups[group];
    for (uint32_t i = 0; i < g->n_shapes; ++i)
        bounds = bounds_union(bounds, sheen_shape_bounds(&scene->shapes[g->first_shape + i]));
    return bounds;
}

/** Copies the instances of groups in which something is left, and completes the bounds. */
static SheenStatus lay_out_instances(SheenBuilder *b, SheenScene *scene)
{
    SheenInstance *instances = SHEEN_ARENA_NEW(b->arena, SheenInstance, b->instances.n);
    Bounds *bounds = calloc(b->n_groups, sizeof *bounds);
    if (!instances || !bounds) {
        free(bounds);
        return SHEEN_ERR_NOMEM;
    }
    for (uint32_t g = 0; g < b->n_groups; ++g) bounds[g] = group_bounds(scene, g);
    scene->bounds = bounds[0];
    for (uint32_t i = 0; i < b->instances.n; ++i) {
        const SheenInstance *instance = LIST_AT(b->instances, SheenInstance, i);
        const Bounds *box = &bounds[instance->group];
        if (bounds_is_empty(box)) continue;
        Bounds placed = bounds_empty();
        for (int corner = 0; corner < 8; ++corner) {
            Vec3 p = v3(corner & 1 ? box->hi.x : box->lo.x, corner & 2 ? box->hi.y : box->lo.y,
                        corner & 4 ? box->hi.z : box->lo.z);
            placed = bounds_add(placed, transform_point(&instance->to_world, p));
        }
        if (!sheen_position_ok(placed.lo) || !sheen_position_ok(placed.hi)) {
            sheen_warn(b->log, "%s: an instance that is not finite is left out", b->name);
            continue;
        }
        scene->bounds = bounds_union(scene->bounds, placed);
        instances[scene->n_instances++] = *instance;
    }
    free(bounds);
    scene->instances = instances;
    return SHEEN_OK;
}

/** A camera in front of the scene, on its +z side, from which the whole bounding sphere is seen. */
static SheenCamera default_camera(const SheenScene *scene)
{
    const float fov = 0.25f * SHEEN_PI;
    Bounds box = scene->bounds;
    if (bounds_is_empty(&box)) box = (Bounds){v3(-1, -1, -1), v3(1, 1, 1)};
    Vec3 target = bounds_center(&box);
    float distance = maxf(bounds_radius(&box), 1e-3f) / sinf(0.5f * fov);
    return (SheenCamera){.name = "default",
                         .to_world = transform_look_at(v3_add(target, v3(0, 0, distance)), target, v3(0, 1, 0)),
                         .fov_x = fov,
                         .width = 512,
                         .height = 512};
}

static SheenStatus complete(SheenBuilder *b, SheenScene *scene, uint32_t map[])
{
    SheenStatus s = lay_out_shapes(b, scene, map);
    if (!s) s = lay_out_lights(b, scene, map);
    if (!s) s = lay_out_instances(b, scene);
    if (s) return s;
    if (b->cameras.n == 0) {
        SheenCamera camera = default_camera(scene);
        if (!b->no_camera_expected)
            sheen_warn(b->log, "%s: the scene has no camera: one that sees all of it stands in", b->name);
        if (list_add(b, &b->cameras, &camera, sizeof camera) == SHEEN_NONE) return SHEEN_ERR_NOMEM;
    }
    SheenMaterial *materials = SHEEN_ARENA_NEW(b->arena, SheenMaterial, b->materials.n);
    SheenCamera *cameras = SHEEN_ARENA_NEW(b->arena, SheenCamera, b->cameras.n);
    if (!materials || !cameras) return SHEEN_ERR_NOMEM;
    if (b->materials.n) memcpy(materials, b->materials.data, b->materials.n * sizeof *materials);
    memcpy(cameras, b->cameras.data, b->cameras.n * sizeof *cameras);
    scene->materials = materials, scene->n_materials = b->materials.n;
    scene->cameras = cameras, scene->n_cameras = b->cameras.n;
    scene->name = b->name;
    return SHEEN_OK;
}

SheenStatus sheen_builder_commit(SheenBuilder **builder, SheenScene **out)
{
    *out = NULL;
    SheenBuilder *b = *builder;
    SheenStatus s = b->status;
    SheenScene *scene = NULL;
    if (!s && !indices_ok(b)) s = SHEEN_ERR_INVALID;
    if (!s) {
        scene = SHEEN_ARENA_NEW(b->arena, SheenScene, 1);
        uint32_t *map = malloc((size_t)b->entries.n * sizeof *map + 1);
        s = scene && map ? complete(b, scene, map) : SHEEN_ERR_NOMEM;
        free(map);
    }
    if (s) {
        s = sheen_fail(b->log, s, "%s: %s", b->name,
                       s == SHEEN_ERR_NOMEM ? "out of memory" : "the scene refers to something that it does not hold");
    } else {
        scene->arena = b->arena;
        b->arena = NULL;
        *out = scene;
    }
    sheen_builder_destroy(builder);
    return s;
}
