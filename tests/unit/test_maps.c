// SPDX-License-Identifier: Apache-2.0
// Bump and normal maps, and materials with a direction: texture coordinates become frames.
#include "material/bsdf.h"
#include "unit/light_scene.h"

static void assert_v3(Vec3 got, Vec3 want, float tolerance)
{
    if (!(v3_length(v3_sub(got, want)) <= tolerance))
        fail_msg("(%g %g %g), want (%g %g %g)", (double)got.x, (double)got.y, (double)got.z, (double)want.x,
                 (double)want.y, (double)want.z);
}

// ---- gradients of textures --------------------------------------------------------------------------------------

static void test_gradients_are_derivatives(void **state)
{
    (void)state;
    Rgb texels[6 * 4];
    Random r = {1, 0};
    for (int i = 0; i < 24; ++i) texels[i] = rgb(random_1d(&r), random_1d(&r), random_1d(&r));
    SheenTexture t = sheen_texture_constant(rgb_gray(0));
    assert_true(sheen_texture_gradient(&t, v2(0.3f, 0.4f)).x == 0);
    t.kind = SHEEN_TEXTURE_BITMAP;
    t.bitmap = (SheenBitmap){.width = 6, .height = 4, .floats = texels};
    t.uv[0][0] = 1.3f, t.uv[0][1] = 0.4f, t.uv[0][2] = 0.1f, t.uv[1][0] = -0.6f, t.uv[1][1] = 0.9f;
    int n_smooth = 0;
    for (int i = 0; i < 3000; ++i) {
        t.wrap_u = (SheenWrap)(i % 3), t.wrap_v = (SheenWrap)(i / 3 % 3);
        Vec2 p = v2(random_in(&r, -2, 3), random_in(&r, -2, 3)), g = sheen_texture_gradient(&t, p);
        const float h = 1e-3f;
        double lo_u = (double)rgb_luminance(sheen_texture_eval(&t, v2(p.x - h, p.y)));
        double hi_u = (double)rgb_luminance(sheen_texture_eval(&t, v2(p.x + h, p.y)));
        double lo_v = (double)rgb_luminance(sheen_texture_eval(&t, v2(p.x, p.y - h)));
        double hi_v = (double)rgb_luminance(sheen_texture_eval(&t, v2(p.x, p.y + h)));
        // Differences across a row of texel centres see both slopes: those few points are left out.
        bool near = fabs((hi_u - lo_u) / (2 * (double)h) - (double)g.x) < 0.02 &&
                    fabs((hi_v - lo_v) / (2 * (double)h) - (double)g.y) < 0.02;
        n_smooth += near;
    }
    assert_true(n_smooth > 3000 * 0.96); // both lines are within h of a centre at 2 % of the points
    t.nearest = true;
    assert_true(sheen_texture_gradient(&t, v2(0.3f, 0.4f)).x == 0);
}

// ---- tangents of shapes -----------------------------------------------------------------------------------------

static SurfacePoint hit(const SheenScene *scene, SheenAccel *accel, Vec3 o, Vec3 d)
{
    Ray ray = {o, INFINITY, d};
    Hit h;
    SurfacePoint s;
    sheen_accel_intersect(accel, &ray, &h);
    assert_true(h.shape != SHEEN_NONE);
    sheen_surface_from_hit(scene, &ray, &h, &s);
    return s;
}

// Two hits near a third: their texture coordinates differ as the tangents say.
static void check_tangents(const SheenScene *scene, SheenAccel *accel, Vec3 o, Vec3 d)
{
    SurfacePoint s = hit(scene, accel, o, d);
    Vec3 du, dv;
    sheen_surface_tangents(scene, &s, &du, &dv);
    assert_true(fabsf(v3_dot(du, s.ng)) < 1e-3f * v3_length(du) && fabsf(v3_dot(dv, s.ng)) < 1e-3f * v3_length(dv));
    const Vec3 steps[2] = {{3e-3f, 1e-3f, 0}, {-1e-3f, 2e-3f, 0}};
    for (int i = 0; i < 2; ++i) {
        SurfacePoint other = hit(scene, accel, v3_add(o, steps[i]), d);
        Vec3 moved = v3_sub(other.p, s.p);
        Vec3 said = v3_mad(v3_scale(du, other.uv.x - s.uv.x), other.uv.y - s.uv.y, dv);
        assert_v3(said, moved, 0.02f * v3_length(moved)); // curvature over a step
    }
}

static void test_tangents_move_as_the_surface(void **state)
{
    (void)state;
    SheenPool *pool;
    assert_int_equal(sheen_pool_create(1, &pool), SHEEN_OK);
    for (int kind = 0; kind < 4; ++kind) {
        LightScene ls = light_scene_begin();
        SheenShape shape = {.name = "s", .material = 0};
        if (kind == 0) {
            shape.kind = SHEEN_SHAPE_SPHERE;
            shape.sphere = (SheenSphere){v3(0.1f, 0.2f, 0), 1.5f, false, frame_from_normal(v3(0.48f, 0.64f, 0.6f))};
        } else if (kind == 1) {
            shape.kind = SHEEN_SHAPE_DISK;
            shape.disk = (SheenDisk){v3(0, 0, 0), v3(2, 0, 0.5f), v3(0.3f, 1.5f, 0),
                                     v3_normalize(v3_cross(v3(2, 0, 0.5f), v3(0.3f, 1.5f, 0)))};
        } else {
            static Vec3 p[5] = {{-2, -2, 0.3f}, {2, -2, -0.4f}, {2, 2, 0}, {-2, 2.5f, 0.2f}};
            static Vec2 uv[4] = {{0.1f, 0.9f}, {0.2f, 0.1f}, {0.8f, 0.2f}, {1.4f, 1.1f}};
            static const uint32_t t[2][3] = {{0, 1, 2}, {0, 2, 3}};
            shape.kind = SHEEN_SHAPE_MESH;
            shape.mesh = (SheenMesh){4, 2, p, NULL, uv, t, NULL, NULL};
        }
        if (kind == 3) { // placed: turned and stretched
            Transform to_world = transform_mul(transform_rotate(v3(0, 0, 1), 0.7), transform_scale(1.5, 0.8, 2));
            uint32_t group = sheen_builder_begin_group(ls.builder);
            sheen_builder_add_shape(ls.builder, &shape);
            sheen_builder_end_group(ls.builder);
            sheen_builder_add_instance(ls.builder, group, &to_world);
        } else {
            sheen_builder_add_shape(ls.builder, &shape);
        }
        light_scene_end(&ls, SHEEN_ENVIRONMENT_WHOLE);
        SheenAccel *accel;
        assert_int_equal(sheen_accel_create(ls.scene, pool, NULL, &accel), SHEEN_OK);
        check_tangents(ls.scene, accel, v3(0.4f, 0.3f, 5), v3(0, 0, -1));
        check_tangents(ls.scene, accel, v3(-0.5f, 0.7f, 5), v3(0, 0, -1));
        sheen_accel_destroy(&accel);
        light_scene_destroy(&ls);
    }
    sheen_pool_destroy(&pool);
}

// ---- frames -----------------------------------------------------------------------------------------------------

/** A square of one metre about the origin, facing +z, u along `along_u`; the material is a map over `inner`. */
typedef struct Mapped {
    SheenScene *scene;
    SurfacePoint point;
} Mapped;

static Mapped mapped(const SheenMaterial *outer, const SheenMaterial *inner, bool u_along_y)
{
    static Vec3 p[5] = {{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}};
    static Vec2 along_x[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, along_y[4] = {{0, 1}, {0, 0}, {1, 0}, {1, 1}};
    static const uint32_t t[2][3] = {{0, 1, 2}, {0, 2, 3}};
    SheenBuilder *b;
    Mapped m = {.point = {.ns = {0, 0, 1}, .ng = {0, 0, 1}, .uv = {0.5f, 0.5f}, .instance = SHEEN_NONE}};
    assert_int_equal(sheen_builder_create(NULL, "maps", &b), SHEEN_OK);
    SheenMaterial top = *inner;
    uint32_t index = sheen_builder_add_material(b, inner);
    if (outer) {
        top = *outer;
        top.nested[0] = index;
        index = sheen_builder_add_material(b, &top);
    }
    SheenShape shape = {.kind = SHEEN_SHAPE_MESH, .material = index, .name = "square"};
    shape.mesh = (SheenMesh){4, 2, p, NULL, u_along_y ? along_y : along_x, t, NULL, NULL};
    sheen_builder_add_shape(b, &shape);
    assert_int_equal(sheen_builder_commit(&b, &m.scene), SHEEN_OK);
    return m;
}

static SheenMaterial white(void)
{
    return (SheenMaterial){.kind = SHEEN_MATERIAL_DIFFUSE, .reflectance = sheen_texture_constant(rgb_gray(1))};
}

// A ramp that rises by `rise` from the left half of the square to the right: slope 2 rise at the middle.
static const Rgb ramp_texels[2] = {{0, 0, 0}, {1, 1, 1}};
static SheenMaterial ramp(float rise)
{
    SheenMaterial m = {.kind = SHEEN_MATERIAL_BUMP, .map_scale = rise};
    m.map = sheen_texture_constant(rgb_gray(0));
    m.map.kind = SHEEN_TEXTURE_BITMAP;
    m.map.bitmap = (SheenBitmap){.width = 2, .height = 1, .floats = ramp_texels};
    return m;
}

static void test_bump_tilts_the_normal(void **state)
{
    (void)state;
    SheenMaterial inner = white(), outer = ramp(0.25f);
    for (int along_y = 0; along_y < 2; ++along_y) {
        Mapped m = mapped(&outer, &inner, along_y);
        Bsdf b = sheen_bsdf_at(m.scene, &m.point);
        Vec3 n, wanted = v3_normalize(along_y ? v3(0, -0.5f, 1) : v3(-0.5f, 0, 1)), wo = v3(0.1f, 0.2f, 0.9746794f);
        assert_true(sheen_bsdf_diffuse(&b, wo, &n).g == 1);
        assert_v3(n, wanted, 1e-5f);
        // f |cos| is that of a Lambertian surface with this normal.
        Vec3 wi = v3_normalize(v3(-0.6f, -0.3f, 0.5f));
        assert_true(fabsf(sheen_bsdf_eval(&b, wo, wi).g - v3_dot(wanted, wi) * SHEEN_INV_PI) < 1e-5f);
        // Light below the surface or below the tilted one does not count.
        assert_true(sheen_bsdf_eval(&b, wo, v3_normalize(along_y ? v3(0, -1, -0.1f) : v3(-1, 0, -0.1f))).g == 0);
        assert_true(sheen_bsdf_eval(&b, wo, v3_normalize(along_y ? v3(0, 1, 0.1f) : v3(1, 0, 0.1f))).g == 0);
        sheen_scene_destroy(&m.scene);
    }
}

static void test_normal_map(void **state)
{
    (void)state;
    SheenMaterial inner = white(), outer = {.kind = SHEEN_MATERIAL_NORMAL};
    Vec3 n, tilted = v3_normalize(v3(0.4f, 0.2f, 0.8f));
    outer.map = sheen_texture_constant(rgb(0.5f * tilted.x + 0.5f, 0.5f * tilted.y + 0.5f, 0.5f * tilted.z + 0.5f));
    inner.two_sided = true;
    Mapped m = mapped(&outer, &inner, false);
    Bsdf b = sheen_bsdf_at(m.scene, &m.point);
    (void)sheen_bsdf_diffuse(&b, v3(0, 0, 1), &n);
    assert_v3(n, tilted, 1e-5f);
    (void)sheen_bsdf_diffuse(&b, v3(0, 0, -1), &n); // from behind, the same plane
    assert_v3(v3(fabsf(n.x), fabsf(n.y), n.z), v3(tilted.x, tilted.y, -tilted.z), 1e-5f);
    sheen_scene_destroy(&m.scene);
    m = mapped(&outer, &inner, true); // u points along y: x of the map too
    b = sheen_bsdf_at(m.scene, &m.point);
    (void)sheen_bsdf_diffuse(&b, v3(0, 0, 1), &n);
    assert_v3(n, v3(-tilted.y, tilted.x, tilted.z), 1e-5f);
    sheen_scene_destroy(&m.scene);
}

// A view that the mapped normal turns away from: black without, lit with the normal on the other side.
static void test_normals_that_look_away(void **state)
{
    (void)state;
    SheenMaterial inner = white(), outer = ramp(1.0f); // normal (-2, 0, 1)
    Vec3 wo = v3_normalize(v3(1, 0, 0.5f)), wi = v3_normalize(v3(0.3f, 0.1f, 1)), n;
    for (int turn = 0; turn < 2; ++turn) {
        outer.turn_normals = turn;
        Mapped m = mapped(&outer, &inner, false);
        Bsdf b = sheen_bsdf_at(m.scene, &m.point);
        assert_int_equal(sheen_bsdf_eval(&b, wo, wi).g > 0, turn);
        assert_int_equal(sheen_bsdf_diffuse(&b, wo, &n).g > 0, turn);
        if (turn) assert_v3(n, v3_normalize(v3(2, 0, 1)), 1e-5f);
        Random r = {1, 0};
        for (int i = 0; i < 200; ++i) {
            BsdfSample s;
            if (!sheen_bsdf_sample(&b, wo, random_1d(&r), random_2d(&r), &s)) continue;
            Rgb f = sheen_bsdf_eval(&b, wo, s.wi_l);
            assert_true(s.wi_l.z > 0 && fabsf(f.g - s.weight.g * s.pdf) < 1e-5f);
        }
        sheen_scene_destroy(&m.scene);
    }
    // With shadowing, light along the surface fades; light from above is as before.
    outer.turn_normals = false;
    float f[2][2];
    for (int shadow = 0; shadow < 2; ++shadow) {
        outer.shadow_normals = shadow;
        Mapped m = mapped(&outer, &inner, false);
        Bsdf b = sheen_bsdf_at(m.scene, &m.point);
        f[shadow][0] = sheen_bsdf_eval(&b, v3(0, 0, 1), v3(0, 0, 1)).g;
        f[shadow][1] = sheen_bsdf_eval(&b, v3(0, 0, 1), v3_normalize(v3(-1, 0, 0.1f))).g;
        sheen_scene_destroy(&m.scene);
    }
    assert_true(fabsf(f[1][0] - f[0][0]) < 1e-6f);
    // alpha^2 = 0.125 4, tan^2 = 100
    assert_true(fabsf(f[1][1] - f[0][1] * 2 / (1 + sqrtf(1 + 0.5f * 100))) < 1e-5f);
}

static void test_brushed_metal_follows_u(void **state)
{
    (void)state;
    SheenMaterial metal = {.kind = SHEEN_MATERIAL_ROUGH_CONDUCTOR,
                           .distribution = SHEEN_DISTRIBUTION_GGX,
                           .alpha_u = sheen_texture_constant(rgb_gray(0.05f)),
                           .alpha_v = sheen_texture_constant(rgb_gray(0.5f)),
                           .specular_reflectance = sheen_texture_constant(rgb_gray(1)),
                           .k = rgb_gray(1)};
    Vec3 wo = v3(0, 0, 1), x = v3_normalize(v3(0.5f, 0, 1)), y = v3_normalize(v3(0, 0.5f, 1));
    for (int along_y = 0; along_y < 2; ++along_y) {
        Mapped m = mapped(NULL, &metal, along_y);
        Bsdf b = sheen_bsdf_at(m.scene, &m.point);
        float along = sheen_bsdf_eval(&b, wo, along_y ? y : x).g, across = sheen_bsdf_eval(&b, wo, along_y ? x : y).g;
        assert_true(across > 10 * along); // smooth along u: the highlight is short there
        sheen_scene_destroy(&m.scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_gradients_are_derivatives), cmocka_unit_test(test_tangents_move_as_the_surface),
        cmocka_unit_test(test_bump_tilts_the_normal),     cmocka_unit_test(test_normal_map),
        cmocka_unit_test(test_normals_that_look_away),    cmocka_unit_test(test_brushed_metal_follows_u),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
