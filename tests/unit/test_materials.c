// SPDX-License-Identifier: Apache-2.0
// Every material of Mitsuba scenes: samples against densities, weights, energy, reciprocity, and its parts apart.
#include "io/mitsuba.h"
#include "material/bsdf.h"
#include "math/warp.h"
#include "unit/chi_squared.h"
#include "unit/light_scene.h"

#include <stdio.h>

#define GOLD "<string name='material' value='Au'/>"
#define GGX "<string name='distribution' value='ggx'/>"
#define F(name, value) "<float name='" #name "' value='" #value "'/>"
#define RGB(name, value) "<rgb name='" #name "' value='" #value "'/>"
#define BSDF(type, inside) "<bsdf type='" type "'>" inside "</bsdf>"
#define DIFFUSE BSDF("diffuse", RGB(reflectance, 0.2 0.5 0.8))
#define LOBE(i, x, y, z, n) "<vector name='lobe_" #i "' value='" #x " " #y " " #z "'/>" F(exponent_##i, n)
#define BASE RGB(base_color, 0.8 0.4 0.2)

typedef struct Case {
    const char *name, *xml;
    float ior;       // where light goes through, what its radiance is scaled by; else 1
    bool conserving; // energy is not made
    bool reciprocal;
} Case;

static const Case cases[] = {
    {"diffuse", DIFFUSE, 1, true, true},
    {"twosided", BSDF("twosided", DIFFUSE), 1, true, true},
    {"clay", BSDF("roughdiffuse", RGB(reflectance, 0.2 0.9 0.8) F(alpha, 0.5)), 1, false, true},
    {"clay, fast",
     BSDF("roughdiffuse",
          RGB(diffuse_reflectance, 0.2 0.9 0.8) F(alpha, 0.7) "<boolean name='useFastApprox' value='true'/>"),
     1, false, true},
    {"sides", BSDF("twosided", DIFFUSE BSDF("roughconductor", GOLD F(alpha, 0.4))), 1, true, true},
    {"difftrans", BSDF("difftrans", RGB(transmittance, 0.3 0.6 0.9)), 1, true, true},
    {"beckmann", BSDF("roughconductor", GOLD F(alpha, 0.15)), 1, true, true},
    {"ggx", BSDF("roughconductor", GOLD GGX F(alpha, 0.15)), 1, true, true},
    {"ggx, smooth", BSDF("roughconductor", GOLD GGX F(alpha, 0.1)), 1, true, true},
    {"ggx, rough", BSDF("roughconductor", GOLD GGX F(alpha, 0.9)), 1, true, true},
    {"beckmann, rough", BSDF("roughconductor", GOLD F(alpha, 0.9)), 1, true, true},
    {"ggx u v", BSDF("roughconductor", GOLD GGX F(alpha_u, 0.1) F(alpha_v, 0.6)), 1, true, true},
    {"beckmann u v", BSDF("roughconductor", GOLD F(alpha_u, 0.6) F(alpha_v, 0.15)), 1, true, true},
    {"glass, ggx", BSDF("roughdielectric", GGX F(alpha, 0.3) F(int_ior, 1.5) F(ext_ior, 1)), 1.5f, true, true},
    {"glass, beckmann", BSDF("roughdielectric", F(alpha, 0.2) F(int_ior, 1.5) F(ext_ior, 1)), 1.5f, true, true},
    {"glass, thinner inside", BSDF("roughdielectric", GGX F(alpha, 0.2) F(int_ior, 1) F(ext_ior, 1.5)), 1 / 1.5f, true,
     true},
    {"plastic", BSDF("plastic", RGB(diffuse_reflectance, 0.9 0.5 0.1)), 1, true, true},
    {"roughplastic", BSDF("roughplastic", F(alpha, 0.2) RGB(diffuse_reflectance, 0.9 0.5 0.1)), 1, true, true},
    {"phong", BSDF("phong", F(exponent, 40) RGB(diffuse_reflectance, 0.5) RGB(specular_reflectance, 0.4)), 1, true,
     true},
    {"ward", BSDF("ward", F(alpha_u, 0.3) F(alpha_v, 0.15)), 1, true, true},
    {"ward, 1992", BSDF("ward", F(alpha, 0.2) "<string name='variant' value='ward'/>"), 1, true, true},
    {"ward, duer", BSDF("ward", F(alpha, 0.2) "<string name='variant' value='ward-duer'/>"), 1, true, true},
    {"ward, 1992, u v", BSDF("ward", F(alpha_u, 0.15) F(alpha_v, 0.3) "<string name='variant' value='ward'/>"), 1, true,
     true},
    {"lafortune",
     BSDF("lafortune", RGB(diffuse_reflectance, 0.2) LOBE(1, -0.9, -0.9, 0.8, 16) RGB(weight_1, 0.3 0.2 0.1)
                           LOBE(2, 0.7, 0.7, 0.6, 5) RGB(weight_2, 0.2 0.3 0.9)),
     1, true, true},
    {"lafortune x y", BSDF("lafortune", RGB(diffuse_reflectance, 0) LOBE(1, -0.95, -0.5, 0.9, 20)), 1, true, true},
    {"blend", BSDF("blendbsdf", F(weight, 0.3) DIFFUSE BSDF("plastic", "")), 1, true, true},
    {"mixture",
     BSDF("mixturebsdf",
          "<string name='weights' value='0.2 0.5 0.2'/>" DIFFUSE BSDF("phong", "") BSDF("roughconductor", GOLD)),
     1, true, true},
    {"mask", BSDF("mask", F(opacity, 0.4) BSDF("roughplastic", F(alpha, 0.3))), 1, true, true},
    {"coating", BSDF("coating", RGB(sigma_a, 0.1 0.2 0.3) BSDF("roughconductor", GOLD F(alpha, 0.3))), 1, true, true},
    {"coated, two sides", BSDF("twosided", BSDF("coating", BSDF("diffuse", ""))), 1, true, true},
    {"roughcoating", BSDF("roughcoating", F(alpha, 0.2) BSDF("roughconductor", F(alpha, 0.3))), 1, true, true},
    {"principled", BSDF("principled", BASE F(clearcoat, 0.8) F(metallic, 0.3) F(spec_tint, 0.5)), 1, true, true},
    {"cloth", BSDF("principled", BASE F(sheen, 0.7) F(sheen_tint, 0.5) F(flatness, 0.4)), 1, false, true},
    {"brushed", BSDF("principled", BASE F(metallic, 1) F(anisotropic, 0.9) F(roughness, 0.5)), 1, true, true},
    {"leaf", BSDF("principledthin", BASE F(sheen, 0.5) F(sheen_tint, 0.3) F(flatness, 0.5) F(diff_trans, 1.2)), 1,
     false, true},
    {"foil",
     BSDF("principledthin",
          BASE F(spec_trans, 0.8) F(spec_tint, 0.4) F(roughness, 0.6) F(anisotropic, 0.5) F(diff_trans, 0.6)),
     1, true, false},
    {"frosted", BSDF("principled", BASE F(spec_trans, 0.7) F(eta, 1.5) F(roughness, 0.5)), 1.5f, true, true},
};
enum { N_CASES = sizeof cases / sizeof *cases };

static void log_line(void *user, SheenLogLevel level, const char *text)
{
    (void)user;
    bool expected = strstr(text, "no light") || strstr(text, "no camera");
    if (level != SHEEN_LOG_INFO && !expected) fail_msg("%s", text);
}

/** A square of the material; free with sheen_scene_destroy. */
static SheenScene *scene_of(const char *bsdf)
{
    char text[4096];
    const SheenLog log = {log_line, NULL};
    SheenScene *scene = NULL;
    int n = snprintf(text, sizeof text, "<scene version='3.0.0'><shape type='rectangle'>%s</shape></scene>", bsdf);
    assert_int_equal(sheen_mitsuba_parse(text, (size_t)n, "test", false, &log, &scene), SHEEN_OK);
    return scene;
}

static Bsdf bsdf_at(const SheenScene *scene, Vec2 uv)
{
    SurfacePoint point = {.ns = {0, 0, 1}, .ng = {0, 0, 1}, .uv = uv, .instance = SHEEN_NONE};
    return sheen_bsdf_at(scene, &point);
}

static Vec3 direction(float theta, float phi)
{
    return v3(sinf(theta) * cosf(phi), sinf(theta) * sinf(phi), cosf(theta));
}

// From near the normal to grazing, from both sides.
static const Vec3 views[] = {{0.05f, 0.1f, 0.9937303f},
                             {0.5f, -0.6f, 0.6244998f},
                             {-0.9f, 0.4f, 0.1732051f},
                             {0.3f, 0.4f, -0.8660254f},
                             {0.7f, -0.6f, -0.3872983f}};
enum { N_VIEWS = sizeof views / sizeof *views };

// ---- a grid of directions ---------------------------------------------------------------------------------------

// Even steps of theta, finer than the narrowest lobe, and of phi; each bin is a few cells of the midpoint rule.
enum { BINS_THETA = 36, BINS_PHI = 24, SUB_THETA = 6, SUB_PHI = 9, BINS = BINS_THETA * BINS_PHI };

static int bin_of(Vec3 w)
{
    int t = (int)(acosf(clampf(w.z, -1, 1)) / SHEEN_PI * BINS_THETA);
    int p = (int)((atan2f(w.y, w.x) / (2 * SHEEN_PI) + 0.5f) * BINS_PHI);
    return (t < BINS_THETA ? t : BINS_THETA - 1) * BINS_PHI + (p < BINS_PHI ? p : BINS_PHI - 1);
}

typedef struct Integrals {
    double pdf[BINS]; // over each bin
    double pdf_sum;
    double light,
        diffuse; // green of f |cos|, without the factor that refraction puts on radiance; of the class diffuse
} Integrals;

static void integrate(const Bsdf *b, Vec3 wo, float ior, Integrals *out)
{
    memset(out, 0, sizeof *out);
    const bool has_diffuse = sheen_bsdf_classes(b) & SHEEN_BSDF_DIFFUSE;
    const int n_theta = BINS_THETA * SUB_THETA, n_phi = BINS_PHI * SUB_PHI;
    for (int i = 0; i < n_theta; ++i)
        for (int k = 0; k < n_phi; ++k) {
            float theta = ((float)i + 0.5f) * SHEEN_PI / (float)n_theta;
            float phi = (((float)k + 0.5f) / (float)n_phi - 0.5f) * 2 * SHEEN_PI;
            Vec3 wi = direction(theta, phi);
            double cell = (double)(sinf(theta) * SHEEN_PI / (float)n_theta * 2 * SHEEN_PI / (float)n_phi);
            double spread = wi.z * wo.z < 0 ? (double)sqrf(wo.z > 0 ? ior : 1 / ior) : 1;
            double pdf = (double)sheen_bsdf_pdf(b, wo, wi) * cell;
            out->pdf[i / SUB_THETA * BINS_PHI + k / SUB_PHI] += pdf;
            out->pdf_sum += pdf;
            out->light += (double)sheen_bsdf_eval(b, wo, wi).g * spread * cell;
            if (has_diffuse) out->diffuse += (double)sheen_bsdf_eval_of(b, SHEEN_BSDF_DIFFUSE, wo, wi).g * cell;
        }
}

static double delta_share(const Bsdf *b, Vec3 wo)
{
    BsdfSample s[SHEEN_BSDF_MAX_DELTA];
    double sum = 0;
    for (int n = sheen_bsdf_delta_lobes(b, wo, s), i = 0; i < n; ++i) sum += (double)s[i].weight.g;
    return sum;
}

static void assert_near(const char *what, const char *name, Vec3 wo, double got, double want, double tolerance)
{
    if (!(fabs(got - want) <= tolerance))
        fail_msg("%s: %s from cosine %g: %.6g, want %.6g +- %.2g", name, what, (double)wo.z, got, want, tolerance);
}

// ---- samples ----------------------------------------------------------------------------------------------------

static void check_samples(const Case *c, const Bsdf *b, Vec3 wo)
{
    enum { N = 40000 };
    static double observed[BINS + 1], expected[BINS + 1];
    static Integrals in;
    memset(observed, 0, sizeof observed);
    integrate(b, wo, c->ior, &in);
    Random r = {17, 0};
    Moments light = {0};
    for (int i = 0; i < N; ++i) {
        BsdfSample s;
        double green = 0;
        // A Beckmann lobe's sampling looks its numbers up by inversion: they are drawn stratified, as renderers do.
        Vec2 u = v2(((float)(i % 200) + random_1d(&r)) / 200, ((float)(i / 200) + random_1d(&r)) / 200);
        if (sheen_bsdf_sample(b, wo, random_1d(&r), u, &s)) {
            double spread = s.transmit ? (double)sqrf(wo.z > 0 ? c->ior : 1 / c->ior) : 1;
            green = (double)s.weight.g * spread;
            assert_true(s.transmit == (s.wi_l.z * wo.z < 0));
            assert_near("length", c->name, wo, (double)v3_length(s.wi_l), 1, 1e-5);
            if (s.delta) {
                observed[BINS] += 1;
            } else {
                observed[bin_of(s.wi_l)] += 1;
                // Rounding of directions, enlarged by the slope of a narrow lobe.
                double pdf = (double)sheen_bsdf_pdf(b, wo, s.wi_l), f = (double)sheen_bsdf_eval(b, wo, s.wi_l).g;
                assert_near("pdf", c->name, wo, (double)s.pdf, pdf, 2e-3 * pdf);
                assert_near("weight", c->name, wo, (double)(s.weight.g * s.pdf), f, 2e-3 * f + 1e-6);
            }
        } else {
            observed[BINS] += 1;
        }
        moments_add(&light, green);
    }
    for (int i = 0; i < BINS; ++i) expected[i] = in.pdf[i] * N;
    expected[BINS] = fmax(1 - in.pdf_sum, 0) * N; // absorbed, or delta
    double deviation = chi_squared_deviation(BINS + 1, observed, expected);
    if (!(deviation < CHI_SQUARED_LIMIT)) fail_msg("%s: chi^2 from cosine %g: %g", c->name, (double)wo.z, deviation);
    double whole = in.light + delta_share(b, wo) * (c->ior == 1 ? 1 : 0);
    // Five standard errors, and the grid's own error at the narrowest lobes.
    assert_near("light", c->name, wo, moments_mean(&light), whole, 5 * moments_error(&light) + 2e-3 * whole);
    assert_near("albedo", c->name, wo, (double)sheen_bsdf_albedo(b, wo).g, fmin(whole, 1), 0.02);
    assert_near("diffuse", c->name, wo, (double)sheen_bsdf_diffuse(b, wo, NULL).g, in.diffuse, 0.02);
    if (c->conserving) assert_true(whole <= 1.002);
    assert_true(in.pdf_sum <= 1.005);
}

static void test_samples_follow_the_density(void **state)
{
    (void)state;
    for (int i = 0; i < N_CASES; ++i) {
        SheenScene *scene = scene_of(cases[i].xml);
        Bsdf b = bsdf_at(scene, v2(0.3f, 0.6f));
        for (int k = 0; k < N_VIEWS; ++k) check_samples(&cases[i], &b, views[k]);
        sheen_scene_destroy(&scene);
    }
}

// ---- pairs of directions ----------------------------------------------------------------------------------------

static void test_reciprocity(void **state)
{
    (void)state;
    for (int i = 0; i < N_CASES; ++i) {
        if (!cases[i].reciprocal) continue;
        SheenScene *scene = scene_of(cases[i].xml);
        Bsdf b = bsdf_at(scene, v2(0.3f, 0.6f));
        Random r = {3, 0};
        for (int k = 0; k < 2000; ++k) {
            Vec3 x = warp_sphere(random_2d(&r)), y = warp_sphere(random_2d(&r));
            // Radiance over the squared index is what is scattered symmetrically.
            float at_x = x.z > 0 ? 1 : cases[i].ior, at_y = y.z > 0 ? 1 : cases[i].ior;
            double xy = (double)(sheen_bsdf_eval(&b, x, y).g * fabsf(x.z) * sqrf(at_y));
            double yx = (double)(sheen_bsdf_eval(&b, y, x).g * fabsf(y.z) * sqrf(at_x));
            // Of a side that is seen from there only.
            if (strcmp(cases[i].name, "sides") == 0 && x.z * y.z < 0) continue;
            assert_near("reciprocity", cases[i].name, x, xy, yx, 2e-4 * (xy + yx) + 1e-6);
        }
        sheen_scene_destroy(&scene);
    }
}

static void test_parts_make_the_whole(void **state)
{
    (void)state;
    for (int i = 0; i < N_CASES; ++i) {
        SheenScene *scene = scene_of(cases[i].xml);
        Bsdf b = bsdf_at(scene, v2(0.3f, 0.6f));
        Random r = {5, 0};
        for (int k = 0; k < 500; ++k) {
            Vec3 wo = warp_sphere(random_2d(&r)), wi = warp_sphere(random_2d(&r));
            float d = sheen_bsdf_eval_of(&b, SHEEN_BSDF_DIFFUSE, wo, wi).g;
            float g = sheen_bsdf_eval_of(&b, SHEEN_BSDF_GLOSSY, wo, wi).g, all = sheen_bsdf_eval(&b, wo, wi).g;
            assert_near("sum of parts", cases[i].name, wo, (double)(d + g), (double)all, 1e-5 * (double)all);
            assert_true(rgb_is_black(sheen_bsdf_eval_of(&b, SHEEN_BSDF_DELTA, wo, wi)));
            BsdfSample s;
            if (sheen_bsdf_sample_of(&b, SHEEN_BSDF_GLOSSY, wo, random_1d(&r), random_2d(&r), &s)) {
                double f = (double)sheen_bsdf_eval_of(&b, SHEEN_BSDF_GLOSSY, wo, s.wi_l).g;
                double pdf = (double)sheen_bsdf_pdf_of(&b, SHEEN_BSDF_GLOSSY, wo, s.wi_l);
                assert_true(!s.delta && pdf > 0);
                assert_near("glossy pdf", cases[i].name, wo, (double)s.pdf, pdf, 2e-3 * pdf);
                assert_near("glossy weight", cases[i].name, wo, (double)s.weight.g * pdf, f, 2e-3 * f + 1e-6);
            }
            if (sheen_bsdf_sample_of(&b, SHEEN_BSDF_DELTA, wo, random_1d(&r), random_2d(&r), &s)) assert_true(s.delta);
        }
        sheen_scene_destroy(&scene);
    }
}

// ---- rough diffuse surfaces -------------------------------------------------------------------------------------

/** Values of both fits in orennayar1994, computed apart from the angles themselves. */
static void test_rough_diffuse_follows_its_paper(void **state)
{
    (void)state;
    static const struct {
        float degrees_i, degrees_o, phi;
        double full, fast;
    } values[] = {{0, 0, 0, 0.23664532783832293, 0.21966880057518742},
                  {30, 60, 0, 0.2680705467482162, 0.25298030029209573},
                  {60, 30, 120, 0.2221019774876878, 0.21966880057518742},
                  {75, 70, 180, 0.15623114709799227, 0.21966880057518742},
                  {45, 45, 90, 0.2378019771340489, 0.21966880057518742}};
    SheenScene *scene[2] = {
        scene_of(BSDF("roughdiffuse", RGB(reflectance, 0.8) F(alpha, 0.5))),
        scene_of(BSDF("roughdiffuse",
                      RGB(reflectance, 0.8) F(alpha, 0.5) "<boolean name='use_fast_approx' value='true'/>"))};
    for (int i = 0; i < 2; ++i) {
        Bsdf b = bsdf_at(scene[i], v2(0, 0));
        for (size_t k = 0; k < sizeof values / sizeof *values; ++k) {
            const float degree = SHEEN_PI / 180;
            Vec3 wi = direction(values[k].degrees_i * degree, 1);
            Vec3 wo = direction(values[k].degrees_o * degree, 1 + values[k].phi * degree);
            assert_near("f", "clay", wo, (double)(sheen_bsdf_eval(&b, wo, wi).g / wi.z),
                        i ? values[k].fast : values[k].full, 2e-6);
        }
    }
    sheen_scene_destroy(&scene[0]);
    sheen_scene_destroy(&scene[1]);
}

/** Lafortune's lobe about the mirror direction is Phong's; each further one adds to it. */
static void test_lafortune_holds_phong(void **state)
{
    (void)state;
    SheenScene *phong = scene_of(BSDF("phong", F(exponent, 20) RGB(specular_reflectance, 0.3)));
    SheenScene *one = scene_of(BSDF("lafortune", LOBE(1, -1, -1, 1, 20) RGB(weight_1, 0.3)));
    SheenScene *three = scene_of(BSDF("lafortune", LOBE(1, -1, -1, 1, 20) RGB(weight_1, 0.05) LOBE(2, -1, -1, 1, 20)
                                                       RGB(weight_2, 0.2) LOBE(3, -1, -1, 1, 20) RGB(weight_3, 0.1)
                                                           RGB(specular_reflectance, 0.857142857)));
    Bsdf b[3] = {bsdf_at(phong, v2(0, 0)), bsdf_at(one, v2(0, 0)), bsdf_at(three, v2(0, 0))};
    assert_int_equal(b[2].n_lobes, 4);
    Random r = {9, 0};
    for (int i = 0; i < 500; ++i) {
        Vec3 wo = warp_sphere(random_2d(&r)), wi = warp_sphere(random_2d(&r));
        double want = (double)sheen_bsdf_eval(&b[0], wo, wi).g;
        for (int k = 1; k < 3; ++k) // a rounding of the cosine, to the power of 20
            assert_near("lafortune", "phong", wo, (double)sheen_bsdf_eval(&b[k], wo, wi).g, want, 1e-5 * want);
    }
    sheen_scene_destroy(&phong);
    sheen_scene_destroy(&one);
    sheen_scene_destroy(&three);
}

/** The quadrature of diffuse lobes against many directions, grazing views included. */
static void test_diffuse_albedos_are_exact(void **state)
{
    (void)state;
    static const char *const xml[] = {
        BSDF("roughdiffuse", RGB(reflectance, 0.9) F(alpha, 0.6)), BSDF("principled", BASE F(roughness, 0.9)),
        BSDF("principled", BASE F(roughness, 0.2) F(sheen, 1) F(sheen_tint, 1) F(flatness, 0.8)),
        BSDF("principledthin", BASE F(roughness, 0.7) F(sheen, 0.4) F(diff_trans, 0.5))};
    enum { N = 256 };
    for (size_t i = 0; i < sizeof xml / sizeof *xml; ++i) {
        SheenScene *scene = scene_of(xml[i]);
        Bsdf b = bsdf_at(scene, v2(0, 0));
        for (int k = 1; k <= 10; ++k) {
            Vec3 wo = direction(acosf(0.1f * (float)k), 0.3f);
            double sum = 0;
            for (int s = 0; s < N * N; ++s) {
                Vec3 wi = warp_cosine_hemisphere(
                    v2(((float)(s % N) + 0.5f) / (float)N, ((float)(s / N) + 0.5f) / (float)N)); // midpoint rule
                sum += (double)(sheen_bsdf_eval_of(&b, SHEEN_BSDF_DIFFUSE, wo, wi).g / wi.z * SHEEN_PI) / (N * N);
            }
            // The clay has a kink where both angles are equal; a flattened lobe has 1 / (cos + cos).
            assert_near("diffuse", xml[i], wo, (double)sheen_bsdf_diffuse(&b, wo, NULL).g, sum,
                        i % 2 == 0 ? 3e-3 : 6e-4);
        }
        sheen_scene_destroy(&scene);
    }
}

// ---- plastics ---------------------------------------------------------------------------------------------------

// On a white base nothing is lost: what the interface keeps inside comes out later.
static void test_white_plastic_is_white(void **state)
{
    (void)state;
    SheenScene *scene = scene_of(BSDF("plastic", RGB(diffuse_reflectance, 1) F(int_ior, 1.7)));
    Bsdf b = bsdf_at(scene, v2(0, 0));
    static Integrals in;
    for (int k = 0; k < 3; ++k) {
        integrate(&b, views[k], 1, &in);
        assert_near("white", "plastic", views[k], in.light + delta_share(&b, views[k]), 1, 2e-3);
        assert_near("albedo", "plastic", views[k], (double)sheen_bsdf_albedo(&b, views[k]).g, 1, 1e-4);
    }
    sheen_scene_destroy(&scene);
}

static void test_rough_plastic_becomes_smooth(void **state)
{
    (void)state;
    SheenScene *scene[2] = {scene_of(BSDF("plastic", RGB(diffuse_reflectance, 0.9))),
                            scene_of(BSDF("roughplastic", F(alpha, 0.003) RGB(diffuse_reflectance, 0.9)))};
    Bsdf smooth = bsdf_at(scene[0], v2(0, 0)), rough = bsdf_at(scene[1], v2(0, 0));
    Random r = {9, 0};
    for (int k = 0; k < 200; ++k) {
        Vec3 wo = warp_cosine_hemisphere(random_2d(&r)), wi = warp_cosine_hemisphere(random_2d(&r));
        if (wo.z < 0.05f || wi.z < 0.05f) continue; // linear interpolation of a steep table
        double a = (double)sheen_bsdf_eval_of(&smooth, SHEEN_BSDF_DIFFUSE, wo, wi).g;
        double c = (double)sheen_bsdf_eval_of(&rough, SHEEN_BSDF_DIFFUSE, wo, wi).g;
        assert_near("base", "roughplastic", wo, c, a, 0.006 * a);
    }
    sheen_scene_destroy(&scene[0]);
    sheen_scene_destroy(&scene[1]);
}

static void test_which_materials_may_be_delta(void **state)
{
    (void)state;
    static const struct {
        const char *xml;
        bool delta;
    } materials[] = {
        {DIFFUSE, false},
        {BSDF("plastic", ""), false},
        {BSDF("conductor", ""), true},
        {BSDF("dielectric", ""), true},
        {BSDF("mask", F(opacity, 0.8) DIFFUSE), false},
        {BSDF("mask", F(opacity, 0.8) BSDF("conductor", "")), true},
        {BSDF("coating", BSDF("mask", F(opacity, 0.8) DIFFUSE)), true},
        {BSDF("blendbsdf", F(weight, 0.7) BSDF("conductor", "") DIFFUSE), true},
        {BSDF("blendbsdf", F(weight, 0.7) BSDF("plastic", "") DIFFUSE), false},
        {BSDF("coating", DIFFUSE), false},
        {BSDF("phong", ""), false},
        {BSDF("difftrans", ""), false},
    };
    for (size_t i = 0; i < sizeof materials / sizeof *materials; ++i) {
        SheenScene *scene = scene_of(materials[i].xml);
        assert_int_equal(sheen_material_may_be_delta(scene, scene->shapes[0].material), materials[i].delta);
        sheen_scene_destroy(&scene);
    }
}

static void test_delta_lobes_of_mixtures(void **state)
{
    (void)state;
    BsdfSample s[SHEEN_BSDF_MAX_DELTA];
    SheenScene *scene =
        scene_of(BSDF("mask", F(opacity, 0.5) BSDF("blendbsdf", F(weight, 0.5) BSDF("conductor", "") BSDF(
                                                                    "dielectric", F(int_ior, 1.5) F(ext_ior, 1)))));
    Bsdf b = bsdf_at(scene, v2(0, 0));
    assert_true(sheen_bsdf_is_delta(&b));
    // Mirrors of metal and glass are one; refraction and the hole stand alone.
    assert_int_equal(sheen_bsdf_delta_lobes(&b, v3(0.6f, 0, 0.8f), s), 3);
    double mirror = 0.25 + 0.25 * 0.043894730508327484;
    assert_near("mirror", "mixture", s[0].wi_l, (double)s[0].weight.g, mirror, 1e-5);
    assert_near("refraction", "mixture", s[1].wi_l, (double)s[1].weight.g, 0.25 * 0.9561052918434143 / 2.25, 1e-5);
    assert_near("hole", "mixture", s[2].wi_l, (double)s[2].weight.g, 0.5, 1e-6);
    assert_true(!s[0].transmit && s[1].transmit && s[2].transmit && s[2].wi_l.x == -0.6f);
    sheen_scene_destroy(&scene);
}

// Grazing and perpendicular directions, ends of the random numbers: nothing that is not a number comes out.
static void test_extremes_stay_finite(void **state)
{
    (void)state;
    const Vec3 ends[] = {{0, 0, 1},
                         {0, 0, -1},
                         {1, 0, 0},
                         {0, -1, 0},
                         {1, 0, 1e-30f},
                         {-1, 0, 1e-7f},
                         {0, 1, -1e-7f},
                         {1e-20f, 0, 1},
                         {0.7071f, 0, 0.7071f},
                         {-0.7071f, 0, 0.7071f},
                         {0, 0.9999f, 0.0141f},
                         {0, -0.9999f, -0.0141f}};
    const float numbers[] = {0, 1e-7f, 0.5f, 0x1.fffffep-1f};
    enum { N_ENDS = sizeof ends / sizeof *ends };
    static const char *const more[] = {
        BSDF("roughconductor", GGX F(alpha, 0.0001)),
        BSDF("roughconductor", F(alpha, 10)),
        BSDF("roughdielectric", F(alpha, 0.0001)),
        BSDF("roughdielectric", F(int_ior, 1) F(ext_ior, 1)),
        BSDF("phong", F(exponent, 1000000)),
        BSDF("ward", F(alpha, 0.0001)),
        BSDF("lafortune", LOBE(1, -2, -2, 2, 1000000) LOBE(2, 0, 0, 0, 0) LOBE(3, 1, 0, 0, 3)),
        BSDF("roughdiffuse", F(alpha, 10) RGB(reflectance, 1)),
        BSDF("roughdiffuse", F(alpha, 0) "<boolean name='use_fast_approx' value='true'/>"),
        BSDF("principledthin", F(roughness, 0) F(spec_trans, 1) F(eta, 1)),
        BSDF("principledthin", F(roughness, 1) F(spec_trans, 0.5) F(eta, 0.2) F(diff_trans, 2)),
        BSDF("principled", F(roughness, 0) F(clearcoat, 1) F(clearcoat_gloss, 1)),
        BSDF("principled", F(roughness, 1) F(anisotropic, 1) F(spec_trans, 1) F(specular, 0)),
        BSDF("coating", F(int_ior, 1) F(ext_ior, 3) BSDF("diffuse", "")),
        BSDF("plastic", F(int_ior, 1) F(ext_ior, 9) RGB(diffuse_reflectance, 1))};
    const int n_more = sizeof more / sizeof *more;
    for (int i = 0; i < N_CASES + n_more; ++i) {
        SheenScene *scene = scene_of(i < N_CASES ? cases[i].xml : more[i - N_CASES]);
        Bsdf b = bsdf_at(scene, v2(NAN, INFINITY));
        for (int o = 0; o < N_ENDS; ++o) {
            assert_true(rgb_finite(sheen_bsdf_albedo(&b, ends[o])));
            for (int k = 0; k < N_ENDS; ++k) {
                Rgb f = sheen_bsdf_eval(&b, ends[o], ends[k]);
                float pdf = sheen_bsdf_pdf(&b, ends[o], ends[k]);
                if (!rgb_finite(f) || !(f.g >= 0) || !(pdf >= 0) || !isfinite(pdf))
                    fail_msg("%s: %d %d: %g, %g", scene->materials[0].name, o, k, (double)f.g, (double)pdf);
            }
            for (int k = 0; k < 64; ++k) {
                BsdfSample s;
                Vec2 u = v2(numbers[k & 3], numbers[k >> 2 & 3]);
                if (!sheen_bsdf_sample(&b, ends[o], numbers[k >> 4], u, &s)) continue;
                assert_true(v3_finite(s.wi_l) && rgb_finite(s.weight) && s.pdf > 0 && !isnan(s.pdf));
            }
        }
        sheen_scene_destroy(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_samples_follow_the_density),   cmocka_unit_test(test_reciprocity),
        cmocka_unit_test(test_parts_make_the_whole),         cmocka_unit_test(test_rough_diffuse_follows_its_paper),
        cmocka_unit_test(test_diffuse_albedos_are_exact),    cmocka_unit_test(test_white_plastic_is_white),
        cmocka_unit_test(test_rough_plastic_becomes_smooth), cmocka_unit_test(test_which_materials_may_be_delta),
        cmocka_unit_test(test_delta_lobes_of_mixtures),      cmocka_unit_test(test_extremes_stay_finite),
        cmocka_unit_test(test_lafortune_holds_phong),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
