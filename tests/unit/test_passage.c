// SPDX-License-Identifier: Apache-2.0
// What rays make of holes: shadow rays are weakened, others pass where there is nothing, and BSDFs agree.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "analytic/path_kit.h"
#include "material/bsdf.h"
#include "math/sampler.h"
#include "scene/passage.h"

static uint32_t add_mask(SheenBuilder *b, SheenTexture opacity, uint32_t nested)
{
    SheenMaterial m = {.kind = SHEEN_MATERIAL_MASK, .weight = opacity, .nested = {nested}, .name = "mask"};
    return sheen_builder_add_material(b, &m);
}

static uint32_t gray_mask(SheenBuilder *b, float opacity)
{
    return add_mask(b, sheen_texture_constant(rgb_gray(opacity)), kit_diffuse(b, 0.5f));
}

static SheenTexture checkerboard(float first, float second)
{
    SheenTexture t = sheen_texture_constant(rgb_gray(first));
    t.kind = SHEEN_TEXTURE_CHECKERBOARD;
    t.value2 = rgb_gray(second);
    return t;
}

/** The square [-1, 1]^2 at height z, its front above. */
static uint32_t sheet(SheenBuilder *b, float z, uint32_t material)
{
    return kit_quad(b, v3(-1, -1, z), v3(2, 0, 0), v3(0, 2, 0), material);
}

static Kit scene_end(SheenBuilder *b)
{
    Kit kit;
    kit_camera(b, v3(0, 0, -5), v3(0, 0, 0), v3(0, 1, 0), 1.0f);
    kit_end(b, 1, &kit);
    return kit;
}

/** The same by a single ray and in a packet, among others that meet nothing. */
static float transmittance(const Kit *kit, Vec3 from, Vec3 to)
{
    Ray rays[21];
    float through[21], alone;
    for (int i = 0; i < 21; ++i) rays[i] = (Ray){v3(9, 9, (float)i), 1.0f, v3(1, 0, 0)};
    rays[18] = (Ray){from, 1.0f, v3_sub(to, from)};
    rays[3] = (Ray){from, -1.0f, v3_sub(to, from)};
    alone = sheen_accel_transmittance(kit->accel, &rays[18]);
    assert_int_equal(sheen_accel_occluded(kit->accel, &rays[18]), alone == 0.0f);
    sheen_accel_transmittance_many(kit->accel, 21, rays, through);
    for (int i = 0; i < 21; ++i)
        if (i != 18) assert_true(through[i] == (i == 3 ? 0.0f : 1.0f));
    assert_true(through[18] == alone);
    return alone;
}

static float down(const Kit *kit, float x, float y)
{
    return transmittance(kit, v3(x, y, 5.0f), v3(x, y, -5.0f));
}

static void test_sheets_multiply(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    sheet(b, 1.0f, gray_mask(b, 0.3f));
    Kit kit = scene_end(b);
    assert_true(down(&kit, 0.3f, 0.6f) == 1.0f - 0.3f);
    assert_true(down(&kit, -0.6f, 0.3f) == 1.0f - 0.3f);
    // On the diagonal both triangles are hit; the sheet is one.
    assert_true(down(&kit, 0.25f, 0.25f) == 1.0f - 0.3f);
    assert_true(down(&kit, 1.5f, 0.0f) == 1.0f);
    kit_free(&kit);

    b = kit_begin();
    sheet(b, 1.0f, gray_mask(b, 0.3f));
    sheet(b, 2.0f, gray_mask(b, 0.5f));
    kit_quad(b, v3(-1, 0, -1), v3(2, 0, 0), v3(0, 1, 0), kit_diffuse(b, 0.5f));
    kit = scene_end(b);
    assert_float_equal(down(&kit, 0.3f, -0.6f), 0.7f * 0.5f, 1e-7f); // a unit in the last place
    assert_true(down(&kit, 0.3f, 0.6f) == 0.0f);
    kit_free(&kit);
}

// The faces of a closed body are two surfaces; a disk is one, and so is an instance of either.
static void test_quadrics_and_instances(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    uint32_t mask = gray_mask(b, 0.25f);
    kit_sphere(b, v3(0, 0, 1), 0.5f, false, mask);
    kit_disk(b, v3(3, 0, 1), 0.5f, v3(0, 0, 1), mask);
    uint32_t group = sheen_builder_begin_group(b);
    kit_sphere(b, v3(0, 0, 1), 0.5f, false, mask);
    sheet(b, 3.0f, mask);
    sheen_builder_end_group(b);
    Transform to_world = transform_mul(transform_translate(-3, 0, 0), transform_scale(2, -1, 1));
    sheen_builder_add_instance(b, group, &to_world);
    Kit kit = scene_end(b);
    assert_true(down(&kit, 0.2f, 0.1f) == 0.75f * 0.75f);
    assert_true(transmittance(&kit, v3(0.1f, 0, 1), v3(0.1f, 0, 5)) == 0.75f); // from within
    assert_true(down(&kit, 3.2f, 0.1f) == 0.75f);
    assert_true(down(&kit, -3.7f, 0.1f) == 0.75f * 0.75f * 0.75f);
    assert_true(down(&kit, -4.5f, 0.1f) == 0.75f);
    assert_true(down(&kit, 0.6f, 0.0f) == 1.0f);
    kit_free(&kit);
}

static uint32_t hit_shape(const Kit *kit, Vec3 from, Vec3 d)
{
    Ray ray = {from, INFINITY, d};
    Hit hit, batch[17];
    Ray rays[17];
    for (int i = 0; i < 17; ++i) rays[i] = ray;
    sheen_accel_intersect(kit->accel, &ray, &hit);
    sheen_accel_intersect_many(kit->accel, SHEEN_COHERENT, 17, rays, batch);
    for (int i = 0; i < 17; ++i) assert_int_equal(batch[i].shape, hit.shape);
    return hit.shape;
}

static void test_rays_pass_where_there_is_nothing(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    uint32_t holes = add_mask(b, checkerboard(0.0f, 1.0f), kit_diffuse(b, 0.5f));
    uint32_t board = sheet(b, 2.0f, holes), floor = sheet(b, 0.0f, kit_diffuse(b, 0.5f));
    uint32_t ball = kit_sphere(b, v3(4, 0, 2), 1.0f, false, holes);
    uint32_t lamp = kit_quad(b, v3(7, 0, 2), v3(1, 0, 0), v3(0, 1, 0), gray_mask(b, 0.0f));
    sheen_builder_add_area_light(b, lamp, rgb_gray(1.0f));
    Kit kit = scene_end(b);
    const Vec3 dir = {0, 0, -1};
    for (int i = 0; i < 16; ++i) {
        float x = -0.9f + 0.6f * (float)(i % 4), y = -0.9f + 0.6f * (float)(i / 4);
        bool hole = (x > 0.0f) == (y > 0.0f); // the first colour
        assert_int_equal(hit_shape(&kit, v3(x, y, 3), dir), hole ? floor : board);
        assert_true(transmittance(&kit, v3(x, y, 3), v3(x, y, 1)) == (hole ? 1.0f : 0.0f));
    }
    // On a sphere u is the azimuth and v the polar angle: the upper half is open for u below 1/2, y > 0, the lower half
    // for the others.
    assert_int_equal(hit_shape(&kit, v3(4, -0.5f, 9), dir), ball);
    Ray through = {v3(4, 0.5f, 9), INFINITY, dir};
    Hit hit;
    sheen_accel_intersect(kit.accel, &through, &hit);
    assert_int_equal(hit.shape, ball);
    assert_float_equal(hit.t, 7.0f + sqrtf(0.75f), 1e-5f); // its other side
    assert_true(transmittance(&kit, v3(4, 0.5f, 9), v3(4, 0.5f, 2)) == 1.0f);
    assert_true(transmittance(&kit, v3(4, 0.5f, 9), v3(4, 0.5f, 0)) == 0.0f);
    // What shines is seen, hole or not; its shadow is none.
    assert_int_equal(hit_shape(&kit, v3(7.5f, 0.2f, 5), dir), lamp);
    assert_true(down(&kit, 7.5f, 0.2f) == 1.0f);
    kit_free(&kit);
}

// Thousands of rays through a heap of sheets, balls and instances, against a walk from surface to surface through the
// same heap of opaque material.
static void test_against_a_walk(void **state)
{
    (void)state;
    enum { SHEETS = 40, BALLS = 10, RAYS = 4096 };
    static const float opacity[] = {0.25f, 0.5f, 0.75f, 0.875f};
    Kit kits[2];
    for (int opaque = 0; opaque < 2; ++opaque) {
        SheenBuilder *b = kit_begin();
        SheenSampler s = sampler_make(5, 0);
        uint32_t solid = kit_diffuse(b, 0.5f), masks[4];
        for (int i = 0; i < 4; ++i) masks[i] = opaque ? solid : gray_mask(b, opacity[i]);
        for (int i = 0; i < SHEETS + BALLS; ++i) {
            Vec2 u = sampler_2d(&s), v = sampler_2d(&s), w = sampler_2d(&s);
            Vec3 p = v3(u.x, u.y, sampler_1d(&s)), e = v3(v.x - 0.5f, v.y - 0.5f, w.x - 0.5f);
            if (i < SHEETS)
                kit_quad(b, p, e, v3(-e.y, e.x, 0.2f + w.y), masks[i % 4]);
            else
                kit_sphere(b, p, 0.2f * w.y, false, masks[i % 4]);
        }
        uint32_t group = sheen_builder_begin_group(b);
        sheet(b, 0.4f, masks[1]);
        kit_sphere(b, v3(0.5f, 0.5f, 0.7f), 0.2f, false, masks[2]);
        sheen_builder_end_group(b);
        Transform half = transform_scale(0.5, 0.5, 0.5), same = transform_identity();
        sheen_builder_add_instance(b, group, &half);
        sheen_builder_add_instance(b, group, &same);
        kits[opaque] = scene_end(b);
    }
    static Ray rays[RAYS];
    static float got[RAYS];
    for (uint32_t i = 0; i < RAYS; ++i) {
        SheenSampler s = sampler_make(6, i);
        Vec2 a = sampler_2d(&s), c = sampler_2d(&s);
        Vec3 from = v3(a.x, a.y, -1.0f), to = v3(c.x, c.y, 2.0f);
        rays[i] = (Ray){from, 1.0f, v3_sub(to, from)};
    }
    sheen_accel_transmittance_many(kits[0].accel, RAYS, rays, got);
    unsigned crossed = 0, most = 0, other = 0;
    for (uint32_t i = 0; i < RAYS; ++i) {
        float want = 1.0f;
        unsigned n = 0;
        Ray left = rays[i];
        Hit hit;
        for (;;) {
            sheen_accel_intersect(kits[1].accel, &left, &hit);
            if (hit.shape == SHEEN_NONE) break;
            SurfacePoint at;
            sheen_surface_from_hit(kits[1].scene, &left, &hit, &at);
            uint32_t material = kits[0].scene->shapes[at.shape].material;
            want *= sheen_material_passage(kits[0].scene->materials, material, at.uv, true);
            float rest = left.t_max - hit.t;
            Vec3 d = left.d;
            left = sheen_surface_ray(&at, d);
            left.t_max = rest;
            ++n;
        }
        crossed += n;
        most = n > most ? n : most;
        other += !(fabsf(got[i] - want) <= 1e-6f * want); // the walk rounds each product
    }
    assert_true(crossed > 4 * RAYS && most > 12); // there was something to count
    assert_true(other <= 2); // where two surfaces cut each other, the walk leaves the first beyond the second
    kit_free(&kits[0]);
    kit_free(&kits[1]);
}

// A mask on one side only, in a blend, twice nested; below a map it is a lobe that shadow rays do not pass.
static void test_lobes_agree_with_passage(void **state)
{
    (void)state;
    enum { N = 8 };
    SheenBuilder *b = kit_begin();
    uint32_t white = kit_diffuse(b, 0.8f), mask = gray_mask(b, 0.3f), materials[N];
    SheenMaterial m = {.name = "test",
                       .weight = sheen_texture_constant(rgb_gray(0.25f)),
                       .map = checkerboard(0.2f, 0.8f),
                       .map_scale = 0.1f,
                       .ior = 1.5f,
                       .nested = {mask, white}};
    const SheenMaterialKind kinds[N] = {SHEEN_MATERIAL_MASK,    SHEEN_MATERIAL_BLEND,  SHEEN_MATERIAL_SIDES,
                                        SHEEN_MATERIAL_SIDES,   SHEEN_MATERIAL_MASK,   SHEEN_MATERIAL_BUMP,
                                        SHEEN_MATERIAL_COATING, SHEEN_MATERIAL_DIFFUSE};
    for (int i = 0; i < N; ++i) {
        m.kind = kinds[i];
        m.two_sided = i == 3;
        if (i == 4) m.weight = checkerboard(0.0f, 0.6f);
        materials[i] = sheen_builder_add_material(b, &m);
        kit_quad(b, v3(-1, -1, (float)i), v3(2, 0, 0), v3(0, 2, 0), materials[i]);
    }
    Kit kit = scene_end(b);
    static const float front[N] = {0.75f + 0.25f * 0.7f, 0.75f * 0.7f, 0.7f, 0.7f, 1.0f, 0.0f, 0.0f, 0.0f};
    static const float back[N] = {0.75f + 0.25f * 0.7f, 0.75f * 0.7f, 0.0f, 0.7f, 1.0f, 0.0f, 0.0f, 0.0f};
    for (int i = 0; i < N; ++i) {
        SurfacePoint s = {.ng = v3(0, 0, 1), .ns = v3(0, 0, 1), .uv = v2(0.2f, 0.2f), .instance = SHEEN_NONE};
        s.shape = (uint32_t)i;
        bool pierced = sheen_material_is_pierced(kit.scene->materials, materials[i]);
        assert_int_equal(pierced, front[i] > 0.0f);
        for (int side = 0; side < 2; ++side) {
            float want = side ? back[i] : front[i];
            Vec3 wo = v3(0.6f, 0.0f, side ? -0.8f : 0.8f);
            assert_float_equal(sheen_material_passage(kit.scene->materials, materials[i], s.uv, side == 0), want,
                               1e-6f);
            float z = (float)i + (side ? -0.5f : 0.5f);
            assert_float_equal(transmittance(&kit, v3(-0.6f, -0.6f, z), v3(-0.6f, -0.6f, 2.0f * (float)i - z)), want,
                               1e-6f);
            Bsdf bsdf = sheen_bsdf_at(kit.scene, &s);
            BsdfSample lobes[SHEEN_BSDF_MAX_DELTA];
            int n = sheen_bsdf_delta_lobes(&bsdf, wo, lobes);
            float sum = 0.0f, sampled = 0.0f;
            for (int k = 0; k < n; ++k)
                if (lobes[k].passage) sum += lobes[k].weight.g;
            assert_float_equal(sum, want, 1e-6f);
            enum { SAMPLES = 4096 };
            for (uint32_t k = 0; k < SAMPLES; ++k) {
                SheenSampler sampler = sampler_make(9, k);
                BsdfSample sample;
                float choice = sampler_1d(&sampler);
                if (!sheen_bsdf_sample(&bsdf, wo, choice, sampler_2d(&sampler), &sample) || !sample.passage) continue;
                assert_true(v3_length2(v3_add(sample.wi_l, wo)) == 0.0f && sample.delta && sample.transmit);
                sampled += sample.weight.g / SAMPLES;
            }
            assert_float_equal(sampled, want, 1e-3f); // stratified: one sample is 1/4096 of the choice
        }
    }
    kit_free(&kit);
}

// Layers beyond counting let nothing pass, and numbers stay in order.
static void test_many_layers(void **state)
{
    (void)state;
    SheenBuilder *b = kit_begin();
    for (int i = 0; i < 300; ++i) sheet(b, 0.01f * (float)i, gray_mask(b, i < 100 ? 0.01f : 0.5f));
    Kit kit = scene_end(b);
    assert_float_equal(transmittance(&kit, v3(0.3f, 0.1f, -1.0f), v3(0.3f, 0.1f, 0.995f)), 0.366032f,
                       1e-5f); // 0.99^100
    assert_true(down(&kit, 0.3f, 0.1f) == 0.0f);
    kit_free(&kit);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sheets_multiply),
        cmocka_unit_test(test_quadrics_and_instances),
        cmocka_unit_test(test_rays_pass_where_there_is_nothing),
        cmocka_unit_test(test_against_a_walk),
        cmocka_unit_test(test_lobes_agree_with_passage),
        cmocka_unit_test(test_many_layers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
