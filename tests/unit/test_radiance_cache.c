// SPDX-License-Identifier: Apache-2.0
// Radiance records: what a lobe makes of their light, against sums and integrals that know nothing of the cache.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/hash.h"
#include "cache/radiance_cache.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const float A = 0.3f;
static const Bounds box = {{-2.0f, -2.0f, -2.0f}, {2.0f, 2.0f, 2.0f}};

static float random_unit(uint32_t i, uint32_t use)
{
    return hash_to_unit(hash_combine(i, use));
}
static float random_signed(uint32_t i, uint32_t use)
{
    return 2.0f * random_unit(i, use) - 1.0f;
}
static Vec3 random_vector(uint32_t i, uint32_t use)
{
    return v3(random_signed(i, use), random_signed(i, use + 1), random_signed(i, use + 2));
}
static Vec3 random_normal(uint32_t i)
{
    return v3_normalize(random_vector(i, 3));
}
// n turned by some degrees in the direction of azimuth phi of its frame.
static Vec3 turned(Vec3 n, float degrees, float phi)
{
    float angle = degrees * SHEEN_PI / 180.0f;
    Frame f = frame_from_normal(n);
    return frame_to_world(&f, v3(sinf(angle) * cosf(phi), sinf(angle) * sinf(phi), cosf(angle)));
}

static SheenRadianceCache *cache_begin(SheenBasis basis, unsigned order, bool tilted)
{
    SheenRadianceCache *c = NULL;
    assert_int_equal(sheen_radiance_cache_create(basis, order, tilted, A, false, &box, &c), SHEEN_OK);
    return c;
}

/** A record's light as the formulas have it: coefficients and their derivatives. */
typedef struct Light {
    Rgb part[3][SHEEN_BASIS_MAX];
} Light;

static void insert(SheenRadianceCache *c, Vec3 p, Vec3 n, const Light *light)
{
    float *padded = calloc(radiance_light_floats(c), sizeof *padded);
    assert_non_null(padded);
    size_t size = basis_size(c->order) * sizeof(Rgb);
    for (size_t i = 0; i < 3; ++i) memcpy(padded + i * c->stride, light->part[i], size);
    Record r = {.p = p, .n = n, .R = 1.0f, .a = A, .R_sure = 1.0f};
    assert_int_equal(sheen_radiance_cache_insert(c, &r, padded), SHEEN_OK);
    free(padded);
}

// The lobe's coefficients are handed over in a block of their own size, so that a sanitizer sees what reads beyond.
static Rgb reflect(const SheenRadianceCache *c, const Contributors *found, Vec3 p, Vec3 n, unsigned order,
                   const Rgb lobe[])
{
    Rgb *own = malloc(basis_size(order) * sizeof *own);
    assert_non_null(own);
    memcpy(own, lobe, basis_size(order) * sizeof *own);
    Rgb L = sheen_radiance_reflect(c, found, p, n, &(RadianceLobe){order, own});
    free(own);
    return L;
}

static Rgb find_and_reflect(const SheenRadianceCache *c, Vec3 p, Vec3 n, unsigned order, const Rgb lobe[])
{
    Contributors found;
    sheen_store_find(c->store, p, n, &found);
    assert_true(found.n > 0);
    return reflect(c, &found, p, n, order, lobe);
}

static void random_coefficients(uint32_t seed, float size, Rgb out[])
{
    for (uint32_t i = 0; i < SHEEN_BASIS_MAX; ++i) {
        Vec3 v = v3_scale(random_vector(hash_combine(seed, i), 40), size);
        out[i] = rgb(v.x, v.y, v.z);
    }
}

static bool near_enough(Rgb a, Rgb b, float slack)
{
    return fabsf(a.r - b.r) <= slack && fabsf(a.g - b.g) <= slack && fabsf(a.b - b.b) <= slack;
}

// ---- the sum ----------------------------------------------------------------------------------------------------

static const unsigned orders[] = {1, 2, 3, 5, 7, 9, 10};
enum { N_ORDERS = sizeof orders / sizeof *orders };

// What is stated in the header, in double precision, for records whose frame is the lobe's.
static Rgb expected_sum(const SheenRadianceCache *c, const Contributors *found, Vec3 p, const Light light[],
                        unsigned order, const Rgb lobe[])
{
    double sum[3] = {0, 0, 0}, weights = 0;
    for (unsigned i = 0; i < found->n; ++i) {
        const Record *r = &c->store->records[found->record[i]];
        Frame f = frame_from_normal(r->n);
        Vec3 d = frame_to_local(&f, v3_sub(p, r->p));
        const Light *l = &light[found->record[i]];
        for (size_t k = 0; k < basis_size(order); ++k) {
            Rgb moved = rgb_mad(rgb_mad(l->part[0][k], d.x, l->part[1][k]), d.y, l->part[2][k]);
            Rgb product = rgb_mul(lobe[k], moved);
            sum[0] += (double)(found->weight[i] * product.r);
            sum[1] += (double)(found->weight[i] * product.g);
            sum[2] += (double)(found->weight[i] * product.b);
        }
        weights += (double)found->weight[i];
    }
    return rgb((float)(sum[0] / weights), (float)(sum[1] / weights), (float)(sum[2] / weights));
}

enum { N_RECORDS = 4 };

// Light that is linear in the position is exact: four records of one plane, whose light and gradients are any, all
// orders of the cache and of the lobe, those that leave padding between the parts of a record's light among them.
static void check_sums(SheenBasis basis, unsigned order, uint32_t seed)
{
    static Light light[N_RECORDS];
    static Rgb lobe[SHEEN_BASIS_MAX];
    SheenRadianceCache *c = cache_begin(basis, order, false);
    Vec3 n = random_normal(seed), p0 = v3_scale(random_vector(seed, 20), 0.5f);
    Frame f = frame_from_normal(n);
    for (uint32_t i = 0; i < N_RECORDS; ++i) {
        for (uint32_t k = 0; k < 3; ++k) random_coefficients(hash_combine(seed, 8 * i + k), 1.0f, light[i].part[k]);
        light[i].part[0][0] = rgb_gray(100.0f); // above zero, which the sum is cut at
        insert(c, v3_mad(v3_mad(p0, 0.1f * random_signed(seed, 60 + i), f.t), 0.1f * random_signed(seed, 70 + i), f.b),
               n, &light[i]);
    }
    for (unsigned lobe_order = 1; lobe_order <= order; ++lobe_order) {
        random_coefficients(hash_combine(seed, 99 + lobe_order), 1.0f, lobe);
        lobe[0] = rgb_gray(1.0f);
        Vec3 p = v3_mad(v3_mad(p0, 0.05f * random_signed(seed, 80), f.t), 0.05f * random_signed(seed, 81), f.b);
        Contributors found;
        sheen_store_find(c->store, p, n, &found);
        assert_int_equal(found.n, N_RECORDS);
        Rgb got = reflect(c, &found, p, n, lobe_order, lobe);
        // Sums of up to 100 products of size 1 beside 100 in floats.
        assert_true(near_enough(got, expected_sum(c, &found, p, light, lobe_order, lobe), 2e-4f));
    }
    sheen_radiance_cache_destroy(&c);
}

static void test_sum_over_records(void **state)
{
    (void)state;
    for (int basis = 0; basis < SHEEN_BASIS_COUNT; ++basis)
        for (uint32_t i = 0; i < N_ORDERS; ++i)
            for (uint32_t k = 0; k < 10; ++k) check_sums((SheenBasis)basis, orders[i], 100 * i + k);
    check_sums(SHEEN_BASIS_HSH, SHEEN_TILT_ORDER_MAX, 1);
    check_sums(SHEEN_BASIS_SH, SHEEN_ORDER_MAX, 1);
}

// Spherical records are in the world's frame: whatever the normals, only the shift is in the record's.
static void test_spherical_records_of_other_normals(void **state)
{
    (void)state;
    static Light light[1];
    static Rgb lobe[SHEEN_BASIS_MAX];
    for (uint32_t i = 0; i < 100; ++i) {
        SheenRadianceCache *c = cache_begin(SHEEN_BASIS_SH, 7, false);
        for (uint32_t k = 0; k < 3; ++k) random_coefficients(hash_combine(i, k), 1.0f, light->part[k]);
        random_coefficients(hash_combine(i, 9), 1.0f, lobe);
        light->part[0][0] = rgb_gray(100.0f);
        lobe[0] = rgb_gray(1.0f);
        Vec3 p = v3_scale(random_vector(i, 20), 0.5f), n = random_normal(i);
        insert(c, p, n, light);
        Vec3 there = turned(n, 15.0f * random_unit(i, 33), 7.0f * random_unit(i, 34)), shift = random_vector(i, 30);
        bool in_front = v3_dot(shift, v3_add(n, there)) < 0.0f; // where the record serves nothing
        p = v3_mad(p, in_front ? -0.02f : 0.02f, shift);
        n = there;
        Contributors found;
        sheen_store_find(c->store, p, n, &found);
        assert_int_equal(found.n, 1);
        Rgb got = reflect(c, &found, p, n, 7, lobe);
        assert_true(near_enough(got, expected_sum(c, &found, p, light, 7, lobe), 2e-4f));
        sheen_radiance_cache_destroy(&c);
    }
}

// ---- integrals --------------------------------------------------------------------------------------------------

enum { ROWS = 60, COLUMNS = 120, CELLS = ROWS * COLUMNS };

/** Directions of equal solid angle over a hemisphere, and what is seen and reflected along them. */
typedef struct Hemi {
    Frame frame;
    Vec3 local[CELLS], there[CELLS]; // in the frame, in the world
    Rgb value[CELLS];
} Hemi;
static const float cell = 2.0f * SHEEN_PI / CELLS;

static void hemi_directions(Vec3 n, Hemi *h)
{
    h->frame = frame_from_normal(n);
    for (size_t i = 0; i < CELLS; ++i) {
        float z = ((float)(i / COLUMNS) + 0.5f) / ROWS, s = sqrtf(1.0f - z * z);
        float phi = 2.0f * SHEEN_PI * ((float)(i % COLUMNS) + 0.5f) / COLUMNS;
        h->local[i] = v3(s * cosf(phi), s * sinf(phi), z);
        h->there[i] = frame_to_world(&h->frame, h->local[i]);
    }
}

// Light from everywhere, with a soft bright side.
static Rgb radiance(Vec3 w)
{
    float bright = v3_dot(w, v3_normalize(v3(1.0f, -2.0f, 0.5f)));
    return rgb(1.0f + 0.7f * w.x, 1.0f + 0.5f * w.y * w.z, 0.5f + (bright > 0.0f ? bright * bright * bright : 0.0f));
}

// A Phong lobe times the cosine, in the world.
static Rgb phong(Vec3 r, Vec3 n, Vec3 w)
{
    float c = v3_dot(r, w), z = v3_dot(n, w);
    return c > 0.0f && z > 0.0f ? rgb_scale(rgb(1.0f, 0.5f, 0.25f), 1.5f * powf(c, 7.0f) * z) : rgb_gray(0.0f);
}

// Projects the values, hemispherical functions in the frame, spherical ones in the world.
// @return the root of the energy that order n misses, luminance
static double project(SheenBasis basis, unsigned n, const Hemi *h, Rgb out[])
{
    double all = 0, held = 0;
    sheen_basis_project(basis, n, CELLS, basis == SHEEN_BASIS_HSH ? h->local : h->there, h->value, out);
    for (size_t i = 0; i < basis_size(n); ++i) {
        out[i] = rgb_scale(out[i], cell);
        held += (double)(out[i].g * out[i].g);
    }
    for (size_t i = 0; i < CELLS; ++i) all += (double)(cell * h->value[i].g * h->value[i].g);
    return sqrt(fmax(all - held, 0.0));
}

// One record under `radiance`, and a Phong lobe there.
// The dot product of two projections is short of the integral by no more than the product of what both miss; the
// rules' own error is 1e-3 of about 1.
static void check_integral(SheenBasis basis, unsigned order, Vec3 n_record, Vec3 n, Vec3 r)
{
    static Hemi h;
    static Light light;
    static Rgb lobe[SHEEN_BASIS_MAX];
    memset(&light, 0, sizeof light);
    hemi_directions(n_record, &h);
    for (size_t i = 0; i < CELLS; ++i) h.value[i] = radiance(h.there[i]);
    double light_missing = project(basis, order, &h, light.part[0]);
    SheenRadianceCache *c = cache_begin(basis, order, false);
    insert(c, v3(0, 0, 0), n_record, &light);
    hemi_directions(n, &h);
    Rgb want = rgb_gray(0.0f);
    for (size_t i = 0; i < CELLS; ++i) {
        h.value[i] = phong(r, n, h.there[i]);
        want = rgb_mad(want, cell, rgb_mul(h.value[i], radiance(h.there[i])));
    }
    double lobe_missing = project(basis, order, &h, lobe);
    Rgb got = find_and_reflect(c, v3(0, 0, 0), n, order, lobe);
    double off = fabs((double)(got.g - want.g)), bound = light_missing * lobe_missing + 1e-3;
    if (!(off <= bound)) fprintf(stderr, "basis %d order %u: off %g, bound %g\n", (int)basis, order, off, bound);
    assert_true(off <= bound);
    if (order >= 9) assert_true(bound < 0.1 * (double)want.g); // or it says nothing
    sheen_radiance_cache_destroy(&c);
}

static void test_integral_of_lobe_and_light(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 24; ++i) {
        Vec3 n = random_normal(i), r = turned(n, 50.0f * random_unit(i, 30), 7.0f * random_unit(i, 31));
        for (int basis = 0; basis < SHEEN_BASIS_COUNT; ++basis)
            check_integral((SheenBasis)basis, orders[i % N_ORDERS], n, n, r);
    }
}

// The choice of the frame jumps where n.z changes its sign, by as much as a turn of 180 degrees: a wall that stands
// upright has normals on both sides of it, by rounding.
static void test_frames_of_upright_walls(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 24; ++i) {
        float phi = 2.0f * SHEEN_PI * (float)i / 24.0f, up = i % 2 ? 1e-9f : -1e-9f;
        Vec3 n = v3(cosf(phi), sinf(phi), up), other = v3(n.x, n.y, -up);
        Vec3 r = turned(n, 40.0f, 1.0f + (float)i);
        for (int basis = 0; basis < SHEEN_BASIS_COUNT; ++basis) {
            check_integral((SheenBasis)basis, 10, n, n, r);
            check_integral((SheenBasis)basis, 10, n, other, r);
        }
        check_integral(SHEEN_BASIS_HSH, 10, v3(n.x, n.y, 0.0f), v3(n.x, n.y, -0.0f), r);
    }
}

static Rgb sum_at(SheenBasis basis, unsigned n, const Rgb c[], Vec3 w)
{
    float y[SHEEN_BASIS_MAX];
    Rgb sum = rgb_gray(0.0f);
    sheen_basis_eval(basis, n, w, y);
    for (size_t i = 0; i < basis_size(n); ++i) sum = rgb_mad(sum, y[i], c[i]);
    return sum;
}

static double norm(unsigned n, const Rgb c[])
{
    double sum = 0;
    for (size_t i = 0; i < basis_size(n); ++i) sum += (double)(c[i].g * c[i].g);
    return sqrt(sum);
}

// A tilted facet: the integral of both sums over the directions above both horizons. The rotation interpolates between
// degrees, which is good to 1 % of any coefficients of order 10, and to a tenth of that where they fall off as these
// do.
static void check_tilt(Vec3 n_record, Vec3 n, Vec3 r, unsigned lobe_order, bool any_light)
{
    enum { ORDER = 10 };
    static Hemi h;
    static Light light;
    static Rgb lobe[SHEEN_BASIS_MAX];
    hemi_directions(n, &h);
    Frame here = h.frame;
    for (size_t k = 0; k < CELLS; ++k) h.value[k] = phong(r, n, h.there[k]);
    project(SHEEN_BASIS_HSH, lobe_order, &h, lobe);
    memset(&light, 0, sizeof light);
    hemi_directions(n_record, &h);
    for (size_t k = 0; k < CELLS; ++k) h.value[k] = radiance(h.there[k]);
    if (any_light)
        random_coefficients(7, 1.0f, light.part[0]);
    else
        project(SHEEN_BASIS_HSH, ORDER, &h, light.part[0]);
    if (any_light) light.part[0][0] = rgb_gray(4.0f); // above zero
    SheenRadianceCache *c = cache_begin(SHEEN_BASIS_HSH, ORDER, true);
    insert(c, v3(0, 0, 0), n_record, &light);
    Rgb want = rgb_gray(0.0f);
    for (size_t k = 0; k < CELLS; ++k) {
        Vec3 w = frame_to_local(&here, h.there[k]);
        Rgb L = sum_at(SHEEN_BASIS_HSH, ORDER, light.part[0], h.local[k]);
        if (w.z > 0.0f) want = rgb_mad(want, cell, rgb_mul(L, sum_at(SHEEN_BASIS_HSH, lobe_order, lobe, w)));
    }
    Rgb got = find_and_reflect(c, v3(0, 0, 0), n, lobe_order, lobe);
    double off = fabs((double)(got.g - want.g)) / (norm(lobe_order, lobe) * norm(ORDER, light.part[0]));
    if (getenv("SHEEN_SHOW")) fprintf(stderr, "tilt, lobe of order %u: off by %g\n", lobe_order, off);
    assert_true(off < 1e-3);
    sheen_radiance_cache_destroy(&c);
}

static void test_tilted_facets(void **state)
{
    (void)state;
    static const float tilt[] = {0.0f, 0.4f, 1.5f, 8.5f, 20.0f};
    for (uint32_t i = 0; i < sizeof tilt / sizeof *tilt; ++i) {
        Vec3 n_record = random_normal(i), n = turned(n_record, tilt[i], 1.0f + (float)i);
        Vec3 r = turned(n, 50.0f, 2.0f * (float)i);
        check_tilt(n_record, n, r, 10, false);
        check_tilt(n_record, n, r, 3 + i, false);
    }
    // At whole degrees any light will do: a lobe of few bands is one of all bands in the record's frame.
    for (uint32_t i = 0; i < 6; ++i) {
        Vec3 n = random_normal(i), r = turned(n, 50.0f, 2.0f * (float)i);
        check_tilt(turned(n, 4.0f * (float)i, 1.0f + (float)i), n, r, 2 + i, true);
    }
}

// ---- who serves whom --------------------------------------------------------------------------------------------

static unsigned contributors(const SheenRadianceCache *c, Vec3 n)
{
    Contributors found;
    sheen_store_find(c->store, v3(0, 0, 0), n, &found);
    return found.n;
}

static void test_which_facets_are_served(void **state)
{
    (void)state;
    static const Light dark;
    // 1 - cos < a^2 lets records serve up to 24.5 degrees for a = 0.3.
    for (uint32_t i = 0; i < 200; ++i) {
        Vec3 n = random_normal(i);
        float phi = 7.0f * random_unit(i, 30);
        for (int kind = 0; kind < 3; ++kind) {
            SheenRadianceCache *c = cache_begin(kind == 2 ? SHEEN_BASIS_SH : SHEEN_BASIS_HSH, 3, kind == 1);
            insert(c, v3(0, 0, 0), n, &dark);
            assert_int_equal(contributors(c, n), 1);
            assert_int_equal(contributors(c, turned(n, 0.4f, phi)), 1);
            assert_int_equal(contributors(c, turned(n, 0.6f, phi)), kind > 0);
            assert_int_equal(contributors(c, turned(n, 24.0f, phi)), kind > 0);
            assert_int_equal(contributors(c, turned(n, 25.0f, phi)), 0);
            assert_int_equal(contributors(c, v3_neg(n)), 0);
            sheen_radiance_cache_destroy(&c);
        }
    }
}

static void test_never_below_zero(void **state)
{
    (void)state;
    static Light light;
    static Rgb lobe[SHEEN_BASIS_MAX];
    for (uint32_t i = 0; i < 100; ++i) {
        SheenRadianceCache *c = cache_begin((SheenBasis)(i % 2), 5, true);
        for (uint32_t k = 0; k < 3; ++k) random_coefficients(hash_combine(i, k), 1.0f, light.part[k]);
        random_coefficients(hash_combine(i, 9), 1.0f, lobe);
        Vec3 n = random_normal(i);
        insert(c, v3(0, 0, 0), n, &light);
        Rgb a = find_and_reflect(c, v3(0, 0, 0), n, 5, lobe);
        for (size_t k = 0; k < 25; ++k) lobe[k] = rgb_scale(lobe[k], -1.0f);
        Rgb b = find_and_reflect(c, v3(0, 0, 0), n, 5, lobe);
        // Of a number and its negative one is cut, each colour for itself.
        assert_true(a.r >= 0.0f && a.g >= 0.0f && a.b >= 0.0f && b.r >= 0.0f && b.g >= 0.0f && b.b >= 0.0f);
        assert_true(a.r * b.r == 0.0f && a.g * b.g == 0.0f && a.b * b.b == 0.0f);
        assert_true(a.r + b.r > 0.0f && a.g + b.g > 0.0f && a.b + b.b > 0.0f);
        Contributors none = {0};
        assert_true(rgb_is_black(reflect(c, &none, v3(0, 0, 0), n, 5, lobe)));
        sheen_radiance_cache_destroy(&c);
    }
}

// ---- keeping ----------------------------------------------------------------------------------------------------

// Each record keeps its own light while the arrays grow.
static void test_growth(void **state)
{
    (void)state;
    enum { N = 1500 };
    static Light light;
    SheenRadianceCache *c = cache_begin(SHEEN_BASIS_HSH, 3, false);
    uint64_t bytes = sheen_radiance_cache_bytes(c), least = radiance_light_floats(c) * sizeof(float) + sizeof(Record);
    assert_true(radiance_light_floats(c) >= 3 * 3 * basis_size(3) && radiance_light_floats(c) <= 3 * (3 * 9 + 11));
    for (uint32_t i = 0; i < N; ++i) {
        for (uint32_t k = 0; k < 3; ++k) random_coefficients(hash_combine(i, k), 1.0f, light.part[k]);
        insert(c, random_vector(i, 20), random_normal(i), &light);
        assert_true(sheen_radiance_cache_bytes(c) >= bytes + least);
        bytes = sheen_radiance_cache_bytes(c);
    }
    assert_int_equal(c->store->n, N);
    for (uint32_t i = 0; i < N; ++i)
        for (uint32_t k = 0; k < 3; ++k) {
            random_coefficients(hash_combine(i, k), 1.0f, light.part[k]);
            const float *kept = c->light + i * radiance_light_floats(c) + k * c->stride;
            assert_memory_equal(kept, light.part[k], 9 * sizeof(Rgb));
            for (size_t j = 27; j < c->stride; ++j) assert_true(kept[j] == 0.0f);
        }
    sheen_radiance_cache_destroy(&c);
    assert_null(c);
    sheen_radiance_cache_destroy(&c);
}

static void test_orders_out_of_range(void **state)
{
    (void)state;
    static const struct {
        SheenBasis basis;
        unsigned order;
    } bad[] = {{SHEEN_BASIS_HSH, 0}, {SHEEN_BASIS_SH, 0}, {SHEEN_BASIS_HSH, 17}, {SHEEN_BASIS_SH, 33}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        SheenRadianceCache *c = NULL;
        assert_int_equal(sheen_radiance_cache_create(bad[i].basis, bad[i].order, true, A, false, &box, &c),
                         SHEEN_ERR_INVALID);
        assert_null(c);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sum_over_records),
        cmocka_unit_test(test_spherical_records_of_other_normals),
        cmocka_unit_test(test_integral_of_lobe_and_light),
        cmocka_unit_test(test_frames_of_upright_walls),
        cmocka_unit_test(test_tilted_facets),
        cmocka_unit_test(test_which_facets_are_served),
        cmocka_unit_test(test_never_below_zero),
        cmocka_unit_test(test_growth),
        cmocka_unit_test(test_orders_out_of_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
