// SPDX-License-Identifier: Apache-2.0
// Structs are fed member by member: padding has no value. What follows from other members, as all that the builder
// completes, is left out.
#include "scene/scene_hash.h"

#define XXH_STATIC_LINKING_ONLY // the size of its state
#include <xxhash.h>

typedef XXH3_state_t Feed;

static void feed(Feed *f, const void *data, size_t bytes)
{
    XXH3_64bits_update(f, data, bytes);
}
static void feed_u32(Feed *f, uint32_t x)
{
    feed(f, &x, sizeof x);
}
static void feed_float(Feed *f, float x)
{
    feed(f, &x, sizeof x);
}
static void feed_rgb(Feed *f, Rgb x)
{
    feed(f, &x, sizeof x);
}
static void feed_v3(Feed *f, Vec3 x)
{
    feed(f, &x, sizeof x);
}
_Static_assert(sizeof(Vec3) == 12 && sizeof(Rgb) == 12 && sizeof(Vec2) == 8 && sizeof(Transform) == 128 &&
                   sizeof(Frame) == 36,
               "fed as they are in memory: no padding");

// An array that may not be there.
static void feed_array(Feed *f, const void *data, size_t n, size_t size)
{
    feed_u32(f, data != NULL);
    if (data) feed(f, data, n * size);
}

static void feed_bitmap(Feed *f, const SheenBitmap *b)
{
    size_t pixels = (size_t)b->width * b->height;
    feed_u32(f, b->width);
    feed_u32(f, b->height);
    feed_array(f, b->floats, pixels, sizeof *b->floats);
    feed_array(f, b->bytes, pixels, 3);
    if (b->bytes) feed_array(f, b->decode, 256, sizeof *b->decode);
}

static void feed_texture(Feed *f, const SheenTexture *t)
{
    feed_u32(f, t->kind);
    feed_rgb(f, t->value);
    feed_rgb(f, t->value2);
    feed_rgb(f, t->scale);
    feed_bitmap(f, &t->bitmap);
    feed_u32(f, t->wrap_u);
    feed_u32(f, t->wrap_v);
    feed_u32(f, t->nearest);
    feed_float(f, t->line_width);
    feed(f, t->uv, sizeof t->uv);
}

// ---- shapes -----------------------------------------------------------------------------------------------------

static void feed_mesh(Feed *f, const SheenMesh *m)
{
    feed_u32(f, m->n_vertices);
    feed_u32(f, m->n_triangles);
    feed_array(f, m->p, m->n_vertices, sizeof *m->p);
    feed_array(f, m->n, m->n_vertices, sizeof *m->n);
    feed_array(f, m->uv, m->n_vertices, sizeof *m->uv);
    feed_array(f, m->triangles, m->n_triangles, sizeof *m->triangles);
    feed_array(f, m->color, m->n_vertices, sizeof *m->color);
    feed_array(f, m->face_color, m->n_triangles, sizeof *m->face_color);
}

static void feed_shape(Feed *f, const SheenShape *s)
{
    feed_u32(f, s->kind);
    switch (s->kind) {
    case SHEEN_SHAPE_MESH:
        feed_mesh(f, &s->mesh);
        break;
    case SHEEN_SHAPE_SPHERE:
        feed_v3(f, s->sphere.center);
        feed_float(f, s->sphere.radius);
        feed_u32(f, s->sphere.flip);
        feed(f, &s->sphere.frame, sizeof s->sphere.frame);
        break;
    case SHEEN_SHAPE_DISK:
        feed_v3(f, s->disk.center);
        feed_v3(f, s->disk.du);
        feed_v3(f, s->disk.dv);
        feed_v3(f, s->disk.n);
        break;
    }
    feed_u32(f, s->material);
    feed_u32(f, s->light);
}

// ---- materials --------------------------------------------------------------------------------------------------

static void feed_principled(Feed *f, const SheenPrincipled *p)
{
    const SheenTexture *textures[] = {&p->anisotropic,     &p->spec_trans, &p->spec_tint, &p->sheen,
                                      &p->sheen_tint,      &p->flatness,   &p->metallic,  &p->clearcoat,
                                      &p->clearcoat_gloss, &p->diff_trans};
    for (size_t i = 0; i < sizeof textures / sizeof *textures; ++i) feed_texture(f, textures[i]);
}

static void feed_lafortune(Feed *f, const SheenLafortune *l)
{
    feed_v3(f, l->c);
    feed_float(f, l->exponent);
    feed_rgb(f, l->weight);
}

static void feed_material(Feed *f, const SheenMaterial *m)
{
    const uint32_t numbers[] = {m->kind,         m->two_sided, m->nonlinear,    m->fast,
                                m->distribution, m->ward,      m->turn_normals, m->shadow_normals,
                                m->nested[0],    m->nested[1], m->n_lafortune};
    const float values[] = {m->ior, m->exponent, m->map_scale};
    const Rgb colors[] = {m->eta, m->k, m->absorption};
    const SheenTexture *textures[] = {
        &m->reflectance, &m->specular_reflectance, &m->specular_transmittance, &m->alpha_u, &m->alpha_v, &m->weight,
        &m->map};
    feed(f, numbers, sizeof numbers);
    feed(f, values, sizeof values);
    feed(f, colors, sizeof colors);
    for (size_t i = 0; i < sizeof textures / sizeof *textures; ++i) feed_texture(f, textures[i]);
    feed_u32(f, m->principled != NULL);
    if (m->principled) feed_principled(f, m->principled);
    for (uint32_t i = 0; i < m->n_lafortune; ++i) feed_lafortune(f, &m->lafortune[i]);
}

// ---- lights -----------------------------------------------------------------------------------------------------

static void feed_light(Feed *f, const SheenLight *l)
{
    const float values[] = {l->cos_inner, l->cos_outer, l->disk, l->tan_x, l->tan_y};
    feed_u32(f, l->kind);
    feed_u32(f, l->shape);
    feed_rgb(f, l->radiance);
    feed_v3(f, l->position);
    feed_v3(f, l->direction);
    feed(f, values, sizeof values);
    feed_u32(f, l->texture != NULL);
    if (l->texture) feed_texture(f, l->texture);
    feed_bitmap(f, &l->environment);
    feed(f, &l->to_world, sizeof l->to_world);
}

uint64_t sheen_scene_hash(const SheenScene *scene)
{
    Feed f;
    XXH3_64bits_reset(&f);
    const uint32_t counts[] = {scene->n_shapes,    scene->n_groups, scene->n_instances,
                               scene->n_materials, scene->n_lights, scene->environment};
    feed(&f, counts, sizeof counts);
    for (uint32_t i = 0; i < scene->n_shapes; ++i) feed_shape(&f, &scene->shapes[i]);
    for (uint32_t i = 0; i < scene->n_groups; ++i) {
        feed_u32(&f, scene->groups[i].first_shape);
        feed_u32(&f, scene->groups[i].n_shapes);
    }
    for (uint32_t i = 0; i < scene->n_instances; ++i) {
        feed_u32(&f, scene->instances[i].group);
        feed(&f, &scene->instances[i].to_world, sizeof scene->instances[i].to_world);
    }
    for (uint32_t i = 0; i < scene->n_materials; ++i) feed_material(&f, &scene->materials[i]);
    for (uint32_t i = 0; i < scene->n_lights; ++i) feed_light(&f, &scene->lights[i]);
    return XXH3_64bits_digest(&f);
}
