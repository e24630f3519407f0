// SPDX-License-Identifier: Apache-2.0
// Glossy lobes in harmonics: what the tables give is the lobe, to the error that was asked for.
#include "io/mitsuba.h"
#include "material/lobe_table.h"
#include "math/warp.h"
#include "unit/light_scene.h"

#include <stdio.h>

#define GOLD "<string name='material' value='Au'/>"
#define GGX "<string name='distribution' value='ggx'/>"
#define F(name, value) "<float name='" #name "' value='" #value "'/>"
#define RGB(name, value) "<rgb name='" #name "' value='" #value "'/>"
#define LOBE(i, x, y, z, n) "<vector name='lobe_" #i "' value='" #x " " #y " " #z "'/>" F(exponent_##i, n)
#define BSDF(type, inside) "<bsdf type='" type "'>" inside "</bsdf>"
#define BASE RGB(base_color, 0.8 0.4 0.2)

static void log_line(void *user, SheenLogLevel level, const char *text)
{
    (void)user;
    bool expected = strstr(text, "no light") || strstr(text, "no camera");
    if (level != SHEEN_LOG_INFO && !expected) fail_msg("%s", text);
}

/** A square of the material, and its tables. */
typedef struct Fixture {
    SheenScene *scene;
    SheenLobeTables *tables;
    unsigned order;
} Fixture;

static Fixture fixture_on(unsigned n_threads, const char *bsdf, unsigned order, float error)
{
    char text[4096];
    const SheenLog log = {log_line, NULL};
    Fixture f = {0};
    SheenPool *pool;
    int n = snprintf(text, sizeof text, "<scene version='3.0.0'><shape type='rectangle'>%s</shape></scene>", bsdf);
    assert_int_equal(sheen_mitsuba_parse(text, (size_t)n, "test", false, &log, &f.scene), SHEEN_OK);
    assert_int_equal(sheen_pool_create(n_threads, &pool), SHEEN_OK);
    const SheenLobeTableDesc desc = {.order = order, .error = error};
    assert_int_equal(sheen_lobe_tables_create(&log, f.scene, &desc, pool, NULL, &f.tables), SHEEN_OK);
    sheen_pool_destroy(&pool);
    f.order = sheen_lobe_tables_order(f.tables);
    return f;
}

static Fixture fixture(const char *bsdf, unsigned order, float error)
{
    return fixture_on(2, bsdf, order, error);
}

static void destroy(Fixture *f)
{
    sheen_lobe_tables_destroy(&f->tables);
    assert_null(f->tables);
    sheen_scene_destroy(&f->scene);
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

// ---- the lobe and what is read of it ----------------------------------------------------------------------------

enum { ROWS = 72, COLUMNS = 96, N_DIRECTIONS = 20 };

/** The part of the lobes that a reading says it holds, by evaluation: the whole less the rest. */
static Rgb held(const Bsdf *whole, const Bsdf *rest, Vec3 wo, Vec3 wi)
{
    return rgb_sub(sheen_bsdf_eval_of(whole, SHEEN_BSDF_GLOSSY, wo, wi),
                   sheen_bsdf_eval_of(rest, SHEEN_BSDF_GLOSSY, wo, wi));
}

static double square(Rgb c)
{
    return (double)(c.r * c.r + c.g * c.g + c.b * c.b);
}

/** @return the relative energy of the difference between the lobes and what was read. */
static double measure(const Fixture *f, SheenBasis basis, const Bsdf *bsdf, Vec3 wo, LobeReading *reading)
{
    static Rgb c[SHEEN_BASIS_MAX];
    static float y[SHEEN_BASIS_MAX];
    sheen_lobe_table_read(f->tables, basis, bsdf, wo, c, reading);
    Bsdf rest = *bsdf;
    sheen_bsdf_leave_rest(&rest, reading);
    double energy = 0, missing = 0;
    float side = wo.z < 0 ? -1 : 1;
    for (int i = 0; i < ROWS; ++i)
        for (int k = 0; k < COLUMNS; ++k) {
            float s = ((float)i + 0.5f) / ROWS, z = s * s;
            Vec3 wi = direction(acosf(z), 2 * SHEEN_PI * ((float)k + 0.5f) / COLUMNS);
            sheen_basis_eval(basis, reading->order, basis == SHEEN_BASIS_HSH ? wi : v3(wi.x, wi.y, wi.z * side), y);
            Rgb sum = rgb_gray(0), want = held(bsdf, &rest, wo, v3(wi.x, wi.y, wi.z * side));
            for (size_t j = 0; j < basis_size(reading->order); ++j) sum = rgb_mad(sum, y[j], c[j]);
            energy += (double)s * square(want);
            missing += (double)s * square(rgb_sub(want, sum));
            // The sphere's harmonics should be zero below the surface; what they are there is missing too.
            if (basis == SHEEN_BASIS_HSH) continue;
            sheen_basis_eval(basis, reading->order, v3(wi.x, wi.y, -wi.z * side), y);
            sum = rgb_gray(0);
            for (size_t j = 0; j < basis_size(reading->order); ++j) sum = rgb_mad(sum, y[j], c[j]);
            missing += (double)s * square(sum);
        }
    return energy > 0 ? missing / energy : 0;
}

typedef struct Case {
    const char *name, *xml;
    unsigned order;
} Case;

#define TWO_TONES                                                                                                      \
    "<texture type='checkerboard' name='roughness'><float name='color0' value='0.5'/>"                                 \
    "<float name='color1' value='1'/></texture>"

static const Case cases[] = {
    {"phong", BSDF("phong", F(exponent, 15)), 0},
    {"phong, order 16", BSDF("phong", F(exponent, 60)), 16},
    {"ward", BSDF("ward", F(alpha, 0.3)), 0},
    {"ward, duer", BSDF("ward", F(alpha, 0.4) "<string name='variant' value='ward-duer'/>"), 0},
    {"ward, original", BSDF("ward", F(alpha, 0.4) "<string name='variant' value='ward'/>"), 0},
    {"ward x y", BSDF("ward", F(alpha_u, 0.6) F(alpha_v, 0.25)), 0},
    {"lafortune", BSDF("lafortune", LOBE(1, -0.9, -0.9, 0.8, 16) RGB(weight_1, 0.3 0.2 0.1) LOBE(2, 0.7, 0.7, 0.6, 5)),
     0},
    {"lafortune x y", BSDF("lafortune", LOBE(1, -0.95, -0.5, 0.9, 20)), 0},
    {"gold, ggx", BSDF("roughconductor", GOLD GGX F(alpha, 0.4)), 0},
    {"gold, beckmann", BSDF("roughconductor", GOLD F(alpha, 0.3)), 0},
    {"gold x y", BSDF("roughconductor", GOLD F(alpha_u, 0.7) F(alpha_v, 0.35)), 0},
    {"plastic", BSDF("roughplastic", F(alpha, 0.3)), 0},
    {"twosided", BSDF("twosided", BSDF("roughconductor", GOLD GGX F(alpha, 0.5))), 0},
    {"twosided x y", BSDF("twosided", BSDF("ward", F(alpha_u, 0.35) F(alpha_v, 0.6))), 0},
    {"two faces", BSDF("twosided", BSDF("phong", F(exponent, 9)) BSDF("ward", F(alpha_u, 0.35) F(alpha_v, 0.6))), 0},
    {"principled", BSDF("principled", BASE F(roughness, 0.6) F(metallic, 0.3) F(spec_tint, 0.5)), 0},
    {"principled metal", BSDF("principled", BASE F(roughness, 0.7) F(metallic, 1)), 0},
    {"brushed", BSDF("principled", BASE F(metallic, 1) F(anisotropic, 0.6) F(roughness, 0.7)), 0},
    {"blend", BSDF("blendbsdf", F(weight, 0.3) BSDF("phong", F(exponent, 10)) BSDF("roughplastic", F(alpha, 0.4))), 0},
    {"checks", BSDF("principled", BASE F(metallic, 1) TWO_TONES), 0},
};
enum { N_CASES = sizeof cases / sizeof *cases };

// The error that is allowed, and the interpolation between nodes: at most 0.005 where lobes change fastest, at grazing.
#define ERROR_BOUND 0.055

static void test_what_is_read_is_the_lobe(void **state)
{
    (void)state;
    for (int i = 0; i < N_CASES; ++i) {
        Fixture f = fixture(cases[i].xml, cases[i].order, 0);
        Bsdf b = bsdf_at(f.scene, v2(0.3f, 0.6f));
        assert_true(sheen_lobe_tables_has(f.tables, f.scene->shapes[0].material));
        for (int basis = 0; basis < 2; ++basis) {
            Random r = {31, 0};
            int n_read = 0;
            for (int k = 0; k < N_DIRECTIONS; ++k) {
                Vec3 wo = direction(acosf(1 - random_1d(&r)), 2 * SHEEN_PI * random_1d(&r));
                if (k & 1) wo.z = -wo.z;
                LobeReading reading;
                double error = measure(&f, (SheenBasis)basis, &b, wo, &reading);
                n_read += reading.order > 0;
                if (!(error <= ERROR_BOUND)) fail_msg("%s, basis %d: error %g", cases[i].name, basis, error);
                assert_true(reading.order <= f.order && f.order <= (cases[i].order ? cases[i].order : 10));
                for (uint32_t j = 0; j < SHEEN_BSDF_MAX_LOBES; ++j)
                    assert_true(reading.share[j] >= 0 && reading.share[j] <= 1);
            }
            if (n_read < N_DIRECTIONS / 5) fail_msg("%s, basis %d: read %d times", cases[i].name, basis, n_read);
        }
        destroy(&f);
    }
}

/** The light reflected from smooth surroundings, by the dot product and by quadrature. */
static void test_smooth_light_is_reflected(void **state)
{
    (void)state;
    for (int i = 0; i < N_CASES; i += 3) {
        static Rgb c[SHEEN_BASIS_MAX];
        static float y[SHEEN_BASIS_MAX];
        Fixture f = fixture(cases[i].xml, cases[i].order, 0);
        Bsdf b = bsdf_at(f.scene, v2(0.3f, 0.6f));
        Random r = {3, 0};
        for (int k = 0; k < 6; ++k) {
            Vec3 wo = direction(acosf(0.1f + 0.9f * random_1d(&r)), 2 * SHEEN_PI * random_1d(&r));
            LobeReading reading;
            sheen_lobe_table_read(f.tables, SHEEN_BASIS_HSH, &b, wo, c, &reading);
            Bsdf rest = b;
            sheen_bsdf_leave_rest(&rest, &reading);
            double got = 0, want = 0, most = 0;
            for (int a = 0; a < ROWS * COLUMNS; ++a) {
                float s = ((float)(a / COLUMNS) + 0.5f) / ROWS;
                Vec3 wi = direction(acosf(s * s), 2 * SHEEN_PI * ((float)(a % COLUMNS) + 0.5f) / COLUMNS);
                double L = (1 + 0.6 * (double)wi.x + 0.3 * (double)(wi.y * wi.z)) * (double)s;
                sheen_basis_eval(SHEEN_BASIS_HSH, reading.order, wi, y);
                for (size_t j = 0; j < basis_size(reading.order); ++j) got += L * (double)(y[j] * c[j].g);
                want += L * (double)held(&b, &rest, wo, wi).g;
                most += 1.9 * (double)held(&b, &rest, wo, wi).g * (double)s;
            }
            // By Cauchy and Schwarz the square root of the error, 22 %, is the most; smooth light is far from it.
            if (!(fabs(got - want) <= 0.015 * most)) fail_msg("%s: %g, want %g", cases[i].name, got, want);
        }
        destroy(&f);
    }
}

// ---- orders -----------------------------------------------------------------------------------------------------

/** Smallest orders for a missing energy of 5 %, a tenth of what is allowed, computed apart in double precision: tables
 *  of another program. */
static void test_orders_of_phong(void **state)
{
    (void)state;
    static const struct {
        const char *xml;
        unsigned at[3]; // seen from 0, 45 and 75 degrees
    } lobes[] = {{BSDF("phong", F(exponent, 7)), {4, 4, 5}},
                 {BSDF("phong", F(exponent, 15)), {5, 6, 6}},
                 {BSDF("phong", F(exponent, 22)), {6, 7, 8}},
                 {BSDF("phong", F(exponent, 50)), {9, 9, 11}}};
    static Rgb c[SHEEN_BASIS_MAX];
    for (int i = 0; i < 4; ++i) {
        Fixture f = fixture(lobes[i].xml, 14, 0.5f);
        Bsdf b = bsdf_at(f.scene, v2(0, 0));
        for (int k = 0; k < 3; ++k) {
            const float degrees[] = {0, 45, 75};
            LobeReading reading;
            sheen_lobe_table_read(f.tables, SHEEN_BASIS_HSH, &b, direction(degrees[k] * SHEEN_PI / 180, 1), c,
                                  &reading);
            assert_int_equal(reading.order, lobes[i].at[k]);
            assert_true(reading.share[0] == 0 && reading.share[1] == 1); // the diffuse part is not glossy
            assert_true(reading.error <= 0.05f && reading.error > 0.01f);
        }
        destroy(&f);
    }
}

/** A stricter error takes higher orders, and keeps to a tenth of it. */
static void test_stricter_errors(void **state)
{
    (void)state;
    const float errors[] = {0.2f, 0.02f, 0.002f, 0.00005f};
    unsigned before = 0;
    for (int i = 0; i < 4; ++i) {
        Fixture f = fixture(BSDF("phong", F(exponent, 12)), 20, errors[i]);
        Bsdf b = bsdf_at(f.scene, v2(0, 0));
        LobeReading reading;
        for (int k = 0; k < 2; ++k) { // from near the normal, where a table ends and is mirrored, as well
            double error = measure(&f, SHEEN_BASIS_HSH, &b, direction(k ? 0.018f : 0.6f, 2), &reading);
            double share = reading.order < 20 ? 0.1 : 1.0; // of what is allowed, where the orders suffice
            assert_true(error <= share * (double)errors[i] * 1.02 && reading.order > before && reading.share[1] == 1);
        }
        before = reading.order;
        destroy(&f);
    }
}

// ---- no boundaries ----------------------------------------------------------------------------------------------

/** From step to step of the view nothing jumps: not where the order changes, nor where the share ends. */
static void test_readings_are_continuous(void **state)
{
    (void)state;
    enum { STEPS = 4000 };
    static Rgb c[2][SHEEN_BASIS_MAX];
    for (int i = 0; i < N_CASES; ++i) {
        Fixture f = fixture(cases[i].xml, cases[i].order, 0);
        Bsdf b = bsdf_at(f.scene, v2(0.3f, 0.6f));
        LobeReading reading[2];
        double most = 0, energy = 0;
        for (int k = 0; k <= STEPS; ++k) {
            float t = (float)k / STEPS;
            sheen_lobe_table_read(f.tables, (SheenBasis)(i & 1), &b, direction(0.5f * SHEEN_PI * t, 9 * t), c[k & 1],
                                  &reading[k & 1]);
            if (k == 0) continue;
            double d2 = 0, e2 = 0;
            for (size_t j = 0; j < basis_size(f.order); ++j)
                d2 += square(rgb_sub(c[0][j], c[1][j])), e2 += square(c[k & 1][j]);
            energy = fmax(energy, e2);
            most = fmax(most, d2);
            for (int j = 0; j < SHEEN_BSDF_MAX_LOBES; ++j)
                assert_true(fabsf(reading[0].share[j] - reading[1].share[j]) <= 0.05f);
        }
        // A step of 0.0025 radians, of lobes of order 10 whose shares change within some degrees.
        if (!(sqrt(most / energy) <= 0.05)) fail_msg("%s: a step of %g", cases[i].name, sqrt(most / energy));
        destroy(&f);
    }
}

/** Roughness between the levels of a textured one, against the lobe of that roughness. */
static void test_roughness_between_levels(void **state)
{
    (void)state;
    Fixture f = fixture(BSDF("principled",
                             BASE F(metallic, 1) "<texture type='checkerboard' name='roughness'>"
                                                 "<float name='color0' value='0.1'/><float name='color1' value='1'/>"
                                                 "</texture>"),
                        0, 0);
    Bsdf b = bsdf_at(f.scene, v2(0.3f, 0.6f));
    assert_int_equal(b.n_lobes, 2);
    int n_read = 0;
    for (float alpha = 0.011f; alpha <= 1; alpha *= 1.09f) {
        b.lobes[1].microfacet.alpha_u = b.lobes[1].microfacet.alpha_v = alpha;
        for (int k = 0; k < 3; ++k) {
            LobeReading reading;
            double error = measure(&f, SHEEN_BASIS_HSH, &b, direction(0.35f * (float)k, 2), &reading);
            assert_true(reading.share[1] == 0 || alpha > 0.1f);
            if (!(error <= ERROR_BOUND)) fail_msg("alpha %g: error %g", (double)alpha, error);
            n_read += reading.share[1] == 1;
        }
    }
    assert_true(n_read > 20);
    destroy(&f);
}

/** The same bytes from any number of threads. */
static void test_threads_do_not_matter(void **state)
{
    (void)state;
    static Rgb c[3][100];
    for (unsigned n = 1; n <= 3; ++n) {
        Fixture f = fixture_on(n, BSDF("ward", F(alpha_u, 0.6) F(alpha_v, 0.25)), 10, 0);
        Bsdf b = bsdf_at(f.scene, v2(0, 0));
        LobeReading reading;
        sheen_lobe_table_read(f.tables, SHEEN_BASIS_SH, &b, direction(0.4f, 2), c[n - 1], &reading);
        assert_true(reading.order > 2);
        destroy(&f);
    }
    assert_memory_equal(c[0], c[1], sizeof c[0]);
    assert_memory_equal(c[0], c[2], sizeof c[0]);
}

/** What is held and what is left are the whole, also where the share is between. */
static void test_shares_leave_the_rest(void **state)
{
    (void)state;
    Fixture f = fixture(BSDF("phong", F(exponent, 60)), 10, 0);
    Bsdf whole = bsdf_at(f.scene, v2(0, 0));
    Rgb c[100];
    int between = 0;
    for (float theta = 0.01f; theta < 1.5f; theta += 0.01f) {
        LobeReading reading;
        Vec3 wo = direction(theta, 1), wi = direction(theta, 1 + SHEEN_PI);
        sheen_lobe_table_read(f.tables, SHEEN_BASIS_HSH, &whole, wo, c, &reading);
        Bsdf rest = whole;
        sheen_bsdf_leave_rest(&rest, &reading);
        float all = sheen_bsdf_eval_of(&whole, SHEEN_BSDF_GLOSSY, wo, wi).g;
        float left = sheen_bsdf_eval_of(&rest, SHEEN_BSDF_GLOSSY, wo, wi).g;
        assert_true(fabsf(left - (1 - reading.share[1]) * all) <= 1e-5f * all);
        between += reading.share[1] > 0 && reading.share[1] < 1;
    }
    assert_true(between > 10);
    destroy(&f);
}

// ---- what is not represented ------------------------------------------------------------------------------------

static void test_what_is_not_represented(void **state)
{
    (void)state;
    static const char *const xml[] = {
        BSDF("diffuse", ""),
        BSDF("roughconductor", GOLD GGX F(alpha, 0.05)),
        BSDF("roughconductor", GOLD F(alpha, 0.0001)),
        BSDF("ward", F(alpha_u, 0.5) F(alpha_v, 0.02)),
        BSDF("roughdielectric", F(alpha, 0.5)),
        BSDF("principled", BASE F(roughness, 0.8) F(spec_trans, 0.5)),
        BSDF("phong", F(exponent, 100000)),
        BSDF("coating", BSDF("phong", F(exponent, 9))),
    };
    Rgb c[100];
    LobeReading reading;
    for (size_t i = 0; i < sizeof xml / sizeof *xml; ++i) {
        Fixture f = fixture(xml[i], 0, 0);
        Bsdf b = bsdf_at(f.scene, v2(0, 0));
        assert_int_equal(f.order, 0);
        assert_false(sheen_lobe_tables_has(f.tables, f.scene->shapes[0].material));
        sheen_lobe_table_read(f.tables, SHEEN_BASIS_SH, &b, v3(0.6f, 0, 0.8f), c, &reading);
        assert_int_equal(reading.order, 0);
        destroy(&f);
    }
    Fixture f = fixture(BSDF("phong", ""), 0, 0);
    Bsdf b = bsdf_at(f.scene, v2(0, 0));
    sheen_lobe_table_read(NULL, SHEEN_BASIS_HSH, &b, v3(0.6f, 0, 0.8f), c, &reading);
    assert_true(reading.order == 0 && reading.share[1] == 0);
    assert_int_equal(sheen_lobe_tables_order(NULL), 0);
    assert_false(sheen_lobe_tables_has(NULL, 0));
    for (int i = 0; i < 3; ++i) { // from behind, along the surface, from nowhere
        sheen_lobe_table_read(f.tables, SHEEN_BASIS_HSH, &b, v3(i == 2 ? NAN : 1, 0, i == 0 ? -0.5f : 0), c, &reading);
        assert_true(reading.order == 0 && reading.share[1] == 0);
    }
    destroy(&f);
}

static void test_memory_is_bounded(void **state)
{
    (void)state;
    Fixture f = fixture(BSDF("blendbsdf", BSDF("phong", F(exponent, 9)) BSDF("phong", F(exponent, 8))), 0, 0);
    Bsdf b = bsdf_at(f.scene, v2(0, 0));
    SheenPool *pool;
    assert_int_equal(b.n_lobes, 4);
    assert_int_equal(sheen_pool_create(1, &pool), SHEEN_OK);
    // For none of the two tables, one, both: 27 directions of 66 numbers in two bases are 14,256 bytes.
    const size_t memory[] = {14255, 14256, 28512};
    for (int room = 0; room < 3; ++room) {
        Rgb c[100];
        LobeReading reading;
        SheenLobeTables *tables;
        const SheenLobeTableDesc desc = {.memory = memory[room]};
        assert_int_equal(sheen_lobe_tables_create(NULL, f.scene, &desc, pool, NULL, &tables), SHEEN_OK);
        sheen_lobe_table_read(tables, SHEEN_BASIS_HSH, &b, v3(0, 0, 1), c, &reading);
        assert_int_equal((reading.share[1] > 0) + (reading.share[3] > 0), room);
        assert_int_equal(sheen_lobe_tables_order(tables) > 0, room > 0);
        sheen_lobe_tables_destroy(&tables);
    }
    sheen_pool_destroy(&pool);
    destroy(&f);
}

static void test_numbers_out_of_range(void **state)
{
    (void)state;
    Fixture f = fixture(BSDF("phong", ""), 0, 0);
    SheenPool *pool;
    SheenLobeTables *tables;
    atomic_bool cancel = true;
    const SheenLobeTableDesc bad[] = {{.order = 33}, {.error = 0.51f}, {.error = -0.1f}, {.error = NAN}}, good = {0};
    assert_int_equal(sheen_pool_create(1, &pool), SHEEN_OK);
    for (int i = 0; i < 4; ++i)
        assert_int_equal(sheen_lobe_tables_create(NULL, f.scene, &bad[i], pool, NULL, &tables), SHEEN_ERR_INVALID);
    assert_int_equal(sheen_lobe_tables_create(NULL, f.scene, &good, pool, &cancel, &tables), SHEEN_ERR_CANCELLED);
    assert_null(tables);
    sheen_pool_destroy(&pool);
    destroy(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_read_is_the_lobe), cmocka_unit_test(test_smooth_light_is_reflected),
        cmocka_unit_test(test_orders_of_phong),          cmocka_unit_test(test_stricter_errors),
        cmocka_unit_test(test_readings_are_continuous),  cmocka_unit_test(test_roughness_between_levels),
        cmocka_unit_test(test_what_is_not_represented),  cmocka_unit_test(test_numbers_out_of_range),
        cmocka_unit_test(test_memory_is_bounded),        cmocka_unit_test(test_threads_do_not_matter),
        cmocka_unit_test(test_shares_leave_the_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
