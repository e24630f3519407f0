// SPDX-License-Identifier: Apache-2.0
// Irradiance records: weight, where they serve, what they predict, clamping of their radii.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/hash.h"
#include "cache/irradiance_cache.h"
#include "math/frame.h"

#include <stdlib.h>

static const float A = 0.15f;
static const Bounds box = {{-1.0f, -1.0f, -1.0f}, {1.0f, 1.0f, 1.0f}};

static float random_unit(uint32_t i, uint32_t use)
{
    return hash_to_unit(hash_combine(i, use));
}
static Vec3 random_point(uint32_t i)
{
    return v3(2.0f * random_unit(i, 0) - 1.0f, 2.0f * random_unit(i, 1) - 1.0f, 2.0f * random_unit(i, 2) - 1.0f);
}
static Vec3 random_normal(uint32_t i)
{
    return v3_normalize(v3(random_unit(i, 3) - 0.5f, random_unit(i, 4) - 0.5f, random_unit(i, 5) - 0.5f));
}
// n turned by `angle` about an axis across it.
static Vec3 turned(Vec3 n, float angle)
{
    Frame f = frame_from_normal(n);
    return v3_add(v3_scale(n, cosf(angle)), v3_scale(f.t, sinf(angle)));
}

static SheenIrradianceCache *cache_begin(bool clamping)
{
    SheenIrradianceCache *c = NULL;
    assert_int_equal(sheen_irradiance_cache_create(A, clamping, &box, &c), SHEEN_OK);
    return c;
}
/** A record and its light. */
typedef struct Lit {
    Record at;
    IrradianceLight light;
} Lit;
static void insert(SheenIrradianceCache *c, const Lit *r)
{
    assert_int_equal(sheen_irradiance_cache_insert(c, &r->at, &r->light), SHEEN_OK);
}
static Lit flat_record(Vec3 p, Vec3 n, float R, float E)
{
    return (Lit){{.p = p, .n = n, .R = R, .a = A, .R_min = 0.0f, .R_sure = R}, {.E = rgb_gray(E)}};
}
static Rgb predict(const Lit *r, Vec3 p, Vec3 n)
{
    return irradiance_predict(&r->at, &r->light, p, n);
}
static Rgb interpolate(const SheenIrradianceCache *c, const Contributors *found, Vec3 p, Vec3 n)
{
    return sheen_irradiance_interpolate(c->store, c->light, found, p, n);
}

// ---- one record -------------------------------------------------------------------------------------------------

static void test_weight(void **state)
{
    (void)state;
    // 1 / (0.2 / 2 + sqrt(1 - cos 5 degrees)), computed in double precision.
    float cos5 = cosf(5.0f * SHEEN_PI / 180.0f);
    // 1 - cos is known to one part in 60,000 only when the cosine is a float.
    assert_true(fabs((double)record_weight(2.0f, 0.04f, cos5) - 6.184784187721485) < 2e-4);
    assert_true(fabsf(record_weight(2.0f, 0.04f, 1.0f) - 10.0f) < 1e-5f);
    assert_true(isinf(record_weight(2.0f, 0.0f, 1.0f)));
    assert_true(isinf(record_weight(2.0f, 0.0f, 1.0000001f))); // rounding makes no NaN of equal normals
    assert_true(record_weight(2.0f, 0.0f, 0.0f) == 1.0f);
    assert_true(record_weight(2.0f, 0.0f, -1.0f) < 1.0f); // the other side of a wall is out of reach for every a <= 1
}

// A plane far from the origin: rounding puts its points in front of each other and behind. All pass; a step pitted
// clearly below the record's plane does not, one above does.
static void test_records_in_front(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 2000; ++i) {
        Vec3 n = random_normal(i), q = v3_scale(random_point(i), 30.0f);
        Frame f = frame_from_normal(n);
        Lit r = flat_record(q, n, 1.0f, 1.0f);
        float x = A * (random_unit(i, 6) - 0.5f), y = A * (random_unit(i, 7) - 0.5f);
        Vec3 p = v3_mad(v3_mad(q, x, f.t), y, f.b);
        assert_false(record_in_front(&r.at, p, n));
        assert_true(record_in_front(&r.at, v3_mad(p, -0.05f * A, n), n));
        assert_false(record_in_front(&r.at, v3_mad(p, -0.01f * A, n), n)); // within the tolerance
        assert_false(record_in_front(&r.at, v3_mad(p, 0.05f * A, n), n));
    }
}

// E = c + g.p per channel: the extrapolation is exact but for rounding.
static void test_translation_is_exact_for_linear_fields(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 1000; ++i) {
        Vec3 n = random_normal(i), q = random_point(i);
        Frame f = frame_from_normal(n);
        Lit r = {.at = {.p = q, .n = n, .R = 1.0f}};
        float E[3];
        for (uint32_t c = 0; c < 3; ++c) {
            r.light.translation[c] =
                v3_add(v3_scale(f.t, random_unit(i, 10 + c)), v3_scale(f.b, -random_unit(i, 20 + c)));
            E[c] = 3.0f + v3_dot(r.light.translation[c], q);
        }
        r.light.E = rgb(E[0], E[1], E[2]);
        Vec3 p = v3_mad(v3_mad(q, 0.2f * random_unit(i, 6), f.t), 0.2f * random_unit(i, 7), f.b);
        Rgb got = predict(&r, p, n);
        float value[3] = {got.r, got.g, got.b};
        for (int c = 0; c < 3; ++c) assert_true(fabsf(value[c] - 3.0f - v3_dot(r.light.translation[c], p)) < 4e-6f);
    }
}

// Sky of radiance 1 + s.d in direction d: E(n) = pi + 2 pi / 3 s.n, and the gradient of rotation is the integral of
// L (n x d) over the hemisphere, 2 pi / 3 n x s. What is left is of second order: 2 pi / 3 |s.n| (1 - cos).
static void test_rotation_is_first_order(void **state)
{
    (void)state;
    Vec3 s = v3(0.3f, -0.5f, 0.4f);
    for (uint32_t i = 0; i < 1000; ++i) {
        Vec3 n = random_normal(i), m = turned(n, 0.2f * random_unit(i, 6));
        Vec3 gradient = v3_scale(v3_cross(n, s), 2.0f * SHEEN_PI / 3.0f);
        float E = SHEEN_PI + 2.0f * SHEEN_PI / 3.0f * v3_dot(s, n);
        Lit r = {{.n = n, .R = 1.0f}, {.E = rgb_gray(E), .rotation = {gradient, gradient, gradient}}};
        float exact = SHEEN_PI + 2.0f * SHEEN_PI / 3.0f * v3_dot(s, m), got = predict(&r, r.at.p, m).g;
        float left = 2.0f * SHEEN_PI / 3.0f * fabsf(v3_dot(s, n)) * (1.0f - v3_dot(n, m));
        assert_true(fabsf(got - exact) <= left + 4e-6f);
    }
}

static void test_never_negative(void **state)
{
    (void)state;
    Lit r = flat_record(v3(0, 0, 0), v3(0, 0, 1), 1.0f, 1.0f);
    r.light.translation[0] = v3(-100, 0, 0);
    r.light.translation[1] = v3(100, 0, 0);
    r.light.rotation[2] = v3(0, -100, 0);
    Rgb E = predict(&r, v3(0.1f, 0, 0), v3_normalize(v3(0.2f, 0, 1)));
    assert_true(E.r == 0.0f && E.b == 0.0f);
    assert_true(fabsf(E.g - 11.0f) < 1e-4f);
}

// ---- many records -----------------------------------------------------------------------------------------------

static void fill_random(SheenIrradianceCache *c, uint32_t n, Lit copy[])
{
    for (uint32_t i = 0; i < n; ++i) {
        float R = 0.2f * expf(3.0f * random_unit(i, 8));
        copy[i] = flat_record(random_point(i), turned(v3(0, 0, 1), 0.1f * random_unit(i, 9)), R, random_unit(i, 10));
        copy[i].at.R_min = R * random_unit(i, 11);
        insert(c, &copy[i]);
    }
}

// Whether a record serves a point, by its definition; 0 when rounding decides.
static int serves(const Record *r, Vec3 p, Vec3 n)
{
    float d2 = v3_length2(v3_sub(p, r->p)), over = record_weight(r->R, d2, v3_dot(n, r->n)) - 1.0f / A;
    float height = v3_dot(v3_sub(p, r->p), v3_add(n, r->n)) * 0.5f + 0.02f * A * r->R;
    if (fabsf(over) < 1e-3f || fabsf(height) < 1e-6f) return 0;
    return over > 0.0f && height > 0.0f ? 1 : -1;
}

static void find_against_all(bool clamping)
{
    enum { N = 1500 };
    static Lit made[N];
    SheenIrradianceCache *c = cache_begin(clamping);
    fill_random(c, N, made);
    size_t found_any = 0;
    for (uint32_t i = 0; i < 2000; ++i) {
        Vec3 p = random_point(i + N), n = turned(v3(0, 0, 1), 0.1f * random_unit(i, 12));
        Contributors found;
        sheen_store_find(c->store, p, n, &found);
        assert_in_range(found.n, 0, SHEEN_CONTRIBUTORS_MAX - 1); // all of them fit
        unsigned char met[N] = {0};
        float sum = 0.0f;
        for (unsigned k = 0; k < found.n; ++k) {
            const Record *r = &c->store->records[found.record[k]];
            met[found.record[k]] = 1;
            sum += found.weight[k];
            float w = record_weight(r->R, v3_length2(v3_sub(p, r->p)), v3_dot(n, r->n)) - 1.0f / A;
            assert_true(found.weight[k] > 0.0f && fabsf(found.weight[k] - w) <= 1e-5f * w);
        }
        assert_true(fabsf(sum - found.weight_sum) <= 1e-5f * sum);
        for (uint32_t j = 0; j < N; ++j) {
            const Record *r = &c->store->records[j];
            int expected = serves(r, p, n);
            if (expected) assert_int_equal(met[j], expected > 0);
        }
        found_any += found.n > 0;
    }
    assert_true(found_any > 300); // the comparison was about something
    sheen_irradiance_cache_destroy(&c);
    assert_null(c);
}

static void test_find(void **state)
{
    (void)state;
    find_against_all(false);
    find_against_all(true);
}

static void test_empty_cache(void **state)
{
    (void)state;
    SheenIrradianceCache *c = cache_begin(false);
    Contributors found;
    sheen_store_find(c->store, v3(0, 0, 0), v3(0, 0, 1), &found);
    assert_int_equal(found.n, 0);
    assert_true(found.weight_sum == 0.0f);
    assert_true(rgb_is_black(interpolate(c, &found, v3(0, 0, 0), v3(0, 0, 1))));
    sheen_irradiance_cache_destroy(&c);
    sheen_irradiance_cache_destroy(NULL);
}

// More records than a point has room for: the lightest are left out, none is written past the end.
static void test_too_many_contributors(void **state)
{
    (void)state;
    SheenIrradianceCache *c = cache_begin(false);
    for (uint32_t i = 0; i < 100; ++i) {
        Lit r = flat_record(v3(1e-4f * (float)i, 0, 0), v3(0, 0, 1), 1.0f, 2.0f);
        insert(c, &r);
    }
    Contributors found;
    sheen_store_find(c->store, v3(0, 0, 0), v3(0, 0, 1), &found);
    assert_int_equal(found.n, SHEEN_CONTRIBUTORS_MAX);
    assert_true(fabsf(interpolate(c, &found, v3(0, 0, 0), v3(0, 0, 1)).r - 2.0f) < 1e-5f);
    sheen_irradiance_cache_destroy(&c);
}

// A small record among more large ones than there is room for, which the octree meets first: it weighs more than all of
// them at its place, and must be there.
static void test_small_record_among_many_large(void **state)
{
    (void)state;
    SheenIrradianceCache *c = cache_begin(false);
    for (uint32_t i = 0; i < 100; ++i) {
        Lit large = flat_record(v3(0.05f + 1e-4f * (float)i, 0, 0), v3(0, 0, 1), 1.0f, 100.0f);
        insert(c, &large);
    }
    Lit small = flat_record(v3(0, 0, 0), v3(0, 0, 1), 0.01f, 1.0f);
    insert(c, &small);
    Contributors found;
    sheen_store_find(c->store, v3(0, 0, 0), v3(0, 0, 1), &found);
    assert_int_equal(found.n, SHEEN_CONTRIBUTORS_MAX);
    // 31 others weigh at most 1 / .05 - 1 / .15 = 13.3 each beside its million, and say 100 times as much: 1.04.
    assert_true(fabsf(interpolate(c, &found, v3(0, 0, 0), v3(0, 0, 1)).r - 1.0f) < 0.05f);
    float sum = 0.0f;
    for (unsigned i = 0; i < found.n; ++i) sum += found.weight[i];
    assert_true(fabsf(sum / found.weight_sum - 1.0f) < 1e-5f); // floats, of which some were taken back
    sheen_irradiance_cache_destroy(&c);
}

static void test_interpolation_at_a_record(void **state)
{
    (void)state;
    SheenIrradianceCache *c = cache_begin(false);
    Lit r = flat_record(v3(0, 0, 0), v3(0, 0, 1), 1.0f, 1.0f);
    insert(c, &r);
    r = flat_record(v3(0.05f, 0, 0), v3(0, 0, 1), 1.0f, 3.0f);
    insert(c, &r);
    Contributors found;
    for (int i = 0; i < 2; ++i) {
        const Record *at = &c->store->records[i];
        sheen_store_find(c->store, at->p, at->n, &found);
        assert_int_equal(found.n, 2);
        // The other's weight is 1 / 0.05 - 1 / 0.15 against a million.
        Rgb E = interpolate(c, &found, at->p, at->n);
        assert_true(fabsf(E.g - c->light[i].E.g) < 1e-4f);
    }
    // Half way both count alike.
    Vec3 middle = v3(0.025f, 0, 0);
    sheen_store_find(c->store, middle, r.at.n, &found);
    assert_true(fabsf(interpolate(c, &found, middle, r.at.n).g - 2.0f) < 1e-4f);
    sheen_irradiance_cache_destroy(&c);
}

// A record of 1 among one of 0 that reaches farther: along a line and along a turn the mean has no step where the
// influence of the first ends. A weight of 1/a there would make it one of about a half.
static void test_no_seams(void **state)
{
    (void)state;
    SheenIrradianceCache *c = cache_begin(false);
    Vec3 up = v3(0, 0, 1);
    Lit near = flat_record(v3(0, 0, 0), up, 1.0f, 1.0f), far = flat_record(v3(0.02f, 0, 0), up, 2.0f, 0.0f);
    insert(c, &near);
    far.at.n = turned(up, 0.08f);
    insert(c, &far);
    enum { STEPS = 2000 };
    for (int way = 0; way < 2; ++way) {
        float before = 1.0f;
        bool ended = false;
        for (int i = 0; i <= STEPS; ++i) {
            float t = (float)i / STEPS;
            Vec3 p = way ? v3(0, 0, 0) : v3(0.2f * t, 0, 0);
            Vec3 n = way ? turned(up, 0.25f * t) : up;
            Contributors found;
            sheen_store_find(c->store, p, n, &found);
            assert_in_range(found.n, 1, 2);
            float E = interpolate(c, &found, p, n).g;
            // The function falls from 1 to 0 with a slope of some 10 at most: 0.005 a step.
            assert_true(fabsf(E - before) < 0.02f);
            before = E;
            ended = ended || found.n == 1;
        }
        assert_true(ended && before == 0.0f); // the end of the influence lies on the way
    }
    sheen_irradiance_cache_destroy(&c);
}

// ---- neighbor clamping ------------------------------------------------------------------------------------------

static void test_clamping_keeps_the_triangle_inequality(void **state)
{
    (void)state;
    enum { N = 600 };
    static Lit made[N];
    SheenIrradianceCache *c = cache_begin(true);
    fill_random(c, N, made);
    size_t shrunk = 0, held = 0;
    for (uint32_t i = 0; i < N; ++i) {
        const Record *r = &c->store->records[i];
        assert_true(r->R >= made[i].at.R_min && r->R <= made[i].at.R);
        shrunk += r->R < made[i].at.R;
        held += r->R == made[i].at.R_min;
        for (uint32_t j = 0; j < N && r->R > r->R_min; ++j) {
            float d = v3_length(v3_sub(r->p, c->store->records[j].p));
            assert_true(r->R <= (c->store->records[j].R + d) * 1.000001f);
        }
    }
    assert_true(shrunk > N / 10 && held > 10);
    sheen_irradiance_cache_destroy(&c);
}

// A corner's small record and a wall's large one know each other in either order of insertion.
static void test_clamping_in_either_order(void **state)
{
    (void)state;
    for (int order = 0; order < 2; ++order) {
        SheenIrradianceCache *c = cache_begin(true);
        Lit small = flat_record(v3(0, 0, 0), v3(0, 0, 1), 0.1f, 1.0f);
        Lit large = flat_record(v3(0.5f, 0, 0), v3(0, 0, 1), 4.0f, 1.0f);
        insert(c, order ? &small : &large);
        insert(c, order ? &large : &small);
        assert_true(c->store->records[order ? 0 : 1].R == 0.1f);
        assert_true(fabsf(c->store->records[order ? 1 : 0].R - 0.6f) < 1e-6f);
        sheen_irradiance_cache_destroy(&c);
    }
}

static void test_without_clamping_radii_stay(void **state)
{
    (void)state;
    enum { N = 600 };
    static Lit made[N];
    SheenIrradianceCache *c = cache_begin(false);
    fill_random(c, N, made);
    assert_int_equal(c->store->n, N);
    for (uint32_t i = 0; i < N; ++i) assert_memory_equal(&c->store->records[i], &made[i].at, sizeof made[i].at);
    sheen_irradiance_cache_destroy(&c);
}

static void test_bytes(void **state)
{
    (void)state;
    SheenIrradianceCache *c = cache_begin(false);
    uint64_t before = sheen_irradiance_cache_bytes(c);
    for (uint32_t i = 0; i < 2000; ++i) {
        Lit r = flat_record(random_point(i), v3(0, 0, 1), 0.3f, 1.0f);
        insert(c, &r);
        uint64_t now = sheen_irradiance_cache_bytes(c);
        assert_true(now >= before + sizeof r);
        before = now;
    }
    sheen_irradiance_cache_destroy(&c);
}

// A dark record whose own radius is a third of the least: beside an open one it decides within its own reach alone;
// where nothing else reaches it is better than nothing, but a point wants two of its kind.
static void test_enlarged_record(void **state)
{
    (void)state;
    SheenIrradianceCache *c = cache_begin(false);
    Vec3 n = v3(0, 0, 1);
    Lit dark = flat_record(v3(0, 0, 0), n, 0.3f, 0.0f), open = flat_record(v3(0.35f * A, 0, 0), n, 1.0f, 1.0f);
    dark.at.R_min = 0.3f;
    dark.at.R_sure = 0.1f;
    insert(c, &dark);
    Contributors found;
    sheen_store_find(c->store, v3(-0.2f * A, 0, 0), n, &found);
    assert_int_equal(found.n, 1);
    assert_int_equal(found.cover, 1);
    insert(c, &dark);
    sheen_store_find(c->store, v3(-0.2f * A, 0, 0), n, &found);
    assert_int_equal(found.cover, 2);
    insert(c, &open);
    // Between the dark record's own reach and its enlarged one the open record says what is there, to a thousandth.
    sheen_store_find(c->store, v3(0.2f * A, 0, 0), n, &found);
    assert_int_equal(found.n, 3);
    assert_true(interpolate(c, &found, v3(0.2f * A, 0, 0), n).g > 0.997f);
    // At the dark record it is dark.
    sheen_store_find(c->store, v3(1e-4f * A, 0, 0), n, &found);
    assert_true(interpolate(c, &found, v3(1e-4f * A, 0, 0), n).g < 0.01f);
    sheen_irradiance_cache_destroy(&c);
}

// A record in a slit, far narrower than what the picture resolves, leaves its neighbors their radii; a contact's does
// not.
static void test_slivers_clamp_nobody(void **state)
{
    (void)state;
    for (int sliver = 0; sliver < 2; ++sliver) {
        SheenIrradianceCache *c = cache_begin(true);
        Vec3 n = v3(0, 0, 1);
        Lit open = flat_record(v3(0.1f, 0, 0), n, 1.0f, 1.0f), small = flat_record(v3(0, 0, 0), n, 0.2f, 0.0f);
        small.at.R_min = 0.2f;
        small.at.R_sure = sliver ? 0.02f : 0.1f;
        open.at.R_min = 0.2f;
        insert(c, &open);
        insert(c, &small);
        insert(c, &open);
        // R_min of the small record plus the distance.
        assert_true(fabsf(c->store->records[0].R - (sliver ? 1.0f : 0.3f)) < 1e-6f);
        assert_true(fabsf(c->store->records[2].R - (sliver ? 1.0f : 0.3f)) < 1e-6f);
        assert_true(c->store->records[1].R == 0.2f);
        sheen_irradiance_cache_destroy(&c);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_weight),
        cmocka_unit_test(test_records_in_front),
        cmocka_unit_test(test_translation_is_exact_for_linear_fields),
        cmocka_unit_test(test_rotation_is_first_order),
        cmocka_unit_test(test_never_negative),
        cmocka_unit_test(test_find),
        cmocka_unit_test(test_empty_cache),
        cmocka_unit_test(test_too_many_contributors),
        cmocka_unit_test(test_small_record_among_many_large),
        cmocka_unit_test(test_interpolation_at_a_record),
        cmocka_unit_test(test_no_seams),
        cmocka_unit_test(test_clamping_keeps_the_triangle_inequality),
        cmocka_unit_test(test_clamping_in_either_order),
        cmocka_unit_test(test_without_clamping_radii_stay),
        cmocka_unit_test(test_enlarged_record),
        cmocka_unit_test(test_slivers_clamp_nobody),
        cmocka_unit_test(test_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
