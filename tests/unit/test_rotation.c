// SPDX-License-Identifier: Apache-2.0
// Rotations of coefficients against rotations of directions, a recurrence for rotation matrices, and quadratures.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "basis/rotation.h"
#include "unit/basis_kit.h"

#include <stdlib.h>
#include <string.h>

#define DEGREE (M_PI / 180)

static double max_double(double a, double b)
{
    return a > b ? a : b;
}

static double random_unit(uint32_t i)
{
    return 2 * (double)hash_to_unit(hash_u32(i ^ 0x51ed270bu)) - 1;
}

// ---- rotations of directions ------------------------------------------------------------------------------------

typedef struct Matrix {
    double at[3][3];
} Matrix;

static Matrix about_z(double a)
{
    return (Matrix){{{cos(a), -sin(a), 0}, {sin(a), cos(a), 0}, {0, 0, 1}}};
}
static Matrix about_y(double b)
{
    return (Matrix){{{cos(b), 0, sin(b)}, {0, 1, 0}, {-sin(b), 0, cos(b)}}};
}
static Matrix times(Matrix a, Matrix b)
{
    Matrix c = {{{0}}};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            for (int j = 0; j < 3; ++j) c.at[i][k] += a.at[i][j] * b.at[j][k];
    return c;
}
static Direction turn_back(Matrix r, Direction w)
{
    return (Direction){r.at[0][0] * w.x + r.at[1][0] * w.y + r.at[2][0] * w.z,
                       r.at[0][1] * w.x + r.at[1][1] * w.y + r.at[2][1] * w.z,
                       r.at[0][2] * w.x + r.at[1][2] * w.y + r.at[2][2] * w.z};
}
static Matrix zyz(double alpha, double beta, double gamma)
{
    return times(about_z(gamma), times(about_y(beta), about_z(alpha)));
}
static SheenEuler euler(double alpha, double beta, double gamma)
{
    return (SheenEuler){v2((float)cos(alpha), (float)sin(alpha)), v2((float)cos(beta), (float)sin(beta)),
                        v2((float)cos(gamma), (float)sin(gamma))};
}

// The frames whose axes are the columns of a matrix.
static Frame frame_of(Matrix r)
{
    return (Frame){v3((float)r.at[0][0], (float)r.at[1][0], (float)r.at[2][0]),
                   v3((float)r.at[0][1], (float)r.at[1][1], (float)r.at[2][1]),
                   v3((float)r.at[0][2], (float)r.at[1][2], (float)r.at[2][2])};
}

// What takes components in one frame to those in the other.
static Matrix between(const Frame *from, const Frame *to)
{
    const Vec3 a[3] = {to->t, to->b, to->n}, b[3] = {from->t, from->b, from->n};
    Matrix r;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            r.at[i][k] =
                (double)a[i].x * (double)b[k].x + (double)a[i].y * (double)b[k].y + (double)a[i].z * (double)b[k].z;
    return r;
}

static Matrix random_rotation(uint32_t i)
{
    return zyz(M_PI * random_unit(3 * i), acos(random_unit(3 * i + 1)), M_PI * random_unit(3 * i + 2));
}

// Also where the angles are not determined: no tilt, hardly any, half a turn.
static void test_frames(void **state)
{
    (void)state;
    static const double tilts[] = {0, 1e-8, 1e-6, 1e-4, 1e-2, 1, M_PI / 2, M_PI - 1e-4, M_PI - 1e-6, M_PI};
    for (uint32_t i = 0; i < 500; ++i) {
        Matrix a = random_rotation(i);
        Matrix b = times(a, i < 100 ? random_rotation(i + 1000)
                                    : zyz(random_unit(i), tilts[i % 10], i < 200 ? 0 : 3 * random_unit(i + 7)));
        Frame from = frame_of(b), to = frame_of(a);
        SheenEuler e = sheen_euler_between(&from, &to);
        Matrix want = between(&from, &to);
        Matrix got = zyz(atan2((double)e.alpha.y, (double)e.alpha.x), atan2((double)e.beta.y, (double)e.beta.x),
                         atan2((double)e.gamma.y, (double)e.gamma.x));
        for (int k = 0; k < 9; ++k)
            // Roundings of frames and dot products, some units of 24 bits.
            assert_true(fabs(got.at[k / 3][k % 3] - want.at[k / 3][k % 3]) < 1e-6);
    }
}

// ---- vectors ----------------------------------------------------------------------------------------------------

static SheenRotation *create(SheenBasis basis, unsigned n, double tilt_max)
{
    SheenRotation *r;
    assert_int_equal(sheen_rotation_create(basis, n, (float)tilt_max, &r), SHEEN_OK);
    return r;
}

static void random_vector(unsigned n, uint32_t seed, float out[])
{
    for (size_t i = 0; i < basis_size(n); ++i) out[i] = (float)random_unit(seed * 2048 + (uint32_t)i);
}

static double norm(size_t size, const float v[])
{
    double sum = 0.0;
    for (size_t i = 0; i < size; ++i) sum += (double)v[i] * (double)v[i];
    return sqrt(sum);
}

static double distance(size_t size, const float a[], const double b[])
{
    double sum = 0.0;
    for (size_t i = 0; i < size; ++i) sum += ((double)a[i] - b[i]) * ((double)a[i] - b[i]);
    return sqrt(sum);
}

static double value_at(SheenBasis basis, unsigned n, const float v[], Direction w)
{
    double f[SHEEN_BASIS_MAX], sum = 0.0;
    kit_eval(basis, n, w, f);
    for (size_t i = 0; i < basis_size(n); ++i) sum += (double)v[i] * f[i];
    return sum;
}

// The rotated function at w is the function at the direction turned back; relative to the vector's length.
static double pointwise_error(SheenBasis basis, unsigned n, const float v[], const float rotated[], Matrix r)
{
    double worst = 0.0;
    for (uint32_t i = 0; i < 20; ++i) {
        Direction w = from_vec3(kit_direction(basis, i));
        worst = max_double(worst, fabs(value_at(basis, n, rotated, w) - value_at(basis, n, v, turn_back(r, w))));
    }
    return worst / norm(basis_size(n), v);
}

static void test_about_z(void **state)
{
    (void)state;
    static const SheenBasis both[] = {SHEEN_BASIS_HSH, SHEEN_BASIS_SH};
    float v[SHEEN_BASIS_MAX] = {0}, out[SHEEN_BASIS_MAX];
    for (uint32_t i = 0; i < 40; ++i) {
        double a = 4 * random_unit(i);
        unsigned n = i % 2 ? 10 : 32;
        random_vector(n, i, v);
        sheen_rotate_z(n, v2((float)cos(a), (float)sin(a)), 1, v, out);
        // m roundings of powers, 6e-8 each, of up to n^2 / 4 pi times the length where functions add up.
        assert_true(pointwise_error(both[i / 2 % 2], n, v, out, about_z(a)) < (n == 10 ? 5e-6 : 5e-5));
    }
}

static void test_sphere_pointwise(void **state)
{
    (void)state;
    static const unsigned orders[] = {1, 2, 3, 10, 16, 17, 32};
    float v[SHEEN_BASIS_MAX] = {0}, out[SHEEN_BASIS_MAX];
    for (size_t k = 0; k < sizeof orders / sizeof *orders; ++k) {
        unsigned n = orders[k];
        SheenRotation *rotation = create(SHEEN_BASIS_SH, n, 0);
        for (uint32_t i = 0; i < 20; ++i) {
            Matrix a = random_rotation(i), b = times(a, zyz(i, i % 4 ? acos(random_unit(i)) : 1e-5 * i, 3.0 * i));
            Frame from = frame_of(a), to = frame_of(b);
            random_vector(n, i, v);
            sheen_rotation_apply(rotation, sheen_euler_between(&from, &to), 1, v, out);
            // Roundings of the same size as in test_about_z.
            assert_true(pointwise_error(SHEEN_BASIS_SH, n, v, out, between(&from, &to)) < (n <= 17 ? 5e-6 : 5e-5));
        }
        sheen_rotation_destroy(&rotation);
    }
}

// ---- a recurrence for the matrices ------------------------------------------------------------------------------

// Blocks of one band: [2 l + 1][2 l + 1], row and column m + l.
typedef struct Band {
    int l;
    double at[2 * SHEEN_ORDER_MAX][2 * SHEEN_ORDER_MAX];
} Band;

static double entry(const Band *b, int row, int column)
{
    return b->at[row + b->l][column + b->l];
}

// Of the functions of band 1 without the Condon-Shortley sign, which are y, z, x.
static void first_band(Matrix r, Band *b)
{
    static const int axis[3] = {1, 2, 0};
    b->l = 1;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) b->at[i][k] = r.at[axis[i]][axis[k]];
}

static double product(const Band *first, const Band *last, int i, int row, int column)
{
    int l = last->l + 1;
    if (column == l)
        return entry(first, i, 1) * entry(last, row, l - 1) - entry(first, i, -1) * entry(last, row, 1 - l);
    if (column == -l)
        return entry(first, i, 1) * entry(last, row, 1 - l) + entry(first, i, -1) * entry(last, row, l - 1);
    return entry(first, i, 0) * entry(last, row, column);
}

static double next_entry(const Band *first, const Band *last, int m, int n)
{
    int l = last->l + 1, k = abs(m);
    double d = abs(n) == l ? 2.0 * l * (2 * l - 1) : (double)(l + n) * (l - n), sum = 0.0;
    double v = 0.5 * sqrt((m ? 1.0 : 2.0) * (l + k - 1) * (l + k) / d);
    if (k < l) sum += sqrt((l + m) * (l - m) / d) * product(first, last, 0, m, n);
    if (m == 0) sum -= v * (product(first, last, 1, 1, n) + product(first, last, -1, -1, n));
    if (m == 1) sum += v * M_SQRT2 * product(first, last, 1, 0, n);
    if (m == -1) sum += v * M_SQRT2 * product(first, last, -1, 0, n);
    if (m > 1) sum += v * (product(first, last, 1, m - 1, n) - product(first, last, -1, 1 - m, n));
    if (m < -1) sum += v * (product(first, last, 1, m + 1, n) + product(first, last, -1, -m - 1, n));
    double w = 0.5 * sqrt((double)(l - k - 1) * (l - k) / d);
    if (m > 0 && k < l - 1) sum -= w * (product(first, last, 1, m + 1, n) + product(first, last, -1, -m - 1, n));
    if (m < 0 && k < l - 1) sum -= w * (product(first, last, 1, m - 1, n) - product(first, last, -1, 1 - m, n));
    return sum;
}

// Applies the rotation. The recurrence is for functions without the Condon-Shortley sign: rows and columns of odd m
// change signs.
static void recurrence_rotate(unsigned n, Matrix r, const float v[], double out[])
{
    Band *first = calloc(3, sizeof *first), *last = first + 1, *next = first + 2;
    assert_non_null(first);
    first_band(r, first);
    *last = *first;
    out[0] = (double)v[0];
    for (int l = 1; l < (int)n; ++l) {
        if (l > 1) {
            next->l = l;
            for (int i = -l; i <= l; ++i)
                for (int k = -l; k <= l; ++k) next->at[i + l][k + l] = next_entry(first, last, i, k);
            *last = *next;
        }
        for (int i = -l; i <= l; ++i) {
            double sum = 0.0;
            for (int k = -l; k <= l; ++k)
                sum += ((i + k) % 2 ? -1 : 1) * entry(last, i, k) * (double)v[basis_index((unsigned)l, k)];
            out[basis_index((unsigned)l, i)] = sum;
        }
    }
    free(first);
}

// Source: ivanic1996-rotation, with the corrections of 1998.
static void test_sphere_recurrence(void **state)
{
    (void)state;
    float v[SHEEN_BASIS_MAX] = {0}, out[SHEEN_BASIS_MAX];
    double want[SHEEN_BASIS_MAX];
    for (uint32_t i = 0; i < 12; ++i) {
        unsigned n = i % 2 ? 10 : 32;
        double a = 3 * random_unit(i), b = 3 * random_unit(i + 50), c = 3 * random_unit(i + 99);
        SheenRotation *rotation = create(SHEEN_BASIS_SH, n, 0);
        random_vector(n, i, v);
        sheen_rotation_apply(rotation, euler(a, b, c), 1, v, out);
        recurrence_rotate(n, zyz(a, b, c), v, want);
        // Powers of angles' cosines and sines, rounded up to 31 times, and sums of as many products.
        assert_true(distance(basis_size(n), out, want) < 2e-6 * norm(basis_size(n), v));
        // The inverse brings it back.
        sheen_rotation_apply(rotation, euler_inverse(euler(a, b, c)), 1, out, out);
        for (size_t k = 0; k < basis_size(n); ++k) want[k] = (double)v[k];
        assert_true(distance(basis_size(n), out, want) < 4e-6 * norm(basis_size(n), v));
        sheen_rotation_destroy(&rotation);
    }
}

// ---- numbers of another implementation --------------------------------------------------------------------------

// Of the vector (-1)^i / (1 + i), i = 0 .. 15: Rz(0.7); Ry(15 degrees); Rz(0.7) Ry(15 degrees) Rz(-1.3) in both bases.
static const double turned[16] = {1,
                                  -0.5434755155,
                                  0.3333333333,
                                  0.1308982968,
                                  0.143487843,
                                  -0.2080009088,
                                  0.1428571429,
                                  0.01176434113,
                                  -0.1782047079,
                                  -0.003465974956,
                                  0.08114820711,
                                  -0.109752398,
                                  0.07692307692,
                                  -0.0009467775362,
                                  -0.07825519623,
                                  0.1178738182};
static const double tilted[16] = {0.9340910203,  -0.4686603903, 0.2856255112,   -0.3964972188,
                                  0.2728395747,  -0.0873246225, 0.007776715982, -0.0670426537,
                                  0.1591137238,  -0.166206945,  0.03056330121,  -0.03172385247,
                                  0.02934597559, -0.1309462266, 0.0859417538,   -0.1178786769};
static const double hsh_rotated[16] = {0.9195370805,  -0.3623420259,  0.1743303053,   -0.5676595721,
                                       0.1176910612,  -0.1177748807,  -0.04206472191, -0.1059814869,
                                       0.2569974886,  0.003542219572, 0.07515394281,  -0.1075428593,
                                       0.00605398034, -0.1107179829,  0.09640588368,  -0.1388473818};
static const double sh_rotated[16] = {1,
                                      -0.3150421901,
                                      0.1799732229,
                                      -0.5403417147,
                                      0.02260700772,
                                      -0.1360497035,
                                      0.04494284497,
                                      -0.1834051171,
                                      0.2479490374,
                                      0.05693596606,
                                      0.05312235742,
                                      -0.07279150494,
                                      0.004395009763,
                                      -0.08670203733,
                                      0.1172892959,
                                      -0.1091932767};
// Of the constant 1, tilted by 15 degrees.
static const double sky_tilted[16] = {2.297742585,
                                      0,
                                      0.2878322827,
                                      -0.1639266862,
                                      0,
                                      0,
                                      -0.2227075795,
                                      0.2690318469,
                                      -0.06691244772,
                                      0,
                                      0,
                                      0,
                                      0.09526711071,
                                      -0.2724099382,
                                      0.1156108439,
                                      -0.01988347814};

static void check_vector(const float got[], const double want[16])
{
    for (int i = 0; i < 16; ++i) assert_true(fabs((double)got[i] - want[i]) < 2e-6); // floats; ten digits
}

static void test_reference_values(void **state)
{
    (void)state;
    SheenRotation *hsh = create(SHEEN_BASIS_HSH, 4, 25 * DEGREE), *sh = create(SHEEN_BASIS_SH, 4, 0);
    float v[16], out[16], sky[16] = {2.50662827463f}; // sqrt(2 pi)
    for (int i = 0; i < 16; ++i) v[i] = (i % 2 ? -1.0f : 1.0f) / (float)(1 + i);
    sheen_rotate_z(4, v2(cosf(0.7f), sinf(0.7f)), 1, v, out);
    check_vector(out, turned);
    sheen_rotation_apply(hsh, euler(0, 15 * DEGREE, 0), 1, v, out);
    check_vector(out, tilted);
    sheen_rotation_apply(hsh, euler(-1.3, 15 * DEGREE, 0.7), 1, v, out);
    check_vector(out, hsh_rotated);
    sheen_rotation_apply(sh, euler(-1.3, 15 * DEGREE, 0.7), 1, v, out);
    check_vector(out, sh_rotated);
    sheen_rotation_apply(hsh, euler(0, 15 * DEGREE, 0), 1, sky, out);
    check_vector(out, sky_tilted);
    sheen_rotation_destroy(&hsh);
    sheen_rotation_destroy(&sh);
}

// ---- tilts ------------------------------------------------------------------------------------------------------

enum { POINTS = 64, ACROSS = 36 };

// Half of the azimuths, and there the angles from z up to where the tilted hemisphere ends. Nodes crowd at the ends of
// both intervals, where roots and narrow bends are.
static void project_half(unsigned n, const float x[], double beta, double phi_first, double out[])
{
    double node[POINTS], weight[POINTS], node2[ACROSS], weight2[ACROSS], h[SHEEN_BASIS_MAX];
    kit_gauss(POINTS, node, weight);
    kit_gauss(ACROSS, node2, weight2);
    for (int i = 0; i < POINTS; ++i) {
        double v = 0.5 * (node[i] + 1), phi = phi_first + M_PI * v * v * (3 - 2 * v), end = M_PI / 2;
        if (cos(phi) < 0) end = atan2(cos(beta), -sin(beta) * cos(phi));
        for (int k = 0; k < ACROSS; ++k) {
            double u = 0.5 * (1 - node2[k]), theta = end * (1 - u * u);
            double dw = 0.25 * M_PI * 6 * v * (1 - v) * weight[i] * weight2[k] * 2 * end * u * sin(theta);
            Direction w = direction(theta, phi);
            double f = dw * value_at(SHEEN_BASIS_HSH, n, x, turn_back(about_y(beta), w));
            kit_eval(SHEEN_BASIS_HSH, n, w, h);
            for (size_t j = 0; j < basis_size(n); ++j) out[j] += f * h[j];
        }
    }
}

// The tilted function's coefficients, by a quadrature about the pole of the new frame.
static void project_tilted(unsigned n, const float v[], double beta, double out[])
{
    memset(out, 0, basis_size(n) * sizeof *out);
    project_half(n, v, beta, -M_PI / 2, out);
    project_half(n, v, beta, M_PI / 2, out);
}

static double tilt_error(const SheenRotation *r, unsigned n, double degrees, uint32_t seed)
{
    float v[SHEEN_BASIS_MAX] = {0}, out[SHEEN_BASIS_MAX];
    double want[SHEEN_BASIS_MAX];
    random_vector(n, seed, v);
    sheen_rotation_apply(r, euler(0, degrees * DEGREE, 0), 1, v, out);
    project_tilted(n, v, degrees * DEGREE, want);
    return distance(basis_size(n), out, want) / norm(basis_size(n), v);
}

static void test_tilts(void **state)
{
    (void)state;
    static const unsigned orders[] = {1, 2, 5, 10, 16};
    for (size_t k = 0; k < sizeof orders / sizeof *orders; ++k) {
        unsigned n = orders[k];
        SheenRotation *r = create(SHEEN_BASIS_HSH, n, n == 16 ? 3 * DEGREE : 25 * DEGREE);
        for (uint32_t i = 1; i <= 3; ++i) {
            assert_true(tilt_error(r, n, n == 16 ? i : 8 * i, i) < 5e-6); // sums of 1000 to 4000 floats
        }
        // Between two entries, and between the identity and the first, where the matrices bend most; as measured.
        static const double between_entries[] = {0.3, 0.5, 0.7, 1.5, 2.5};
        for (uint32_t i = 0; i < 5; ++i) {
            assert_true(tilt_error(r, n, between_entries[i], i) < (n <= 10 ? 0.01 : 0.04));
        }
        sheen_rotation_destroy(&r);
    }
}

// The share of the squares of random coefficients that is left: the squares of all entries over their number.
static double energy(const SheenRotation *r, unsigned n, double degrees)
{
    float v[SHEEN_BASIS_MAX] = {0}, out[SHEEN_BASIS_MAX];
    double sum = 0.0;
    for (size_t i = 0; i < basis_size(n); ++i) {
        memset(v, 0, sizeof v);
        v[i] = 1.0f;
        sheen_rotation_apply(r, euler(0, degrees * DEGREE, 0), 1, v, out);
        double length = norm(basis_size(n), out);
        sum += length * length;
    }
    return sum / (double)basis_size(n);
}

static void test_energy(void **state)
{
    (void)state;
    SheenRotation *r = create(SHEEN_BASIS_HSH, 10, 60 * DEGREE);
    static const double tilt[] = {0, 5, 15, 30, 60, 61, 90}, left[] = {1, 0.923, 0.791, 0.663, 0.470, 0.470, 0.470};
    for (int i = 0; i < 7; ++i) assert_true(fabs(energy(r, 10, tilt[i]) - left[i]) < 6e-4); // three digits
    // The irradiance of an even sky: what the cosine, of bands 0 and 1 only, sees of it.
    float sky[100] = {2.50662827463f}, out[100];
    for (int i = 0; i <= 60; i += 5) {
        sheen_rotation_apply(r, euler(0, i * DEGREE, 0), 1, sky, out);
        double irradiance = 1.2533141373 * (double)out[0] + 0.7236012546 * (double)out[2];
        assert_true(fabs(irradiance - M_PI * (1 + cos(i * DEGREE)) / 2) < 1e-5);
    }
    sheen_rotation_destroy(&r);
}

// Inner products of the spherical functions (l, m), l < 2 n, and the hemispherical ones (k, m), of one m.
typedef struct Inner {
    double of[SHEEN_ORDER_MAX][SHEEN_ORDER_MAX]; // [l][k]
} Inner;

static Inner inner_products(int n, int m)
{
    Inner t = {{{0}}};
    double node[POINTS], weight[POINTS], sphere[SHEEN_ORDER_MAX], hemisphere[SHEEN_ORDER_MAX];
    kit_gauss(POINTS, node, weight);
    for (int i = 0; i < POINTS; ++i) {
        double u = 0.5 * (node[i] + 1), c = u * u, s = sqrt(1 - c * c); // a root at the horizon becomes smooth
        kit_zenith(SHEEN_BASIS_SH, 2 * n, m, c, s, sphere);
        kit_zenith(SHEEN_BASIS_HSH, n, m, c, s, hemisphere);
        for (int l = m; l < 2 * n; ++l)
            for (int k = m; k < n; ++k) t.of[l][k] += 2 * M_PI * weight[i] * u * sphere[l] * hemisphere[k];
    }
    return t;
}

// Hemispherical of order n, extended by 0, to spherical of order 2 n.
static void to_sphere(int n, const Inner t[], const float hsh[], float sh[])
{
    memset(sh, 0, basis_size(2 * (unsigned)n) * sizeof *sh);
    for (int l = 0; l < 2 * n; ++l)
        for (int m = -l; m <= l; ++m)
            for (int k = abs(m); k < n; ++k)
                sh[basis_index((unsigned)l, m)] += (float)t[abs(m)].of[l][k] * hsh[basis_index((unsigned)k, m)];
}

// Spherical of order 2 n, its upper half, to hemispherical of order n.
static void to_hemisphere(int n, const Inner t[], const float sh[], float hsh[])
{
    memset(hsh, 0, basis_size((unsigned)n) * sizeof *hsh);
    for (int k = 0; k < n; ++k)
        for (int m = -k; m <= k; ++m)
            for (int l = abs(m); l < 2 * n; ++l)
                hsh[basis_index((unsigned)k, m)] += (float)t[abs(m)].of[l][k] * sh[basis_index((unsigned)l, m)];
}

static void test_inner_products(void **state)
{
    (void)state;
    // l, k, m and value, by another implementation.
    static const struct {
        int l, k, m;
        double value;
    } want[] = {{0, 0, 0, M_SQRT1_2},    {1, 0, 0, 0.6123724357}, {1, 1, 1, 0.6738716048}, {2, 1, 1, 0.6745163469},
                {3, 2, 2, 0.7015607600}, {3, 3, 0, 0.0883883476}, {7, 3, 3, -0.1207471063}};
    for (int i = 0; i < 7; ++i) {
        Inner t = inner_products(4, want[i].m);
        assert_true(fabs(t.of[want[i].l][want[i].k] - want[i].value) < 1e-9);
    }
}

// The tilt by way of spherical harmonics of twice the order, as krivanek2005-radiance-caching has it with the same
// order. How far it is from the exact one was measured with matrices of another implementation.
static void test_tilt_by_sphere(void **state)
{
    (void)state;
    enum { N = 10 };
    // Root of the sum of squares of all entries' differences, relative to the exact matrix.
    static const double tilt[] = {5, 15, 30, 60}, error[] = {0.134, 0.066, 0.028, 0.014};
    SheenRotation *sphere = create(SHEEN_BASIS_SH, 2 * N, 0), *hemisphere = create(SHEEN_BASIS_HSH, N, 60 * DEGREE);
    static Inner t[SHEEN_ORDER_MAX];
    for (int m = 0; m < N; ++m) t[m] = inner_products(N, m);
    for (int k = 0; k < 4; ++k) {
        SheenEuler e = euler(0, tilt[k] * DEGREE, 0);
        double differences = 0.0, squares = 0.0;
        for (int i = 0; i < N * N; ++i) {
            float v[N * N] = {0}, out[N * N], sh[4 * N * N], by_sphere[N * N];
            v[i] = 1.0f;
            sheen_rotation_apply(hemisphere, e, 1, v, out);
            to_sphere(N, t, v, sh);
            sheen_rotation_apply(sphere, e, 1, sh, sh);
            to_hemisphere(N, t, sh, by_sphere);
            squares += norm(N * N, out) * norm(N * N, out);
            for (int j = 0; j < N * N; ++j) out[j] -= by_sphere[j];
            differences += norm(N * N, out) * norm(N * N, out);
        }
        assert_true(fabs(sqrt(differences / squares) - error[k]) < 6e-4); // three digits
    }
    sheen_rotation_destroy(&sphere);
    sheen_rotation_destroy(&hemisphere);
}

// ---- both -------------------------------------------------------------------------------------------------------

static double dot(size_t size, const float a[], const float b[])
{
    double sum = 0.0;
    for (size_t i = 0; i < size; ++i) sum += (double)a[i] * (double)b[i];
    return sum;
}

static void test_transpose(void **state)
{
    (void)state;
    float x[256] = {0}, y[256] = {0}, ax[256], aty[256];
    for (int b = 0; b < 2; ++b) {
        unsigned n = b ? 16 : 10;
        SheenRotation *r = create(b ? SHEEN_BASIS_SH : SHEEN_BASIS_HSH, n, 25 * DEGREE);
        for (uint32_t i = 0; i < 20; ++i) {
            SheenEuler e = euler(3 * random_unit(i), 24.6 * DEGREE * random_unit(i + 20), 3 * random_unit(i + 40));
            random_vector(n, i, x);
            random_vector(n, i + 100, y);
            sheen_rotation_apply(r, e, 1, x, ax);
            sheen_rotation_apply(r, euler_inverse(e), 1, y, aty);
            double scale = norm(basis_size(n), x) * norm(basis_size(n), y);
            assert_true(fabs(dot(basis_size(n), ax, y) - dot(basis_size(n), x, aty)) < 1e-6 * scale);
        }
        sheen_rotation_destroy(&r);
    }
}

static void test_channels_and_in_place(void **state)
{
    (void)state;
    float v[3][100], colors[300], out[300];
    for (int b = 0; b < 2; ++b) {
        SheenRotation *r = create(b ? SHEEN_BASIS_SH : SHEEN_BASIS_HSH, 10, 25 * DEGREE);
        SheenEuler e = euler(1, 0.2, -2);
        for (uint32_t c = 0; c < 3; ++c) {
            random_vector(10, c, v[c]);
            for (size_t i = 0; i < 100; ++i) colors[3 * i + c] = v[c][i];
            sheen_rotation_apply(r, e, 1, v[c], v[c]);
        }
        sheen_rotation_apply(r, e, 3, colors, out);
        sheen_rotation_apply(r, e, 3, colors, colors);
        for (size_t i = 0; i < 300; ++i) assert_true(out[i] == v[i % 3][i / 3] && colors[i] == out[i]);
        sheen_rotation_destroy(&r);
        assert_null(r);
    }
}

static void test_limits(void **state)
{
    (void)state;
    SheenRotation *r;
    assert_int_equal(sheen_rotation_create(SHEEN_BASIS_SH, 0, 0, &r), SHEEN_ERR_INVALID);
    assert_null(r);
    assert_int_equal(sheen_rotation_create(SHEEN_BASIS_SH, SHEEN_ORDER_MAX + 1, 0, &r), SHEEN_ERR_INVALID);
    assert_int_equal(sheen_rotation_create(SHEEN_BASIS_HSH, SHEEN_TILT_ORDER_MAX + 1, 0, &r), SHEEN_ERR_INVALID);
    sheen_rotation_destroy(&r);
    sheen_rotation_destroy(NULL);
    const float broken[] = {NAN, INFINITY, -INFINITY, -1, 0};
    float v[16] = {0}, out[16];
    random_vector(4, 0, v);
    for (int b = 0; b < 2; ++b)
        for (int i = 0; i < 5; ++i) {
            r = create(b ? SHEEN_BASIS_SH : SHEEN_BASIS_HSH, 4, i < 2 ? 0.1 : (double)broken[i]);
            Vec2 a = v2(broken[i], 1), c = v2(0, broken[i]);
            sheen_rotation_apply(r, (SheenEuler){c, a, a}, 1, v, out);
            sheen_rotation_apply(r, (SheenEuler){a, c, a}, 1, v, out);
            sheen_rotation_destroy(&r);
        }
    r = create(SHEEN_BASIS_HSH, 2, (double)NAN);
    sheen_rotation_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_frames),
        cmocka_unit_test(test_about_z),
        cmocka_unit_test(test_sphere_pointwise),
        cmocka_unit_test(test_sphere_recurrence),
        cmocka_unit_test(test_reference_values),
        cmocka_unit_test(test_tilts),
        cmocka_unit_test(test_energy),
        cmocka_unit_test(test_inner_products),
        cmocka_unit_test(test_tilt_by_sphere),
        cmocka_unit_test(test_transpose),
        cmocka_unit_test(test_channels_and_in_place),
        cmocka_unit_test(test_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
