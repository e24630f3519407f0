// SPDX-License-Identifier: Apache-2.0
// BSDFs: samples against densities, energy, reciprocity, the laws of Fresnel and Snell.
#include "material/bsdf.h"

#include "math/warp.h"
#include "unit/chi_squared.h"
#include "unit/light_scene.h"

static SheenMaterial material(SheenMaterialKind kind)
{
    return (SheenMaterial){.kind = kind,
                           .ior = 1.5f,
                           .name = "m",
                           .reflectance = sheen_texture_constant(rgb(0.2f, 0.5f, 0.8f)),
                           .specular_reflectance = sheen_texture_constant(rgb_gray(1)),
                           .specular_transmittance = sheen_texture_constant(rgb_gray(1))};
}

static Bsdf bsdf_of(const SheenMaterial *m)
{
    SheenShape shape = {.kind = SHEEN_SHAPE_DISK};
    SheenScene scene = {.materials = m, .shapes = &shape};
    SurfacePoint point = {.ns = {0, 0, 1}, .ng = {0, 0, 1}, .instance = SHEEN_NONE};
    return sheen_bsdf_at(&scene, &point);
}

static Vec3 direction(float cosine, float phi)
{
    float s = safe_sqrtf(1 - cosine * cosine);
    return v3(s * cosf(phi), s * sinf(phi), cosine);
}

static void assert_near(double got, double want, double tolerance)
{
    if (!(fabs(got - want) <= tolerance)) fail_msg("%.9g, want %.9g +- %.2g", got, want, tolerance);
}

static void assert_direction(Vec3 got, Vec3 want)
{
    // A few roundings of unit vectors.
    if (!(v3_length(v3_sub(got, want)) <= 1e-6f))
        fail_msg("(%g, %g, %g), want (%g, %g, %g)", (double)got.x, (double)got.y, (double)got.z, (double)want.x,
                 (double)want.y, (double)want.z);
}

// ---- diffuse ----------------------------------------------------------------------------------------------------

#define BINS_Z 16
#define BINS_PHI 16

static void check_diffuse_samples(const Bsdf *b, Vec3 wo)
{
    enum { N = 400000 };
    static double observed[BINS_Z * BINS_PHI], expected[BINS_Z * BINS_PHI];
    memset(observed, 0, sizeof observed);
    memset(expected, 0, sizeof expected);
    Random r = {7, 0};
    for (int i = 0; i < N; ++i) {
        BsdfSample s;
        assert_true(sheen_bsdf_sample(b, wo, random_1d(&r), random_2d(&r), &s));
        assert_near((double)s.pdf, (double)sheen_bsdf_pdf(b, wo, s.wi_l), 1e-6);
        Rgb f = sheen_bsdf_eval(b, wo, s.wi_l);
        assert_near((double)(s.weight.r * s.pdf), (double)f.r, 1e-6);
        float phi = atan2f(s.wi_l.y, s.wi_l.x) / (2 * SHEEN_PI) + 0.5f, z = 0.5f * (s.wi_l.z + 1);
        int i_z = (int)minf(z * BINS_Z, BINS_Z - 1), i_phi = (int)minf(phi * BINS_PHI, BINS_PHI - 1);
        observed[i_z * BINS_PHI + i_phi] += 1;
    }
    // Bins of equal solid angle; the midpoint rule is exact for a density linear in z.
    double sum = 0;
    for (int k = 0; k < BINS_Z * BINS_PHI; ++k) {
        float z = 2 * ((float)(k / BINS_PHI) + 0.5f) / BINS_Z - 1;
        float phi = 2 * SHEEN_PI * (((float)(k % BINS_PHI) + 0.5f) / BINS_PHI - 0.5f);
        double share = (double)sheen_bsdf_pdf(b, wo, direction(z, phi)) * 4 * (double)SHEEN_PI / (BINS_Z * BINS_PHI);
        expected[k] = share * N;
        sum += share;
    }
    assert_near(sum, 1, 1e-5);
    assert_true(chi_squared_deviation(BINS_Z * BINS_PHI, observed, expected) < CHI_SQUARED_LIMIT);
}

static void test_diffuse_samples_follow_the_density(void **state)
{
    (void)state;
    SheenMaterial m = material(SHEEN_MATERIAL_DIFFUSE);
    Bsdf b = bsdf_of(&m);
    check_diffuse_samples(&b, direction(0.3f, 1));
    m.two_sided = true;
    b = bsdf_of(&m);
    check_diffuse_samples(&b, direction(0.3f, 1));
    check_diffuse_samples(&b, direction(-0.7f, 2));
}

static void test_diffuse_sides(void **state)
{
    (void)state;
    SheenMaterial m = material(SHEEN_MATERIAL_DIFFUSE);
    Bsdf b = bsdf_of(&m);
    Vec3 front = direction(0.5f, 1), back = direction(-0.25f, 2);
    BsdfSample s;
    assert_false(sheen_bsdf_is_delta(&b));
    assert_near((double)sheen_bsdf_eval(&b, front, direction(0.25f, 4)).g, 0.5 * 0.25 / (double)SHEEN_PI, 1e-7);
    assert_true(rgb_is_black(sheen_bsdf_eval(&b, front, back)));
    assert_true(rgb_is_black(sheen_bsdf_eval(&b, back, back)));
    assert_true(rgb_is_black(sheen_bsdf_albedo(&b, back)));
    assert_false(sheen_bsdf_sample(&b, back, 0, v2(0.5f, 0.5f), &s));
    m.two_sided = true;
    b = bsdf_of(&m);
    assert_near((double)sheen_bsdf_eval(&b, back, back).g, 0.5 * 0.25 / (double)SHEEN_PI, 1e-7);
    assert_true(rgb_is_black(sheen_bsdf_eval(&b, back, front)));
    assert_true(sheen_bsdf_sample(&b, back, 0, v2(0.5f, 0.5f), &s));
    assert_true(s.wi_l.z < 0 && !s.transmit && !s.delta);
}

static void test_diffuse_is_reciprocal(void **state)
{
    (void)state;
    SheenMaterial m = material(SHEEN_MATERIAL_DIFFUSE);
    m.two_sided = true;
    Bsdf b = bsdf_of(&m);
    Random r = {3, 0};
    for (int i = 0; i < 1000; ++i) {
        Vec3 x = warp_sphere(random_2d(&r)), y = warp_sphere(random_2d(&r));
        double xy = (double)(sheen_bsdf_eval(&b, x, y).g * fabsf(x.z)),
               yx = (double)(sheen_bsdf_eval(&b, y, x).g * fabsf(y.z));
        assert_near(xy, yx, 1e-7);
    }
}

// ---- energy of all kinds ----------------------------------------------------------------------------------------

// White furnace: the mean weight of the samples, where nothing is lost by absorption, is the albedo. For the dielectric
// the factor 1/eta^2 on radiance is taken out.
static void test_albedo_is_the_mean_weight(void **state)
{
    (void)state;
    const SheenMaterialKind kinds[] = {SHEEN_MATERIAL_DIFFUSE, SHEEN_MATERIAL_CONDUCTOR, SHEEN_MATERIAL_DIELECTRIC,
                                       SHEEN_MATERIAL_THIN_DIELECTRIC};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
        SheenMaterial m = material(kinds[k]);
        m.eta = rgb(0.2f, 1.1f, 2);
        m.k = rgb(3.9f, 2.5f, 1.9f);
        m.specular_reflectance = sheen_texture_constant(rgb(0.9f, 0.5f, 0.1f));
        m.specular_transmittance = sheen_texture_constant(rgb(0.2f, 0.6f, 1));
        Bsdf b = bsdf_of(&m);
        const float cosines[] = {1, 0.8f, 0.3f, 0.01f, -0.2f, -0.9f};
        for (size_t c = 0; c < sizeof cosines / sizeof *cosines; ++c) {
            Vec3 wo = direction(cosines[c], 1);
            float scale = kinds[k] != SHEEN_MATERIAL_DIELECTRIC ? 1 : wo.z > 0 ? 1.5f * 1.5f : 1 / (1.5f * 1.5f);
            Random r = {11, 0};
            Moments red = {0}, blue = {0};
            for (int i = 0; i < 20000; ++i) {
                BsdfSample s = {0};
                bool any = sheen_bsdf_sample(&b, wo, random_1d(&r), random_2d(&r), &s);
                float f = any ? (s.transmit ? scale : 1) : 0;
                moments_add(&red, (double)(f * s.weight.r));
                moments_add(&blue, (double)(f * s.weight.b));
            }
            Rgb albedo = sheen_bsdf_albedo(&b, wo);
            // Five standard errors, and rounding for the weights that do not vary.
            assert_near(moments_mean(&red), (double)albedo.r, 5 * moments_error(&red) + 2e-6);
            assert_near(moments_mean(&blue), (double)albedo.b, 5 * moments_error(&blue) + 2e-6);
            assert_true(albedo.r >= 0 && albedo.r <= 1 && albedo.b >= 0 && albedo.b <= 1);
        }
    }
}

static void test_glass_loses_nothing(void **state)
{
    (void)state;
    const SheenMaterialKind kinds[] = {SHEEN_MATERIAL_DIELECTRIC, SHEEN_MATERIAL_THIN_DIELECTRIC};
    for (int k = 0; k < 2; ++k) {
        SheenMaterial m = material(kinds[k]);
        Bsdf b = bsdf_of(&m);
        for (int i = 0; i <= 100; ++i)
            assert_near((double)sheen_bsdf_albedo(&b, direction(0.02f * (float)i - 1, 1)).g, 1, 1e-6);
    }
}

// ---- delta lobes ------------------------------------------------------------------------------------------------

// Values of Mitsuba 3.9's `dielectric`, int_ior 1.5, ext_ior 1, mode radiance.
static void test_dielectric_as_mitsuba(void **state)
{
    (void)state;
    SheenMaterial m = material(SHEEN_MATERIAL_DIELECTRIC);
    Bsdf b = bsdf_of(&m);
    BsdfSample s[SHEEN_BSDF_MAX_DELTA];
    assert_true(sheen_bsdf_is_delta(&b));
    assert_int_equal(sheen_bsdf_delta_lobes(&b, v3(0.6f, 0, 0.8f), s), 2);
    assert_direction(s[0].wi_l, v3(-0.6f, 0, 0.8f));
    assert_near((double)s[0].weight.g, 0.043894730508327484, 1e-6);
    assert_direction(s[1].wi_l, v3(-0.4f, 0, -0.916515f));
    assert_near((double)s[1].weight.g, 0.9561052918434143 / 2.25, 1e-6);
    assert_true(s[1].transmit && s[1].delta && s[1].pdf == 1 && !s[0].transmit && s[0].pdf == 1);

    assert_int_equal(sheen_bsdf_delta_lobes(&b, v3(0.6f, 0, -0.8f), s), 2);
    assert_direction(s[0].wi_l, v3(-0.6f, 0, -0.8f));
    assert_near((double)s[0].weight.g, 0.11414109170436859, 1e-6);
    assert_direction(s[1].wi_l, v3(-0.9f, 0, 0.43589f));
    assert_near((double)s[1].weight.g, 0.8858588933944702 * 2.25, 2e-6);

    assert_int_equal(sheen_bsdf_delta_lobes(&b, direction(-0.3f, 0), s), 1); // total reflection
    assert_direction(s[0].wi_l, v3(-0.953939f, 0, -0.3f));
    assert_true(s[0].weight.g == 1 && !s[0].transmit);

    assert_true(rgb_is_black(sheen_bsdf_eval(&b, direction(0.8f, 0), direction(0.8f, SHEEN_PI))));
    assert_true(sheen_bsdf_pdf(&b, direction(0.8f, 0), direction(0.8f, SHEEN_PI)) == 0);
}

static void test_dielectric_samples_choose_by_energy(void **state)
{
    (void)state;
    SheenMaterial m = material(SHEEN_MATERIAL_DIELECTRIC);
    Bsdf b = bsdf_of(&m);
    BsdfSample s;
    const float f = 0.043894730508327484f;
    assert_true(sheen_bsdf_sample(&b, v3(0.6f, 0, 0.8f), f - 1e-4f, v2(0, 0), &s));
    assert_true(!s.transmit);
    assert_near((double)s.pdf, (double)f, 1e-6);
    assert_near((double)s.weight.g, 1, 1e-6);
    assert_true(sheen_bsdf_sample(&b, v3(0.6f, 0, 0.8f), f + 1e-4f, v2(0, 0), &s));
    assert_true(s.transmit);
    assert_near((double)s.weight.g, 1 / 2.25, 1e-6);
    m.specular_reflectance = sheen_texture_constant(rgb_gray(0));
    b = bsdf_of(&m); // a black lobe is never drawn
    assert_true(sheen_bsdf_sample(&b, v3(0.6f, 0, 0.8f), 0, v2(0, 0), &s));
    assert_true(s.transmit && s.pdf == 1);
}

static void test_index_one_is_not_there(void **state)
{
    (void)state;
    const SheenMaterialKind kinds[] = {SHEEN_MATERIAL_DIELECTRIC, SHEEN_MATERIAL_THIN_DIELECTRIC};
    Random r = {5, 0};
    for (int i = 0; i < 200; ++i) {
        SheenMaterial m = material(kinds[i & 1]);
        m.ior = 1;
        Bsdf b = bsdf_of(&m);
        Vec3 wo = warp_sphere(random_2d(&r));
        BsdfSample s[SHEEN_BSDF_MAX_DELTA];
        assert_int_equal(sheen_bsdf_delta_lobes(&b, wo, s), 1);
        assert_true(s[0].transmit && s[0].weight.g == 1);
        assert_true(s[0].wi_l.x == -wo.x && s[0].wi_l.y == -wo.y && s[0].wi_l.z == -wo.z);
    }
}

// Values of Mitsuba 3.9's `thindielectric`.
static void test_pane_as_mitsuba(void **state)
{
    (void)state;
    SheenMaterial m = material(SHEEN_MATERIAL_THIN_DIELECTRIC);
    Bsdf b = bsdf_of(&m);
    const float cosines[] = {0.8f, 0.2f, -0.2f};
    const double expected[] = {0.08409799635410309, 0.5062301754951477, 0.5062301754951477};
    for (int i = 0; i < 3; ++i) {
        BsdfSample s[SHEEN_BSDF_MAX_DELTA];
        Vec3 wo = direction(cosines[i], 1);
        assert_int_equal(sheen_bsdf_delta_lobes(&b, wo, s), 2);
        assert_near((double)s[0].weight.g, expected[i], 2e-6);
        assert_near((double)s[1].weight.g, 1 - expected[i], 2e-6);
        assert_direction(s[0].wi_l, v3(-wo.x, -wo.y, wo.z));
        assert_direction(s[1].wi_l, v3_neg(wo));
    }
}

// Values of Mitsuba 3.9's `conductor`.
static void test_conductor_as_mitsuba(void **state)
{
    (void)state;
    SheenMaterial m = material(SHEEN_MATERIAL_CONDUCTOR);
    m.eta = rgb(0.2f, 1.1f, 2);
    m.k = rgb(3.9f, 2.5f, 1.9f);
    Bsdf b = bsdf_of(&m);
    const float cosines[] = {1, 0.8f, 0.2f, 0.02f};
    const double expected[][3] = {{0.951952, 0.587242, 0.365583},
                                  {0.951109, 0.58681, 0.3673},
                                  {0.945621, 0.685438, 0.517312},
                                  {0.99141, 0.950818, 0.912374}};
    BsdfSample s[SHEEN_BSDF_MAX_DELTA];
    for (int i = 0; i < 4; ++i) {
        Vec3 wo = direction(cosines[i], 1);
        assert_int_equal(sheen_bsdf_delta_lobes(&b, wo, s), 1);
        assert_direction(s[0].wi_l, v3(-wo.x, -wo.y, wo.z));
        // Six printed digits.
        assert_near((double)s[0].weight.r, expected[i][0], 2e-6);
        assert_near((double)s[0].weight.g, expected[i][1], 2e-6);
        assert_near((double)s[0].weight.b, expected[i][2], 2e-6);
    }
    assert_int_equal(sheen_bsdf_delta_lobes(&b, direction(-0.5f, 1), s), 0);
    m.two_sided = true;
    b = bsdf_of(&m);
    assert_int_equal(sheen_bsdf_delta_lobes(&b, direction(-0.8f, 1), s), 1);
    assert_near((double)s[0].weight.r, expected[1][0], 2e-6);
    assert_true(s[0].wi_l.z < 0);
    m.eta = rgb_gray(0); // a perfect mirror
    m.k = rgb_gray(1);
    b = bsdf_of(&m);
    for (int i = 0; i < 4; ++i) assert_true(sheen_bsdf_albedo(&b, direction(cosines[i], 1)).g == 1);
}

// ---- Fresnel ----------------------------------------------------------------------------------------------------

static void test_fresnel_known_values(void **state)
{
    (void)state;
    float c;
    assert_near((double)sheen_fresnel_dielectric(1, 1.5f, &c), 0.04, 1e-7); // ((n - 1) / (n + 1))^2
    assert_near((double)c, -1, 1e-7);
    assert_near((double)sheen_fresnel_dielectric(-1, 1.5f, &c), 0.04, 1e-7);
    assert_near((double)c, 1, 1e-7);
    assert_true(sheen_fresnel_dielectric(0, 1.5f, &c) == 1);
    // At Brewster's angle, tan = n, only the s polarization is left: half of ((n^2 - 1) / (n^2 + 1))^2.
    float brewster = cosf(atanf(1.5f));
    assert_near((double)sheen_fresnel_dielectric(brewster, 1.5f, &c), 0.5 * pow(1.25 / 3.25, 2), 1e-6);
    // Beyond the critical angle, sin = 1/n, all is reflected; just within it is not.
    float critical = sqrtf(1 - 1 / (1.5f * 1.5f));
    assert_true(sheen_fresnel_dielectric(-critical + 1e-3f, 1.5f, &c) == 1 && c == 0);
    assert_true(sheen_fresnel_dielectric(-critical - 1e-3f, 1.5f, &c) < 0.9f && c > 0);
    // A metal without absorption is a dielectric.
    for (float x = 0.05f; x <= 1; x += 0.05f)
        assert_near((double)sheen_fresnel_conductor(x, 1.5f, 0), (double)sheen_fresnel_dielectric(x, 1.5f, &c), 1e-6);
    // At normal incidence ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2).
    assert_near((double)sheen_fresnel_conductor(1, 0.2f, 3.9f), (0.64 + 15.21) / (1.44 + 15.21), 1e-6);
}

// The same light, reversed, is reflected in the same share, and Snell's law holds.
static void test_fresnel_both_ways(void **state)
{
    (void)state;
    for (float eta = 0.5f; eta < 3; eta += 0.21f)
        for (float x = 0.03f; x <= 1; x += 0.03f) {
            float c, back, f = sheen_fresnel_dielectric(x, eta, &c);
            if (c == 0) continue;
            assert_near(sqrt(1 - (double)x * (double)x), (double)eta * sqrt(fmax(0, 1 - (double)c * (double)c)), 1e-5);
            // Near the critical angle the reflectance falls without bound: rounding of the cosine shows.
            assert_near((double)sheen_fresnel_dielectric(c, eta, &back), (double)f, 1e-4);
            assert_near((double)back, (double)x, 2e-5);
        }
}

static void test_fresnel_of_nonsense_is_finite(void **state)
{
    (void)state;
    const float values[] = {0, -1, 1e-30f, 1e30f, INFINITY, NAN, 1};
    for (size_t i = 0; i < 7; ++i)
        for (size_t j = 0; j < 7; ++j) {
            float c, f = sheen_fresnel_dielectric(values[j], values[i], &c),
                     g = sheen_fresnel_conductor(0.5f, values[i], values[j]);
            if (!isnan(values[j])) assert_true(f >= 0 && f <= 1);
            assert_true(g >= 0 && g <= 1);
        }
}

// ---- textures ---------------------------------------------------------------------------------------------------

static void test_reflectances_stay_within_one(void **state)
{
    (void)state;
    SheenMaterial m = material(SHEEN_MATERIAL_DIFFUSE);
    m.reflectance = sheen_texture_constant(rgb(-1, 2, NAN));
    SheenShape shape = {0};
    SheenScene scene = {.materials = &m, .shapes = &shape};
    SurfacePoint point = {.ns = {0, 0, 1}, .ng = {0, 0, 1}, .instance = SHEEN_NONE};
    Bsdf b = sheen_bsdf_at(&scene, &point);
    Rgb c = sheen_bsdf_albedo(&b, v3(0, 0, 1));
    assert_true(c.r == 0 && c.g == 1 && c.b == 0);
    m.kind = SHEEN_MATERIAL_DIELECTRIC;
    m.ior = 1.5f;
    m.specular_reflectance = sheen_texture_constant(rgb(0.5f, -2, 3));
    m.specular_transmittance = sheen_texture_constant(rgb(0.5f, 0.5f, NAN));
    b = sheen_bsdf_at(&scene, &point);
    c = sheen_bsdf_albedo(&b, v3(0, 0, 1)); // the interface reflects 0.04
    assert_near((double)c.r, 0.5, 1e-6);
    assert_near((double)c.g, 0.48, 1e-6);
    assert_near((double)c.b, 0.04, 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_diffuse_samples_follow_the_density),
        cmocka_unit_test(test_diffuse_sides),
        cmocka_unit_test(test_diffuse_is_reciprocal),
        cmocka_unit_test(test_albedo_is_the_mean_weight),
        cmocka_unit_test(test_glass_loses_nothing),
        cmocka_unit_test(test_dielectric_as_mitsuba),
        cmocka_unit_test(test_dielectric_samples_choose_by_energy),
        cmocka_unit_test(test_index_one_is_not_there),
        cmocka_unit_test(test_pane_as_mitsuba),
        cmocka_unit_test(test_conductor_as_mitsuba),
        cmocka_unit_test(test_fresnel_known_values),
        cmocka_unit_test(test_fresnel_both_ways),
        cmocka_unit_test(test_fresnel_of_nonsense_is_finite),
        cmocka_unit_test(test_reflectances_stay_within_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
