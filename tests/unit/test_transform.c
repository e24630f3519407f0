// SPDX-License-Identifier: Apache-2.0
// Transforms: composition order, inverses, normals, the camera's frame.
#include "math/transform.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

// Values near 1 pass through a few double operations and one rounding to float.
#define EPS 2e-6f

static void assert_v3_near(Vec3 a, Vec3 b)
{
    assert_float_equal(a.x, b.x, EPS);
    assert_float_equal(a.y, b.y, EPS);
    assert_float_equal(a.z, b.z, EPS);
}

static void product_applies_the_right_factor_first(void **state)
{
    (void)state;
    Transform t = transform_mul(transform_translate(1, 2, 3), transform_scale(2, 2, 2));
    assert_v3_near(transform_point(&t, v3(1, 1, 1)), v3(3, 4, 5));
    assert_v3_near(transform_vector(&t, v3(1, 1, 1)), v3(2, 2, 2));
}

static void rotation_is_right_handed(void **state)
{
    (void)state;
    Transform t = transform_rotate(v3(0, 0, 5), 0.5 * 3.14159265358979);
    assert_v3_near(transform_vector(&t, v3(1, 0, 0)), v3(0, 1, 0));
    t = transform_rotate(v3(1, 1, 1), 2.0 / 3.0 * 3.14159265358979); // cycles the axes
    assert_v3_near(transform_vector(&t, v3(1, 0, 0)), v3(0, 1, 0));
    assert_v3_near(transform_vector(&t, v3(0, 1, 0)), v3(0, 0, 1));
    t = transform_rotate(v3(0, 0, 0), 1.0);
    assert_v3_near(transform_vector(&t, v3(1, 2, 3)), v3(1, 2, 3));
}

static void inverse_undoes(void **state)
{
    (void)state;
    Transform t = transform_mul(transform_rotate(v3(1, -2, 0.5f), 0.7), transform_scale(2, -0.5, 3));
    t = transform_mul(transform_translate(1, -4, 2), t);
    Transform inverse;
    assert_true(transform_invert(&t, &inverse));
    assert_v3_near(transform_point(&inverse, transform_point(&t, v3(0.3f, -0.7f, 0.9f))), v3(0.3f, -0.7f, 0.9f));
    assert_float_equal(transform_determinant(&t), -3.0, 1e-12);
}

static void singular_and_non_finite_matrices_have_no_inverse(void **state)
{
    (void)state;
    Transform inverse, t = transform_scale(1, 0, 1);
    assert_false(transform_invert(&t, &inverse));
    assert_true(inverse.m[0][0] == 1.0 && inverse.m[0][1] == 0.0);
    t = transform_identity();
    t.m[1][3] = NAN;
    assert_false(transform_invert(&t, &inverse));
    t = transform_scale(1e-12, 1e-12, 1e-12); // small but regular
    assert_true(transform_invert(&t, &inverse));
}

static void normals_stay_perpendicular(void **state)
{
    (void)state;
    Transform t = transform_mul(transform_rotate(v3(1, 2, 3), 1.1), transform_scale(4, 1, -0.25)), inverse;
    assert_true(transform_invert(&t, &inverse));
    Vec3 n = v3_normalize(v3(1, 2, -1)), tangent = v3_cross(n, v3(0, 1, 0));
    Vec3 nt = transform_normal(&inverse, n);
    assert_float_equal(v3_dot(nt, transform_vector(&t, tangent)), 0.0f, EPS);
    assert_float_equal(v3_length(nt), 1.0f, EPS);
}

static void camera_looks_at_its_target(void **state)
{
    (void)state;
    Transform t = transform_look_at(v3(1, 2, 3), v3(1, 2, -7), v3(0, 1, 0));
    assert_v3_near(transform_vector(&t, v3(0, 0, 1)), v3(0, 0, -1));
    assert_v3_near(transform_vector(&t, v3(0, 1, 0)), v3(0, 1, 0));
    assert_v3_near(transform_vector(&t, v3(1, 0, 0)), v3(-1, 0, 0)); // looking along -z, left is -x
    assert_v3_near(transform_point(&t, v3(0, 0, 0)), v3(1, 2, 3));
    assert_float_equal(transform_determinant(&t), 1.0, EPS);
    // An up vector along the view is replaced by another.
    t = transform_look_at(v3(0, 0, 0), v3(0, 1, 0), v3(0, 1, 0));
    assert_float_equal(transform_determinant(&t), 1.0, EPS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(product_applies_the_right_factor_first),
        cmocka_unit_test(rotation_is_right_handed),
        cmocka_unit_test(inverse_undoes),
        cmocka_unit_test(singular_and_non_finite_matrices_have_no_inverse),
        cmocka_unit_test(normals_stay_perpendicular),
        cmocka_unit_test(camera_looks_at_its_target),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
