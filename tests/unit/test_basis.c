// SPDX-License-Identifier: Apache-2.0
// Spherical and hemispherical harmonics: values, orthonormality, derivatives, sums over many directions.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "basis/legendre.h"
#include "unit/basis_kit.h"

#include <stdlib.h>
#include <string.h>

static const SheenBasis both[] = {SHEEN_BASIS_HSH, SHEEN_BASIS_SH};

static double max_double(double a, double b)
{
    return a > b ? a : b;
}

// ---- values -----------------------------------------------------------------------------------------------------

static void test_coefficients(void **state)
{
    (void)state;
    for (int l = 1; l < SHEEN_ORDER_MAX; ++l)
        for (int m = 0; m <= l; ++m) {
            size_t i = basis_zenith_index((unsigned)l, (unsigned)m);
            double a = m == l ? -sqrt((2 * m + 1) / (2.0 * m)) : sqrt((4.0 * l * l - 1) / (l * l - m * m)), b = 0.0;
            if (m < l - 1) b = a / sqrt((4.0 * (l - 1) * (l - 1) - 1) / ((l - 1) * (l - 1) - m * m));
            // Rounded once: half a unit of 24 bits.
            assert_true(fabs((double)sheen_legendre_a[i] / a - 1) <= 0x1p-24);
            assert_true(fabs((double)sheen_legendre_b[i] - b) <= 0x1p-24 * b);
        }
}

// Values of an independent implementation (Legendre functions of a numeric library), ten digits.
typedef struct Reference {
    double theta, phi;
    double hsh[16], hsh_by_theta[16], hsh_by_phi[16], sh[16], sh_by_theta[16];
    double hsh_9[5]; // l = 9, m = -9, -4, 0, 5, 9
} Reference;

static const Reference references[] = {
    {
        0.3,
        0.4,
        {0.3989422804, -0.1111659298, 0.6292643721, -0.2629321496, 0.09458661987, -0.2263701493, 0.6636833862,
         -0.5354157524, 0.09186390625, -0.05483868649, 0.2278983475, -0.3272057364, 0.5510784961, -0.7739143437,
         0.2213382026, -0.02132016092}, // HSH
        {0, -0.3505759476, -0.4084020098, -0.8291900912, 0.5965819553, -0.566969537, -1.440442579, -1.34100906,
         0.5794091055, -0.5188223903, 1.289503607, -0.472184983, -2.944507737, -1.116822508, 1.25238473,
         -0.2017075455}, // HSH_dtheta
        {0, -0.2629321496, 0, 0.1111659298, 0.1837278125, -0.5354157524, 0, 0.2263701493, -0.1891732397, -0.06396048275,
         0.4426764052, -0.7739143437, 0, 0.3272057364, -0.455796695, 0.1645160595}, // HSH_dphi
        {0.2820947918, -0.0562288603, 0.4667798083, -0.132993761, 0.03422314014, -0.1201159413, 0.5481516198,
         -0.2841009174, 0.03323801338, -0.01419318186, 0.08650181929, -0.1874219504, 0.5573443859, -0.4432945991,
         0.08401182988, -0.00551801913}, // SH
        {0, -0.1817726192, -0.1443919153, -0.4299326742, 0.2212682166, -0.3511459691, -0.5342504205, -0.8305383189,
         0.2148989226, -0.1376480953, 0.5325155831, -0.4573909151, -1.178907348, -1.081831247, 0.5171869094,
         -0.05351476722},                                                             // SH_dtheta
        {0.0001642987243, 0.6726686919, -0.6948648139, 0.1193701101, 0.000332947926}, // HSH_l9_m_-9_-4_0_5_9
    },
    {
        0.9,
        2.5,
        {0.3989422804, -0.4011192073, 0.1680621302, 0.5369574761, -0.6969917874, -0.2181512126, -0.366874878,
         0.2920277124, 0.2061791727, -0.7142962907, -0.448513843, 0.2642323775, -0.3471125624, -0.3537141776,
         0.1326761876, -0.2639662344}, // HSH
        {0, -0.1624531072, -1.082539458, 0.2174675479, -0.564562751, 1.316827372, -1.01973784, -1.762768497,
         0.1670049534, -0.8678690758, 2.525718678, 1.536729737, 1.746754755, -2.057140386, -0.7471402061,
         -0.3207186358}, // HSH_dtheta
        {0, 0.5369574761, 0, 0.4011192073, 0.4123583455, 0.2920277124, 0, 0.2181512126, 1.393983575, -0.7918987032,
         0.2653523751, -0.3537141776, 0, -0.2642323775, 0.897027686, 2.142888872}, // HSH_dphi
        {0.2820947918, -0.2290565327, 0.3037201919, 0.3066260988, -0.3214260763, -0.3183799095, 0.05020934622,
         0.4261986699, 0.09508198475, -0.2660210863, -0.5286254856, -0.1996917767, -0.2477453117, 0.2673170232,
         0.1563742461, -0.09830736258}, // SH
        {0, -0.1817680745, -0.3827354957, 0.2433234927, -0.5101360636, 0.1485583166, -0.9214299859, -0.1988673125,
         0.1509048363, -0.6333040153, -0.1728309721, 0.8848308011, -0.8173195087, -1.184477096, 0.05112563374,
         -0.2340357612},                                                        // SH_dtheta
        {0.392151028, -0.3160545785, 0.3290150793, 0.2818013385, 0.7029663983}, // HSH_l9_m_-9_-4_0_5_9
    },
    {
        1.4,
        -1.2,
        {0.3989422804, 0.4837989744, -0.456097685, -0.1880911569, -0.2944744574, -0.7140639703, 0.1369583954,
         0.2776134829, -0.3214736502, -0.1565354867, 0.5142612782, 0.5333031349, 0.2861929049, -0.2073373631,
         0.5614118513, 0.3172158876}, // HSH
        {0, -1.115311907, -1.361868465, 0.433610483, 1.357716267, -0.4859869847, 3.481512574, 0.1889418106, 1.482199876,
         1.082593607, -0.8355346357, 4.657925418, -3.67722312, -1.810906238, -0.9121414863, -2.193853286}, // HSH_dtheta
        {0, -0.1880911569, 0, -0.4837989744, -0.6429473004, 0.2776134829, 0, 0.7140639703, 0.5889489147, 0.9516476627,
         1.122823703, -0.2073373631, 0, -0.5333031349, -1.028522556, 0.4696064602}, // HSH_dphi
        {0.2820947918, 0.4487704945, 0.08304637296, -0.1744727996, -0.358328484, 0.170558855, -0.2880576856,
         -0.06630979819, -0.3911821988, -0.2498738797, -0.1611370195, -0.3591506759, -0.1811213829, 0.1396304451,
         -0.1759110325, 0.5063641873}, // SH
        {0, 0.07740246555, -0.4814932134, -0.03009249722, -0.1236066474, -0.9594629749, -0.3169573111, 0.3730196022,
         -0.1349396497, -0.1292922859, 0.8786689301, -0.7650624119, 0.9438830516, 0.297440635, 0.9592305928,
         0.2620081113},                                                             // SH_dtheta
        {-0.07914459841, 0.1568276991, -0.282929597, -0.6434590308, 0.01567906448}, // HSH_l9_m_-9_-4_0_5_9
    },
};

static void check_row(const double want[16], const float got[], double factor)
{
    // Ten digits of values up to 3; floats, and half a dozen roundings of them.
    for (int i = 0; i < 16; ++i) assert_true(fabs((double)got[i] - factor * want[i]) < 2e-6);
}

static void test_reference_values(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof references / sizeof *references; ++k) {
        const Reference *r = &references[k];
        Vec3 w = to_vec3(direction(r->theta, r->phi));
        float f[100], by_theta[100], by_phi[100];
        sheen_basis_eval(SHEEN_BASIS_SH, 4, w, f);
        check_row(r->sh, f, 1.0);
        sheen_basis_derive(SHEEN_BASIS_SH, 4, w, by_theta, by_phi);
        check_row(r->sh_by_theta, by_theta, cos(r->theta));
        sheen_basis_derive(SHEEN_BASIS_HSH, 4, w, by_theta, by_phi);
        check_row(r->hsh_by_theta, by_theta, cos(r->theta));
        check_row(r->hsh_by_phi, by_phi, 1 / sin(r->theta));
        sheen_basis_eval(SHEEN_BASIS_HSH, 10, w, f);
        check_row(r->hsh, f, 1.0);
        static const int m[5] = {-9, -4, 0, 5, 9};
        for (int i = 0; i < 5; ++i) assert_true(fabs((double)f[basis_index(9, m[i])] - r->hsh_9[i]) < 2e-6);
    }
}

// The largest error at one direction, of values up to sqrt(2 l + 1).
static double error_at(SheenBasis basis, unsigned n, Vec3 w)
{
    float got[SHEEN_BASIS_MAX];
    double want[SHEEN_BASIS_MAX], worst = 0.0;
    sheen_basis_eval(basis, n, w, got);
    kit_eval(basis, n, from_vec3(w), want);
    for (size_t i = 0; i < basis_size(n); ++i) worst = max_double(worst, fabs((double)got[i] - want[i]));
    return worst;
}

static double largest_error(SheenBasis basis, unsigned n)
{
    static const Vec3 special[] = {
        {0, 0, 1},           {1, 0, 0},     {0, -1, 0},     {1e-3f, 0, 0.9999995f}, {0, 1e-20f, 1},
        {1e-38f, 1e-38f, 1}, {1, 0, 1e-7f}, {0, 1, 1e-20f}, {0.6f, 0.8f, 0},        {0, 0.70710678f, 0.70710678f}};
    double worst = 0.0;
    for (size_t i = 0; i < sizeof special / sizeof *special; ++i)
        worst = max_double(worst, error_at(basis, n, special[i]));
    if (basis == SHEEN_BASIS_SH) worst = max_double(worst, error_at(basis, n, v3(0, 0, -1)));
    for (uint32_t i = 0; i < 500; ++i) worst = max_double(worst, error_at(basis, n, kit_direction(basis, i)));
    return worst;
}

static void test_values(void **state)
{
    (void)state;
    for (int i = 0; i < 2; ++i) {
        // What the rounding of z, half a unit of 24 bits, makes of H_{n-1}^0 at the pole, where its slope is
        // l (l + 1) sqrt((2 l + 1) / 2 pi): 4.7e-6 and 9.4e-5. Everywhere else errors are smaller.
        double at10 = largest_error(both[i], 10), at32 = largest_error(both[i], 32);
        assert_true(at10 < 4.7e-6 && at32 < 9.4e-5);
    }
}

static void test_factors(void **state)
{
    (void)state;
    for (int b = 0; b < 2; ++b)
        for (uint32_t i = 0; i < 200; ++i) {
            Vec3 w = kit_direction(both[b], i);
            float zenith[SHEEN_ZENITH_MAX], azimuth[SHEEN_AZIMUTH_MAX], f[SHEEN_BASIS_MAX];
            unsigned n = 1 + i % SHEEN_ORDER_MAX;
            sheen_basis_zenith(both[b], n, w.z, zenith);
            sheen_basis_azimuth(n, atan2f(w.y, w.x), azimuth);
            sheen_basis_eval(both[b], n, w, f);
            for (unsigned l = 0; l < n; ++l)
                for (int m = -(int)l; m <= (int)l; ++m) {
                    float product = zenith[basis_zenith_index(l, (unsigned)abs(m))] * azimuth[(int)n - 1 + m];
                    // atan2f, cosf and sinf round angles; m times that is 1e-5 of the largest value, 3.
                    assert_true(fabs((double)(product - f[basis_index(l, m)])) < 3e-5);
                }
        }
}

// An order's functions are those of a higher one; nothing but zeros below the horizon.
static void test_orders_and_horizon(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 100; ++i) {
        float f[SHEEN_BASIS_MAX], part[SHEEN_BASIS_MAX];
        Vec3 w = kit_direction(SHEEN_BASIS_SH, i);
        for (int b = 0; b < 2; ++b) {
            unsigned n = 1 + i % (SHEEN_ORDER_MAX - 1);
            sheen_basis_eval(both[b], SHEEN_ORDER_MAX, w, f);
            sheen_basis_eval(both[b], n, w, part);
            assert_memory_equal(f, part, basis_size(n) * sizeof *f);
        }
        if (w.z >= 0) w.z = -w.z;
        float zenith[SHEEN_ZENITH_MAX], by_phi[SHEEN_BASIS_MAX];
        sheen_basis_zenith(SHEEN_BASIS_HSH, SHEEN_ORDER_MAX, w.z, zenith);
        for (size_t k = 0; k < SHEEN_ZENITH_MAX; ++k) assert_true(zenith[k] == 0.0f);
        sheen_basis_eval(SHEEN_BASIS_HSH, SHEEN_ORDER_MAX, w, f);
        sheen_basis_derive(SHEEN_BASIS_HSH, SHEEN_ORDER_MAX, w, part, by_phi);
        for (size_t k = 0; k < SHEEN_BASIS_MAX; ++k) assert_true(f[k] == 0.0f && part[k] == 0.0f && by_phi[k] == 0.0f);
    }
}

// ---- orthonormality ---------------------------------------------------------------------------------------------

// Sums of products over a rule that is exact for them: Gauss-Legendre in the argument, even steps in the azimuth.
static double worst_product(SheenBasis basis, unsigned n)
{
    enum { POINTS = 10, STEPS = 20 };
    double node[POINTS], weight[POINTS], gram[10000] = {0}, worst = 0.0;
    float f[100];
    kit_gauss(POINTS, node, weight);
    for (int i = 0; i < POINTS; ++i)
        for (int k = 0; k < STEPS; ++k) {
            double c = basis == SHEEN_BASIS_SH ? node[i] : 0.5 * (node[i] + 1);
            double dw = weight[i] * 2 * M_PI / STEPS * (basis == SHEEN_BASIS_SH ? 1.0 : 0.5);
            sheen_basis_eval(basis, n, to_vec3(direction(acos(c), 2 * M_PI * (k + 0.3) / STEPS)), f);
            for (size_t a = 0; a < basis_size(n); ++a)
                for (size_t b = 0; b < basis_size(n); ++b) gram[a * 100 + b] += dw * (double)f[a] * (double)f[b];
        }
    for (size_t a = 0; a < basis_size(n); ++a)
        for (size_t b = 0; b < basis_size(n); ++b) worst = max_double(worst, fabs(gram[a * 100 + b] - (a == b)));
    return worst;
}

static void test_orthonormal(void **state)
{
    (void)state;
    for (int i = 0; i < 2; ++i) {
        // Means of products of floats, whose errors are those of test_values and of either sign.
        assert_true(worst_product(both[i], 10) < 2e-6);
    }
}

// Order 32 by its factors: the products over the sphere are products of these two sums.
static void test_orthonormal_factors(void **state)
{
    (void)state;
    enum { N = SHEEN_ORDER_MAX, STEPS = 2 * N };
    double node[N], weight[N], worst = 0.0;
    static float zenith[N][SHEEN_ZENITH_MAX], azimuth[STEPS][SHEEN_AZIMUTH_MAX];
    kit_gauss(N, node, weight);
    for (int b = 0; b < 2; ++b) {
        bool sphere = both[b] == SHEEN_BASIS_SH;
        for (int i = 0; i < N; ++i)
            sheen_basis_zenith(both[b], N, (float)(sphere ? node[i] : 0.5 * (node[i] + 1)), zenith[i]);
        for (unsigned m = 0; m < N; ++m)
            for (unsigned l = m; l < N; ++l)
                for (unsigned k = m; k <= l; ++k) {
                    double sum = 0.0;
                    for (int i = 0; i < N; ++i)
                        sum += (sphere ? 1.0 : 0.5) * 2 * M_PI * weight[i] *
                               (double)zenith[i][basis_zenith_index(l, m)] *
                               (double)zenith[i][basis_zenith_index(k, m)];
                    worst = max_double(worst, fabs(sum - (k == l)));
                }
    }
    assert_true(worst < 5e-6); // as above, at three times the order
    worst = 0.0;
    for (int i = 0; i < STEPS; ++i) sheen_basis_azimuth(N, (float)(2 * M_PI * (i + 0.3) / STEPS), azimuth[i]);
    for (int a = 0; a < SHEEN_AZIMUTH_MAX; ++a)
        for (int b = 0; b <= a; ++b) {
            double sum = 0.0;
            for (int i = 0; i < STEPS; ++i) sum += (double)azimuth[i][a] * (double)azimuth[i][b] / STEPS;
            worst = max_double(worst, fabs(sum - (a == b)));
        }
    assert_true(worst < 5e-6); // a rounding for each of 31 products
}

// ---- derivatives ------------------------------------------------------------------------------------------------

// cos(theta) d/dtheta and 1 / sin(theta) d/dphi by central differences of the definition.
static void differences(SheenBasis basis, unsigned n, double theta, double phi, double by_theta[], double by_phi[])
{
    static double f[4][SHEEN_BASIS_MAX];
    const double h = 1e-6;
    kit_eval(basis, n, direction(theta + h, phi), f[0]);
    kit_eval(basis, n, direction(theta - h, phi), f[1]);
    kit_eval(basis, n, direction(theta, phi + h), f[2]);
    kit_eval(basis, n, direction(theta, phi - h), f[3]);
    for (size_t i = 0; i < basis_size(n); ++i) {
        by_theta[i] = cos(theta) * (f[0][i] - f[1][i]) / (2 * h);
        by_phi[i] = (f[2][i] - f[3][i]) / (2 * h) / sin(theta);
    }
}

static double derivative_error(SheenBasis basis, unsigned n, double theta, double phi)
{
    float got[2][SHEEN_BASIS_MAX];
    double want[2][SHEEN_BASIS_MAX], worst = 0.0;
    sheen_basis_derive(basis, n, to_vec3(direction(theta, phi)), got[0], got[1]);
    differences(basis, n, theta, phi, want[0], want[1]);
    for (int k = 0; k < 2; ++k)
        for (size_t i = 0; i < basis_size(n); ++i) worst = max_double(worst, fabs((double)got[k][i] - want[k][i]));
    return worst;
}

static void test_derivatives(void **state)
{
    (void)state;
    for (int b = 0; b < 2; ++b) {
        double worst[2] = {0};
        for (uint32_t i = 0; i < 200; ++i) {
            Direction w = from_vec3(kit_direction(both[b], i));
            double theta = acos(w.z), phi = atan2(w.y, w.x);
            for (int k = 0; k < 2; ++k)
                worst[k] = max_double(worst[k], derivative_error(both[b], k ? 32 : 10, theta, phi));
        }
        // The bounds of test_values times the order.
        assert_true(worst[0] < 4.7e-5 && worst[1] < 3e-3);
    }
}

static void test_derivatives_at_the_ends(void **state)
{
    (void)state;
    for (int b = 0; b < 2; ++b) {
        float at[2][100], near[2][100];
        // At the pole the azimuth is that of +x.
        sheen_basis_derive(both[b], 10, v3(0, 0, 1), at[0], at[1]);
        sheen_basis_derive(both[b], 10, v3(1e-6f, 0, 1), near[0], near[1]);
        for (size_t k = 0; k < 2; ++k)
            for (size_t i = 0; i < 100; ++i) assert_true(fabsf(at[k][i] - near[k][i]) < 1e-3f);
        // d/dx at the pole: of Y_1^1 = -sqrt(3 / 4 pi) x, and of H_1^1, where sin(theta) stands for x / sqrt(2).
        float slope = both[b] == SHEEN_BASIS_SH ? -0.48860251f : -0.97720502f;
        assert_true(fabsf(at[0][basis_index(1, 1)] - slope) < 1e-6f);
        assert_true(fabsf(at[1][basis_index(1, -1)] - slope) < 1e-6f);
        // The horizon, where dH / dtheta alone is infinite.
        sheen_basis_derive(both[b], 10, v3(0.6f, 0.8f, 0), at[0], at[1]);
        for (size_t i = 0; i < 100; ++i) assert_true(at[0][i] == 0.0f && isfinite(at[1][i]));
    }
}

// ---- sums -------------------------------------------------------------------------------------------------------

static Rgb value_of(uint32_t i)
{
    return rgb(hash_to_unit(hash_u32(~i)), 5.0f * hash_to_unit(hash_u32(i ^ 0xabcdu)), (float)(i % 3));
}

static void check_projection(SheenBasis basis, unsigned n, uint32_t count)
{
    Vec3 *w = malloc((count + 1) * sizeof *w);
    Rgb *value = malloc((count + 1) * sizeof *value), *got = malloc(basis_size(n) * sizeof *got);
    double(*want)[3] = calloc(basis_size(n), sizeof *want);
    assert_true(w && value && got && want);
    for (uint32_t i = 0; i < count; ++i) {
        float f[SHEEN_BASIS_MAX];
        w[i] = kit_direction(SHEEN_BASIS_SH, i); // half of them below the horizon
        value[i] = value_of(i);
        sheen_basis_eval(basis, n, w[i], f);
        for (size_t k = 0; k < basis_size(n); ++k) {
            want[k][0] += (double)f[k] * (double)value[i].r;
            want[k][1] += (double)f[k] * (double)value[i].g;
            want[k][2] += (double)f[k] * (double)value[i].b;
        }
    }
    sheen_basis_project(basis, n, count, w, value, got);
    // The order of sums differs, and some products' roundings: 1e-6 of the sum of magnitudes, values up to 5 * sqrt(2
    // n).
    double bound = 1e-6 * count * 2 * sqrt(2.0 * n);
    for (size_t k = 0; k < basis_size(n); ++k)
        assert_true(fabs((double)got[k].r - want[k][0]) <= bound && fabs((double)got[k].g - want[k][1]) <= bound &&
                    fabs((double)got[k].b - want[k][2]) <= bound);
    free(w);
    free(value);
    free(got);
    free(want);
}

static void test_projection(void **state)
{
    (void)state;
    static const uint32_t counts[] = {0, 1, 7, 8, 9, 63, 64, 65, 1000};
    static const unsigned orders[] = {1, 2, 3, 10, 17, 32};
    for (size_t c = 0; c < sizeof counts / sizeof *counts; ++c)
        for (size_t k = 0; k < sizeof orders / sizeof *orders; ++k)
            for (int b = 0; b < 2; ++b) check_projection(both[b], orders[k], counts[c]);
}

static void test_dot(void **state)
{
    (void)state;
    for (unsigned n = 1; n <= SHEEN_ORDER_MAX; ++n) {
        static float a[SHEEN_BASIS_MAX];
        static Rgb b[SHEEN_BASIS_MAX];
        double sum[3] = {0};
        for (uint32_t i = 0; i < basis_size(n); ++i) {
            a[i] = hash_to_unit(hash_u32(i)) - 0.3f;
            b[i] = value_of(i);
            sum[0] += (double)a[i] * (double)b[i].r;
            sum[1] += (double)a[i] * (double)b[i].g;
            sum[2] += (double)a[i] * (double)b[i].b;
        }
        Rgb got = sheen_basis_dot(n, a, b);
        // Roundings of up to 256 sums, of numbers up to 3.5.
        double bound = 1e-6 * (double)basis_size(n);
        assert_true(fabs((double)got.r - sum[0]) < bound && fabs((double)got.g - sum[1]) < bound &&
                    fabs((double)got.b - sum[2]) < bound);
    }
}

// Numbers that are none: they may show in the result, but not where a direction below the horizon brings them.
static void test_broken_numbers(void **state)
{
    (void)state;
    const float broken[] = {NAN, INFINITY, -INFINITY, 1e30f, -0.0f};
    float f[100], g[100];
    for (size_t i = 0; i < 5; ++i)
        for (int b = 0; b < 2; ++b) {
            sheen_basis_eval(both[b], 10, v3(broken[i], 0, 1), f);
            sheen_basis_eval(both[b], 10, v3(0, 0, broken[i]), f);
            sheen_basis_derive(both[b], 10, v3(broken[i], broken[i], broken[i]), f, g);
            sheen_basis_zenith(both[b], 10, broken[i], f);
            sheen_basis_azimuth(10, broken[i], f);
        }
    Rgb out[100];
    const Vec3 w[2] = {{0, 0, -1}, {NAN, NAN, NAN}};
    const Rgb value[2] = {{INFINITY, NAN, 1}, {1, 1, 1}};
    sheen_basis_project(SHEEN_BASIS_HSH, 10, 2, w, value, out);
    for (size_t i = 0; i < 100; ++i) assert_true(rgb_is_black(out[i]));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_coefficients),
        cmocka_unit_test(test_reference_values),
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_factors),
        cmocka_unit_test(test_orders_and_horizon),
        cmocka_unit_test(test_orthonormal),
        cmocka_unit_test(test_orthonormal_factors),
        cmocka_unit_test(test_derivatives),
        cmocka_unit_test(test_derivatives_at_the_ends),
        cmocka_unit_test(test_projection),
        cmocka_unit_test(test_dot),
        cmocka_unit_test(test_broken_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
