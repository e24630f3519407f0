// SPDX-License-Identifier: Apache-2.0
// Rays that leave a surface do not hit it again, at any scale and place, and start close to it.
#include "ray/surface.h"
#include "unit/light_scene.h"

#include <stdlib.h>

#define N_PRIMITIVES 400
#define N_RAYS 100

static Vec3 random_direction(Random *r)
{
    return warp_sphere(random_2d(r));
}

static Vec3 *three_points(SheenBuilder *b, const Vec3 v[3])
{
    Vec3 *p = SHEEN_ARENA_NEW(sheen_builder_arena(b), Vec3, 4);
    memcpy(p, v, 3 * sizeof *p);
    p[3] = v3(0, 0, 0);
    return p;
}

static SheenShape triangle_shape(SheenBuilder *b, const Vec3 v[3])
{
    static const uint32_t t[1][3] = {{0, 1, 2}};
    return (SheenShape){
        .kind = SHEEN_SHAPE_MESH,
        .light = SHEEN_NONE,
        .mesh = {.n_vertices = 3, .n_triangles = 1, .p = three_points(b, v), .triangles = t},
        .name = "triangle",
    };
}

// A triangle about `at` with edges of about `size`, one of them `thin` times shorter; along the axes when `aligned`.
static SheenShape random_triangle(SheenBuilder *b, Random *r, Vec3 at, float size, float thin, bool aligned)
{
    Vec3 t = aligned ? v3(1, 0, 0) : random_direction(r), n = aligned ? v3(0, 1, 0) : random_direction(r);
    Vec3 across = v3_normalize(v3_cross(n, t));
    Vec3 v[3] = {at, v3_mad(at, size, t),
                 v3_add(v3_mad(at, size * random_in(r, 0.0f, 1.0f), t), v3_scale(across, size / thin))};
    return triangle_shape(b, v);
}

// A flat wall of small triangles, whose vertices are off its plane by their rounding.
static SheenShape random_wall(SheenBuilder *b, Random *r, Vec3 at, float size)
{
    enum { SIDE = 6 };
    SheenArena *arena = sheen_builder_arena(b);
    Vec3 *p = SHEEN_ARENA_NEW(arena, Vec3, SIDE * SIDE + 1);
    uint32_t(*t)[3] = sheen_arena_alloc(arena, 2 * (SIDE - 1) * (SIDE - 1), sizeof *t), n = 0;
    Frame f = frame_from_normal(random_direction(r));
    for (uint32_t y = 0; y < SIDE; ++y)
        for (uint32_t x = 0; x < SIDE; ++x) {
            uint32_t i = y * SIDE + x;
            p[i] = v3_mad(v3_mad(at, size * (float)x / SIDE, f.t), size * (float)y / SIDE, f.b);
            if (x == SIDE - 1 || y == SIDE - 1) continue;
            memcpy(t[n++], (uint32_t[3]){i, i + 1, i + SIDE}, sizeof *t);
            memcpy(t[n++], (uint32_t[3]){i + 1, i + SIDE + 1, i + SIDE}, sizeof *t);
        }
    p[SIDE * SIDE] = v3(0, 0, 0);
    return (SheenShape){
        .kind = SHEEN_SHAPE_MESH,
        .light = SHEEN_NONE,
        .mesh = {.n_vertices = SIDE * SIDE, .n_triangles = n, .p = p, .triangles = (const uint32_t(*)[3])t},
        .name = "wall",
    };
}

typedef enum Kind { TRIANGLE, SLIVER, ALIGNED, WALL, SPHERE, DISK, INSTANCE, KINDS } Kind;
static const char *const kind_names[] = {"triangle", "sliver", "aligned", "wall", "sphere", "disk", "instance"};

static SheenScene *scene_of(Kind kind, Random *r, Vec3 at, float size)
{
    LightScene s = light_scene_begin();
    SheenBuilder *b = s.builder;
    SheenShape shape = {.light = SHEEN_NONE, .name = "shape"};
    if (kind == TRIANGLE || kind == ALIGNED || kind == SLIVER) {
        float thin = kind == SLIVER ? expf(random_in(r, 1.0f, 5.0f)) : 1.5f;
        shape = random_triangle(b, r, at, size, thin, kind == ALIGNED);
    } else if (kind == WALL) {
        shape = random_wall(b, r, at, size);
    } else if (kind == SPHERE) {
        shape.kind = SHEEN_SHAPE_SPHERE;
        shape.sphere = (SheenSphere){at, size, false, frame_from_normal(v3(0, 0, 1))};
    } else if (kind == DISK) {
        Frame f = frame_from_normal(random_direction(r));
        shape.kind = SHEEN_SHAPE_DISK;
        shape.disk = (SheenDisk){at, v3_scale(f.t, size), v3_scale(f.b, 0.3f * size), f.n};
    } else {
        Transform turn = transform_rotate(random_direction(r), (double)random_in(r, 0.0f, 3.0f));
        Transform grow = transform_scale((double)size, 0.3 * (double)size, 2.0 * (double)size);
        Transform move = transform_translate((double)at.x, (double)at.y, (double)at.z);
        uint32_t group = sheen_builder_begin_group(b);
        shape = random_triangle(b, r, random_direction(r), 1.0f, 1.5f, false);
        sheen_builder_add_shape(b, &shape);
        sheen_builder_end_group(b);
        Transform place = transform_mul(move, transform_mul(turn, grow));
        sheen_builder_add_instance(b, group, &place);
    }
    if (kind != INSTANCE) sheen_builder_add_shape(b, &shape);
    SheenScene *scene = NULL;
    assert_int_equal(sheen_builder_commit(&b, &scene), SHEEN_OK);
    return scene;
}

typedef struct Tally {
    int hits, again;
    double farthest; // largest distance from the surface over the size of what rounds
} Tally;

// Looks at the shape from around it and sends rays on from where it is seen, many of them along the surface.
static void leave(const SheenScene *scene, SheenPool *pool, Random *r, Vec3 at, float size, bool convex, Tally *t)
{
    SheenAccel *accel = NULL;
    assert_int_equal(sheen_accel_create(scene, pool, NULL, &accel), SHEEN_OK);
    Vec3 center = bounds_center(&scene->bounds);
    float radius = bounds_radius(&scene->bounds);
    for (int i = 0; i < N_RAYS; ++i) {
        Vec3 eye = v3_mad(center, 3.0f * radius, random_direction(r));
        Vec3 aim = v3_mad(center, 0.5f * radius * random_in(r, 0, 1), random_direction(r));
        Ray ray = {eye, INFINITY, v3_normalize(v3_sub(aim, eye))};
        Hit hit;
        sheen_accel_intersect(accel, &ray, &hit);
        if (hit.shape == SHEEN_NONE) continue;
        SurfacePoint s;
        sheen_surface_from_hit(scene, &ray, &hit, &s);
        Frame frame = frame_from_normal(s.ng);
        float phi = random_in(r, 0, 2.0f * SHEEN_PI), z = expf(random_in(r, -7.0f, 0.0f));
        float side = convex || random_in(r, -1, 1) > 0.0f ? 1.0f : -1.0f, w = safe_sqrtf(1.0f - z * z);
        Vec3 d = frame_to_world(&frame, v3(w * cosf(phi), w * sinf(phi), side * z));
        Ray away = sheen_surface_ray(&s, d);
        float in_packet;
        sheen_accel_transmittance_many(accel, 1, &away, &in_packet);
        ++t->hits;
        t->again += sheen_accel_occluded(accel, &away) || in_packet < 1.0f;
        t->farthest = fmax(t->farthest, (double)(s.clearance / (v3_length(at) + size)));
    }
    sheen_accel_destroy(&accel);
}

static void test_rays_leave(void **state)
{
    (void)state;
    SheenPool *pool = NULL;
    assert_int_equal(sheen_pool_create(1, &pool), SHEEN_OK);
    for (Kind kind = 0; kind < KINDS; ++kind) {
        Tally t = {0};
        Random r = {7, 0};
        for (int i = 0; i < N_PRIMITIVES; ++i) {
            float size = expf(random_in(&r, -10.0f, 8.0f)); // 0.05 mm to 3 km
            Vec3 at = v3_scale(random_direction(&r), i % 4 == 0 ? 0.0f : size * expf(random_in(&r, -3.0f, 8.0f)));
            SheenScene *scene = scene_of(kind, &r, at, size);
            leave(scene, pool, &r, at, size, kind == SPHERE, &t);
            sheen_scene_destroy(&scene);
        }
        if (getenv("SHEEN_SHOW"))
            print_message("%s: %d of %d hit again, farthest %g\n", kind_names[kind], t.again, t.hits, t.farthest);
        assert_true(t.hits > N_PRIMITIVES * N_RAYS / 10);
        assert_int_equal(t.again, 0);
        // Four roundings of the coordinates and of the size, 2.4e-7 each, by up to sqrt(3) for the sum over the axes
        // and twice for the edges; an instance adds up its way in and out. A sliver's normal is up to 150 times less
        // sure.
        assert_true(t.farthest < (kind == SLIVER ? 1e-4 : 5e-6));
    }
    sheen_pool_destroy(&pool);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_rays_leave)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
