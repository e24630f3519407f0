// SPDX-License-Identifier: Apache-2.0
// Glossy surfaces in the irradiance integrator, against path tracing and against albedos.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "analytic/irradiance_kit.h"
#include "integrator/follow.h"

static SheenMaterial rough(SheenMaterialKind kind, float alpha)
{
    return (SheenMaterial){.kind = kind,
                           .reflectance = sheen_texture_constant(rgb_gray(0.5f)),
                           .specular_reflectance = sheen_texture_constant(rgb_gray(0.8f)),
                           .specular_transmittance = sheen_texture_constant(rgb_gray(0.6f)),
                           .alpha_u = sheen_texture_constant(rgb_gray(alpha)),
                           .alpha_v = sheen_texture_constant(rgb_gray(alpha)),
                           .distribution = SHEEN_DISTRIBUTION_GGX,
                           .weight = sheen_texture_constant(rgb_gray(0.4f)),
                           .eta = rgb_gray(0.2f),
                           .k = rgb_gray(3.0f),
                           .ior = 1.5f,
                           .exponent = 30.0f,
                           .name = "rough"};
}

static uint32_t add_material(SheenBuilder *b, SheenMaterialKind kind, float alpha)
{
    SheenMaterial m = rough(kind, alpha);
    if (kind == SHEEN_MATERIAL_PHONG) m.specular_reflectance = sheen_texture_constant(rgb_gray(0.3f));
    if (kind == SHEEN_MATERIAL_MASK || kind == SHEEN_MATERIAL_BLEND) {
        m.nested[0] = kit_diffuse(b, 0.7f);
        m.nested[1] = add_material(b, SHEEN_MATERIAL_ROUGH_CONDUCTOR, alpha);
    }
    if (kind == SHEEN_MATERIAL_DIFFUSE_TRANSMIT) m.specular_reflectance = sheen_texture_constant(rgb_gray(0.3f));
    return sheen_builder_add_material(b, &m);
}

typedef struct GlossyCase {
    const char *name;
    SheenMaterialKind kind;
    float alpha;
    double mean, block; // bounds of the picture's mean and of a block
} GlossyCase;

// Bounds as in test_irradiance_against_path, but gathers lack some of the lamp in metal, a caustic: 0.8 % of the
// picture was measured.
static const GlossyCase cases[] = {
    {"rough metal", SHEEN_MATERIAL_ROUGH_CONDUCTOR, 0.3f, 0.015, 0.06},
    {"narrow metal", SHEEN_MATERIAL_ROUGH_CONDUCTOR, 0.1f, 0.015, 0.06},
    {"plastic", SHEEN_MATERIAL_PLASTIC, 0.0f, 0.01, 0.06},
    {"rough plastic", SHEEN_MATERIAL_ROUGH_PLASTIC, 0.15f, 0.01, 0.06},
    {"phong", SHEEN_MATERIAL_PHONG, 0.0f, 0.01, 0.06},
    {"mask", SHEEN_MATERIAL_MASK, 0.3f, 0.01, 0.06},
    {"blend", SHEEN_MATERIAL_BLEND, 0.3f, 0.01, 0.06},
    {"paper", SHEEN_MATERIAL_DIFFUSE_TRANSMIT, 0.0f, 0.01, 0.06},
};
enum { N_CASES = sizeof cases / sizeof *cases };

static void test_room_with_a_glossy_ball(void **state)
{
    (void)state;
    for (int i = 0; i < N_CASES; ++i) {
        SheenBuilder *b = kit_room(1.0f, 0.5f, SHEEN_MATERIAL_DIFFUSE, true);
        kit_sphere(b, v3(0.35f, 0.1f, 0.2f), 0.4f, false, add_material(b, cases[i].kind, cases[i].alpha));
        Stage stage = stage_end(b, 2);
        SheenRenderSettings s = small_settings(8);
        s.options.spp = 16;
        s.options.gather_rays = 256;
        assert_agrees_with_paths(&stage, &s, 256, cases[i].mean, cases[i].block, cases[i].name);
        stage_free(&stage);
    }
}

// In the mean over its ways, a step takes and gives as much light as the BSDF's albedo says.
static void test_steps_keep_the_albedo(void **state)
{
    (void)state;
    enum { N = 1 << 14 };
    for (int i = 0; i < N_CASES; ++i) {
        SheenBuilder *b = kit_begin();
        kit_quad(b, v3(-1, -1, 0), v3(2, 0, 0), v3(0, 2, 0), add_material(b, cases[i].kind, cases[i].alpha));
        SheenScene *scene = NULL;
        assert_int_equal(sheen_builder_commit(&b, &scene), SHEEN_OK);
        SurfacePoint s = {.ng = v3(0, 0, 1), .ns = v3(0, 0, 1), .instance = SHEEN_NONE};
        Bsdf bsdf = sheen_bsdf_at(scene, &s);
        Vec3 wo = v3(0.6f, 0.0f, 0.8f);
        double sum = 0.0;
        for (uint32_t k = 0; k < N; ++k) {
            SheenSampler sampler = sampler_make(7, k);
            Rgb through = rgb_gray(1.0f);
            Ray next;
            DiffusePoint point;
            SheenStep step = sheen_step(&s, &bsdf, wo, &sampler, &through, &next, &point);
            if (step == SHEEN_STEP_PASSES || step == SHEEN_STEP_GOES_ON) sum += (double)through.g / N;
            if (step == SHEEN_STEP_SCATTERS || step == SHEEN_STEP_TURNS) sum += (double)point.reflectance.g / N;
        }
        double albedo = (double)sheen_bsdf_albedo(&bsdf, wo).g;
        show("%s: steps %.4f, albedo %.4f\n", cases[i].name, sum, albedo);
        assert_true(albedo > 0.1 && fabs(sum / albedo - 1.0) < 0.02); // what sheen_bsdf_albedo is good to
        sheen_scene_destroy(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_steps_keep_the_albedo),
        cmocka_unit_test(test_room_with_a_glossy_ball),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
