// SPDX-License-Identifier: Apache-2.0
// Area lights: the points that sheen_light_sample draws follow the density that sheen_light_pdf_hit claims.
#include "unit/chi_squared.h"
#include "unit/light_scene.h"

#define N_SAMPLES 200000
#define SIDE 8       // bins a side of each patch
#define SUBDIVIDE 32 // midpoints a side of a bin, for the integral of the density over it

/** A patch of a light: a map of the unit square onto it. A light has one, or one a triangle. */
typedef struct Patch {
    const SheenShape *shape;
    uint32_t triangle;
    Frame frame; // sphere: z toward p
    double cap;  // sphere: height over radius of the cap that p sees
} Patch;

static Patch patch_of(const SheenShape *shape, uint32_t triangle, Vec3 p)
{
    Patch patch = {.shape = shape, .triangle = triangle};
    if (shape->kind == SHEEN_SHAPE_SPHERE) {
        Vec3 d = v3_sub(p, shape->sphere.center);
        double distance = (double)v3_length(d);
        patch.frame = frame_from_normal(distance > 0 ? v3_normalize(d) : v3(0, 0, 1));
        patch.cap = shape->sphere.flip ? 2 : 1 - (double)shape->sphere.radius / distance;
    }
    return patch;
}

// Point, front normal, and area over the area of the unit square.
static void patch_point(const Patch *patch, double s, double t, SurfacePoint *out, double *jacobian)
{
    const SheenShape *shape = patch->shape;
    *out = (SurfacePoint){.triangle = patch->triangle};
    if (shape->kind == SHEEN_SHAPE_MESH) {
        const uint32_t *v = shape->mesh.triangles[patch->triangle];
        Vec3 a = shape->mesh.p[v[0]], e1 = v3_sub(shape->mesh.p[v[1]], a), e2 = v3_sub(shape->mesh.p[v[2]], a);
        out->p = v3_mad(v3_mad(a, (float)(s * (1 - t)), e1), (float)t, e2);
        Vec3 n = v3_cross(e1, e2);
        out->ng = v3_normalize(n);
        *jacobian = (double)v3_length(n) * (1 - t);
        return;
    }
    double phi = 2 * (double)SHEEN_PI * t;
    if (shape->kind == SHEEN_SHAPE_DISK) {
        const SheenDisk *d = &shape->disk;
        double r = sqrt(s);
        out->p = v3_mad(v3_mad(d->center, (float)(r * cos(phi)), d->du), (float)(r * sin(phi)), d->dv);
        out->ng = d->n;
        *jacobian = (double)SHEEN_PI * (double)v3_length(v3_cross(d->du, d->dv));
    } else {
        const SheenSphere *b = &shape->sphere;
        double z = 1 - patch->cap * s, r = sqrt(fmax(1 - z * z, 0));
        Vec3 n = frame_to_world(&patch->frame, v3((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z));
        out->p = v3_mad(b->center, b->radius, n);
        out->ng = b->flip ? v3_neg(n) : n;
        *jacobian = 2 * patch->cap * (double)SHEEN_PI * (double)(b->radius * b->radius);
    }
}

// The place of a point on its patch, or above it by `off`; false when it is not there.
static bool patch_place(const Patch *patch, Vec3 q, double off, double *s, double *t)
{
    const SheenShape *shape = patch->shape;
    if (shape->kind == SHEEN_SHAPE_MESH) {
        const uint32_t *v = shape->mesh.triangles[patch->triangle];
        Vec3 a = shape->mesh.p[v[0]], e1 = v3_sub(shape->mesh.p[v[1]], a), e2 = v3_sub(shape->mesh.p[v[2]], a);
        Vec3 n = v3_cross(e1, e2), d = v3_sub(q, a);
        double n2 = (double)v3_length2(n);
        double b1 = (double)v3_dot(v3_cross(d, e2), n) / n2, b2 = (double)v3_dot(v3_cross(e1, d), n) / n2;
        *t = b2;
        *s = b2 < 1 ? b1 / (1 - b2) : 0;
        return fabs((double)v3_dot(d, n)) <= (1e-4 + off) * sqrt(n2) && b1 > -1e-4 && b2 > -1e-4 && b1 + b2 < 1.0001;
    }
    double x, y;
    if (shape->kind == SHEEN_SHAPE_DISK) {
        const SheenDisk *d = &shape->disk;
        Vec3 n = v3_cross(d->du, d->dv), c = v3_sub(q, d->center);
        double n2 = (double)v3_length2(n);
        x = (double)v3_dot(v3_cross(c, d->dv), n) / n2;
        y = (double)v3_dot(v3_cross(d->du, c), n) / n2;
        *s = x * x + y * y;
    } else {
        Vec3 n = frame_to_local(&patch->frame, v3_normalize(v3_sub(q, shape->sphere.center)));
        x = (double)n.x;
        y = (double)n.y;
        *s = (1 - (double)n.z) / patch->cap;
    }
    *t = atan2(y, x) / (2 * (double)SHEEN_PI);
    if (*t < 0) *t += 1;
    return true;
}

static int bin_of(double x)
{
    int i = (int)(x * SIDE);
    return i < 0 ? 0 : i >= SIDE ? SIDE - 1 : i;
}

// Expected share of the samples in each bin of a patch: the integral of the density over the directions to it.
static void expect(const LightScene *scene, const Patch *patch, Vec3 p, double out[SIDE * SIDE])
{
    double step = 1.0 / (SIDE * SUBDIVIDE);
    for (int i = 0; i < SIDE * SUBDIVIDE; ++i)
        for (int j = 0; j < SIDE * SUBDIVIDE; ++j) {
            SurfacePoint q;
            double jacobian;
            patch_point(patch, (i + 0.5) * step, (j + 0.5) * step, &q, &jacobian);
            Vec3 d = v3_sub(q.p, p);
            double d2 = (double)v3_length2(d), cosine = -(double)v3_dot(d, q.ng) / sqrt(d2);
            if (cosine <= 0) continue;
            double pdf = (double)sheen_light_pdf_hit(scene->lights, 0, p, &q);
            out[i / SUBDIVIDE * SIDE + j / SUBDIVIDE] += pdf * cosine / d2 * jacobian * step * step;
        }
}

// The only light of the scene, as seen from p. The samples that bring nothing are a bin of their own.
// @return the share of the samples that the density expects to bring something
static double check(const LightScene *scene, Vec3 p)
{
    enum { MAX_BINS = 12 * SIDE * SIDE + 1 };
    static double observed[MAX_BINS], expected[MAX_BINS];
    const SheenShape *shape = &scene->scene->shapes[0];
    uint32_t n_patches = shape->kind == SHEEN_SHAPE_MESH ? shape->mesh.n_triangles : 1;
    int n_bins = (int)n_patches * SIDE * SIDE;
    assert_true(n_bins < MAX_BINS);
    memset(observed, 0, sizeof observed);
    memset(expected, 0, sizeof expected);
    double sum = 0;
    Patch patches[12];
    for (uint32_t k = 0; k < n_patches; ++k) {
        patches[k] = patch_of(shape, k, p);
        expect(scene, &patches[k], p, expected + k * SIDE * SIDE);
    }
    for (int i = 0; i < n_bins; ++i) {
        sum += expected[i];
        expected[i] *= N_SAMPLES;
    }
    expected[n_bins] = fmax(1 - sum, 0) * N_SAMPLES;

    Random r = {1, 0};
    int n_unlike = 0;
    for (int i = 0; i < N_SAMPLES; ++i) {
        LightSample sample;
        if (!sheen_light_sample(scene->lights, 0, p, random_2d(&r), &sample)) {
            observed[n_bins] += 1;
            continue;
        }
        uint32_t k = 0;
        double s = 0, t = 0, off = 1e-6 * (double)v3_length(v3_sub(sample.target, p)); // as long rays are rounded
        while (k < n_patches && !patch_place(&patches[k], sample.target, off, &s, &t)) ++k;
        assert_true(k < n_patches);
        observed[k * SIDE * SIDE + (uint32_t)(bin_of(s) * SIDE + bin_of(t))] += 1;
        // The density of the sample is that of its point; the offset of the target moves it a little.
        SurfacePoint q = {.p = sample.target, .triangle = k};
        double pdf = (double)sheen_light_pdf_hit(scene->lights, 0, p, &q);
        n_unlike += !(fabs(pdf / (double)sample.pdf - 1) <= 2e-3);
        assert_true(fabs((double)v3_length(sample.wi) - 1) < 1e-5);
    }
    // A point on the edge of two triangles may be told to the wrong one.
    assert_true(n_unlike <= (n_patches > 1 ? N_SAMPLES / 500 : 0));
    double deviation = chi_squared_deviation((size_t)n_bins + 1, observed, expected);
    if (!(deviation < CHI_SQUARED_LIMIT))
        fail_msg("chi squared is %.1f deviations off; pdf sums to %.6f", deviation, sum);
    return sum;
}

static void assert_near(double got, double want, double tolerance)
{
    if (!(fabs(got - want) <= tolerance)) fail_msg("%.9g, want %.9g +- %.2g", got, want, tolerance);
}

// Midpoint sums of smooth densities: seen from as near as a tenth of the light's size they are good to this.
#define INTEGRAL 2e-3

static const Vec3 ceiling[4] = {{-1, -0.5f, 2}, {-1, 0.5f, 2}, {1, 0.5f, 2}, {1, -0.5f, 2}}; // faces down

static void test_rectangle(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_quad(&s, ceiling, rgb_gray(1));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    // Below, near, beside, at a grazing angle, far, and so far that the area takes over (solid angle 2e-9).
    const Vec3 p[] = {{0, 0, 0}, {0.5f, 0.3f, 1.8f}, {4, 3, 1}, {2, 1, 1.99f}, {50, -70, -100}, {1e4f, 0, -3e4f}};
    for (size_t i = 0; i < sizeof p / sizeof *p; ++i) assert_near(check(&s, p[i]), 1, INTEGRAL);
    light_scene_destroy(&s);
}

// Rotated, with its vertices in every order that a file may give them.
static void test_rectangle_in_any_order(void **state)
{
    (void)state;
    Vec3 o = v3(1, 2, 3), x = v3_scale(v3_normalize(v3(1, 2, 2)), 0.7f), y = v3_scale(v3_normalize(v3(2, 1, -2)), 1.3f);
    Vec3 v[4] = {o, v3_add(o, x), v3_add(v3_add(o, x), y), v3_add(o, y)};
    Vec3 p = v3_mad(v3_mad(o, 0.2f, x), 0.8f, v3_cross(x, y));
    for (int turn = 0; turn < 9; ++turn) {
        static const uint32_t first[3][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}};
        static const uint32_t second[3][3] = {{0, 2, 3}, {2, 3, 0}, {3, 0, 2}};
        uint32_t t[2][3];
        memcpy(t[0], first[turn % 3], sizeof t[0]);
        memcpy(t[1], second[turn / 3], sizeof t[1]);
        LightScene s = light_scene_begin();
        add_mesh(&s, 4, v, 2, (const uint32_t(*)[3])t, rgb_gray(1));
        light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
        LightSample a, b; // over the whole solid angle: the same density for both triangles
        assert_true(sheen_light_sample(s.lights, 0, p, v2(0.01f, 0.01f), &a));
        assert_true(sheen_light_sample(s.lights, 0, p, v2(0.99f, 0.99f), &b));
        assert_true(a.pdf == b.pdf);
        if (turn == 0 || turn == 5) assert_near(check(&s, p), 1, INTEGRAL);
        light_scene_destroy(&s);
    }
}

static void test_triangle(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_triangle(&s, ceiling[0], ceiling[1], ceiling[2], rgb_gray(1));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    // Below, near, beside, grazing, far, far enough for the area.
    const Vec3 p[] = {{0, 0, 0}, {-0.3f, 0.3f, 1.8f}, {4, 3, 1}, {2, 1, 1.95f}, {20, -30, -40}, {30, -30, -150}};
    for (size_t i = 0; i < sizeof p / sizeof *p; ++i) assert_near(check(&s, p[i]), 1, INTEGRAL);
    light_scene_destroy(&s);
}

static void test_sliver(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_triangle(&s, v3(0, 0, 1), v3(0.5f, 0.002f, 1), v3(1, 0, 1), rgb_gray(1));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    const Vec3 p[] = {{0.5f, 0, 0}, {0.3f, 0.2f, 0.7f}};
    for (size_t i = 0; i < sizeof p / sizeof *p; ++i) assert_near(check(&s, p[i]), 1, INTEGRAL);
    light_scene_destroy(&s);
}

// A closed mesh: triangles that face away bring nothing.
static void test_box(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_box(&s, v3(-1, -1, 2), v3(1, 1, 2.5f), rgb_gray(1));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    double faces = 2 * 4 + 4 * 1; // m^2
    assert_near(check(&s, v3(0.2f, 0.1f, 0)), 4 / faces, INTEGRAL);
    assert_near(check(&s, v3(3, 0.1f, 0)), (4 + 1) / faces, INTEGRAL);
    light_scene_destroy(&s);
}

// The share of the bounding rectangle's solid angle that the disk fills: far away that of the areas, pi/4.
static void test_disk(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_disk(&s, v3(0, 0, 2), v3(0.5f, 0, 0), v3(0, -0.5f, 0), rgb_gray(1));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    const Vec3 p[] = {{0, 0, 0}, {0.3f, 0.2f, 1.9f}, {3, 2, 1}, {20, 0, -30}};
    for (size_t i = 0; i < sizeof p / sizeof *p; ++i) {
        double share = check(&s, p[i]);
        assert_true(share > 0.7 && share < 1);
        if (i == 3) assert_near(share, (double)SHEEN_PI / 4, INTEGRAL);
    }
    light_scene_destroy(&s);
}

static void test_ellipse_with_skewed_axes(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_disk(&s, v3(0, 0, 2), v3(0.5f, 0.1f, 0), v3(0.3f, -0.2f, 0.1f), rgb_gray(1));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    Vec3 n = s.scene->shapes[0].disk.n;
    check(&s, v3_mad(v3(0.3f, 0.2f, 2), 1, n));
    check(&s, v3_mad(v3(-0.1f, 0.2f, 2), 0.2f, n));
    light_scene_destroy(&s);
}

static void test_sphere(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_sphere(&s, v3(1, 2, 3), 0.5f, false, rgb_gray(1));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    const Vec3 p[] = {{1, 2, 0}, {1, 2, 3.6f}, {4, -5, 6}};
    for (size_t i = 0; i < sizeof p / sizeof *p; ++i) assert_near(check(&s, p[i]), 1, INTEGRAL);
    light_scene_destroy(&s);
}

static void test_inside_of_a_sphere(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_sphere(&s, v3(1, 2, 3), 5, true, rgb_gray(1));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    assert_near(check(&s, v3(1, 2, 3)), 1, INTEGRAL);
    assert_near(check(&s, v3(1.5f, 1, 4.5f)), 1, INTEGRAL);
    light_scene_destroy(&s);
}

// A light a millionth of its distance in size, and one a thousandth of a millimetre away: finite and never refused.
static void test_extremes(void **state)
{
    (void)state;
    LightScene s = light_scene_begin();
    add_quad(&s, ceiling, rgb_gray(1));
    add_triangle(&s, ceiling[0], ceiling[1], ceiling[2], rgb_gray(1));
    add_sphere(&s, v3(0, 0, 3), 0.5f, false, rgb_gray(1));
    add_disk(&s, v3(0, 0, 2), v3(0.5f, 0, 0), v3(0, -0.5f, 0), rgb_gray(1));
    light_scene_end(&s, SHEEN_ENVIRONMENT_WHOLE);
    const Vec3 p[] = {{0, 0, -2e6f}, {-0.01f, 0, 1.999999f}, {-0.3f, 0.1f, 1.9999f}, {1e6f, 1e6f, 1.9f}};
    Random r = {2, 0};
    for (uint32_t light = 0; light < 4; ++light)
        for (size_t i = 0; i < sizeof p / sizeof *p; ++i)
            for (int k = 0; k < 1000; ++k) {
                LightSample sample;
                if (!sheen_light_sample(s.lights, light, p[i], random_2d(&r), &sample)) continue;
                assert_true(isfinite(sample.pdf) && sample.pdf > 0 && rgb_finite(sample.radiance));
                assert_true(v3_finite(sample.wi) && v3_finite(sample.target));
                // No light fills more than a half-space.
                assert_true(sample.radiance.g <= 2 * SHEEN_PI * 1.6f);
            }
    light_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rectangle),
        cmocka_unit_test(test_rectangle_in_any_order),
        cmocka_unit_test(test_triangle),
        cmocka_unit_test(test_sliver),
        cmocka_unit_test(test_box),
        cmocka_unit_test(test_disk),
        cmocka_unit_test(test_ellipse_with_skewed_axes),
        cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_inside_of_a_sphere),
        cmocka_unit_test(test_extremes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
